// SPDX-License-Identifier: Apache-2.0
// The displacement shader of a batch, before its surface shader (sl.md 5.1): run if something of
// what it does reaches the shaders after it.
#include "tracer/hit_shader.h"

#include <algorithm>

namespace trace {

// What the shaders after the displacement need of the points.
NeededVariables HitShader::needed_after(const ShadeJob& job) const {
    const ShadingClass& c = class_of(job);
    NeededVariables needed{shown_variables(job.shading_class) | c.surface->object().needed,
                           c.surface->object().needed_aux};
    needed.aux |= c.lights.needs_differences ? std::uint64_t{1} << SL_VAR_P : 0;
    if (job.volume_shader != nullptr) {
        needed.main |= job.volume_shader->object().needed;
    }
    return needed;
}

bool HitShader::is_displaced(const ShadeJob& job, NeededVariables after) const {
    const ShadingClass& c = class_of(job);
    if (c.displacement == nullptr) {
        return false;
    }
    const bool is_shown =
        outputs_ != nullptr &&
        std::ranges::any_of(outputs_->sources(job.shading_class), [](const ChannelSource& s) {
            return s.from == ChannelSource::From::Displacement;
        });
    const bool matters = (changed_by(c.displacement->object()) & (after.main | after.aux)) != 0;
    return matters || is_shown || c.by_attributes; // displacement("x", v)
}

void HitShader::run_displacement(ShadeJob& job, NeededVariables after) {
    const ShadingClass& c = class_of(job);
    rt::ShadeBatch& batch = job.displacement;
    batch.begin(c.displacement->current(), job.count());
    job.displaced.begin(batch, after);
    Execution execution(frame_, *c.displacement);
    job.subject.displacement = {c.displacement, &batch};
    frame_.world->fill(job.hits, job.incident(), job.displaced.filled() & geometry_variables,
                       batch.stride(), job.displaced.points(), batch.aux_points_u(),
                       batch.aux_points_v());
    fill_own_variables(batch);
    fill_seeds(job, batch);
    bind_overrides(job, Stage::Displacement, batch);
    job.displaced.keep_position();
    run(job, batch, execution);
    job.displaced.finish();
    thread_.counters.add(Counter::points_displacement, job.count());
}

void HitShader::displace(const ShadeJob& job, const sl_points& main, const sl_points* aux_u,
                         const sl_points* aux_v) const {
    if (job.is_displaced) {
        job.displaced.apply(main, aux_u, aux_v, {job.incident(), camera_.perspective()});
    }
}

} // namespace trace
