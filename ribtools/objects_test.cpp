// SPDX-License-Identifier: Apache-2.0
// Objects and instances, motion blocks, archives, conditionals.
#include "ribtools/scene_dump.h"
#include "ribtools/test_util.h"
#include "runtime/base/temp_dir.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>

namespace {

using base::V3d;
using rib_test::Reading;
using rib_test::world;

const std::string ball = "Sphere 1 -1 1 360\n";

// --- objects, ri.md 12.2 ---

TEST(Objects, InstancesTakeTheAttributesInForce) {
    const Reading r(
        "Color 0 0 1 ObjectBegin 1 Translate 1 0 0 " + ball + "ObjectEnd " +
        world("Color 1 0 0 Translate 0 0 5 ObjectInstance 1 Color 0 1 0 ObjectInstance \"1\""));
    EXPECT_EQ(r.said(), "");
    const rib::Scene& s = r.scene();
    ASSERT_EQ(s.instances.size(), 2u);
    ASSERT_EQ(s.objects[0].primitives.size(), 1u);
    EXPECT_EQ(s.attributes[s.instances[0].attributes[0]].color, (std::array<float, 3>{1, 0, 0}));
    EXPECT_EQ(s.attributes[s.instances[1].attributes[0]].color, (std::array<float, 3>{0, 1, 0}));
    const base::Mat4 place = s.transforms[s.instances[0].world_from_object].still();
    const base::Mat4 inner = s.transforms[s.objects[0].primitives[0].world_from_object].still();
    EXPECT_EQ(base::point(place * inner, {0, 0, 0}), (V3d{1, 0, 5}));
}

TEST(Objects, WhatTheObjectSetsOverrides) {
    const Reading r(
        world("ObjectBegin 1 " + ball +
              "AttributeBegin Color 0 1 0 ReverseOrientation Translate 2 0 0 Surface \"inner\" " +
              ball + "AttributeEnd " + ball +
              "ObjectEnd Color 1 0 0 Opacity .5 .5 .5 Orientation \"inside\" "
              "Translate 0 7 0 ObjectInstance 1"));
    EXPECT_EQ(r.said(), "");
    const rib::Scene& s = r.scene();
    ASSERT_EQ(s.instances[0].attributes.size(), 3u);
    const auto of = [&](std::size_t i) -> const rib::Attributes& {
        return s.attributes[s.instances[0].attributes[i]];
    };
    EXPECT_EQ(of(0).color, (std::array<float, 3>{1, 0, 0}));
    EXPECT_EQ(of(1).color, (std::array<float, 3>{0, 1, 0}));
    EXPECT_EQ(of(1).opacity[0], .5f);
    EXPECT_FALSE(of(0).orientation_matches);
    EXPECT_TRUE(of(1).orientation_matches);
    EXPECT_EQ(s.instances[0].attributes[0], s.instances[0].attributes[2]);
    // Its shader's space is where the object put it, at the instance.
    const rib::ShaderCall& shader = s.shaders[of(1).surface];
    EXPECT_EQ(base::point(s.transforms[shader.world_from_shader].still(), {0, 0, 0}),
              (V3d{2, 7, 0}));
}

TEST(Objects, BasisBelongsToTheDefinition) {
    const Reading r(world("Basis \"b-spline\" 1 \"b-spline\" 1 ObjectBegin 1 " + ball +
                          "ObjectEnd Basis \"bezier\" 3 \"bezier\" 3 ObjectInstance 1"));
    EXPECT_EQ(r.scene().attributes[r.scene().instances[0].attributes[0]].basis->ustep, 1);
}

TEST(Objects, NestedOnesAreFlattened) {
    const Reading r(world("ObjectBegin 1 " + ball +
                          "ObjectEnd ObjectBegin 2 Color 0 0 1 ObjectInstance 1 Translate 1 0 0 "
                          "ObjectInstance 1 ObjectEnd Translate 0 0 3 ObjectInstance 2"));
    EXPECT_EQ(r.said(), "");
    const rib::Scene& s = r.scene();
    ASSERT_EQ(s.instances.size(), 2u);
    EXPECT_EQ(s.instances[1].object, 0u);
    EXPECT_EQ(base::point(s.transforms[s.instances[1].world_from_object].still(), {0, 0, 0}),
              (V3d{1, 0, 3}));
    EXPECT_EQ(s.attributes[s.instances[0].attributes[0]].color[2], 1);
    EXPECT_EQ(s.attributes[s.instances[0].attributes[0]].color[0], 0);
}

TEST(Objects, ExplosionsAreBounded) {
    std::string text = "ObjectBegin 0 " + ball + "ObjectEnd ";
    for (int i = 1; i < 40; ++i) { // 2^39 balls
        const std::string inner = "ObjectInstance " + std::to_string(i - 1) + " ";
        text += "ObjectBegin " + std::to_string(i) + " " + inner + inner + "ObjectEnd ";
    }
    // Depth first to the limit of depth or number; here the number would be reached after seconds,
    // so go deeper.
    for (int i = 40; i < 120; ++i) {
        text += "ObjectBegin " + std::to_string(i) + " ObjectInstance " + std::to_string(i - 1) +
                " ObjectEnd ";
    }
    const Reading r(text + world("ObjectInstance 119"));
    EXPECT_EQ(r.code(), base::Code::Limit);
}

TEST(Objects, UnknownAndOwnHandles) {
    const Reading r(world("ObjectInstance 5 ObjectBegin 1 ObjectInstance 1 " + ball +
                          "ObjectEnd ObjectInstance 1"));
    EXPECT_EQ(r.messages.size(), 2u) << r.said();
    EXPECT_EQ(r.scene().instances.size(), 1u);
}

TEST(Objects, SurviveWorldsAndEndWithFrames) {
    const Reading r("ObjectBegin 1 " + ball + "ObjectEnd FrameBegin 1 ObjectBegin 2 " + ball +
                    "ObjectEnd " + world("ObjectInstance 1 ObjectInstance 2") +
                    "FrameEnd FrameBegin 2 " + world("ObjectInstance 1 ObjectInstance 2") +
                    "FrameEnd");
    ASSERT_EQ(r.backend.scenes.size(), 2u);
    EXPECT_EQ(r.backend.scenes[0]->instances.size(), 2u);
    EXPECT_EQ(r.backend.scenes[1]->instances.size(), 1u);
}

// --- motion, ri.md 12.3 ---

TEST(Motion, TransformationsMergeTheirTimes) {
    const Reading r(world("MotionBegin [0 1] Translate 0 0 0 Translate 2 0 0 MotionEnd\n"
                          "MotionBegin [0.5 1] Scale 1 1 1 Scale 3 3 3 MotionEnd " +
                          ball));
    EXPECT_EQ(r.said(), "");
    const rib::Transform& t = r.scene().transforms[r.scene().primitives[0].world_from_object];
    ASSERT_EQ(t.keys.size(), 3u);
    EXPECT_EQ(t.keys[1].time, .5f);
    EXPECT_EQ(base::point(t.at(1), {1, 0, 0}), (V3d{5, 0, 0}));
    EXPECT_EQ(base::point(t.at(.25f), {1, 0, 0}), (V3d{1.5, 0, 0}));
    EXPECT_EQ(base::point(t.at(7), {1, 0, 0}), (V3d{5, 0, 0}));
}

TEST(Motion, RotationsTurn) {
    const Reading r(world("MotionBegin [0 1] Rotate 0 0 0 1 Rotate 360 0 0 1 MotionEnd " + ball));
    const rib::Transform& t = r.scene().transforms[r.scene().primitives[0].world_from_object];
    for (const float time : {0.0f, 0.1f, 0.25f, 0.5f, 0.77f}) {
        const double angle = 2 * 3.14159265358979 * static_cast<double>(time);
        const V3d P = base::point(t.at(time), {1, 0, 0});
        // Keys every 5 degrees: the chord leaves the circle by 1 - cos(2.5 deg) = 0.00095 at most.
        EXPECT_NEAR(P.x, std::cos(angle), 0.001);
        EXPECT_NEAR(P.y, std::sin(angle), 0.001);
    }
}

TEST(Motion, CameraMoves) {
    const Reading r("MotionBegin [0 1] Translate 0 0 5 Translate 0 0 6 MotionEnd " + world(ball));
    EXPECT_TRUE(r.scene().camera_from_world.moving());
}

TEST(Motion, GeometryKeepsItsKeys) {
    const Reading r(world(
        "MotionBegin [0 .5 1] Polygon \"P\" [0 0 0 1 0 0 0 1 0] Polygon \"P\" [0 0 1 1 0 1 0 1 1]\n"
        "Polygon \"P\" [0 0 2 1 0 2 0 1 2] MotionEnd"));
    EXPECT_EQ(r.said(), "");
    ASSERT_EQ(r.scene().primitives.size(), 1u);
    const rib::Primitive& p = r.scene().primitives[0];
    ASSERT_EQ(p.motion.size(), 3u);
    EXPECT_EQ(p.motion[0].time, 0);
    EXPECT_EQ(p.motion[1].time, .5f);
    EXPECT_EQ(p.motion[2].params.find("P")->floats[2], 2);
    EXPECT_EQ(p.params.find("P")->floats[2], 0);
}

TEST(Motion, ShadingTakesTheFirstSample) {
    const Reading r(world("MotionBegin [0 1] Color 1 0 0 Color 0 1 0 MotionEnd " + ball));
    EXPECT_EQ(r.said(), "");
    EXPECT_EQ(r.scene().attributes[r.scene().primitives[0].attributes].color[0], 1);
}

TEST(Motion, ShutterOffset) {
    const Reading r("Option \"shutter\" \"offset\" 10 " +
                    world("MotionBegin [0 1] Translate 0 0 0 Translate 2 0 0 MotionEnd " + ball));
    EXPECT_EQ(r.scene().transforms[r.scene().primitives[0].world_from_object].keys[1].time, 11);
}

TEST(Motion, BadBlocksUseTheFirstSample) {
    for (const char* block : {"MotionBegin [0 1] Translate 1 0 0 MotionEnd",
                              "MotionBegin [0] Translate 1 0 0 Translate 2 0 0 MotionEnd",
                              "MotionBegin [0 1] Translate 1 0 0 Scale 2 2 2 MotionEnd",
                              "MotionBegin [1 0] Translate 1 0 0 Translate 3 0 0 MotionEnd"}) {
        const Reading r(world(std::string(block) + " " + ball));
        EXPECT_EQ(r.code(), base::Code::BadMotion) << block;
        EXPECT_EQ(r.messages.size(), 1u) << r.said();
        const rib::Transform& t = r.scene().transforms[r.scene().primitives[0].world_from_object];
        EXPECT_EQ(base::point(t.at(0), {0, 0, 0}), (V3d{1, 0, 0})) << block;
        EXPECT_FALSE(t.moving());
    }
    const Reading topology(world("MotionBegin [0 1] Polygon \"P\" [0 0 0 1 0 0 0 1 0] Polygon "
                                 "\"P\" [0 0 0 1 0 0 1 1 0 0 1 0] "
                                 "MotionEnd"));
    EXPECT_EQ(topology.code(), base::Code::BadMotion);
    EXPECT_EQ(topology.scene().primitives.size(), 1u);
    EXPECT_EQ(Reading("MotionBegin [0 1] MotionEnd").code(), base::Code::BadMotion);
}

// --- archives ---

class Folder : public testing::Test {
protected:
    void write(const std::string& name, const std::string& text) const {
        std::filesystem::create_directories(
            std::filesystem::path(path_ + "/" + name).parent_path());
        std::ofstream(path_ + "/" + name) << text;
    }
    // Reads a file of the folder; keeps what was rendered and said.
    void read(const std::string& name) {
        std::FILE* null = std::fopen("/dev/null", "w");
        base::Diag diag(null);
        rib::Reader reader(backend_, diag, {});
        status_ = reader.read_file(path_ + "/" + name);
        messages_ = diag.messages();
        code_ = diag.last_code();
        std::fclose(null);
    }

    const base::TempDir dir_{"perigee-rib"};
    const std::string path_ = dir_.path();
    rib_test::Collector backend_;
    rib::ReadStatus status_ = rib::ReadStatus::Ok;
    base::Code code_ = base::Code::None;
    std::vector<std::string> messages_;
};

TEST_F(Folder, ArchivesAreFoundBesideTheFileAndOnThePath) {
    write("main.rib", "Option \"searchpath\" \"archive\" \"" + path_ + "/lib\"\n" +
                          world("ReadArchive \"sub/a.rib\" ReadArchive \"b.rib\" " + ball));
    write("sub/a.rib", "Color 1 0 0 ReadArchive \"c.rib\"");
    write("sub/c.rib", ball);
    write("lib/b.rib", ball);
    read("main.rib");
    EXPECT_EQ(messages_, std::vector<std::string>());
    ASSERT_EQ(backend_.scenes.size(), 1u);
    const rib::Scene& s = *backend_.scenes[0];
    ASSERT_EQ(s.primitives.size(), 3u);
    EXPECT_EQ(s.attributes[s.primitives[2].attributes].color[1], 0); // state changes persist
}

TEST_F(Folder, ErrorsNameTheInnermostFile) {
    write("main.rib", world("ReadArchive \"a.rib\" " + ball));
    write("a.rib", "\n\nNonsense 1 2 3");
    read("main.rib");
    ASSERT_EQ(messages_.size(), 1u);
    EXPECT_NE(messages_[0].find("/a.rib:3:1: error"), std::string::npos) << messages_[0];
    EXPECT_EQ(backend_.scenes[0]->primitives.size(), 1u);
}

TEST_F(Folder, CircularArchivesAreRefused) {
    write("main.rib", world("ReadArchive \"a.rib\" " + ball));
    write("a.rib", "ReadArchive \"b.rib\"");
    write("b.rib", "ReadArchive \"a.rib\" " + ball);
    read("main.rib");
    EXPECT_EQ(messages_.size(), 1u);
    EXPECT_EQ(backend_.scenes[0]->primitives.size(), 2u);
}

TEST_F(Folder, MissingArchivesAreSkipped) {
    write("main.rib", world("ReadArchive \"nothing.rib\" " + ball));
    read("main.rib");
    EXPECT_EQ(code_, base::Code::NoFile);
    EXPECT_EQ(status_, rib::ReadStatus::Ok);
    EXPECT_EQ(backend_.scenes[0]->primitives.size(), 1u);
    read(".");
    EXPECT_EQ(status_, rib::ReadStatus::Environment);
}

TEST_F(Folder, DelayedArchivesLeakNoState) {
    write(
        "main.rib",
        world("Color 0 0 1 Procedural \"DelayedReadArchive\" \"a.rib\" [-1 1 -1 1 -1 1] " + ball));
    write("a.rib", "Color 1 0 0 TransformBegin Translate 1 0 0 " + ball);
    read("main.rib");
    const rib::Scene& s = *backend_.scenes.at(0);
    ASSERT_EQ(s.primitives.size(), 2u);
    EXPECT_EQ(s.attributes[s.primitives[0].attributes].color[0], 1);
    EXPECT_EQ(s.attributes[s.primitives[1].attributes].color[0], 0);
    EXPECT_EQ(messages_.size(), 1u); // the open TransformBegin
}

TEST(Archives, InlineOnes) {
    const Reading r("ArchiveBegin \"balls\"\n# comment \" [\nColor 1 0 0 ArchiveBegin \"inner\" " +
                    ball + "ArchiveEnd ReadArchive \"inner\" " + ball + "ArchiveEnd\n" +
                    world("ReadArchive \"balls\" ReadArchive \"balls\""));
    EXPECT_EQ(r.said(), "");
    EXPECT_EQ(r.scene().primitives.size(), 4u);
}

TEST(Archives, ErrorsInInlineOnesPointToTheirText) {
    const Reading r("ArchiveBegin \"a\"\nColor 1 0 0\n  Sphere 1\nArchiveEnd\n" +
                    world("ReadArchive \"a\""));
    EXPECT_TRUE(r.said("test.rib:4:1: error: Sphere") || r.said("test.rib:3:")) << r.said();
}

TEST(Archives, ThatReadThemselvesAreRefused) {
    const Reading r("ArchiveBegin \"a\" ReadArchive \"a\" ArchiveEnd " +
                    world("ReadArchive \"a\""));
    EXPECT_EQ(r.messages.size(), 1u) << r.said();
}

TEST(Archives, UnfinishedOnesAreDropped) {
    const Reading r("ArchiveBegin \"a\" " + ball);
    EXPECT_EQ(r.code(), base::Code::Nesting);
}

// --- conditionals ---

bool is_true(const std::string& expression) {
    const Reading r("FrameBegin 3 Option \"user\" \"float x\" 2 \"string pass\" \"shadow\" "
                    "\"float[2] v\" [1 2]\n"
                    "Attribute \"user\" \"float y\" 5 WorldBegin IfBegin \"" +
                    expression + "\" " + ball + "IfEnd WorldEnd FrameEnd");
    EXPECT_EQ(r.said(), "") << expression;
    return r.scene().primitives.size() == 1;
}

TEST(Conditionals, Expressions) {
    for (const char* yes : {"1",
                            "!0",
                            "2 > 1",
                            "1 + 2 * 3 == 7",
                            "(1 + 2) * 3 == 9",
                            "2 ** 3 == 8",
                            "$x == 2",
                            "$user:y == 5",
                            "$pass == 'shadow'",
                            "$pass =~ 'sh.*w'",
                            "$Frame == 3",
                            "${Option:user:x} == 2",
                            "defined(pass)",
                            "!defined(nothing)",
                            "concat('a', 'b') == 'ab'",
                            "0 || 1",
                            "1 && 1",
                            "$x != 3",
                            "'a' != 'b'",
                            "-1 < 0",
                            "6 / 2 - 3 == 0",
                            "$(concat('pa','ss')) == 'shadow'"}) {
        EXPECT_TRUE(is_true(yes)) << yes;
    }
    for (const char* no : {"0", "!1", "1 > 2", "$x == 3", "$pass == 'beauty'",
                           "defined(Attribute:user:x)", "1 && 0", "0 || 0", "''", "1 / 0"}) {
        EXPECT_FALSE(is_true(no)) << no;
    }
}

TEST(Conditionals, BranchesAndNesting) {
    const auto count = [](const std::string& body) {
        return Reading(world(body)).scene().primitives.size();
    };
    EXPECT_EQ(count("IfBegin \"0\" " + ball + "ElseIf \"1\" " + ball + ball + "ElseIf \"1\" " +
                    ball + "Else " + ball + "IfEnd"),
              2u);
    EXPECT_EQ(count("IfBegin \"0\" IfBegin \"1\" " + ball + "Else " + ball + "IfEnd Else " + ball +
                    "IfEnd"),
              1u);
}

TEST(Conditionals, MistakesAreFalse) {
    for (const char* wrong : {"1 +", "(1", "'open", "1 2", "'a' < 'b'", "@"}) {
        const Reading r(world("IfBegin \"" + std::string(wrong) + "\" " + ball + "IfEnd"));
        EXPECT_EQ(r.code(), base::Code::Syntax) << wrong;
        EXPECT_EQ(r.scene().primitives.size(), 0u) << wrong;
    }
    EXPECT_EQ(Reading("IfEnd").code(), base::Code::Nesting);
    EXPECT_EQ(Reading("IfBegin \"1\"").code(), base::Code::Nesting);
    EXPECT_TRUE(Reading(world("IfBegin \"$nothing\" IfEnd")).said("not defined"));
}

// --- the dump ---

TEST(Dump, IsStableText) {
    const Reading r("Format 8 6 1 Display \"a.tif\" \"file\" \"rgb\" " +
                    world("LightSource \"ambientlight\" 1 Color 1 .5 0 " + ball));
    const std::string text = rib::dump(r.scene());
    EXPECT_EQ(text, rib::dump(r.scene()));
    for (const char* line :
         {"frame 0 format 8 6 1", "display a.tif file rgb", "color [1 0.5 0] opacity [1 1 1]",
          "Sphere [1 -1 1 360 0 0 0]", "light 0 \"1\" shader 0"}) {
        EXPECT_NE(text.find(line), std::string::npos) << line << "\n" << text;
    }
}

} // namespace
