// SPDX-License-Identifier: Apache-2.0
// Every row of the request table: a minimal legal form is read without a message, in its several
// spellings; wrong ones are reported at their place and the next request is read.
#include "ribtools/request.h"
#include "ribtools/request_examples.h"
#include "ribtools/test_util.h"

#include <gtest/gtest.h>

namespace {

using rib_test::Example;
using rib_test::examples;
using rib_test::Reading;
using rib_test::world;
// These say something even when used as intended.
constexpr const char* noted[] = {
    "System",     "Deformation", "ShaderLayer", "ConnectShaderLayers", "GeometricRepresentation",
    "Procedural", "Procedural2"};

TEST(Requests, EveryRowHasAnExample) {
    for (const rib::RequestRow& row : rib::request_table()) {
        const auto is_row = [&](const char* name) { return row.name == name; };
        const bool covered = row.kind == rib::RequestKind::Skipped ||
                             std::any_of(std::begin(examples), std::end(examples),
                                         [&](const Example& e) { return row.name == e.name; }) ||
                             std::any_of(std::begin(noted), std::end(noted), is_row);
        EXPECT_TRUE(covered) << row.name;
    }
}

TEST(Requests, MinimalFormsAreReadWithoutAMessage) {
    for (const Example& e : examples) {
        const Reading run(e.text);
        EXPECT_EQ(run.said(), "") << e.name;
    }
}

TEST(Requests, NotedOnesAreReadWithOneWarning) {
    for (const char* text :
         {"System \"rm -rf /\"", "Deformation \"twist\"", "ShaderLayer \"surface\" \"a\" \"b\"",
          "GeometricRepresentation \"points\"",
          "WorldBegin Procedural \"RunProgram\" [\"cmd\" \"data\"] [-1 1 -1 1 -1 1] WorldEnd"}) {
        const Reading run(text);
        ASSERT_EQ(run.messages.size(), 1u) << text;
        EXPECT_TRUE(run.said("warning")) << run.said();
    }
}

TEST(Requests, LaterOnesAreSkippedWithOneWarning) {
    const Reading run(
        "Bxdf \"a\" \"b\" \"color c\" [1 0 0] Bxdf \"x\" \"y\" Format 10 20 1 WorldBegin WorldEnd");
    EXPECT_EQ(run.messages.size(), 1u);
    EXPECT_EQ(run.scene().options.xres, 10);
}

// What follows a mistake is read.
TEST(Requests, MistakesCostOneRequest) {
    struct Case {
        const char* wrong;
        const char* place;
        const char* part;
    };
    for (const Case& c :
         {Case{"Translate 1 0 0 0 0 1 0 0 0 0 1 0 0 0 5 1", ":2:17:", "13 surplus numbers"},
          Case{"Translate [1 0 0 0]", ":2:11:", "4 numbers in brackets where 3"},
          Case{"Sphere 1 -1", ":3:1:", "'zmax'"},
          Case{"Sphere 1 \"x\" 1 360", ":2:10:", "expected a number for 'zmin'"},
          Case{"Sphere 1 -1 01a3 360", ":2:13:", "malformed number"},
          Case{"Spere 1 -1 1 360", ":2:1:", "did you mean Sphere"},
          Case{"42 \"x\" [1 2", ":2:1:", "expected a request name"},
          Case{"PointsPolygons [3] [0 1 \"x\"] \"P\" [0 0 0]", ":2:25:", "expected integers"},
          Case{"ConcatTransform [1 2 3]", ":2:23:", "16 were expected"},
          Case{"Polygon \"P\" [0 0 0] 7", ":2:21:", "surplus"},
          Case{"Polygon \"P\"", ":3:1:", "has no value"},
          Case{"Polygon \"Q\" [1 2 3]", ":2:9:", "not declared"},
          Case{"Matte 3e9", ":", "does not fit an integer"}}) {
        const Reading run("WorldBegin\n" + std::string(c.wrong) + "\nDisk 0 1 360 WorldEnd");
        ASSERT_EQ(run.backend.scenes.size(), 1u) << c.wrong;
        EXPECT_EQ(run.scene().primitives.size(), 1u) << c.wrong << "\n" << run.said();
        EXPECT_TRUE(run.said("test.rib" + std::string(c.place))) << run.said();
        EXPECT_TRUE(run.said(c.part)) << run.said();
    }
}

TEST(Requests, RealsForIntegersAreCutWithAWarning) {
    const Reading run("Format 200.5 100.0 1 WorldBegin WorldEnd");
    EXPECT_EQ(run.scene().options.xres, 200);
    EXPECT_EQ(run.messages.size(), 1u);
    EXPECT_TRUE(run.said("warning"));
}

TEST(Requests, BlocksSurviveSurplusArguments) {
    const Reading run(
        "WorldBegin\nObjectBegin 1 2 Sphere 1 -1 1 360 ObjectEnd ObjectInstance 1 WorldEnd");
    EXPECT_EQ(run.scene().instances.size(), 1u) << run.said();
    EXPECT_EQ(run.messages.size(), 1u);
}

TEST(Requests, HandlesMayBeNumbersOrStrings) {
    const Reading run(world(
        "LightSource \"a\" 1 LightSource \"b\" \"two\" \"intensity\" 1 \"string mode\" \"x\"\n"
        "LightSource \"c\" \"string mode\" \"x\" LightSource \"d\" \"three\"\n"
        "LightSource \"e\" \"intensity\" [3] Illuminate \"1\" 0 Illuminate \"two\" 0\n"
        "Sphere 1 -1 1 360"));
    EXPECT_EQ(run.said(), "");
    ASSERT_EQ(run.scene().lights.size(), 5u);
    EXPECT_EQ(run.scene().lights[1].handle, "two");
    EXPECT_EQ(run.scene().lights[2].handle, "");
    EXPECT_EQ(run.scene().lights[3].handle, "three");
    const rib::Attributes& a = run.scene().attributes[run.scene().primitives[0].attributes];
    EXPECT_EQ(a.lights.get(), (std::vector<rib::LightId>{2, 3, 4}));
}

TEST(Requests, ParametersTakeTypesFromDeclarations) {
    const Reading run("Declare \"bgcolor\" \"uniform color\" Declare \"color\" \"uniform color\"\n"
                      "Imager \"background\" \"color\" [0 0 1] \"bgcolor\" 1 0 0\n" +
                      world("Surface \"x\" \"uniform float[2] f\" [1 2] \"string s\" \"text\" "
                            "\"int n\" 3 \"point p\" "
                            "[1 2 3] \"guess\" 4 \"words\" [\"a\" \"b\"] Sphere 1 -1 1 360"));
    EXPECT_EQ(run.said(), "");
    const rib::Scene& s = run.scene();
    const rib::ParamList& imager = s.shaders[s.options.imager].params;
    EXPECT_EQ(imager.find("color")->decl.type, rib::ParamType::Color);
    EXPECT_EQ(imager.find("bgcolor")->floats, (std::vector<float>{1, 0, 0}));
    const rib::ParamList& p = s.shaders.back().params;
    EXPECT_EQ(p.find("f")->decl.array_length, 2);
    EXPECT_EQ(p.get_int("n", 0), 3);
    EXPECT_EQ(p.get_string("s", ""), "text");
    EXPECT_FALSE(p.find("p")->guessed);
    EXPECT_TRUE(p.find("guess")->guessed);
    EXPECT_EQ(p.find("words")->strings.size(), 2u);
}

TEST(Requests, IllegalDeclarationsAreReportedOnce) {
    const Reading run(
        "Declare \"Normals\" \"varying double\" Declare \"Normals\" \"varying double\"\n" +
        world("Polygon \"P\" [0 0 0 1 0 0 0 1 0] \"Normals\" [1 2 3]\n"
              "Polygon \"P\" [0 0 0 1 0 0 0 1 0] \"varying double w\" [1 2 3]\n"
              "Polygon \"P\" [0 0 0 1 0 0 0 1 0] \"varying double w\" [1 2 3]"));
    EXPECT_EQ(run.messages.size(), 2u) << run.said();
    EXPECT_EQ(run.scene().primitives.size(), 3u);
    EXPECT_EQ(run.scene().primitives[2].params.params.size(), 1u);
}

TEST(Requests, ValuesOfTheWrongKindCostTheParameter) {
    const Reading run(
        world("Disk 0 1 360 \"Cs\" \"red\" \"Os\" [\"a\"] \"constant string s\" [1 2]\n"
              "Surface \"plastic\" \"Kd\" \"Ks\" .5 Disk 0 1 360"));
    EXPECT_EQ(run.messages.size(), 4u) << run.said();
    EXPECT_EQ(run.scene().primitives.size(), 2u);
    EXPECT_EQ(run.scene().shaders[0].params.get_float("Ks", 0), .5f);
}

TEST(Requests, ColorSamplesConvertEveryColor) {
    // One sample per color: its red, half green.
    const Reading run(
        "ColorSamples [1 .5 0] [1 0 0]\n" +
        world("Color 0.5 Surface \"plastic\" \"specularcolor\" [1] Disk 0 1 360 \"Cs\" [1 0 1 0]"));
    EXPECT_EQ(run.said(), "");
    const rib::Primitive& p = run.scene().primitives[0];
    EXPECT_EQ(run.scene().attributes[p.attributes].color, (std::array<float, 3>{.5f, .25f, 0}));
    EXPECT_EQ(p.params.find("Cs")->floats,
              (std::vector<float>{1, .5f, 0, 0, 0, 0, 1, .5f, 0, 0, 0, 0}));
    EXPECT_EQ(run.scene().shaders[0].params.find("specularcolor")->floats,
              (std::vector<float>{1, .5f, 0}));
}

TEST(Requests, VersionWithThreeComponents) {
    EXPECT_EQ(Reading("version 3.03.1 Format 1 1 1").said(), "");
    EXPECT_EQ(Reading("version 9 Format 1 1 1").messages.size(), 1u);
}

} // namespace
