// SPDX-License-Identifier: Apache-2.0
// Ray queries of a whole World: which place is hit, which rays see what, and where new rays may
// start.
#include "geometry/test_scene.h"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <random>

namespace {

using namespace geo::test;
using geo::Hit;
using geo::RayPacket;
using geo::World;
using rib::QuadricKind;

constexpr QuadricKind sphere_kind = QuadricKind::Sphere;

rib::Primitive unit_sphere() {
    return SceneBuilder::quadric(sphere_kind, {1, -1, 1, 360});
}

// A closed sphere of triangles: 2 * n * (n - 1) of them.
rib::Primitive triangle_sphere(int n, double radius) {
    std::vector<float> xyz;
    std::vector<std::int32_t> index;
    const auto put = [&](double theta, double phi) {
        xyz.push_back(float(radius * std::cos(theta) * std::cos(phi)));
        xyz.push_back(float(radius * std::sin(theta) * std::cos(phi)));
        xyz.push_back(float(radius * std::sin(phi)));
    };
    put(0, -std::numbers::pi / 2);
    put(0, std::numbers::pi / 2);
    for (int j = 1; j < n; ++j) {
        for (int i = 0; i < n; ++i) {
            put(2 * std::numbers::pi * i / n, std::numbers::pi * (double(j) / n - 0.5));
        }
    }
    const auto at = [n](int i, int j) { return 2 + (j - 1) * n + i % n; };
    for (int i = 0; i < n; ++i) {
        index.insert(index.end(), {0, at(i + 1, 1), at(i, 1)});
        index.insert(index.end(), {1, at(i, n - 1), at(i + 1, n - 1)});
        for (int j = 1; j + 1 < n; ++j) {
            index.insert(index.end(), {at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            index.insert(index.end(), {at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    }
    const std::size_t count = index.size() / 3;
    return SceneBuilder::polygons(std::vector<std::int32_t>(count, 1),
                                  std::vector<std::int32_t>(count, 3), index, xyz);
}

rib::Primitive square(float half, float z) {
    return SceneBuilder::polygons({1}, {4}, {0, 1, 2, 3},
                                  {-half, -half, z, -half, half, z, half, half, z, half, -half, z});
}

V3f random_direction(std::mt19937& rng) {
    std::normal_distribution<float> n(0, 1);
    const V3f d(n(rng), n(rng), n(rng));
    return base::length(d) > 0.1f ? normalize(d) : V3f(1, 0, 0);
}

Mat4 random_transform(std::mt19937& rng, double offset, bool mirrored) {
    std::uniform_real_distribution<double> in(-1, 1), size(0.5, 2);
    const V3d axis(in(rng), in(rng), in(rng));
    const Mat4 m = Mat4::translate(V3d(in(rng), in(rng), 1.5) * offset) *
                   Mat4::rotate(180 * in(rng), axis) *
                   Mat4::scale({size(rng), size(rng), (mirrored ? -1 : 1) * size(rng)}) *
                   Mat4::rotate(180 * in(rng), V3d(axis.z, axis.x, 0.3));
    return m;
}

TEST(World, SphereAndSquareAreHitWhereTheyAre) {
    SceneBuilder b;
    b.add(unit_sphere(), Mat4::translate({0, 0, 5}));
    b.add(square(10, 8));
    QuietDiag d;
    const auto world = b.world(d.diag);
    const Hit on_sphere = trace(*world, {{0.5f, 0, 0}, {0, 0, 1}});
    ASSERT_TRUE(on_sphere.valid());
    EXPECT_NEAR(on_sphere.t, 5 - std::sqrt(0.75), 1e-6);
    const Hit on_square = trace(*world, {{3, 0, 0}, {0, 0, 2}});
    ASSERT_TRUE(on_square.valid());
    EXPECT_NEAR(on_square.t, 4, 1e-6);
    EXPECT_FALSE(trace(*world, {{30, 0, 0}, {0, 0, 1}}).valid());
    EXPECT_FALSE(trace(*world, {{0, 0, 0}, {0, 0, 1}, 0, 3.9f}).valid());
    EXPECT_NEAR(trace(*world, {{0, 0, 0}, {0, 0, 1}, 4.5f}).t, 6, 1e-6);
    EXPECT_TRUE(occluded(*world, {{0, 0, 0}, {0, 0, 1}}));
    EXPECT_FALSE(occluded(*world, {{0, 0, 0}, {0, 0, 1}, 0, 3.9f}));
    EXPECT_EQ(world->binding(on_sphere).primitive, 0u);
    EXPECT_EQ(world->binding(on_square).primitive, 1u);
    EXPECT_NE(world->binding(on_sphere).transform_key, world->binding(on_square).transform_key);
    EXPECT_EQ(d.diag.messages().size(), 0u);
}

TEST(World, RaysThatAreNotFiniteMiss) {
    SceneBuilder b;
    b.add(unit_sphere());
    b.add(square(1, 2));
    QuietDiag d;
    const auto world = b.world(d.diag);
    const float bad[] = {NAN, INFINITY, -INFINITY, 3e38f};
    for (const float x : bad) {
        EXPECT_FALSE(trace(*world, {{x, 0, 0}, {0, 0, 1}}).valid());
        EXPECT_FALSE(trace(*world, {{0, 0, -5}, {0, x, 1}}).valid());
    }
    EXPECT_FALSE(trace(*world, {{0, 0, -5}, {0, 0, 0}}).valid());
    EXPECT_FALSE(trace(*world, {{0, 0, -5}, {0, 0, 1}, NAN}).valid());
    EXPECT_FALSE(trace(*world, {{0, 0, -5}, {0, 0, 1}, 0, NAN}).valid());
    EXPECT_FALSE(trace(*world, {{0, 0, -5}, {0, 0, 1}, 9, 3}).valid());
    EXPECT_TRUE(trace(*world, {{0, 0, -5}, {0, 0, 1}, 0, 1e38f}).valid());
    EXPECT_FALSE(occluded(*world, {{NAN, 0, -5}, {0, 0, 1}}));
}

TEST(World, SidesAndOrientation) {
    for (const bool mirrored : {false, true}) {
        for (const bool matches : {true, false}) {
            for (const bool ball : {true, false}) {
                SceneBuilder b;
                b.attributes().sides = 1;
                b.attributes().orientation_matches = matches;
                const Mat4 flip = Mat4::scale({1, 1, mirrored ? -1.0 : 1.0});
                b.add(ball ? unit_sphere() : triangle_sphere(16, 1),
                      Mat4::translate({0, 0, 5}) * flip);
                QuietDiag d;
                const auto world = b.world(d.diag);
                const Hit hit = trace(*world, {{0.11f, 0.07f, 0}, {0, 0, 1}});
                ASSERT_TRUE(hit.valid());
                // The outside is seen from outside whatever the transform; the inside when
                // orientation is reversed.
                EXPECT_NEAR(hit.t, matches ? 4 : 6, 0.1) << mirrored << matches << ball;
                EXPECT_TRUE(occluded(*world, {{0.11f, 0.07f, 0}, {0, 0, 1}, 0, 4.5f}));
            }
        }
    }
}

rib::Param int_attribute(const char* name, int value) {
    rib::Param p;
    p.name = name;
    p.decl.type = rib::ParamType::Integer;
    p.ints = {value};
    return p;
}

TEST(World, VisibilityBits) {
    for (int bits = 0; bits < 8; ++bits) {
        for (int form = 0; form < 3; ++form) { // analytic, triangles, instance
            SceneBuilder b;
            b.attributes().user.edit()["render:visibility"] = int_attribute("visibility", bits);
            if (form == 2) {
                rib::Object object;
                object.primitives.edit().push_back(unit_sphere());
                b.scene.objects.push_back(object);
                rib::Instance instance;
                instance.attributes = {0};
                b.scene.instances.push_back(instance);
            } else {
                b.add(form == 0 ? unit_sphere() : triangle_sphere(16, 1));
            }
            QuietDiag d;
            const auto world = b.world(d.diag);
            const Ray ray{{0.1f, 0.2f, -5}, {0, 0, 1}};
            Ray reflected = ray;
            reflected.mask = geo::ReflectionRay;
            EXPECT_EQ(trace(*world, ray).valid(), (bits & 1) != 0);
            EXPECT_EQ(trace(*world, reflected).valid(), (bits & 2) != 0);
            EXPECT_EQ(occluded(*world, ray), (bits & 4) != 0);
        }
    }
}

TEST(World, CastsNoShadowsWhenTold) {
    SceneBuilder b;
    rib::Param p;
    p.decl.type = rib::ParamType::String;
    p.strings = {"none"};
    b.attributes().user.edit()["render:casts_shadows"] = p;
    b.add(unit_sphere());
    QuietDiag d;
    const auto world = b.world(d.diag);
    const Ray ray{{0.1f, 0.2f, -5}, {0, 0, 1}};
    EXPECT_TRUE(trace(*world, ray).valid());
    EXPECT_FALSE(occluded(*world, ray));
}

TEST(World, ClosedMeshIsWatertight) {
    SceneBuilder b;
    const V3d centre(100, 200, 300);
    b.add(triangle_sphere(64, 1), Mat4::translate(centre) * Mat4::rotate(33, {1, 2, 3}));
    QuietDiag d;
    const auto world = b.world(d.diag);
    std::mt19937 rng(1);
    std::uniform_real_distribution<float> in(-0.3f, 0.3f);
    for (int n = 0; n < 25000; ++n) {
        RayPacket p{};
        Hit hits[8];
        for (int i = 0; i < 8; ++i) {
            set_ray(p, i, {V3f(centre) + V3f(in(rng), in(rng), in(rng)), random_direction(rng)});
        }
        world->intersect(p, hits);
        for (const Hit& hit : hits) {
            ASSERT_TRUE(hit.valid());
        }
    }
}

// Pieces of a sphere, cut by sweep and by z, fit together; so do the seam and the poles of a whole
// one.
TEST(World, SeamsAndJointsAreTight) {
    SceneBuilder whole, pieces;
    const Mat4 place = Mat4::translate({20, -30, 40}) * Mat4::rotate(25, {1, 1, 0});
    whole.add(unit_sphere(), place);
    const double cuts[] = {-1, -0.4, 0.3, 1};
    for (int j = 0; j < 3; ++j) {
        for (const double start : {0.0, 120.0, 190.0}) {
            const double sweep = start == 0 ? 120 : start == 120 ? 70 : 170;
            pieces.add(SceneBuilder::quadric(sphere_kind, {1, cuts[j], cuts[j + 1], sweep}),
                       place * Mat4::rotate(start, {0, 0, 1}));
        }
    }
    QuietDiag d;
    std::mt19937 rng(6);
    const auto a = whole.world(d.diag), b = pieces.world(d.diag);
    for (int n = 0; n < 20000; ++n) {
        V3d aim(random_direction(rng));
        if (n % 2 == 0) { // at a cut
            const double angle = (n % 3 == 0 ? 0 : n % 3 == 1 ? 120 : 190) * std::numbers::pi / 180;
            const double rho = std::hypot(aim.x, aim.y);
            aim = n % 4 == 0 ? V3d(rho * std::cos(angle), rho * std::sin(angle), aim.z)
                             : V3d(aim.x, aim.y, 0) / rho * std::sqrt(1 - 0.09) + V3d(0, 0, 0.3);
        }
        const Ray ray{{20, -30, 40}, V3f(vector(place, aim))};
        const Hit ha = trace(*a, ray), hb = trace(*b, ray);
        ASSERT_TRUE(ha.valid() && hb.valid()) << n;
        ASSERT_NEAR(ha.t, hb.t, 1e-6);
    }
    const Hit pole = trace(*a, {{20, -30, 40}, V3f(vector(place, V3d(0, 0, 1)))});
    EXPECT_TRUE(pole.valid());
}

// Packets full or with one ray, alone or in spans: the same place. Bits may differ, as Embree
// changes its code path with the number of active rays.
TEST(World, OneRayOrEight) {
    SceneBuilder b;
    b.add(triangle_sphere(40, 1), Mat4::translate({0, 0, 4}));
    b.add(SceneBuilder::quadric(QuadricKind::Torus, {1.5, 0.3, 0, 360, 360}),
          Mat4::translate({0.2, 0, 4}) * Mat4::rotate(70, {1, 0, 0}));
    QuietDiag d;
    const auto world = b.world(d.diag);
    std::mt19937 rng(2);
    std::uniform_real_distribution<float> in(-0.5f, 0.5f);
    std::vector<RayPacket> packets(500, RayPacket{});
    for (RayPacket& p : packets) {
        for (int i = 0; i < 8; ++i) {
            set_ray(p, i, {{0, 0, 0}, {in(rng), in(rng), 1}});
        }
    }
    std::vector<Hit> together(packets.size() * 8);
    world->intersect(std::span<const RayPacket>(packets), together.data());
    int different_bits = 0;
    for (std::size_t k = 0; k < packets.size(); ++k) {
        Hit packet[8];
        world->intersect(packets[k], packet);
        for (int i = 0; i < 8; ++i) {
            RayPacket one = packets[k];
            one.active = 1u << i;
            Hit alone[8];
            world->intersect(one, alone);
            for (int j = 0; j < 8; ++j) {
                EXPECT_TRUE(j == i || !alone[j].valid());
            }
            for (const Hit& other : {packet[i], together[8 * k + std::size_t(i)]}) {
                ASSERT_EQ(alone[i].shape, other.shape);
                ASSERT_EQ(alone[i].part, other.part);
                ASSERT_NEAR(alone[i].u, other.u, 2e-5);
                ASSERT_NEAR(alone[i].v, other.v, 2e-5);
                ASSERT_NEAR(alone[i].t, other.t, 2e-6);
                different_bits +=
                    alone[i].u != other.u || alone[i].v != other.v || alone[i].t != other.t;
            }
        }
    }
    RecordProperty("hits_with_different_bits", different_bits);
}

TEST(World, ManySmallPolygonsKeepTheirNames) {
    SceneBuilder b;
    b.scene.attributes.push_back(b.scene.attributes.front());
    b.scene.attributes[1].sides = 1;
    for (int i = 0; i < 3000; ++i) {
        rib::Primitive& p = b.add(SceneBuilder::polygons({1}, {5}, {0, 1, 2, 3, 4},
                                                         {-0.4f, -0.4f, 0, -0.4f, 0.4f, 0, 0, 0.45f,
                                                          0, 0.4f, 0.4f, 0, 0.4f, -0.4f, 0}),
                                  Mat4::translate({double(i % 60), double(i / 60), 10}));
        p.attributes = i % 3 == 0 ? 1 : 0;
    }
    QuietDiag d;
    const auto world = b.world(d.diag);
    for (int i = 0; i < 3000; ++i) {
        const Hit hit = trace(*world, {{float(i % 60) + 0.1f, float(i / 60) + 0.2f, 0}, {0, 0, 1}});
        ASSERT_TRUE(hit.valid());
        EXPECT_EQ(world->binding(hit).primitive, std::uint32_t(i));
        EXPECT_EQ(world->binding(hit).attributes, i % 3 == 0 ? 1u : 0u);
        EXPECT_LT(hit.part, 3u);
    }
    EXPECT_EQ(world->stats().triangles, 9000u);
}

TEST(World, InstancesAreCopies) {
    std::mt19937 rng(3);
    SceneBuilder copies, instanced;
    rib::Object object;
    std::vector<Mat4> inner, outer;
    const rib::Primitive members[] = {unit_sphere(), triangle_sphere(12, 0.8),
                                      SceneBuilder::quadric(QuadricKind::Cone, {2, 1, 270})};
    for (const rib::Primitive& m : members) {
        rib::Primitive p = m;
        inner.push_back(Mat4::translate({500, 10, 0}) * random_transform(rng, 2, false));
        p.world_from_object = instanced.transform(inner.back());
        object.primitives.edit().push_back(p);
    }
    instanced.scene.objects.push_back(object);
    for (int k = 0; k < 6; ++k) {
        const Mat4 place = Mat4::translate({-500.0 + 4 * (k % 3), -10.0 + 4 * (k / 3), 20}) *
                           Mat4::scale({1, 1, k % 2 == 0 ? 1.0 : -1.0});
        rib::Instance instance;
        instance.object = 0;
        instance.world_from_object = instanced.transform(place);
        instance.attributes = {0, 0, 0};
        instanced.scene.instances.push_back(instance);
        for (std::size_t m = 0; m < 3; ++m) {
            copies.add(members[m], place * inner[m]);
        }
    }
    QuietDiag d;
    const auto a = copies.world(d.diag), b = instanced.world(d.diag);
    std::uniform_real_distribution<float> in(-2, 10);
    int hits = 0, different = 0;
    for (int n = 0; n < 4000; ++n) {
        const Ray ray{{in(rng), in(rng), -5}, {0.01f, 0.02f, 1}};
        const Hit ha = trace(*a, ray), hb = trace(*b, ray);
        if (!ha.valid() || !hb.valid() ||
            a->binding(ha).primitive % 3 != b->binding(hb).primitive) {
            different += ha.valid() || hb.valid();
            continue;
        }
        ++hits;
        EXPECT_EQ(hb.instance, a->binding(ha).primitive / 3);
        const Filled fa(*a, {ha}, {ray}), fb(*b, {hb}, {ray});
        // The origin 500 away from the prototype's own is rounded on its way in: 500 * 6e-8 * a
        // few.
        const auto same = [&](sl_variable v, double tolerance) {
            EXPECT_LT(base::length(fa.vec(v, 0) - fb.vec(v, 0)), tolerance) << v;
        };
        const double grazing =
            std::fabs(dot(normalize(fa.vec(SL_VAR_Ng, 0)), normalize(fa.vec(SL_VAR_I, 0))));
        if (grazing > 0.1) {
            same(SL_VAR_P, 3e-3);
            same(SL_VAR_Ng, 3e-3);
        }
    }
    EXPECT_GT(hits, 500);
    EXPECT_LT(different, 4); // silhouettes
}

TEST(World, InstanceMembersTakeTheInstancesAttributes) {
    SceneBuilder b;
    b.scene.attributes.resize(3);
    b.scene.attributes[1].color = {1, 0, 0};
    b.scene.attributes[2].color = {0, 1, 0};
    b.scene.attributes[2].user.edit()["render:visibility"] = int_attribute("visibility", 4);
    rib::Object object;
    object.primitives.edit().push_back(unit_sphere());
    b.scene.objects.push_back(object);
    for (std::uint32_t k = 0; k < 3; ++k) {
        rib::Instance instance;
        instance.world_from_object = b.transform(Mat4::translate({4.0 * k, 0, 5}));
        instance.attributes = {k};
        b.scene.instances.push_back(instance);
    }
    QuietDiag d;
    const auto world = b.world(d.diag);
    const Ray first{{0, 0, 0}, {0, 0, 1}}, second{{4, 0, 0}, {0, 0, 1}},
        third{{8, 0, 0}, {0, 0, 1}};
    const Hit hit0 = trace(*world, first), hit1 = trace(*world, second);
    ASSERT_TRUE(hit0.valid() && hit1.valid());
    EXPECT_EQ(world->binding(hit0).attributes, 0u);
    EXPECT_EQ(world->binding(hit1).attributes, 1u);
    EXPECT_NE(world->binding(hit0).transform_key, world->binding(hit1).transform_key);
    EXPECT_EQ(Filled(*world, {hit1}, {second}).at(SL_VAR_Cs, 0, 1), 0);
    EXPECT_FALSE(trace(*world, third).valid());
    EXPECT_TRUE(occluded(*world, third));
    EXPECT_EQ(world->camera_from_object(hit1, 0).m[3][0], 4);
}

// Rays leave every kind of surface to its own side without meeting it again. Convex shapes: any hit
// is a self-hit.
TEST(World, NoSelfHitsFromSpawnOrigins) {
    std::mt19937 rng(4);
    std::size_t rays = 0, self_hits = 0;
    double largest_offset = 0;
    for (const double offset : {0.0, 10.0, 1e3, 1e5}) {
        for (int form = 0; form < 4; ++form) {
            SceneBuilder b;
            const Mat4 place = random_transform(rng, offset, form % 2 == 0);
            const rib::Primitive shape = form < 2 ? unit_sphere() : triangle_sphere(30, 1);
            if (form % 2 == 1) {
                rib::Object object;
                object.primitives.edit().push_back(shape);
                object.primitives.edit().front().world_from_object =
                    b.transform(Mat4::translate({50, -20, 7}));
                b.scene.objects.push_back(object);
                rib::Instance instance;
                instance.world_from_object = b.transform(place * Mat4::translate({-50, 20, -7}));
                instance.attributes = {0};
                b.scene.instances.push_back(instance);
            } else {
                b.add(shape, place);
            }
            QuietDiag d;
            const auto world = b.world(d.diag);
            const V3d centre = point(place, V3d());
            for (int n = 0; n < 700; ++n) {
                const V3f from = V3f(centre) + random_direction(rng) * 5.0f;
                const V3f aim = V3f(centre) + random_direction(rng) * 0.5f;
                const Ray ray{from, aim - from};
                const Hit hit = trace(*world, ray);
                if (!hit.valid()) {
                    continue;
                }
                const Filled f(*world, {hit}, {ray});
                const V3f outward(f.vec(SL_VAR_Ng, 0));
                const V3f P(f.vec(SL_VAR_P, 0));
                for (int packet = 0; packet < 12; ++packet) {
                    RayPacket p{};
                    Hit hits[8];
                    for (int i = 0; i < 8; ++i) {
                        V3f dir = random_direction(rng);
                        dir = dot(dir, outward) < 0 ? -dir : dir;
                        const V3f start = world->spawn_origin(hit, dir);
                        largest_offset = std::max(largest_offset, double(base::length(start - P)) /
                                                                      (1 + base::length(centre)));
                        set_ray(p, i, {start, dir});
                    }
                    world->intersect(p, hits);
                    for (const Hit& h : hits) {
                        ++rays;
                        self_hits += h.valid();
                    }
                }
            }
        }
    }
    EXPECT_GT(rays, 1000000u);
    EXPECT_EQ(self_hits, 0u);
    // An offset is a bound of rounding errors, not a visible gap.
    EXPECT_LT(largest_offset, 3e-5);
    RecordProperty("largest_relative_offset", std::to_string(largest_offset));
}

// Shapes that are not convex may be met again, but not at once: their radii of curvature are
// near 1.
TEST(World, NoSelfHitsFromOtherQuadrics) {
    using K = QuadricKind;
    const rib::Quadric shapes[] = {
        {K::Torus, {1, 0.4, 0, 360, 360}}, {K::Cone, {2, 1, 360}},
        {K::Cylinder, {1, -1, 1, 360}},    {K::Hyperboloid, {1, 0, -1, 0.3, 1, 1, 360}},
        {K::Paraboloid, {1, 0, 1.5, 360}}, {K::Disk, {0, 1, 360}},
    };
    std::mt19937 rng(5);
    std::size_t rays = 0, self_hits = 0;
    for (const rib::Quadric& q : shapes) {
        for (const double offset : {0.0, 100.0, 1e4}) {
            SceneBuilder b;
            const Mat4 place = random_transform(rng, offset, offset > 10);
            b.add(SceneBuilder::quadric(q.kind, q.args), place);
            QuietDiag d;
            const auto world = b.world(d.diag);
            const V3f centre(point(place, V3d()));
            for (int n = 0; n < 500; ++n) {
                const V3f from = centre + random_direction(rng) * 5.0f;
                const Hit hit = trace(*world, {from, centre + random_direction(rng) * 0.8f - from});
                for (int k = 0; hit.valid() && k < 16; ++k) {
                    const V3f dir = random_direction(rng);
                    // A rounding error's worth of distance, but far more than an offset could
                    // bridge.
                    const float near = float(1e-4 + 1e-6 * offset);
                    const Hit again = trace(*world, {world->spawn_origin(hit, dir), dir, 0, near});
                    ++rays;
                    self_hits += again.valid();
                }
            }
        }
    }
    EXPECT_GT(rays, 60000u);
    EXPECT_EQ(self_hits, 0u);
}

TEST(World, LeavesOutWhatItCannotDraw) {
    SceneBuilder b;
    rib::Primitive p;
    p.shape = rib::SubdivisionMesh{};
    b.add(p);
    b.add(p);
    p.shape = rib::Curves{};
    b.add(p);
    b.add(unit_sphere(), Mat4::scale({1, 0, 1}));
    Mat4 perspective;
    perspective.m[2][3] = 1;
    b.add(unit_sphere(), perspective);
    rib::Primitive in_solid = unit_sphere();
    in_solid.solid = 0;
    b.add(in_solid);
    QuietDiag d;
    const auto world = b.world(d.diag);
    EXPECT_TRUE(d.said("SubdivisionMesh: not drawn by this version"));
    EXPECT_TRUE(d.said("Curves: not drawn by this version"));
    EXPECT_TRUE(d.said("singular or not affine"));
    EXPECT_TRUE(d.said("SolidBegin"));
    EXPECT_EQ(d.diag.messages().size(), 5u);
    EXPECT_EQ(world->stats().shapes, 1u);
}

TEST(World, OneLevelOfDetailIsDrawn) {
    const float infinity = rib::ri_infinity;
    for (const float detail : {0.0f, 9.0f, 10.0f, 14.0f, 15.0f, 16.0f, 20.0f, 1e6f, infinity}) {
        SceneBuilder b;
        b.scene.attributes.resize(2);
        for (rib::Attributes& a : b.scene.attributes) {
            a.detail_area_px = detail;
        }
        b.scene.attributes[0].detail_range = {0, 0, 10, 20};
        b.scene.attributes[1].detail_range = {10, 20, infinity, infinity};
        b.add(unit_sphere());
        b.add(unit_sphere()).attributes = 1;
        QuietDiag d;
        const auto world = b.world(d.diag);
        ASSERT_EQ(world->stats().shapes, 1u) << detail;
        const Hit hit = trace(*world, {{0, 0.1f, -5}, {0, 0, 1}});
        ASSERT_TRUE(hit.valid());
        EXPECT_EQ(world->binding(hit).primitive, detail < 15 ? 0u : 1u);
    }
}

TEST(World, HostileGeometry) {
    SceneBuilder b;
    const float huge = 1e38f, nan = NAN;
    b.add(SceneBuilder::polygons({1}, {3}, {0, 1, 2}, {nan, 0, 0, 1, 0, 0, 0, 1, 0}));
    b.add(SceneBuilder::polygons({1}, {3}, {0, 1, 2}, {huge, 0, 0, 1, huge, 0, 0, 1, -huge}));
    b.add(SceneBuilder::polygons({1}, {3}, {0, 1, 2000000000}, {0, 0, 0, 1, 0, 0, 0, 1, 0}));
    b.add(SceneBuilder::polygons({1}, {3}, {0, 1, -5}, {0, 0, 0, 1, 0, 0, 0, 1, 0}));
    b.add(SceneBuilder::polygons({1000000000}, {3}, {0, 1, 2}, {0, 0, 0, 1, 0, 0, 0, 1, 0}));
    b.add(SceneBuilder::polygons({1}, {2000000000}, {0, 1, 2}, {0, 0, 0, 1, 0, 0, 0, 1, 0}));
    b.add(SceneBuilder::polygons({1}, {-3}, {0, 1, 2}, {0, 0, 0, 1, 0, 0, 0, 1, 0}));
    b.add(SceneBuilder::polygons({1}, {4}, {0, 0, 0, 0}, {1, 1, 1}));
    b.add(SceneBuilder::polygons({1, 1}, {3, 5}, {0, 1, 2, 2, 2, 1, 0, 0},
                                 {0, 0, 5, 1, 0, 5, 0, 1, 5}));
    b.add(SceneBuilder::polygons({}, {}, {}, {}));
    rib::Primitive& short_color = b.add(square(1, 3));
    short_color.params.params.push_back(
        param("Cs", rib::StorageClass::Vertex, rib::ParamType::Color, {1, 0, 0}));
    b.add(unit_sphere(), Mat4::scale({1e-20, 1e-20, 1e-20}));
    b.add(unit_sphere(), Mat4::translate({1e30, 0, 0}));
    rib::Primitive lost = unit_sphere();
    lost.attributes = 77;
    b.add(lost);
    b.scene.primitives.back().world_from_object = 1234567;
    rib::Instance instance;
    instance.object = 42;
    b.scene.instances.push_back(instance);
    QuietDiag d;
    const auto world = b.world(d.diag);
    EXPECT_TRUE(trace(*world, {{0.1f, 0.1f, 0}, {0, 0, 1}}).valid());
    for (const Ray& ray :
         {Ray{{0.1f, 0.2f, -1}, {0, 0, 1}}, Ray{{1e30f, 0, -5}, {0, 0, 1}},
          Ray{{1e18f, 1e18f, 0}, {-1, -1, 0}}, Ray{{0, 0, -1}, {1e-38f, 0, 1e-38f}}}) {
        const Hit hit = trace(*world, ray);
        if (hit.valid()) {
            Filled(*world, {hit}, {ray});
            (void)world->spawn_origin(hit, {0, 0, 1});
        }
    }
    EXPECT_TRUE(d.said("does not fit the primitive"));
    EXPECT_GE(d.diag.messages().size(), 8u);
}

} // namespace
