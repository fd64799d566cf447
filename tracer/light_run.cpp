// SPDX-License-Identifier: Apache-2.0
#include "tracer/light_run.h"

#include "runtime/base/lanes4.h"
#include "runtime/base/ticks.h"
#include "tracer/area_light.h"
#include "tracer/services.h"
#include "tracer/shader_set.h"
#include "tracer/sl_types.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace trace {

namespace {

constexpr std::uint32_t all_lanes = SL_LANES_MAX;
// Lights run for a packet at a time: a clock for each would cost more than some lights do.
constexpr std::uint64_t timed_every = 16;

// The lanes of a mask, one after another.
template <class Body> void for_lanes(std::uint32_t mask, Body body) {
    for (std::uint32_t rest = mask; rest != 0; rest &= rest - 1) {
        body(static_cast<std::uint32_t>(std::countr_zero(rest)));
    }
}

void fill_triple(rt::ShadeBatch& batch, sl_variable id, const base::V3d& value) {
    if (!batch.has(id)) {
        return;
    }
    for (int k = 0; k < 3; ++k) {
        std::fill_n(batch.plane(id, k), all_lanes, static_cast<float>(value[k]));
    }
}

void fill_color(rt::ShadeBatch& batch, sl_variable id, const base::Color& c) {
    fill_triple(batch, id,
                {static_cast<double>(c.r), static_cast<double>(c.g), static_cast<double>(c.b)});
}

void fill_float(rt::ShadeBatch& batch, sl_variable id, float value) {
    if (batch.has(id)) {
        std::fill_n(batch.plane(id), all_lanes, value);
    }
}

} // namespace

void LightRun::attach(Execution& asker, const LightInfo& info, rib::LightId id) {
    const bool stale = asker_ != &asker || serial_ != asker.serial;
    // Between batches of the asker: what a running one learned from the light stays.
    const bool is_new = info_ != &info || (stale && instance_ != &info.shader->current());
    if (!is_new && !stale) {
        return;
    }
    info_ = &info;
    id_ = id;
    asker_ = &asker;
    serial_ = asker.serial;
    execution_.emplace(asker.frame, *info.shader);
    execution_->thread = asker.thread;
    execution_->batch = &batch_;
    execution_->subject = asker.subject;
    execution_->asked_by = &asker;
    execution_->ray_level = asker.ray_level;
    execution_->ray_kind = asker.ray_kind;
    execution_->light = this;
    if (is_new) {
        begin();
        samples_.clear();
        sent_ = false;
    }
    if (!info.is_constant) {
        lanes_ = 0; // no points yet
    }
    in_batch_ = -1;
}

void LightRun::begin() {
    instance_ = &info_->shader->current();
    batch_.begin(*instance_, all_lanes);
    fill_frame(Space::from(info_->shader->camera_from_shader).value_or(Space{}));
    for (const sl_variable id : {SL_VAR_u, SL_VAR_v, SL_VAR_s, SL_VAR_t, SL_VAR_du, SL_VAR_dv}) {
        fill_float(batch_, id, 0);
    }
    fill_color(batch_, SL_VAR_Cs, info_->color);
    fill_color(batch_, SL_VAR_Os, info_->opacity);
    const rib::Options& options = asker_->frame.scene.options;
    fill_float(batch_, SL_VAR_dtime, options.shutter_close - options.shutter_open);
    if (float* E = batch_.uniform(SL_VAR_E)) {
        E[0] = E[1] = E[2] = 0; // the eye is the origin of camera space
    }
    if (float* ncomps = batch_.uniform(SL_VAR_ncomps)) {
        *ncomps = 3;
    }
}

// The frame of shader space stands for the geometry of a light without any ([R] of sl.md 3.3).
void LightRun::fill_frame(const Space& space) {
    fill_triple(batch_, SL_VAR_P, space.point_to_camera({0, 0, 0}));
    fill_triple(batch_, SL_VAR_dPdu, space.vector_to_camera({1, 0, 0}));
    fill_triple(batch_, SL_VAR_dPdv, space.vector_to_camera({0, 1, 0}));
    const base::V3d normal = base::normalize(space.normal_to_camera({0, 0, 1}));
    fill_triple(batch_, SL_VAR_N, normal);
    fill_triple(batch_, SL_VAR_Ng, normal);
}

bool LightRun::wants(sl_string category) {
    if (category != category_) { // interned: equal texts have equal addresses
        category_ = category;
        wanted_ = category == nullptr || in_category(info_->categories, category);
    }
    return wanted_;
}

std::int32_t LightRun::num_samples() const {
    if (info_->area != nullptr) {
        return info_->num_samples + (has_hidden_sample(*info_) ? 1 : 0);
    }
    return spreads_ ? info_->num_samples : 1;
}

// --- what is known

// Other points: what was found for the last ones is forgotten. Lanes that are not asked get the
// point of one that is: a light may loop until its value converges.
void LightRun::move_to(const sl_light_query& query) {
    const auto any = static_cast<std::uint32_t>(std::countr_zero(query.mask));
    bool same = query.first == first_ && lanes_ == query.lanes;
    for_lanes(query.mask, [&](std::uint32_t lane) {
        for (std::uint32_t k = 0; k < 3; ++k) {
            same = same && query.P[k * query.lanes + lane] == Ps_[k][lane];
        }
    });
    if (same) {
        return;
    }
    first_ = query.first;
    lanes_ = query.lanes;
    for (std::uint32_t lane = 0; lane < all_lanes; ++lane) {
        const bool has_point = lane < query.lanes && (query.mask >> lane & 1U) != 0;
        for (std::uint32_t k = 0; k < 3; ++k) {
            Ps_[k][lane] = query.P[k * query.lanes + (has_point ? lane : any)];
        }
    }
    for (LightSample& sample : samples_) {
        sample.known = info_->is_constant ? sample.known : 0;
        sample.traced = 0;
    }
    spreads_ = false;
    in_batch_ = -1;
}

LightSample& LightRun::sample_of(std::int32_t index) {
    const auto at = static_cast<std::size_t>(index);
    if (at >= samples_.size()) {
        samples_.resize(at + 1);
    }
    return samples_[at];
}

bool LightRun::is_known(const sl_light_query& query, const LightSample& sample) const {
    return (query.mask & ~sample.known) == 0 && query.num_sends == 0 && query.refresh == 0 &&
           info_->reusable;
}

std::uint32_t LightRun::illuminate(const sl_light_query& asked) {
    sl_light_query query = asked;
    query.mask &= (1U << query.lanes) - 1;
    if (query.mask == 0) {
        return 0;
    }
    move_to(query);
    LightSample& sample = sample_of(query.sample);
    if (is_known(query, sample)) {
        asker_->thread->counters.add(Counter::light_reused);
        return query.mask & sample.lit;
    }
    run_lanes(query, query.mask, sample);
    if (query.num_sends > 0) {
        sample.known = 0; // for this execution only
    }
    return query.mask & sample.lit;
}

// Points that are sent different values for one uniform parameter are lit one after another.
void LightRun::run_lanes(const sl_light_query& query, std::uint32_t mask, LightSample& sample) {
    for (std::uint32_t rest = mask; rest != 0;) {
        const std::uint32_t together = alike(query, rest);
        if (sent_) {
            begin();
            sent_ = false;
        } else {
            batch_.restart();
        }
        execution_->asked_first = query.first;
        execution_->asked_mask = together;
        execution_->light_sample = query.sample;
        fill_points(together, query.N);
        if (info_->shader->object().needed_aux != 0) {
            fill_differences(together);
        }
        fill_seeds_and_time();
        reset_results();
        if (info_->area != nullptr) {
            fill_place(together, sample);
        } else {
            std::fill_n(weight_, all_lanes, 1.0f);
        }
        send(query, together);
        run_shader(static_cast<std::uint32_t>(std::popcount(together)));
        collect(together, sample);
        rest &= ~together;
        in_batch_ = query.sample;
        in_batch_mask_ = together;
    }
}

void LightRun::recall(const sl_light_query& query) {
    (void)illuminate(query);
    if (in_batch_ != query.sample || (query.mask & ~in_batch_mask_) != 0) {
        run_lanes(query, query.mask, sample_of(query.sample));
    }
}

// --- messages to the light

namespace {

bool differ(const sl_value& value, std::uint32_t lanes, std::uint32_t a, std::uint32_t b) {
    if (value.type == SL_TYPE_string) {
        const auto* texts = static_cast<const sl_string*>(value.data);
        return texts[a] != texts[b];
    }
    const auto* floats = static_cast<const float*>(value.data);
    const int planes = rt::components_of(value.type) * std::max(value.array_length, 1);
    for (int k = 0; k < planes; ++k) {
        const float* plane = floats + static_cast<std::size_t>(k) * lanes;
        if (std::bit_cast<std::uint32_t>(plane[a]) != std::bit_cast<std::uint32_t>(plane[b])) {
            return true;
        }
    }
    return false;
}

} // namespace

// Of these lanes, those that may share an execution with the first.
std::uint32_t LightRun::alike(const sl_light_query& query, std::uint32_t mask) const {
    const auto first = static_cast<std::uint32_t>(std::countr_zero(mask));
    std::uint32_t together = mask;
    for (std::int32_t i = 0; i + 1 < query.num_sends; i += 2) {
        const sl_string name = *static_cast<const sl_string*>(query.sends[i].data);
        const sl_value& value = query.sends[i + 1];
        const int index = info_->shader->instance->shader().find_param(name);
        const bool is_shared = value.varying != 0 && index >= 0 &&
                               info_->shader->object().params[index].detail == SL_DETAIL_uniform;
        for_lanes(is_shared ? mask : 0, [&](std::uint32_t lane) {
            together &= differ(value, query.lanes, first, lane) ? ~(1U << lane) : ~0U;
        });
    }
    return together;
}

// "send:light:name": the parameter has this value for one execution.
void LightRun::send(const sl_light_query& query, std::uint32_t mask) {
    for (std::int32_t i = 0; i + 1 < query.num_sends; i += 2) {
        const sl_string name = *static_cast<const sl_string*>(query.sends[i].data);
        const sl_value& value = query.sends[i + 1];
        const int index = info_->shader->instance->shader().find_param(name);
        if (index < 0) {
            continue;
        }
        const sl_param& param = info_->shader->object().params[index];
        if (types_agree(param.type, value.type) && param.array_length == value.array_length) {
            sent_ = true;
            send_value(query, mask, index, value);
        }
    }
}

// Lanes that are not asked take the value of one that is.
void LightRun::send_value(const sl_light_query& query, std::uint32_t mask, int index,
                          const sl_value& value) {
    const auto any = static_cast<std::uint32_t>(std::countr_zero(mask));
    const auto put = [&]<class T>(const T* from, T* each, T* one) {
        const std::size_t step = value.varying != 0 ? query.lanes : 1;
        for (std::uint32_t lane = 0; each != nullptr && lane < all_lanes; ++lane) {
            const std::uint32_t asked = (mask >> lane & 1U) != 0 ? lane : any;
            each[lane] = from[value.varying != 0 ? asked : 0];
        }
        if (one != nullptr) {
            *one = from[value.varying != 0 ? any : 0];
        }
        return from + step;
    };
    const sl_param& param = info_->shader->object().params[index];
    if (param.type == SL_TYPE_string) { // arrays of strings: their first element
        put(static_cast<const sl_string*>(value.data), batch_.param_strings(index),
            batch_.param_uniform_string(index));
        return;
    }
    const int num_floats = rt::components_of(param.type) * std::max(param.array_length, 1);
    const auto* from = static_cast<const float*>(value.data);
    float* const uniform = batch_.param_uniform(index);
    for (int k = 0; k < num_floats; ++k) {
        from = put(from, batch_.param_plane(index, k), uniform != nullptr ? uniform + k : nullptr);
    }
}

// --- inputs

void LightRun::fill_points(std::uint32_t mask, const float* N) {
    const auto any = static_cast<std::uint32_t>(std::countr_zero(mask));
    for (std::uint32_t k = 0; k < 3; ++k) {
        float* Ns = batch_.has(SL_VAR_Ns) ? batch_.plane(SL_VAR_Ns, static_cast<int>(k)) : nullptr;
        for (std::uint32_t lane = 0; Ns != nullptr && lane < all_lanes; ++lane) {
            const std::uint32_t from = (mask >> lane & 1U) != 0 ? lane : any;
            Ns[lane] = N != nullptr ? N[k * lanes_ + from] : 0;
        }
        for (const sl_variable id : {SL_VAR_Ps, SL_VAR_I}) { // I = Ps - E, and E is the origin
            if (batch_.has(id)) {
                std::copy_n(Ps_[k], all_lanes, batch_.plane(id, static_cast<int>(k)));
            }
        }
    }
}

// The sampled places of the light. P, N and the like are what the surface has there.
void LightRun::fill_place(std::uint32_t mask, LightSample& sample) {
    constexpr std::uint64_t of_surface = 1ULL << SL_VAR_P | 1ULL << SL_VAR_N | 1ULL << SL_VAR_Ng |
                                         1ULL << SL_VAR_dPdu | 1ULL << SL_VAR_dPdv |
                                         1ULL << SL_VAR_u | 1ULL << SL_VAR_v | 1ULL << SL_VAR_s |
                                         1ULL << SL_VAR_t;
    const auto any = static_cast<std::uint32_t>(std::countr_zero(mask));
    geo::Hit places[all_lanes];
    for_lanes(mask, [&](std::uint32_t lane) {
        const std::uint32_t seed = light_seed(seed_[lane], id_, point(lane));
        geo::AreaPoint place = place_on_light(*info_, point(lane), seed, execution_->light_sample);
        place.hit.time = time_of(lane);
        sample.on[lane] = places[lane] = place.hit;
        weight_[lane] = static_cast<float>(place.weight);
    });
    for (std::uint32_t lane = 0; lane < all_lanes; ++lane) {
        if ((mask >> lane & 1U) == 0) {
            places[lane] = places[any];
            weight_[lane] = 0;
        }
    }
    static constexpr float zero[all_lanes] = {}, one[all_lanes] = {1, 1, 1, 1, 1, 1, 1, 1};
    asker_->frame.world->fill(places, {zero, zero, zero, zero, zero, one, {}},
                              info_->shader->object().needed & of_surface, batch_.stride(),
                              batch_.points(), nullptr, nullptr);
}

// Points that are those of the surface differ as it does; others (a march through a volume) not at
// all. I = Ps - E differs as Ps does.
void LightRun::fill_differences(std::uint32_t mask) {
    const BatchSubject* subject = asker_->subject;
    const bool known = subject != nullptr && subject->P_u != nullptr && asker_->batch != nullptr &&
                       asker_->batch->has(SL_VAR_P);
    const auto any = static_cast<std::uint32_t>(std::countr_zero(mask));
    for (std::uint32_t lane = 0; lane < all_lanes; ++lane) {
        const std::uint32_t from = (mask >> lane & 1U) != 0 ? lane : any;
        const std::size_t at = first_ + from;
        bool same = known && at < asker_->batch->count();
        for (int k = 0; same && k < 3; ++k) {
            same = asker_->batch->plane(SL_VAR_P, k)[at] == Ps_[k][lane];
        }
        for (int k = 0; k < 3; ++k) {
            const std::size_t place =
                same ? static_cast<std::size_t>(k) * asker_->batch->stride() + at : 0;
            for (const sl_variable id : {SL_VAR_Ps, SL_VAR_I}) {
                if (batch_.aux_u(id, k) != nullptr) {
                    batch_.aux_u(id, k)[lane] = same ? subject->P_u[place] : 0;
                    batch_.aux_v(id, k)[lane] = same ? subject->P_v[place] : 0;
                }
            }
        }
    }
}

float LightRun::time_of(std::uint32_t lane) const {
    const BatchSubject* subject = asker_->subject;
    const std::size_t at = first_ + lane;
    return subject != nullptr && at < subject->hits.size() ? subject->hits[at].time
                                                           : asker_->frame.spaces.shutter_open();
}

// Each sample of a point has random numbers of its own.
void LightRun::fill_seeds_and_time() {
    const std::uint32_t count = asker_->batch != nullptr ? asker_->batch->count() : 0;
    const auto turn = static_cast<std::uint32_t>(execution_->light_sample) * 0x9e3779b1U;
    for (std::uint32_t lane = 0; lane < all_lanes && count > 0; ++lane) {
        seed_[lane] = seed_of(*asker_, std::min(first_ + lane, count - 1));
        batch_.seeds()[lane] = seed_[lane] ^ turn;
        if (batch_.has(SL_VAR_time)) {
            batch_.plane(SL_VAR_time)[lane] = time_of(std::min(lane, count - 1 - first_));
        }
    }
}

void LightRun::reset_results() {
    fill_triple(batch_, SL_VAR_L, {0, 0, 0});
    fill_triple(batch_, SL_VAR_Cl, {0, 0, 0});
    fill_triple(batch_, SL_VAR_Ol, {1, 1, 1});
    if ((info_->shader->object().written >> SL_VAR_N & 1U) != 0) {
        fill_frame(Space::from(info_->shader->camera_from_shader).value_or(Space{}));
    }
}

// Uniform in solid angle; light from everywhere weighs twice, so that an even field of radiance 1
// gives a white surface 1, as its middle alone does (light-003).
void LightRun::choose_solar_direction(const SolarQuery& query, std::uint32_t lanes) {
    const bool all = query.axis == nullptr;
    for_lanes(query.mask, [&](std::uint32_t lane) {
        float* const L = query.L + lane;
        const std::uint32_t at = query.first + lane; // in the batch
        base::V3f axis;
        for (std::uint32_t k = 0; k < 3; ++k) {
            axis[static_cast<int>(k)] = all ? -batch_.plane(SL_VAR_Ns, static_cast<int>(k))[at]
                                            : query.axis[k * lanes + lane];
        }
        const float length = base::length(axis);
        const float angle = all ? 0.5f * std::numbers::pi_v<float>
                                : std::clamp(query.angle[lane], 0.0f, std::numbers::pi_v<float>);
        if (angle > 0 && length > 0) {
            const std::uint32_t seed = light_seed(seed_[at], id_, point(at));
            const auto place =
                light_pattern(seed, static_cast<std::uint32_t>(execution_->light_sample));
            axis = direction_in_cone(axis / length, angle, place) * (all ? 1.0f : length);
            spreads_ = true;
            weight_[at] = all ? 2.0f : 1.0f;
        }
        for (std::uint32_t k = 0; k < 3; ++k) {
            L[k * lanes] = axis[static_cast<int>(k)];
        }
    });
}

// --- results

std::uint32_t LightRun::executed() const {
    if (!info_->directional) {
        return ~0U;
    }
    std::uint32_t mask = 0;
    for (std::uint32_t lane = 0; lane < all_lanes; ++lane) {
        mask |= batch_.lit(lane) ? 1U << lane : 0;
    }
    return mask;
}

void LightRun::run_shader(std::uint32_t num_points) {
    Counters& counters = asker_->thread->counters;
    ShaderCounters& of_shader = counters.shader(info_->shader->number);
    const bool is_timed = of_shader.value[ShaderCount::batches] % timed_every == 0;
    const std::uint64_t start = is_timed ? base::ticks() : 0;
    if (batch_.run({&service_table(), &*execution_}) != 0) {
        report_suspended(*execution_);
    }
    drop_bad();
    if (is_timed) {
        const std::uint64_t spent = base::ticks() - start;
        of_shader.add_time(spent);
        info_->shader->spent_ticks.fetch_add(timed_every * spent, std::memory_order_relaxed);
    }
    of_shader.add_batch(num_points, batch_.num_packets(), execution_->lanes());
    counters.add(Counter::light_packets, batch_.num_packets());
}

// Light that is no number does not arrive: the lane counts as unlit, and black.
void LightRun::drop_bad() {
    static constexpr sl_variable results[] = {SL_VAR_L, SL_VAR_Cl, SL_VAR_Ol};
    base::Float4 bad[all_lanes / 4] = {}; // x - x is 0 for numbers, NaN for the rest
    for (const sl_variable id : results) {
        for (std::size_t at = 0; batch_.has(id) && at < 3 * all_lanes; at += 4) {
            const auto x = *reinterpret_cast<const base::Float4*>(batch_.plane(id) + at);
            bad[at / 4 % (all_lanes / 4)] += x - x;
        }
    }
    std::uint64_t num_bad = 0;
    for (std::uint32_t lane = 0; lane < all_lanes; ++lane) {
        if (bad[lane / 4][lane % 4] == 0) {
            continue;
        }
        num_bad += (execution_->asked_mask >> lane & 1U) != 0 ? 1 : 0;
        for (const sl_variable id : results) {
            for (int k = 0; k < 3 && batch_.has(id); ++k) {
                batch_.plane(id, k)[lane] = 0;
            }
        }
    }
    if (num_bad > 0) {
        asker_->thread->counters.add(Counter::bad_values, num_bad);
        asker_->thread->bad.note(*info_->shader, BadResult::Light, num_bad);
    }
}

// Takes the results of these lanes out of the batch.
void LightRun::collect(std::uint32_t mask, LightSample& sample) {
    const std::uint32_t taken = info_->is_constant ? ~0U : mask;
    const float share = spreads_ ? 1.0f / static_cast<float>(info_->num_samples) : 1.0f;
    const auto take = [&](sl_variable id, float* to, float fallback, const auto& changed) {
        for (std::uint32_t k = 0; k < 3; ++k) {
            const float* plane = batch_.plane(id, static_cast<int>(k));
            for (std::uint32_t lane = 0; lane < all_lanes; ++lane) {
                const float value = plane != nullptr ? changed(plane[lane], lane) : fallback;
                float& out = to[k * all_lanes + lane];
                out = (taken >> lane & 1U) != 0 ? value : out;
            }
        }
    };
    take(SL_VAR_L, sample.L, 0, [](float x, std::uint32_t) { return -x; });
    take(SL_VAR_Cl, sample.Cl, 0,
         [&](float x, std::uint32_t lane) { return x * weight_[lane] * share; });
    take(SL_VAR_Ol, sample.Ol, 1, [](float x, std::uint32_t) { return x; });
    for_lanes(taken & ((1U << all_lanes) - 1), [&](std::uint32_t lane) {
        sample.nondiffuse[lane] = param(info_->nondiffuse, lane);
        sample.nonspecular[lane] = param(info_->nonspecular, lane);
    });
    sample.lit = (sample.lit & ~taken) | (executed() & taken);
    sample.known |= taken;
    sample.traced &= ~taken;
}

float LightRun::param(int index, std::uint32_t lane) {
    if (index < 0) {
        return 0;
    }
    if (const float* plane = batch_.param_plane(index)) {
        return plane[lane];
    }
    const float* uniform = batch_.param_uniform(index);
    return uniform != nullptr ? *uniform : 0;
}

} // namespace trace
