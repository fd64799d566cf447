// SPDX-License-Identifier: Apache-2.0
// Bounds of a rational Bezier part from its control points: how much it bends, where it lies, and
// its halves. Private to dice.cpp and dice_plan.cpp. A chord of a curve with control points h
// misses it by max|h''| step^2 / 8; for rational ones, with c the centre of the hull and r its
// radius, |P'' - c w''| + r |w''| over the least weight takes the place of |h''| (the chord of the
// homogeneous curve projects to the same straight line; derived here after [Wang84]).
#pragma once

#include "runtime/base/vec.h"

#include <vector>

namespace geo {

// Largest second derivatives by the parameters of the part, and along its four borders.
struct Bends {
    double uu = 0, uv = 0, vv = 0;
    double uu_v0 = 0, uu_v1 = 0, vv_u0 = 0, vv_u1 = 0;
};
[[nodiscard]] Bends bends(int degree_u, int degree_v, const double* net);

struct Hull {
    base::V3d lo, hi;
};
[[nodiscard]] Hull hull(int num_points, const double* net);

// Cuts a net at the middle of one direction (de Casteljau; the cut is symmetric, so a curve and its
// reverse give the same halves bit for bit).
void halve_u(int degree_u, int degree_v, const std::vector<double>& net, std::vector<double>& left,
             std::vector<double>& right);
void halve_v(int degree_u, int degree_v, const std::vector<double>& net, std::vector<double>& left,
             std::vector<double>& right);

} // namespace geo
