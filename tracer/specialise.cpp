// SPDX-License-Identifier: Apache-2.0
#include "tracer/specialise.h"

#include "runtime/base/parallel.h"
#include "tracer/shader_set.h"

#include <algorithm>

namespace trace {

namespace {

using namespace std::chrono_literals;

// Looking costs microseconds per instance.
constexpr auto look_every = 20ms;
// Instances with less work to come than the quickest compilation takes are not looked into.
constexpr double least_work_s = 0.05;
// What must be saved for each second of compiling: estimates of gain and of work to come are off by
// such factors (docs/design/slc-speed.md, spd-003).
constexpr double wanted_return = 1.5;
// Most expensive first: what is asked for later may be worth more.
constexpr int most_waiting = 2;

// The value every point of an instance has.
rt::BoundValue constant_of(const rt::ShaderInstance& instance, int index) {
    const sl_param& param = instance.object().params[index];
    rt::BoundValue value;
    value.name = param.name;
    value.type = static_cast<sl_type>(param.type);
    value.array_length = param.array_length;
    if (value.type == SL_TYPE_string) {
        value.strings = {instance.uniform_string(index)};
        return value;
    }
    const auto n = static_cast<std::size_t>(std::max(param.array_length, 1)) *
                   static_cast<std::size_t>(rt::components_of(param.type));
    const float* floats = instance.uniform_floats(index);
    value.floats.assign(floats, floats + n);
    return value;
}

std::vector<rt::BoundValue> constants_of(const rt::ShaderInstance& instance,
                                         const std::vector<int>& kept) {
    const sl_object& object = instance.object();
    std::vector<rt::BoundValue> constants;
    for (int i = 0; i < object.num_params; ++i) {
        const sl_param& p = object.params[i];
        const bool is_kept = std::find(kept.begin(), kept.end(), i) != kept.end();
        const bool is_list_of_strings = p.type == SL_TYPE_string && p.array_length > 0;
        if (!is_kept && p.is_output == 0 && !is_list_of_strings) {
            constants.push_back(constant_of(instance, i));
        }
    }
    return constants;
}

} // namespace

Specialiser::Specialiser(const Settings& settings, const ShadingClasses& classes,
                         const LightSet& lights, rt::ShaderLibrary& library, base::Diag& diag)
    : settings_(settings), library_(library), diag_(diag), next_look_(Clock::now() + look_every) {
    const bool is_off = settings.mode == SpecialMode::Off && !settings.for_profile;
    if (is_off || !library.config().specialise) {
        return;
    }
    for (std::size_t i = 0; i < classes.size(); ++i) {
        const ShadingClass& c = classes[static_cast<std::uint32_t>(i)];
        add(c.surface, c.overrides);
        add(c.atmosphere, {});
    }
    for (std::size_t i = 0; i < lights.size(); ++i) {
        add(lights[static_cast<rib::LightId>(i)].shader, {});
    }
    if (settings.mode == SpecialMode::Always || settings.for_profile) {
        make_all();
    }
}

Specialiser::~Specialiser() {
    is_ending_ = true;
    queue_.stop();
    for (const auto& candidate : candidates_) {
        candidate->entry->special = nullptr;
        candidate->entry->spent_ticks = 0;
    }
}

void Specialiser::add(const ShaderEntry* entry, const std::vector<ParamOverride>& overrides) {
    if (entry == nullptr || entry->object().ir == nullptr || entry->object().ir[0] == '\0') {
        return;
    }
    auto it = std::find_if(candidates_.begin(), candidates_.end(),
                           [&](const auto& c) { return c->entry == entry; });
    if (it == candidates_.end()) {
        it = candidates_.insert(it, std::make_unique<Candidate>());
        (*it)->entry = entry;
    }
    for (const ParamOverride& o : overrides) {
        (*it)->kept.push_back(o.param);
    }
}

void Specialiser::make_all() {
    base::parallel_for(candidates_.size(), settings_.num_threads, [&](std::size_t i, int) {
        make(*candidates_[i], std::nullopt);
        return true;
    });
}

void Specialiser::progress(std::size_t done, std::size_t total) {
    if (candidates_.empty() || settings_.mode != SpecialMode::Auto || settings_.for_profile ||
        done >= total) {
        return;
    }
    const std::unique_lock lock(looking_, std::try_to_lock);
    if (!lock.owns_lock() || Clock::now() < next_look_) {
        return;
    }
    look(static_cast<double>(done) / static_cast<double>(total));
    next_look_ = Clock::now() + look_every;
}

// The frame is taken to go on as it went: what an instance cost so far tells what it will cost.
void Specialiser::look(double share_done) {
    struct Work {
        double seconds;
        Candidate* candidate;
    };
    std::vector<Work> works;
    const double seconds_per_tick = tick_rate_.seconds_per_tick();
    for (const auto& c : candidates_) {
        const double spent_s = seconds_per_tick * static_cast<double>(c->entry->spent_ticks);
        const double work_s = spent_s * (1 - share_done) / share_done;
        if (c->state == State::General && work_s > std::max(least_work_s, 2 * c->refused_s)) {
            works.push_back({work_s, c.get()});
        }
    }
    std::sort(works.begin(), works.end(),
              [](const Work& a, const Work& b) { return a.seconds > b.seconds; });
    for (const Work& work : works) {
        if (num_asked_ >= most_waiting) {
            break;
        }
        ask(*work.candidate, work.seconds);
    }
}

void Specialiser::ask(Candidate& candidate, double work_s) {
    candidate.state = State::Asked;
    ++num_asked_;
    queue_.add([this, &candidate, work_s] {
        make(candidate, work_s);
        --num_asked_;
    });
}

// While the compiler works the others go on without it.
bool Specialiser::pays(const rt::SpecialShader& special, double work_s) const {
    const double left_s = work_s - settings_.num_threads * special.compile_seconds;
    return left_s * special.gain > wanted_return * special.compile_seconds;
}

// Without work_s: whatever it costs.
void Specialiser::make(Candidate& candidate, std::optional<double> work_s) {
    const rt::ShaderInstance& general = *candidate.entry->instance;
    const std::vector<rt::BoundValue> constants = settings_.for_profile
                                                      ? std::vector<rt::BoundValue>()
                                                      : constants_of(general, candidate.kept);
    const auto special = library_.config().specialise(general.object(), constants);
    if (!special) {
        candidate.state = State::Done;
        return;
    }
    const rt::ShaderObject* object = library_.find_special(*special);
    if (object == nullptr && work_s && !pays(*special, *work_s)) {
        candidate.refused_s = *work_s;
        candidate.state = State::General;
        return;
    }
    if (object == nullptr) {
        object = library_.make_special(*special, [this] {
            return is_ending_ || (settings_.interrupted != nullptr && settings_.interrupted());
        });
    }
    if (object != nullptr && rt::have_same_block(*object, general.shader())) {
        publish(candidate, *object);
    }
    candidate.state = State::Done;
}

void Specialiser::publish(Candidate& candidate, const rt::ShaderObject& object) {
    candidate.instance = std::make_unique<rt::ShaderInstance>(object, *candidate.entry->instance);
    candidate.entry->special = candidate.instance.get();
    ++num_special_;
    if (settings_.is_verbose && !settings_.for_profile) {
        diag_.report(base::Severity::Info, base::Code::None, candidate.entry->pos,
                     "shader \"" + candidate.entry->name +
                         "\" now runs specialised on its parameters");
    }
}

} // namespace trace
