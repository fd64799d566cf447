// SPDX-License-Identifier: Apache-2.0
// Shading, lights, visibility and imagers against closed forms, on sheets and hand-written shaders
// (test_world.h). Float results are compared to 2e-6 relative: a dozen float roundings.
#include "tracer/lights.h"
#include "tracer/test_frame.h"

#include <cmath>
#include <gtest/gtest.h>

namespace trace {
namespace {

constexpr float tolerance = 2e-6f;

class Shading : public ::testing::Test, protected test::TestFrame {
protected:
    template <class Expected> void expect_red(const Image& image, Expected expected) {
        for (std::size_t i = 0; i < 256; ++i) {
            const auto want = static_cast<double>(expected(x_of(i), y_of(i)));
            EXPECT_NEAR(image.plane(Plane::R)[i], want,
                        static_cast<double>(tolerance) * std::max(1.0, std::fabs(want)))
                << "pixel " << i;
        }
    }
};

// --- lights

TEST_F(Shading, AmbientCountsWhereNothingIsDirectional) {
    const auto a = light(shader("ambient", {floats("intensity", rib::ParamType::Float, {0.25f})}));
    const auto b = light(shader("ambient", {floats("intensity", rib::ParamType::Float, {0.5f})}));
    lit_sheet(1, shader("lit"), {a, b});
    expect_red(render(), [](float, float) { return 0.75f; });
}

TEST_F(Shading, PointLightFallsOffWithTheSquare) {
    const auto id = light(shader("point", {floats("intensity", rib::ParamType::Float, {4}),
                                           floats("from", rib::ParamType::Point, {0, 0, 1})}));
    lit_sheet(3, shader("lit"), {id});
    // The light is 2 above the sheet: cos = 2/d, Cl = 4/d^2.
    expect_red(render(), [](float x, float y) {
        const double d2 = static_cast<double>(x * x + y * y) + 4;
        return 4 / d2 * 2 / std::sqrt(d2);
    });
    EXPECT_GT(counters.get(Counter::light_reused), 0U)
        << "the second loop asks for the same points";
}

TEST_F(Shading, DistantLightShinesAlongItsAxisAndNotFromBehind) {
    const auto front = light(shader("distant", {floats("to", rib::ParamType::Point, {0, 3, 4})}));
    const auto behind = light(shader("distant", {floats("to", rib::ParamType::Point, {0, 0, -1})}));
    lit_sheet(1, shader("lit"), {front, behind});
    expect_red(render(), [](float, float) { return 0.8f; });
}

TEST_F(Shading, ConesEndAtTheirAngle) {
    const float angle = 0.3f;
    const auto id = light(shader("cone", {floats("angle", rib::ParamType::Float, {angle}),
                                          floats("from", rib::ParamType::Point, {0, 0, 0}),
                                          floats("to", rib::ParamType::Point, {0, 0, 5})}));
    lit_sheet(2, shader("lit"), {id});
    expect_red(render(), [&](float x, float y) {
        const double d2 = static_cast<double>(x * x + y * y) + 4;
        const double cosine = 2 / std::sqrt(d2);
        return cosine >= std::cos(static_cast<double>(angle)) ? cosine / d2 : 0;
    });
}

TEST_F(Shading, LightParametersLieInTheSpaceOfTheirCall) {
    // Shader space is shifted by (0,0,1): the default from (0,0,0) and a written from are both at z
    // = 1.
    const base::Mat4 shifted = base::Mat4::translate({0, 0, 1});
    const auto by_default = light(shader("point", {}, shifted));
    const auto by_value =
        light(shader("point", {floats("from", rib::ParamType::Point, {0, 0, 0})}, shifted));
    lit_sheet(3, shader("lit"), {by_default, by_value});
    expect_red(render(), [](float x, float y) {
        const double d2 = static_cast<double>(x * x + y * y) + 4;
        return 2 / d2 * 2 / std::sqrt(d2);
    });
}

TEST_F(Shading, NonDiffuseLightsAreLeftOutAndListsAreObeyed) {
    const auto on = light(shader("distant"));
    const auto half =
        light(shader("distant", {floats("__nondiffuse", rib::ParamType::Float, {0.75f})}));
    light(shader("distant", {floats("intensity", rib::ParamType::Float, {100})})); // in no list
    lit_sheet(1, shader("lit"), {on, half});
    expect_red(render(), [](float, float) { return 1.25f; });
}

TEST_F(Shading, CategoriesSelectLights) {
    const auto key = light(shader("distant", {text("__category", "key, warm")}));
    const auto fill = light(shader(
        "distant", {floats("intensity", rib::ParamType::Float, {10}), text("__category", "fill")}));
    const auto none = light(shader("distant", {floats("intensity", rib::ParamType::Float, {100})}));
    const std::vector<rib::LightId> all = {key, fill, none};
    lit_sheet(1, shader("lit", {text("category", "warm")}), all);
    expect_red(render(), [](float, float) { return 1.0f; });
    scene.attributes[0].surface = shader("lit", {text("category", "-warm")});
    expect_red(render(), [](float, float) { return 110.0f; });
    scene.attributes[0].surface = shader("lit");
    expect_red(render(), [](float, float) { return 111.0f; });
    EXPECT_FALSE(in_category({}, "a"));
    EXPECT_TRUE(in_category({}, "-a"));
}

TEST_F(Shading, ShadowsOnlyWhereTheAttributeSaysSo) {
    rib::Attributes shadowed;
    shadowed.user.edit()["light:shadows"] = text("shadows", "on");
    scene.attributes.push_back(shadowed);
    const std::vector<rib::Param> from = {floats("from", rib::ParamType::Point, {0, 0, 1})};
    const auto with = light(shader("point", from), 0);
    const auto without = light(shader("point", from));
    lit_sheet(3, shader("lit"), {with, without});
    // An occluder between light and sheet that the camera does not see: half way, so its shadow is
    // twice its size.
    sheet(2, shader("flat"));
    sheets.back().half_width = 0.25f;
    scene.options.near_clip = 2.5f;
    expect_red(render(), [](float x, float y) {
        const double d2 = static_cast<double>(x * x + y * y) + 4;
        const bool hidden = std::fabs(x) < 0.5f && std::fabs(y) < 0.5f;
        return (hidden ? 1 : 2) / d2 * 2 / std::sqrt(d2);
    });
    EXPECT_EQ(counters.get(Counter::rays_shadow), 256U)
        << "one ray per point, though the light was asked twice";
}

// --- visibility

TEST_F(Shading, TransparentSheetsStackInDepthOrder) {
    const auto flat = shader("flat");
    sheet(1, flat);
    sheet(3, flat);
    sheet(2, flat);
    const float color[] = {1, 0.5f, 0.25f}, opacity[] = {0.5f, 1, 0.25f};
    for (std::size_t i = 0; i < 3; ++i) {
        scene.attributes[i].color = grey(color[i]);
        scene.attributes[i].opacity = grey(opacity[i]);
    }
    const Image image = render();
    // .5*1 + .5*(.25*.25 + .75*1*.5)
    expect_red(image, [](float, float) { return 0.5f + 0.5f * (0.0625f + 0.75f * 0.5f); });
    EXPECT_NEAR(image.plane(Plane::A)[7], 1, 1e-6);
    EXPECT_EQ(counters.get(Counter::rays_behind), 512U);
    EXPECT_NEAR(image.plane(Plane::Z)[7], 3, 1e-5) << "depth of the first opaque surface";
}

TEST_F(Shading, MatteHidesAndShowsNothing) {
    const auto flat = shader("flat");
    sheet(1, flat).matte = 1;
    sheets.back().half_width = 0.5f;
    sheet(2, flat);
    const Image image = render();
    for (std::size_t i = 0; i < 256; ++i) {
        const float want = std::fabs(x_of(i)) < 0.5f && std::fabs(y_of(i)) < 0.5f ? 0.0f : 1.0f;
        EXPECT_EQ(image.plane(Plane::R)[i], want);
        EXPECT_EQ(image.plane(Plane::A)[i], want);
    }
}

TEST_F(Shading, UnassignedResultsAreTheAttributes) {
    rib::Attributes& attributes = sheet(1, shader("unset"));
    attributes.color = {0.1f, 0.2f, 0.3f};
    attributes.opacity = {1, 1, 1};
    const Image image = render();
    EXPECT_EQ(image.plane(Plane::G)[100], 0.2f);
    EXPECT_EQ(image.plane(Plane::A)[100], 1.0f);
}

TEST_F(Shading, WhatIsNoNumberNeverReachesThePicture) {
    sheet(1, shader("bad"));
    const Image image = render();
    for (std::size_t i = 0; i < 256; ++i) {
        EXPECT_EQ(image.plane(Plane::R)[i], x_of(i) > 0 ? 0.0f : 1.0f);
    }
    EXPECT_EQ(counters.get(Counter::bad_values), 128U);
    EXPECT_EQ(diag.count(base::Severity::Warning), 1U) << "one message per shader";
}

TEST_F(Shading, MissingSurfacesGetTheDefaultOne) {
    sheet(1, rib::none);
    const Image image = render();
    // Orthographic rays meet the sheet squarely: Ka + Kd.
    EXPECT_NEAR(image.plane(Plane::R)[17], 1, 1e-6);
    scene.attributes[0].surface = shader("nosuchshader");
    EXPECT_NEAR(render().plane(Plane::R)[17], 1, 1e-6);
    EXPECT_EQ(diag.count(base::Severity::Error), 1U);
}

TEST_F(Shading, AtmosphereFollowsTheSurface) {
    rib::Attributes& attributes = sheet(4, shader("flat"));
    attributes.color = grey(0.5f);
    scene.attributes[0].atmosphere = shader("haze");
    expect_red(render(), [](float, float) { return 0.5f * 0.6f + 0.4f; });
    EXPECT_EQ(counters.get(Counter::points_volume), 256U);
}

// --- batches

TEST_F(Shading, PrimitiveVariablesReplaceParameters) {
    const auto tint = shader("tint", {floats("tint", rib::ParamType::Color, {0.5f, 0.5f, 0.5f})});
    sheet(1, tint);
    const auto bind = [&](std::vector<rib::Param> variables) {
        sheets[0].variables.clear();
        scene.primitives[0].params.params = variables;
        for (rib::Param& variable : variables) {
            sheets[0].variables[variable.name] = variable;
        }
    };
    expect_red(render(), [](float, float) { return 0.5f; });
    bind({floats("tint", rib::ParamType::Color, {0.25f, 0, 0}, rib::StorageClass::Constant)});
    expect_red(render(), [](float, float) { return 0.25f; });
    bind({floats("scale", rib::ParamType::Float, {3}, rib::StorageClass::Varying)});
    expect_red(render(), [](float x, float) { return 1.5f * x; });
    bind({floats("tint", rib::ParamType::Color, {2, 0, 0}, rib::StorageClass::Varying)});
    expect_red(render(), [](float x, float) { return 2 * x; });
    EXPECT_EQ(counters.get(Counter::batches), 16U) << "one batch per value";
    bind({floats("tint", rib::ParamType::Float, {2},
                 rib::StorageClass::Constant)}); // another type: ignored
    expect_red(render(), [](float, float) { return 0.5f; });
}

TEST_F(Shading, BatchesOfObjectSpaceHoldOneObject) {
    const auto spaces = shader("spaces");
    for (int i = 0; i < 2; ++i) {
        sheet(static_cast<float>(i + 1), spaces);
        sheets.back().camera_from_object = base::Mat4::translate({i == 0 ? 1.0 : -5.0, 0, 0});
    }
    sheets[0].half_width = 0.5f;
    expect_red(render(), [](float x, float y) {
        const bool near = std::fabs(x) < 0.5f && std::fabs(y) < 0.5f;
        return near ? x - 1 : x + 5;
    });
    EXPECT_EQ(counters.get(Counter::batches), 2U);
}

TEST_F(Shading, EqualCallsShareBatches) {
    // Two attribute states with different colours, one shader: one batch.
    const auto flat = shader("flat");
    sheet(1, flat).color = grey(0.25f);
    sheets.back().half_width = 0.5f;
    sheet(2, flat).color = grey(0.5f);
    expect_red(render(), [](float x, float y) {
        return std::fabs(x) < 0.5f && std::fabs(y) < 0.5f ? 0.25f : 0.5f;
    });
    EXPECT_EQ(counters.get(Counter::batches), 1U);
    EXPECT_EQ(counters.get(Counter::lanes_live), 256U);
}

TEST_F(Shading, SameBytesWhateverThreadsAndBuckets) {
    scene.options.xsamples = scene.options.ysamples = 3;
    scene.options.hider_params.params.clear();
    scene.options.filter = "gaussian";
    scene.options.filter_width[0] = scene.options.filter_width[1] = 2;
    const auto id = light(shader("point", {floats("intensity", rib::ParamType::Float, {4})}));
    sheet(1, shader("flat")).opacity = grey(0.3f);
    sheets.back().half_width = 0.7f;
    lit_sheet(3, shader("lit"), {id});
    const Image reference = render();
    for (const int threads : {1, 2, 5}) {
        for (const int bucket_px : {16, 5}) {
            const Image image = render(threads, bucket_px);
            for (std::size_t p = 0; p < image.planes.size(); ++p) {
                EXPECT_EQ(image.planes[p], reference.planes[p])
                    << threads << " threads, buckets of " << bucket_px;
            }
        }
    }
}

// --- imager

TEST_F(Shading, ImagersRunOnEveryPixel) {
    sheet(1, shader("flat"));
    sheets.back().half_width = 0.5f;
    scene.options.imager = shader("invert");
    const Image image = render();
    expect_red(image, [](float x, float y) {
        return std::fabs(x) < 0.5f && std::fabs(y) < 0.5f ? 0.0f : 1.0f;
    });
    EXPECT_EQ(image.plane(Plane::A)[0], 0.25f);
    EXPECT_EQ(image.plane(Plane::A)[8 * 16 + 8], 1.25f);
    EXPECT_EQ(image.plane(Plane::OR)[18], 2.5f) << "P is the raster position of the pixel centre";
    EXPECT_EQ(image.plane(Plane::OG)[18], 1.5f);
    EXPECT_EQ(counters.get(Counter::points_imager), 256U);
}

} // namespace
} // namespace trace
