// SPDX-License-Identifier: Apache-2.0
// Rays between two places that must not meet the surfaces their ends lie on. In: where they start
// (SpawnPoint) and a place on another surface, or a point in space. Out: origin, direction and tfar
// with error bounds at both ends; no global epsilon.
#pragma once

#include "geometry/world.h"

namespace geo {

struct ShadowSegment {
    base::V3f origin, direction;
    float tfar = 1;
};

// Rounding of a difference of points and of its sum with one: by how much a ray aimed at
// from + direction may miss it.
[[nodiscard]] float far_end_error(const base::V3f& from, const base::V3f& direction);

// To a point in space: ends short of it by the point's error.
[[nodiscard]] ShadowSegment segment_to(const base::V3f& origin, const base::V3f& end);

// To a place on a surface: ends outside of that surface's error and the ray's.
[[nodiscard]] ShadowSegment segment_to(const base::V3f& origin, const SpawnPoint& end);

// From a place on a surface; it starts on the side the end lies on.
[[nodiscard]] ShadowSegment segment_between(const SpawnPoint& from, const SpawnPoint& end);
[[nodiscard]] ShadowSegment segment_between(const SpawnPoint& from, const base::V3f& end);

} // namespace geo
