// SPDX-License-Identifier: Apache-2.0
// Flat pieces as they are seen from a point: their solid angle, and directions uniform in it.
// Enters: corners relative to the eye, numbers of [0,1)^2. Leaves: unit directions. In double;
// pieces seen edge on have the solid angle 0.
#pragma once

#include "runtime/base/vec.h"

#include <array>

namespace geo {

class SphericalTriangle {
public:
    // The corners as seen, any length.
    explicit SphericalTriangle(const std::array<base::V3d, 3>& corners);
    [[nodiscard]] double solid_angle() const { return solid_angle_; }
    [[nodiscard]] base::V3d direction(double x, double y) const; // [Arvo95]

private:
    std::array<base::V3d, 3> corner_; // unit
    double alpha_ = 0, solid_angle_ = 0;
};

class SphericalRectangle {
public:
    // A corner and two edges at right angles.
    SphericalRectangle(const base::V3d& corner, const base::V3d& edge_u, const base::V3d& edge_v);
    [[nodiscard]] double solid_angle() const { return solid_angle_; }
    [[nodiscard]] base::V3d direction(double x, double y) const; // [Urena13]

private:
    base::V3d u_, v_, n_; // axes of the rectangle's own frame
    double x0_ = 0, x1_ = 0, y0_ = 0, y1_ = 0, z0_ = 0;
    double b0_ = 0, b1_ = 0, k_ = 0, solid_angle_ = 0;
};

} // namespace geo
