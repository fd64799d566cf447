// SPDX-License-Identifier: Apache-2.0
// How finely a Bezier part is diced, and its grid of points without cracks to the neighbours.
// Enters: homogeneous control points of one part in trace space, and from where it is seen. Leaves:
// a plan, then a grid of vertices, row by row along v. The vertices on a border depend on the
// border curve alone, so parts that share a curve share vertices bit for bit. A grid keeps within
// the flatness of the true surface everywhere: [Filip86] bounds what a triangle misses, and the
// distance between corresponding points bounds the error of any outline.
#pragma once

#include "geometry/bezier.h"
#include "geometry/param_axis.h"
#include "geometry/world.h"
#include "runtime/base/mat.h"

#include <cstdint>
#include <span>
#include <vector>

namespace geo {

constexpr int max_border_segments = 1024;
constexpr std::int64_t max_part_vertices = std::int64_t(1) << 20;

// Everything about the eye that dicing depends on.
struct DiceContext {
    View view;
    // Placements that are looked at one by one; identity when trace space is camera space.
    std::span<const base::Mat4> cam_from_trace;
    // The other placements together: raster length of a unit of trace space, at most.
    double far_px_per_unit = 0;
    double flatness_px = 0.1; // largest distance to the true surface
};

// Distances from the eye to a box of camera space; orthographic: from outside the picture, plus its
// size. A box with farthest <= even * nearest is seen at one scale, near enough.
struct Distances {
    double nearest, farthest;
    static constexpr double even = 2;
    [[nodiscard]] bool is_even() const { return farthest <= even * nearest; }
};
[[nodiscard]] Distances distances(const base::V3d& lo, const base::V3d& hi, const View& view);
// Raster length of a unit anywhere in a box of camera space, at most. Places beside the picture
// count as if it went on there: they may be seen in a mirror.
[[nodiscard]] double pixels_per_unit(const base::V3d& lo, const base::V3d& hi, const View& view);

// The control points of a border curve, every `step` points from first, in the order that does not
// depend on who asks (degree + 1 homogeneous points); true if that reverses it.
bool canonical_border(const double* first, int degree, int step, double* out);

struct DicePlan {
    ParamAxis u, v;                       // of the grid
    ParamAxis at_v0, at_v1, at_u0, at_u1; // of the borders, in canonical direction
    [[nodiscard]] std::int64_t vertices() const {
        return (std::int64_t(u.segments()) + 1) * (v.segments() + 1);
    }
};

[[nodiscard]] DicePlan plan_part(int degree_u, int degree_v, const double* net_trace,
                                 const DiceContext& context);

// Appends the vertices of the grid, (v segments + 1) rows. Border vertices are the nearest of the
// border's own, so triangles there may be empty; the border itself is the polyline of that curve,
// whatever lies on the other side.
void dice_part(int degree_u, int degree_v, const double* net_trace, const DicePlan& plan,
               std::vector<base::V3d>& out);

// What a diced part misses of the true one, in the units of its net.
struct DiceError {
    float uu = 0, uv = 0, vv = 0;         // [Filip86]: error <= (uu a^2 + 2 uv a b + vv b^2) / 8
    float v0 = 0, v1 = 0, u0 = 0, u1 = 0; // in the strips along the borders
    [[nodiscard]] double at(const DicePlan& plan, double u, double v) const;
};
[[nodiscard]] DiceError dice_error(int degree_u, int degree_v, const double* net,
                                   const DicePlan& plan);

} // namespace geo
