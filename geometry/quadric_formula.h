// SPDX-License-Identifier: Apache-2.0
// For tests: the quadrics of ri.md 11.9 as written there, in 80-bit floats; what surfaces and their
// differences are measured against.
#pragma once

#include "ribtools/scene.h"
#include "runtime/base/vec.h"

#include <cmath>
#include <numbers>

namespace geo::test {

using rib::QuadricKind;
using Real = long double;
using V3l = base::Vec3<Real>;

inline V3l formula(const rib::Quadric& q, Real u, Real v) {
    constexpr Real pi = std::numbers::pi_v<Real>;
    const auto& a = q.args;
    const auto theta = [&](double thetamax) { return u * thetamax * pi / 180; };
    switch (q.kind) {
    case QuadricKind::Sphere: {
        const Real lo = a[1] > -a[0] ? std::asin(Real(a[1]) / a[0]) : -pi / 2;
        const Real hi = a[2] < a[0] ? std::asin(Real(a[2]) / a[0]) : pi / 2;
        const Real phi = lo + v * (hi - lo), t = theta(a[3]);
        return {a[0] * std::cos(t) * std::cos(phi), a[0] * std::sin(t) * std::cos(phi),
                a[0] * std::sin(phi)};
    }
    case QuadricKind::Cone: {
        const Real t = theta(a[2]), r = a[1] * (1 - v);
        return {r * std::cos(t), r * std::sin(t), v * a[0]};
    }
    case QuadricKind::Cylinder: {
        const Real t = theta(a[3]);
        return {a[0] * std::cos(t), a[0] * std::sin(t), a[1] + v * (Real(a[2]) - a[1])};
    }
    case QuadricKind::Hyperboloid: {
        const Real t = theta(a[6]);
        const Real x = (1 - v) * a[0] + v * a[3], y = (1 - v) * a[1] + v * a[4];
        return {x * std::cos(t) - y * std::sin(t), x * std::sin(t) + y * std::cos(t),
                (1 - v) * a[2] + v * a[5]};
    }
    case QuadricKind::Paraboloid: {
        const Real t = theta(a[3]), z = a[1] + v * (Real(a[2]) - a[1]),
                   r = a[0] * std::sqrt(z / a[2]);
        return {r * std::cos(t), r * std::sin(t), z};
    }
    case QuadricKind::Disk: {
        const Real t = theta(a[2]), r = a[1] * (1 - v);
        return {r * std::cos(t), r * std::sin(t), a[0]};
    }
    case QuadricKind::Torus: {
        const Real phi = (a[2] + v * (Real(a[3]) - a[2])) * pi / 180, t = theta(a[4]);
        const Real r = a[0] + a[1] * std::cos(phi);
        return {r * std::cos(t), r * std::sin(t), a[1] * std::sin(phi)};
    }
    }
    return {};
}

} // namespace geo::test
