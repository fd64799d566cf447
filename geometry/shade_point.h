// SPDX-License-Identifier: Apache-2.0
// THE function that turns hits into ShaderVariables, for displacement, radiosity and tracing alike.
// In: hits, the rays that found them, the mask of variables somebody reads. Out: camera-space
// values and, for the auxiliary points, differences (design.md, section 5). All geometry is
// computed in double and rounded once.
#pragma once

#include "geometry/shapes.h"

namespace geo {

struct FillRequest {
    std::span<const Hit> hits;
    const Incident& incident;
    std::uint64_t needed;
    std::uint32_t stride;
    const sl_points& out;
    const sl_points* aux_u;
    const sl_points* aux_v;
    bool perspective; // of the camera: whether neighbouring rays along z are parallel
};

void fill_points(const ShapeTable& table, const FillRequest& request);

// Values of one primitive variable, camera space; planes of stride.
void fill_variable(const ShapeTable& table, std::span<const Hit> hits, const rib::Param& param,
                   std::uint32_t stride, float* out);

// Differences of one primitive variable to the auxiliary points du and dv away, per hit; planes as
// above.
void fill_variable_differences(const ShapeTable& table, std::span<const Hit> hits,
                               const rib::Param& param, const AuxiliaryPlanes& planes);

// See World::spawn_origin.
[[nodiscard]] SpawnPoint spawn_points(const ShapeTable& table, const Hit& hit);

} // namespace geo
