// SPDX-License-Identifier: Apache-2.0
#include "tracer/transmission.h"

#include "tracer/area_light.h"
#include "tracer/light_run.h"
#include "tracer/pixel_trace.h"
#include "tracer/ray_levels.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <string_view>

namespace trace {

namespace {

using geo::ShadowMode;

constexpr std::uint32_t lanes = geo::RayPacket::size;
constexpr std::size_t most_layers = lanes * geo::Crossings::most;
// What a ray that starts anew every Crossings::most layers may pass: ten thousand layers, as the
// camera's do (bucket.cpp).
constexpr int most_turns = 10'000 / geo::Crossings::most;

template <class Body> void for_lanes(std::uint32_t mask, Body body) {
    for (std::uint32_t rest = mask; rest != 0; rest &= rest - 1) {
        body(static_cast<std::uint32_t>(std::countr_zero(rest)));
    }
}

// Layers of one turn, and the lanes they filter.
struct Layers {
    std::size_t count = 0;
    geo::Hit hits[most_layers];
    std::uint32_t lane[most_layers];

    void add(const geo::Hit& hit, std::uint32_t of_lane) {
        hits[count] = hit;
        lane[count++] = of_lane;
    }
};

class Transmission {
public:
    Transmission(const Execution& asker, ShadowRays& rays, float* T)
        : asker_(asker), world_(*asker.frame.world), rays_(rays), T_(T) {}

    void run() {
        Counters& counters = asker_.thread->counters;
        geo::RayPacket& packet = rays_.packet;
        const std::uint32_t asked = packet.active;
        counters.add(Counter::rays_shadow, static_cast<std::uint64_t>(std::popcount(asked)));
        for_lanes(asked, [&](std::uint32_t lane) { set(lane, 1); });
        if (!world_.filters_light()) {
            for_lanes(world_.occluded(packet) & asked, [&](std::uint32_t lane) { set(lane, 0); });
            return;
        }
        for (int turn = 0; packet.active != 0 && turn < most_turns; ++turn) {
            packet.active = pass();
        }
    }

private:
    const Execution& asker_;
    const geo::World& world_;
    ShadowRays& rays_;
    float* T_;

    void set(std::uint32_t lane, float value) {
        T_[lane] = T_[lanes + lane] = T_[2 * lanes + lane] = value;
    }
    [[nodiscard]] bool is_dark(std::uint32_t lane) const {
        return T_[lane] == 0 && T_[lanes + lane] == 0 && T_[2 * lanes + lane] == 0;
    }
    void filter(std::uint32_t lane, const float* opacity, std::size_t stride) {
        for (std::size_t k = 0; k < 3; ++k) {
            T_[k * lanes + lane] *= 1 - std::clamp(opacity[k * stride], 0.0f, 1.0f);
        }
    }

    // The next layers of all rays. Returns those that may meet more.
    std::uint32_t pass() {
        geo::RayPacket& packet = rays_.packet;
        geo::Crossings crossings;
        const std::uint32_t blocked = world_.occluded(packet, crossings) & packet.active;
        for_lanes(blocked, [&](std::uint32_t lane) { set(lane, 0); });
        const std::uint32_t open = packet.active & ~blocked;
        Layers plain, shaded;
        for_lanes(open, [&](std::uint32_t lane) {
            for (int i = 0; i < crossings.count[lane]; ++i) {
                const geo::Hit& hit = crossings.hits[lane][i];
                sort_in(hit, lane, plain, shaded);
            }
        });
        asker_.thread->counters.add(Counter::shadow_layers, plain.count + shaded.count);
        filter_plain(plain);
        filter_shaded(shaded);
        std::uint32_t more = 0;
        for_lanes(open & crossings.more, [&](std::uint32_t lane) {
            const geo::Hit& last = crossings.hits[lane][crossings.count[lane] - 1];
            packet.tnear[lane] = std::nextafter(last.t, std::numeric_limits<float>::infinity());
            more |= is_dark(lane) ? 0 : 1U << lane;
        });
        return more;
    }

    void sort_in(const geo::Hit& hit, std::uint32_t lane, Layers& plain, Layers& shaded) {
        switch (rays_.as.value_or(world_.shadow_mode(hit))) {
        case ShadowMode::None:
            break;
        case ShadowMode::Opaque:
            set(lane, 0);
            break;
        case ShadowMode::Os:
            plain.add(hit, lane);
            break;
        case ShadowMode::Shader:
            shaded.add(hit, lane);
            break;
        }
    }

    // By Os, attribute or primitive variable.
    void filter_plain(const Layers& layers) {
        if (layers.count == 0) {
            return;
        }
        float Os[3 * most_layers];
        sl_points points = {};
        points.var[SL_VAR_Os] = Os;
        world_.fill({layers.hits, layers.count}, {}, 1ULL << SL_VAR_Os, most_layers, points,
                    nullptr, nullptr);
        for (std::size_t i = 0; i < layers.count; ++i) {
            filter(layers.lane[i], Os + i, most_layers);
        }
    }

    // By Oi, nearest layers first: what lies behind an opaque place is not shaded.
    void filter_shaded(const Layers& layers) {
        if (asker_.thread->levels == nullptr) { // nothing can be shaded here
            filter_plain(layers);
            return;
        }
        std::uint32_t depth[lanes] = {}; // layers of a lane come in its order
        for (std::uint32_t next = 0; next < geo::Crossings::most; ++next) {
            Layers now;
            for (std::size_t i = 0; i < layers.count; ++i) {
                const std::uint32_t lane = layers.lane[i];
                if (i == 0 || layers.lane[i - 1] != lane) {
                    depth[lane] = 0;
                }
                if (depth[lane]++ == next && !is_dark(lane)) {
                    now.add(layers.hits[i], lane);
                }
            }
            if (now.count == 0) {
                return;
            }
            shade(now);
        }
    }

    void shade(const Layers& layers) {
        const DeeperShader deeper(*asker_.thread);
        ShadingRays rays;
        rays.packets = {&rays_.packet, 1};
        rays.ray = {layers.lane, layers.count};
        rays.seed = rays_.seed;
        rays.level = asker_.ray_level + 1;
        rays.kind = SL_RAY_shadow;
        const std::array<RayCone, lanes> cones{};
        rays.cones = cones;
        Sample shades[most_layers];
        deeper.hits().shade(rays, {layers.hits, layers.count}, {shades, layers.count}, {});
        for (std::size_t i = 0; i < layers.count; ++i) {
            filter(layers.lane[i], shades[i].opacity, 1);
        }
    }
};

} // namespace

void transmit(const Execution& asker, ShadowRays& rays, float* T) {
    Transmission(asker, rays, T).run();
}

// --- where shadow rays start and end

std::uint32_t seed_of(const Execution& execution, std::size_t point) {
    if (execution.subject != nullptr && point < execution.subject->rays.seeds.size()) {
        return execution.subject->rays.seeds[point];
    }
    return execution.batch != nullptr && point < execution.batch->count()
               ? execution.batch->seeds()[point]
               : 0;
}

const geo::Hit* hit_at(const Execution& asker, std::size_t point, const base::V3f& P) {
    const BatchSubject* subject = asker.subject;
    if (subject == nullptr || point >= subject->hits.size() || asker.batch == nullptr ||
        !asker.batch->has(SL_VAR_P) || !subject->hits[point].valid()) {
        return nullptr;
    }
    for (int k = 0; k < 3; ++k) {
        if (asker.batch->plane(SL_VAR_P, k)[point] != P[k]) {
            return nullptr;
        }
    }
    return &subject->hits[point];
}

const geo::SpawnPoint* ShadowOrigins::at(const Execution& asker, std::uint32_t first,
                                         std::uint32_t lane, const base::V3f& P) {
    const geo::Hit* hit = hit_at(asker, first + lane, P);
    if (hit == nullptr) {
        return nullptr;
    }
    if (asker_ != &asker || serial_ != asker.serial || first_ != first) {
        asker_ = &asker;
        serial_ = asker.serial;
        first_ = first;
        known_ = 0;
    }
    if ((known_ >> lane & 1U) == 0) {
        spawn_[lane] = asker.frame.world->spawn(*hit);
        known_ |= 1U << lane;
    }
    return &spawn_[lane];
}

// To a place on a surface the ray ends outside that surface's own error; to a point in space it
// ends short of it by the point's error.
geo::ShadowSegment LightRun::shadow_segment(const LightSample& sample, std::uint32_t lane,
                                            ShadowOrigins& origins) const {
    const base::V3f P = point(lane);
    const base::V3f L(sample.L[lane], sample.L[LightSample::lanes + lane],
                      sample.L[2 * LightSample::lanes + lane]);
    const geo::SpawnPoint* from = origins.at(*asker_, first_, lane, P);
    if (info_->from_infinity) {
        return {from != nullptr ? from->towards(L) : P, base::normalize(L),
                std::numeric_limits<float>::infinity()};
    }
    const base::V3f end = P + L;
    if (info_->area != nullptr) {
        const geo::SpawnPoint place = asker_->frame.world->spawn(sample.on[lane]);
        const float error = geo::far_end_error(end, L) + 2 * base::length(place.front - place.back);
        if (base::length(end - place.front) <= error) { // else the shader moved the light
            return from != nullptr ? geo::segment_between(*from, place) : geo::segment_to(P, place);
        }
    }
    return from != nullptr ? geo::segment_between(*from, end) : geo::segment_to(P, end);
}

void LightRun::trace_shadows(std::int32_t index, std::uint32_t mask, ShadowOrigins& origins) {
    LightSample& sample = sample_of(index);
    const std::uint32_t unknown = mask & ~sample.traced;
    if (unknown == 0) {
        return;
    }
    sample.traced |= unknown;
    ShadowRays rays;
    rays.packet = {};
    rays.packet.active = unknown;
    for_lanes(unknown, [&](std::uint32_t lane) {
        const auto [o, d, tfar] = shadow_segment(sample, lane, origins);
        geo::RayPacket& p = rays.packet;
        p.ox[lane] = o.x, p.oy[lane] = o.y, p.oz[lane] = o.z;
        p.dx[lane] = d.x, p.dy[lane] = d.y, p.dz[lane] = d.z;
        p.tnear[lane] = 0;
        p.tfar[lane] = tfar;
        p.time[lane] = time_of(lane);
        p.mask[lane] = geo::ShadowRay;
        rays.seed[lane] = light_seed(seed_[lane], id_ + 1, point(lane));
    });
    if (asker_->frame.world == nullptr) {
        std::fill_n(sample.passes, 3 * LightSample::lanes, 1.0f);
        return;
    }
    const geo::RayPacket asked = rays.packet;
    transmit(*asker_, rays, sample.passes);
    if (asker_->thread->trace != nullptr) {
        asker_->thread->trace->shadow_rays(first_, asked, sample.passes);
    }
}

// --- questions of shaders

namespace {

// The points of a light shader are those of who it lights.
struct Asked {
    const Execution& execution;
    std::uint32_t first;
};

Asked asked_points(const Execution& execution, std::uint32_t first) {
    return execution.asked_by != nullptr ? Asked{*execution.asked_by, execution.asked_first + first}
                                         : Asked{execution, first};
}

base::V3f at(const float* planes, std::uint32_t stride, std::uint32_t lane) {
    return {planes[lane], planes[stride + lane], planes[2 * stride + lane]};
}

std::optional<ShadowMode> hit_mode(sl_string text) {
    const std::string_view word = text != nullptr ? text : "";
    return word == "primitive" || word == "Os"   ? std::optional(ShadowMode::Os)
           : word == "none"                      ? std::optional(ShadowMode::None)
           : word == "opaque"                    ? std::optional(ShadowMode::Opaque)
           : word == "shader" || word == "shade" ? std::optional(ShadowMode::Shader)
                                                 : std::nullopt;
}

class Question {
public:
    Question(Execution& execution, sl_ray_query& query)
        : execution_(execution), query_(query), points_(asked_points(execution, query.first)) {}

    // One ray per lane, number `sample` of its cone.
    void ask(std::uint32_t sample) {
        rays_ = {};
        rays_.as = hit_mode(query_.text[SL_RAY_TEXT_hitmode]);
        rays_.packet.active = query_.mask & ((1U << query_.lanes) - 1);
        for_lanes(rays_.packet.active, [&](std::uint32_t lane) { aim(lane, sample); });
        float T[3 * lanes] = {};
        const geo::RayPacket asked = rays_.packet;
        transmit(execution_, rays_, T);
        for_lanes(asked.active, [&](std::uint32_t lane) {
            for (std::uint32_t k = 0; k < 3; ++k) {
                query_.C[k * query_.lanes + lane] += T[k * lanes + lane];
            }
        });
        if (execution_.thread->trace != nullptr) {
            execution_.thread->trace->shadow_rays(points_.first, asked, T);
        }
    }

private:
    Execution& execution_;
    sl_ray_query& query_;
    Asked points_;
    ShadowRays rays_{};

    [[nodiscard]] float option(int which, std::uint32_t lane) const {
        return query_.option[which][lane];
    }
    [[nodiscard]] std::uint32_t seed(std::uint32_t lane, const base::V3f& P) const {
        return light_seed(seed_of(points_.execution, points_.first + lane), 0x7ea1, P);
    }
    // An end of the ray that is the point being shaded starts outside its error.
    [[nodiscard]] base::V3f end(std::uint32_t lane, const base::V3f& P,
                                const base::V3f& towards) const {
        const geo::Hit* hit = hit_at(points_.execution, points_.first + lane, P);
        return hit != nullptr ? execution_.frame.world->spawn(*hit).towards(towards) : P;
    }

    void aim(std::uint32_t lane, std::uint32_t sample) {
        const bool is_segment = query_.kind == SL_RAYS_transmission;
        const bool is_endless =
            !is_segment && execution_.light != nullptr && execution_.light->info().from_infinity;
        const base::V3f P = at(query_.P, query_.lanes, lane);
        const base::V3f D = at(query_.D, query_.lanes, lane);
        base::V3f d = is_segment ? D - P : D;
        const base::V3f target = P + d;
        const base::V3f origin = end(lane, P, d);
        float tfar = std::numeric_limits<float>::infinity();
        if (!is_endless) {
            const base::V3f far = is_segment ? end(lane, D, P - D) : target;
            d = far - origin;
            tfar = far == target ? geo::segment_to(origin, far).tfar : 1;
        }
        const float length = base::length(d);
        const std::uint32_t point_seed = seed(lane, P);
        if (const float cone = option(SL_RAY_OPTION_samplecone, lane); cone > 0 && length > 0) {
            d = direction_in_cone(d / length, cone, light_pattern(point_seed, sample)) * length;
        }
        const float bias = option(SL_RAY_OPTION_bias, lane);
        const float reach = option(SL_RAY_OPTION_maxdist, lane);
        geo::RayPacket& p = rays_.packet;
        p.ox[lane] = origin.x, p.oy[lane] = origin.y, p.oz[lane] = origin.z;
        p.dx[lane] = d.x, p.dy[lane] = d.y, p.dz[lane] = d.z;
        p.tnear[lane] = length > 0 ? std::max(bias, 0.0f) / length : 0;
        p.tfar[lane] = length > 0 ? std::min(tfar, reach / length) : 0;
        const BatchSubject* subject = points_.execution.subject;
        const std::size_t point = points_.first + lane;
        p.time[lane] = subject != nullptr && point < subject->hits.size()
                           ? subject->hits[point].time
                           : execution_.frame.spaces.shutter_open();
        p.mask[lane] = geo::ShadowRay;
        rays_.seed[lane] = point_seed + sample;
    }
};

} // namespace

void answer_transmission(Execution& execution, sl_ray_query& query) {
    const std::size_t num_floats = 3 * std::size_t{query.lanes};
    query.hit = 0;
    if (execution.thread == nullptr || execution.frame.world == nullptr) {
        std::fill_n(query.C, num_floats, 1.0f);
        return;
    }
    std::fill_n(query.C, num_floats, 0.0f);
    constexpr float most = 4096;
    float wanted = 1;
    bool is_cone = false;
    for_lanes(query.mask & ((1U << query.lanes) - 1), [&](std::uint32_t lane) {
        wanted = std::max(wanted, query.option[SL_RAY_OPTION_samples][lane]);
        is_cone |= query.option[SL_RAY_OPTION_samplecone][lane] > 0;
    });
    const auto count = static_cast<std::uint32_t>(is_cone ? std::min(wanted, most) : 1);
    Question question(execution, query);
    for (std::uint32_t sample = 0; sample < count; ++sample) {
        question.ask(sample);
    }
    for (std::size_t i = 0; i < num_floats; ++i) {
        query.C[i] /= static_cast<float>(count);
    }
    for_lanes(query.mask & ((1U << query.lanes) - 1), [&](std::uint32_t lane) {
        const bool passes = query.C[lane] > 0 || query.C[query.lanes + lane] > 0 ||
                            query.C[2 * query.lanes + lane] > 0;
        query.hit |= passes ? 0 : 1U << lane;
    });
}

} // namespace trace
