// SPDX-License-Identifier: Apache-2.0
#include "geometry/dice.h"

#include "geometry/dice_bounds.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace geo {

namespace {

using base::V3d;

// The points of a row as a curve: the net of a part with one parameter fixed.
void fix_v(int degree_u, int degree_v, const double* net, double t, double* curve) {
    double b[max_degree + 1], unused[max_degree + 1];
    bernstein(degree_v, t, b, unused);
    const int row = 4 * (degree_u + 1);
    std::fill_n(curve, row, 0.0);
    for (int j = 0; j <= degree_v; ++j) {
        for (int k = 0; k < row; ++k) {
            curve[k] += b[j] * net[j * row + k];
        }
    }
}

V3d curve_point(int degree, const double* curve, const double* b) {
    double h[4] = {};
    for (int i = 0; i <= degree; ++i) {
        for (int k = 0; k < 4; ++k) {
            h[k] += b[i] * curve[4 * i + k];
        }
    }
    return V3d{h[0], h[1], h[2]} / h[3];
}

class GridFiller {
public:
    GridFiller(const DicePlan& plan, V3d* out)
        : plan_(plan), width_(plan.u.segments() + 1), out_(out) {}

    void lay_inside(int degree_u, int degree_v, const double* net) {
        const auto n = static_cast<std::size_t>(degree_u) + 1;
        std::vector<double> basis(n * static_cast<std::size_t>(width_));
        double unused[max_degree + 1];
        for (int i = 0; i < width_; ++i) {
            bernstein(degree_u, plan_.u.vertex(i), &basis[n * static_cast<std::size_t>(i)], unused);
        }
        double curve[4 * (max_degree + 1)];
        for (int j = 1; j < plan_.v.segments(); ++j) {
            fix_v(degree_u, degree_v, net, plan_.v.vertex(j), curve);
            for (int i = 1; i + 1 < width_; ++i) {
                at(i, j) = curve_point(degree_u, curve, &basis[n * static_cast<std::size_t>(i)]);
            }
        }
    }

    // Vertex i of the grid's border goes to the nearest vertex of the border itself.
    template <class Vertex>
    static void lay_border(const double* first, int degree, int step, const ParamAxis& border,
                           const ParamAxis& inner, Vertex&& vertex) {
        double curve[4 * (max_degree + 1)], b[max_degree + 1], unused[max_degree + 1];
        const bool reversed = canonical_border(first, degree, step, curve);
        int last = -1;
        V3d p;
        for (int i = 0; i <= inner.segments(); ++i) {
            const double s = inner.vertex(i);
            const int k = border.nearest(reversed ? 1 - s : s);
            if (k != last) {
                bernstein(degree, border.vertex(k), b, unused);
                p = curve_point(degree, curve, b);
                last = k;
            }
            vertex(i) = p;
        }
    }

    V3d& at(int i, int j) {
        return out_[static_cast<std::size_t>(j) * static_cast<std::size_t>(width_) +
                    static_cast<std::size_t>(i)];
    }

private:
    const DicePlan& plan_;
    int width_;
    V3d* out_;
};

} // namespace

bool canonical_border(const double* first, int degree, int step, double* out) {
    for (int i = 0; i <= degree; ++i) {
        std::copy_n(first + 4 * step * i, 4, out + 4 * i);
    }
    bool reverse = false;
    for (int i = 0; i < degree - i; ++i) {
        const double *a = out + 4 * i, *b = out + 4 * (degree - i);
        if (!std::equal(a, a + 4, b)) {
            reverse = std::lexicographical_compare(b, b + 4, a, a + 4);
            break;
        }
    }
    for (int i = 0; reverse && i < degree - i; ++i) {
        std::swap_ranges(out + 4 * i, out + 4 * i + 4, out + 4 * (degree - i));
    }
    return reverse;
}

void dice_part(int degree_u, int degree_v, const double* net, const DicePlan& plan,
               std::vector<V3d>& out) {
    const std::size_t first = out.size();
    out.resize(first + static_cast<std::size_t>(plan.vertices()));
    GridFiller grid(plan, out.data() + first);
    const int row = degree_u + 1, nu = plan.u.segments(), nv = plan.v.segments();
    grid.lay_inside(degree_u, degree_v, net);
    GridFiller::lay_border(net, degree_u, 1, plan.at_v0, plan.u,
                           [&](int i) -> V3d& { return grid.at(i, 0); });
    GridFiller::lay_border(net + 4 * row * degree_v, degree_u, 1, plan.at_v1, plan.u,
                           [&](int i) -> V3d& { return grid.at(i, nv); });
    GridFiller::lay_border(net, degree_v, row, plan.at_u0, plan.v,
                           [&](int j) -> V3d& { return grid.at(0, j); });
    GridFiller::lay_border(net + 4 * degree_u, degree_v, row, plan.at_u1, plan.v,
                           [&](int j) -> V3d& { return grid.at(nu, j); });
}

DiceError dice_error(int degree_u, int degree_v, const double* net, const DicePlan& plan) {
    const Bends b = bends(degree_u, degree_v, net);
    const auto strip = [&](double border_bend, double bend, double bend_across, int degree_across,
                           const ParamAxis& border, double h) {
        const double a = border.longest_segment(0, 1);
        if (a * border.segments() > 1.5) { // near the eye in places: the inside's bound stands in
            return 0.0f;
        }
        const double near =
            border_bend + std::max(bend - border_bend, 0.0) * std::min(1.0, degree_across * h);
        return static_cast<float>((near * a * a + 2 * b.uv * a * h + bend_across * h * h) / 8);
    };
    DiceError e;
    e.uu = static_cast<float>(b.uu), e.uv = static_cast<float>(b.uv);
    e.vv = static_cast<float>(b.vv);
    e.v0 = strip(b.uu_v0, b.uu, b.vv, degree_v, plan.at_v0, plan.v.spacing(0));
    e.v1 = strip(b.uu_v1, b.uu, b.vv, degree_v, plan.at_v1, plan.v.spacing(1));
    e.u0 = strip(b.vv_u0, b.vv, b.uu, degree_u, plan.at_u0, plan.u.spacing(0));
    e.u1 = strip(b.vv_u1, b.vv, b.uu, degree_u, plan.at_u1, plan.u.spacing(1));
    return e;
}

double DiceError::at(const DicePlan& plan, double u, double v) const {
    const double a = plan.u.spacing(u), b = plan.v.spacing(v);
    double error = (static_cast<double>(uu) * a * a + 2 * static_cast<double>(uv) * a * b +
                    static_cast<double>(vv) * b * b) /
                   8;
    const auto in_strip = [&](bool inside, float strip) {
        error = inside ? std::max(error, static_cast<double>(strip)) : error;
    };
    in_strip(v <= plan.v.spacing(0), v0);
    in_strip(v >= 1 - plan.v.spacing(1), v1);
    in_strip(u <= plan.u.spacing(0), u0);
    in_strip(u >= 1 - plan.u.spacing(1), u1);
    return error;
}

} // namespace geo
