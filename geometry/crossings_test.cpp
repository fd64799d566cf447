// SPDX-License-Identifier: Apache-2.0
// Shadow rays among things that let light through: opaque ones stop them at once, the others are
// named, nearest first, each side of a closed surface for itself.
#include "geometry/test_scene.h"

#include <cstring>
#include <gtest/gtest.h>

namespace geo::test {
namespace {

struct Glass {
    SceneBuilder builder;
    QuietDiag quiet;

    // An attribute state with an opacity and, if not empty, a word of casts_shadows.
    std::uint32_t state(float opacity, const char* word = "") {
        rib::Attributes a;
        a.opacity = {opacity, opacity, opacity};
        if (std::strlen(word) > 0) {
            rib::Param p;
            p.name = "casts_shadows";
            p.decl.type = rib::ParamType::String;
            p.strings = {word};
            a.user.edit()["render:casts_shadows"] = p;
        }
        builder.scene.attributes.push_back(a);
        return static_cast<std::uint32_t>(builder.scene.attributes.size() - 1);
    }
    void sphere(double z, std::uint32_t attributes) {
        rib::Primitive p = SceneBuilder::quadric(rib::QuadricKind::Sphere, {1, -1, 1, 360});
        p.attributes = attributes;
        builder.add(p, Mat4::translate({0, 0, z}));
    }
    void square(double z, std::uint32_t attributes) {
        rib::Primitive p = SceneBuilder::polygons({1}, {4}, {0, 1, 2, 3},
                                                  {-1, -1, 0, -1, 1, 0, 1, 1, 0, 1, -1, 0});
        p.attributes = attributes;
        builder.add(p, Mat4::translate({0, 0, z}));
    }
};

RayPacket shadow_ray(float tfar) {
    RayPacket p{};
    set_ray(p, 3, {{0.1f, 0.2f, 0}, {0, 0, 1}, 0, tfar, ShadowRay});
    return p;
}

TEST(Crossings, AreNamedNearestFirst) {
    Glass g;
    const auto half = g.state(0.5f);
    g.square(9, half);
    g.sphere(4, half);
    g.square(1, half);
    const auto world = g.builder.world(g.quiet.diag);
    EXPECT_TRUE(world->filters_light());
    Crossings c;
    EXPECT_EQ(world->occluded(shadow_ray(100), c), 0U);
    ASSERT_EQ(c.count[3], 4);
    EXPECT_EQ(c.more, 0U);
    EXPECT_NEAR(c.hits[3][0].t, 1, 1e-6f);
    EXPECT_NEAR(c.hits[3][1].t, 4 - std::sqrt(0.95f), 1e-5f);
    EXPECT_NEAR(c.hits[3][2].t, 4 + std::sqrt(0.95f), 1e-5f);
    EXPECT_NEAR(c.hits[3][3].t, 9, 1e-5f);
    EXPECT_EQ(world->shadow_mode(c.hits[3][0]), ShadowMode::Os);
    EXPECT_EQ(world->occluded(shadow_ray(100)), 0U); // nothing opaque
    EXPECT_EQ(world->occluded(shadow_ray(4.5f), c), 0U);
    EXPECT_EQ(c.count[3], 2); // the segment ends inside
}

TEST(Crossings, OpaqueStopsAndNoneIsNotThere) {
    Glass g;
    g.square(1, g.state(0.5f));
    g.square(2, g.state(0.5f, "none"));
    g.square(3, g.state(0.5f, "opaque"));
    const auto world = g.builder.world(g.quiet.diag);
    Crossings c;
    EXPECT_EQ(world->occluded(shadow_ray(100), c), 8U);
    EXPECT_EQ(world->occluded(shadow_ray(2.5f), c), 0U);
    EXPECT_EQ(c.count[3], 1);
    RayPacket other = shadow_ray(100);
    other.mask[3] = ReflectionRay;
    other.tfar[3] = 1.5f;
    EXPECT_EQ(world->occluded(other), 8U); // to other rays it is a thing like any
}

TEST(Crossings, ManyLayersAreTakenInTurns) {
    Glass g;
    const auto half = g.state(0.5f);
    for (int i = 20; i > 0; --i) {
        g.square(i, half);
    }
    const auto world = g.builder.world(g.quiet.diag);
    Crossings c;
    EXPECT_EQ(world->occluded(shadow_ray(100), c), 0U);
    EXPECT_EQ(c.count[3], Crossings::most);
    EXPECT_EQ(c.more, 8U);
    EXPECT_NEAR(c.hits[3][Crossings::most - 1].t, Crossings::most, 1e-5f);
}

// The diagonal of a square belongs to two triangles.
TEST(Crossings, SharedEdgesCountOnce) {
    Glass g;
    g.square(1, g.state(0.5f));
    const auto world = g.builder.world(g.quiet.diag);
    for (int i = -90; i <= 90; ++i) {
        RayPacket p{};
        const float x = 0.01f * float(i);
        set_ray(p, 0, {{x, x, 0}, {0, 0, 1}, 0, 10, ShadowRay});
        set_ray(p, 1, {{x, -x, 0}, {0, 0, 1}, 0, 10, ShadowRay});
        Crossings c;
        (void)world->occluded(p, c);
        EXPECT_EQ(c.count[0], 1) << i;
        EXPECT_EQ(c.count[1], 1) << i;
    }
}

// Opacity 1 is opaque whatever the mode says by default; 0 is not there; shaders decide at the hit.
TEST(Crossings, ModesFollowOpacity) {
    Glass g;
    g.square(1, g.state(1));
    EXPECT_FALSE(g.builder.world(g.quiet.diag)->filters_light());
    g.square(2, g.state(0));
    EXPECT_FALSE(g.builder.world(g.quiet.diag)->filters_light());
    g.square(3, g.state(1, "shade"));
    EXPECT_TRUE(g.builder.world(g.quiet.diag)->filters_light());
}

} // namespace
} // namespace geo::test
