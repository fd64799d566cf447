// SPDX-License-Identifier: Apache-2.0
#include "tracer/ray_packets.h"

namespace trace {

base::V3f geometric_normal(const geo::World& world, const geo::Hit& hit) {
    alignas(64) float planes[3 * SL_LANES_MAX] = {};
    sl_points points = {};
    points.var[SL_VAR_Ng] = planes;
    world.fill({&hit, 1}, {}, 1ULL << SL_VAR_Ng, SL_LANES_MAX, points, nullptr, nullptr);
    return {planes[0], planes[SL_LANES_MAX], planes[2 * SL_LANES_MAX]};
}

} // namespace trace
