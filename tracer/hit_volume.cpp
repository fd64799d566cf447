// SPDX-License-Identifier: Apache-2.0
// The volume between a surface and where its ray comes from, or behind which there is nothing
// (sl.md 3.4, 5.1, 5.7). In: Ci and Oi of the surface. Out: what arrives at the origin. P is the
// surface, P - I where the ray entered the volume: the ray's origin, or the surface it went
// through.
#include "tracer/hit_shader.h"
#include "tracer/pixel_trace.h"
#include "tracer/ray_levels.h"
#include "tracer/ray_packets.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace trace {

void HitShader::run_volume(ShadeJob& job) {
    const ShadingClass& c = class_of(job);
    const ShaderEntry& shader = *job.volume_shader;
    rt::ShadeBatch& batch = job.volume;
    batch.begin(shader.current(), job.count());
    Execution execution(frame_, shader);
    job.subject.atmosphere = {&shader, &batch};
    frame_.world->fill(job.hits, job.incident(),
                       batch.instance().object().needed & geometry_variables, batch.stride(),
                       batch.points(), nullptr, nullptr);
    displace(job, batch.points(), nullptr, nullptr);
    begin_segment(job, batch);
    fill_own_variables(batch);
    fill_seeds(job, batch);
    if (&shader == c.atmosphere && rays_.level == 0) {
        bind_overrides(job, Stage::Atmosphere, batch);
    }
    const sl_points& planes = batch.points();
    float* const Ci = planes.var[SL_VAR_Ci];
    float* const Oi = planes.var[SL_VAR_Oi];
    if (Ci != nullptr) {
        std::copy_n(job.Ci, 3 * job.stride, Ci);
    }
    if (Oi != nullptr) {
        std::copy_n(job.Oi, 3 * job.stride, Oi);
    }
    // Inside of a solid its lights count, not those of what lies in it or shows through it.
    const LightList* const lights = job.subject.lights;
    const std::uint32_t solid =
        rays_.media.empty() ? rib::none : thread_.levels->media().attributes(job.media[0]);
    if (solid != rib::none) {
        job.subject.lights = &classes_[classes_.facts(solid).shading_class].lights;
    }
    run(job, batch, execution);
    job.subject.lights = lights;
    thread_.counters.add(Counter::points_volume, job.count());
    job.Ci = Ci != nullptr ? Ci : job.Ci;
    job.Oi = Oi != nullptr ? Oi : job.Oi;
}

// I of a volume begins where the ray came through the last surface.
void HitShader::begin_segment(const ShadeJob& job, rt::ShadeBatch& batch) const {
    for (std::size_t i = 0; !rays_.since.empty() && batch.has(SL_VAR_I) && i < job.count(); ++i) {
        const float since = rays_.since[job.members[i]];
        const float d[] = {job.dx[i], job.dy[i], job.dz[i]};
        for (int k = 0; k < 3; ++k) {
            batch.plane(SL_VAR_I, k)[i] -= since * d[k];
        }
    }
}

// Where a ray that meets nothing ends, in units of its direction: where it was told to, at the far
// clipping plane's distance, or nowhere.
float HitShader::far_end(std::uint32_t ray) const {
    const geo::RayPacket& packet = rays_.packets[ray / geo::RayPacket::size];
    const std::size_t lane = ray % geo::RayPacket::size;
    const float d2 = packet.dx[lane] * packet.dx[lane] + packet.dy[lane] * packet.dy[lane] +
                     packet.dz[lane] * packet.dz[lane];
    const auto far = static_cast<float>(camera_.far_clip());
    const float end = rays_.level > 0 ? far / std::sqrt(d2) : far;
    const float told =
        packet.tfar[lane] < very_far ? packet.tfar[lane] : std::numeric_limits<float>::infinity();
    return std::min(end, told);
}

// Only a volume: nothing lies behind it.
void HitShader::shade_misses(const Group& group, std::span<const std::uint32_t> members) {
    ShadeJob& job = thread_.jobs->take();
    begin(job, group, members);
    job.hits = {};
    job.has_rays = false;
    gather_origins(job);
    if (group.attributes != rib::none) {
        job.subject.lights = &classes_[classes_.facts(group.attributes).shading_class].lights;
    }
    const ShaderEntry& shader = *job.volume_shader;
    rt::ShadeBatch& batch = job.volume;
    batch.begin(shader.current(), job.count());
    Execution execution(frame_, shader);
    job.subject.atmosphere = {&shader, &batch};
    for (std::size_t i = 0; i < members.size(); ++i) {
        const float end = far_end(ray_of(members[i]));
        const float since = rays_.since.empty() ? 0 : rays_.since[members[i]];
        const float o[] = {job.ox[i], job.oy[i], job.oz[i]};
        const float d[] = {job.dx[i], job.dy[i], job.dz[i]};
        for (int k = 0; k < 3; ++k) {
            if (batch.has(SL_VAR_P)) {
                batch.plane(SL_VAR_P, k)[i] = o[k] + end * d[k];
            }
            if (batch.has(SL_VAR_I)) {
                batch.plane(SL_VAR_I, k)[i] = (end - since) * d[k];
            }
        }
    }
    fill_own_variables(batch);
    fill_seeds(job, batch);
    run(job, batch, execution);
    thread_.counters.add(Counter::points_volume, job.count());
    finish_misses(job);
    thread_.jobs->give(job);
}

void HitShader::finish_misses(ShadeJob& job) {
    const sl_points& planes = job.volume.points();
    const auto or_black = [](float* plane, std::array<float, 3 * ShadeJob::size>& black) {
        black.fill(0);
        return plane != nullptr ? plane : black.data();
    };
    job.stride = job.volume.stride();
    job.Ci = or_black(planes.var[SL_VAR_Ci], job.own_Ci);
    job.Oi = or_black(planes.var[SL_VAR_Oi], job.own_Oi);
    if (!scatter(job)) {
        blacken_bad(job, *job.volume_shader);
    }
    if (thread_.trace != nullptr) {
        thread_.trace->begin_batch(job.subject.rays.samples);
        thread_.trace->shaded(job.members, out_);
    }
}

} // namespace trace
