// SPDX-License-Identifier: Apache-2.0
#include "tracer/hit_shader.h"

#include "runtime/base/ticks.h"
#include "tracer/pixel_trace.h"
#include "tracer/ray_levels.h"
#include "tracer/services.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace trace {

namespace {

constexpr std::uint64_t bit(sl_variable id) {
    return 1ULL << id;
}

} // namespace

HitShader::HitShader(const FrameContext& frame, const Camera& camera, const ShadingClasses& classes,
                     const OutputBindings* outputs, ThreadState& thread)
    : frame_(frame), camera_(camera), classes_(classes),
      outputs_(outputs != nullptr && outputs->num_channels() > 0 ? outputs : nullptr),
      thread_(thread), group_of_class_(classes.size(), geo::no_id) {
    if (!thread_.jobs) {
        thread_.jobs = std::make_unique<ShadeJobs>();
    }
}

void HitShader::shade(const ShadingRays& rays, std::span<const geo::Hit> hits,
                      std::span<Sample> out, std::span<float> out_extra, ShadeObserver* observer) {
    rays_ = rays;
    hits_ = hits;
    out_ = out;
    out_extra_ = out_extra;
    observer_ = observer;
    group_hits(hits);
    for (const Group& group : groups_) {
        shade_group(group);
    }
    finish_waiting();
}

void HitShader::shade_group(const Group& group) {
    const std::span<std::uint32_t> members(members_.data() + group.begin, group.count);
    const bool is_miss = group.shading_class == geo::no_id;
    for (std::size_t begin = 0; begin < members.size();) {
        const std::size_t end = is_miss || classes_[group.shading_class].overrides.empty()
                                    ? members.size()
                                    : equal_values(classes_[group.shading_class], members, begin);
        for (; begin < end; begin += std::min<std::size_t>(SL_BATCH_MAX, end - begin)) {
            const auto batch =
                members.subspan(begin, std::min<std::size_t>(SL_BATCH_MAX, end - begin));
            is_miss ? shade_misses(group, batch) : shade_batch(group, batch);
        }
    }
    thread_.counters.add(Counter::hits, is_miss ? 0 : members.size());
}

const ShaderEntry* HitShader::volume_of(const Group& group) const {
    const Media* media = thread_.levels != nullptr ? &thread_.levels->media() : nullptr;
    const bool is_open = media == nullptr || media->is_open(group.medium);
    if (rays_.level == 0 && is_open && group.shading_class != geo::no_id) {
        return classes_[group.shading_class].atmosphere;
    }
    return media != nullptr && frame_.shaders != nullptr
               ? frame_.shaders->get(media->volume(group.medium))
               : nullptr;
}

// --- one batch

// Something about the points is random: their shaders, their lights or their rays.
bool HitShader::needs_seeds(const ShadeJob& job) const {
    const auto is_random = [](const ShaderEntry* shader) {
        constexpr std::uint32_t facts =
            SL_FACT_random | SL_FACT_lights | SL_FACT_ambient | SL_FACT_traces;
        return shader != nullptr && (shader->object().facts & facts) != 0;
    };
    return is_random(job.volume_shader) ||
           (job.shading_class != geo::no_id &&
            (is_random(class_of(job).surface) || is_random(class_of(job).displacement)));
}

void HitShader::begin(ShadeJob& job, const Group& group,
                      std::span<const std::uint32_t> members) const {
    job.shading_class = group.shading_class;
    job.members = members;
    job.volume_shader = volume_of(group);
    job.is_displaced = false;
    job.subject = {};
    job.subject.attributes = group.attributes;
    job.subject.misses = &job.misses;
    RaySubject& rays = job.subject.rays;
    rays.level = rays_.level;
    rays.kind = rays_.kind;
    rays.diffuse_level = rays_.diffuse_level;
    const std::size_t n = members.size();
    for (std::size_t i = 0; needs_seeds(job) && i < n; ++i) {
        job.seeds[i] = PixelHash::mix(rays_.seed[ray_of(members[i])] + rays_.layer);
        rays.seeds = {job.seeds.data(), n};
    }
    if (!rays_.media.empty()) {
        for (std::size_t i = 0; i < n; ++i) {
            job.media[i] = rays_.media[members[i]];
        }
        rays.media = {job.media.data(), n};
    }
    for (std::size_t i = 0; !rays_.labels.empty() && i < n; ++i) {
        job.labels[i] = rays_.labels[ray_of(members[i])];
        rays.labels = {job.labels.data(), n};
    }
    for (std::size_t i = 0; thread_.trace != nullptr && i < n; ++i) {
        const std::uint32_t ray = ray_of(members[i]);
        job.samples[i] = rays_.samples.empty() ? ray : rays_.samples[ray];
        rays.samples = {job.samples.data(), n};
    }
}

void HitShader::shade_batch(const Group& group, std::span<const std::uint32_t> members) {
    ShadeJob& job = thread_.jobs->take();
    begin(job, group, members);
    const ShadingClass& c = class_of(job);
    const NeededVariables after = needed_after(job);
    job.is_displaced = is_displaced(job, after);
    NeededVariables needed = after;
    if (job.is_displaced) {
        const auto before = DisplacedBatch::needed_before(c.displacement->object(), after);
        needed = {after.main | before.main, after.aux | before.aux};
    }
    gather_hits(job);
    gather(job, needed);
    job.subject.hits = job.hits;
    job.subject.lights = &c.lights;
    if (job.has_rays) {
        job.subject.incident = job.incident();
    }
    if (job.is_displaced) {
        run_displacement(job, after);
    }
    Execution& surface = job.surface_execution.emplace(frame_, *c.surface);
    surface.batch = &job.surface;
    prepare_surface(job);
    if (run(job, job.surface, surface) != 0) {
        waiting_.push_back(&job);
        thread_.counters.add(Counter::batches_waiting);
        if (waiting_.size() >= max_waiting) {
            finish_waiting();
        }
        return;
    }
    finish(job);
}

// The surface shader is done.
void HitShader::finish(ShadeJob& job) {
    const ShadingClass& c = class_of(job);
    thread_.counters.add(Counter::points_surface, job.count());
    const ShaderEntry* last = c.surface;
    if (job.volume_shader != nullptr) {
        drop_bad_surface(job);
        run_volume(job);
        last = job.volume_shader;
    }
    const bool all_good = scatter(job);
    if (outputs_ != nullptr) {
        scatter_outputs(job);
    }
    if (!all_good) {
        blacken_bad(job, *last);
    }
    if (thread_.trace != nullptr) {
        thread_.trace->begin_batch(job.subject.rays.samples);
        thread_.trace->shaded(job.members, out_);
    }
    if (observer_ != nullptr) {
        observer_->finished(job);
    }
    thread_.jobs->give(job);
}

// All that waiting batches ask is answered at once, until they ask no more.
void HitShader::finish_waiting() {
    while (!waiting_.empty()) {
        thread_.counters.add(Counter::ray_rounds);
        if (frame_.interrupted != nullptr && frame_.interrupted()) {
            thread_.is_abandoned = true;
        }
        thread_.levels->answer(waiting_);
        std::size_t kept = 0;
        for (ShadeJob* job : waiting_) {
            if (run(*job, job->surface, *job->surface_execution) != 0) {
                waiting_[kept++] = job;
            } else {
                finish(*job);
            }
        }
        waiting_.resize(kept);
    }
}

// --- inputs

// Nothing is gathered where nothing depends on the rays.
void HitShader::gather(ShadeJob& job, NeededVariables needed) const {
    const ShadingClass& c = class_of(job);
    const bool traces = (c.surface->object().facts & SL_FACT_traces) != 0;
    const bool needs_footprint =
        traces || (needed.main & (bit(SL_VAR_du) | bit(SL_VAR_dv))) != 0 || needed.aux != 0;
    // incident(), opposite(), sides of the surface, rayinfo(); which side is seen.
    const bool asks = c.by_attributes || c.lights.is_indirect;
    job.has_rays = needs_footprint || asks || (needed.main & bit(SL_VAR_I)) != 0;
    if (!job.has_rays) {
        return;
    }
    gather_origins(job);
    for (std::size_t i = 0; needs_footprint && i < job.members.size(); ++i) {
        gather_footprint(job, i);
    }
    job.subject.rays.lengths = {job.length.data(), job.members.size()};
    job.subject.rays.spread = needs_footprint
                                  ? std::span<const float>(job.spread.data(), job.members.size())
                                  : std::span<const float>();
}

void HitShader::gather_origins(ShadeJob& job) const {
    for (std::size_t i = 0; i < job.members.size(); ++i) {
        const std::uint32_t ray = ray_of(job.members[i]);
        const geo::RayPacket& packet = rays_.packets[ray / geo::RayPacket::size];
        const std::size_t lane = ray % geo::RayPacket::size;
        job.ox[i] = packet.ox[lane], job.oy[i] = packet.oy[lane], job.oz[i] = packet.oz[lane];
        job.dx[i] = packet.dx[lane], job.dy[i] = packet.dy[lane], job.dz[i] = packet.dz[lane];
        const float t = job.hits.empty() ? 0 : distance_of(job, i);
        job.length[i] =
            t * std::sqrt(job.dx[i] * job.dx[i] + job.dy[i] * job.dy[i] + job.dz[i] * job.dz[i]);
    }
}

void HitShader::gather_footprint(ShadeJob& job, std::size_t i) const {
    const std::uint32_t ray = ray_of(job.members[i]);
    const float t = distance_of(job, i);
    if (!rays_.cones.empty()) {
        const RayCone& cone = rays_.cones[ray];
        job.footprint[i] = cone.width(t);
        job.spread[i] = cone.spread(t);
        job.widening[i] = job.footprint[i] > 0 ? t * job.spread[i] / job.footprint[i] : 1;
        return;
    }
    if (rays_.level > 0) { // whoever traces it asks for no filter
        job.footprint[i] = job.spread[i] = job.widening[i] = 0;
        return;
    }
    const float spacing_px =
        classes_.facts(frame_.world->binding(job.hits[i]).attributes).spacing_px;
    job.footprint[i] = camera_.footprint(job.oz[i] + t * job.dz[i], spacing_px);
    const float length = job.length[i];
    job.spread[i] = camera_.perspective() && length > 0 ? job.footprint[i] / length : 0;
    job.widening[i] = 1;
}

// Neighbouring rays mostly meet one class: then the hits are used where they are.
void HitShader::gather_hits(ShadeJob& job) const {
    const std::span<const std::uint32_t> members = job.members;
    const bool in_order = class_of(job).overrides.empty(); // else sorted by value
    if (in_order && members.back() - members.front() + 1 == members.size()) {
        job.hits = hits_.subspan(members.front(), members.size());
        return;
    }
    for (std::size_t i = 0; i < members.size(); ++i) {
        job.own_hits[i] = hits_[members[i]];
    }
    job.hits = {job.own_hits.data(), members.size()};
}

// Ci and Oi start as Cs and Os ([R] of sl.md 5.2), so the geometry is asked for those whatever the
// shader needs; where it has no planes for them they go straight to the results.
void HitShader::prepare_surface(ShadeJob& job) {
    const ShadingClass& c = class_of(job);
    rt::ShadeBatch& batch = job.surface;
    const bool is_sent_to = observer_ != nullptr && observer_->sends();
    // Special instances have their parameters no more.
    const rt::ShaderInstance& instance = is_sent_to ? *c.surface->instance : c.surface->current();
    batch.begin(instance, job.count());
    job.subject.surface = {c.surface, &batch};
    job.stride = batch.stride();
    job.planes = batch.points();
    const std::uint64_t shown = shown_variables(job.shading_class);
    add_shown_planes(job, shown);
    sl_points& planes = job.planes;
    const auto or_scratch = [](float*& plane, std::array<float, 3 * ShadeJob::size>& scratch) {
        plane = plane != nullptr ? plane : scratch.data();
    };
    or_scratch(planes.var[SL_VAR_Ci], job.own_Ci);
    or_scratch(planes.var[SL_VAR_Oi], job.own_Oi);
    job.Ci = planes.var[SL_VAR_Ci];
    job.Oi = planes.var[SL_VAR_Oi];
    const bool own_Cs = planes.var[SL_VAR_Cs] != nullptr, own_Os = planes.var[SL_VAR_Os] != nullptr;
    planes.var[SL_VAR_Cs] = own_Cs ? planes.var[SL_VAR_Cs] : job.Ci;
    planes.var[SL_VAR_Os] = own_Os ? planes.var[SL_VAR_Os] : job.Oi;
    const std::uint64_t needed = instance.object().needed | shown | bit(SL_VAR_Cs) | bit(SL_VAR_Os);
    const AuxPlanes aux = aux_planes(c, job);
    frame_.world->fill(job.hits, job.incident(), needed & geometry_variables, job.stride, planes,
                       aux.at_u(), aux.at_v());
    displace(job, planes, aux.at_u(), aux.at_v());
    job.subject.P_u = aux.u.var[SL_VAR_P];
    job.subject.P_v = aux.v.var[SL_VAR_P];
    if (own_Cs) {
        std::copy_n(planes.var[SL_VAR_Cs], 3 * job.stride, job.Ci);
    }
    if (own_Os) {
        std::copy_n(planes.var[SL_VAR_Os], 3 * job.stride, job.Oi);
    }
    fill_own_variables(batch);
    fill_seeds(job, batch);
    bind_overrides(job, Stage::Surface, batch);
    if (is_sent_to) {
        observer_->starting(job);
    }
}

// Lights may need how the points they light differ, whether the surface does or not.
HitShader::AuxPlanes HitShader::aux_planes(const ShadingClass& c, ShadeJob& job) {
    AuxPlanes aux;
    if (job.surface.aux_points_u() != nullptr) {
        aux = {*job.surface.aux_points_u(), *job.surface.aux_points_v(), true};
    }
    if (c.lights.needs_differences && aux.u.var[SL_VAR_P] == nullptr) {
        aux.u.var[SL_VAR_P] = job.P_u.data();
        aux.v.var[SL_VAR_P] = job.P_v.data();
        aux.wanted = true;
    }
    return aux;
}

void HitShader::fill_own_variables(rt::ShadeBatch& batch) const {
    if (float* ncomps = batch.uniform(SL_VAR_ncomps)) {
        *ncomps = 3;
    }
    if (float* dtime = batch.plane(SL_VAR_dtime)) {
        const rib::Options& options = frame_.scene.options;
        std::fill_n(dtime, batch.count(), options.shutter_close - options.shutter_open);
    }
    const bool is_volume = batch.instance().object().type == SL_SHADER_volume;
    for (const sl_variable id : {SL_VAR_du, SL_VAR_dv}) {
        if (is_volume &&
            batch.has(id)) { // constants, so that area functions give 0 ([R] of sl.md 3.4)
            std::fill_n(batch.plane(id), batch.count(), 1.0f);
        }
    }
}

// random() must not depend on the batch, but differ from layer to layer of one ray.
void HitShader::fill_seeds(const ShadeJob& job, rt::ShadeBatch& batch) const {
    if ((batch.instance().object().facts & (SL_FACT_random | SL_FACT_lights)) != 0) {
        std::copy_n(job.seeds.begin(), job.count(), batch.seeds());
    }
}

// --- running

std::uint32_t HitShader::run(ShadeJob& job, rt::ShadeBatch& batch, Execution& execution) {
    const bool is_new = execution.thread == nullptr;
    if (is_new) {
        execution.thread = &thread_;
        execution.batch = &batch;
        execution.subject = &job.subject;
        execution.ray_level = rays_.level;
        execution.ray_kind = rays_.kind;
        execution.serial = ++thread_.batch_serial;
        count_run(batch, execution);
    }
    if (thread_.trace != nullptr) {
        thread_.trace->begin_batch(job.subject.rays.samples);
        is_new ? thread_.trace->before_shader(execution, batch) : void();
    }
    const std::uint64_t start = base::ticks();
    std::uint32_t num_waiting = batch.run({&service_table(), &execution});
    if (num_waiting != 0 && (&batch != &job.surface || thread_.levels == nullptr)) {
        report_suspended(execution);
        num_waiting = 0;
    }
    const std::uint64_t spent = base::ticks() - start;
    thread_.counters.shader(execution.running.number).add_time(spent);
    execution.running.spent_ticks.fetch_add(spent, std::memory_order_relaxed);
    if (thread_.trace != nullptr && num_waiting == 0) {
        thread_.trace->after_shader(execution, batch);
    }
    return num_waiting;
}

void HitShader::count_run(rt::ShadeBatch& batch, const Execution& execution) {
    static constexpr std::pair<Counter, Counter> by_level[] = {
        {Counter::lanes_offered_1, Counter::lanes_live_1},
        {Counter::lanes_offered_2, Counter::lanes_live_2},
        {Counter::lanes_offered_3, Counter::lanes_live_3},
        {Counter::lanes_offered_4, Counter::lanes_live_4},
    };
    Counters& counters = thread_.counters;
    if (&batch.instance() != execution.running.instance.get()) {
        counters.add(Counter::points_special, batch.count());
    }
    const std::uint64_t offered = batch.num_packets() * execution.lanes();
    counters.shader(execution.running.number)
        .add_batch(batch.count(), batch.num_packets(), execution.lanes());
    counters.add(Counter::batches);
    counters.add(Counter::packets, batch.num_packets());
    counters.add(Counter::lanes_offered, offered);
    counters.add(Counter::lanes_live, batch.count());
    if (rays_.level > 0) {
        const auto& [of_offered, of_live] = by_level
            [std::min<std::size_t>(static_cast<std::size_t>(rays_.level), std::size(by_level)) - 1];
        counters.add(of_offered, offered);
        counters.add(of_live, batch.count());
    }
}

} // namespace trace
