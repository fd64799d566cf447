// SPDX-License-Identifier: Apache-2.0
// How finely a Bezier part is diced, and its grid of points without cracks to the neighbours.
// Enters: control points of one part in camera space. Leaves: a grid of vertices, row by row along
// v, whose border vertices depend on the border curve alone, so that parts sharing a curve share
// vertices bit for bit. The chord error of n equal segments of a Bezier curve of degree d is at
// most d(d-1)/8 max|second difference| / n^2
// ([Wang84]); its raster length bounds the silhouette error.
#pragma once

#include "geometry/bezier.h"
#include "geometry/world.h"
#include "runtime/base/mat.h"

#include <vector>

namespace geo {

constexpr int max_segments = 256; // per direction and part

// Segments along the four border curves and inside; every border count is at most the inner one.
struct DiceRates {
    int u = 1, v = 1;
    int at_v0 = 1, at_v1 = 1; // the borders that run along u
    int at_u0 = 1, at_u1 = 1; // the borders that run along v
};

// net_cam: homogeneous control points of one part in camera space.
[[nodiscard]] DiceRates dice_rates(int degree_u, int degree_v, const double* net_cam,
                                   const View& view, double flatness_px);

struct DicedPart {
    int width = 0, height = 0; // vertices along u and v
    std::vector<base::V3d> P;  // height rows of width vertices
    std::vector<float> s, t;   // local parameters of every vertex
};

// net: control points in the space of the vertices. Border vertices are the nearest of the border
// curve's own segments, so triangles there may be empty; the border itself is the polyline of that
// curve, whatever lies on the other side.
[[nodiscard]] DicedPart dice_part(int degree_u, int degree_v, const double* net,
                                  const DiceRates& rates);

// The larger of two rates, member by member: a part seen from several placements.
[[nodiscard]] DiceRates finest(const DiceRates& a, const DiceRates& b);

// Largest distance between the diced part and the true one, in the units of the net.
[[nodiscard]] double chord_error(int degree_u, int degree_v, const double* net,
                                 const DiceRates& rates);

} // namespace geo
