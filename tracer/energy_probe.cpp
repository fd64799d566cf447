// SPDX-License-Identifier: Apache-2.0
#include "tracer/energy_probe.h"

#include "tracer/execution.h"
#include "tracer/lights.h"
#include "tracer/services.h"
#include "tracer/shader_set.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <vector>

namespace trace {

namespace {

constexpr float very_far = 1e30f;

class ProbeExecution : public Execution {
public:
    ProbeExecution(const FrameContext& frame_, const ShaderEntry& running_,
                   const ProbeLight& light_)
        : Execution(frame_, running_), light(light_) {}
    const ProbeLight& light;
};

ProbeExecution& of(void* engine) {
    return static_cast<ProbeExecution&>(*static_cast<Execution*>(engine));
}

int32_t light_count(void* engine) {
    return of(engine).light.has_light ? 1 : 0;
}

bool in_cone(const sl_light_query& query, std::uint32_t lane, const base::V3f& L) {
    if (query.axis == nullptr) {
        return true;
    }
    const std::uint32_t n = query.lanes;
    const base::V3f axis(query.axis[lane], query.axis[n + lane], query.axis[2 * n + lane]);
    return base::dot(L, axis) >= query.cosangle[lane] * base::length(axis);
}

uint32_t light(void* engine, const sl_light_query* query, sl_light_result* result) {
    const ProbeLight& probe = of(engine).light;
    result->more = 0;
    result->next = query->index + 1;
    if (!probe.has_light || query->index != 0 ||
        (query->category != nullptr && !in_category({}, query->category))) {
        return 0;
    }
    std::uint32_t reached = 0;
    for (std::uint32_t lane = 0; lane < query->lanes; ++lane) {
        for (std::uint32_t k = 0; k < 3; ++k) {
            const std::uint32_t at = k * query->lanes + lane;
            result->L[at] = probe.to_light[static_cast<int>(k)];
            result->Cl[at] = result->Ol[at] = 1;
        }
        result->nondiffuse[lane] = result->nonspecular[lane] = 0;
        reached |= in_cone(*query, lane, probe.to_light) ? 1U << lane : 0;
    }
    return reached & query->mask;
}

uint32_t light_message(void*, const sl_light_query*, sl_string, int32_t, int32_t, float*) {
    return 0;
}

void ambient(void* engine, uint32_t /*first*/, uint32_t /*mask*/, const float* /*P*/, float* C) {
    const Execution& execution = of(engine);
    std::fill_n(C, 3 * execution.lanes(), of(engine).light.ambient);
}

// Nothing is near; what comes from far away is even.
void answer(const ProbeLight& light, sl_ray_query& query) {
    const bool passes = query.kind == SL_RAYS_transmission || query.kind == SL_RAYS_shadow;
    const bool sees = query.kind == SL_RAYS_trace || query.kind == SL_RAYS_fulltrace ||
                      query.kind == SL_RAYS_indirect;
    query.hit = 0;
    std::fill_n(query.C, 3 * query.lanes, passes ? 1.0f : sees ? light.surroundings : 0.0f);
    std::fill_n(query.distance, query.lanes, very_far);
    std::fill_n(query.Phit, 3 * query.lanes, 0.0f);
    std::fill_n(query.Nhit, 3 * query.lanes, 0.0f);
    std::copy_n(query.P, 3 * query.lanes, query.Pmiss);
    std::copy_n(query.D, 3 * query.lanes, query.Rmiss);
    std::fill_n(query.level_missed, query.lanes, 1.0f);
}

void rays(void* engine, sl_ray_query* query) {
    answer(of(engine).light, *query);
}

uint32_t bake(void*, const sl_point_query* query) {
    return query->mask; // into files of nobody
}

const sl_services& probe_services() {
    static const sl_services table = [] {
        sl_services services = service_table();
        services.light_count = light_count;
        services.light = light;
        services.light_message = light_message;
        services.ambient = ambient;
        services.rays = rays;
        services.bake = bake;
        return services;
    }();
    return table;
}

// False: the shader does not end.
bool run(rt::ShadeBatch& batch, ProbeExecution& execution) {
    constexpr int max_rounds = 10'000;
    const rt::ShadeContext context{&probe_services(), static_cast<Execution*>(&execution)};
    for (int round = 0; round < max_rounds; ++round) {
        if (batch.run(context) == 0) {
            return true;
        }
        for (std::uint32_t packet = 0; packet < batch.num_packets(); ++packet) {
            if (sl_ray_query* query = batch.request(packet)) {
                answer(execution.light, *query);
            }
        }
    }
    return false;
}

bool is_number(const base::Color& c) {
    return std::isfinite(c.r) && std::isfinite(c.g) && std::isfinite(c.b);
}

} // namespace

base::V3f EnergyProbe::normal(const geo::Hit& hit) const {
    alignas(64) float N[3 * SL_LANES_MAX] = {};
    sl_points points = {};
    points.var[SL_VAR_N] = N;
    frame_.world->fill({&hit, 1}, {}, 1ULL << SL_VAR_N, SL_LANES_MAX, points, nullptr, nullptr);
    return base::normalize(base::V3f(N[0], N[SL_LANES_MAX], N[2 * SL_LANES_MAX]));
}

// As for rays that come from each eye. They are long, so that an eye at infinity is no worse.
void EnergyProbe::fill(const Place& place, std::span<const View> views,
                       std::span<const geo::Hit> hits) {
    alignas(64) float P[3 * SL_LANES_MAX] = {};
    sl_points points = {};
    points.var[SL_VAR_P] = P;
    frame_.world->fill(hits.first(1), {}, 1ULL << SL_VAR_P, SL_LANES_MAX, points, nullptr, nullptr);
    const base::V3f P_cam(P[0], P[SL_LANES_MAX], P[2 * SL_LANES_MAX]);
    const float away = std::max(base::length(P_cam), 100 * place.footprint);
    std::array<std::array<float, SL_BATCH_MAX>, 3> origin{}, direction{};
    std::array<float, SL_BATCH_MAX> footprint{};
    for (std::size_t i = 0; i < views.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            const float step = away * views[i].to_eye[static_cast<int>(k)];
            origin[k][i] = P_cam[static_cast<int>(k)] + step;
            direction[k][i] = -step;
        }
        footprint[i] = place.footprint;
        batch_.seeds()[i] = views[i].seed;
    }
    const auto span = [&](const std::array<float, SL_BATCH_MAX>& values) {
        return std::span<const float>(values.data(), views.size());
    };
    const geo::Incident incident{span(origin[0]),    span(origin[1]),    span(origin[2]),
                                 span(direction[0]), span(direction[1]), span(direction[2]),
                                 span(footprint)};
    frame_.world->fill(
        hits, incident, batch_.instance().object().needed | 1ULL << SL_VAR_Cs | 1ULL << SL_VAR_Os,
        batch_.stride(), batch_.points(), batch_.aux_points_u(), batch_.aux_points_v());
    if (float* ncomps = batch_.uniform(SL_VAR_ncomps)) {
        *ncomps = 3;
    }
}

void EnergyProbe::shade(const Place& place, const ProbeLight& probe, std::span<const View> views,
                        std::span<Response> out) {
    views = views.first(std::min(views.size(), max_views));
    std::vector<geo::Hit> hits(views.size(), place.hit);
    for (geo::Hit& hit : hits) {
        hit.t = 1;
    }
    batch_.begin(*place.shader.instance, static_cast<std::uint32_t>(views.size()));
    fill(place, views, hits);
    const geo::Binding binding = frame_.world->binding(place.hit);
    const rib::Attributes& state = frame_.scene.attributes[binding.attributes];
    const LightList no_lights;
    BatchSubject subject{hits, &no_lights, binding.attributes};
    subject.surface = {&place.shader, &batch_};
    ProbeExecution execution(frame_, place.shader, probe);
    execution.thread = &thread_;
    execution.batch = &batch_;
    execution.subject = &subject;
    // Shaders that leave Ci and Oi alone show Cs and Os ([R] of sl.md 5.2).
    for (int k = 0; k < 3; ++k) {
        if (float* Ci = batch_.plane(SL_VAR_Ci, k)) {
            std::fill_n(Ci, views.size(), state.color[static_cast<std::size_t>(k)]);
        }
        if (float* Oi = batch_.plane(SL_VAR_Oi, k)) {
            std::fill_n(Oi, views.size(), state.opacity[static_cast<std::size_t>(k)]);
        }
    }
    ++thread_.batch_serial;
    const bool done = run(batch_, execution);
    const auto result = [&](sl_variable id, const auto& fallback, std::size_t i) {
        const auto at = [&](int k) {
            const float* plane = batch_.plane(id, k);
            return plane != nullptr ? plane[i] : fallback[static_cast<std::size_t>(k)];
        };
        return base::Color(at(0), at(1), at(2));
    };
    for (std::size_t i = 0; i < views.size(); ++i) {
        const base::Color Ci = result(SL_VAR_Ci, state.color, i);
        const base::Color Oi = result(SL_VAR_Oi, state.opacity, i);
        const auto clamped = [](float x) { return std::clamp(x, 0.0f, 1.0f); };
        out[i] = done && is_number(Ci) && is_number(Oi)
                     ? Response{Ci, {clamped(Oi.r), clamped(Oi.g), clamped(Oi.b)}}
                     : Response{};
    }
}

} // namespace trace
