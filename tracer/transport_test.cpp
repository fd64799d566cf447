// SPDX-License-Identifier: Apache-2.0
// Rays of shaders against closed forms, on sheets and hand-written shaders that wait for their
// rays: mirrors, slabs, volumes, the deepest miss, gather, lights that trace. Float results are
// compared to 1e-5 relative: a few dozen float roundings along a ray of some levels.
#include "tracer/media.h"
#include "tracer/ray_cone.h"
#include "tracer/ray_directions.h"
#include "tracer/test_frame.h"

#include <cmath>
#include <gtest/gtest.h>
#include <vector>

namespace trace {
namespace {

constexpr double tolerance = 1e-5;

class Transport : public ::testing::Test, protected test::TestFrame {
protected:
    rib::Attributes& backdrop(float z, float value, float side = -1) {
        rib::Attributes& a = sheet(z, shader("flat"), side);
        a.color = grey(value);
        return a;
    }
    rib::ShaderId mirror(float weight, float emits) {
        return shader("mirror", {number("weight", weight), number("emits", emits)});
    }
    // Straight through.
    rib::ShaderId clear() { return shader("glass", {number("weight", 0)}); }
    rib::ShaderId absorb(float density) { return shader("absorb", {number("density", density)}); }
    void max_level(int level) { option("render:max_raylevel", integer("max_raylevel", level)); }

    void expect_all(const Image& image, Plane plane, double want) {
        for (const float value : image.plane(plane)) {
            ASSERT_NEAR(value, want, tolerance * std::max(1.0, std::fabs(want)));
        }
    }
};

// --- levels

TEST_F(Transport, FacingMirrorsSumAGeometricSeriesToTheDeepestLevel) {
    for (const int level : {0, 1, 4, 9}) {
        scene.attributes.clear();
        sheets.clear();
        sheet(2, mirror(0.5f, 1));
        sheet(-1, mirror(0.5f, 1), 1);
        max_level(level);
        double want = 0;
        for (int k = 0; k <= level; ++k) {
            want += std::pow(0.5, k);
        }
        expect_all(render(), Plane::R, want);
        EXPECT_EQ(counters.get(Counter::rays_reflection), 256U * static_cast<unsigned>(level));
        EXPECT_EQ(counters.get(Counter::rays_too_deep), 256U);
    }
}

TEST_F(Transport, FourLevelsAreTheDefault) {
    sheet(2, mirror(0.5f, 1));
    sheet(-1, mirror(0.5f, 1), 1);
    expect_all(render(), Plane::R, 1.9375);
}

TEST_F(Transport, AttributesOfTheSurfaceThatAsksLimitDepth) {
    rib::Attributes& a = sheet(2, mirror(0.5f, 1));
    a.user.edit()["trace:maxspeculardepth"] = integer("maxspeculardepth", 2);
    sheet(-1, mirror(0.5f, 1), 1);
    expect_all(render(), Plane::R, 1.75); // levels 0, 1, 2; the mirror ahead asks no third
}

// --- a slab with all its internal reflections

struct Slab {
    double R, ahead, behind_camera, back;
    int max_level;
    // Sheets at 2 and 3; what a ray sees that leaves sheet `from` (-1: the camera) along dz.
    [[nodiscard]] double seen(int from, int dz, int level) const {
        if (level > max_level) {
            return 0;
        }
        const int next = from == -1 ? 0 : from + dz;
        if (next < 0) {
            return behind_camera;
        }
        if (next > 1) {
            return back;
        }
        return R * seen(next, -dz, level + 1) + (1 - R) * seen(next, dz, level + 1);
    }
};

TEST_F(Transport, ASlabSumsItsInternalReflections) {
    const auto glass = shader("glass", {number("weight", 0.3f)});
    sheet(2, glass);
    sheet(3, glass, 1);
    backdrop(10, 1);
    backdrop(-5, 0.25f, 1);
    max_level(7);
    const Slab slab{static_cast<double>(0.3f), 0, 0.25, 1, 7};
    expect_all(render(), Plane::R, slab.seen(-1, 1, 0));
}

TEST_F(Transport, SameBytesWhateverThreadsAndBuckets) {
    const auto glass = shader("glass", {number("weight", 0.3f)});
    sheet(2, glass);
    sheet(3, glass, 1);
    backdrop(10, 1);
    sheet(-5, shader("gathering", {number("samples", 5), number("angle", 0.8f)}), 1);
    const Image one = render(1, 16);
    const Image many = render(3, 4);
    EXPECT_EQ(one.planes, many.planes);
}

// --- what is not opaque

TEST_F(Transport, RaysGoOnBehindWhatIsNotOpaque) {
    sheet(2, mirror(1, 0));
    rib::Attributes& pane = backdrop(-1, 0.5f, 1);
    pane.opacity = {0.25f, 0.5f, 1};
    backdrop(-2, 1, 1);
    const Image image = render();
    expect_all(image, Plane::R, 0.25 * 0.5 + 0.75);
    expect_all(image, Plane::G, 0.5 * 0.5 + 0.5);
    expect_all(image, Plane::B, 0.5);
    EXPECT_EQ(counters.get(Counter::rays_behind), 256U);
}

// --- volumes

TEST_F(Transport, SlabsInsideSlabsAbsorbExactly) {
    const float k1 = 0.3f, k2 = 0.8f;
    const auto outer = absorb(k1), inner = absorb(k2);
    for (const float z : {2.0f, 6.0f}) {
        sheet(z, clear(), z == 2 ? -1.0f : 1.0f).interior = outer;
    }
    for (const float z : {3.0f, 4.0f}) {
        sheet(z, clear(), z == 3 ? -1.0f : 1.0f).interior = inner;
    }
    backdrop(10, 1);
    max_level(6);
    expect_all(render(), Plane::R,
               std::exp(-3 * static_cast<double>(k1) - static_cast<double>(k2)));
}

TEST_F(Transport, PartlyOpaqueSurfacesInsideAVolume) {
    const auto k = static_cast<double>(0.4f);
    sheet(2, clear()).interior = absorb(0.4f);
    backdrop(3, 0.5f).opacity = grey(0.5f);
    backdrop(5, 1);
    expect_all(render(), Plane::R, std::exp(-k) * 0.25 + 0.5 * std::exp(-3 * k));
}

// The wall of a solid that a ray passes by transparency bounds its volume as one it is refracted
// by.
TEST_F(Transport, TransparentWallsBoundVolumes) {
    const auto k = static_cast<double>(0.4f);
    sheet(2, clear());
    const auto fog = absorb(0.4f);
    for (const float z : {3.0f, 5.0f}) {
        rib::Attributes& wall = backdrop(z, 0, z == 3 ? -1.0f : 1.0f);
        wall.opacity = grey(0);
        wall.interior = fog;
    }
    backdrop(9, 1);
    expect_all(render(), Plane::R, std::exp(-2 * k));
}

TEST_F(Transport, ExteriorLiesWhereTheNormalPoints) {
    const auto k = static_cast<double>(0.2f);
    sheet(2, mirror(1, 0)).exterior = absorb(0.2f);
    backdrop(-3, 1, 1);
    expect_all(render(), Plane::R, std::exp(-5 * k));
}

TEST_F(Transport, TheAtmosphereBetweenPanesCountsOnce) {
    const auto k = static_cast<double>(0.2f);
    const auto air = absorb(0.2f);
    rib::Attributes& pane = backdrop(2, 1);
    pane.opacity = grey(0.5f);
    pane.atmosphere = air;
    backdrop(5, 1).atmosphere = air;
    expect_all(render(), Plane::R, 0.5 * std::exp(-2 * k) + 0.5 * std::exp(-5 * k));
}

TEST_F(Transport, TheCamerasExteriorFillsWhatRaysThatMeetNothingSee) {
    scene.options.far_clip = 10;
    scene.camera_exterior = absorb(0.5f);
    const Image image = render();
    expect_all(image, Plane::A, 1 - std::exp(-5));
    scene.options.far_clip = 1e38f; // RI_INFINITY
    expect_all(render(), Plane::A, 0);
}

TEST(MediaTest, RaysComeOutOfNestedSolidsIntoTheRightOne) {
    rib::Scene scene;
    scene.attributes.resize(3);
    scene.attributes[0].interior = 10;
    scene.attributes[1].interior = 11;
    Media media(scene);
    const MediumId in_0 = media.behind(0, 0, true);
    const MediumId in_1 = media.behind(in_0, 1, true);
    EXPECT_EQ(media.volume(in_0), 10U);
    EXPECT_EQ(media.volume(in_1), 11U);
    EXPECT_EQ(media.behind(in_1, 1, true), in_1) << "total internal reflection";
    EXPECT_EQ(media.behind(in_1, 1, false), in_0);
    EXPECT_EQ(media.behind(in_1, 2, true), in_1) << "a surface without volumes bounds nothing";
    EXPECT_EQ(media.behind(in_0, 0, false), 0U);
    EXPECT_TRUE(media.is_open(0));
    MediumId deep = 0; // as many as somebody may write
    for (int i = 0; i < 1000; ++i) {
        scene.attributes.emplace_back().interior = static_cast<rib::ShaderId>(100 + i);
        deep = media.behind(deep, static_cast<std::uint32_t>(scene.attributes.size() - 1), true);
    }
    EXPECT_EQ(media.volume(deep), 1099U);
}

// --- what else rays tell

TEST_F(Transport, FulltraceTellsTheDeepestMiss) {
    sheet(2, shader("probe"));
    const Image alone = render();
    expect_all(alone, Plane::R, 1e30);
    expect_all(alone, Plane::G, 1);
    expect_all(alone, Plane::B, -1);
    backdrop(-1, 1, 1);
    const Image stopped = render();
    expect_all(stopped, Plane::R, 3);
    expect_all(stopped, Plane::G, 0);
    scene.attributes.back().opacity = grey(0); // the ray goes on, and meets nothing
    const Image behind = render();
    expect_all(behind, Plane::R, 3);
    expect_all(behind, Plane::G, 1);
    sheet(-3, mirror(1, 0), 1); // and so do all those between the two mirrors: five levels
    const Image deep = render();
    expect_all(deep, Plane::G, 5);
    expect_all(deep, Plane::B, -1);
}

TEST_F(Transport, GatherFillsTheConeAndReadsChannels) {
    const float angle = 0.6f;
    sheet(2, shader("gathering", {number("samples", 64), number("angle", angle)}));
    sheet(-1, mirror(0, 0.5f), 1);
    const Image image = render();
    expect_all(image, Plane::R, 0.5);
    expect_all(image, Plane::B, 1);
    const auto a = static_cast<double>(angle);
    const double want = 2 * 3 * (1 - std::cos(a)) / std::pow(std::sin(a), 2); // mean of 3 / cos
    double mean = 0;
    for (const float length : image.plane(Plane::G)) {
        EXPECT_NEAR(length, want, 0.03) << "64 stratified rays of lengths 3 to 3.6";
        mean += static_cast<double>(length) / 256;
    }
    EXPECT_NEAR(mean, want, 0.003) << "256 points, shifted at random";
}

TEST_F(Transport, GatherSendsParameters) {
    sheet(2, shader("gathering", {number("samples", 4), number("sent", 0.75f)}));
    sheet(-1, mirror(0, 0.5f), 1);
    expect_all(render(), Plane::R, 0.75);
}

// The light runs for the surface it lights while it runs for what its own ray meets.
TEST_F(Transport, LightsMayTraceToWhatTheyLight) {
    const auto traced = light(shader("tracing_light"));
    const auto glow = light(shader("ambient", {number("intensity", 0.25f)}));
    lit_sheet(2, shader("lit"), {traced});
    lit_sheet(-1, shader("lit"), {traced, glow});
    expect_all(render(), Plane::R, 0.25);
}

// --- widths and directions

TEST(RayConeTest, WidthAndSpread) {
    const RayCone linear = RayCone::from(0.5f, 0.25f);
    EXPECT_FLOAT_EQ(linear.width(2), 1);
    EXPECT_FLOAT_EQ(linear.spread(2), 0.25f);
    // Along u the rays draw apart, along v they stay; what lies along the ray does not count.
    const RayCone cone = RayCone::from({0, 0, 1}, {1, 0, 5}, {0, 4, 5}, {1, 0, 0}, {});
    EXPECT_FLOAT_EQ(cone.width(0), 2);
    EXPECT_FLOAT_EQ(cone.width(3), 4);
    const float h = 1e-3f;
    EXPECT_NEAR(cone.spread(3), (cone.width(3 + h) - cone.width(3 - h)) / (2 * h), 1e-3);
}

TEST(ConeDirectionTest, CosineWeightedDirectionsHaveTheirMean) {
    const base::V3d axis = base::normalize(base::V3d(1, -2, 0.5));
    ConeSample which;
    which.samples = 1024;
    which.seed = 7;
    which.distribution = ConeDistribution::Cosine;
    double mean = 0, uniform = 0;
    for (which.sample = 0; which.sample < 1024; ++which.sample) {
        const base::V3d d = cone_direction(axis, 10, which);
        EXPECT_NEAR(base::length(d), 1, 1e-9);
        mean += base::dot(d, axis) / 1024;
        ConeSample even = which;
        even.distribution = ConeDistribution::Uniform;
        uniform += base::dot(cone_direction(axis, 0.5, even), axis) / 1024;
    }
    EXPECT_NEAR(mean, 2.0 / 3, 1e-3); // of cos over a hemisphere, by cos / pi
    EXPECT_NEAR(uniform, (1 + std::cos(0.5)) / 2, 1e-3);
    EXPECT_NEAR(cone_solid_angle(10), 4 * 3.14159265358979, 1e-9);
}

} // namespace
} // namespace trace
