// SPDX-License-Identifier: Apache-2.0
#include "geometry/dice_bounds.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace geo {

namespace {

using base::V3d;

V3d project(const double* h) {
    return V3d{h[0], h[1], h[2]} / (h[3] != 0 ? h[3] : 1);
}

// Length of a difference of homogeneous points as the head comment has it.
class DifferenceLength {
public:
    DifferenceLength(int num_points, const double* net) {
        const Hull box = hull(num_points, net);
        centre_ = (box.lo + box.hi) * 0.5;
        least_weight_ = net[3];
        double largest = net[3];
        for (int i = 0; i < num_points; ++i) {
            least_weight_ = std::min(least_weight_, net[4 * i + 3]);
            largest = std::max(largest, net[4 * i + 3]);
        }
        radius_ = length(box.hi - box.lo) * 0.5;
        least_weight_ = std::max(least_weight_, largest * 1e-12);
    }
    [[nodiscard]] double operator()(const std::array<double, 4>& d) const {
        const V3d v = V3d{d[0], d[1], d[2]} - centre_ * d[3];
        return (length(v) + radius_ * std::fabs(d[3])) / least_weight_;
    }

private:
    V3d centre_;
    double radius_ = 0, least_weight_ = 1;
};

std::array<double, 4> second_difference(const double* a, const double* b, const double* c) {
    std::array<double, 4> d{};
    for (std::size_t k = 0; k < 4; ++k) {
        d[k] = a[k] - 2 * b[k] + c[k];
    }
    return d;
}

// Largest of a run of degree + 1 control points, step apart.
double bend(const DifferenceLength& length_of, const double* first, int degree, int step) {
    double largest = 0;
    for (int i = 0; i + 2 <= degree; ++i) {
        const double* p = first + 4 * step * i;
        largest = std::max(largest, length_of(second_difference(p, p + 4 * step, p + 8 * step)));
    }
    return degree * (degree - 1) * largest;
}

double twist(const DifferenceLength& length_of, int degree_u, int degree_v, const double* net) {
    const int row = degree_u + 1;
    double largest = 0;
    for (int j = 0; j < degree_v; ++j) {
        for (int i = 0; i < degree_u; ++i) {
            const double* p = net + 4 * (j * row + i);
            std::array<double, 4> d{};
            for (int k = 0; k < 4; ++k) {
                d[static_cast<std::size_t>(k)] =
                    p[k] - p[4 + k] - p[4 * row + k] + p[4 * row + 4 + k];
            }
            largest = std::max(largest, length_of(d));
        }
    }
    return degree_u * degree_v * largest;
}

// One run of points, step apart, into both halves.
void halve_run(int degree, int step, const double* from, double* left, double* right) {
    for (int k = 0; k < 4; ++k) {
        std::array<double, 32> p{};
        const auto n = static_cast<std::size_t>(degree);
        for (std::size_t i = 0; i <= n; ++i) {
            p[i] = from[4 * step * static_cast<int>(i) + k];
        }
        for (std::size_t r = 0; r <= n; ++r) {
            left[4 * step * static_cast<int>(r) + k] = p[0];
            right[4 * step * static_cast<int>(n - r) + k] = p[n - r];
            for (std::size_t i = 0; i + r < n; ++i) {
                p[i] = 0.5 * (p[i] + p[i + 1]);
            }
        }
    }
}

} // namespace

Hull hull(int num_points, const double* net) {
    const V3d first = project(net);
    Hull box{first, first};
    for (int i = 1; i < num_points; ++i) {
        const V3d p = project(net + 4 * i);
        for (int k = 0; k < 3; ++k) {
            box.lo[k] = std::min(box.lo[k], p[k]);
            box.hi[k] = std::max(box.hi[k], p[k]);
        }
    }
    return box;
}

Bends bends(int degree_u, int degree_v, const double* net) {
    const int row = degree_u + 1;
    const DifferenceLength length_of(row * (degree_v + 1), net);
    const auto along_u = [&](int j) { return bend(length_of, net + 4 * row * j, degree_u, 1); };
    const auto along_v = [&](int i) { return bend(length_of, net + 4 * i, degree_v, row); };
    Bends b;
    b.uu_v0 = along_u(0), b.uu_v1 = along_u(degree_v);
    b.vv_u0 = along_v(0), b.vv_u1 = along_v(degree_u);
    b.uu = std::max(b.uu_v0, b.uu_v1);
    b.vv = std::max(b.vv_u0, b.vv_u1);
    for (int j = 1; j < degree_v; ++j) {
        b.uu = std::max(b.uu, along_u(j));
    }
    for (int i = 1; i < degree_u; ++i) {
        b.vv = std::max(b.vv, along_v(i));
    }
    b.uv = twist(length_of, degree_u, degree_v, net);
    return b;
}

void halve_u(int degree_u, int degree_v, const std::vector<double>& net, std::vector<double>& left,
             std::vector<double>& right) {
    left.resize(net.size());
    right.resize(net.size());
    for (int j = 0; j <= degree_v; ++j) {
        const int at = 4 * (degree_u + 1) * j;
        halve_run(degree_u, 1, net.data() + at, left.data() + at, right.data() + at);
    }
}

void halve_v(int degree_u, int degree_v, const std::vector<double>& net, std::vector<double>& left,
             std::vector<double>& right) {
    left.resize(net.size());
    right.resize(net.size());
    for (int i = 0; i <= degree_u; ++i) {
        halve_run(degree_v, degree_u + 1, net.data() + 4 * i, left.data() + 4 * i,
                  right.data() + 4 * i);
    }
}

} // namespace geo
