// SPDX-License-Identifier: Apache-2.0
#include "tracer/camera.h"
#include "tracer/spaces.h"

#include <gtest/gtest.h>

namespace trace {
namespace {

class NamedSpaces : public ::testing::Test {
protected:
    NamedSpaces() {
        scene.options.xres = 200;
        scene.options.yres = 100;
        scene.options.projection = "perspective";
        scene.options.fov_deg = 90;
        scene.options.near_clip = 1;
        scene.options.far_clip = 100;
        scene.options.has_screen_window = true;
        scene.options.screen_window = {-2, 2, -1, 1};
        scene.camera_from_world.keys = {
            {0, base::Mat4::translate({0, 0, 5}) * base::Mat4::rotate(30, {0, 1, 0})}};
        scene.transforms.push_back(
            {{{0, base::Mat4::translate({1, 2, 3}) * base::Mat4::scale({2, 2, -2})}}});
        scene.coordinate_systems["desk"] = 0;
    }
    [[nodiscard]] Spaces spaces() {
        const Camera camera(scene, diag);
        return {
            scene,
            {camera.screen_from_camera(), camera.ndc_from_screen(), camera.raster_from_screen()}};
    }
    static void expect_point(const base::V3d& a, const base::V3d& b) {
        // Double arithmetic on values of this size.
        EXPECT_NEAR(a.x, b.x, 1e-9);
        EXPECT_NEAR(a.y, b.y, 1e-9);
        EXPECT_NEAR(a.z, b.z, 1e-9);
    }
    rib::Scene scene;
    base::Diag diag{std::tmpfile()};
};

TEST_F(NamedSpaces, RoundTrips) {
    const Spaces all = spaces();
    for (const char* name :
         {"current", "camera", "eye", "world", "screen", "NDC", "raster", "desk"}) {
        const Space* space = all.find(name);
        ASSERT_NE(space, nullptr) << name;
        const base::V3d P(0.3, -0.4, 7);
        expect_point(
            base::point(space->camera_from_space, base::point(space->space_from_camera, P)), P);
    }
    EXPECT_EQ(all.find("nowhere"), nullptr);
}

TEST_F(NamedSpaces, TheImagePlane) {
    const Spaces all = spaces();
    const base::V3d P(
        2, 1, 2); // on the frame's right edge, half way up its upper half; fov 90: screen = x/z
    expect_point(base::point(all.find("screen")->space_from_camera, P),
                 {1, 0.5, 100 * (2.0 - 1) / (2 * 99)});
    const base::V3d ndc = base::point(all.find("NDC")->space_from_camera, P);
    EXPECT_NEAR(ndc.x, 0.75, 1e-12);
    EXPECT_NEAR(ndc.y, 0.25, 1e-12);
    const base::V3d raster = base::point(all.find("raster")->space_from_camera, P);
    EXPECT_NEAR(raster.x, 150, 1e-9);
    EXPECT_NEAR(raster.y, 25, 1e-9);
}

TEST_F(NamedSpaces, UserSystemsHangOnTheWorld) {
    const Spaces all = spaces();
    const base::V3d in_world = base::V3d(1, 2, 3) + base::V3d(2, 0, 0);
    expect_point(all.find("desk")->point_to_camera({1, 0, 0}),
                 base::point(all.camera_from_world(), in_world));
}

TEST_F(NamedSpaces, ScopedSystemsComeFirst) {
    scene.transforms.push_back({{{0, base::Mat4::translate({9, 0, 0})}}});
    rib::Attributes scoped;
    scoped.scoped_systems.edit()["desk"] = 1;
    scene.attributes.push_back(scoped);
    const Spaces all = spaces();
    EXPECT_NE(all.find("desk", &scene.attributes[0]), all.find("desk"));
    expect_point(all.find("desk", &scene.attributes[0])->point_to_camera({0, 0, 0}),
                 base::point(all.camera_from_world(), {9, 0, 0}));
}

TEST_F(NamedSpaces, SystemsThatCannotBeInvertedAreUnknown) {
    scene.transforms.push_back({{{0, base::Mat4::scale({1, 0, 1})}}});
    scene.coordinate_systems["flat"] = 1;
    EXPECT_EQ(spaces().find("flat"), nullptr);
}

// An open frustum, as without Clipping: 38 decades of depth must not spoil raster space.
TEST_F(NamedSpaces, DefaultClippingKeepsRasterSpace) {
    scene.options.near_clip = rib::ri_epsilon;
    scene.options.far_clip = rib::ri_infinity;
    const Spaces all = spaces();
    ASSERT_NE(all.find("raster"), nullptr);
    const base::V3d raster = base::point(all.find("raster")->space_from_camera, {2, 1, 2});
    EXPECT_NEAR(raster.x, 150, 1e-9);
}

} // namespace
} // namespace trace
