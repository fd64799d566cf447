// SPDX-License-Identifier: Apache-2.0
#include "tracer/ray_cone.h"

#include <algorithm>
#include <cmath>

namespace trace {

namespace {

using base::V3d;

double at(const float* q, double t) {
    return std::max(0.0, static_cast<double>(q[0]) +
                             t * (2 * static_cast<double>(q[1]) + t * static_cast<double>(q[2])));
}

void set(float* q, const V3d& P, const V3d& D) {
    q[0] = static_cast<float>(base::dot(P, P));
    q[1] = static_cast<float>(base::dot(P, D));
    q[2] = static_cast<float>(base::dot(D, D));
}

V3d across(const V3d& x, const V3d& direction) {
    return x - direction * base::dot(x, direction);
}

} // namespace

RayCone RayCone::from(float width, float spread) {
    RayCone cone;
    for (float* q : {cone.u, cone.v}) {
        q[0] = width * width;
        q[1] = width * spread;
        q[2] = spread * spread;
    }
    return cone;
}

RayCone RayCone::from(const V3d& direction, const V3d& P_u, const V3d& P_v, const V3d& D_u,
                      const V3d& D_v) {
    RayCone cone;
    set(cone.u, across(P_u, direction), across(D_u, direction));
    set(cone.v, across(P_v, direction), across(D_v, direction));
    return cone;
}

float RayCone::width(float t) const {
    const double by_u = at(u, t), by_v = at(v, t);
    // At poles one direction has no neighbour: the other stands for both.
    const double product = by_u == 0 ? by_v * by_v : by_v == 0 ? by_u * by_u : by_u * by_v;
    return static_cast<float>(std::sqrt(std::sqrt(product)));
}

// w = (qu qv)^(1/4), so w'/w is a quarter of qu'/qu + qv'/qv.
float RayCone::spread(float t) const {
    const double length = t;
    double relative = 0;
    for (const float* q : {u, v}) {
        const double square = at(q, length);
        relative += square > 0 ? (static_cast<double>(q[1]) + length * static_cast<double>(q[2])) /
                                     (2 * square)
                               : 0;
    }
    return static_cast<float>(relative * static_cast<double>(width(t)));
}

void RayCone::widen(float spread) {
    for (float* q : {u, v}) {
        q[2] = std::max(q[2], spread * spread);
    }
}

} // namespace trace
