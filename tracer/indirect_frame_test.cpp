// SPDX-License-Identifier: Apache-2.0
// Records of indirect light in other spaces, and what attributes and options say about it.
#include "tracer/indirect_frame.h"
#include "tracer/indirect_light.h"

#include <gtest/gtest.h>

namespace trace {
namespace {

IrradianceRecord some_record() {
    IrradianceRecord r;
    r.P = {1, 2, 3};
    r.N = base::normalize(base::V3f(1, 1, 0));
    r.mean = base::Color(2);
    r.rotation[0] = {0.1f, -0.2f, 0.3f};
    r.translation[0] = {0.5f, 0.25f, -0.125f};
    r.radius = 2;
    r.max_error = 0.25f;
    return r;
}

float value_at(const IrradianceRecord& record, const base::V3f& P, const base::V3f& N) {
    IrradianceCache cache;
    EXPECT_TRUE(cache.insert(record));
    const auto found = cache.lookup({P, base::normalize(N), record.max_error});
    EXPECT_TRUE(found);
    return found.value_or(base::Color(-1)).r;
}

// A point and a normal near the record, moved along with it, find the same light.
TEST(Transformed, LooksTheSameFromEverySpace) {
    const IrradianceRecord record = some_record();
    const base::V3d P(1.1, 1.9, 3.2), N(1, 0.9, 0.1);
    const float expected = value_at(record, base::V3f(P), base::V3f(N));
    const base::Mat4 turn = base::Mat4::rotate(33, {1, 2, 3});
    for (const base::Mat4& to_from :
         {turn, base::Mat4::translate({5, -6, 7}) * turn, base::Mat4::scale({3, 3, 3}) * turn,
          base::Mat4::scale({1, 1, -1}) * turn,
          base::Mat4::translate({0, 1, 0}) * base::Mat4::scale({-0.5, 0.5, 0.5}) * turn}) {
        const auto from_to = base::inverse(to_from);
        ASSERT_TRUE(from_to);
        const IrradianceRecord there = transformed(record, to_from, *from_to);
        const base::V3f P_there(base::point(to_from, P));
        const base::V3f N_there(base::normal_by_inverse(*from_to, N));
        EXPECT_NEAR(value_at(there, P_there, N_there), expected, 1e-5f);
        const IrradianceRecord back = transformed(there, *from_to, to_from);
        EXPECT_NEAR(back.radius, record.radius, 1e-5f);
        EXPECT_NEAR(base::length(back.rotation[0] - record.rotation[0]), 0, 1e-6f);
    }
}

rib::Scene scene_with(std::vector<std::pair<std::string, float>> attributes, bool shines) {
    rib::Scene scene;
    rib::ShaderCall call;
    call.name = "indirect";
    scene.shaders.push_back(call);
    rib::Light light;
    light.shader = 0;
    scene.lights.push_back(light);
    rib::Attributes state;
    if (shines) {
        state.lights = std::vector<rib::LightId>{0};
    }
    std::map<std::string, rib::Param> user;
    for (const auto& [name, value] : attributes) {
        user[name].floats = {value};
    }
    state.user = user;
    scene.attributes.push_back(state);
    return scene;
}

TEST(IndirectLight, ShinesWhereItIsOn) {
    EXPECT_FALSE(IndirectLight(scene_with({}, false)).is_used());
    const IndirectLight light(scene_with({}, true));
    EXPECT_TRUE(light.is_used());
    EXPECT_TRUE(light.interpolates());
    EXPECT_EQ(light.settings(0).num_rays, 256U);
    EXPECT_FALSE(IndirectLight(scene_with({{"indirect:nsamples", 0}}, true)).is_used());
    EXPECT_FALSE(IndirectLight(scene_with({{"indirect:maxerror", 0}}, true)).interpolates());
}

TEST(IndirectLight, AttributesOfOtherSystemsStandIn) {
    const IndirectLight other(scene_with({{"irradiance:maxerror", 0.5f}}, true));
    EXPECT_FLOAT_EQ(other.settings(0).max_error, 0.5f);
    const IndirectLight both(
        scene_with({{"irradiance:maxerror", 0.5f}, {"indirect:maxerror", 0.125f}}, true));
    EXPECT_FLOAT_EQ(both.settings(0).max_error, 0.125f);
}

TEST(IndirectLight, ValuesThatMeanNothingAreLimited) {
    const IndirectLight light(scene_with(
        {{"indirect:nsamples", 1e30f}, {"indirect:maxerror", -3}, {"indirect:maxpixeldist", -1}},
        true));
    EXPECT_EQ(light.settings(0).num_rays, 65536U);
    EXPECT_EQ(light.settings(0).max_error, 0);
    EXPECT_EQ(light.settings(0).max_pixel_distance, 0);
}

} // namespace
} // namespace trace
