// SPDX-License-Identifier: Apache-2.0
#include "geometry/spherical.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace geo {

using base::V3d;

namespace {

constexpr double pi = std::numbers::pi;

// The angle between two planes through the eye at the edge they share, of unit normals.
double angle_between(const V3d& a, const V3d& b) {
    return std::atan2(length(cross(a, b)), dot(a, b));
}

double clamped_acos(double x) {
    return std::acos(std::clamp(x, -1.0, 1.0));
}

} // namespace

// The excess by [VanOosterom83], which is exact for small triangles too.
SphericalTriangle::SphericalTriangle(const std::array<V3d, 3>& corners) {
    for (std::size_t k = 0; k < 3; ++k) {
        corner_[k] = normalize(corners[k]);
    }
    const auto& [a, b, c] = corner_;
    const double volume = std::fabs(dot(a, cross(b, c)));
    solid_angle_ = 2 * std::atan2(volume, 1 + dot(a, b) + dot(b, c) + dot(a, c));
    const V3d n_ab = normalize(cross(a, b)), n_ca = normalize(cross(c, a));
    alpha_ = angle_between(n_ab, -n_ca);
}

V3d SphericalTriangle::direction(double x, double y) const {
    const auto& [a, b, c] = corner_;
    const double part = x * solid_angle_;
    // The triangle with a corner c' on the side a c that has this part of the area.
    const double s = std::sin(part - alpha_), t = std::cos(part - alpha_);
    const double cos_alpha = std::cos(alpha_), sin_alpha = std::sin(alpha_);
    const double u = t - cos_alpha, v = s + sin_alpha * dot(a, b);
    const double numerator = (v * t - u * s) * cos_alpha - v;
    const double denominator = (v * s + u * t) * sin_alpha;
    const double q = denominator != 0 ? std::clamp(numerator / denominator, -1.0, 1.0) : 1.0;
    const V3d c_across = normalize(c - a * dot(c, a));
    const V3d c_new = a * q + c_across * std::sqrt(std::max(0.0, 1 - q * q));
    // A point on the arc from b to c', by its height.
    const double z = 1 - y * (1 - dot(c_new, b));
    const V3d across = normalize(c_new - b * dot(c_new, b));
    return b * z + across * std::sqrt(std::max(0.0, 1 - z * z));
}

SphericalRectangle::SphericalRectangle(const V3d& corner, const V3d& edge_u, const V3d& edge_v) {
    const double length_u = length(edge_u), length_v = length(edge_v);
    u_ = edge_u / length_u;
    v_ = edge_v / length_v;
    n_ = cross(u_, v_);
    z0_ = dot(corner, n_);
    if (z0_ > 0) {
        n_ = -n_;
        z0_ = -z0_;
    }
    x0_ = dot(corner, u_), y0_ = dot(corner, v_);
    x1_ = x0_ + length_u, y1_ = y0_ + length_v;
    // Normals of the planes through the eye and the four sides.
    const V3d v00(x0_, y0_, z0_), v01(x0_, y1_, z0_), v10(x1_, y0_, z0_), v11(x1_, y1_, z0_);
    const V3d n0 = normalize(cross(v00, v10)), n1 = normalize(cross(v10, v11));
    const V3d n2 = normalize(cross(v11, v01)), n3 = normalize(cross(v01, v00));
    const double g0 = clamped_acos(-dot(n0, n1)), g1 = clamped_acos(-dot(n1, n2));
    const double g2 = clamped_acos(-dot(n2, n3)), g3 = clamped_acos(-dot(n3, n0));
    b0_ = n0.z;
    b1_ = n2.z;
    k_ = 2 * pi - g2 - g3;
    solid_angle_ = z0_ != 0 ? std::max(0.0, g0 + g1 - k_) : 0;
}

V3d SphericalRectangle::direction(double x, double y) const {
    const double au = x * solid_angle_ + k_;
    const double fu = (std::cos(au) * b0_ - b1_) / std::sin(au);
    const double cu =
        std::clamp(std::copysign(1.0, fu) / std::sqrt(fu * fu + b0_ * b0_), -1.0, 1.0);
    double xu = -(cu * z0_) / std::sqrt(std::max(1 - cu * cu, 1e-300));
    xu = std::clamp(xu, x0_, x1_);
    const double d = std::sqrt(xu * xu + z0_ * z0_);
    const double h0 = y0_ / std::sqrt(d * d + y0_ * y0_), h1 = y1_ / std::sqrt(d * d + y1_ * y1_);
    const double h = h0 + y * (h1 - h0), h2 = h * h;
    const double yv = h2 < 1 - 1e-12 ? h * d / std::sqrt(1 - h2) : y1_;
    return normalize(u_ * xu + v_ * yv + n_ * z0_);
}

} // namespace geo
