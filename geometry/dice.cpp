// SPDX-License-Identifier: Apache-2.0
#include "geometry/dice.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace geo {

namespace {

base::V3d project(const double* h) {
    const double w = h[3] != 0 ? h[3] : 1;
    return base::V3d{h[0], h[1], h[2]} / w;
}

// Largest raster length of a camera-space unit anywhere on the part.
double pixels_per_unit(int num_points, const double* net_cam, const View& view) {
    const double scale = std::max(view.pixels_per_unit_x, view.pixels_per_unit_y);
    if (!view.perspective) {
        return scale;
    }
    double near = 1e300, far = 0;
    for (int i = 0; i < num_points; ++i) {
        const base::V3d p = project(net_cam + 4 * i);
        near = std::min(near, p.z);
        far = std::max(far, length(p));
    }
    // A part that reaches the eye has no bounded raster size: a hundredth of its extent stands in
    // for its distance.
    return scale / std::max({near, far * 0.01, view.near_clip, 1e-30});
}

int segments(double second_difference_px, int degree, double flatness_px) {
    const double bound = degree * (degree - 1) / 8.0 * second_difference_px / flatness_px;
    if (!(bound > 1)) { // NaN included
        return 1;
    }
    return static_cast<int>(std::min(std::ceil(std::sqrt(bound)), double(max_segments)));
}

// Largest second difference of a run of control points, camera units.
double second_difference(const double* first, int degree, int step) {
    double largest = 0;
    for (int i = 0; i + 2 <= degree; ++i) {
        const base::V3d a = project(first + 4 * step * i), b = project(first + 4 * step * (i + 1)),
                        c = project(first + 4 * step * (i + 2));
        largest = std::max(largest, length(a - b * 2.0 + c));
    }
    return largest;
}

double largest_twist(int degree_u, int degree_v, const double* net) {
    const int row = degree_u + 1;
    double twist = 0;
    for (int j = 0; j < degree_v; ++j) {
        for (int i = 0; i < degree_u; ++i) {
            const double* p = net + 4 * (j * row + i);
            twist = std::max(twist, length(project(p) - project(p + 4) - project(p + 4 * row) +
                                           project(p + 4 * row + 4)));
        }
    }
    return twist;
}

using BorderNet = std::array<double, 4 * (max_degree + 1)>;

// The control points of a border curve in the order that does not depend on who asks; true if that
// reverses it.
bool canonical_border(const double* first, int degree, int step, BorderNet& out) {
    for (int i = 0; i <= degree; ++i) {
        std::copy_n(first + 4 * step * i, 4, out.data() + 4 * i);
    }
    const auto begin = out.data(), end = out.data() + 4 * degree;
    const bool reverse = std::lexicographical_compare(end, end + 4, begin, begin + 4);
    for (int i = 0; reverse && i < degree - i; ++i) {
        std::swap_ranges(begin + 4 * i, begin + 4 * i + 4, begin + 4 * (degree - i));
    }
    return reverse;
}

// The point k of n on a border curve.
base::V3d border_point(const BorderNet& net, bool reversed, int degree, int k, int n) {
    const double x = static_cast<double>(reversed ? n - k : k) / n;
    const BezierPoint p = evaluate_part(degree, 0, net.data(), x, 0);
    return p.P;
}

} // namespace

DiceRates dice_rates(int degree_u, int degree_v, const double* net, const View& view,
                     double flatness_px) {
    const int row = degree_u + 1;
    const double px = pixels_per_unit(row * (degree_v + 1), net, view);
    const auto along_u = [&](int j) {
        return segments(second_difference(net + 4 * row * j, degree_u, 1) * px, degree_u,
                        flatness_px);
    };
    const auto along_v = [&](int i) {
        return segments(second_difference(net + 4 * i, degree_v, row) * px, degree_v, flatness_px);
    };
    // Borders must not depend on the part they are seen from: their own points give their raster
    // size too.
    const auto border = [&](const double* first, int degree, int step) {
        BorderNet curve;
        canonical_border(first, degree, step, curve);
        const double border_px = pixels_per_unit(degree + 1, curve.data(), view);
        return segments(second_difference(curve.data(), degree, 1) * border_px, degree,
                        flatness_px);
    };
    DiceRates r;
    r.at_v0 = border(net, degree_u, 1);
    r.at_v1 = border(net + 4 * row * degree_v, degree_u, 1);
    r.at_u0 = border(net, degree_v, row);
    r.at_u1 = border(net + 4 * degree_u, degree_v, row);
    r.u = std::max(r.at_v0, r.at_v1);
    r.v = std::max(r.at_u0, r.at_u1);
    for (int j = 0; j <= degree_v; ++j) {
        r.u = std::max(r.u, along_u(j));
    }
    for (int i = 0; i <= degree_u; ++i) {
        r.v = std::max(r.v, along_v(i));
    }
    // The twist bends both families of lines at once; a bilinear part of one quad would be two flat
    // triangles.
    const double twist_px = largest_twist(degree_u, degree_v, net) * px;
    // Diagonal deviation of a twisted quad: |twist| du dv / 4 with du dv = degree_u degree_v / (u
    // v).
    const double cells = twist_px * degree_u * degree_v / (4 * flatness_px);
    if (cells > r.u * double(r.v)) {
        const double grow = std::sqrt(cells / (r.u * double(r.v)));
        r.u = static_cast<int>(std::min(std::ceil(r.u * grow), double(max_segments)));
        r.v = static_cast<int>(std::min(std::ceil(r.v * grow), double(max_segments)));
    }
    return r;
}

DicedPart dice_part(int degree_u, int degree_v, const double* net, const DiceRates& rates) {
    const int row = degree_u + 1;
    DicedPart grid;
    grid.width = rates.u + 1;
    grid.height = rates.v + 1;
    const auto count = static_cast<std::size_t>(grid.width) * static_cast<std::size_t>(grid.height);
    grid.P.resize(count);
    grid.s.resize(count);
    grid.t.resize(count);
    const auto at = [&](int i, int j) {
        return static_cast<std::size_t>(j) * static_cast<std::size_t>(grid.width) +
               static_cast<std::size_t>(i);
    };
    for (int j = 0; j <= rates.v; ++j) {
        for (int i = 0; i <= rates.u; ++i) {
            const double s = static_cast<double>(i) / rates.u, t = static_cast<double>(j) / rates.v;
            grid.s[at(i, j)] = static_cast<float>(s);
            grid.t[at(i, j)] = static_cast<float>(t);
            if (i > 0 && i < rates.u && j > 0 && j < rates.v) {
                grid.P[at(i, j)] = evaluate_part(degree_u, degree_v, net, s, t).P;
            }
        }
    }
    // Vertex i of n goes to the nearest vertex of the border's own n_border segments.
    const auto lay_border = [&](const double* first, int degree, int step, int n_border, int n,
                                auto&& index, std::vector<float>& parameter) {
        BorderNet curve;
        const bool reversed = canonical_border(first, degree, step, curve);
        for (int i = 0; i <= n; ++i) {
            const int k = (2 * i * n_border + n) / (2 * n);
            grid.P[index(i)] = border_point(curve, reversed, degree, k, n_border);
            parameter[index(i)] = static_cast<float>(static_cast<double>(k) / n_border);
        }
    };
    lay_border(
        net, degree_u, 1, rates.at_v0, rates.u, [&](int i) { return at(i, 0); }, grid.s);
    lay_border(
        net + 4 * row * degree_v, degree_u, 1, rates.at_v1, rates.u,
        [&](int i) { return at(i, rates.v); }, grid.s);
    lay_border(
        net, degree_v, row, rates.at_u0, rates.v, [&](int j) { return at(0, j); }, grid.t);
    lay_border(
        net + 4 * degree_u, degree_v, row, rates.at_u1, rates.v,
        [&](int j) { return at(rates.u, j); }, grid.t);
    return grid;
}

DiceRates finest(const DiceRates& a, const DiceRates& b) {
    return {std::max(a.u, b.u),         std::max(a.v, b.v),         std::max(a.at_v0, b.at_v0),
            std::max(a.at_v1, b.at_v1), std::max(a.at_u0, b.at_u0), std::max(a.at_u1, b.at_u1)};
}

double chord_error(int degree_u, int degree_v, const double* net, const DiceRates& rates) {
    const int row = degree_u + 1;
    double bend_u = 0, bend_v = 0;
    for (int j = 0; j <= degree_v; ++j) {
        bend_u = std::max(bend_u, second_difference(net + 4 * row * j, degree_u, 1));
    }
    for (int i = 0; i <= degree_u; ++i) {
        bend_v = std::max(bend_v, second_difference(net + 4 * i, degree_v, row));
    }
    const auto chord = [](double bend, int degree, double n) {
        return degree * (degree - 1) / 8.0 * bend / (n * n);
    };
    // The strips at the borders are as coarse as the borders.
    const int u = std::min(rates.at_v0, rates.at_v1), v = std::min(rates.at_u0, rates.at_u1);
    return chord(bend_u, degree_u, u) + chord(bend_v, degree_v, v) +
           largest_twist(degree_u, degree_v, net) * degree_u * degree_v / (4.0 * u * v);
}

} // namespace geo
