// SPDX-License-Identifier: Apache-2.0
// Objects as prototypes: what their instances share in Embree.
#pragma once

#include "geometry/accel.h"
#include "geometry/shapes.h"

namespace geo {

// Puts every drawn instance into accel, with the prototypes they need, and sets ShapeGroup::centre
// of their objects. Members whose visibility or sides differ between instances get one prototype
// per combination.
void add_instances(ShapeTable& table, Accel& accel, base::Diag& diag);

// One level's items; trace space = the group's parent space moved by -centre.
[[nodiscard]] std::vector<TraceItem> trace_items(const ShapeTable& table, const ShapeGroup& group,
                                                 std::uint32_t instance,
                                                 std::span<const Mat4> cam_from_parent);

} // namespace geo
