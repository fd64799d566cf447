// SPDX-License-Identifier: Apache-2.0
// Triangulation of plane regions bounded by loops, filled by the even-odd rule: concave outlines,
// holes, islands, outlines that touch or run along each other. In: loops of points, any winding.
// Out: triangles of the given points only, every point a corner, so that neighbouring polygons stay
// free of cracks; wound like the first loop. Never fails: where outlines cross, triangles are
// chosen by their centres and the result says so. Source: constrained Delaunay triangulation by
// edge flips, [Sloan93].
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace geo {

struct Point2 {
    double x, y;
    friend bool operator==(const Point2&, const Point2&) = default;
};

// Twice the signed area of the triangle; the sign is exact for coordinates that are floats
// (differences of floats and their products fit into a double unless the exponents differ by more
// than 28).
[[nodiscard]] inline double orient(const Point2& a, const Point2& b, const Point2& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

struct Triangulation {
    std::vector<std::array<std::uint32_t, 3>> triangles; // indices into the points
    bool clean = true;                                   // false: outlines cross
};

// points: all loops one after another; loop_sizes: their lengths.
[[nodiscard]] Triangulation triangulate(std::span<const Point2> points,
                                        std::span<const std::uint32_t> loop_sizes);

} // namespace geo
