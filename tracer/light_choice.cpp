// SPDX-License-Identifier: Apache-2.0
#include "tracer/light_choice.h"

#include "tracer/area_light.h"
#include "tracer/light_run.h"
#include "tracer/lights.h"
#include "tracer/shader_set.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <string_view>

namespace trace {

namespace {

// Share of the probability that is dealt out evenly: a light no probe saw is chosen all the same.
constexpr double even_share = 0.1;
// Cells along the box of all lights, at the finest level; outside cells double with the distance.
constexpr float cells_across = 32;
constexpr std::uint32_t num_probes = SL_LANES_MAX;
constexpr int everywhere = 6; // facing; 0..5: the faces of a cube

std::uint32_t number(const rib::Options& options, const char* name, std::uint32_t fallback) {
    const auto it = options.user.find(name);
    if (it == options.user.end()) {
        return fallback;
    }
    const rib::Param& p = it->second;
    const double given = !p.ints.empty()     ? p.ints.front()
                         : !p.floats.empty() ? static_cast<double>(p.floats.front())
                                             : fallback;
    return static_cast<std::uint32_t>(std::clamp(given, 0.0, 1e6));
}

int facing_of(const base::V3f* axis) {
    if (axis == nullptr) {
        return everywhere;
    }
    int longest = 0;
    for (int k = 1; k < 3; ++k) {
        longest = std::fabs((*axis)[k]) > std::fabs((*axis)[longest]) ? k : longest;
    }
    return 2 * longest + ((*axis)[longest] < 0 ? 1 : 0);
}

base::V3f axis_of(int facing) {
    base::V3f axis;
    axis[facing / 2] = facing % 2 == 0 ? 1.0f : -1.0f;
    return axis;
}

// Ten bits of each coordinate in turns.
std::uint64_t interleaved(const base::V3f& at) {
    std::uint64_t code = 0;
    for (int k = 0; k < 3; ++k) {
        const auto x = static_cast<std::uint32_t>(std::clamp(at[k], 0.0f, 1.0f) * 1023);
        for (unsigned b = 0; b < 10; ++b) {
            code |= std::uint64_t{x >> b & 1U} << (3 * b + static_cast<unsigned>(k));
        }
    }
    return code;
}

float luminance(const LightSample& sample, std::uint32_t lane) {
    const float* Cl = sample.Cl + lane;
    return std::max(0.0f, Cl[0] + Cl[LightSample::lanes] + Cl[2 * LightSample::lanes]);
}

base::V3f direction(const LightSample& sample, std::uint32_t lane) {
    return {sample.L[lane], sample.L[LightSample::lanes + lane],
            sample.L[2 * LightSample::lanes + lane]};
}

} // namespace

// Runs lights for points that nobody shades; what it counts and prints is nobody's.
class LightProber {
public:
    explicit LightProber(const FrameContext& frame) : frame_(frame) {}

    // Sample 0 of a light at num_probes points, planes. Returns the lanes that are lit.
    std::uint32_t run(rib::LightId id, const float* P) {
        Execution asker(frame_, *(*frame_.lights)[id].shader);
        asker.thread = &thread_;
        asker.serial = ++thread_.batch_serial;
        LightRun& run = attached(asker, id);
        sl_light_query query = {};
        query.lanes = asker.lanes();
        query.mask = (1U << query.lanes) - 1;
        float points[3 * SL_LANES_MAX];
        for (std::uint32_t k = 0; k < 3; ++k) {
            std::copy_n(P + k * num_probes, query.lanes, points + k * query.lanes);
        }
        query.P = points;
        const std::uint32_t lit = run.illuminate(query);
        sample_ = &run.sample(0);
        num_samples_ = run.num_samples();
        return lit;
    }
    // Of the last run.
    [[nodiscard]] const LightSample& sample() const { return *sample_; }
    [[nodiscard]] std::int32_t num_samples() const { return num_samples_; }

private:
    const FrameContext& frame_;
    ThreadState thread_;
    const LightSample* sample_ = nullptr;
    std::int32_t num_samples_ = 1;
};

LightChoiceOptions light_choice_options(const rib::Options& options) {
    LightChoiceOptions o;
    o.samples = number(options, "lights:samples", o.samples);
    o.all_up_to = number(options, "lights:allupto", o.all_up_to);
    return o;
}

// --- tables

void LightTable::pick(float u, std::vector<Pick>& out) const {
    for (const Item& item : certain) {
        out.push_back({item.index, 1});
    }
    if (others.empty()) {
        return;
    }
    auto at = others.begin();
    for (float wanted = u; wanted < others.back().up_to; wanted += 1) {
        at = std::upper_bound(at, others.end(), wanted,
                              [](float x, const Item& item) { return x < item.up_to; });
        if (at == others.end()) {
            break;
        }
        out.push_back({at->index, 1 / at->probability});
    }
}

LightCells::LightCells(const FrameContext& frame, LightChoiceOptions options) : options_(options) {
    find_positions(frame);
}

LightCells::~LightCells() = default;

bool LightCells::is_many(const LightList& list) const {
    return options_.samples > 0 && list.directional.size() > options_.all_up_to;
}

// Where the lights are: from the origin, where the light comes from. A cone that points elsewhere
// keeps the place of its shader space.
void LightCells::find_positions(const FrameContext& frame) {
    std::vector<base::V3f> places(frame.lights->size());
    base::V3f high(-std::numeric_limits<float>::infinity());
    low_ = base::V3f(std::numeric_limits<float>::infinity());
    LightProber prober(frame);
    for (rib::LightId id = 0; id < places.size(); ++id) {
        const LightInfo& light = (*frame.lights)[id];
        if (light.shader == nullptr || !light.directional || light.from_infinity) {
            continue;
        }
        const float P[3 * num_probes] = {};
        const std::uint32_t lit = prober.run(id, P);
        const base::V3d origin = point(light.shader->camera_from_shader, base::V3d());
        places[id] = (lit & 1U) != 0 ? direction(prober.sample(), 0) : base::V3f(origin);
        for (int k = 0; k < 3; ++k) {
            low_[k] = std::min(low_[k], places[id][k]);
            high[k] = std::max(high[k], places[id][k]);
        }
    }
    const base::V3f extent = high - low_;
    const float longest = std::max({extent.x, extent.y, extent.z});
    const bool is_box = longest > 0 && longest < std::numeric_limits<float>::infinity();
    low_ = is_box ? low_ : base::V3f();
    edge_ = is_box ? longest / cells_across : 1;
    size_of_all_ = is_box ? extent : base::V3f(1);
    for (const base::V3f& place : places) {
        const base::V3f at = (place - low_) * (1 / (edge_ * cells_across));
        place_.push_back(interleaved(at));
    }
}

std::size_t LightCells::KeyHash::operator()(const Key& key) const {
    std::size_t h = std::hash<const void*>()(key.list);
    for (const std::int32_t x : {key.level, key.x, key.y, key.z, key.facing}) {
        h = h * 0x9e3779b97f4a7c15ULL + static_cast<std::uint32_t>(x);
        h ^= h >> 29;
    }
    return h;
}

LightCells::Key LightCells::key_of(const LightList& list, const base::V3f& P,
                                   const base::V3f* axis) const {
    float outside = 0; // distance from the box
    for (int k = 0; k < 3; ++k) {
        outside = std::max({outside, low_[k] - P[k], P[k] - low_[k] - size_of_all_[k]});
    }
    const float cells_off = outside / (edge_ * cells_across);
    Key key{&list, 0, 0, 0, 0, facing_of(axis)};
    if (cells_off < 1e9f) {
        key.level = cells_off > 0.125f ? std::ilogb(cells_off * 8) : 0;
        const float edge = std::ldexp(edge_, key.level);
        const auto cell = [&](int k) {
            return static_cast<std::int32_t>(std::floor((P[k] - low_[k]) / edge));
        };
        key.x = cell(0), key.y = cell(1), key.z = cell(2);
    } else {
        key.level = 64; // somewhere far off, or not a number
    }
    return key;
}

const LightTable& LightCells::table(LightProber& prober, const LightList& list, const base::V3f& P,
                                    const base::V3f* axis) const {
    const Key key = key_of(list, P, axis);
    {
        const std::lock_guard lock(mutex_);
        if (const auto it = tables_.find(key); it != tables_.end()) {
            return *it->second;
        }
    }
    std::unique_ptr<LightTable> made = make(prober, list, key); // equal, whoever comes first
    const std::lock_guard lock(mutex_);
    return *tables_.try_emplace(key, std::move(made)).first->second;
}

// The root mean square over the probes: a light that is bright in a corner of the cell counts.
std::vector<double> LightCells::expected(LightProber& prober, const LightList& list,
                                         const Key& key) const {
    const float edge = std::ldexp(edge_, std::min<int>(key.level, 40));
    float P[3 * num_probes];
    for (std::uint32_t i = 0; i < num_probes; ++i) {
        const std::int32_t cell[] = {key.x, key.y, key.z};
        for (std::uint32_t k = 0; k < 3; ++k) {
            const float in_cell = (i >> k & 1U) != 0 ? 0.8f : 0.2f;
            P[k * num_probes + i] =
                low_[static_cast<int>(k)] + (static_cast<float>(cell[k]) + in_cell) * edge;
        }
    }
    std::vector<double> all;
    all.reserve(list.directional.size());
    for (const rib::LightId id : list.directional) {
        const std::uint32_t lit = prober.run(id, P);
        const LightSample& sample = prober.sample();
        double sum = 0;
        for (std::uint32_t rest = lit; rest != 0; rest &= rest - 1) {
            const auto lane = static_cast<std::uint32_t>(std::countr_zero(rest));
            double value = static_cast<double>(luminance(sample, lane)) * prober.num_samples();
            if (key.facing != everywhere) {
                // Faces differ from the axis by up to 55 degrees.
                const base::V3f L = base::normalize(direction(sample, lane));
                const float cosine = base::dot(L, axis_of(key.facing));
                value *= static_cast<double>(std::max(0.0f, 0.25f + 0.75f * cosine));
            }
            sum += value * value;
        }
        all.push_back(std::sqrt(sum / num_probes));
    }
    return all;
}

std::unique_ptr<LightTable> LightCells::make(LightProber& prober, const LightList& list,
                                             const Key& key) const {
    std::vector<double> weight = expected(prober, list, key);
    double sum = 0;
    for (const double w : weight) {
        sum += w;
    }
    const auto n = static_cast<double>(weight.size());
    const double floor = sum > 0 ? even_share * sum / n : 1;
    sum = 0;
    for (double& w : weight) {
        w += floor;
        sum += w;
    }
    // Lights whose probability would exceed 1 are certain; what is left is shared by the others.
    std::vector<std::uint32_t> order(weight.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) {
        order[i] = i;
    }
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return weight[a] != weight[b] ? weight[a] > weight[b] : a < b;
    });
    auto table = std::make_unique<LightTable>();
    double left = options_.samples;
    std::size_t num_certain = 0;
    while (num_certain < order.size() && left >= 1 && weight[order[num_certain]] * left >= sum) {
        table->certain.push_back({order[num_certain], 0, 1});
        sum -= weight[order[num_certain++]];
        left -= 1;
    }
    // At least a few: the floor must mean something.
    left = std::max(left, 0.25 * options_.samples);
    std::vector<std::uint32_t> others(order.begin() + static_cast<std::ptrdiff_t>(num_certain),
                                      order.end());
    std::sort(others.begin(), others.end(), [&](std::uint32_t a, std::uint32_t b) {
        const std::uint64_t pa = place_[list.directional[a]], pb = place_[list.directional[b]];
        return pa != pb ? pa < pb : a < b;
    });
    double up_to = 0;
    for (const std::uint32_t i : others) {
        const double probability = std::min(1.0, left * weight[i] / sum);
        up_to += probability;
        table->others.push_back({i, static_cast<float>(up_to), static_cast<float>(probability)});
    }
    return table;
}

// --- choices of a packet

LightChoice::LightChoice() = default;
LightChoice::~LightChoice() = default;

bool LightChoice::is_known(const Execution& execution, const sl_light_query& query) const {
    const std::uint64_t serial = execution.serial;
    if (execution_ != &execution || serial_ != serial || first_ != query.first ||
        (query.mask & ~mask_) != 0 || has_axis_ != (query.axis != nullptr)) {
        return false;
    }
    for (std::uint32_t rest = query.mask; rest != 0; rest &= rest - 1) {
        const auto lane = static_cast<std::uint32_t>(std::countr_zero(rest));
        for (std::uint32_t at = lane; at < 3 * query.lanes; at += query.lanes) {
            if (query.P[at] != P_[at] || (has_axis_ && query.axis[at] != axis_[at])) {
                return false;
            }
        }
    }
    return true;
}

void LightChoice::choose_lane(const Execution& execution, const sl_light_query& query,
                              std::uint32_t lane) {
    const auto at = [&](const float* planes) {
        return base::V3f(planes[lane], planes[query.lanes + lane], planes[2 * query.lanes + lane]);
    };
    const base::V3f P = at(query.P);
    const base::V3f axis = query.axis != nullptr ? at(query.axis) : base::V3f();
    // A narrow or wide cone says little of where the point faces.
    const bool is_half_space = query.axis != nullptr && query.cosangle[lane] == 0;
    const LightList& list = *execution.subject->lights;
    const LightTable& table =
        execution.frame.lights->cells()->table(*prober_, list, P, is_half_space ? &axis : nullptr);
    const std::uint32_t seed = seed_of(execution, query.first + lane);
    const std::uint32_t h = light_seed(seed, 0x11947, P);
    picks_.clear();
    table.pick(static_cast<float>(h >> 8) * 0x1p-24f, picks_);
    for (const LightTable::Pick& pick : picks_) {
        pairs_.push_back({pick.index, lane, pick.weight});
    }
}

const std::vector<LightChoice::Chosen>* LightChoice::choose(const Execution& execution,
                                                            const sl_light_query& query) {
    const LightCells* cells = execution.frame.lights->cells();
    if (cells == nullptr || !cells->is_many(*execution.subject->lights) ||
        execution.subject->lights->asks_all) {
        return nullptr;
    }
    if (is_known(execution, query)) {
        return &chosen_;
    }
    if (!prober_) {
        prober_ = std::make_unique<LightProber>(execution.frame);
    }
    execution_ = &execution;
    serial_ = execution.serial;
    first_ = query.first;
    mask_ = query.mask;
    has_axis_ = query.axis != nullptr;
    std::copy_n(query.P, 3 * query.lanes, P_);
    std::copy_n(has_axis_ ? query.axis : query.P, 3 * query.lanes, axis_);
    pairs_.clear();
    for (std::uint32_t rest = query.mask; rest != 0; rest &= rest - 1) {
        choose_lane(execution, query, static_cast<std::uint32_t>(std::countr_zero(rest)));
    }
    std::sort(pairs_.begin(), pairs_.end(), [](const Pair& a, const Pair& b) {
        return a.index != b.index ? a.index < b.index : a.lane < b.lane;
    });
    chosen_.clear();
    for (const Pair& pair : pairs_) {
        if (chosen_.empty() || chosen_.back().index != static_cast<std::int32_t>(pair.index)) {
            chosen_.emplace_back().index = static_cast<std::int32_t>(pair.index);
        }
        chosen_.back().mask |= 1U << pair.lane;
        chosen_.back().weight[pair.lane] += pair.weight;
    }
    return &chosen_;
}

} // namespace trace
