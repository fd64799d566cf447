// SPDX-License-Identifier: Apache-2.0
// Objects as prototypes: what their instances share in Embree.
#pragma once

#include "geometry/accel.h"
#include "geometry/shapes.h"

namespace geo {

// Puts every drawn instance into accel, with the prototypes they need, and sets ShapeGroup::centre
// of their objects. Members whose visibility or sides differ between instances get one prototype
// per combination.
void add_instances(ShapeTable& table, const View& view, Accel& accel, base::Diag& diag);

// One level's items; trace space = the group's parent space moved by -centre.
[[nodiscard]] std::vector<TraceItem> trace_items(const ShapeTable& table, const ShapeGroup& group,
                                                 std::uint32_t instance);

// What dicing must know of many placements of one box: those that the eye is near to one by one
// (the nearest few hundred), the others by the largest raster size any of them has.
[[nodiscard]] LevelView level_view(const Box& box_trace, std::vector<Mat4> cam_from_trace,
                                   const View& view);

} // namespace geo
