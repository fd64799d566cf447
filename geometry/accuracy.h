// SPDX-License-Identifier: Apache-2.0
// For tests and benchmarks: how far diced patches are from the true ones, measured in double and
// with nothing of the dicing's own bounds. Enters: random patches, a camera. Leaves: raster
// distances.
#pragma once

#include "geometry/dice.h"
#include "geometry/test_scene.h"

#include <random>
#include <vector>

namespace geo::test {

// Bilinear (degree 1) or bicubic (degree 3) parts with jittered control points; every third one is
// rational. Camera space.
std::vector<double> random_part(std::mt19937& rng, int degree, double size, const V3d& centre);

// A picture of that many pixels across, field of view in degrees.
View test_view(double pixels, double fov_deg);

struct PartAccuracy {
    double deviation_px = 0;  // largest raster distance between corresponding points
    double silhouette_px = 0; // largest distance of the outline of the grid from the true one
    std::size_t outline_points = 0;
    std::int64_t vertices = 0;
};

// Points that the camera cannot see (behind it, outside of the picture) do not count.
// samples: places inside every triangle, and silhouette points on every parameter line.
PartAccuracy measure_part(int degree, const std::vector<double>& net_cam, const View& view,
                          double flatness_px);

// The p-th part (0..1) of sorted values.
double percentile(std::vector<double> values, double p);

// Closed surfaces made of patches, "P" of a PatchMesh or of separate Patch requests.
enum class Closed { SplineTorus, BezierPot, PatchesPot, RationalBall };
rib::Scene closed_scene(Closed kind, double scale, const Mat4& camera_from_world);
// Rays from points inside; how many leave the surface without meeting it.
std::size_t count_leaks(const World& world, Closed kind, double scale,
                        const Mat4& camera_from_world, std::size_t rays, unsigned seed);

} // namespace geo::test
