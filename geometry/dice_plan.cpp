// SPDX-License-Identifier: Apache-2.0
// Chooses the axes of a part (dice.h): how many segments, and where they must be shorter because
// the part comes near the eye there. Pieces of the part are halved until the raster size of a unit
// varies little over each; what every piece needs along u and v adds up to the axes.
#include "geometry/dice.h"
#include "geometry/dice_bounds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace geo {

namespace {

using base::Mat4;
using base::V3d;
using Need = ParamAxis::Need;
using Needs = std::vector<Need>;

constexpr int max_depth = 26;     // halvings of one direction
constexpr int max_pieces = 20000; // of one part and placement
constexpr int max_piece_segments = 4096;
// Share of the flatness that borders may use up; the strips beside them need the rest.
constexpr double border_share = 0.4;

// One way of seeing the part: a placement with perspective, or a plain scale.
struct Eye {
    const View* view = nullptr;
    double fixed_px_per_unit = 0; // without a view
};

double pixels_per_unit(const Hull& box, const Eye& eye) {
    return eye.view ? geo::pixels_per_unit(box.lo, box.hi, *eye.view) : eye.fixed_px_per_unit;
}

bool is_even(const Hull& box, const Eye& eye) {
    return !eye.view || distances(box.lo, box.hi, *eye.view).is_even();
}

int whole_number(double x) {
    return static_cast<int>(std::clamp(std::ceil(x - 1e-9), 1.0, double(max_piece_segments)));
}

// The bound of a cell of one by one parameters, as multiples of the flatness.
struct Excess {
    double uu, uv, vv;
};

// Least n with uu / n^2 + uv / (n m) + vv / m^2 <= 1; 0 if there is none.
int least_partner(double uu, double uv, double vv, int m) {
    const double left = 1 - vv / (double(m) * m), cross = uv / m;
    if (!(left > 0)) {
        return 0;
    }
    return whole_number((cross + std::sqrt(cross * cross + 4 * uu * left)) / (2 * left));
}

// Few segments that keep the bound below the flatness.
std::array<int, 2> segments(const Excess& e) {
    const double root_u = std::sqrt(e.uu), root_v = std::sqrt(e.vv);
    // Where both directions bend: equal shares of the error.
    const double mixed = root_u > 0 && root_v > 0 ? 2 + e.uv / (root_u * root_v) : 2;
    const int balanced_v = whole_number(std::sqrt(mixed) * root_v);
    const int square = whole_number(std::sqrt(e.uu + e.uv + e.vv));
    std::array<int, 2> best{max_piece_segments, max_piece_segments};
    const auto consider = [&](int u, int v) {
        if (u > 0 && v > 0 && (u + 1.0) * (v + 1.0) < (best[0] + 1.0) * (best[1] + 1.0)) {
            best = {u, v};
        }
    };
    for (const int v : {1, whole_number(root_v * 1.1), balanced_v, square}) {
        consider(least_partner(e.uu, e.uv, e.vv, v), v);
    }
    consider(1, least_partner(e.vv, e.uv, e.uu, 1));
    return best;
}

// Collects what one border curve needs; its own points decide, nothing else.
class BorderNeeds {
public:
    BorderNeeds(int degree, const DiceContext& context) : degree_(degree), context_(context) {}

    void add(const std::vector<double>& curve, const Eye& eye) {
        pieces_ = 0;
        visit(curve, eye, 0, 1, 0);
    }
    [[nodiscard]] ParamAxis axis() const {
        return ParamAxis::covering(needs_, max_border_segments);
    }

private:
    int degree_;
    const DiceContext& context_;
    Needs needs_;
    int pieces_ = 0;

    void visit(const std::vector<double>& curve, const Eye& eye, double lo, double hi, int depth) {
        const Hull box = hull(degree_ + 1, curve.data());
        const double excess = bends(degree_, 0, curve.data()).uu * pixels_per_unit(box, eye) /
                              (8 * border_share * context_.flatness_px);
        const int n = whole_number(std::sqrt(excess));
        if (n <= 1 || depth >= max_depth || ++pieces_ > max_pieces || is_even(box, eye)) {
            needs_.push_back({lo, hi, (hi - lo) / (depth < max_depth ? n : std::min(n, 16))});
            return;
        }
        std::vector<double> left, right;
        halve_u(degree_, 0, curve, left, right);
        visit(left, eye, lo, 0.5 * (lo + hi), depth + 1);
        visit(right, eye, 0.5 * (lo + hi), hi, depth + 1);
    }
};

// A border with its axis in the direction of the part.
struct Border {
    Needs needs;
    ParamAxis axis;
    bool reversed = false;

    [[nodiscard]] double longest_segment(double lo, double hi) const {
        return reversed ? axis.longest_segment(1 - hi, 1 - lo) : axis.longest_segment(lo, hi);
    }
};

struct Borders {
    Border v0, v1, u0, u1;
};

struct Piece {
    std::vector<double> net;
    double u0 = 0, u1 = 1, v0 = 0, v1 = 1;
    int depth_u = 0, depth_v = 0;
};

class InnerNeeds {
public:
    InnerNeeds(int degree_u, int degree_v, const DiceContext& context, const Borders& borders)
        : degree_u_(degree_u), degree_v_(degree_v), context_(context), borders_(borders) {}

    void add(std::vector<double> net, const Eye& eye) {
        pieces_ = 0;
        visit({std::move(net)}, eye);
    }
    Needs u, v;

private:
    int degree_u_, degree_v_;
    const DiceContext& context_;
    const Borders& borders_;
    int pieces_ = 0;

    void visit(const Piece& piece, const Eye& eye) {
        const Hull box = hull((degree_u_ + 1) * (degree_v_ + 1), piece.net.data());
        const Bends b = bends(degree_u_, degree_v_, piece.net.data());
        const double scale = pixels_per_unit(box, eye) / (8 * context_.flatness_px);
        const std::array<int, 2> n = segments({b.uu * scale, 2 * b.uv * scale, b.vv * scale});
        const bool deepest = piece.depth_u >= max_depth && piece.depth_v >= max_depth;
        if ((n[0] <= 1 && n[1] <= 1) || deepest || ++pieces_ > max_pieces || is_even(box, eye)) {
            const int most = deepest ? 16 : max_piece_segments;
            settle(piece, b, scale, {std::min(n[0], most), std::min(n[1], most)});
        } else {
            cut(piece, eye);
        }
    }

    void cut(const Piece& piece, const Eye& eye) {
        const bool along_u = piece.depth_v >= max_depth ||
                             (piece.depth_u < max_depth && length_u(piece) >= length_v(piece));
        Piece a = piece, b = piece;
        if (along_u) {
            halve_u(degree_u_, degree_v_, piece.net, a.net, b.net);
            a.u1 = b.u0 = 0.5 * (piece.u0 + piece.u1);
            ++a.depth_u, ++b.depth_u;
        } else {
            halve_v(degree_u_, degree_v_, piece.net, a.net, b.net);
            a.v1 = b.v0 = 0.5 * (piece.v0 + piece.v1);
            ++a.depth_v, ++b.depth_v;
        }
        visit(a, eye);
        visit(b, eye);
    }

    [[nodiscard]] double span_of(const Piece& piece, int from, int to) const {
        const Hull a = hull(1, piece.net.data() + 4 * from), b = hull(1, piece.net.data() + 4 * to);
        return length(b.lo - a.lo);
    }
    [[nodiscard]] double length_u(const Piece& p) const {
        const int top = (degree_u_ + 1) * degree_v_;
        return std::max(span_of(p, 0, degree_u_), span_of(p, top, top + degree_u_));
    }
    [[nodiscard]] double length_v(const Piece& p) const {
        const int top = (degree_u_ + 1) * degree_v_;
        return std::max(span_of(p, 0, top), span_of(p, degree_u_, top + degree_u_));
    }

    void settle(const Piece& p, const Bends& b, double scale, const std::array<int, 2>& n) {
        const double du = p.u1 - p.u0, dv = p.v1 - p.v0;
        u.push_back({p.u0, p.u1, du / n[0]});
        v.push_back({p.v0, p.v1, dv / n[1]});
        // Towards a border that is coarser than the piece the rows draw together: the strip beside
        // it bends as the border does, and not as the inside.
        const auto along_u = [&](const Border& border, double bend) {
            const double a = border.longest_segment(p.u0, p.u1) / du;
            return halvings({b.uu * scale, 2 * b.uv * scale, b.vv * scale}, bend * scale, degree_v_,
                            a, n[0], n[1]);
        };
        const auto along_v = [&](const Border& border, double bend) {
            const double a = border.longest_segment(p.v0, p.v1) / dv;
            return halvings({b.vv * scale, 2 * b.uv * scale, b.uu * scale}, bend * scale, degree_u_,
                            a, n[1], n[0]);
        };
        if (p.v0 <= 0) {
            draw_together(v, p.v0, dv, along_u(borders_.v0, b.uu_v0));
        }
        if (p.v1 >= 1) {
            draw_together(v, p.v1, -dv, along_u(borders_.v1, b.uu_v1));
        }
        if (p.u0 <= 0) {
            draw_together(u, p.u0, du, along_v(borders_.u0, b.vv_u0));
        }
        if (p.u1 >= 1) {
            draw_together(u, p.u1, -du, along_v(borders_.u1, b.vv_u1));
        }
    }

    // How often the distance of the first row must be halved. a: longest border segment, in
    // parameters of the piece, beyond which it may reach; the strip's bend goes from the border's
    // to the largest like 1 - (1 - h)^degree.
    static int halvings(const Excess& e, double border_bend, int degree_across, double a,
                        int n_along, int n_across) {
        if (a * n_along <= 1.001) {
            return 0;
        }
        const double least = border_bend * a * a; // what no distance can better
        const double limit = std::max(1.0, 1.25 * least);
        constexpr int most = 30;
        int k = 0;
        for (double h = 1; k < most; ++k, h /= 2) {
            const double bend =
                border_bend + std::max(e.uu - border_bend, 0.0) * std::min(1.0, degree_across * h);
            if (h <= 1.0 / n_across && bend * a * a + e.uv * a * h + e.vv * h * h <= limit) {
                break;
            }
        }
        return k;
    }

    // One row at that distance; the cells behind it are like all others.
    static void draw_together(Needs& needs, double border, double towards_inside, int halvings) {
        if (halvings > 0) {
            const double h = std::ldexp(towards_inside, -halvings);
            needs.push_back(
                {std::min(border, border + h), std::max(border, border + h), std::fabs(h)});
        }
    }
};

std::vector<double> transformed(const std::vector<double>& net, const Mat4& m) {
    std::vector<double> out(net.size());
    for (std::size_t i = 0; i < net.size(); i += 4) {
        for (std::size_t k = 0; k < 4; ++k) {
            out[i + k] = net[i] * m.m[0][k] + net[i + 1] * m.m[1][k] + net[i + 2] * m.m[2][k] +
                         net[i + 3] * m.m[3][k];
        }
    }
    return out;
}

// Calls see(net in camera space, eye) for every way the net is seen.
template <class See>
void for_all_eyes(const std::vector<double>& net, const DiceContext& context, See&& see) {
    for (const Mat4& m : context.cam_from_trace) {
        see(m == Mat4() ? net : transformed(net, m), Eye{&context.view, 0});
    }
    if (context.far_px_per_unit > 0) {
        see(net, Eye{nullptr, context.far_px_per_unit});
    }
}

Border plan_border(const double* first, int degree, int step, const DiceContext& context) {
    std::vector<double> curve(4 * (static_cast<std::size_t>(degree) + 1));
    Border border;
    border.reversed = canonical_border(first, degree, step, curve.data());
    BorderNeeds needs(degree, context);
    for_all_eyes(curve, context,
                 [&](const std::vector<double>& net, const Eye& eye) { needs.add(net, eye); });
    border.axis = needs.axis();
    border.axis.append_needs(border.needs);
    if (border.reversed) {
        for (Need& n : border.needs) {
            n = n.mirrored();
        }
    }
    return border;
}

ParamAxis inner_axis(const Needs& inner, double stretch, const Border& a, const Border& b) {
    Needs all = a.needs;
    all.insert(all.end(), b.needs.begin(), b.needs.end());
    for (const Need& n : inner) {
        all.push_back({n.lo, n.hi, n.spacing * stretch});
    }
    return ParamAxis::covering(all, std::numeric_limits<int>::max());
}

} // namespace

Distances distances(const V3d& lo, const V3d& hi, const View& view) {
    V3d near, far;
    for (int k = 0; k < 3; ++k) {
        near[k] = std::max({lo[k], -hi[k], 0.0});
        far[k] = std::max(std::fabs(lo[k]), std::fabs(hi[k]));
    }
    if (view.perspective) {
        return {std::max(length(near), view.near_clip), length(far)};
    }
    const double size = std::max(view.corner_x, view.corner_y);
    const auto beyond = [&](const V3d& p) {
        return std::max({p.x - view.corner_x, p.y - view.corner_y, 0.0});
    };
    return {size + beyond(near), size + beyond(far)};
}

double pixels_per_unit(const V3d& lo, const V3d& hi, const View& view) {
    const double scale = std::max(view.pixels_per_unit_x, view.pixels_per_unit_y);
    const Distances d = distances(lo, hi, view);
    if (!view.perspective) {
        return scale * std::max(view.corner_x, view.corner_y) / d.nearest;
    }
    // Across the ray a unit covers scale / distance; towards the corners of the picture up to
    // 1 / cos^2 of the angle more.
    const double secant = std::hypot(1, view.corner_x, view.corner_y);
    const double by_distance = secant * secant / d.nearest;
    if (!(lo.z > view.near_clip)) {
        return scale * by_distance;
    }
    return scale * std::min(by_distance, std::min(secant, d.farthest / lo.z) / lo.z);
}

DicePlan plan_part(int degree_u, int degree_v, const double* net, const DiceContext& context) {
    const int row = degree_u + 1;
    const Borders borders{plan_border(net, degree_u, 1, context),
                          plan_border(net + 4 * row * degree_v, degree_u, 1, context),
                          plan_border(net, degree_v, row, context),
                          plan_border(net + 4 * degree_u, degree_v, row, context)};
    InnerNeeds inner(degree_u, degree_v, context, borders);
    const std::vector<double> whole(net, net + 4 * row * (degree_v + 1));
    for_all_eyes(whole, context,
                 [&](const std::vector<double>& seen, const Eye& eye) { inner.add(seen, eye); });
    DicePlan plan{{}, {}, borders.v0.axis, borders.v1.axis, borders.u0.axis, borders.u1.axis};
    for (double stretch = 1; stretch < 1e9; stretch *= 1.2) {
        plan.u = inner_axis(inner.u, stretch, borders.v0, borders.v1);
        plan.v = inner_axis(inner.v, stretch, borders.u0, borders.u1);
        if (plan.vertices() <= max_part_vertices) {
            break;
        }
    }
    return plan;
}

} // namespace geo
