// SPDX-License-Identifier: Apache-2.0
// Directions that fill a cone: number `sample` of `samples`, well spread among themselves, shifted
// by a seed so that points differ. Pure. Hammersley's points under a Cranley-Patterson rotation
// [pbrt4] 8.
#pragma once

#include "runtime/base/vec.h"

#include <cstdint>

namespace trace {

enum class ConeDistribution : std::uint8_t { Uniform, Cosine };

struct ConeSample {
    std::uint32_t seed = 0;
    int sample = 0, samples = 1;
    float shift = 1; // of the rotation: 0 gives all points the same directions
    ConeDistribution distribution = ConeDistribution::Uniform;
};

// axis: unit. half_angle in radians, cosine-weighted cones end at a right angle.
[[nodiscard]] base::V3d cone_direction(const base::V3d& axis, double half_angle,
                                       const ConeSample& which);
// Solid angle, steradian.
[[nodiscard]] double cone_solid_angle(double half_angle);

} // namespace trace
