// SPDX-License-Identifier: Apache-2.0
#include "geometry/accuracy.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace geo::test {

namespace {

struct Raster {
    double x, y;
};

class Projector {
public:
    explicit Projector(const View& view) : view_(view) {}
    [[nodiscard]] bool sees(const V3d& p) const {
        const double w = view_.perspective ? p.z : 1;
        return p.z > 1e-3 && std::fabs(p.x) <= view_.corner_x * w &&
               std::fabs(p.y) <= view_.corner_y * w;
    }
    [[nodiscard]] Raster operator()(const V3d& p) const {
        const double w = view_.perspective ? p.z : 1;
        return {p.x / w * view_.pixels_per_unit_x, p.y / w * view_.pixels_per_unit_y};
    }

private:
    const View& view_;
};

double distance(const Raster& a, const Raster& b) {
    return std::hypot(a.x - b.x, a.y - b.y);
}

double distance_to_segment(const Raster& p, const Raster& a, const Raster& b) {
    const double dx = b.x - a.x, dy = b.y - a.y, dd = dx * dx + dy * dy;
    const double s =
        dd > 0 ? std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / dd, 0.0, 1.0) : 0.0;
    return distance(p, {a.x + s * dx, a.y + s * dy});
}

// The grid of one part: vertices and the parameters they stand for.
class Grid {
public:
    Grid(int degree, const std::vector<double>& net, const View& view, double flatness_px)
        : degree_(degree), net_(net), plan_(make_plan(degree, net, view, flatness_px)),
          width_(plan_.u.segments() + 1), height_(plan_.v.segments() + 1) {
        dice_part(degree, degree, net.data(), plan_, P_);
        for (V3d& p : P_) { // as Embree gets them
            p = V3d(double(float(p.x)), double(float(p.y)), double(float(p.z)));
        }
    }
    [[nodiscard]] std::int64_t vertices() const { return plan_.vertices(); }
    [[nodiscard]] int width() const { return width_; }
    [[nodiscard]] int height() const { return height_; }
    [[nodiscard]] const V3d& P(int i, int j) const { return P_[std::size_t(j * width_ + i)]; }
    [[nodiscard]] double s(int i, int j) const {
        const double s = plan_.u.vertex(i);
        return j == 0             ? snapped(s, plan_.at_v0, 0, 1)
               : j == height_ - 1 ? snapped(s, plan_.at_v1, (degree_ + 1) * degree_, 1)
                                  : s;
    }
    [[nodiscard]] double t(int i, int j) const {
        const double t = plan_.v.vertex(j);
        return i == 0            ? snapped(t, plan_.at_u0, 0, degree_ + 1)
               : i == width_ - 1 ? snapped(t, plan_.at_u1, degree_, degree_ + 1)
                                 : t;
    }
    [[nodiscard]] V3d truth(double s, double t) const {
        return evaluate_part(degree_, degree_, net_.data(), s, t).P;
    }
    // Weight of the true surface: what interpolation on a triangle weighs its corners by.
    [[nodiscard]] double weight(double s, double t) const {
        double b[4], c[4], unused[4], sum = 0;
        bernstein(degree_, s, b, unused);
        bernstein(degree_, t, c, unused);
        for (int k = 0; k < (degree_ + 1) * (degree_ + 1); ++k) {
            sum += b[k % (degree_ + 1)] * c[k / (degree_ + 1)] * net_[std::size_t(4 * k + 3)];
        }
        return sum;
    }
    [[nodiscard]] int column(double s) const {
        return std::clamp(int(plan_.u.position(s) * (width_ - 1)), 0, width_ - 2);
    }
    [[nodiscard]] int line(double t) const {
        return std::clamp(int(plan_.v.position(t) * (height_ - 1)), 0, height_ - 2);
    }

private:
    int degree_;
    const std::vector<double>& net_;
    DicePlan plan_;
    int width_, height_;
    std::vector<V3d> P_;

    static DicePlan make_plan(int degree, const std::vector<double>& net, const View& view,
                              double flatness_px) {
        const Mat4 identity;
        DiceContext context{view, std::span(&identity, 1), 0, flatness_px};
        return plan_part(degree, degree, net.data(), context);
    }
    [[nodiscard]] double snapped(double s, const ParamAxis& border, int first, int step) const {
        double curve[16];
        const bool reversed =
            canonical_border(net_.data() + std::ptrdiff_t(4) * first, degree_, step, curve);
        const double at = border.vertex(border.nearest(reversed ? 1 - s : s));
        return reversed ? 1 - at : at;
    }
};

// Corresponding points inside every triangle (of rational parts: of the homogeneous triangle).
// Embree cuts a quad from (1, 0) to (0, 1).
double deviation(const Grid& g, const Projector& project) {
    constexpr double inner[][3] = {
        {1. / 3, 1. / 3, 1. / 3}, {.5, .5, 0}, {.5, 0, .5}, {0, .5, .5}, {.6, .2, .2}};
    double worst = 0;
    for (int j = 0; j + 1 < g.height(); ++j) {
        for (int i = 0; i + 1 < g.width(); ++i) {
            const int corners[2][3][2] = {{{i, j}, {i + 1, j}, {i, j + 1}},
                                          {{i + 1, j + 1}, {i, j + 1}, {i + 1, j}}};
            for (const auto& c : corners) {
                for (const auto& w : inner) {
                    V3d P;
                    double s = 0, t = 0, total = 0;
                    for (int k = 0; k < 3; ++k) {
                        const int i2 = c[k][0], j2 = c[k][1];
                        const double h = w[k] * g.weight(g.s(i2, j2), g.t(i2, j2));
                        P += g.P(i2, j2) * h;
                        total += h;
                        s += g.s(i2, j2) * w[k];
                        t += g.t(i2, j2) * w[k];
                    }
                    P = P / total;
                    const V3d Q = g.truth(s, t);
                    if (project.sees(Q) && project.sees(P)) {
                        worst = std::max(worst, distance(project(P), project(Q)));
                    }
                }
            }
        }
    }
    return worst;
}

// How far triangles near (s, t) reach along a raster line from `at` in direction n: the outline of
// the grid there.
std::optional<double> reach_along(const Grid& g, const Projector& project, double s, double t,
                                  const Raster& at, const Raster& n) {
    std::optional<double> reach;
    const int ci = g.column(s), cj = g.line(t), near = 2;
    const auto add_edge = [&](const V3d& a3, const V3d& b3) {
        const Raster a = project(a3), b = project(b3);
        const double da = (a.x - at.x) * n.y - (a.y - at.y) * n.x;
        const double db = (b.x - at.x) * n.y - (b.y - at.y) * n.x;
        if ((da > 0) == (db > 0)) {
            return;
        }
        const double f = da / (da - db);
        const double r =
            (a.x + f * (b.x - a.x) - at.x) * n.x + (a.y + f * (b.y - a.y) - at.y) * n.y;
        reach = std::max(reach.value_or(-1e300), r);
    };
    for (int j = std::max(cj - near, 0); j <= std::min(cj + near, g.height() - 2); ++j) {
        for (int i = std::max(ci - near, 0); i <= std::min(ci + near, g.width() - 2); ++i) {
            add_edge(g.P(i, j), g.P(i + 1, j));
            add_edge(g.P(i, j), g.P(i, j + 1));
            add_edge(g.P(i + 1, j), g.P(i, j + 1));
            add_edge(g.P(i + 1, j), g.P(i + 1, j + 1));
            add_edge(g.P(i, j + 1), g.P(i + 1, j + 1));
        }
    }
    return reach;
}

// Places where the true surface is seen edge on, by bisection along parameter lines.
class Folds {
public:
    Folds(const Grid& g, int degree, const std::vector<double>& net, const View& view)
        : g_(g), degree_(degree), net_(net), view_(view), project_(view) {}

    void measure(PartAccuracy& out) {
        constexpr int lines = 13, steps = 64;
        for (int k = 1; k < lines; ++k) {
            for (int i = 0; i < steps; ++i) {
                along(double(k) / lines, double(i) / steps, double(i + 1) / steps, true, out);
                along(double(k) / lines, double(i) / steps, double(i + 1) / steps, false, out);
            }
        }
    }

private:
    const Grid& g_;
    int degree_;
    const std::vector<double>& net_;
    const View& view_;
    Projector project_;

    [[nodiscard]] BezierPoint at(double fixed, double x, bool along_u) const {
        return evaluate_part(degree_, degree_, net_.data(), along_u ? x : fixed,
                             along_u ? fixed : x);
    }
    [[nodiscard]] double facing(const BezierPoint& p) const {
        return dot(cross(p.dPdu, p.dPdv), view_.perspective ? p.P : V3d(0, 0, 1));
    }
    void along(double fixed, double a, double b, bool along_u, PartAccuracy& out) {
        double fa = facing(at(fixed, a, along_u)), fb = facing(at(fixed, b, along_u));
        if ((fa > 0) == (fb > 0)) {
            return;
        }
        for (int i = 0; i < 60; ++i) {
            const double m = 0.5 * (a + b);
            ((facing(at(fixed, m, along_u)) > 0) == (fa > 0) ? a : b) = m;
        }
        measure_at(fixed, a, along_u, out);
    }
    void measure_at(double fixed, double x, bool along_u, PartAccuracy& out) {
        const BezierPoint p = at(fixed, x, along_u);
        const double s = along_u ? x : fixed, t = along_u ? fixed : x;
        const V3d n3 = cross(p.dPdu, p.dPdv);
        const double length_n = std::hypot(n3.x, n3.y);
        if (!project_.sees(p.P) || !(length_n > 1e-9 * length(n3)) || is_cusp(s, t)) {
            return;
        }
        Raster n{n3.x / length_n, n3.y / length_n};
        if (curvature_sign(s, t, n) > 0) { // the surface lies on the side of -n
            n = {-n.x, -n.y};
        }
        const auto reach = reach_along(g_, project_, s, t, project_(p.P), n);
        if (reach) {
            out.silhouette_px = std::max(out.silhouette_px, std::fabs(*reach));
            ++out.outline_points;
        }
    }
    // Which way the fold opens: the raster offset along n of near points on both sides.
    [[nodiscard]] double curvature_sign(double s, double t, const Raster& n) const {
        double sum = 0;
        const Raster here = project_(g_.truth(s, t));
        for (int k = 0; k < 8; ++k) {
            const double angle = k * std::numbers::pi / 4, h = 1e-3;
            const Raster q = project_(g_.truth(s + h * std::cos(angle), t + h * std::sin(angle)));
            sum += (q.x - here.x) * n.x + (q.y - here.y) * n.y;
        }
        return sum;
    }
    // Near a cusp of the outline, or where two folds come close, "the" fold along a line is not
    // one.
    [[nodiscard]] bool is_cusp(double s, double t) const {
        const Raster here = project_(g_.truth(s, t));
        const V3d n3 = [&] {
            const BezierPoint p = evaluate_part(degree_, degree_, net_.data(), s, t);
            return cross(p.dPdu, p.dPdv);
        }();
        const double l = std::hypot(n3.x, n3.y);
        bool plus = false, minus = false;
        double largest = 0;
        for (int k = 0; k < 16; ++k) {
            const double angle = k * std::numbers::pi / 8, h = 0.08;
            const double qs = s + h * std::cos(angle), qt = t + h * std::sin(angle);
            if (qs < 0 || qs > 1 || qt < 0 || qt > 1) {
                return true; // the border's own measure covers it
            }
            const Raster q = project_(g_.truth(qs, qt));
            const double d = ((q.x - here.x) * n3.x + (q.y - here.y) * n3.y) / l;
            largest = std::max(largest, std::fabs(d));
            plus = plus || d > 0.02;
            minus = minus || d < -0.02;
        }
        return plus == minus;
    }
};

// Cuts off what lies behind the eye; false if that is all.
bool clip_before_eye(V3d& a, V3d& b) {
    constexpr double least_z = 1e-6;
    if (a.z < least_z && b.z < least_z) {
        return false;
    }
    V3d& behind = a.z < b.z ? a : b;
    const V3d& before = a.z < b.z ? b : a;
    if (behind.z < least_z) {
        behind = before + (behind - before) * ((before.z - least_z) / (before.z - behind.z));
    }
    return true;
}

// Dense points of the four borders against the polyline of the grid.
void measure_borders(const Grid& g, const Projector& project, PartAccuracy& out) {
    for (int side = 0; side < 4; ++side) {
        const bool along_u = side < 2;
        const double fixed = side % 2;
        const int n = along_u ? g.width() : g.height();
        const auto vertex = [&](int i) {
            return along_u ? g.P(i, fixed > 0 ? g.height() - 1 : 0)
                           : g.P(fixed > 0 ? g.width() - 1 : 0, i);
        };
        for (int k = 0; k <= 200; ++k) {
            const double x = k / 200.0;
            const V3d p = along_u ? g.truth(x, fixed) : g.truth(fixed, x);
            if (!project.sees(p)) {
                continue;
            }
            double least = 1e300;
            for (int i = 0; i + 1 < n; ++i) {
                V3d a = vertex(i), b = vertex(i + 1);
                if (clip_before_eye(a, b)) {
                    least =
                        std::min(least, distance_to_segment(project(p), project(a), project(b)));
                }
            }
            if (least < 1e300) {
                out.silhouette_px = std::max(out.silhouette_px, least);
                ++out.outline_points;
            }
        }
    }
}

} // namespace

std::vector<double> random_part(std::mt19937& rng, int degree, double size, const V3d& centre) {
    std::uniform_real_distribution<double> jitter(-1, 1);
    const double rough = 0.15 + 0.35 * (1 + jitter(rng)); // from nearly flat to folded over
    const double a = 3 * jitter(rng), b = 3 * jitter(rng);
    const bool rational = jitter(rng) > 1.0 / 3;
    std::vector<double> net;
    for (int j = 0; j <= degree; ++j) {
        for (int i = 0; i <= degree; ++i) {
            V3d p(2.0 * i / degree - 1 + rough * jitter(rng),
                  2.0 * j / degree - 1 + rough * jitter(rng), rough * jitter(rng));
            p = V3d(p.x * std::cos(a) - p.z * std::sin(a), p.y,
                    p.x * std::sin(a) + p.z * std::cos(a));
            p = V3d(p.x, p.y * std::cos(b) - p.z * std::sin(b),
                    p.y * std::sin(b) + p.z * std::cos(b));
            p = p * size + centre;
            const double w = rational ? std::exp(jitter(rng)) : 1;
            net.insert(net.end(), {p.x * w, p.y * w, p.z * w, w});
        }
    }
    return net;
}

View test_view(double pixels, double fov_deg) {
    View view;
    view.corner_x = view.corner_y = std::tan(fov_deg * std::numbers::pi / 360);
    view.pixels_per_unit_x = view.pixels_per_unit_y = pixels / (2 * view.corner_x);
    return view;
}

PartAccuracy measure_part(int degree, const std::vector<double>& net_cam, const View& view,
                          double flatness_px) {
    const Grid grid(degree, net_cam, view, flatness_px);
    const Projector project(view);
    PartAccuracy out;
    out.vertices = grid.vertices();
    out.deviation_px = deviation(grid, project);
    measure_borders(grid, project, out);
    Folds(grid, degree, net_cam, view).measure(out);
    return out;
}

double percentile(std::vector<double> values, double p) {
    if (values.empty()) {
        return 0;
    }
    std::sort(values.begin(), values.end());
    return values[std::min(values.size() - 1, std::size_t(p * double(values.size())))];
}

namespace {

constexpr std::array<float, 16> b_spline{-1 / 6.f, 3 / 6.f, -3 / 6.f, 1 / 6.f, 3 / 6.f, -6 / 6.f,
                                         3 / 6.f,  0,       -3 / 6.f, 0,       3 / 6.f, 0,
                                         1 / 6.f,  4 / 6.f, 1 / 6.f,  0};

rib::Primitive patches(rib::Patches shape, std::vector<float> values, bool rational) {
    rib::Primitive p;
    p.shape = shape;
    p.params.params.push_back(param(rational ? "Pw" : "P", rib::StorageClass::Vertex,
                                    rational ? rib::ParamType::HPoint : rib::ParamType::Point,
                                    std::move(values)));
    return p;
}

// Control polygon of a pot with poles: radius and height by row.
constexpr double pot[][2] = {{0, -1},  {.5, -1}, {1, -.9},  {1, -.3}, {1, .3},
                             {.3, .3}, {.3, .7}, {.3, 1.0}, {.2, 1},  {0, 1}};
constexpr int pot_rows = 10;

V3d pot_point(int row, int column) {
    // A cubic circle in four quarters: 12 control points around.
    constexpr double k = 0.5522847498307936;
    constexpr double quarter[3][2] = {{1, 0}, {1, k}, {k, 1}};
    const double x = quarter[column % 3][0], y = quarter[column % 3][1];
    const double turn[4][2] = {{x, y}, {-y, x}, {-x, -y}, {y, -x}};
    const auto& q = turn[column / 3 % 4];
    return {pot[row][0] * q[0], pot[row][1], pot[row][0] * q[1]};
}

void append(std::vector<float>& out, const V3d& p, double scale) {
    out.insert(out.end(), {float(p.x * scale), float(p.y * scale), float(p.z * scale)});
}

rib::Primitive spline_torus(double scale) {
    constexpr int around = 9, across = 7;
    std::vector<float> P;
    for (int j = 0; j < across; ++j) {
        for (int i = 0; i < around; ++i) {
            const double a = 2 * std::numbers::pi * i / around,
                         b = 2 * std::numbers::pi * j / across;
            const double r = 1 + 0.45 * std::cos(b);
            append(P, {r * std::cos(a), r * std::sin(a), 0.45 * std::sin(b)}, scale);
        }
    }
    return patches({.bicubic = true,
                    .is_mesh = true,
                    .nu = around,
                    .nv = across,
                    .uperiodic = true,
                    .vperiodic = true},
                   P, false);
}

std::vector<rib::Primitive> pot_patches(double scale) {
    std::vector<rib::Primitive> out;
    for (int b = 0; b < pot_rows / 3; ++b) {
        for (int a = 0; a < 4; ++a) {
            std::vector<float> P;
            const bool turned = (a + b) % 2; // neighbours run in different directions
            for (int j = 0; j < 4; ++j) {
                for (int i = 0; i < 4; ++i) {
                    append(P,
                           turned ? pot_point(3 * b + 3 - i, 3 * a + j)
                                  : pot_point(3 * b + j, 3 * a + i),
                           scale);
                }
            }
            out.push_back(patches({.bicubic = true, .nu = 4, .nv = 4}, P, false));
        }
    }
    return out;
}

rib::Primitive pot_mesh(double scale) {
    std::vector<float> P;
    for (int j = 0; j < pot_rows; ++j) {
        for (int i = 0; i < 12; ++i) {
            append(P, pot_point(j, i), scale);
        }
    }
    return patches({.bicubic = true, .is_mesh = true, .nu = 12, .nv = pot_rows, .uperiodic = true},
                   P, false);
}

// The nine-point circle swept along the five-point half circle: exact, with poles.
rib::Primitive rational_ball(double scale) {
    const double w = std::sqrt(0.5);
    const double circle[9][3] = {{1, 0, 1},   {1, 1, w},  {0, 1, 1},  {-1, 1, w}, {-1, 0, 1},
                                 {-1, -1, w}, {0, -1, 1}, {1, -1, w}, {1, 0, 1}};
    const double half[5][3] = {{0, -1, 1}, {1, -1, w}, {1, 0, 1}, {1, 1, w}, {0, 1, 1}};
    std::vector<float> Pw;
    for (const auto& h : half) {
        for (const auto& c : circle) {
            const double weight = h[2] * c[2];
            for (const double x : {h[0] * c[0], h[1], h[0] * c[1]}) {
                Pw.push_back(float(x * scale * weight));
            }
            Pw.push_back(float(weight));
        }
    }
    rib::Primitive p;
    p.shape = rib::NuPatch{.nu = 9,
                           .uorder = 3,
                           .nv = 5,
                           .vorder = 3,
                           .uknot = {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4},
                           .vknot = {0, 0, 0, 1, 1, 2, 2, 2},
                           .umin = 0,
                           .umax = 4,
                           .vmin = 0,
                           .vmax = 2};
    p.params.params.push_back(
        param("Pw", rib::StorageClass::Vertex, rib::ParamType::HPoint, std::move(Pw)));
    return p;
}

// A point well inside, unscaled.
V3d inside(Closed kind, std::mt19937& rng) {
    std::uniform_real_distribution<double> unit(-1, 1);
    if (kind == Closed::SplineTorus) {
        const double a = std::numbers::pi * unit(rng);
        return V3d(0.93 * std::cos(a), 0.93 * std::sin(a), 0) +
               V3d(unit(rng), unit(rng), unit(rng)) * 0.12;
    }
    return V3d(unit(rng), unit(rng), unit(rng)) * 0.12 + V3d(0, -0.2, 0);
}

} // namespace

rib::Scene closed_scene(Closed kind, double scale, const Mat4& camera_from_world) {
    SceneBuilder b;
    b.scene.camera_from_world = still(camera_from_world);
    rib::Basis basis;
    if (kind == Closed::SplineTorus) {
        basis = {b_spline, b_spline, 1, 1};
    }
    b.attributes().basis = basis;
    switch (kind) {
    case Closed::SplineTorus:
        b.add(spline_torus(scale));
        break;
    case Closed::BezierPot:
        b.add(pot_mesh(scale));
        break;
    case Closed::PatchesPot:
        for (rib::Primitive& p : pot_patches(scale)) {
            b.add(std::move(p));
        }
        break;
    case Closed::RationalBall:
        b.add(rational_ball(scale));
        break;
    }
    return std::move(b.scene);
}

std::size_t count_leaks(const World& world, Closed kind, double scale,
                        const Mat4& camera_from_world, std::size_t rays, unsigned seed) {
    std::mt19937 rng(seed);
    std::normal_distribution<double> normal;
    std::size_t leaks = 0;
    for (std::size_t k = 0; k < rays; k += RayPacket::size) {
        RayPacket packet{};
        for (int i = 0; i < RayPacket::size; ++i) {
            const V3d o = point(camera_from_world, inside(kind, rng) * scale);
            const V3d d = normalize(V3d(normal(rng), normal(rng), normal(rng)));
            set_ray(packet, i, {V3f(o), V3f(d)});
        }
        Hit hits[RayPacket::size];
        world.intersect(packet, hits);
        leaks += std::size_t(
            std::count_if(hits, hits + RayPacket::size, [](const Hit& h) { return !h.valid(); }));
    }
    return leaks;
}

} // namespace geo::test
