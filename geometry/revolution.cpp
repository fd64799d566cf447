// SPDX-License-Identifier: Apache-2.0
#include "geometry/revolution.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace geo {

namespace {

constexpr double two_pi = 2 * std::numbers::pi;

V3d rotated(const V3d& p, double cos_theta, double sin_theta) {
    return {p.x * cos_theta - p.y * sin_theta, p.x * sin_theta + p.y * cos_theta, p.z};
}

// d/dtheta of a rotating point.
V3d turned(const V3d& p) {
    return {-p.y, p.x, 0};
}

} // namespace

Revolution::Revolution(double thetamax_deg)
    : thetamax_(std::clamp(thetamax_deg, -360.0, 360.0) * std::numbers::pi / 180) {}

bool Revolution::is_whole_turn() const {
    return std::fabs(thetamax_) >= two_pi;
}

// A ring's extent along an axis is its radius times the length of the transform's part that acts
// on its plane, per axis.
Box Revolution::bound(const Mat4& dst_from_object) const {
    const auto& m = dst_from_object.m;
    Box box;
    for (const Ring& ring : hull()) {
        V3d centre, extent;
        for (int k = 0; k < 3; ++k) {
            centre[k] = ring.z * m[2][k] + m[3][k];
            extent[k] = std::fabs(ring.radius) * std::hypot(m[0][k], m[1][k]);
        }
        box.add(centre - extent);
        box.add(centre + extent);
    }
    return box;
}

// The origin is moved next to the surface first: roots then lose nothing to the distance of the
// eye.
bool Revolution::intersect(const ObjectRay& ray, LocalHit& hit) const {
    const double dd = dot(ray.d, ray.d);
    if (!(dd > 0) || !std::isfinite(dd)) {
        return false;
    }
    const auto ends = hull();
    const V3d centre(0, 0, 0.5 * (ends[0].z + ends[1].z));
    const double shift = dot(centre - ray.o, ray.d) / dd;
    const V3d o = ray.o + ray.d * shift;
    for (const double root : roots(o, ray.d)) {
        const double t = root + shift;
        LocalPoint at;
        if (!(t >= ray.tnear && t <= ray.tfar) || !locate(o + ray.d * root, at.u, at.v)) {
            continue;
        }
        if (ray.cull != 0 && !ray.sees(evaluate(at).Ng)) {
            continue;
        }
        hit = {at, t};
        return true;
    }
    return false;
}

SurfacePoint Revolution::evaluate(const LocalPoint& at) const {
    const Generator g = generator(at.v);
    const double theta = at.u * thetamax_;
    const double c = std::cos(theta), s = std::sin(theta);
    SurfacePoint p;
    p.u = at.u;
    p.v = at.v;
    p.P = rotated(g.p, c, s);
    p.dPdu = turned(p.P) * thetamax_;
    p.dPdv = rotated(g.dp, c, s);
    p.Ng = normalize(rotated(g.n, c, s)) * std::copysign(1.0, thetamax_);
    return p;
}

// P(u+du, v+dv) - P(u, v) = R(theta2) (g2 - g1) + (R(theta2) - R(theta1)) g1, and the difference of
// two rotations is 2 sin(dtheta/2) times the quarter turn of the mean one.
SurfacePoint Revolution::difference(const LocalPoint& at, const SurfacePoint& here, double du,
                                    double dv) const {
    SurfacePoint d = Surface::difference(at, here, du, dv);
    const double theta1 = at.u * thetamax_, dtheta = du * thetamax_;
    const V3d step_v = dv == 0 ? V3d() : generator_difference(at.v, dv);
    const double theta2 = theta1 + dtheta, mid = theta1 + 0.5 * dtheta;
    const V3d g1 = rotated(here.P, std::cos(theta1), -std::sin(theta1));
    d.P = rotated(step_v, std::cos(theta2), std::sin(theta2)) +
          turned(rotated(g1, std::cos(mid), std::sin(mid))) * (2 * std::sin(0.5 * dtheta));
    if (dv == 0) {
        const V3d n1 = rotated(here.Ng, std::cos(theta1), -std::sin(theta1));
        d.Ng = turned(rotated(n1, std::cos(mid), std::sin(mid))) * (2 * std::sin(0.5 * dtheta));
        d.dPdu = turned(d.P) * thetamax_;
    }
    return d;
}

// A quarter of a turn keeps the auxiliary point away from the point itself where dPdu vanishes.
std::array<double, 2> Revolution::max_step() const {
    return {std::min(1.0, 0.25 * two_pi / std::fabs(thetamax_)), 1.0};
}

std::size_t Revolution::num_items(rib::StorageClass storage) const {
    return storage == rib::StorageClass::Constant || storage == rib::StorageClass::Uniform ? 1 : 4;
}

void Revolution::stencil(rib::StorageClass storage, const LocalPoint& at, Stencil& out) const {
    if (storage == rib::StorageClass::Uniform) {
        out.add(0, 1);
    } else {
        out.add_bilinear({0, 1, 2, 3}, at.u, at.v);
    }
}

bool Revolution::sweep_u(double theta, double& u) const {
    const double sweep = std::fabs(thetamax_);
    double angle = std::copysign(1.0, thetamax_) * theta;
    angle -= two_pi * std::floor(angle / two_pi);
    if (angle > sweep * (1 + edge_slack)) {
        if (angle < two_pi * (1 - edge_slack)) {
            return false;
        }
        angle = 0; // a rounding error before the start
    }
    u = std::min(angle / sweep, 1.0);
    return true;
}

bool Revolution::limit_v(double& v) {
    if (!(v >= -edge_slack && v <= 1 + edge_slack)) {
        return false;
    }
    v = std::clamp(v, 0.0, 1.0);
    return true;
}

} // namespace geo
