// SPDX-License-Identifier: Apache-2.0
#include "tracer/hit_shader.h"

#include "runtime/base/lanes4.h"
#include "runtime/base/ticks.h"
#include "tracer/pixel_trace.h"
#include "tracer/services.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace trace {

namespace {

constexpr std::uint64_t bit(sl_variable id) {
    return 1ULL << id;
}

bool is_number(float x) {
    return x - x == 0;
}

std::uint32_t mix(std::uint32_t x) { // [Mueller] lowbias32: neighbouring inputs give unlike outputs
    x ^= x >> 16;
    x *= 0x7feb352dU;
    x ^= x >> 15;
    x *= 0x846ca68bU;
    return x ^ x >> 16;
}

} // namespace

std::size_t HitShader::KeyHash::operator()(const Key& key) const {
    return mix(key.shading_class ^ mix(key.a ^ mix(key.b)));
}

HitShader::HitShader(const FrameContext& frame, const Camera& camera, const ShadingClasses& classes,
                     const OutputBindings* outputs, ThreadState& thread)
    : frame_(frame), camera_(camera), classes_(classes),
      outputs_(outputs != nullptr && outputs->num_channels() > 0 ? outputs : nullptr),
      thread_(thread), group_of_class_(classes.size(), geo::no_id),
      shown_planes_(outputs_ != nullptr
                        ? static_cast<std::size_t>(std::popcount(outputs_->all_variables()))
                        : 0) {}

// --- grouping

std::uint32_t HitShader::new_group(std::uint32_t shading_class, std::uint32_t attributes) {
    groups_.push_back({shading_class, attributes});
    return static_cast<std::uint32_t>(groups_.size() - 1);
}

std::uint32_t HitShader::keyed_group(const geo::Hit& hit, const geo::Binding& binding,
                                     std::uint32_t shading_class) {
    const ShadingClass& c = classes_[shading_class];
    Key key{shading_class, 0, geo::no_id};
    if (!c.overrides.empty()) { // primitive variables are read shape by shape
        key.a = hit.shape;
        key.b = hit.instance;
    } else {
        key.a = binding.transform_key;
    }
    const auto [it, is_new] = group_of_key_.emplace(key, 0);
    if (is_new) {
        it->second = new_group(shading_class, binding.attributes);
    }
    return it->second;
}

std::uint32_t HitShader::group_of(const geo::Hit& hit) {
    const geo::Binding binding = frame_.world->binding(hit);
    const std::uint32_t shading_class = classes_.facts(binding.attributes).shading_class;
    if (classes_[shading_class].needs_key()) {
        return keyed_group(hit, binding, shading_class);
    }
    std::uint32_t& group = group_of_class_[shading_class];
    if (group == geo::no_id) {
        group = new_group(shading_class, binding.attributes);
    }
    return group;
}

// Counting sort: members of a group keep the order of the rays.
void HitShader::group_hits(std::span<const geo::Hit> hits) {
    for (const Group& group : groups_) {
        group_of_class_[group.shading_class] = geo::no_id;
    }
    groups_.clear();
    group_of_key_.clear();
    group_of_hit_.resize(hits.size());
    const geo::Hit* last = nullptr;
    std::uint32_t group = geo::no_id;
    for (std::size_t i = 0; i < hits.size(); ++i) {
        if (!hits[i].valid()) {
            group_of_hit_[i] = geo::no_id;
            continue;
        }
        // Neighbouring rays mostly meet the same shape, whose parts bind alike.
        if (last == nullptr || last->shape != hits[i].shape || last->instance != hits[i].instance) {
            group = group_of(hits[i]);
            last = &hits[i];
        }
        group_of_hit_[i] = group;
        ++groups_[group].count;
    }
    std::uint32_t begin = 0;
    for (Group& g : groups_) {
        g.begin = begin;
        begin += g.count;
        g.count = 0;
    }
    members_.resize(begin);
    for (std::uint32_t i = 0; i < hits.size(); ++i) {
        if (group_of_hit_[i] != geo::no_id) {
            Group& g = groups_[group_of_hit_[i]];
            members_[g.begin + g.count++] = i;
        }
    }
}

void HitShader::shade(const ShadingRays& rays, std::span<const geo::Hit> hits,
                      std::span<Sample> out, std::span<float> out_extra) {
    rays_ = rays;
    hits_ = hits;
    out_ = out;
    out_extra_ = out_extra;
    group_hits(hits);
    thread_.counters.add(Counter::hits, members_.size());
    for (const Group& group : groups_) {
        shade_group(group);
    }
}

void HitShader::shade_group(const Group& group) {
    const ShadingClass& c = classes_[group.shading_class];
    const std::span<std::uint32_t> members(members_.data() + group.begin, group.count);
    for (std::size_t begin = 0; begin < members.size();) {
        const std::size_t end =
            c.overrides.empty() ? members.size() : equal_values(c, members, begin);
        for (; begin < end; begin += std::min<std::size_t>(SL_BATCH_MAX, end - begin)) {
            shade_batch(group,
                        members.subspan(begin, std::min<std::size_t>(SL_BATCH_MAX, end - begin)));
        }
    }
}

// --- one batch

void HitShader::shade_batch(const Group& group, std::span<const std::uint32_t> members) {
    const ShadingClass& c = classes_[group.shading_class];
    const std::uint64_t shown = shown_variables(group.shading_class);
    const NeededVariables after = needed_after(group);
    is_displaced_ = is_displaced(group, after);
    NeededVariables needed = after;
    if (is_displaced_) {
        const auto before = DisplacedBatch::needed_before(c.displacement->object(), after);
        needed = {after.main | before.main, after.aux | before.aux};
    }
    const bool has_rays = gather(c, needed, members);
    ++thread_.batch_serial;
    BatchSubject subject{subject_hits_, &c.lights, group.attributes};
    if (has_rays) {
        subject.incident = incident(static_cast<std::uint32_t>(members.size()));
    }
    if (thread_.trace != nullptr) {
        thread_.trace->begin_batch(rays_.ray, members);
    }
    if (is_displaced_) {
        run_displacement(c, after, subject, members);
    }
    Execution surface(frame_, *c.surface);
    surface.thread = &thread_;
    surface.batch = &thread_.surface;
    surface.subject = &subject;
    subject.surface = {c.surface, &thread_.surface};
    const sl_points planes = run_surface(c, shown, surface, subject, members);
    if (c.atmosphere != nullptr) {
        drop_bad_surface(*c.surface, static_cast<std::uint32_t>(members.size()));
        run_atmosphere(c, subject, members);
    }
    const bool all_good = scatter(members);
    if (outputs_ != nullptr) {
        scatter_outputs(group.shading_class, planes, members, *c.surface);
    }
    if (!all_good) {
        blacken_bad(members, c.atmosphere != nullptr ? *c.atmosphere : *c.surface);
    }
    if (thread_.trace != nullptr) {
        thread_.trace->shaded(members, out_);
    }
}

bool HitShader::gather(const ShadingClass& c, NeededVariables needed,
                       std::span<const std::uint32_t> members) {
    gather_hits(c, members);
    const bool needs_footprint =
        (needed.main & (bit(SL_VAR_du) | bit(SL_VAR_dv))) != 0 || needed.aux != 0;
    const bool asks = c.by_attributes; // incident(), opposite(), sides of the surface
    if (!needs_footprint && !asks && (needed.main & bit(SL_VAR_I)) == 0) {
        return false; // nothing else depends on the ray
    }
    for (std::size_t i = 0; i < members.size(); ++i) {
        const std::uint32_t ray = ray_of(members[i]);
        const geo::RayPacket& packet = rays_.packets[ray / geo::RayPacket::size];
        const std::size_t lane = ray % geo::RayPacket::size;
        batch_.ox[i] = packet.ox[lane], batch_.oy[i] = packet.oy[lane],
        batch_.oz[i] = packet.oz[lane];
        batch_.dx[i] = packet.dx[lane], batch_.dy[i] = packet.dy[lane],
        batch_.dz[i] = packet.dz[lane];
        if (needs_footprint) {
            const geo::Hit& hit = subject_hits_[i];
            const float spacing_px =
                classes_.facts(frame_.world->binding(hit).attributes).spacing_px;
            const float z =
                packet.oz[lane] + (rays_.t.empty() ? hit.t : rays_.t[members[i]]) * packet.dz[lane];
            batch_.footprint[i] = camera_.footprint(z, spacing_px);
        }
    }
    return true;
}

// Neighbouring rays mostly meet one class: then the hits are used where they are.
void HitShader::gather_hits(const ShadingClass& c, std::span<const std::uint32_t> members) {
    const bool in_order = c.overrides.empty(); // else sorted by value
    if (in_order && members.back() - members.front() + 1 == members.size()) {
        subject_hits_ = hits_.subspan(members.front(), members.size());
        return;
    }
    for (std::size_t i = 0; i < members.size(); ++i) {
        batch_.hits[i] = hits_[members[i]];
    }
    subject_hits_ = {batch_.hits.data(), members.size()};
}

// Ci and Oi start as Cs and Os ([R] of sl.md 5.2), so the geometry is asked for those whatever the
// shader needs; where it has no planes for them they go straight to the results.
sl_points HitShader::run_surface(const ShadingClass& c, std::uint64_t shown, Execution& execution,
                                 BatchSubject& subject, std::span<const std::uint32_t> members) {
    const auto count = static_cast<std::uint32_t>(members.size());
    rt::ShadeBatch& batch = thread_.surface;
    const rt::ShaderInstance& instance = c.surface->current();
    batch.begin(instance, count);
    const std::uint32_t stride = batch.stride();
    sl_points planes = batch.points();
    add_shown_planes(shown, planes);
    const auto or_scratch = [](float*& plane, std::array<float, 3 * Batch::size>& scratch) {
        plane = plane != nullptr ? plane : scratch.data();
    };
    or_scratch(planes.var[SL_VAR_Ci], batch_.Ci);
    or_scratch(planes.var[SL_VAR_Oi], batch_.Oi);
    float* const Ci = planes.var[SL_VAR_Ci];
    float* const Oi = planes.var[SL_VAR_Oi];
    const bool own_Cs = planes.var[SL_VAR_Cs] != nullptr, own_Os = planes.var[SL_VAR_Os] != nullptr;
    planes.var[SL_VAR_Cs] = own_Cs ? planes.var[SL_VAR_Cs] : Ci;
    planes.var[SL_VAR_Os] = own_Os ? planes.var[SL_VAR_Os] : Oi;
    const std::uint64_t needed = instance.object().needed | shown | bit(SL_VAR_Cs) | bit(SL_VAR_Os);
    const AuxPlanes aux = aux_planes(c, batch);
    frame_.world->fill(subject_hits_, incident(count), needed & geometry_variables, stride, planes,
                       aux.at_u(), aux.at_v());
    displace(planes, aux.at_u(), aux.at_v(), count);
    subject.P_u = aux.u.var[SL_VAR_P];
    subject.P_v = aux.v.var[SL_VAR_P];
    if (own_Cs) {
        std::copy_n(planes.var[SL_VAR_Cs], 3 * stride, Ci);
    }
    if (own_Os) {
        std::copy_n(planes.var[SL_VAR_Os], 3 * stride, Oi);
    }
    fill_own_variables(batch, count);
    fill_seeds(batch, members);
    bind_overrides(c, Stage::Surface, batch);
    run(batch, execution);
    thread_.counters.add(Counter::points_surface, count);
    stride_ = stride;
    Ci_ = Ci;
    Oi_ = Oi;
    return planes;
}

// Lights may need how the points they light differ, whether the surface does or not.
HitShader::AuxPlanes HitShader::aux_planes(const ShadingClass& c, const rt::ShadeBatch& batch) {
    AuxPlanes aux;
    if (batch.aux_points_u() != nullptr) {
        aux = {*batch.aux_points_u(), *batch.aux_points_v(), true};
    }
    if (c.lights.needs_differences && aux.u.var[SL_VAR_P] == nullptr) {
        aux.u.var[SL_VAR_P] = batch_.P_u.data();
        aux.v.var[SL_VAR_P] = batch_.P_v.data();
        aux.wanted = true;
    }
    return aux;
}

// The volume between the eye and the surface; it takes Ci and Oi of the surface and gives those at
// the eye.
void HitShader::run_atmosphere(const ShadingClass& c, BatchSubject& subject,
                               std::span<const std::uint32_t> members) {
    const auto count = static_cast<std::uint32_t>(members.size());
    const ShaderEntry& shader = *c.atmosphere;
    rt::ShadeBatch& batch = thread_.volume;
    batch.begin(shader.current(), count);
    Execution execution(frame_, shader);
    execution.thread = &thread_;
    execution.batch = &batch;
    execution.subject = &subject;
    subject.atmosphere = {&shader, &batch};
    frame_.world->fill(subject_hits_, incident(count),
                       batch.instance().object().needed & geometry_variables, batch.stride(),
                       batch.points(), nullptr, nullptr);
    displace(batch.points(), nullptr, nullptr, count);
    fill_own_variables(batch, count);
    fill_seeds(batch, members);
    bind_overrides(c, Stage::Atmosphere, batch);
    const sl_points& planes = batch.points();
    float* const Ci = planes.var[SL_VAR_Ci];
    float* const Oi = planes.var[SL_VAR_Oi];
    if (Ci != nullptr) {
        std::copy_n(Ci_, 3 * stride_, Ci);
    }
    if (Oi != nullptr) {
        std::copy_n(Oi_, 3 * stride_, Oi);
    }
    ++thread_.batch_serial; // its lights are asked by another shader
    run(batch, execution);
    thread_.counters.add(Counter::points_volume, count);
    Ci_ = Ci != nullptr ? Ci : Ci_;
    Oi_ = Oi != nullptr ? Oi : Oi_;
}

geo::Incident HitShader::incident(std::uint32_t count) const {
    const auto all = [count](const std::array<float, Batch::size>& values) {
        return std::span<const float>(values.data(), count);
    };
    return {all(batch_.ox), all(batch_.oy), all(batch_.oz),       all(batch_.dx),
            all(batch_.dy), all(batch_.dz), all(batch_.footprint)};
}

void HitShader::fill_own_variables(rt::ShadeBatch& batch, std::uint32_t count) const {
    if (float* ncomps = batch.uniform(SL_VAR_ncomps)) {
        *ncomps = 3;
    }
    if (float* dtime = batch.plane(SL_VAR_dtime)) {
        const rib::Options& options = frame_.scene.options;
        std::fill_n(dtime, count, options.shutter_close - options.shutter_open);
    }
    const bool is_volume = batch.instance().object().type == SL_SHADER_volume;
    for (const sl_variable id : {SL_VAR_du, SL_VAR_dv}) {
        if (is_volume &&
            batch.has(id)) { // constants, so that area functions give 0 ([R] of sl.md 3.4)
            std::fill_n(batch.plane(id), count, 1.0f);
        }
    }
}

// random() must not depend on the batch, but differ from layer to layer of one ray.
void HitShader::fill_seeds(rt::ShadeBatch& batch, std::span<const std::uint32_t> members) const {
    if ((batch.instance().object().facts & (SL_FACT_random | SL_FACT_lights)) == 0) {
        return;
    }
    for (std::size_t i = 0; i < members.size(); ++i) {
        batch.seeds()[i] = mix(rays_.seed[ray_of(members[i])] + rays_.layer);
    }
}

void HitShader::run(rt::ShadeBatch& batch, Execution& execution) {
    if (thread_.trace != nullptr) {
        thread_.trace->before_shader(execution, batch);
    }
    const std::uint64_t start = base::ticks();
    if (batch.run({&service_table(), &execution}) != 0) {
        report_suspended(execution);
    }
    Counters& counters = thread_.counters;
    ShaderCounters& of_shader = counters.shader(execution.running.number);
    const std::uint64_t spent = base::ticks() - start;
    of_shader.add_time(spent);
    execution.running.spent_ticks.fetch_add(spent, std::memory_order_relaxed);
    if (&batch.instance() != execution.running.instance.get()) {
        thread_.counters.add(Counter::points_special, batch.count());
    }
    of_shader.add_batch(batch.count(), batch.num_packets(), execution.lanes());
    counters.add(Counter::batches);
    counters.add(Counter::packets, batch.num_packets());
    counters.add(Counter::lanes_offered, batch.num_packets() * execution.lanes());
    counters.add(Counter::lanes_live, batch.count());
    if (thread_.trace != nullptr) {
        thread_.trace->after_shader(execution, batch);
    }
}

// --- results

namespace {

// Planes are aligned to 64 bytes and padded to eight.
using base::Float4;

// Clamps the opacities, where they are about to be composited; colours stay (sl.md 5.2). False if a
// value is no number.
bool finish_planes(const float* Ci, float* Oi, std::size_t num_floats) {
    Float4 bad = {}; // x - x is 0 for numbers, NaN for the rest
    for (std::size_t at = 0; at < num_floats; at += 4) {
        const Float4 c = *reinterpret_cast<const Float4*>(Ci + at);
        auto& opacity = *reinterpret_cast<Float4*>(Oi + at);
        Float4 o = opacity;
        bad += (c - c) + (o - o);
        o = o < 0 ? Float4{} : o; // NaN stays, to be found
        opacity = o > 1 ? Float4{} + 1 : o;
    }
    return (bad[0] + bad[1]) + (bad[2] + bad[3]) == 0;
}

} // namespace

bool HitShader::scatter(std::span<const std::uint32_t> members) {
    const bool all_good = finish_planes(Ci_, Oi_, 3 * std::size_t{stride_});
    const std::size_t stride = stride_;
    for (std::size_t i = 0; i < members.size(); ++i) {
        Sample& out = out_[members[i]];
        for (std::size_t k = 0; k < 3; ++k) {
            out.color[k] = Ci_[k * stride + i];
            out.opacity[k] = Oi_[k * stride + i];
        }
    }
    return all_good;
}

// Before a volume takes them: its own light still comes from there.
void HitShader::drop_bad_surface(const ShaderEntry& shader, std::uint32_t count) {
    std::uint64_t num_bad = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
        float sum = 0; // x - x is 0 for numbers, NaN for the rest
        for (std::size_t at = i; at < 3 * std::size_t{stride_}; at += stride_) {
            sum += (Ci_[at] - Ci_[at]) + (Oi_[at] - Oi_[at]);
        }
        for (std::size_t at = i; sum != 0 && at < 3 * std::size_t{stride_}; at += stride_) {
            Ci_[at] = Oi_[at] = 0;
        }
        num_bad += sum != 0 ? 1 : 0;
    }
    thread_.counters.add(Counter::bad_values, num_bad);
    thread_.bad.note(shader, BadResult::Color, num_bad);
}

// What is no number becomes a transparent black point.
void HitShader::blacken_bad(std::span<const std::uint32_t> members, const ShaderEntry& shader) {
    std::uint64_t num_bad = 0;
    for (const std::uint32_t member : members) {
        Sample& out = out_[member];
        const auto is_good = [](const float* rgb) {
            return is_number(rgb[0]) && is_number(rgb[1]) && is_number(rgb[2]);
        };
        if (!is_good(out.color) || !is_good(out.opacity)) {
            out = {};
            if (outputs_ != nullptr) {
                const std::size_t n = outputs_->num_channels();
                std::ranges::fill(out_extra_.subspan(member * n, n), 0.0f);
            }
            ++num_bad;
        }
    }
    if (num_bad == 0) {
        return; // it was in the padding
    }
    thread_.counters.add(Counter::bad_values, num_bad);
    thread_.bad.note(shader, BadResult::Color, num_bad);
}

} // namespace trace
