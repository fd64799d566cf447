// SPDX-License-Identifier: Apache-2.0
// What rays need to know of the point they leave from. In: a running shader and the index of a
// point in its batch. Out: where rays may start, their time, seed and medium. Points that lie on no
// hit (lights, marches through volumes) start where they are.
#pragma once

#include "geometry/hit.h"
#include "runtime/base/vec.h"
#include "tracer/media.h"

#include <cstdint>

namespace trace {

class Execution;

// The hit that P, a point in camera space, lies on; null: none. P is that of the batch's point, or
// it is not on it.
[[nodiscard]] const geo::Hit* hit_at(const Execution& execution, std::uint32_t point,
                                     const base::V3f& P);
[[nodiscard]] base::V3f ray_origin(const Execution& execution, std::uint32_t point,
                                   const base::V3f& P, const base::V3f& direction);
[[nodiscard]] std::uint32_t point_seed(const Execution& execution, std::uint32_t point);
[[nodiscard]] float point_time(const Execution& execution, std::uint32_t point);
// What the rays that found the point came through: rays back to that side go on in it.
[[nodiscard]] MediumId point_medium(const Execution& execution, std::uint32_t point);
[[nodiscard]] int diffuse_level(const Execution& execution);

} // namespace trace
