// SPDX-License-Identifier: Apache-2.0
// The fill function: values and auxiliary differences in camera space against formulas in double,
// through random transforms, mirrored ones and far offsets.
#include "geometry/revolution.h"
#include "geometry/test_scene.h"

#include <cmath>
#include <cstring>
#include <gtest/gtest.h>
#include <numbers>
#include <random>

namespace {

using namespace geo::test;
using geo::Hit;
using geo::LocalPoint;
using geo::SurfacePoint;
using geo::World;
using rib::ParamType;
using rib::QuadricKind;
using rib::StorageClass;

constexpr double float_ulp = 1.0 / (1 << 23);

const std::vector<rib::Quadric>& quadrics() {
    using K = QuadricKind;
    static const std::vector<rib::Quadric> all{{K::Sphere, {1, -1, 1, 360}},
                                               {K::Sphere, {1.5, -1, 0.7, -200}},
                                               {K::Cone, {2, 1, 360}},
                                               {K::Cylinder, {1, -1, 1, 300}},
                                               {K::Hyperboloid, {1, 0, -1, 0.3, 1, 1, 360}},
                                               {K::Paraboloid, {1, 0, 1.5, 360}},
                                               {K::Disk, {0, 1, -360}},
                                               {K::Torus, {1, 0.4, 0, 360, 360}}};
    return all;
}

Mat4 random_transform(std::mt19937& rng, double offset, bool mirrored) {
    std::uniform_real_distribution<double> in(-1, 1), size(0.5, 2);
    return Mat4::translate(V3d(in(rng), in(rng), 1.5) * offset) *
           Mat4::rotate(180 * in(rng), {in(rng), in(rng), in(rng)}) *
           *Mat4::skew(20 * in(rng), {1, 0, 0}, {0, 1, 0.2}) *
           Mat4::scale({size(rng), size(rng), (mirrored ? -1 : 1) * size(rng)});
}

// A hit at known parameters, as if a ray had come from 5 units away, and that ray.
struct Aimed {
    Hit hit;
    Ray ray;
};

Aimed aim(const Mat4& place, const geo::Surface& s, double u, double v, std::mt19937& rng) {
    Aimed a;
    a.hit.shape = 0;
    a.hit.u = float(u);
    a.hit.v = float(v);
    std::uniform_real_distribution<float> in(-1, 1);
    const V3f d = normalize(V3f(in(rng), in(rng), in(rng)));
    a.ray = {V3f(point(place, s.evaluate({0, u, v}).P)) - d * 5.0f, d};
    return a;
}

double error(const V3d& got, const V3d& expected, double scale) {
    return base::length(got - expected) / scale;
}

TEST(Fill, QuadricsInCameraSpace) {
    std::mt19937 rng(1);
    std::uniform_real_distribution<double> unit(0, 1);
    for (const double offset : {0.0, 1e3, 1e6}) {
        for (const rib::Quadric& q : quadrics()) {
            for (const bool mirrored : {false, true}) {
                for (const bool matches : {true, false}) {
                    const Mat4 place = random_transform(rng, offset, mirrored);
                    SceneBuilder b;
                    b.attributes().orientation_matches = matches;
                    b.add(SceneBuilder::quadric(q.kind, q.args), place);
                    QuietDiag d;
                    const auto world = b.world(d.diag);
                    std::string why;
                    const auto s = geo::make_quadric(q, why);
                    for (int k = 0; k < 30; ++k) {
                        const Aimed a = aim(place, *s, unit(rng), unit(rng), rng);
                        const Filled f(*world, {a.hit}, {a.ray});
                        const SurfacePoint e = s->evaluate({0, a.hit.u, a.hit.v});
                        const V3d P = point(place, e.P), dPdu = vector(place, e.dPdu),
                                  dPdv = vector(place, e.dPdv);
                        // Everything is rounded once: half an ulp per coordinate, sqrt(3)/2 in
                        // length.
                        EXPECT_LT(error(f.vec(SL_VAR_P, 0), P, base::length(P)), float_ulp);
                        EXPECT_LT(error(f.vec(SL_VAR_dPdu, 0), dPdu, base::length(dPdu) + 1e-20),
                                  float_ulp);
                        EXPECT_LT(error(f.vec(SL_VAR_dPdv, 0), dPdv, base::length(dPdv) + 1e-20),
                                  float_ulp);
                        // ri.md 8.6: derivatives in shading space need the sign of the determinant.
                        V3d n = normalize(cross(dPdu, dPdv)) * (matches ? 1.0 : -1.0) *
                                (mirrored ? -1.0 : 1.0);
                        EXPECT_LT(error(f.vec(SL_VAR_Ng, 0), n, 1), 2 * float_ulp);
                        EXPECT_EQ(f.vec(SL_VAR_N, 0), f.vec(SL_VAR_Ng, 0));
                        EXPECT_LT(error(f.vec(SL_VAR_I, 0), P - V3d(a.ray.o), 5), float_ulp);
                        EXPECT_EQ(f.at(SL_VAR_E, 0) + f.at(SL_VAR_E, 1) + f.at(SL_VAR_E, 2),
                                  0); // uniform
                        EXPECT_EQ(f.at(SL_VAR_u, 0), a.hit.u);
                        EXPECT_EQ(f.at(SL_VAR_s, 0), a.hit.u);
                        EXPECT_EQ(f.at(SL_VAR_t, 0), a.hit.v);
                        EXPECT_EQ(f.vec(SL_VAR_dPdtime, 0), V3d());
                    }
                }
            }
        }
    }
}

TEST(Fill, SpheresFaceOutwardsInEveryTransform) {
    std::mt19937 rng(2);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int n = 0; n < 200; ++n) {
        const Mat4 place = random_transform(rng, 3, n % 2 == 0);
        SceneBuilder b;
        b.add(SceneBuilder::quadric(QuadricKind::Sphere, {1, -1, 1, 360}), place);
        QuietDiag d;
        const auto world = b.world(d.diag);
        std::string why;
        const auto s = geo::make_quadric({QuadricKind::Sphere, {1, -1, 1, 360}}, why);
        // Poles included.
        const Aimed a = aim(place, *s, unit(rng), n % 5 == 0 ? 0 : n % 5 == 1 ? 1 : unit(rng), rng);
        const Filled f(*world, {a.hit}, {a.ray});
        EXPECT_GT(dot(f.vec(SL_VAR_Ng, 0), f.vec(SL_VAR_P, 0) - point(place, V3d())), 0.1);
        EXPECT_NEAR(base::length(f.vec(SL_VAR_Ng, 0)), 1, float_ulp);
    }
}

TEST(Fill, StepsFollowTheFootprint) {
    SceneBuilder b;
    b.add(SceneBuilder::quadric(QuadricKind::Cylinder, {1, -1, 1, 360}),
          Mat4::translate({0, 0, 5}));
    QuietDiag d;
    const auto world = b.world(d.diag);
    Hit hit;
    hit.shape = 0;
    hit.u = 0.5f; // P = (-1, 0, 5); dPdu = 2 pi (0, -1, 0), dPdv = (0, 0, 2)
    hit.v = 0.5f;
    const auto steps = [&](const V3f& dir, float footprint) {
        const Filled f(*world, {hit}, {{V3f(-1, 0, 5) - dir, dir}}, footprint);
        return std::array<double, 2>{f.at(SL_VAR_du, 0), f.at(SL_VAR_dv, 0)};
    };
    const auto straight = steps({1, 0, 0}, 0.01f);
    EXPECT_NEAR(straight[0], 0.01 / (2 * std::numbers::pi), 1e-9);
    EXPECT_NEAR(straight[1], 0.005, 1e-9);
    const auto slanted = steps({1, 0, 1}, 0.01f); // 45 degrees to dPdv: sqrt(2) further
    EXPECT_NEAR(slanted[0], straight[0], 1e-9);
    EXPECT_NEAR(slanted[1], 0.005 * std::sqrt(2.0), 1e-9);
    const auto grazing = steps({1e-6f, 0, 1}, 0.01f);
    EXPECT_NEAR(grazing[1], 0.005 * 16, 1e-7); // limited
    const auto huge = steps({1, 0, 0}, 1e6f);
    EXPECT_EQ(huge[0], 0.25); // a quarter of a turn
    EXPECT_EQ(huge[1], 1);
    const auto none = steps({1, 0, 0}, 0);
    EXPECT_GT(none[0], 0);
    EXPECT_GT(none[1], 0);
    const auto nan = steps({1, 0, 0}, NAN);
    EXPECT_TRUE(nan[0] > 0 && nan[0] <= 0.25);
    EXPECT_EQ(steps({1, 0, 0}, INFINITY)[0], 0.25);
}

// A polygon far smaller than a pixel still has the pixel's step, so that textures on it are
// filtered.
TEST(Fill, SmallPolygonsKeepTheFootprint) {
    SceneBuilder b;
    b.add(SceneBuilder::polygons({1}, {3}, {0, 1, 2}, {0, 0, 5, 0, 1e-4f, 5, 1e-4f, 0, 5}));
    QuietDiag d;
    const auto world = b.world(d.diag);
    Hit hit;
    hit.shape = 0;
    hit.u = hit.v = 0.3f;
    const Filled f(*world, {hit}, {{{0, 0, 0}, {0, 0, 1}}}, 0.02f);
    EXPECT_FLOAT_EQ(f.at(SL_VAR_du, 0), 0.02f);
    EXPECT_FLOAT_EQ(f.at(SL_VAR_s, 0, 0, 1), 0.02f);
    EXPECT_FLOAT_EQ(f.at(SL_VAR_t, 0, 0, 2), 0.02f);
}

// The auxiliary records against differences of double evaluations, at offsets where float positions
// are useless.
TEST(Fill, AuxiliaryDifferences) {
    std::mt19937 rng(3);
    std::uniform_real_distribution<double> unit(0.05, 0.7);
    double worst_P = 0, worst_N = 0;
    for (const double offset : {0.0, 1e3, 1e6}) {
        for (const rib::Quadric& q : quadrics()) {
            const Mat4 place = random_transform(rng, offset, offset > 10);
            const auto back = base::inverse(place);
            SceneBuilder b;
            b.attributes().texture_coordinates = {0.1f, 0.2f, 3, 0.5f, -1, 2, 7, 9};
            b.add(SceneBuilder::quadric(q.kind, q.args), place);
            QuietDiag d;
            const auto world = b.world(d.diag);
            std::string why;
            const auto s = geo::make_quadric(q, why);
            for (int n = 0; n < 40; ++n) {
                const Aimed a = aim(place, *s, unit(rng), unit(rng), rng);
                const float footprint = n % 2 == 0 ? 1e-4f : 1e-2f;
                const Filled f(*world, {a.hit}, {a.ray}, footprint);
                for (const int which : {1, 2}) {
                    const double du = which == 1 ? f.at(SL_VAR_du, 0) : 0,
                                 dv = which == 2 ? f.at(SL_VAR_dv, 0) : 0;
                    const SurfacePoint p0 = s->evaluate({0, a.hit.u, a.hit.v});
                    const SurfacePoint p1 = s->evaluate({0, a.hit.u + du, a.hit.v + dv});
                    const V3d dP = vector(place, p1.P - p0.P);
                    const double length = base::length(dP);
                    worst_P = std::max(worst_P, error(f.vec(SL_VAR_P, 0, which), dP, length));
                    EXPECT_EQ(f.vec(SL_VAR_I, 0, which), f.vec(SL_VAR_P, 0, which));
                    const V3d dN = normalize(normal_by_inverse(*back, p1.Ng)) -
                                   normalize(normal_by_inverse(*back, p0.Ng));
                    if (base::length(dN) > 1e-8) {
                        worst_N = std::max(worst_N,
                                           error(f.vec(SL_VAR_N, 0, which), dN, base::length(dN)));
                    } else {
                        EXPECT_LT(base::length(f.vec(SL_VAR_N, 0, which)), 1e-7);
                    }
                    EXPECT_EQ(f.at(SL_VAR_u, 0, 0, which), float(du));
                    EXPECT_EQ(f.at(SL_VAR_v, 0, 0, which), float(dv));
                    const auto st = [&](double x, double y, std::size_t k) {
                        const auto& c = b.attributes().texture_coordinates;
                        return (1 - x) * (1 - y) * c[k] + x * (1 - y) * c[2 + k] +
                               (1 - x) * y * c[4 + k] + x * y * c[6 + k];
                    };
                    const double ds = st(a.hit.u + du, a.hit.v + dv, 0) - st(a.hit.u, a.hit.v, 0);
                    EXPECT_NEAR(f.at(SL_VAR_s, 0, 0, which), ds, 1e-6 * std::fabs(ds) + 1e-14);
                }
            }
        }
    }
    // Rounded once to float; the reference cancels to 1e-16 / 1e-4.
    EXPECT_LT(worst_P, 2 * float_ulp);
    EXPECT_LT(worst_N, 2 * float_ulp);
    RecordProperty("worst_dP", std::to_string(worst_P * 1e9) + "e-9");
    RecordProperty("worst_dN", std::to_string(worst_N * 1e9) + "e-9");
}

// Differences of primitive variables against two values, where these differ enough to be
// subtracted.
TEST(Fill, DifferencesOfPrimitiveVariables) {
    const std::vector<float> corners{1, 0, 2, 3, 1, 0, 0, 4, 1, 2, 2, 5};
    SceneBuilder b;
    rib::Primitive p = SceneBuilder::quadric(QuadricKind::Sphere, {1, -1, 1, 360});
    auto& list = p.params.params;
    list.push_back(param("where", StorageClass::Varying, ParamType::Point, corners));
    list.push_back(param("way", StorageClass::Varying, ParamType::Vector, corners));
    list.push_back(param("up", StorageClass::Varying, ParamType::Normal, corners));
    list.push_back(param("tint", StorageClass::Varying, ParamType::Color, corners));
    list.push_back(
        param("pair", StorageClass::Varying, ParamType::Float, {1, 2, 3, 5, 8, 13, 21, 34}, 2));
    list.push_back(param("four", StorageClass::Varying, ParamType::HPoint,
                         {1, 0, 2, 1, 3, 1, 0, 2, 0, 4, 1, 1.5f, 2, 2, 5, 4}));
    list.push_back(param("same", StorageClass::Constant, ParamType::Color, {1, 2, 3}));
    b.add(p, Mat4::translate({0, 0, 5}) * Mat4::rotate(30, {1, 1, 0}) * Mat4::scale({1, 2, 3}));
    QuietDiag d;
    const auto world = b.world(d.diag);
    Hit hit, by_u, by_v;
    hit.shape = 0;
    hit.u = 0.25f, hit.v = 0.5f;
    by_u = by_v = hit;
    by_u.u += 0.125f, by_v.v += 0.25f;
    const float du[8] = {0.125f}, dv[8] = {0.25f};
    for (const char* name : {"where", "way", "up", "tint", "pair", "four", "same"}) {
        float here[3 * 8] = {}, there[2][3 * 8] = {}, change[2][3 * 8] = {};
        world->fill_primitive_variable(std::span(&hit, 1), name, 8, here);
        world->fill_primitive_variable(std::span(&by_u, 1), name, 8, there[0]);
        world->fill_primitive_variable(std::span(&by_v, 1), name, 8, there[1]);
        world->fill_primitive_differences(std::span(&hit, 1), name,
                                          {du, dv, 8, change[0], change[1]});
        for (std::size_t which = 0; which < 2; ++which) {
            for (std::size_t plane = 0; plane < 3; ++plane) { // values up to 34, rounded once
                EXPECT_NEAR(change[which][8 * plane], there[which][8 * plane] - here[8 * plane],
                            4e-6)
                    << name << " " << which << " " << plane;
            }
        }
    }
}

TEST(Fill, OnlyWhatIsAsked) {
    SceneBuilder b;
    b.add(SceneBuilder::quadric(QuadricKind::Sphere, {1, -1, 1, 360}), Mat4::translate({0, 0, 5}));
    b.attributes().color = {0.25f, 0.5f, 0.75f};
    QuietDiag d;
    const auto world = b.world(d.diag);
    const Ray ray{{0.1f, 0, 0}, {0, 0, 1}};
    const Hit hit = trace(*world, ray);
    const std::uint64_t needed = (1u << SL_VAR_Cs) | (1u << SL_VAR_N);
    const Filled f(*world, {hit}, {ray}, 0.01f, needed);
    EXPECT_EQ(f.vec(SL_VAR_Cs, 0), V3d(0.25, 0.5, 0.75));
    for (int v = 0; v < SL_VAR_COUNT; ++v) {
        const bool asked = (needed >> v & 1) != 0;
        EXPECT_EQ(f.at(sl_variable(v), 0) != Filled::unset, asked) << v;
    }
    // NULL planes are skipped whatever the mask says.
    const float zero[1] = {}, one[1] = {1};
    const geo::Incident incident{zero, zero, zero, zero, zero, one, zero};
    const sl_points nothing{};
    world->fill(std::span(&hit, 1), incident, ~std::uint64_t(0), 8, nothing, &nothing, nullptr);
}

// A unit square in the plane z = x/2 of object space, as polygon of given storage for its colours.
rib::Primitive tilted_square(StorageClass storage, std::vector<float> colors) {
    rib::Primitive p =
        SceneBuilder::polygons({1}, {4}, {0, 1, 2, 3}, {0, 0, 0, 0, 1, 0, 1, 1, 0.5f, 1, 0, 0.5f});
    p.params.params.push_back(param("Cs", storage, ParamType::Color, std::move(colors)));
    return p;
}

TEST(Fill, PolygonClasses) {
    const std::vector<float> corners{1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1};
    const struct {
        StorageClass storage;
        std::vector<float> colors;
        V3d expected; // at object (0.25, 0.75): on triangle 0-1-2, weights 0.25, 0.5, 0.25
    } cases[] = {
        {StorageClass::Constant, {0.1f, 0.2f, 0.3f}, {0.1f, 0.2f, 0.3f}},
        {StorageClass::Uniform, {0.4f, 0.5f, 0.6f}, {0.4f, 0.5f, 0.6f}},
        {StorageClass::Varying, corners, {0.25, 0.5, 0.25}},
        {StorageClass::Vertex, corners, {0.25, 0.5, 0.25}},
        {StorageClass::FaceVarying, corners, {0.25, 0.5, 0.25}},
        {StorageClass::FaceVertex, corners, {0.25, 0.5, 0.25}},
    };
    for (const auto& c : cases) {
        SceneBuilder b;
        b.add(tilted_square(c.storage, c.colors), Mat4::translate({0, 0, 5}));
        QuietDiag d;
        const auto world = b.world(d.diag);
        const Ray ray{{0.25f, 0.75f, 0}, {0, 0, 1}};
        const Hit hit = trace(*world, ray);
        ASSERT_TRUE(hit.valid());
        const Filled f(*world, {hit}, {ray});
        EXPECT_LT(error(f.vec(SL_VAR_Cs, 0), c.expected, 1), 1e-6);
        EXPECT_LT(error(f.vec(SL_VAR_P, 0), {0.25, 0.75, 5.125}, 1), 1e-6);
        // Polygons: u = s = x, v = t = y of object space (ri.md 11.1).
        for (const sl_variable x : {SL_VAR_u, SL_VAR_s}) {
            EXPECT_NEAR(f.at(x, 0), 0.25, 1e-6);
        }
        for (const sl_variable y : {SL_VAR_v, SL_VAR_t}) {
            EXPECT_NEAR(f.at(y, 0), 0.75, 1e-6);
        }
        EXPECT_LT(error(f.vec(SL_VAR_dPdu, 0), {1, 0, 0.5}, 1), 1e-6);
        EXPECT_LT(error(f.vec(SL_VAR_dPdv, 0), {0, 1, 0}, 1), 1e-6);
        // Vertices (0,0) (0,1) (1,1) run clockwise for a viewer at -z of a left-handed system: it
        // faces him.
        EXPECT_LT(error(f.vec(SL_VAR_Ng, 0), normalize(V3d(0.5, 0, -1)), 1), 1e-6);
        EXPECT_EQ(d.diag.messages().size(), 0u);
    }
}

TEST(Fill, PolygonDifferencesAreLinear) {
    std::mt19937 rng(4);
    for (const double offset : {0.0, 1e6}) {
        SceneBuilder b;
        rib::Primitive p =
            tilted_square(StorageClass::Vertex, {1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1});
        p.params.params.push_back(param("st", StorageClass::FaceVarying, ParamType::Float,
                                        {0, 0, 0, 10, 10, 10, 10, 0}, 2));
        p.params.params.push_back(param("N", StorageClass::Varying, ParamType::Normal,
                                        {0, 0, -1, 0, 1, -1, 1, 0, -1, 0, 0, -2}));
        const Mat4 place = Mat4::translate({0, 0, 5 + offset}) * Mat4::rotate(30, {1, 1, 0});
        const auto back = *base::inverse(place);
        b.add(p, place);
        QuietDiag d;
        const auto world = b.world(d.diag);
        Hit hit;
        hit.shape = 0;
        hit.u = 0.5f; // weights 0.25, 0.5, 0.25 of triangle 0-1-2
        hit.v = 0.25f;
        const Ray ray{V3f(point(place, {0.25, 0.75, 0.125})) - V3f(0, 0, 3), {0, 0, 1}};
        const Filled f(*world, {hit}, {ray}, 1e-3f);
        const double du = f.at(SL_VAR_du, 0), dv = f.at(SL_VAR_dv, 0);
        // On that triangle b0 = 1 - y, b1 = y - x, b2 = x.
        EXPECT_LT(error(f.vec(SL_VAR_P, 0, 1), vector(place, V3d(1, 0, 0.5) * du), du), 2e-7);
        EXPECT_LT(error(f.vec(SL_VAR_P, 0, 2), vector(place, V3d(0, 1, 0) * dv), dv), 2e-7);
        EXPECT_LT(error(f.vec(SL_VAR_Cs, 0, 1), V3d(0, -1, 1) * du, du), 2e-7);
        EXPECT_LT(error(f.vec(SL_VAR_Cs, 0, 2), V3d(-1, 1, 0) * dv, dv), 2e-7);
        EXPECT_NEAR(f.at(SL_VAR_s, 0, 0, 1), 10 * du, 1e-6 * du);
        EXPECT_NEAR(f.at(SL_VAR_t, 0, 0, 1), 0, 1e-6 * du);
        EXPECT_NEAR(f.at(SL_VAR_t, 0, 0, 2), 10 * dv, 2e-6 * dv);
        const V3d dN = V3d(1, 0, -1) - V3d(0, 1, -1);
        EXPECT_LT(error(f.vec(SL_VAR_N, 0, 1), normal_by_inverse(back, dN) * du, du), 1e-6);
        EXPECT_EQ(f.vec(SL_VAR_Ng, 0, 1), V3d());
    }
}

TEST(Fill, UprightPolygonsHaveUsableDerivatives) {
    const std::vector<std::vector<float>> walls{
        {0, 0, 0, 0, 0, 1, 1, 0, 1, 1, 0, 0},   // y = 0
        {0, 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1},   // x = 0
        {0, 0, 0, 1, 1, 0, 1, 1, 1, 0, 0, 1},   // x = y
        {0, 0, 0, -1, 1, 0, -1, 1, 1, 0, 0, 1}, // x = -y
    };
    for (const auto& wall : walls) {
        SceneBuilder b;
        b.add(SceneBuilder::polygons({1}, {4}, {0, 1, 2, 3}, wall));
        QuietDiag d;
        const auto world = b.world(d.diag);
        Hit hit;
        hit.shape = 0;
        hit.u = hit.v = 0.25f;
        const Filled f(*world, {hit}, {{{3, -4, 5}, {-1, 1, -1}}});
        const V3d dPdu = f.vec(SL_VAR_dPdu, 0), dPdv = f.vec(SL_VAR_dPdv, 0),
                  Ng = f.vec(SL_VAR_Ng, 0);
        EXPECT_GT(base::length(cross(dPdu, dPdv)), 0.5);
        EXPECT_NEAR(dot(dPdu, Ng), 0, 1e-6);
        EXPECT_NEAR(dot(dPdv, Ng), 0, 1e-6);
        EXPECT_GT(dot(cross(dPdu, dPdv), Ng), 0);
    }
}

TEST(Fill, NormalsAsGiven) {
    SceneBuilder b;
    b.attributes().orientation_matches = false;
    rib::Primitive p = tilted_square(StorageClass::Constant, {1, 1, 1});
    p.params.params.push_back(param("N", StorageClass::Vertex, ParamType::Normal,
                                    {0, 0, -3, 0, 0, -3, 0, 0, -3, 0, 0, -3}));
    const Mat4 place = Mat4::translate({0, 0, 5}) * Mat4::scale({2, 1, -1});
    b.add(p, place);
    QuietDiag d;
    const auto world = b.world(d.diag);
    Hit hit;
    hit.shape = 0;
    hit.u = hit.v = 0.25f;
    const Filled f(*world, {hit}, {{{0.2f, 0.5f, 0}, {0, 0, 1}}});
    // Inverse transpose of the mirror, neither normalised nor flipped by Orientation "inside".
    EXPECT_LT(error(f.vec(SL_VAR_N, 0), {0, 0, 3}, 1), 1e-6);
    EXPECT_NEAR(base::length(f.vec(SL_VAR_Ng, 0)), 1, 1e-6);
    EXPECT_LT(f.vec(SL_VAR_Ng, 0).z, 0);
}

TEST(Fill, QuadricVariablesAreBilinear) {
    SceneBuilder b;
    rib::Primitive p = SceneBuilder::quadric(QuadricKind::Disk, {0, 1, 360});
    p.params.params.push_back(
        param("Cs", StorageClass::Varying, ParamType::Color, {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 4}));
    p.params.params.push_back(param("s", StorageClass::Varying, ParamType::Float, {0, 2, 4, 6}));
    p.params.params.push_back(
        param("st", StorageClass::Varying, ParamType::Float, {9, 1, 9, 1, 9, 5, 9, 5}, 2));
    b.add(p, Mat4::translate({0, 0, 5}));
    QuietDiag d;
    const auto world = b.world(d.diag);
    Hit hit;
    hit.shape = 0;
    hit.u = 0.25f;
    hit.v = 0.5f;
    const Filled f(*world, {hit}, {{{0, 0.5f, 0}, {0, 0, 1}}});
    EXPECT_LT(error(f.vec(SL_VAR_Cs, 0), {0.25, 0.5, 0.5}, 1), 1e-7);
    EXPECT_FLOAT_EQ(f.at(SL_VAR_s, 0), 2.5f); // "s" beats "st"
    EXPECT_FLOAT_EQ(f.at(SL_VAR_t, 0), 3);
    EXPECT_FLOAT_EQ(f.at(SL_VAR_s, 0, 0, 1), 2 * f.at(SL_VAR_du, 0));
    EXPECT_FLOAT_EQ(f.at(SL_VAR_t, 0, 0, 2), 4 * f.at(SL_VAR_dv, 0));
}

TEST(Fill, ShaderParametersFromThePrimitive) {
    SceneBuilder b;
    rib::Primitive p = SceneBuilder::quadric(QuadricKind::Disk, {0, 1, 360});
    auto& list = p.params.params;
    list.push_back(param("where", StorageClass::Constant, ParamType::Point, {1, 2, 3}));
    list.push_back(param("way", StorageClass::Uniform, ParamType::Vector, {1, 2, 3}));
    list.push_back(param("up", StorageClass::Uniform, ParamType::Normal, {0, 2, 0}));
    list.push_back(param("h", StorageClass::Uniform, ParamType::HPoint, {2, 4, 6, 2}));
    list.push_back(param("Kd", StorageClass::Varying, ParamType::Float, {0, 1, 0, 1}));
    list.push_back(param("pair", StorageClass::Constant, ParamType::Color, {1, 2, 3, 4, 5, 6}, 2));
    list.push_back(param("short", StorageClass::Varying, ParamType::Float, {0, 1}));
    rib::Param text;
    text.name = "name";
    text.decl.type = ParamType::String;
    text.strings = {"x"};
    list.push_back(text);
    b.add(p, Mat4::translate({0, 0, 5}) * Mat4::scale({1, 2, 1}));
    QuietDiag d;
    const auto world = b.world(d.diag);
    Hit hit;
    hit.shape = 0;
    hit.u = 0.25f;
    hit.v = 0.5f;
    const std::vector<Hit> hits{hit, hit};
    const auto values = [&](const char* name) {
        std::vector<float> out(6 * 8, 0);
        world->fill_primitive_variable(hits, name, 8, out.data());
        std::vector<float> second;
        for (std::size_t plane = 0; plane < 6; ++plane) {
            second.push_back(out[8 * plane + 1]);
        }
        return second;
    };
    EXPECT_EQ(values("where"), (std::vector<float>{1, 4, 8, 0, 0, 0}));
    EXPECT_EQ(values("way"), (std::vector<float>{1, 4, 3, 0, 0, 0}));
    EXPECT_EQ(values("up"), (std::vector<float>{0, 1, 0, 0, 0, 0}));
    EXPECT_EQ(values("h"), (std::vector<float>{1, 4, 8, 0, 0, 0}));
    EXPECT_EQ(values("Kd"), (std::vector<float>{0.25f, 0, 0, 0, 0, 0}));
    EXPECT_EQ(values("pair"), (std::vector<float>{1, 2, 3, 4, 5, 6}));
    EXPECT_EQ(world->primitive_variable(hit, "short"), nullptr);
    EXPECT_EQ(world->primitive_variable(hit, "absent"), nullptr);
    ASSERT_NE(world->primitive_variable(hit, "name"), nullptr);
    EXPECT_EQ(world->primitive_variable(hit, "name")->strings.front(), "x");
}

} // namespace
