// SPDX-License-Identifier: Apache-2.0
#include "tracer/lights.h"

#include "runtime/base/lanes4.h"
#include "runtime/base/ticks.h"
#include "tracer/messages.h"
#include "tracer/pixel_trace.h"
#include "tracer/services.h"
#include "tracer/shader_set.h"
#include "tracer/sl_types.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

namespace trace {

namespace {

constexpr std::uint32_t all_lanes = SL_LANES_MAX;
// A shadow ray ends this fraction before the light, so that rounding of the two ends does not find
// a surface the light lies on: some ten float roundings of the distance.
constexpr float short_of_light = 1e-6f;
// Lights run for a packet at a time: a clock for each would cost more than some lights do.
constexpr std::uint64_t timed_every = 16;

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

LightRun& attached(Execution& execution, rib::LightId id) {
    ThreadState& thread = *execution.thread;
    if (thread.lights.size() < execution.frame.lights->size()) {
        thread.lights.resize(execution.frame.lights->size());
    }
    std::unique_ptr<LightRun>& run = thread.lights[id];
    if (!run) {
        run = std::make_unique<LightRun>();
    }
    run->attach(execution, (*execution.frame.lights)[id]);
    return *run;
}

} // namespace

void LightRun::attach(Execution& asker, const LightInfo& info) {
    const bool stale = asker_ != &asker || serial_ != asker.serial;
    // Between batches of the asker: what a running one learned from the light stays.
    const bool is_new = info_ != &info || (stale && instance_ != &info.shader->current());
    if (!is_new && !stale) {
        return;
    }
    info_ = &info;
    asker_ = &asker;
    serial_ = asker.serial;
    execution_.emplace(asker.frame, *info.shader);
    execution_->thread = asker.thread;
    execution_->batch = &batch_;
    execution_->subject = asker.subject;
    execution_->asked_by = &asker;
    execution_->ray_level = asker.ray_level;
    execution_->ray_kind = asker.ray_kind;
    if (is_new) {
        begin();
        known_ = 0;
        sent_ = false;
    }
    if (!info.is_constant) {
        known_ = 0;
    }
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

bool LightRun::is_known(const sl_light_query& query) const {
    if ((query.mask & ~known_) != 0 || sent_ || query.num_sends > 0 || query.refresh != 0) {
        return false;
    }
    if (info_->is_constant) {
        return true;
    }
    if (!info_->reusable || query.first != first_) {
        return false;
    }
    for (std::uint32_t rest = query.mask; rest != 0; rest &= rest - 1) {
        const auto lane = static_cast<std::uint32_t>(std::countr_zero(rest));
        for (std::uint32_t k = 0; k < 3; ++k) {
            if (query.P[k * lanes_ + lane] != Ps_[k][lane]) {
                return false;
            }
        }
    }
    return true;
}

// "send:light:name": the parameter has this value for one execution.
void LightRun::send(const sl_light_query& query) {
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
            send_value(query, index, value);
        }
    }
}

// A uniform parameter takes the value of the first point asked; lanes that are not asked do too.
void LightRun::send_value(const sl_light_query& query, int index, const sl_value& value) {
    const auto any = static_cast<std::uint32_t>(std::countr_zero(query.mask));
    const auto put = [&]<class T>(const T* from, T* each, T* one) {
        const std::size_t step = value.varying != 0 ? query.lanes : 1;
        for (std::uint32_t lane = 0; each != nullptr && lane < all_lanes; ++lane) {
            const std::uint32_t asked = (query.mask >> lane & 1U) != 0 ? lane : any;
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

// Lanes that are not asked get the point of one that is: a light may loop until its value
// converges.
void LightRun::fill_points(std::uint32_t mask, const float* P, const float* N) {
    const auto any = static_cast<std::uint32_t>(std::countr_zero(mask));
    for (std::uint32_t lane = 0; lane < all_lanes; ++lane) {
        const std::uint32_t from = (mask >> lane & 1U) != 0 ? lane : any;
        for (std::uint32_t k = 0; k < 3; ++k) {
            Ps_[k][lane] = P[k * lanes_ + from];
            if (batch_.has(SL_VAR_Ns)) {
                batch_.plane(SL_VAR_Ns, static_cast<int>(k))[lane] =
                    N != nullptr ? N[k * lanes_ + from] : 0;
            }
        }
    }
    for (int k = 0; k < 3; ++k) {
        for (const sl_variable id : {SL_VAR_Ps, SL_VAR_I}) { // I = Ps - E, and E is the origin
            if (batch_.has(id)) {
                std::copy_n(Ps_[k], all_lanes, batch_.plane(id, k));
            }
        }
    }
}

// Points that are those of the surface differ as it does; others (a march through a volume) not at
// all. I = Ps - E differs as Ps does.
void LightRun::fill_differences(std::uint32_t mask) {
    const BatchSubject* subject = asker_->subject;
    const bool known =
        subject != nullptr && subject->P_u != nullptr && asker_->batch->has(SL_VAR_P);
    const auto any = static_cast<std::uint32_t>(std::countr_zero(mask));
    for (std::uint32_t lane = 0; lane < all_lanes; ++lane) {
        const std::uint32_t from = (mask >> lane & 1U) != 0 ? lane : any;
        const std::size_t point = first_ + from;
        const bool same = known && point < asker_->batch->count() &&
                          asker_->batch->plane(SL_VAR_P, 0)[point] == Ps_[0][lane] &&
                          asker_->batch->plane(SL_VAR_P, 1)[point] == Ps_[1][lane] &&
                          asker_->batch->plane(SL_VAR_P, 2)[point] == Ps_[2][lane];
        for (int k = 0; k < 3; ++k) {
            const std::size_t at = static_cast<std::size_t>(k) * asker_->batch->stride() + point;
            for (const sl_variable id : {SL_VAR_Ps, SL_VAR_I}) {
                if (batch_.aux_u(id, k) != nullptr) {
                    batch_.aux_u(id, k)[lane] = same ? subject->P_u[at] : 0;
                    batch_.aux_v(id, k)[lane] = same ? subject->P_v[at] : 0;
                }
            }
        }
    }
}

void LightRun::fill_seeds_and_time() {
    const std::uint32_t count = asker_->batch != nullptr ? asker_->batch->count() : 0;
    const float open = asker_->frame.spaces.shutter_open();
    for (std::uint32_t lane = 0; lane < all_lanes && count > 0; ++lane) {
        const std::uint32_t point = std::min(first_ + lane, count - 1);
        batch_.seeds()[lane] = asker_->batch->seeds()[point];
        if (batch_.has(SL_VAR_time)) {
            const bool has_hit = asker_->subject != nullptr && point < asker_->subject->hits.size();
            batch_.plane(SL_VAR_time)[lane] = has_hit ? asker_->subject->hits[point].time : open;
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

std::uint32_t LightRun::illuminate(const sl_light_query& query) {
    const std::uint32_t mask = query.mask & ((1U << query.lanes) - 1);
    if (mask == 0) {
        return 0;
    }
    Counters& counters = asker_->thread->counters;
    if (is_known(query)) {
        counters.add(Counter::light_reused);
        return mask & executed();
    }
    first_ = query.first;
    lanes_ = query.lanes;
    known_ = info_->is_constant ? ~0U : mask;
    execution_->asked_first = query.first;
    execution_->asked_mask = mask;
    traced_ = clear_ = 0;
    if (sent_) {
        begin();
        sent_ = false;
    } else {
        batch_.restart();
    }
    fill_points(mask, query.P, query.N);
    if (info_->shader->object().needed_aux != 0) {
        fill_differences(mask);
    }
    fill_seeds_and_time();
    reset_results();
    send(query);
    run(static_cast<std::uint32_t>(std::popcount(mask)));
    return mask & executed();
}

void LightRun::run(std::uint32_t num_points) {
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

float LightRun::param(int index, std::uint32_t lane) {
    if (const float* plane = batch_.param_plane(index)) {
        return plane[lane];
    }
    const float* uniform = batch_.param_uniform(index);
    return uniform != nullptr ? *uniform : 0;
}

// --- shadows

// Points that lie on the hit start outside its rounding error. Points a shader made up (a march
// through a volume) lie on nothing and start as they are.
base::V3f LightRun::shadow_origin(std::uint32_t lane, const base::V3f& to_light) const {
    const base::V3f P(Ps_[0][lane], Ps_[1][lane], Ps_[2][lane]);
    const BatchSubject* subject = asker_->subject;
    const std::size_t point = first_ + lane;
    if (subject == nullptr || point >= subject->hits.size() || !asker_->batch->has(SL_VAR_P)) {
        return P;
    }
    for (int k = 0; k < 3; ++k) {
        if (asker_->batch->plane(SL_VAR_P, k)[point] != P[k]) {
            return P;
        }
    }
    return asker_->frame.world->spawn_origin(subject->hits[point], to_light);
}

std::uint32_t LightRun::unshadowed(std::uint32_t mask) {
    const std::uint32_t unknown = mask & ~traced_;
    if (unknown == 0 || asker_->frame.world == nullptr) {
        return mask & clear_;
    }
    geo::RayPacket rays = {};
    rays.active = unknown;
    for (std::uint32_t rest = unknown; rest != 0; rest &= rest - 1) {
        const auto lane = static_cast<std::uint32_t>(std::countr_zero(rest));
        const base::V3f to_light(-batch_.plane(SL_VAR_L, 0)[lane], -batch_.plane(SL_VAR_L, 1)[lane],
                                 -batch_.plane(SL_VAR_L, 2)[lane]);
        const base::V3f P(Ps_[0][lane], Ps_[1][lane], Ps_[2][lane]);
        const base::V3f origin = shadow_origin(lane, to_light);
        const base::V3f d =
            info_->from_infinity ? base::normalize(to_light) : P + to_light - origin;
        rays.ox[lane] = origin.x, rays.oy[lane] = origin.y, rays.oz[lane] = origin.z;
        rays.dx[lane] = d.x, rays.dy[lane] = d.y, rays.dz[lane] = d.z;
        rays.tnear[lane] = 0;
        rays.tfar[lane] =
            info_->from_infinity ? std::numeric_limits<float>::infinity() : 1 - short_of_light;
        rays.time[lane] = asker_->subject != nullptr && first_ + lane < asker_->subject->hits.size()
                              ? asker_->subject->hits[first_ + lane].time
                              : asker_->frame.spaces.shutter_open();
        rays.mask[lane] = geo::ShadowRay;
    }
    asker_->thread->counters.add(Counter::rays_shadow,
                                 static_cast<std::uint64_t>(std::popcount(unknown)));
    const std::uint32_t blocked = asker_->frame.world->occluded(rays);
    if (asker_->thread->trace != nullptr) {
        asker_->thread->trace->shadow_rays(first_, rays, blocked);
    }
    traced_ |= unknown;
    clear_ = (clear_ & ~unknown) | (unknown & ~blocked);
    return mask & clear_;
}

// --- services

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

void copy_result(LightRun& run, std::uint32_t lanes, sl_light_result& result) {
    rt::ShadeBatch& batch = run.batch();
    const auto copy = [&](sl_variable id, float sign, float fallback, float* out) {
        for (std::uint32_t k = 0; k < 3; ++k) {
            const float* plane = batch.plane(id, static_cast<int>(k));
            for (std::uint32_t lane = 0; lane < lanes; ++lane) {
                out[k * lanes + lane] = plane != nullptr ? sign * plane[lane] : fallback;
            }
        }
    };
    copy(SL_VAR_L, -1, 0, result.L);
    copy(SL_VAR_Cl, 1, 0, result.Cl);
    copy(SL_VAR_Ol, 1, 1, result.Ol);
    const LightInfo& info = run.info();
    for (std::uint32_t lane = 0; lane < lanes; ++lane) {
        result.nondiffuse[lane] = run.param(info.nondiffuse, lane);
        result.nonspecular[lane] = run.param(info.nonspecular, lane);
    }
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

void darken(sl_light_result& result, std::uint32_t lanes, std::uint32_t shadowed) {
    for (std::uint32_t rest = shadowed; rest != 0; rest &= rest - 1) {
        const auto lane = static_cast<std::uint32_t>(std::countr_zero(rest));
        for (std::uint32_t k = 0; k < 3; ++k) {
            result.Cl[k * lanes + lane] = 0;
        }
    }
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

std::uint32_t run_light(Execution& execution, const sl_light_query& query,
                        sl_light_result& result) {
    const rib::LightId id = asked_light(execution, query);
    LightRun& run = attached(execution, id);
    if (!run.wants(query.category)) {
        return 0;
    }
    const std::uint32_t lit = run.illuminate(Query(execution, query).get());
    std::uint32_t reached = 0, shadowed = 0;
    if (lit != 0) {
        copy_result(run, query.lanes, result);
        reached = lit & in_cone(query, result);
    }
    if (run.info().casts_shadows && reached != 0) {
        const std::uint32_t bright = reached & lanes_with_light(result, query.lanes);
        shadowed = bright & ~run.unshadowed(bright);
        darken(result, query.lanes, shadowed);
    }
    if (execution.thread->trace != nullptr) {
        execution.thread->trace->light(id, run.batch(), query, result, reached, shadowed);
    }
    result.more = 0;
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
    run.illuminate(Query(execution, query).get());
    return param_of_batch({SL_MESSAGE_lightsource, name, type, array_length, query.first,
                           query.mask, value, query.lanes},
                          *run.info().shader, run.batch(), 0);
}

// The middle of the cone stands for all of it.
void choose_solar_direction(const Execution& execution, const SolarQuery& query) {
    if (query.axis != nullptr) {
        std::copy_n(query.axis, 3 * execution.lanes(), query.L);
        return;
    }
    for (std::uint32_t k = 0; k < 3 && execution.batch->has(SL_VAR_Ns); ++k) {
        const float* Ns = execution.batch->plane(SL_VAR_Ns, static_cast<int>(k));
        for (std::uint32_t lane = 0; lane < execution.lanes(); ++lane) {
            query.L[k * execution.lanes() + lane] = -Ns[query.first + lane];
        }
    }
}

void run_ambient(Execution& execution, std::uint32_t first, std::uint32_t mask, const float* P,
                 float* C) {
    const std::uint32_t lanes = execution.lanes();
    std::fill_n(C, 3 * lanes, 0.0f);
    if (execution.thread == nullptr || execution.subject == nullptr ||
        execution.subject->lights == nullptr) {
        return;
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
        if (!run.batch().has(SL_VAR_Cl)) {
            continue;
        }
        for (std::uint32_t k = 0; k < 3; ++k) {
            const float* Cl = run.batch().plane(SL_VAR_Cl, static_cast<int>(k));
            for (std::uint32_t lane = 0; lane < lanes; ++lane) {
                C[k * lanes + lane] += Cl[lane];
            }
        }
    }
}

} // namespace trace
