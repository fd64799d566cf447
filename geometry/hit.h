// SPDX-License-Identifier: Apache-2.0
// What a ray met: enough to rebuild everything about the point from the surface itself, never from
// origin + t * direction. Displacement, radiosity and ray tracing share this record.
#pragma once

#include <cstdint>
#include <limits>

namespace geo {

constexpr std::uint32_t no_id = std::numeric_limits<std::uint32_t>::max();

struct Hit {
    std::uint32_t shape = no_id;    // index into World's shapes; no_id = missed
    std::uint32_t part = 0;         // triangle, sub-patch, segment ... within the shape
    std::uint32_t instance = no_id; // index into Scene::instances, or no_id
    float u = 0,
          v = 0;    // on the part: barycentric (triangles) or local parameters of the true surface
    float t = 0;    // ray parameter; the direction is not normalised
    float time = 0; // shutter time of the ray

    [[nodiscard]] bool valid() const { return shape != no_id; }
};
static_assert(sizeof(Hit) <= 64);

// Eight rays in camera space; planes so that they go to Embree as they are. tnear/tfar in units of
// the direction.
struct alignas(32) RayPacket {
    static constexpr int size = 8;
    float ox[size], oy[size], oz[size];
    float dx[size], dy[size], dz[size];
    float tnear[size], tfar[size];
    float time[size];
    std::uint32_t mask[size]; // RayMask bits
    std::uint32_t active;     // one bit per ray
};

// What kind of ray sees which shapes (visibility attributes).
enum RayMask : std::uint32_t { CameraRay = 1, ReflectionRay = 2, ShadowRay = 4 };

// How a shape stops light that goes to a light source: Attribute "render" "casts_shadows".
enum class ShadowMode : std::uint8_t {
    None,
    Opaque, // wholly
    Os,     // by its opacity, attribute or primitive variable
    Shader  // by what its surface shader says
};

// What shadow rays met that lets part of the light through, nearest first. Light passes all of it,
// so a ray knows them together.
struct Crossings {
    static constexpr int most = 8;
    Hit hits[RayPacket::size][most];
    std::uint8_t count[RayPacket::size] = {};
    std::uint32_t more = 0; // rays that met further ones behind their last
};

} // namespace geo
