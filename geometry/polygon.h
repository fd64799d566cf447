// SPDX-License-Identifier: Apache-2.0
// The four polygon requests as one surface (ri.md 11.2): a part is a triangle, local parameters are
// barycentric.
#pragma once

#include "geometry/surface.h"
#include "ribtools/scene.h"

#include <memory>

namespace geo {

// What was wrong with the input; polygons concerned are left out (or cut as well as it goes, for
// tangled ones).
struct PolygonFaults {
    bool no_positions = false;
    std::size_t bad_index = 0;  // indices or counts outside the data
    std::size_t not_finite = 0; // NaN, infinite or above 1e18
    std::size_t degenerate = 0; // fewer than three distinct points, or no area
    std::size_t tangled = 0;    // outlines that cross
};

// Refers to polygons and params, which must outlive it. nullptr when nothing is left to draw.
[[nodiscard]] std::unique_ptr<Surface>
make_polygons(const rib::Polygons& polygons, const rib::ParamList& params, PolygonFaults& faults);

} // namespace geo
