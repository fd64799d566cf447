// SPDX-License-Identifier: Apache-2.0
// How much light passes along rays: shadows, visibility(), transmission(), shadow("raytrace").
// In: up to eight rays from tnear to tfar. Out: what remains of light that travels along them, in
// colour. Opaque things stop it, others filter it layer by layer (Attribute "render"
// "casts_shadows"); both sides of a closed object are layers. Scenes and rays that meet opaque
// things only cost one occlusion query.
#pragma once

#include "geometry/world.h"
#include "tracer/execution.h"

#include <cstdint>
#include <optional>

namespace trace {

struct ShadowRays {
    geo::RayPacket packet;
    std::uint32_t seed[geo::RayPacket::size] = {}; // for surface shaders that are asked
    std::optional<geo::ShadowMode> as; // "hitmode": every surface is taken as one of these
};

// T: 3 planes of 8; 1 where nothing is in the way. Lanes that are not active stay as they are. A
// packet's active lanes may change.
void transmit(const Execution& asker, ShadowRays& rays, float* T);

// Questions of kind SL_RAYS_transmission and SL_RAYS_shadow.
void answer_transmission(Execution& execution, sl_ray_query& query);

} // namespace trace
