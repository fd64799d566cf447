// SPDX-License-Identifier: Apache-2.0
// Camera spaces against numbers derived by hand from ri.md 8.3 and 8.4, rays against the spaces.
#include "tracer/camera.h"
#include "tracer/sampler.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace {

using base::Mat4;
using base::V3d;
using trace::Camera;

constexpr double deg = 3.14159265358979323846 / 180;

// Compositions of a few double operations: 1e-12 of values up to 1000.
constexpr double tight = 1e-9;

rib::Scene scene_with(const std::string& projection, int xres, int yres, float fov_deg = 90) {
    rib::Scene s;
    s.options.projection = projection;
    s.options.xres = xres;
    s.options.yres = yres;
    s.options.fov_deg = fov_deg;
    return s;
}

void expect_point(const V3d& p, double x, double y) {
    EXPECT_NEAR(p.x, x, tight);
    EXPECT_NEAR(p.y, y, tight);
}

class CameraTest : public testing::Test {
protected:
    Camera camera(const rib::Scene& scene) { return Camera(scene, diag_); }
    std::FILE* null_ = std::fopen("/dev/null", "w");
    base::Diag diag_{null_};
    ~CameraTest() override { std::fclose(null_); }
};

TEST_F(CameraTest, PerspectiveLandscape) {
    // 640x480: window (-4/3, 4/3, -1, 1); fov 90: screen x = x/z, y = y/z.
    const Camera c = camera(scene_with("perspective", 640, 480));
    const Mat4 raster = c.raster_from_camera();
    expect_point(base::point(raster, {0, 0, 5}), 320, 240);
    expect_point(base::point(raster, {1, 0, 1}), 560, 240); // (1 + 4/3) / (8/3) 640
    expect_point(base::point(raster, {0, 2, 2}), 320, 0);   // top edge: y down
    expect_point(base::point(raster, {-4, -3, 3}), 0, 480); // lower left corner
    expect_point(base::point(c.ndc_from_camera(), {-4, -3, 3}), 0, 1);
    EXPECT_TRUE(c.perspective());
}

TEST_F(CameraTest, FieldOfViewSpansTheShorterSide) {
    const double t = std::tan(20 * deg);
    // Landscape: screen y = 1 is the top edge. Portrait: screen x = 1 is the right edge.
    const Camera wide = camera(scene_with("perspective", 640, 480, 40));
    expect_point(base::point(wide.raster_from_camera(), {0, 3 * t, 3}), 320, 0);
    const Camera tall = camera(scene_with("perspective", 480, 640, 40));
    expect_point(base::point(tall.raster_from_camera(), {3 * t, 0, 3}), 480, 320);
}

TEST_F(CameraTest, ScreenDepth) {
    rib::Scene s = scene_with("perspective", 100, 100, 50);
    s.options.near_clip = 2;
    s.options.far_clip = 10;
    const Camera c = camera(s);
    // z_s = f (z - n) / (z (f - n))
    EXPECT_NEAR(base::point(c.screen_from_camera(), {0, 0, 2}).z, 0, tight);
    EXPECT_NEAR(base::point(c.screen_from_camera(), {0, 0, 10}).z, 1, tight);
    EXPECT_NEAR(base::point(c.screen_from_camera(), {0, 0, 4}).z, 10.0 * 2 / (4 * 8), tight);
    s.options.far_clip = rib::ri_infinity;
    EXPECT_NEAR(base::point(camera(s).screen_from_camera(), {0, 0, 4}).z, 1 - 2.0 / 4, tight);
    s.options.projection = "orthographic";
    s.options.far_clip = 10;
    EXPECT_NEAR(base::point(camera(s).screen_from_camera(), {1, 2, 4}).z, 2.0 / 8, tight);
}

TEST_F(CameraTest, Orthographic) {
    const Camera c = camera(scene_with("orthographic", 200, 100));
    // Window (-2, 2, -1, 1): 50 pixels per unit.
    expect_point(base::point(c.raster_from_camera(), {1, 0.5, 7}), 150, 25);
    EXPECT_FALSE(c.perspective());
    const auto ray = c.pinhole_ray(150, 25);
    EXPECT_NEAR(ray.origin.x, 1, tight);
    EXPECT_NEAR(ray.origin.y, 0.5, tight);
    EXPECT_EQ(ray.origin.z, 0);
    EXPECT_EQ(ray.direction, (V3d{0, 0, 1}));
}

TEST_F(CameraTest, FrameAspectFitsUpperLeft) {
    rib::Scene s = scene_with("perspective", 640, 480);
    s.options.frame_aspect = 2; // wider than 4/3: H = 480 (4/3) / 2 = 320
    EXPECT_EQ(camera(s).raster().picture, (trace::PixelRange{0, 0, 640, 320}));
    // Window (-2, 2, -1, 1): the centre of the picture is (320, 160).
    expect_point(base::point(camera(s).raster_from_camera(), {0, 0, 1}), 320, 160);
    expect_point(base::point(camera(s).raster_from_camera(), {2, -1, 1}), 640, 320);
    s.options.frame_aspect = 1; // W = 640 / (4/3) = 480
    EXPECT_EQ(camera(s).raster().picture, (trace::PixelRange{0, 0, 480, 480}));
    EXPECT_EQ(camera(s).raster().frame, (trace::PixelRange{0, 0, 640, 480}));
}

TEST_F(CameraTest, PixelAspect) {
    rib::Scene s = scene_with("perspective", 320, 240);
    s.options.pixel_aspect = 2; // viewport aspect 8/3: window (-8/3, 8/3, -1, 1)
    const Camera c = camera(s);
    expect_point(base::point(c.raster_from_camera(), {8.0 / 3, 1, 1}), 320, 0);
    EXPECT_NEAR(c.view().pixels_per_unit_x, 60, tight);  // 320 / (16/3)
    EXPECT_NEAR(c.view().pixels_per_unit_y, 120, tight); // 240 / 2
    // Mean pixel at depth 3: 3 / sqrt(60 120).
    EXPECT_NEAR(c.footprint(3, 1), 3 / std::sqrt(7200.0), 1e-6);
}

TEST_F(CameraTest, ScreenWindowMirroredAndOffCentre) {
    rib::Scene s = scene_with("perspective", 100, 100);
    s.options.has_screen_window = true;
    s.options.screen_window = {1, -1, -1, 1}; // left > right
    expect_point(base::point(camera(s).raster_from_camera(), {0.5, 0, 1}), 25, 50);
    s.options.screen_window = {0, 1, 0.5, 1.5};
    expect_point(base::point(camera(s).raster_from_camera(), {0.25, 1, 1}), 25, 50);
    const auto ray = camera(s).pinhole_ray(25, 50);
    EXPECT_NEAR(ray.direction.x, 0.25, tight);
    EXPECT_NEAR(ray.direction.y, 1, tight);
}

TEST_F(CameraTest, WorldMatrices) {
    rib::Scene s = scene_with("perspective", 100, 100);
    s.camera_from_world.keys[0].m = Mat4::translate({1, 2, 10});
    const Camera c = camera(s);
    expect_point(base::point(c.ndc_from_world(), {-1, -2, 0}), 0.5, 0.5);
    expect_point(base::point(c.ndc_from_world(), {4, -2, 0}), 0.75, 0.5); // x/z = 5/10
}

// Transformations before Projection, and the projections they meet.
struct CameraSetup {
    const char* projection;
    Mat4 extra;
};

std::vector<CameraSetup> setups() {
    Mat4 perspective_request; // ri.md 8.3: Perspective 50
    const double t = std::tan(25 * deg);
    perspective_request.m[2][2] = t;
    perspective_request.m[2][3] = t;
    perspective_request.m[3][2] = -t;
    perspective_request.m[3][3] = 0;
    return {{"perspective", {}},
            {"orthographic", {}},
            {"null", {}},
            {"perspective", Mat4::scale({0.5, 0.25, 1})},
            {"perspective", Mat4::translate({0.2, -0.1, 0})},
            {"perspective", Mat4::rotate(30, {0, 0, 1})},
            {"orthographic", Mat4::rotate(20, {0, 1, 0})},
            {"perspective", Mat4::rotate(20, {1, 1, 0})},
            {"orthographic", perspective_request * Mat4::translate({0, 0, 2})},
            {"null", perspective_request}};
}

TEST_F(CameraTest, RaysProjectBackToTheirPosition) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> unit(0, 1);
    for (const CameraSetup& setup : setups()) {
        rib::Scene s = scene_with(setup.projection, 640, 480, 55);
        s.options.near_clip = 0.5f;
        s.options.far_clip = 50;
        s.screen_from_camera_extra = setup.extra;
        const Camera c = camera(s);
        const Mat4 raster = c.raster_from_camera();
        for (int i = 0; i < 50; ++i) {
            const double x = 640 * unit(random), y = 480 * unit(random);
            const auto ray = c.pinhole_ray(x, y);
            const double t = 1 + 9 * unit(random);
            const V3d back = base::point(raster, ray.origin + t * ray.direction);
            EXPECT_NEAR(back.x, x, 1e-7) << setup.projection;
            EXPECT_NEAR(back.y, y, 1e-7) << setup.projection;
        }
    }
    EXPECT_EQ(diag_.count(base::Severity::Error), 0U);
}

TEST_F(CameraTest, PacketsAreExactToAHundredthOfAPixel) {
    const trace::Sampler sampler({.nx = 2, .ny = 2});
    for (const CameraSetup& setup : setups()) {
        rib::Scene s = scene_with(setup.projection, 4096, 4096, 60);
        s.options.near_clip = 0.5f;
        s.options.far_clip = 50; // an infinite one leaves no depth to turn into x and y
        s.screen_from_camera_extra = setup.extra;
        const Camera c = camera(s);
        const Mat4 raster = c.raster_from_camera();
        trace::SampleBlock block;
        sampler.fill({4080, -3, 4099, 6}, block);
        std::vector<geo::RayPacket> packets(block.num_packets());
        c.make_rays(block, packets);
        for (std::size_t i = 0; i < block.count; ++i) {
            const auto& p = packets[i / 8];
            const std::size_t k = i % 8;
            ASSERT_TRUE((p.active >> k & 1U) != 0) << setup.projection;
            const V3d at{double(p.ox[k]) + 7 * double(p.dx[k]),
                         double(p.oy[k]) + 7 * double(p.dy[k]),
                         double(p.oz[k]) + 7 * double(p.dz[k])};
            const V3d back = base::point(raster, at);
            // Float directions: 2^-24 of 4096 pixels is 0.0003.
            EXPECT_NEAR(back.x, block.px[i] + double(block.x[i]), 0.01) << setup.projection;
            EXPECT_NEAR(back.y, block.py[i] + double(block.y[i]), 0.01) << setup.projection;
        }
        const std::size_t tail = block.count % 8;
        EXPECT_EQ(packets.back().active, (1U << (tail == 0 ? 8 : tail)) - 1U);
    }
}

TEST_F(CameraTest, ClippingLimitsRays) {
    rib::Scene s = scene_with("perspective", 100, 100);
    s.options.near_clip = 2;
    s.options.far_clip = 10;
    auto ray = camera(s).pinhole_ray(3, 77);
    EXPECT_NEAR(ray.tnear, 2, tight); // t is camera z
    EXPECT_NEAR(ray.tfar, 10, tight);
    s.options.far_clip = rib::ri_infinity;
    EXPECT_TRUE(std::isinf(camera(s).pinhole_ray(3, 77).tfar));
    // The positive side of the normal goes: z > 5 here.
    s.options.clipping_planes.push_back({{0, 0, 5}, {0, 0, 1}});
    ray = camera(s).pinhole_ray(50, 50);
    EXPECT_NEAR(ray.tnear, 2, tight);
    EXPECT_NEAR(ray.tfar, 5, tight);
    // And everything left of x = 0: the left half of the picture is empty.
    s.options.clipping_planes.push_back({{0, 0, 0}, {-1, 0, 0}});
    EXPECT_LE(camera(s).pinhole_ray(75, 50).tnear, 5);
    ray = camera(s).pinhole_ray(25, 50);
    EXPECT_GT(ray.tnear, ray.tfar);
}

TEST_F(CameraTest, LensRaysMeetAtTheFocalDistance) {
    for (const char* projection : {"perspective", "orthographic"}) {
        rib::Scene s = scene_with(projection, 64, 64);
        s.options.fstop = 2;
        s.options.focal_length = 0.5f;
        s.options.focal_distance = 6;
        const Camera c = camera(s);
        EXPECT_NEAR(c.lens_radius(), 0.125, tight);
        const trace::Sampler sampler({.nx = 4, .ny = 4, .jitter = 1, .wants_lens = true});
        trace::SampleBlock block;
        sampler.fill({10, 20, 11, 21}, block);
        std::vector<geo::RayPacket> packets(block.num_packets());
        c.make_rays(block, packets);
        double spread = 0;
        for (std::size_t i = 0; i < block.count; ++i) {
            const auto& p = packets[i / 8];
            const std::size_t k = i % 8;
            const float t = (6 - p.oz[k]) / p.dz[k];
            const auto pin = c.pinhole_ray(10 + double(block.x[i]), 20 + double(block.y[i]));
            const V3d focus = pin.origin + 6 * pin.direction;
            EXPECT_NEAR(p.ox[k] + t * p.dx[k], focus.x, 1e-5); // float rays
            EXPECT_NEAR(p.oy[k] + t * p.dy[k], focus.y, 1e-5);
            const double r =
                std::hypot(p.ox[k] - float(pin.origin.x), p.oy[k] - float(pin.origin.y));
            EXPECT_LE(r, 0.125 + 1e-6);
            spread = std::max(spread, r);
        }
        EXPECT_GT(spread, 0.09); // 16 stratified points reach the outer quarter of the disc
    }
}

TEST_F(CameraTest, ImpossibleValuesAreReportedAndReplaced) {
    rib::Scene s = scene_with("perspective", 100, 100, 200);
    s.options.near_clip = 5;
    s.options.far_clip = 2;
    s.options.has_screen_window = true;
    s.options.screen_window = {1, 1, -1, 1};
    s.options.crop = {0, NAN, 0, 1};
    const Camera c = camera(s);
    EXPECT_EQ(diag_.count(base::Severity::Error), 4U);
    EXPECT_EQ(c.raster().crop, c.raster().frame);
    expect_point(base::point(c.raster_from_camera(), {1, 1, 1}), 100, 0); // fov 90, default window
    s = scene_with("fisheye", 0x7fffffff, -1);
    s.screen_from_camera_extra = Mat4::scale({0, 1, 1});
    const Camera d = camera(s);
    EXPECT_EQ(diag_.count(base::Severity::Error), 7U);
    EXPECT_EQ(d.raster().xres, 65536);
    EXPECT_EQ(d.raster().yres, 480);
    EXPECT_TRUE(std::isfinite(d.pinhole_ray(1, 1).direction.x));
}

// ri.md 6.3, written down a second time in integers: first pixel whose left edge is at or beyond
// the fraction.
TEST(Crop, FormulaAtPlainFractions) {
    EXPECT_EQ(trace::crop_span(640, 0, 1).begin, 0);
    EXPECT_EQ(trace::crop_span(640, 0, 1).end, 640);
    EXPECT_EQ(trace::crop_span(640, 0.1f, 0.9f).begin, 64);
    EXPECT_EQ(trace::crop_span(640, 0.1f, 0.9f).end, 576);
    EXPECT_EQ(trace::crop_span(10, 0.25f, 0.75f).begin, 3); // ceil(2.5)
    EXPECT_EQ(trace::crop_span(10, 0.25f, 0.75f).end, 8);   // ceil(6.5) + 1
    EXPECT_EQ(trace::crop_span(10, -3, 7).begin, 0);
    EXPECT_EQ(trace::crop_span(10, -3, 7).end, 10);
    EXPECT_EQ(trace::crop_span(10, 0.55f, 0.6f).begin, trace::crop_span(10, 0.55f, 0.6f).end);
}

TEST(Crop, AbuttingWindowsTile) {
    std::mt19937 random(2);
    std::uniform_real_distribution<float> unit(0, 1);
    for (int trial = 0; trial < 200; ++trial) {
        const int res = 1 + static_cast<int>(2000 * unit(random));
        std::vector<float> cuts = {0, unit(random), unit(random), unit(random), 1};
        std::sort(cuts.begin(), cuts.end());
        std::vector<int> owners(static_cast<std::size_t>(res), 0);
        for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
            const auto span = trace::crop_span(res, cuts[i], cuts[i + 1]);
            for (int x = span.begin; x < span.end; ++x) {
                ++owners[static_cast<std::size_t>(x)];
            }
        }
        // The clamp gives every window before the first pixel's centre that pixel, and every one
        // past the last the last; in between each pixel has one owner.
        for (int x = 1; x + 1 < res; ++x) {
            EXPECT_EQ(owners[static_cast<std::size_t>(x)], 1) << res;
        }
        EXPECT_GE(owners.front(), 1);
        EXPECT_GE(owners.back(), 1);
    }
}

} // namespace
