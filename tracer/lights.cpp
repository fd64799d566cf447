// SPDX-License-Identifier: Apache-2.0
#include "tracer/lights.h"

#include "tracer/indirect_ambient.h"
#include "tracer/light_run.h"
#include "tracer/messages.h"
#include "tracer/pixel_trace.h"
#include "tracer/shader_set.h"

#include <algorithm>
#include <bit>
#include <limits>

namespace trace {

LightRun& attached(Execution& execution, rib::LightId id) {
    ThreadState& thread = *execution.thread;
    if (!thread.lights) {
        thread.lights = std::make_unique<LightScratch>();
    }
    auto& runs = thread.lights->runs;
    if (runs.size() < execution.frame.lights->size()) {
        runs.resize(execution.frame.lights->size());
    }
    if (!runs[id]) {
        runs[id] = std::make_unique<LightRun>();
    }
    runs[id]->attach(execution, (*execution.frame.lights)[id], id);
    return *runs[id];
}

namespace {

// Lanes whose light vector lies within the cone: L.A >= cos |L||A|, inclusive, neither need be unit
// (sl.md 5.5).
std::uint32_t in_cone(const sl_light_query& query, const sl_light_result& result) {
    std::uint32_t mask = 0;
    const std::uint32_t n = query.lanes;
    for (std::uint32_t lane = 0; lane < n; ++lane) {
        const base::V3f L(result.L[lane], result.L[n + lane], result.L[2 * n + lane]);
        const float length = base::length(L);
        bool inside = length > 0; // a light exactly at the point has no direction: skipped
        if (inside && query.axis != nullptr) {
            const base::V3f A(query.axis[lane], query.axis[n + lane], query.axis[2 * n + lane]);
            inside = base::dot(L, A) >= query.cosangle[lane] * length * base::length(A);
        }
        mask |= inside ? 1U << lane : 0;
    }
    return mask;
}

// Planes of SL_LANES_MAX to planes of `lanes`.
void copy_planes(const float* from, int num_planes, std::uint32_t lanes, float* to) {
    for (int k = 0; k < num_planes; ++k) {
        std::copy_n(from + k * SL_LANES_MAX, lanes, to + static_cast<std::uint32_t>(k) * lanes);
    }
}

void copy_result(const LightSample& sample, std::uint32_t lanes, sl_light_result& result) {
    copy_planes(sample.L, 3, lanes, result.L);
    copy_planes(sample.Cl, 3, lanes, result.Cl);
    copy_planes(sample.Ol, 3, lanes, result.Ol);
    copy_planes(sample.nondiffuse, 1, lanes, result.nondiffuse);
    copy_planes(sample.nonspecular, 1, lanes, result.nonspecular);
}

std::uint32_t lanes_with_light(const sl_light_result& result, std::uint32_t lanes) {
    std::uint32_t mask = 0;
    for (std::uint32_t lane = 0; lane < lanes; ++lane) {
        const bool black = result.Cl[lane] == 0 && result.Cl[lanes + lane] == 0 &&
                           result.Cl[2 * lanes + lane] == 0;
        mask |= black ? 0 : 1U << lane;
    }
    return mask;
}

// Takes off what is kept from arriving. Returns the lanes that get nothing.
std::uint32_t darken(const LightSample& sample, std::uint32_t lanes, std::uint32_t mask,
                     sl_light_result& result) {
    for (std::uint32_t rest = mask; rest != 0; rest &= rest - 1) {
        const auto lane = static_cast<std::uint32_t>(std::countr_zero(rest));
        for (std::uint32_t k = 0; k < 3; ++k) {
            result.Cl[k * lanes + lane] *= sample.passes[k * SL_LANES_MAX + lane];
        }
    }
    return mask & ~lanes_with_light(result, lanes);
}

} // namespace

namespace {

// The batch's N stands for a query without one.
class Query {
public:
    Query(const Execution& execution, const sl_light_query& query) : query_(query) {
        if (query.N != nullptr || execution.batch == nullptr || !execution.batch->has(SL_VAR_N)) {
            return;
        }
        for (std::uint32_t k = 0; k < 3; ++k) {
            const float* plane = execution.batch->plane(SL_VAR_N, static_cast<int>(k));
            std::copy_n(plane + query.first, query.lanes, batch_N_ + k * query.lanes);
        }
        query_.N = batch_N_;
    }
    Query(const Query&) = delete;
    Query& operator=(const Query&) = delete;
    [[nodiscard]] const sl_light_query& get() const { return query_; }

private:
    sl_light_query query_;
    float batch_N_[3 * SL_LANES_MAX] = {};
};

rib::LightId asked_light(const Execution& execution, const sl_light_query& query) {
    return execution.subject->lights->directional[static_cast<std::size_t>(query.index)];
}

} // namespace

namespace {

// Light `id` for lanes it was chosen for, or all. Returns those it reaches; shadowed: of them,
// those that get nothing.
std::uint32_t light_lanes(Execution& execution, LightRun& run, const sl_light_query& query,
                          sl_light_result& result, std::uint32_t& shadowed) {
    const std::uint32_t lit = run.illuminate(query);
    result.more = query.sample + 1 < run.num_samples() ? 1 : 0;
    shadowed = 0;
    if (lit == 0) {
        return 0;
    }
    copy_result(run.sample(query.sample), query.lanes, result);
    const std::uint32_t reached = lit & in_cone(query, result);
    if (run.info().casts_shadows && reached != 0) {
        const std::uint32_t bright = reached & lanes_with_light(result, query.lanes);
        run.trace_shadows(query.sample, bright, execution.thread->lights->origins);
        shadowed = darken(run.sample(query.sample), query.lanes, bright, result);
    }
    return reached;
}

// Those chosen make up for those left out.
void weigh(const LightChoice::Chosen& chosen, std::uint32_t lanes, sl_light_result& result) {
    for (std::uint32_t k = 0; k < 3; ++k) {
        for (std::uint32_t lane = 0; lane < lanes; ++lane) {
            result.Cl[k * lanes + lane] *= chosen.weight[lane];
        }
    }
}

} // namespace

std::uint32_t run_light(Execution& execution, const sl_light_query& asked,
                        sl_light_result& result) {
    result.more = 0;
    result.next = asked.index + 1;
    const rib::LightId id = asked_light(execution, asked);
    LightRun& run = attached(execution, id);
    sl_light_query query = asked;
    const LightChoice::Chosen* chosen = nullptr;
    if (const auto* choices = execution.thread->lights->choice.choose(execution, asked)) {
        auto at = std::lower_bound(
            choices->begin(), choices->end(), asked.index,
            [](const LightChoice::Chosen& c, std::int32_t index) { return c.index < index; });
        const bool is_chosen = at != choices->end() && at->index == asked.index;
        chosen = is_chosen ? &*at++ : nullptr;
        query.mask &= is_chosen ? chosen->mask : 0;
        result.next = at != choices->end() ? at->index : std::numeric_limits<std::int32_t>::max();
    }
    if (query.mask == 0 || !run.wants(query.category)) {
        return 0;
    }
    std::uint32_t shadowed = 0;
    const std::uint32_t reached =
        light_lanes(execution, run, Query(execution, query).get(), result, shadowed);
    if (chosen != nullptr) {
        weigh(*chosen, query.lanes, result);
    }
    if (execution.thread->trace != nullptr) {
        execution.thread->trace->light(id, run.batch(), query, result, reached, shadowed);
    }
    return reached;
}

std::uint32_t answer_light_message(Execution& execution, const sl_light_query& query,
                                   sl_string name, std::int32_t type, std::int32_t array_length,
                                   float* value) {
    LightRun& run = attached(execution, asked_light(execution, query));
    if (name == nullptr) {
        const sl_string text = execution.frame.strings.intern(run.info().shader->name);
        std::fill_n(reinterpret_cast<sl_string*>(value), query.lanes, text);
        return query.mask;
    }
    run.recall(Query(execution, query).get());
    return param_of_batch({SL_MESSAGE_lightsource, name, type, array_length, query.first,
                           query.mask, value, query.lanes},
                          *run.info().shader, run.batch(), 0);
}

// Outside of lights, which parameters' defaults are, the middle of the cone stands for all of it.
void choose_solar_direction(const Execution& execution, const SolarQuery& query) {
    if (execution.light != nullptr) {
        execution.light->choose_solar_direction(query, execution.lanes());
    } else if (query.axis != nullptr) {
        std::copy_n(query.axis, 3 * execution.lanes(), query.L);
    }
}

void run_ambient(Execution& execution, std::uint32_t first, std::uint32_t mask, const float* P,
                 float* C) {
    const std::uint32_t lanes = execution.lanes();
    std::fill_n(C, 3 * lanes, 0.0f);
    if (execution.thread == nullptr || execution.subject == nullptr ||
        execution.subject->lights == nullptr || execution.ray_kind == SL_RAY_shadow) {
        return;
    }
    if (execution.subject->lights->is_indirect) {
        mask &= ~indirect_ambient(execution, first, mask, C);
        if (mask == 0) {
            return;
        }
    }
    for (const rib::LightId id : execution.subject->lights->ambient) {
        LightRun& run = attached(execution, id);
        sl_light_query query = {};
        query.first = first;
        query.lanes = lanes;
        query.mask = mask;
        query.P = P;
        run.illuminate(query);
        if (execution.thread->trace != nullptr) {
            execution.thread->trace->ambient(id, run.batch(), first, mask);
        }
        const LightSample& sample = run.sample(0);
        for (std::uint32_t k = 0; k < 3; ++k) {
            for (std::uint32_t lane = 0; lane < lanes; ++lane) {
                C[k * lanes + lane] +=
                    (mask >> lane & 1U) != 0 ? sample.Cl[k * SL_LANES_MAX + lane] : 0;
            }
        }
    }
}

} // namespace trace
