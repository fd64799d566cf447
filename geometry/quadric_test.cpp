// SPDX-License-Identifier: Apache-2.0
// Quadrics against the formulas of ri.md 11.9 written down once more in long double, and rays
// against sign changes of the implicit equations. All in object space: what transforms add is
// tested in world_test and fill_test.
#include "geometry/quadric_formula.h"
#include "geometry/revolution.h"

#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <numbers>
#include <random>

namespace {

using base::V3d;
using geo::LocalPoint;
using geo::SurfacePoint;
using rib::QuadricKind;
using namespace geo::test;

// Zero on the unlimited surface.
Real implicit(const rib::Quadric& q, const V3l& p) {
    const auto& a = q.args;
    const Real rho2 = p.x * p.x + p.y * p.y;
    switch (q.kind) {
    case QuadricKind::Sphere:
        return rho2 + p.z * p.z - Real(a[0]) * a[0];
    case QuadricKind::Cone: {
        const Real r = a[1] * (1 - p.z / a[0]);
        return rho2 - r * r;
    }
    case QuadricKind::Cylinder:
        return rho2 - Real(a[0]) * a[0];
    case QuadricKind::Hyperboloid: {
        const Real v = (p.z - a[2]) / (Real(a[5]) - a[2]);
        const Real x = (1 - v) * a[0] + v * a[3], y = (1 - v) * a[1] + v * a[4];
        return rho2 - x * x - y * y;
    }
    case QuadricKind::Paraboloid:
        return rho2 - Real(a[0]) * a[0] * p.z / a[2];
    case QuadricKind::Disk:
        return p.z - a[0];
    case QuadricKind::Torus: {
        const Real r = std::sqrt(rho2) - a[0];
        return r * r + p.z * p.z - Real(a[1]) * a[1];
    }
    }
    return 0;
}

struct Case {
    const char* name;
    rib::Quadric quadric;
};

std::vector<Case> cases() {
    using K = QuadricKind;
    return {
        {"sphere", {K::Sphere, {2, -2, 2, 360}}},
        {"sphere clipped", {K::Sphere, {2, -1, 1.5, 200}}},
        {"sphere negative sweep", {K::Sphere, {1, -0.5, 1, -270}}},
        {"sphere negative radius", {K::Sphere, {-1, -1, 1, 360}}},
        {"cone", {K::Cone, {3, 1, 360}}},
        {"cone down, partial", {K::Cone, {-2, 1.5, 100}}},
        {"cone negative radius", {K::Cone, {2, -1, 360}}},
        {"cylinder", {K::Cylinder, {1, -1, 2, 360}}},
        {"cylinder partial negative", {K::Cylinder, {0.5, 2, -1, -90}}},
        {"hyperboloid", {K::Hyperboloid, {1, 0, -1, 0.3, 1, 1.5, 360}}},
        {"hyperboloid as cone", {K::Hyperboloid, {1, 0, 0, 0, 0, 2, 250}}},
        {"hyperboloid as cylinder", {K::Hyperboloid, {1, 0.5, 0, 1, 0.5, 2, -300}}},
        {"hyperboloid as ring", {K::Hyperboloid, {1, 0, 0.5, 2, 0, 0.5, 360}}},
        {"paraboloid", {K::Paraboloid, {1.5, 0.25, 2, 360}}},
        {"paraboloid from tip", {K::Paraboloid, {1, 0, 1, 190}}},
        {"paraboloid hanging", {K::Paraboloid, {1, -0.5, -2, 360}}},
        {"disk", {K::Disk, {0.5, 2, 360}}},
        {"disk lower side", {K::Disk, {-1, 1, -360}}},
        {"torus", {K::Torus, {2, 0.5, 0, 360, 360}}},
        {"torus partial", {K::Torus, {1.5, 0.75, -60, 210, 300}}},
        {"torus spindle", {K::Torus, {0.5, 1, 0, 360, 360}}},
        {"torus thin", {K::Torus, {3, 0.01, 0, 360, 360}}},
    };
}

std::unique_ptr<geo::Surface> make(const rib::Quadric& q) {
    std::string why;
    auto s = geo::make_quadric(q, why);
    EXPECT_TRUE(s) << why;
    return s;
}

double relative(const V3d& a, const V3l& b, double scale) {
    return base::length(V3d(V3l(a) - b)) / scale;
}

TEST(Quadric, PointsDerivativesAndNormals) {
    const Real h = 1e-6L; // central difference in long double: error about h^2
    for (const Case& c : cases()) {
        SCOPED_TRACE(c.name);
        const auto s = make(c.quadric);
        for (int i = 0; i <= 40; ++i) {
            for (int j = 1; j < 40; ++j) {
                const double u = i / 40.0, v = j / 40.0;
                const SurfacePoint p = s->evaluate({0, u, v});
                const auto f = [&](Real x, Real y) { return formula(c.quadric, x, y); };
                const V3l dPdu = (f(u + h, v) - f(u - h, v)) / (2 * h),
                          dPdv = (f(u, v + h) - f(u, v - h)) / (2 * h);
                const double size = 1 + base::length(p.P);
                EXPECT_LT(relative(p.P, f(u, v), size), 1e-15);
                EXPECT_LT(relative(p.dPdu, dPdu, base::length(p.dPdu) + 1e-9), 1e-9);
                EXPECT_LT(relative(p.dPdv, dPdv, base::length(p.dPdv) + 1e-9), 1e-9);
                const V3l n = cross(dPdu, dPdv);
                if (base::length(n) > 1e-9L) {
                    EXPECT_LT(relative(p.Ng, n / base::length(n), 1), 1e-8) << u << " " << v;
                }
            }
        }
    }
}

TEST(Quadric, SingularPlacesHaveLimits) {
    for (const Case& c : cases()) {
        SCOPED_TRACE(c.name);
        const auto s = make(c.quadric);
        for (const double v : {0.0, 1.0}) {
            for (int i = 0; i <= 8; ++i) {
                const double u = i / 8.0;
                const SurfacePoint p = s->evaluate({0, u, v});
                // The limit along v: a normal close by, within what the curvature turns it.
                const SurfacePoint near = s->evaluate({0, u, v == 0 ? 1e-7 : 1 - 1e-7});
                EXPECT_NEAR(base::length(p.Ng), 1, 1e-12);
                // Near a paraboloid's tip the generator is r ~ sqrt(v): sqrt(1e-7) of the way
                // round.
                EXPECT_LT(base::length(p.Ng - near.Ng), 1e-3);
                for (const V3d& d : {p.dPdu, p.dPdv, p.P}) {
                    EXPECT_TRUE(std::isfinite(d.x) && std::isfinite(d.y) && std::isfinite(d.z));
                }
            }
        }
    }
}

TEST(Quadric, DifferencesAreFreeOfCancellation) {
    double worst = 0;
    for (const Case& c : cases()) {
        SCOPED_TRACE(c.name);
        const auto s = make(c.quadric);
        for (const double step : {1e-9, 1e-6, 1e-3, 0.2}) {
            for (int i = 0; i < 10; ++i) {
                for (int j = 0; j < 10; ++j) {
                    const LocalPoint at{0, i / 10.0, (j + 0.5) / 11};
                    const SurfacePoint here = s->evaluate(at);
                    for (const bool along_u : {true, false}) {
                        const double du = along_u ? step : 0, dv = along_u ? 0 : step;
                        if (at.v + dv > 1) {
                            continue;
                        }
                        const SurfacePoint d = s->difference(at, here, du, dv);
                        const V3l exact = formula(c.quadric, Real(at.u) + du, Real(at.v) + dv) -
                                          formula(c.quadric, at.u, at.v);
                        const double length = static_cast<double>(base::length(exact));
                        if (length > 0) {
                            // The reference itself cancels: long double leaves 1e-19 |P|.
                            const double allowed =
                                1e-12 + 1e-18 * (1 + base::length(here.P)) / length;
                            const double error = relative(d.P, exact, length);
                            EXPECT_LT(error, allowed) << at.u << " " << at.v << " step " << step;
                            worst = std::max(worst, error);
                        }
                    }
                }
            }
        }
    }
    RecordProperty("worst_relative_error", std::to_string(worst));
}

// The first place where the ray crosses the limited surface, by sampling the implicit equation.
bool first_crossing(const Case& c, const geo::Surface& s, const V3d& o, const V3d& d,
                    double& t_found) {
    const int steps = 4000;
    const double length = 12;
    Real before = implicit(c.quadric, V3l(o));
    for (int i = 1; i <= steps; ++i) {
        Real lo = Real(length) * (i - 1) / steps, hi = Real(length) * i / steps;
        const Real now = implicit(c.quadric, V3l(o) + V3l(d) * hi);
        if ((before < 0) != (now < 0)) {
            for (int k = 0; k < 70; ++k) {
                const Real mid = (lo + hi) / 2;
                ((implicit(c.quadric, V3l(o) + V3l(d) * mid) < 0) == (before < 0) ? lo : hi) = mid;
            }
            // Inside the limits if the surface's own bounds in u, v reproduce the point.
            geo::ObjectRay ray{o, d, static_cast<double>(lo) - 1e-7, static_cast<double>(lo) + 1e-7,
                               0};
            geo::LocalHit hit;
            if (s.intersect(ray, hit)) {
                t_found = static_cast<double>(lo);
                return true;
            }
        }
        before = now;
    }
    return false;
}

TEST(Quadric, RaysMeetTheFirstCrossing) {
    std::mt19937 rng(7);
    std::uniform_real_distribution<double> in(-1, 1);
    for (const Case& c : cases()) {
        if (std::string(c.name).find("ring") != std::string::npos) {
            continue; // its implicit equation is a plane; see RaysAimedAtPoints
        }
        SCOPED_TRACE(c.name);
        const auto s = make(c.quadric);
        int hits = 0;
        for (int n = 0; n < 300; ++n) {
            const V3d target(2 * in(rng), 2 * in(rng), 2 * in(rng));
            const V3d d = normalize(V3d(in(rng), in(rng), in(rng)));
            const V3d o = target - d * 6.0;
            double expected = 0;
            const bool crosses = first_crossing(c, *s, o, d, expected);
            geo::LocalHit hit;
            const bool found = s->intersect({o, d, 0, 12, 0}, hit);
            if (crosses) {
                ASSERT_TRUE(found);
                EXPECT_LE(hit.t, expected + 1e-9); // sampling may miss a thin chord before it
                EXPECT_LT(base::length(s->evaluate(hit.at).P - (o + d * hit.t)), 1e-9);
                hits += std::fabs(hit.t - expected) < 1e-9;
            }
        }
        if (std::string(c.name) != "torus thin") {
            EXPECT_GT(hits, 10);
        }
    }
}

// Rays aimed at places of the surface from any side find that place or one before it.
TEST(Quadric, RaysAimedAtPoints) {
    std::mt19937 rng(8);
    std::uniform_real_distribution<double> in(-1, 1), unit(0, 1);
    for (const double distance : {3.0, 1e3, 1e6}) {
        for (const Case& c : cases()) {
            SCOPED_TRACE(c.name);
            const auto s = make(c.quadric);
            int exact = 0;
            for (int n = 0; n < 400; ++n) {
                const LocalPoint at{0, unit(rng), unit(rng)};
                const SurfacePoint p = s->evaluate(at);
                const V3d d = normalize(V3d(in(rng), in(rng), in(rng)));
                if (std::fabs(dot(d, p.Ng)) < 0.05) {
                    continue; // grazing: rounding decides
                }
                const V3d o = p.P - d * distance;
                geo::LocalHit hit;
                // Towards the edge of a partial surface the aim itself is off by 1e-16 * distance.
                if (std::min({at.u, 1 - at.u, at.v, 1 - at.v}) < 1e-6) {
                    continue;
                }
                ASSERT_TRUE(s->intersect({o, d, 0, 2 * distance, 0}, hit)) << at.u << " " << at.v;
                EXPECT_LE(hit.t, distance * (1 + 1e-12) + 1e-9);
                EXPECT_LT(base::length(s->evaluate(hit.at).P - (o + d * hit.t)),
                          1e-9 + 1e-14 * distance);
                exact += std::fabs(hit.t - distance) < 1e-7;
            }
            EXPECT_GT(exact, 100); // about half are hidden behind the near side
        }
    }
}

TEST(Quadric, BoundsHoldTheSurface) {
    std::mt19937 rng(9);
    std::uniform_real_distribution<double> in(-1, 1);
    for (const Case& c : cases()) {
        SCOPED_TRACE(c.name);
        const auto s = make(c.quadric);
        for (int n = 0; n < 20; ++n) {
            base::Mat4 m;
            for (int i = 0; i < 4; ++i) {
                for (int k = 0; k < 3; ++k) {
                    m.m[i][k] = in(rng) * (i == 3 ? 100 : 2);
                }
            }
            const geo::Box box = s->bound(m);
            for (int i = 0; i <= 16; ++i) {
                for (int j = 0; j <= 16; ++j) {
                    const V3d p = point(m, s->evaluate({0, i / 16.0, j / 16.0}).P);
                    for (int k = 0; k < 3; ++k) {
                        EXPECT_GE(p[k], box.lo[k] - 1e-12 * std::fabs(p[k]));
                        EXPECT_LE(p[k], box.hi[k] + 1e-12 * std::fabs(p[k]));
                    }
                }
            }
        }
    }
}

TEST(Quadric, CullingSeesOneSide) {
    const auto s = make({QuadricKind::Sphere, {1, -1, 1, 360}});
    geo::LocalHit hit;
    ASSERT_TRUE(s->intersect({{0, 0.1, -5}, {0, 0, 1}, 0, 10, 1}, hit));
    EXPECT_LT(hit.t, 5);
    ASSERT_TRUE(s->intersect({{0, 0.1, -5}, {0, 0, 1}, 0, 10, -1}, hit));
    EXPECT_GT(hit.t, 5);
}

TEST(Quadric, RefusesWhatIsNoSurface) {
    using K = QuadricKind;
    const rib::Quadric bad[] = {
        {K::Sphere, {0, -1, 1, 360}},
        {K::Sphere, {1, -1, 1, 0}},
        {K::Sphere, {1, 2, 3, 360}},
        {K::Sphere, {NAN, -1, 1, 360}},
        {K::Sphere, {1e38, -1, 1, 360}},
        {K::Cone, {0, 1, 360}},
        {K::Cone, {1, 0, 360}},
        {K::Cylinder, {1, 1, 1, 360}},
        {K::Hyperboloid, {1, 2, 3, 1, 2, 3, 360}},
        {K::Hyperboloid, {0, 0, 0, 0, 0, 1, 360}},
        {K::Paraboloid, {1, 1, 1, 360}},
        {K::Disk, {1, 0, 360}},
        {K::Torus, {1, 0, 0, 360, 360}},
        {K::Torus, {1, 1, 10, 10, 360}},
        {K::Disk, {1, 1, INFINITY}},
    };
    for (const rib::Quadric& q : bad) {
        std::string why;
        EXPECT_FALSE(geo::make_quadric(q, why));
        EXPECT_FALSE(why.empty());
    }
}

// Any finite arguments: no crash, no NaN from evaluate, hits only where the ray is.
TEST(Quadric, SurvivesExtremeArguments) {
    std::mt19937 rng(10);
    const double values[] = {0, 1, -1, 1e-30, -1e-30, 1e17, -1e17, 360, 1e-3, 0.5};
    std::uniform_int_distribution<int> pick(0, 9), kind(0, 6);
    for (int n = 0; n < 5000; ++n) {
        rib::Quadric q;
        q.kind = static_cast<QuadricKind>(kind(rng));
        for (double& a : q.args) {
            a = values[pick(rng)];
        }
        std::string why;
        const auto s = geo::make_quadric(q, why);
        if (!s) {
            continue;
        }
        for (const double v : {0.0, 0.5, 1.0}) {
            const SurfacePoint p = s->evaluate({0, 0.25, v});
            EXPECT_FALSE(std::isnan(p.P.x + p.dPdu.x + p.dPdv.x + p.Ng.x));
        }
        geo::LocalHit hit;
        if (s->intersect({{0.3, 0.2, -3}, {0.1, -0.1, 1}, 0, 1e30, 0}, hit)) {
            EXPECT_TRUE(hit.at.u >= 0 && hit.at.u <= 1 && hit.at.v >= 0 && hit.at.v <= 1);
        }
    }
}

} // namespace
