// SPDX-License-Identifier: Apache-2.0
// The displacement shader of a batch, before its surface shader (sl.md 5.1): run if something of
// what it does reaches the shaders after it.
#include "tracer/hit_shader.h"

#include <algorithm>

namespace trace {

// What the shaders after the displacement need of the points.
NeededVariables HitShader::needed_after(const Group& group) const {
    const ShadingClass& c = classes_[group.shading_class];
    NeededVariables needed{shown_variables(group.shading_class) | c.surface->object().needed,
                           c.surface->object().needed_aux};
    needed.aux |= c.lights.needs_differences ? std::uint64_t{1} << SL_VAR_P : 0;
    if (c.atmosphere != nullptr) {
        needed.main |= c.atmosphere->object().needed;
    }
    return needed;
}

bool HitShader::is_displaced(const Group& group, NeededVariables after) const {
    const ShadingClass& c = classes_[group.shading_class];
    if (c.displacement == nullptr) {
        return false;
    }
    const bool is_shown =
        outputs_ != nullptr &&
        std::ranges::any_of(outputs_->sources(group.shading_class), [](const ChannelSource& s) {
            return s.from == ChannelSource::From::Displacement;
        });
    const bool matters = (changed_by(c.displacement->object()) & (after.main | after.aux)) != 0;
    return matters || is_shown || c.by_attributes; // displacement("x", v)
}

void HitShader::run_displacement(const ShadingClass& c, NeededVariables after,
                                 BatchSubject& subject, std::span<const std::uint32_t> members) {
    const auto count = static_cast<std::uint32_t>(members.size());
    rt::ShadeBatch& batch = thread_.displacement;
    batch.begin(c.displacement->current(), count);
    displaced_.begin(batch, after);
    Execution execution(frame_, *c.displacement);
    execution.thread = &thread_;
    execution.batch = &batch;
    execution.subject = &subject;
    subject.displacement = {c.displacement, &batch};
    frame_.world->fill(subject_hits_, incident(count), displaced_.filled() & geometry_variables,
                       batch.stride(), displaced_.points(), batch.aux_points_u(),
                       batch.aux_points_v());
    fill_own_variables(batch, count);
    fill_seeds(batch, members);
    bind_overrides(c, Stage::Displacement, batch);
    displaced_.keep_position();
    run(batch, execution);
    displaced_.finish();
    ++thread_.batch_serial; // its lights are asked by another shader
    thread_.counters.add(Counter::points_displacement, count);
}

} // namespace trace
