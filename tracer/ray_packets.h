// SPDX-License-Identifier: Apache-2.0
// Small helpers for rays in packets, and for what they meet.
#pragma once

#include "geometry/world.h"
#include "runtime/base/vec.h"

#include <cstddef>
#include <cstdint>

namespace trace {

// Distance to nothing, as the Shading Language sees it; rays that long are meant to be endless.
constexpr float very_far = 1e30f;

struct PlainRay {
    base::V3f origin, direction;
    float tfar = 0, time = 0;
    std::uint32_t mask = 0;
};

inline void set_ray(geo::RayPacket& to, std::size_t lane, const PlainRay& ray) {
    to.ox[lane] = ray.origin.x, to.oy[lane] = ray.origin.y, to.oz[lane] = ray.origin.z;
    to.dx[lane] = ray.direction.x, to.dy[lane] = ray.direction.y, to.dz[lane] = ray.direction.z;
    to.tnear[lane] = 0;
    to.tfar[lane] = ray.tfar;
    to.time[lane] = ray.time;
    to.mask[lane] = ray.mask;
    to.active |= 1U << lane;
}

// Variables at one hit that do not depend on the ray: planes of SL_LANES_MAX floats, lane 0.
void fill_one(const geo::World& world, const geo::Hit& hit, const sl_points& points);
// Ng of the undisplaced surface.
[[nodiscard]] base::V3f geometric_normal(const geo::World& world, const geo::Hit& hit);

} // namespace trace
