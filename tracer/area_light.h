// SPDX-License-Identifier: Apache-2.0
// Where on an area light, or in the disc of a distant one, the samples of a point lie. In: the
// light's surfaces, the point, its seed, the number of the sample. Out: a place and the weight of
// what the light shader says there. The mean over samples is the mean over the surface (design.md,
// section 7), whichever way places are chosen (docs/lights.md).
#pragma once

#include "geometry/area_set.h"
#include "runtime/base/vec.h"
#include "tracer/lights.h"

#include <array>
#include <cstdint>

namespace trace {

// Sample `index` of a point's set, in [0,1)^2: an Owen-scrambled (0,2)-sequence [Burley20], so that
// any first 2^n lie evenly.
[[nodiscard]] std::array<float, 2> light_pattern(std::uint32_t seed, std::uint32_t index);

// Seed of a point for one light. Points of one ray (a march through a volume) differ by place.
[[nodiscard]] std::uint32_t light_seed(std::uint32_t point_seed, std::uint32_t light,
                                       const base::V3f& P);

// Every so many points look at the part of a light that by_angle() cannot choose.
constexpr std::uint32_t hidden_every = 64;

// A light that is sampled by solid angle has one sample more than asked for: the hidden part, which
// one point in hidden_every looks at, with so much more weight.
[[nodiscard]] inline bool has_hidden_sample(const LightInfo& light) {
    return light.by_angle && light.area->num_elements() == 1;
}

// weight: of Cl, the number of samples taken into account; 0: no light from there.
[[nodiscard]] geo::AreaPoint place_on_light(const LightInfo& light, const base::V3f& P,
                                            std::uint32_t seed, std::int32_t sample);

// Runs the light for a few points about it and finds which way of choosing places has the smaller
// error with this shader: sets by_angle. Before the first ray; the same for every run.
void learn_area(const FrameContext& frame, rib::LightId id, LightInfo& light);

// A unit vector within `angle` of a unit axis, uniform in solid angle.
[[nodiscard]] base::V3f direction_in_cone(const base::V3f& axis, float angle,
                                          const std::array<float, 2>& at);

} // namespace trace
