// SPDX-License-Identifier: Apache-2.0
// Every row of the request table: a minimal legal form is read without a message, in its several
// spellings; wrong ones are reported at their place and the next request is read.
#include "ribtools/request.h"
#include "ribtools/test_util.h"

#include <gtest/gtest.h>

namespace {

using rib_test::Reading;
using rib_test::world;

// One legal use of each request, with whatever it needs around it.
struct Example {
    const char* name;
    const char* text;
};
constexpr Example examples[] = {
    {"version", "version 3.03"},
    {"Declare", "Declare \"x\" \"uniform float\""},
    {"ErrorHandler", "ErrorHandler \"print\""},
    {"ArchiveRecord", "ArchiveRecord \"comment\" \"text\""},
    {"FrameBegin", "FrameBegin 1 FrameEnd"},
    {"FrameEnd", "FrameBegin FrameEnd"},
    {"WorldBegin", "WorldBegin WorldEnd"},
    {"WorldEnd", "WorldBegin WorldEnd"},
    {"AttributeBegin", "AttributeBegin AttributeEnd"},
    {"AttributeEnd", "WorldBegin AttributeBegin AttributeEnd WorldEnd"},
    {"TransformBegin", "TransformBegin TransformEnd"},
    {"TransformEnd", "TransformBegin TransformEnd"},
    {"SolidBegin", "WorldBegin SolidBegin \"primitive\" Sphere 1 -1 1 360 SolidEnd WorldEnd"},
    {"SolidEnd", "WorldBegin SolidBegin \"union\" SolidEnd WorldEnd"},
    {"ObjectBegin", "ObjectBegin 1 Sphere 1 -1 1 360 ObjectEnd"},
    {"ObjectEnd", "ObjectBegin \"ball\" ObjectEnd"},
    {"MotionBegin", "MotionBegin [0 1] Translate 0 0 1 Translate 0 0 2 MotionEnd"},
    {"MotionEnd", "MotionBegin 0 1 Scale 1 1 1 Scale 2 2 2 MotionEnd"},
    {"ResourceBegin", "ResourceBegin ResourceEnd"},
    {"ResourceEnd", "ResourceBegin ResourceEnd"},
    {"Format", "Format 200 150 -1"},
    {"FrameAspectRatio", "FrameAspectRatio 1.5"},
    {"ScreenWindow", "ScreenWindow [-1 1 -1 1]"},
    {"CropWindow", "Cropwindow 0 .5 0 .5"},
    {"Projection", "Projection \"perspective\" \"fov\" 45"},
    {"Clipping", "Clipping 0.1 1e38"},
    {"ClippingPlane", "ClippingPlane 0 0 3 0 0 1"},
    {"DepthOfField", "DepthOfField - DepthOfField 22 45 1200 DepthOfField"},
    {"Shutter", "Shutter 0 1"},
    {"PixelVariance", "PixelVariance .01"},
    {"PixelSamples", "PixelSamples 4 4"},
    {"PixelFilter", "PixelFilter \"catmull-rom\" 4 4"},
    {"Exposure", "Exposure 1 2.2"},
    {"Imager", "Imager \"background\" \"color bgcolor\" [0 0 1]"},
    {"Quantize", "Quantize \"rgba\" 255 0 255 0.5"},
    {"Display",
     "Display \"a.tif\" \"file\" \"rgba\" Display \"+b.tif\" \"file\" \"z\" \"origin\" [0 0]"},
    {"DisplayChannel", "DisplayChannel \"varying color Ci\" \"quantize\" [0 255 0 255]"},
    {"Hider", "Hider \"hidden\" \"jitter\" 0"},
    {"ColorSamples", "ColorSamples [1 1 1] [.3 .6 .1] Color .5"},
    {"RelativeDetail", "RelativeDetail 0.5"},
    {"Option", "Option \"limits\" \"bucketsize\" [16 16] \"integer gridsize\" 256"},
    {"Color", "Color [1 0 0] Color 1 0 0"},
    {"Opacity", "Opacity .5 .5 .5"},
    {"TextureCoordinates", "TextureCoordinates [0 0 1 0 0 1 1 1]"},
    {"LightSource",
     "LightSource \"distantlight\" 1 \"from\" [0 0 0] LightSource \"ambientlight\" \"amb\" "
     "\"intensity\" .1 LightSource \"pointlight\" \"intensity\" 10"},
    {"AreaLightSource",
     "WorldBegin AreaLightSource \"arealight\" 3 Sphere 1 -1 1 360 AreaLightSource \"\" WorldEnd"},
    {"Illuminate", "LightSource \"ambientlight\" 1 Illuminate \"1\" 0"},
    {"Surface", "Surface \"plastic\" \"Ks\" .5 \"mine\" [1 2 3]"},
    {"Displacement", "Displacement \"bumpy\" \"amplitude\" [.1]"},
    {"Atmosphere", "Atmosphere \"fog\" \"distance\" 10"},
    {"Interior", "Interior \"null\""},
    {"Exterior", "Exterior \"\""},
    {"ShadingRate", "ShadingRate .25"},
    {"ShadingInterpolation", "ShadingInterpolation \"smooth\""},
    {"Matte", "Matte 1"},
    {"Bound", "Bound [-1 1 -1 1 -1 1]"},
    {"Detail", "Detail -1 1 -1 1 2 3"},
    {"DetailRange", "DetailRange 0 0 10 1e38"},
    {"GeometricApproximation", "GeometricApproximation \"flatness\" .5"},
    {"Orientation", "Orientation \"rh\""},
    {"ReverseOrientation", "ReverseOrientation"},
    {"Sides", "Sides [1] Sides 2.0"},
    {"Basis", "Basis \"b-spline\" 1 [1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1] 4"},
    {"TrimCurve", "TrimCurve [1] [2] [0 0 1 1] [0] [1] [2] [0 1] [0 1] [1 1] TrimCurve [] [] [] [] "
                  "[] [] [] [] []"},
    {"Attribute",
     "Attribute \"light\" \"shadows\" \"on\" Attribute \"identifier\" \"name\" [\"ball\"]"},
    {"Identity", "Identity"},
    {"Transform", "Transform [1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1]"},
    {"ConcatTransform", "ConcatTransform 1 0 0 0 0 1 0 0 0 0 1 0 0 0 2 1"},
    {"Perspective", "Perspective 60"},
    {"Translate", "Translate 1 2 3 Translate [1 2 3]"},
    {"Rotate", "Rotate 90 0 0 1"},
    {"Scale", "Scale 1 2 3"},
    {"Skew", "Skew 45 0 1 0 1 0 0"},
    {"CoordinateSystem", "CoordinateSystem \"here\""},
    {"ScopedCoordinateSystem", "ScopedCoordinateSystem \"here\""},
    {"CoordSysTransform", "CoordinateSystem \"here\" CoordSysTransform \"here\""},
    {"Polygon", "WorldBegin Polygon \"P\" [0 0 0 1 0 0 0 1 0] WorldEnd"},
    {"GeneralPolygon",
     "WorldBegin GeneralPolygon [4 3] \"P\" [0 0 0 4 0 0 4 4 0 0 4 0 1 1 0 2 1 0 1 2 0] WorldEnd"},
    {"PointsPolygons",
     "WorldBegin PointsPolygons [3 3] [0 1 2 0 2 3] \"P\" [0 0 0 1 0 0 1 1 0 0 1 0] WorldEnd"},
    {"PointsGeneralPolygons",
     "WorldBegin PointsGeneralPolygons [1] [3] [0 1 2] \"P\" [0 0 0 1 0 0 1 1 0] WorldEnd"},
    {"Patch", "WorldBegin Patch \"bilinear\" \"P\" [0 0 0 1 0 0 0 1 0 1 1 0] WorldEnd"},
    {"PatchMesh",
     "WorldBegin PatchMesh \"bilinear\" 2 \"nonperiodic\" 2 \"nowrap\" \"Pz\" [0 1 2 3] WorldEnd"},
    {"NuPatch", "WorldBegin NuPatch 2 2 [0 0 1 1] 0 1 2 2 [0 0 1 1] 0 1 \"Pw\" [0 0 0 1 1 0 0 1 0 "
                "1 0 1 1 1 0 1] WorldEnd"},
    {"SubdivisionMesh",
     "WorldBegin SubdivisionMesh \"catmull-clark\" [3] [0 1 2] \"P\" [0 0 0 1 0 0 0 1 0]\n"
     "SubdivisionMesh \"catmull-clark\" [3] [0 1 2] [\"interpolateboundary\"] [0 0] [] [] \"P\" "
     "[0 0 0 1 0 0 0 1 0] WorldEnd"},
    {"HierarchicalSubdivisionMesh",
     "WorldBegin HierarchicalSubdivisionMesh \"catmull-clark\" [3] [0 1 2] [] [] [] [] [] "
     "\"P\" [0 0 0 1 0 0 0 1 0] WorldEnd"},
    {"Sphere", "WorldBegin Sphere [1 -1 1 360] WorldEnd"},
    {"Cone", "WorldBegin Cone 1 1 360 WorldEnd"},
    {"Cylinder", "WorldBegin Cylinder 1 0 1 360 WorldEnd"},
    {"Hyperboloid", "WorldBegin Hyperboloid 1 0 0 1 0 1 360 WorldEnd"},
    {"Paraboloid", "WorldBegin Paraboloid 1 0 1 360 WorldEnd"},
    {"Disk", "WorldBegin Disk 0 1 360 \"Cs\" [1 0 0 0 1 0 0 0 1 1 1 1] WorldEnd"},
    {"Torus", "WorldBegin Torus 1 .2 0 360 360 WorldEnd"},
    {"Points", "WorldBegin Points \"P\" [0 0 0 1 1 1] \"constantwidth\" .1 WorldEnd"},
    {"Curves", "WorldBegin Curves \"linear\" [2] \"nonperiodic\" \"P\" [0 0 0 1 1 1] WorldEnd"},
    {"Blobby", "WorldBegin Blobby 1 [1001 0] [1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1] [] "
               "Blobby 1 [1001 0] [1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1] \"Cs\" [1 0 0] WorldEnd"},
    {"Geometry", "WorldBegin Geometry \"teapot\" WorldEnd"},
    {"Volume", "WorldBegin Volume \"box\" [-1 1 -1 1 -1 1] [0 0 0] WorldEnd"},
    {"ObjectInstance",
     "ObjectBegin 1 Sphere 1 -1 1 360 ObjectEnd WorldBegin ObjectInstance 1 WorldEnd"},
    {"MakeTexture", "MakeTexture \"a.tif\" \"a.tx\" \"periodic\" \"clamp\" \"gaussian\" 2 2"},
    {"MakeBump", "MakeBump \"a.tif\" \"a.tx\" \"periodic\" \"clamp\" \"gaussian\" 2 2"},
    {"MakeLatLongEnvironment", "MakeLatLongEnvironment \"a.tif\" \"a.tx\" \"box\" 1 1"},
    {"MakeCubeFaceEnvironment",
     "MakeCubeFaceEnvironment \"1\" \"2\" \"3\" \"4\" \"5\" \"6\" \"a.tx\" 90 \"box\" 1 1"},
    {"MakeShadow", "MakeShadow \"a.z\" \"a.shd\""},
    {"MakeOcclusion", "MakeOcclusion [\"a.z\" \"b.z\"] \"a.shd\""},
    {"MakeBrickMap", "MakeBrickMap [\"a.ptc\"] \"a.bkm\""},
    {"ReadArchive", "ArchiveBegin \"a\" Color 1 0 0 ArchiveEnd ReadArchive \"a\""},
    {"ArchiveBegin", "ArchiveBegin \"a\" ArchiveEnd"},
    {"ArchiveEnd", "ArchiveBegin \"a\" Sphere 1 -1 1 360 ArchiveEnd"},
    {"IfBegin", "IfBegin \"1\" IfEnd"},
    {"ElseIf", "IfBegin \"0\" ElseIf \"1 == 1\" IfEnd"},
    {"Else", "IfBegin \"0\" Else IfEnd"},
    {"IfEnd", "IfBegin \"0\" Sphere 1 -1 1 360 IfEnd"},
    {"Resource", "Resource \"here\" \"attributes\" \"string operation\" \"save\""},
};
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
