// SPDX-License-Identifier: Apache-2.0
// The graphics state: blocks, options, attributes, transformations, orientation, lights, solids.
#include "ribtools/test_util.h"

#include <cmath>
#include <cstdlib>
#include <gtest/gtest.h>

namespace {

using base::V3d;
using rib_test::Reading;
using rib_test::world;

const std::string ball = "Sphere 1 -1 1 360\n";

const rib::Attributes& attributes_of(const Reading& r, std::size_t primitive) {
    return r.scene().attributes[r.scene().primitives[primitive].attributes];
}

V3d world_origin_of(const Reading& r, std::size_t primitive, V3d P = {0, 0, 0}) {
    return base::point(
        r.scene().transforms[r.scene().primitives[primitive].world_from_object].still(), P);
}

void expect_near(const V3d& a, const V3d& b) {
    // Composed in double from a handful of factors: a few units of 2^-52.
    EXPECT_NEAR(base::length(a - b), 0, 1e-12) << a.x << " " << a.y << " " << a.z;
}

// --- blocks ---

TEST(Blocks, SaveAndRestore) {
    const Reading r(world("Color 1 0 0 AttributeBegin Color 0 1 0 Translate 1 0 0 " + ball +
                          "AttributeEnd " + ball + "TransformBegin Translate 2 0 0 Color 0 0 1 " +
                          ball + "TransformEnd " + ball));
    EXPECT_EQ(r.said(), "");
    EXPECT_EQ(attributes_of(r, 0).color[1], 1);
    EXPECT_EQ(attributes_of(r, 1).color[0], 1);
    EXPECT_EQ(attributes_of(r, 3).color[2], 1);
    expect_near(world_origin_of(r, 0), {1, 0, 0});
    expect_near(world_origin_of(r, 1), {0, 0, 0});
    expect_near(world_origin_of(r, 2), {2, 0, 0});
    expect_near(world_origin_of(r, 3), {0, 0, 0});
}

TEST(Blocks, FramesRestoreOptionsAndHandles) {
    const Reading r(
        "Format 100 100 1 FrameBegin 7 Format 50 50 1 LightSource \"ambientlight\" 1\n" +
        world(ball) + "FrameEnd FrameBegin 8 Illuminate 1 1 " + world(ball) + "FrameEnd");
    ASSERT_EQ(r.backend.scenes.size(), 2u);
    EXPECT_EQ(r.backend.scenes[0]->options.xres, 50);
    EXPECT_EQ(r.backend.scenes[0]->options.frame, 7);
    EXPECT_EQ(r.backend.scenes[0]->lights.size(), 1u);
    EXPECT_EQ(r.backend.scenes[1]->options.xres, 100);
    EXPECT_EQ(r.backend.scenes[1]->lights.size(), 0u);
    EXPECT_EQ(r.code(), base::Code::BadHandle);
}

TEST(Blocks, WorldsWithoutFramesKeepOptions) {
    const Reading r("Format 30 20 1 Translate 0 0 5 " + world(ball + "Translate 1 1 1") +
                    world(ball));
    ASSERT_EQ(r.backend.scenes.size(), 2u);
    EXPECT_EQ(r.backend.scenes[1]->options.xres, 30);
    EXPECT_EQ(r.backend.scenes[1]->camera_from_world.still().m[3][2], 5);
    EXPECT_EQ(r.backend.scenes[1]->primitives.size(), 1u);
}

TEST(Blocks, OverlappingOnesAreUnwound) {
    const Reading r(
        world("Color 1 0 0 TransformBegin AttributeBegin Color 0 1 0 TransformEnd " + ball));
    EXPECT_EQ(r.code(), base::Code::Nesting);
    ASSERT_EQ(r.scene().primitives.size(), 1u);
    EXPECT_EQ(attributes_of(r, 0).color[0], 1);
}

TEST(Blocks, StrayEndsAreIgnored) {
    const Reading r("AttributeBegin " + world("AttributeEnd " + ball) + "AttributeEnd FrameEnd");
    ASSERT_EQ(r.backend.scenes.size(), 1u) << r.said();
    EXPECT_EQ(r.scene().primitives.size(), 1u);
    EXPECT_TRUE(r.said("AttributeEnd: no AttributeBegin is open")) << r.said();
    EXPECT_TRUE(r.said("FrameEnd: no FrameBegin is open"));
}

TEST(Blocks, EndOfInputClosesThem) {
    const Reading r("FrameBegin 1 WorldBegin " + ball);
    EXPECT_EQ(r.backend.scenes.size(), 0u);
    EXPECT_TRUE(r.said("the world is not rendered"));
    EXPECT_EQ(r.messages.size(), 2u);
}

TEST(Blocks, IllegalPlacesHaveTheirCodes) {
    struct Case {
        std::string text;
        base::Code code;
    };
    for (const Case& c :
         {Case{ball, base::Code::NotPrims}, Case{world("Format 1 1 1"), base::Code::NotOptions},
          Case{"AttributeBegin Format 1 1 1 AttributeEnd", base::Code::NotOptions},
          Case{"AttributeBegin " + ball + "AttributeEnd", base::Code::NotPrims},
          Case{"ObjectBegin 1 LightSource \"ambientlight\" 1 ObjectEnd", base::Code::NotAttribs},
          Case{world("WorldBegin"), base::Code::Nesting},
          Case{"FrameBegin 1 FrameBegin 2 FrameEnd", base::Code::Nesting},
          Case{world("SolidBegin \"primitive\" ObjectBegin 1 ObjectEnd SolidEnd"),
               base::Code::Nesting},
          Case{"MotionBegin [0 1] Sides 1 MotionEnd", base::Code::BadMotion},
          Case{"WorldBegin MakeShadow \"a\" \"b\" WorldEnd", base::Code::NotOptions}}) {
        const Reading r(c.text);
        ASSERT_FALSE(r.messages.empty()) << c.text;
        EXPECT_TRUE(r.said(": error: ")) << c.text;
        if (c.code != base::Code::BadMotion) { // an empty motion block has its own say
            EXPECT_NE(r.code(), base::Code::None);
        }
    }
    EXPECT_EQ(Reading(ball).code(), base::Code::NotPrims);
    EXPECT_EQ(Reading(world("Format 1 1 1")).code(), base::Code::NotOptions);
    EXPECT_EQ(Reading("ObjectBegin 1 LightSource \"a\" 1 ObjectEnd").code(),
              base::Code::NotAttribs);
}

// --- options ---

TEST(Options, ScreenWindowFollowsTheAspectWhateverTheOrder) {
    const Reading wide("Projection \"perspective\" Format 200 100 1 " + world(""));
    EXPECT_EQ(wide.scene().options.screen_window, (std::array<float, 4>{-2, 2, -1, 1}));
    const Reading tall("Format 100 200 1 " + world(""));
    EXPECT_EQ(tall.scene().options.screen_window, (std::array<float, 4>{-1, 1, -2, 2}));
    const Reading given("FrameAspectRatio 3 ScreenWindow -1 1 -2 2 " + world(""));
    EXPECT_EQ(given.scene().options.screen_window, (std::array<float, 4>{-1, 1, -2, 2}));
    const Reading aspect("FrameAspectRatio 3 " + world(""));
    EXPECT_EQ(aspect.scene().options.screen_window, (std::array<float, 4>{-3, 3, -1, 1}));
}

TEST(Options, FormatDefaults) {
    const Reading r("Format 200 -1 0 " + world(""));
    EXPECT_EQ(r.scene().options.xres, 200);
    EXPECT_EQ(r.scene().options.yres, 480);
    EXPECT_EQ(r.scene().options.pixel_aspect, 1);
}

TEST(Options, OutOfRangeValuesChangeNothing) {
    const Reading r("Clipping 5 1 Shutter 1 0 Exposure 1 0 PixelFilter \"box\" 0 0 Projection "
                    "\"perspective\" \"fov\" 0\n"
                    "CropWindow .5 .5 0 1 FrameAspectRatio 0 PixelSamples 0 0 " +
                    world(""));
    const rib::Options& o = r.scene().options;
    EXPECT_EQ(o.near_clip, rib::ri_epsilon);
    EXPECT_EQ(o.shutter_open, 0);
    EXPECT_EQ(o.gamma, 1);
    EXPECT_EQ(o.filter, "gaussian");
    EXPECT_EQ(o.fov_deg, 90);
    EXPECT_EQ(o.crop, (std::array<float, 4>{0, 1, 0, 1}));
    EXPECT_EQ(o.xsamples, 1);
    EXPECT_EQ(r.messages.size(), 7u) << r.said();
}

TEST(Options, DisplaysAddAndReplace) {
    const Reading r("Display \"a\" \"file\" \"rgb\" Display \"+b\" \"tiff\" \"z\" Display \"c\" "
                    "\"file\" \"rgba\"\n"
                    "Display \"+d\" \"exr\" \"varying color x\" " +
                    world(""));
    ASSERT_EQ(r.scene().options.displays.size(), 2u);
    EXPECT_EQ(r.scene().options.displays[0].name, "c");
    EXPECT_EQ(r.scene().options.displays[1].name, "d");
    EXPECT_EQ(r.scene().options.displays[1].mode, "varying color x");
}

TEST(Options, UnknownOnesAreKeptAndWarnedAboutOnce) {
    const Reading r(
        "Option \"limits\" \"uniform integer gridsiz\" 4 Option \"limits\" \"integer gridsiz\" 5\n"
        "Option \"user\" \"string mode\" \"x\" Option \"own\" \"thing\" [1 2] " +
        world(""));
    EXPECT_EQ(r.messages.size(), 2u) << r.said();
    EXPECT_TRUE(r.said("did you mean \"limits gridsize\""));
    EXPECT_EQ(r.scene().options.user.at("limits:gridsiz").ints.front(), 5);
    EXPECT_EQ(r.scene().options.user.at("own:thing").floats.size(), 2u);
    EXPECT_EQ(r.scene().options.user.at("user:mode").strings.front(), "x");
}

TEST(Options, SearchPaths) {
    rib::Config config;
    config.default_paths["shader"] = {"/std"};
    const Reading r(
        "Option \"searchpath\" \"shader\" \"a:b:&\" Option \"searchpath\" \"shader\" \"c:&:@\"\n"
        "Option \"searchpath\" \"string include\" \"$PERIGEE_NOT_SET/x;y::\" " +
            world(""),
        config);
    EXPECT_EQ(r.scene().options.search_paths.at("shader"),
              (std::vector<std::string>{"c", "a", "b", "/std", "/std"}));
    EXPECT_EQ(r.scene().options.search_paths.at("archive"), (std::vector<std::string>{"/x", "y"}));
}

// Every kind of path knows &, @ and escapes.
TEST(Options, SearchPathsOfAllKinds) {
    for (const std::string kind :
         {"shader", "texture", "archive", "procedural", "display", "resource"}) {
        rib::Config config;
        config.default_paths[kind] = {"/std"};
        const Reading r("Option \"searchpath\" \"" + kind + "\" \"&:mine\" " +
                            "Option \"searchpath\" \"" + kind +
                            "\" [\"&:a\\\\:b;~/c\" \"@:x\\\\$y%PERIGEE_NOT_SET%\"] " + world(""),
                        config);
        const std::string home = std::getenv("HOME") ? std::getenv("HOME") : "";
        EXPECT_EQ(r.scene().options.search_paths.at(kind),
                  (std::vector<std::string>{"/std", "mine", "a:b", home + "/c", "/std", "x$y"}))
            << kind;
    }
}

// A backend that notes which shaders it hears of.
struct Listener : rib::Backend {
    std::vector<std::string> heard;
    void shader_named(const rib::ShaderCall& call, rib::ShaderRole role) override {
        std::string text = call.name + std::to_string(static_cast<int>(role));
        for (const std::string& directory : *call.search_path) {
            text += " " + directory;
        }
        heard.push_back(text);
    }
    bool render(std::unique_ptr<rib::Scene>) override { return true; }
    bool make_texture(const rib::TextureRequest&) override { return true; }
};

TEST(Shaders, AreAnnouncedWithThePathThatHolds) {
    std::FILE* null = std::fopen("/dev/null", "w");
    base::Diag diag(null);
    Listener listener;
    rib::Config config;
    config.default_paths["shader"] = {"std"};
    config.wants_world = [](const rib::Options& o) { return o.frame != 2; };
    rib::Reader reader(listener, diag, config);
    (void)reader.read_text(
        "Imager \"i\" Surface \"s\" "
        "Option \"searchpath\" \"shader\" \"mine:&\" "
        "FrameBegin 1 WorldBegin LightSource \"l\" 1 Surface \"s\" Surface \"s\" "
        "Displacement \"d\" Atmosphere \"null\" WorldEnd FrameEnd "
        "FrameBegin 2 Surface \"unwanted\" WorldBegin Surface \"unwanted\" "
        "WorldEnd FrameEnd",
        "test");
    EXPECT_EQ(listener.heard, (std::vector<std::string>{"i6 std", "s0 std", "l5 mine std",
                                                        "s0 mine std", "d1 mine std"}));
    std::fclose(null);
}

TEST(Options, CommandLineDefaultsAndOverrides) {
    rib::Config config;
    config.defaults.xres = 64;
    config.defaults.xsamples = 1;
    config.override_options = [](rib::Options& o) { o.crop = {0, .5f, 0, .5f}; };
    config.wants_world = [](const rib::Options& o) { return o.frame == 2; };
    const Reading r("PixelSamples 3 3 FrameBegin 1 " + world(ball) +
                        "FrameEnd FrameBegin 2 CropWindow 0 1 0 1 " + world(ball) + "FrameEnd",
                    config);
    ASSERT_EQ(r.backend.scenes.size(), 1u);
    EXPECT_EQ(r.scene().options.xres, 64);
    EXPECT_EQ(r.scene().options.xsamples, 3);
    EXPECT_EQ(r.scene().options.crop[1], .5f);
    EXPECT_EQ(r.scene().primitives.size(), 1u);
}

TEST(Options, BackendCanStopTheReader) {
    std::FILE* null = std::fopen("/dev/null", "w");
    base::Diag diag(null);
    rib_test::Collector backend;
    backend.keep_going = false;
    rib::Reader reader(backend, diag, {});
    EXPECT_EQ(reader.read_text(world("") + world(""), "t"), rib::ReadStatus::Stopped);
    EXPECT_EQ(backend.scenes.size(), 1u);
    EXPECT_EQ(reader.read_file("/nonexistent.rib"), rib::ReadStatus::Environment);
    std::fclose(null);
}

TEST(Options, AbortHandlerEndsTheRun) {
    const Reading r("ErrorHandler \"abort\" Nonsense " + world(""));
    EXPECT_EQ(r.status, rib::ReadStatus::Stopped);
    EXPECT_EQ(r.backend.scenes.size(), 0u);
}

// --- transformations ---

TEST(Transforms, LaterRequestsApplyFirst) {
    const Reading r(world("Translate 0 0 5 Rotate 90 0 0 1 Scale 2 1 1 " + ball));
    expect_near(world_origin_of(r, 0, {1, 0, 0}), {0, 2, 5});
}

TEST(Transforms, CameraAndWorld) {
    // Before WorldBegin: camera from world. Identity goes back to camera space, inside to world
    // space.
    const Reading r("Projection \"perspective\" Translate 9 9 9 Identity Translate 0 0 5\n" +
                    world("Translate 1 0 0 Identity Translate 0 1 0 " + ball +
                          "Transform [1 0 0 0 0 1 0 0 0 0 1 0 3 0 0 1] " + ball));
    EXPECT_EQ(r.scene().camera_from_world.still().m[3][0], 0);
    EXPECT_EQ(r.scene().camera_from_world.still().m[3][2], 5);
    expect_near(world_origin_of(r, 0), {0, 1, 0});
    expect_near(world_origin_of(r, 1), {3, 0, 0});
}

TEST(Transforms, BeforeProjectionActsOnTheScreen) {
    const Reading r("Scale 2 2 1 Projection \"orthographic\" Translate 0 0 1 " + world(""));
    EXPECT_EQ(r.scene().screen_from_camera_extra.m[0][0], 2);
    EXPECT_EQ(r.scene().camera_from_world.still().m[0][0], 1);
}

TEST(Transforms, NamedSystems) {
    const Reading r("Translate 0 0 10 CoordinateSystem \"eye5\"\n" +
                    world("TransformBegin Translate 1 2 3 CoordinateSystem \"here\" TransformEnd "
                          "CoordSysTransform "
                          "\"here\" " +
                          ball + "CoordSysTransform \"camera\" " + ball +
                          "CoordSysTransform \"world\" " + ball + "CoordSysTransform \"eye5\" " +
                          ball + "CoordSysTransform \"nowhere\" " + ball));
    expect_near(world_origin_of(r, 0), {1, 2, 3});
    expect_near(world_origin_of(r, 1), {0, 0, -10}); // the eye, seen from the world
    expect_near(world_origin_of(r, 2), {0, 0, 0});
    expect_near(world_origin_of(r, 3),
                {0, 0, 0}); // camera-from-named was Translate 0 0 10, as was the world
    expect_near(world_origin_of(r, 4), {0, 0, 0}); // unknown: unchanged
    EXPECT_EQ(r.messages.size(), 1u);
}

TEST(Transforms, RasterAndScreenSystems) {
    const Reading r("Format 200 100 1 Projection \"perspective\" \"fov\" 90 Clipping 1 100\n" +
                    world("CoordSysTransform \"raster\" " + ball + "CoordSysTransform \"NDC\" " +
                          ball + "CoordSysTransform \"screen\" " + ball));
    // Raster (0,0), on the near plane: the upper left corner of the frame at z = 1.
    expect_near(world_origin_of(r, 0, {0, 0, 0}), {-2, 1, 1});
    expect_near(world_origin_of(r, 1, {1, 1, 0}), {2, -1, 1});
    expect_near(world_origin_of(r, 2, {.5, .5, 0}), {.5, .5, 1});
}

TEST(Transforms, DegenerateOnesAreReported) {
    const Reading r(world("Rotate 90 0 0 0 Skew 0 1 0 0 1 0 0 Perspective 0 " + ball +
                          "Scale 1e200 1 1 Scale 1e200 1 1 " + ball));
    EXPECT_EQ(r.messages.size(), 4u) << r.said();
    EXPECT_EQ(r.code(), base::Code::Math);
    expect_near(world_origin_of(r, 0, {1, 1, 1}), {1, 1, 1});
}

// --- orientation, ri.md 8.6 ---

bool outside(const std::string& before_world, const std::string& body) {
    const Reading r(before_world + world(body + " Sphere 1 -1 1 360"));
    EXPECT_EQ(r.said(), "");
    return r.scene().attributes[r.scene().primitives[0].attributes].orientation_matches;
}

TEST(Orientation, FollowsTheCoordinateSystem) {
    EXPECT_TRUE(outside("", ""));
    EXPECT_TRUE(outside("", "Scale 1 1 -1"));
    EXPECT_TRUE(outside("Scale 1 1 -1 ", ""));
    EXPECT_FALSE(outside("", "Orientation \"inside\""));
    EXPECT_FALSE(outside("", "Orientation \"inside\" Scale -1 1 1"));
    EXPECT_FALSE(outside("", "ReverseOrientation"));
    EXPECT_TRUE(outside("ReverseOrientation ", "ReverseOrientation"));
}

TEST(Orientation, ExplicitHandednessIsComparedWithTheSystem) {
    EXPECT_TRUE(outside("", "Orientation \"lh\""));
    EXPECT_FALSE(outside("", "Orientation \"rh\""));
    EXPECT_TRUE(outside("Scale 1 1 -1 ", "Orientation \"rh\""));
    EXPECT_FALSE(outside("Scale 1 1 -1 ", "Orientation \"lh\""));
    EXPECT_TRUE(outside("Scale 1 1 -1 ", "Scale 1 -1 1 Orientation \"lh\""));
    // A later mirror flips both, so the bit stays.
    EXPECT_FALSE(outside("", "Orientation \"rh\" Scale 1 1 -1"));
    // Replacing the matrix leaves the bit unchanged as well.
    EXPECT_FALSE(outside("", "Scale -1 1 1 Orientation \"lh\" Identity"));
}

// --- shared records ---

TEST(Sharing, EqualStatesShareOneRecord) {
    std::string body;
    for (int i = 0; i < 100; ++i) {
        body += "AttributeBegin Surface \"plastic\" Color 1 " + std::to_string(i % 2) + " 0 " +
                ball + "AttributeEnd ";
    }
    const Reading r(world(body));
    EXPECT_EQ(r.scene().primitives.size(), 100u);
    EXPECT_EQ(r.scene().attributes.size(), 2u);
    EXPECT_EQ(r.scene().shaders.size(), 1u);
    EXPECT_EQ(r.scene().transforms.size(), 1u);
}

TEST(Sharing, ShadersInDifferentSpacesKnowTheirTwin) {
    const Reading r(world("Surface \"a\" \"Kd\" 1 " + ball +
                          "Translate 1 0 0 Surface \"a\" \"Kd\" 1 " + ball +
                          "Surface \"a\" \"Kd\" 2 " + ball));
    ASSERT_EQ(r.scene().shaders.size(), 3u);
    EXPECT_EQ(r.scene().shaders[1].same_params_as, 0u);
    EXPECT_EQ(r.scene().shaders[2].same_params_as, 2u);
}

TEST(Sharing, EditsDoNotReachEarlierCopies) {
    const Reading r(world("Attribute \"user\" \"float a\" 1 " + ball +
                          "AttributeBegin Attribute \"user\" \"float a\" 2 " + ball +
                          "AttributeEnd " + ball));
    EXPECT_EQ(attributes_of(r, 0).find("user:a")->floats[0], 1);
    EXPECT_EQ(attributes_of(r, 1).find("user:a")->floats[0], 2);
    EXPECT_EQ(attributes_of(r, 2).find("user:a")->floats[0], 1);
}

// --- attributes and lights ---

TEST(Attributes, BadValuesChangeNothing) {
    const Reading r(world("Sides 3 ShadingRate 0 ShadingInterpolation \"flat\" Orientation \"up\" "
                          "Basis \"nurbs\" 1 \"bezier\" 3\n"
                          "DetailRange 3 2 1 0 Opacity 2 2 2 " +
                          ball));
    const rib::Attributes& a = attributes_of(r, 0);
    EXPECT_EQ(r.messages.size(), 7u) << r.said();
    EXPECT_EQ(a.sides, 2);
    EXPECT_EQ(a.shading_rate, 1);
    EXPECT_EQ(a.basis->ustep, 3);
    EXPECT_EQ(a.opacity, (std::array<float, 3>{1, 1, 1}));
}

TEST(Attributes, DetailIsMeasuredInPixels) {
    // Perspective, fov 90, 200x100 pixels: 50 pixels a unit at z = 1, 5 at z = 10. A 2x2 square at
    // z = 10.
    const Reading r("Format 200 100 1 Projection \"perspective\" \"fov\" 90 RelativeDetail 3\n" +
                    world("Detail -1 1 -1 1 10 10 " + ball));
    EXPECT_NEAR(attributes_of(r, 0).detail_area_px, 3 * 100.0f,
                1e-3f); // float result of a double computation
}

TEST(Lights, SpaceAndScope) {
    const Reading r("LightSource \"distantlight\" 1 Translate 0 0 5\n" +
                    world("AttributeBegin LightSource \"pointlight\" 2 " + ball + "AttributeEnd " +
                          ball + "Illuminate 2 1 Illuminate 1 0 " + ball));
    EXPECT_EQ(r.said(), "");
    EXPECT_TRUE(r.scene().lights[0].in_camera_space);
    EXPECT_FALSE(r.scene().lights[1].in_camera_space);
    EXPECT_EQ(attributes_of(r, 0).lights.get(), (std::vector<rib::LightId>{0, 1}));
    EXPECT_EQ(attributes_of(r, 1).lights.get(), (std::vector<rib::LightId>{0}));
    EXPECT_EQ(attributes_of(r, 2).lights.get(), (std::vector<rib::LightId>{1}));
}

TEST(Lights, AreaLightsListTheirGeometry) {
    const Reading r(
        "ObjectBegin 1 " + ball + ball + "ObjectEnd " +
        world("AttributeBegin Attribute \"light\" \"nsamples\" 4 AreaLightSource \"area\" 5 " +
              ball + "ObjectInstance 1 AttributeEnd " + ball));
    EXPECT_EQ(r.said(), "");
    const rib::Light& light = r.scene().lights.at(0);
    EXPECT_TRUE(light.is_area);
    EXPECT_EQ(light.area_primitives, (std::vector<std::uint32_t>{0, 1, 2}));
    EXPECT_EQ(r.scene().attributes[light.attributes].find("light:nsamples")->ints[0], 4);
    EXPECT_EQ(attributes_of(r, 3).area_light, rib::none);
}

TEST(Lights, ReusedHandlesMeanTheNewLight) {
    const Reading r(world("LightSource \"a\" 1 LightSource \"b\" 1 Illuminate 1 0 " + ball));
    EXPECT_EQ(attributes_of(r, 0).lights.get(), (std::vector<rib::LightId>{0}));
}

TEST(Shaders, PlacedBeforeTheWorldMoveIntoIt) {
    const Reading r("Translate 0 0 2 Surface \"a\" Translate 0 0 3 " + world(ball));
    const rib::ShaderCall& s = r.scene().shaders[attributes_of(r, 0).surface];
    // Shader space lies 2 before the camera, the world's origin 5.
    expect_near(base::point(r.scene().transforms[s.world_from_shader].still(), {0, 0, 0}),
                {0, 0, -3});
}

// --- solids ---

TEST(Solids, FormATree) {
    const Reading r(world("SolidBegin \"difference\" SolidBegin \"primitive\" " + ball + ball +
                          "SolidEnd AttributeBegin "
                          "SolidBegin \"union\" " +
                          ball + "SolidEnd AttributeEnd SolidEnd " + ball));
    EXPECT_EQ(r.said(), "");
    const auto& solids = r.scene().solids;
    ASSERT_EQ(solids.size(), 4u); // the ball in the union is a solid of its own
    EXPECT_EQ(solids[0].op, rib::SolidOp::Difference);
    EXPECT_EQ(solids[1].parent, 0u);
    EXPECT_EQ(solids[3].parent, 2u);
    EXPECT_EQ(r.scene().primitives[1].solid, 1u);
    EXPECT_EQ(r.scene().primitives[2].solid, 3u);
    EXPECT_EQ(r.scene().primitives[3].solid, rib::none);
}

TEST(Solids, BadNestingIsReported) {
    EXPECT_EQ(Reading(world("SolidBegin \"primitive\" SolidBegin \"primitive\" SolidEnd SolidEnd"))
                  .code(),
              base::Code::BadSolid);
    EXPECT_EQ(Reading(world("SolidBegin \"difference\" SolidBegin \"primitive\" SolidEnd SolidEnd"))
                  .code(),
              base::Code::BadSolid);
}

// --- resources ---

TEST(Resources, SaveAndRestoreAttributes) {
    const Reading r(world("Color 1 0 0 Resource \"red\" \"attributes\" \"string operation\" "
                          "\"save\" Color 0 1 0 Sides 1\n"
                          "Resource \"red\" \"attributes\" \"string operation\" \"restore\" "
                          "\"string subset\" \"shading\" " +
                          ball +
                          "Resource \"blue\" \"attributes\" \"string operation\" \"restore\""));
    EXPECT_EQ(attributes_of(r, 0).color[0], 1);
    EXPECT_EQ(attributes_of(r, 0).sides, 1);
    EXPECT_EQ(r.code(), base::Code::BadHandle);
}

} // namespace
