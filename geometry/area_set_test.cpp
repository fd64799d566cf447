// SPDX-License-Identifier: Apache-2.0
// AreaSet: whichever way places are chosen, weights make them means over the area. Irradiance of
// emitters against configuration factors in closed form ([Howell]).
#include "geometry/area_set.h"
#include "geometry/test_scene.h"

#include <gtest/gtest.h>
#include <numbers>
#include <vector>

namespace geo::test {
namespace {

constexpr double pi = std::numbers::pi;

struct Emitter {
    SceneBuilder builder;
    QuietDiag quiet;
    std::unique_ptr<World> world;
    std::unique_ptr<const AreaSet> set;

    void build() {
        world = builder.world(quiet.diag);
        std::vector<std::uint32_t> all;
        for (std::uint32_t i = 0; i < builder.scene.primitives.size(); ++i) {
            all.push_back(i);
        }
        set = world->area_set(all);
    }
    struct Place {
        V3d P, N;
    };
    // Mean of weight * f over n x n numbers, at the middle of their cells.
    template <class Choose, class F> double mean(int n, Choose choose, F f) const {
        double sum = 0;
        std::vector<Hit> hits;
        std::vector<double> weights;
        const auto finish = [&] {
            const std::vector<Ray> rays(hits.size(), Ray{{0, 0, 0}, {0, 0, 1}});
            const Filled filled(*world, hits, rays);
            for (std::size_t i = 0; i < hits.size(); ++i) {
                sum += weights[i] * f(Place{filled.vec(SL_VAR_P, i), filled.vec(SL_VAR_Ng, i)});
            }
            hits.clear();
            weights.clear();
        };
        for (int i = 0; i < n * n; ++i) {
            const AreaPoint p = choose((i % n + 0.5) / n, (i / n + 0.5) / n);
            if (p.hit.valid()) {
                hits.push_back(p.hit);
                weights.push_back(p.weight);
            }
            if (hits.size() == SL_BATCH_MAX) {
                finish();
            }
        }
        finish();
        return sum / (n * n);
    }
    // Irradiance at P with normal n from Lambertian radiance 1 of the side of N, over pi: the
    // configuration factor. From all ways of choosing.
    double factor(const V3d& P, const V3d& n, int cells, bool by_angle) const {
        const auto received = [&](const Place& q) {
            const V3d d = q.P - P;
            const double r = length(d);
            const double here = dot(d, n) / r, there = -dot(d, q.N) / r;
            return here > 0 && there > 0 ? here * there / (r * r) * set->area() / pi : 0;
        };
        if (!by_angle) {
            return mean(
                cells, [&](double x, double y) { return set->by_area(x, y); }, received);
        }
        return mean(
            cells, [&](double x, double y) { return set->by_angle(P, x, y); }, received);
    }
};

TEST(AreaSet, FindsAreas) {
    Emitter e;
    e.builder.add(SceneBuilder::quadric(rib::QuadricKind::Sphere, {2, -2, 2, 360}));
    e.builder.add(SceneBuilder::quadric(rib::QuadricKind::Cylinder, {1, 0, 3, 180}));
    e.builder.add(SceneBuilder::quadric(rib::QuadricKind::Disk, {0, 2, 90}));
    e.builder.add(SceneBuilder::quadric(rib::QuadricKind::Torus, {3, 1, 0, 360, 360}));
    e.builder.add(
        SceneBuilder::polygons({1}, {4}, {0, 1, 2, 3}, {0, 0, 0, 2, 0, 0, 2, 3, 0, 0, 3, 0}),
        Mat4::scale({2, 1, 1}));
    e.build();
    const double expected = 16 * pi + 3 * pi + pi + 12 * pi * pi + 12;
    EXPECT_NEAR(e.set->area(), expected, 1e-4 * expected); // areas of curved ones by quadrature
}

// Every kind of surface: the mean place of a known function over the area.
TEST(AreaSet, PlacesAreUniformOnEveryKind) {
    struct Case {
        rib::Primitive primitive;
        double mean_z; // of P, over the area
    };
    std::vector<Case> cases;
    cases.push_back({SceneBuilder::quadric(rib::QuadricKind::Cone, {3, 2, 360}), 1});
    cases.push_back({SceneBuilder::quadric(rib::QuadricKind::Sphere, {1, 0, 1, 360}), 0.5});
    cases.push_back({SceneBuilder::quadric(rib::QuadricKind::Cylinder, {1, 1, 2, 90}), 1.5});
    cases.push_back(
        {SceneBuilder::quadric(rib::QuadricKind::Hyperboloid, {1, 0, 0, 2, 0, 1, 360}), 5.0 / 9});
    // z over r = sqrt(z): integral z sqrt(z + 1/4) / integral sqrt(z + 1/4), z in 0..1
    const auto F = [](double w) { return 0.4 * std::pow(w, 2.5) - std::pow(w, 1.5) / 6; };
    const auto G = [](double w) { return std::pow(w, 1.5) * 2 / 3; };
    cases.push_back({SceneBuilder::quadric(rib::QuadricKind::Paraboloid, {1, 0, 1, 360}),
                     (F(1.25) - F(0.25)) / (G(1.25) - G(0.25))});
    cases.push_back({SceneBuilder::polygons({1, 1}, {3, 3}, {0, 1, 2, 0, 2, 3},
                                            {0, 0, 0, 1, 0, 0, 1, 1, 1, 0, 1, 3}),
                     (1.0 / 3 * std::sqrt(2.0) + 4.0 / 3 * std::sqrt(14.0)) /
                         (std::sqrt(2.0) + std::sqrt(14.0))});
    for (std::size_t i = 0; i < cases.size(); ++i) {
        Emitter e;
        e.builder.add(cases[i].primitive);
        e.build();
        const double mean = e.mean(
            40, [&](double x, double y) { return e.set->by_area(x, y); },
            [](const Emitter::Place& q) { return q.P.z; });
        EXPECT_NEAR(mean, cases[i].mean_z, 2e-3 * cases[i].mean_z) << i; // midpoints, 1600 of them
        EXPECT_NEAR(e.mean(
                        40, [&](double x, double y) { return e.set->by_area(x, y); },
                        [](const Emitter::Place&) { return 1.0; }),
                    1, 1e-3)
            << i;
    }
}

// A square above a point of the plane below its corner, parallel ([Howell] C-11): four of these
// make the centre.
double square_factor(double half, double distance) {
    const double x = half / distance, s = std::sqrt(1 + x * x);
    return 4 / (2 * pi) * 2 * (x / s * std::atan(x / s));
}

TEST(AreaSet, SquareMatchesConfigurationFactor) {
    for (const double distance : {0.3, 1.0, 3.0}) {
        Emitter e;
        e.builder.add(SceneBuilder::polygons({1}, {4}, {0, 1, 2, 3},
                                             {-1, -1, 0, -1, 1, 0, 1, 1, 0, 1, -1, 0}),
                      Mat4::translate({0, 0, distance}));
        e.build();
        // whichever side the polygon faces
        const double a = e.factor({}, {0, 0, 1}, 64, true), exact = square_factor(1, distance);
        const double b = e.factor({0, 0, 2 * distance}, {0, 0, -1}, 64, true);
        EXPECT_NEAR(a + b, exact, 1e-3 * exact) << distance;
        const double c = e.factor({}, {0, 0, 1}, 64, false);
        const double d = e.factor({0, 0, 2 * distance}, {0, 0, -1}, 64, false);
        EXPECT_NEAR(c + d, exact, 2e-3 * exact) << distance;
        EXPECT_GT(e.set->seen_from({}).solid_angle, 0);
    }
}

TEST(AreaSet, TrianglesMatchTheSquareTheyMake) {
    Emitter e;
    e.builder.add(SceneBuilder::polygons({1, 1}, {3, 3}, {0, 1, 2, 3, 2, 1},
                                         {-1, -1, 0, 1, -1, 0, -1, 1, 0, 1, 1, 0}),
                  Mat4::translate({0, 0, 1}));
    e.build();
    const double sum =
        e.factor({}, {0, 0, 1}, 64, true) + e.factor({0, 0, 2}, {0, 0, -1}, 64, true);
    EXPECT_NEAR(sum, square_factor(1, 1), 1e-3 * square_factor(1, 1));
}

// ((r/d)^2 on the axis of a sphere, as long as all of it is above the horizon.
TEST(AreaSet, SphereMatchesConfigurationFactor) {
    for (const double distance : {1.05, 2.0, 10.0, 1000.0}) {
        Emitter e;
        e.builder.add(SceneBuilder::quadric(rib::QuadricKind::Sphere, {1, -1, 1, 360}),
                      Mat4::translate({0, 0, distance}));
        e.build();
        const double exact = 1 / (distance * distance);
        EXPECT_NEAR(e.factor({}, {0, 0, 1}, 48, true), exact, 1e-3 * exact) << distance;
        // both together are the mean over the whole area
        const double all = e.mean(
                               64, [&](double x, double y) { return e.set->by_angle({}, x, y); },
                               [&](const Emitter::Place& q) { return q.P.z - distance; }) +
                           e.mean(
                               64, [&](double x, double y) { return e.set->by_hidden({}, x, y); },
                               [&](const Emitter::Place& q) { return q.P.z - distance; });
        EXPECT_NEAR(all, 0, 0.02) << distance;
    }
}

TEST(AreaSet, DiskMatchesConfigurationFactor) {
    Emitter e;
    e.builder.add(SceneBuilder::quadric(rib::QuadricKind::Disk, {2, 1, 360}));
    e.build();
    const double exact = 1.0 / (1 + 4); // [Howell] B-12
    const double sum =
        e.factor({}, {0, 0, 1}, 100, false) + e.factor({0, 0, 4}, {0, 0, -1}, 100, false);
    EXPECT_NEAR(sum, exact, 1e-3 * exact);
}

// The farther it is off, the more its parts look alike: by angle falls back to by area.
TEST(AreaSet, FarSquaresAreChosenByArea) {
    Emitter e;
    e.builder.add(
        SceneBuilder::polygons({1}, {4}, {0, 1, 2, 3}, {-1, -1, 0, -1, 1, 0, 1, 1, 0, 1, -1, 0}),
        Mat4::translate({0, 0, 1000}));
    e.build();
    EXPECT_EQ(e.set->seen_from({}).solid_angle, 0);
}

} // namespace
} // namespace geo::test
