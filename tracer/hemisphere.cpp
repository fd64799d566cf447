// SPDX-License-Identifier: Apache-2.0
#include "tracer/hemisphere.h"

#include "tracer/asking_point.h"
#include "tracer/diffuse_rays.h"
#include "tracer/execution.h"
#include "tracer/hemisphere_samples.h"
#include "tracer/services.h"
#include "tracer/texture_frame.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <string_view>

namespace trace {

namespace {

constexpr std::uint32_t lanes_max = SL_LANES_MAX;
constexpr std::uint32_t packet_size = geo::RayPacket::size;
// More would only cost: the error of 65,536 stratified rays is below what a picture shows.
constexpr std::uint32_t max_samples = 1U << 16;
constexpr float default_error = 0.02f; // of adaptive estimates that name none
constexpr float pi = 3.14159265358979324f;

std::uint32_t count_of(float number) {
    return number >= 1 ? static_cast<std::uint32_t>(std::min(number, float{max_samples})) : 0;
}

// Cells are visited in an order whose every beginning is spread over all of them: steps of the
// golden section of their number, made coprime to it.
class CellOrder {
public:
    explicit CellOrder(std::uint32_t count) : count_(count) {
        while (std::gcd(step_ = next_step(), count_) != 1) {
        }
    }
    [[nodiscard]] std::uint32_t operator[](std::uint32_t i) const {
        return static_cast<std::uint32_t>(std::uint64_t{i} * step_ % count_);
    }

private:
    std::uint32_t next_step() {
        return static_cast<std::uint32_t>(0.618034 * static_cast<double>(count_)) + ++tries_;
    }
    std::uint32_t count_, tries_ = 0, step_ = 1;
};

// One lane's question and what its rays have told so far.
struct Lane {
    base::V3f P, N;
    HemisphereFrame frame;
    HemisphereStrata strata;
    HemisphereCone cone;
    std::uint32_t index = 0, seed = 0, done = 0, goal = 0;
    float max_distance = 0, bias = 0, falloff = 0, max_error = 0;
    bool by_power = false;

    double covered = 0, covered2 = 0; // sums over rays, and of squares
    base::V3d open_direction;
    double light[3] = {}, sky[3] = {};
};

class Answer {
public:
    Answer(Execution& execution, sl_ray_query& query);
    void run();

private:
    void begin_lane(std::uint32_t index);
    [[nodiscard]] float option(int id, std::uint32_t lane) const { return query_.option[id][lane]; }
    [[nodiscard]] std::uint32_t first_round(const Lane& lane) const;
    [[nodiscard]] bool is_settled(const Lane& lane) const;
    void ask(Lane& lane, std::uint32_t begin, std::uint32_t end);
    void add_ray(const Lane& lane, std::uint32_t cell);
    void take(Lane& lane, std::size_t ray);
    void take_block(Lane& lane);
    [[nodiscard]] float weight_of(const Lane& lane, float distance) const;
    void look_up(const std::uint32_t* rays, std::uint32_t count, Lane& lane);
    void store(const Lane& lane);
    void store_channel(sl_ray_channel& channel, const Lane& lane) const;

    Execution& execution_;
    sl_ray_query& query_;
    bool shades_;
    RayFilter filter_;
    sl_string map_;
    base::Mat4 map_from_current_, asked_from_current_;
    std::vector<Lane> lanes_;
    DiffuseRays rays_;
    std::vector<base::V3f> directions_;
};

base::Mat4 space_from_current(Execution& execution, sl_string name) {
    float m[16 * lanes_max] = {};
    service_table().space(&execution, nullptr, name, 0, m);
    return base::Mat4::from_rows(m);
}

Answer::Answer(Execution& execution, sl_ray_query& query)
    : execution_(execution), query_(query),
      shades_(query.kind == SL_RAYS_indirect), filter_{query.text[SL_RAY_TEXT_subset],
                                                       query.text[SL_RAY_TEXT_hitsides]},
      map_(query.text[SL_RAY_TEXT_environmentmap]) {
    if (map_ != nullptr && (*map_ == '\0' || execution.frame.textures == nullptr)) {
        map_ = nullptr;
    }
    const sl_string space = query.text[SL_RAY_TEXT_coordsystem];
    if (space != nullptr) {
        asked_from_current_ = space_from_current(execution, space);
    }
    if (map_ != nullptr) {
        map_from_current_ =
            space != nullptr
                ? asked_from_current_
                : space_from_current(execution, execution.frame.strings.intern("world"));
    }
}

void Answer::begin_lane(std::uint32_t index) {
    const std::uint32_t n = query_.lanes;
    const auto triple = [&](const float* planes) {
        return base::V3f(planes[index], planes[n + index], planes[2 * n + index]);
    };
    Lane lane;
    lane.index = index;
    lane.P = triple(query_.P);
    lane.N = base::normalize(triple(query_.D));
    if (!(base::dot(lane.N, lane.N) > 0.5f)) {
        return; // no direction, no cone: what store() finds is 0
    }
    lane.frame = HemisphereFrame::about(lane.N);
    const sl_string distribution = query_.text[SL_RAY_TEXT_distribution];
    const bool is_uniform = distribution != nullptr && std::string_view(distribution) == "uniform";
    lane.cone =
        HemisphereCone::of(option(SL_RAY_OPTION_coneangle, index),
                           is_uniform ? HemisphereDensity::Uniform : HemisphereDensity::Cosine);
    lane.strata =
        HemisphereStrata::of(std::max(count_of(option(SL_RAY_OPTION_samples, index)), 1U));
    lane.goal = lane.strata.count();
    lane.max_distance = option(SL_RAY_OPTION_maxdist, index);
    lane.bias = option(SL_RAY_OPTION_bias, index);
    lane.falloff = option(SL_RAY_OPTION_falloff, index);
    lane.by_power = option(SL_RAY_OPTION_falloffmode, index) != 0;
    const float error = option(SL_RAY_OPTION_maxerror, index);
    lane.max_error = error > 0 ? error : default_error;
    lane.seed = point_seed(execution_, query_.first + index) ^ 0x68656d69U;
    lanes_.push_back(lane);
}

std::uint32_t Answer::first_round(const Lane& lane) const {
    const std::uint32_t least = count_of(option(SL_RAY_OPTION_minsamples, lane.index));
    return least > 0 && !shades_ ? std::min(least, lane.goal) : lane.goal;
}

// The standard error as if the rays were independent; strata make it less.
bool Answer::is_settled(const Lane& lane) const {
    const double n = lane.done, mean = lane.covered / n;
    const double variance = std::max(lane.covered2 / n - mean * mean, 0.0);
    const double tolerated = static_cast<double>(lane.max_error);
    return variance <= tolerated * tolerated * n;
}

void Answer::run() {
    for (std::uint32_t rest = query_.mask; rest != 0; rest &= rest - 1) {
        begin_lane(static_cast<std::uint32_t>(std::countr_zero(rest)));
    }
    for (Lane& lane : lanes_) {
        for (std::uint32_t end = first_round(lane); lane.done < lane.goal;
             end = std::min(2 * end, lane.goal)) {
            ask(lane, lane.done, end);
            lane.done = end;
            if (end < lane.goal && is_settled(lane)) {
                break;
            }
        }
        store(lane);
    }
}

// A packet's worth of rays of one lane at a time stays near the surface; light is gathered in
// larger blocks, since what is met is shaded.
void Answer::ask(Lane& lane, std::uint32_t begin, std::uint32_t end) {
    const std::uint32_t block = shades_ ? 4096 : 256;
    const bool in_order = begin == 0 && end == lane.goal;
    const CellOrder order(lane.goal);
    for (; begin < end; begin += block) {
        rays_.clear();
        directions_.clear();
        for (std::uint32_t i = begin; i < std::min(begin + block, end); ++i) {
            add_ray(lane, in_order ? i : order[i]);
        }
        take_block(lane);
    }
}

void Answer::add_ray(const Lane& lane, std::uint32_t cell) {
    SampleStream stream(lane.seed + 0x9e3779b9U * cell);
    const float jitter = option(SL_RAY_OPTION_samplebase, lane.index);
    const auto place = [&] {
        return 0.5f + std::clamp(jitter, 0.0f, 1.0f) * (stream.next() - 0.5f);
    };
    const float x = place(), y = place();
    const base::V3f local = direction_in(lane.strata, lane.cone, cell, x, y);
    const base::V3f direction = lane.frame.from_local(local.x, local.y, local.z);
    DiffuseRays::Ray ray;
    ray.origin = ray_origin(execution_, query_.first + lane.index, lane.P, direction) +
                 lane.bias * direction;
    ray.direction = direction;
    ray.max_distance = lane.max_distance;
    ray.time = point_time(execution_, query_.first + lane.index);
    ray.medium = point_medium(execution_, query_.first + lane.index);
    ray.seed = stream.next_bits();
    rays_.add(ray);
    directions_.push_back(direction);
}

float Answer::weight_of(const Lane& lane, float distance) const {
    if (lane.falloff == 0) {
        return 1;
    }
    return lane.by_power ? std::pow(std::max(1 - distance / lane.max_distance, 0.0f), lane.falloff)
                         : std::exp(-lane.falloff * distance);
}

void Answer::take_block(Lane& lane) {
    const float spread = std::sqrt(2 / static_cast<float>(lane.goal)); // of 2 pi over all rays
    const DiffuseRays::Asker asker{execution_.frame,
                                   *execution_.thread,
                                   execution_.ray_level,
                                   diffuse_level(execution_),
                                   spread,
                                   filter_};
    if (shades_) {
        rays_.shade(asker);
    } else if (lane.falloff == 0 && filter_.is_empty()) {
        rays_.occlude(asker);
    } else {
        rays_.intersect(asker);
    }
    std::uint32_t open[packet_size], num_open = 0;
    for (std::size_t ray = 0; ray < rays_.size(); ++ray) {
        take(lane, ray);
        if (rays_.distance(ray) == DiffuseRays::nothing && map_ != nullptr) {
            open[num_open++] = static_cast<std::uint32_t>(ray);
        }
        if (num_open == packet_size || (num_open > 0 && ray + 1 == rays_.size())) {
            look_up(open, num_open, lane);
            num_open = 0;
        }
    }
}

void Answer::take(Lane& lane, std::size_t ray) {
    const float distance = rays_.distance(ray);
    const bool is_open = distance == DiffuseRays::nothing;
    const double weight = is_open ? 0 : static_cast<double>(weight_of(lane, distance));
    lane.covered += weight;
    lane.covered2 += weight * weight;
    if (is_open) {
        lane.open_direction += base::V3d(directions_[ray]);
    }
    if (shades_) {
        const base::Color& c = rays_.radiance(ray);
        lane.light[0] += static_cast<double>(c.r);
        lane.light[1] += static_cast<double>(c.g);
        lane.light[2] += static_cast<double>(c.b);
    }
}

// Rays that met nothing see the environment map, filtered over what one ray stands for.
void Answer::look_up(const std::uint32_t* rays, std::uint32_t count, Lane& lane) {
    sl_map_query map = {};
    map.kind = SL_MAP_environment;
    map.num_channels = 3;
    map.first = query_.first;
    map.lanes = packet_size;
    map.mask = (1U << count) - 1;
    const float step = std::sqrt(2 * pi / static_cast<float>(lane.goal));
    for (std::uint32_t i = 0; i < count; ++i) {
        const base::V3d d = base::vector(map_from_current_, base::V3d(directions_[rays[i]]));
        const HemisphereFrame across = HemisphereFrame::about(base::V3f(base::normalize(d)));
        map.name[i] = map_;
        for (std::uint32_t k = 0; k < 3; ++k) {
            map.at[k * packet_size + i] = static_cast<float>(d[static_cast<int>(k)]);
            map.du[k * packet_size + i] = step * across.x[static_cast<int>(k)];
            map.dv[k * packet_size + i] = step * across.y[static_cast<int>(k)];
        }
        map.option[SL_MAP_OPTION_swidth][i] = map.option[SL_MAP_OPTION_twidth][i] = 1;
    }
    float result[3 * packet_size] = {};
    service_table().map(&execution_, &map, result);
    for (std::uint32_t i = 0; i < count; ++i) {
        for (std::uint32_t k = 0; k < 3; ++k) {
            lane.sky[k] += static_cast<double>(result[k * packet_size + i]);
        }
    }
}

void Answer::store(const Lane& lane) {
    const double n = std::max(lane.done, 1U);
    for (std::uint32_t k = 0; k < 3; ++k) {
        query_.C[k * query_.lanes + lane.index] =
            static_cast<float>(shades_  ? (lane.light[k] + lane.sky[k]) / n
                               : k == 0 ? lane.covered / n
                                        : 0.0);
    }
    query_.hit |= lane.covered > 0 ? 1U << lane.index : 0;
    for (std::int32_t i = 0; i < query_.num_channels; ++i) {
        if (query_.channel[i].is_sent == 0) {
            store_channel(query_.channel[i], lane);
        }
    }
}

void Answer::store_channel(sl_ray_channel& channel, const Lane& lane) const {
    const std::string_view name = channel.name;
    const double n = std::max(lane.done, 1U);
    const auto put = [&](std::uint32_t k, double value) {
        channel.values[k * query_.lanes + lane.index] = static_cast<float>(value);
    };
    if (name == "occlusion" && channel.type == SL_TYPE_float) {
        put(0, lane.covered / n);
    } else if (name == "environmentdir" && channel.type != SL_TYPE_float) {
        const base::V3d d = base::normalize(base::vector(asked_from_current_, lane.open_direction));
        put(0, d.x), put(1, d.y), put(2, d.z);
    } else if (name == "environmentcolor" && channel.type != SL_TYPE_float) {
        put(0, lane.sky[0] / n), put(1, lane.sky[1] / n), put(2, lane.sky[2] / n);
    } else {
        return;
    }
    channel.set |= 1U << lane.index;
}

} // namespace

void answer_hemisphere(Execution& execution, sl_ray_query& query) {
    query.hit = 0;
    for (std::uint32_t k = 0; k < 3 * query.lanes; ++k) {
        query.C[k] = 0;
    }
    if (execution.thread != nullptr && execution.frame.world != nullptr) {
        Answer(execution, query).run();
    }
}

} // namespace trace
