// SPDX-License-Identifier: Apache-2.0
#include "tracer/ray_packets.h"

namespace trace {

void fill_one(const geo::World& world, const geo::Hit& hit, const sl_points& points) {
    static constexpr float nothing[1] = {};
    static constexpr std::span<const float> none(nothing);
    std::uint64_t needed = 0;
    for (int id = 0; id < SL_VAR_COUNT; ++id) {
        needed |= points.var[id] != nullptr ? std::uint64_t{1} << id : 0;
    }
    world.fill({&hit, 1}, {none, none, none, none, none, none, none}, needed, SL_LANES_MAX, points,
               nullptr, nullptr);
}

base::V3f geometric_normal(const geo::World& world, const geo::Hit& hit) {
    alignas(64) float planes[3 * SL_LANES_MAX] = {};
    sl_points points = {};
    points.var[SL_VAR_Ng] = planes;
    fill_one(world, hit, points);
    return {planes[0], planes[SL_LANES_MAX], planes[2 * SL_LANES_MAX]};
}

} // namespace trace
