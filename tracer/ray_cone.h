// SPDX-License-Identifier: Apache-2.0
// How wide a ray is: the distance, across the ray, to the rays of neighbouring shading samples, as
// a function of the length travelled. Made from the differences of origin and direction at the
// auxiliary points ([Igehy99]'s ray differentials without their orientation): in u and in v the
// square of that distance is a parabola of the length, and the width is their geometric mean.
#pragma once

#include "runtime/base/vec.h"

namespace trace {

struct RayCone {
    // Square of the distance to the neighbour in u (v): [0] + 2 [1] t + [2] t^2.
    float u[3] = {0, 0, 0}, v[3] = {0, 0, 0};

    // A width that grows linearly.
    [[nodiscard]] static RayCone from(float width, float spread);
    // direction: unit; D_u, D_v: how it differs.
    [[nodiscard]] static RayCone from(const base::V3d& direction, const base::V3d& P_u,
                                      const base::V3d& P_v, const base::V3d& D_u,
                                      const base::V3d& D_v);

    [[nodiscard]] bool is_empty() const { return u[0] == 0 && u[2] == 0 && v[0] == 0 && v[2] == 0; }
    [[nodiscard]] float width(float t) const;
    // Growth of the width per unit of length, there.
    [[nodiscard]] float spread(float t) const;
    // Never narrower than a cone from one point: a ray that stands for a solid angle.
    void widen(float spread);
};

} // namespace trace
