// SPDX-License-Identifier: Apache-2.0
// Polygons through a whole World: coverage by the even-odd rule, mapping from triangles back to
// polygons and their variables, normals by Newell, closed meshes of mixed polygons, and what is
// left out.
#include "geometry/polygon.h"
#include "geometry/test_scene.h"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <random>

namespace {

using namespace geo::test;
using geo::Hit;
using geo::PolygonFaults;
using rib::ParamType;
using rib::StorageClass;

struct Loops {
    std::vector<std::int32_t> sizes;
    std::vector<float> xy;

    void add(std::mt19937& rng, double cx, double cy, double inner, double outer, int n, bool ccw) {
        std::uniform_real_distribution<double> radius(inner, outer);
        for (int i = 0; i < n; ++i) {
            const double a = 2 * std::numbers::pi * (ccw ? i : n - i) / n, r = radius(rng);
            xy.push_back(float(cx + r * std::cos(a)));
            xy.push_back(float(cy + r * std::sin(a)));
        }
        sizes.push_back(n);
    }
    [[nodiscard]] bool inside(double x, double y) const {
        bool odd = false;
        std::size_t first = 0;
        for (const std::int32_t size : sizes) {
            const auto n = std::size_t(size);
            for (std::size_t i = 0; i < n; ++i) {
                const float *a = &xy[2 * (first + i)], *b = &xy[2 * (first + (i + 1) % n)];
                odd ^= (a[1] > y) != (b[1] > y) &&
                       x < a[0] + (y - a[1]) * (double(b[0]) - a[0]) / (double(b[1]) - a[1]);
            }
            first += n;
        }
        return odd;
    }
    [[nodiscard]] rib::Primitive primitive() const {
        std::vector<float> xyz;
        std::vector<std::int32_t> index;
        for (std::size_t i = 0; i < xy.size() / 2; ++i) {
            xyz.insert(xyz.end(), {xy[2 * i], xy[2 * i + 1], 0});
            index.push_back(std::int32_t(i));
        }
        return SceneBuilder::polygons({std::int32_t(sizes.size())}, sizes, index, xyz);
    }
};

TEST(Polygon, ConcaveWithHolesCoversByTheEvenOddRule) {
    std::mt19937 rng(1);
    for (int k = 0; k < 10; ++k) {
        Loops loops;
        loops.add(rng, 0, 0, 2, 3, 25, k % 2 == 0);
        loops.add(rng, 0.8, 0, 0.2, 0.6, 11, k % 3 == 0);
        loops.add(rng, -0.8, 0.3, 0.3, 0.7, 8, k % 5 == 0);
        loops.add(rng, -0.8, 0.3, 0.1, 0.2, 5, true); // island
        SceneBuilder b;
        b.add(loops.primitive(), Mat4::translate({0, 0, 10}));
        QuietDiag d;
        const auto world = b.world(d.diag);
        std::uniform_real_distribution<float> in(-3, 3);
        for (int n = 0; n < 4000; ++n) {
            const float x = in(rng), y = in(rng);
            ASSERT_EQ(trace(*world, {{x, y, 0}, {0, 0, 1}}).valid(), loops.inside(x, y))
                << x << " " << y;
        }
        EXPECT_EQ(d.diag.messages().size(), 0u);
    }
}

// Triangles, quads, a concave pentagon and a hexagon with a hole in one request: every place knows
// its polygon.
TEST(Polygon, MixedMeshKeepsFacesAndCorners) {
    SceneBuilder b;
    rib::Primitive p =
        SceneBuilder::polygons({1, 1, 1, 2}, {3, 4, 5, 4, 3},
                               {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18},
                               {0,  0, 0, 1,  0, 0, 0,  1, 0,             // triangle at x = 0
                                2,  0, 0, 3,  0, 0, 3,  1, 0, 2, 1,    0, // quad at 2
                                4,  0, 0, 6,  0, 0, 6,  2, 0, 5, 0.5f, 0, 4, 2, 0, // concave at 4
                                8,  0, 0, 12, 0, 0, 12, 4, 0, 8, 4,    0, 9, 1, 0,
                                11, 1, 0, 10, 3, 0}); // square with a hole at 8
    std::vector<float> uniform{0, 1, 2, 3}, corner;
    for (int i = 0; i < 19; ++i) {
        corner.push_back(float(i));
    }
    p.params.params.push_back(param("face", StorageClass::Uniform, ParamType::Float, uniform));
    p.params.params.push_back(param("corner", StorageClass::FaceVarying, ParamType::Float, corner));
    p.params.params.push_back(param("vertex", StorageClass::Vertex, ParamType::Float, corner));
    b.add(p, Mat4::translate({0, 0, 5}));
    QuietDiag d;
    const auto world = b.world(d.diag);
    const struct {
        float x, y, face;
    } places[] = {{0.2f, 0.2f, 0}, {2.3f, 0.8f, 1}, {2.8f, 0.2f, 1}, {4.1f, 1.5f, 2},
                  {5.9f, 1.5f, 2}, {5, 0.3f, 2},    {8.2f, 0.2f, 3}, {11.5f, 3.5f, 3}};
    for (const auto& place : places) {
        const Hit hit = trace(*world, {{place.x, place.y, 0}, {0, 0, 1}});
        ASSERT_TRUE(hit.valid());
        float face = -1, by_corner = -1, by_vertex = -2;
        world->fill_primitive_variable(std::span(&hit, 1), "face", 8, &face);
        world->fill_primitive_variable(std::span(&hit, 1), "corner", 8, &by_corner);
        world->fill_primitive_variable(std::span(&hit, 1), "vertex", 8, &by_vertex);
        EXPECT_EQ(face, place.face);
        EXPECT_EQ(by_corner, by_vertex); // the indices run through
    }
    EXPECT_FALSE(trace(*world, {{5, 1.5f, 0}, {0, 0, 1}}).valid());
    EXPECT_FALSE(trace(*world, {{10, 1.5f, 0}, {0, 0, 1}}).valid());
    EXPECT_EQ(world->stats().triangles, 1u + 2 + 3 + 7);
}

// A box of quads with one side of six corners and a top of two pieces, one concave: no ray from
// inside gets out.
TEST(Polygon, ClosedMixedMeshIsWatertight) {
    SceneBuilder b;
    // Bottom quad, four side quads, and a top cut into a concave hexagon and the quad that fills
    // its notch.
    const rib::Primitive q = SceneBuilder::polygons(
        {1, 1, 1, 1, 1, 1, 1}, {4, 4, 4, 4, 6, 4, 8},
        {0, 1, 2,  3,               // bottom
         0, 4, 5,  1,               // y = -1
         1, 5, 6,  2,               // x = 1
         2, 6, 7,  3,               // y = 1
         3, 7, 9,  8,  4, 0,        // x = -1, with two straight corners
         8, 9, 10, 11,              // the notch's filling
         4, 8, 11, 10, 9, 7, 6, 5}, // the rest of the top, concave
        {-1, -1, -1, 1,  -1, -1, 1,  1,     -1, -1, 1,    -1, -1,   -1,   1, 1,    -1,    1,
         1,  1,  1,  -1, 1,  1,  -1, -0.5f, 1,  -1, 0.5f, 1,  0.3f, 0.5f, 1, 0.3f, -0.5f, 1});
    b.add(q, Mat4::translate({3, 4, 50}) * Mat4::rotate(40, {1, 2, 0.5}));
    QuietDiag d;
    const auto world = b.world(d.diag);
    EXPECT_EQ(d.diag.messages().size(), 0u);
    std::mt19937 rng(3);
    std::normal_distribution<float> g(0, 1);
    for (int n = 0; n < 100000; ++n) {
        const V3f dir(g(rng), g(rng), g(rng));
        ASSERT_TRUE(trace(*world, {{3.1f, 4.05f, 49.9f}, dir}).valid());
    }
}

TEST(Polygon, NewellNormalOfSlightlyBentPolygon) {
    // A quad with one corner lifted: the normal is that of the diagonals' cross product, on both
    // triangles.
    SceneBuilder b;
    b.add(SceneBuilder::polygons({1}, {4}, {0, 1, 2, 3}, {0, 0, 0, 0, 1, 0, 1, 1, 0.1f, 1, 0, 0}));
    QuietDiag d;
    const auto world = b.world(d.diag);
    const V3d expected = normalize(cross(V3d(1, 1, 0.1f), V3d(1, -1, 0)));
    for (std::uint32_t part = 0; part < 2; ++part) {
        Hit hit;
        hit.shape = 0;
        hit.part = part;
        hit.u = hit.v = 0.3f;
        const Filled f(*world, {hit}, {{{0.5f, 0.5f, -1}, {0, 0, 1}}});
        EXPECT_LT(base::length(f.vec(SL_VAR_Ng, 0) - expected), 1e-6);
    }
}

TEST(Polygon, HomogeneousPositions) {
    rib::Primitive p = SceneBuilder::polygons({1}, {3}, {0, 1, 2}, {});
    p.params.params.front() = param("Pw", StorageClass::Vertex, ParamType::HPoint,
                                    {0, 0, 10, 2, 2, 0, 10, 2, 0, 2, 10, 2});
    SceneBuilder b;
    b.add(p);
    QuietDiag d;
    const auto world = b.world(d.diag);
    EXPECT_NEAR(trace(*world, {{0.3f, 0.3f, 0}, {0, 0, 1}}).t, 5, 1e-6);
}

TEST(Polygon, FaultsAreCounted) {
    const auto faults_of = [](const rib::Primitive& p) {
        PolygonFaults faults;
        (void)geo::make_polygons(std::get<rib::Polygons>(p.shape), p.params, faults);
        return faults;
    };
    const std::vector<float> xyz{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, NAN, 0, 0};
    EXPECT_EQ(faults_of(SceneBuilder::polygons({1, 1}, {3, 3}, {0, 1, 2, 0, 1, 9}, xyz)).bad_index,
              1u);
    EXPECT_EQ(faults_of(SceneBuilder::polygons({1, 1}, {3, 3}, {0, 1, 2, 0, 1, 4}, xyz)).not_finite,
              1u);
    EXPECT_EQ(
        faults_of(SceneBuilder::polygons({1, 1}, {3, 4}, {0, 1, 1, 0, 1, 2, 3}, xyz)).degenerate,
        1u);
    EXPECT_EQ(faults_of(SceneBuilder::polygons({1, 1}, {3, 3}, {0, 1, 1, 0, 1, 2}, xyz)).degenerate,
              1u);
    EXPECT_TRUE(faults_of(SceneBuilder::polygons({1}, {3}, {0, 1, 2}, {})).no_positions);
}

} // namespace
