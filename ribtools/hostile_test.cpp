// SPDX-License-Identifier: Apache-2.0
// Input that means harm: whatever comes in, reading ends, in time linear in the input, with
// messages and without a crash. Run under ASan and UBSan these tests are the fuzz replay of the
// reader.
#include "ribtools/test_util.h"

#include <gtest/gtest.h>
#include <random>

namespace {

using rib_test::Reading;
using rib_test::world;

// A bit of everything, to be cut and bent.
const std::string sample = R"(##RenderMan RIB-Structure 1.1
version 3.03
Option "searchpath" "shader" ".:&" # comment
Declare "st" "varying float[2]"
Format 20 10 1 Projection "perspective" "fov" [45] ColorSamples [1 0 0 0 1 0 0 0 1] [1 0 0 0 1 0 0 0 1]
FrameBegin 1
ArchiveBegin "a" Color [1 0 0] Sphere 1 -1 1 360 ArchiveEnd
ObjectBegin "o" AttributeBegin Surface "matte" "Kd" .5 Disk 0 1 360 AttributeEnd ObjectEnd
MotionBegin [0 1] Translate 0 0 5 Translate 0 0 6 MotionEnd
WorldBegin
LightSource "distantlight" 1 "from" [0 0 0] "to" [0 0 1] LightSource "x" "h" "intensity" 1
IfBegin "defined(user:x) || $Frame == 1" ReadArchive "a" Else Sides 1 IfEnd
SolidBegin "difference" SolidBegin "primitive" Torus 1 .5 0 360 360 SolidEnd SolidBegin "primitive" SolidEnd SolidEnd
ObjectInstance "o" Basis "b-spline" 1 [1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1] 4
PointsPolygons [4 3] [0 1 2 3 0 1 2] "P" [0 0 0 1 0 0 1 1 0 0 1 0] "st" [0 0 1 0 1 1 0 1] "uniform color Cs" [1 0 0 0 1 0]
PatchMesh "bicubic" 4 "nonperiodic" 4 "nonperiodic" "Pz" [0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0]
NuPatch 2 2 [0 0 1 1] 0 1 2 2 [0 0 1 1] 0 1 "Pw" [0 0 0 1 1 0 0 1 0 1 0 1 1 1 0 1]
SubdivisionMesh "catmull-clark" [3] [0 1 2] ["crease"] [2 1] [0 1] [2.5] "P" [0 0 0 1 0 0 0 1 0]
Curves "cubic" [4] "nonperiodic" "P" [0 0 0 1 0 0 2 0 0 3 0 0] "constantwidth" .1
Blobby 2 [1001 0 1001 0 0 2 0 1] [1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1] [""]
TrimCurve [1] [2] [0 0 1 1] [0] [1] [2] [0 1] [0 1] [1 1]
Attribute "user" "string s\"" "\101\n" Detail -1 1 -1 1 1 2
WorldEnd FrameEnd
)";

TEST(Hostile, SampleIsFine) {
    const Reading r(sample);
    EXPECT_EQ(r.said(), "");
    EXPECT_EQ(r.scene().primitives.size(), 8u);
}

TEST(Hostile, TruncatedAnywhere) {
    for (std::size_t n = 0; n < sample.size(); n += 3) {
        const Reading r(sample.substr(0, n));
        EXPECT_LE(r.backend.scenes.size(), 1u);
    }
}

TEST(Hostile, BytesChangedAtRandom) {
    std::mt19937 random(3);
    for (int i = 0; i < 600; ++i) {
        std::string text = sample;
        const std::size_t changes = 1 + random() % 8;
        for (std::size_t k = 0; k < changes; ++k) {
            const std::size_t at = random() % text.size();
            switch (random() % 4) {
            case 0:
                text[at] = static_cast<char>(random());
                break;
            case 1:
                text.erase(at, random() % 20);
                break;
            case 2:
                text.insert(at, text.substr(random() % text.size(), random() % 40));
                break;
            default:
                text.insert(at, std::to_string(static_cast<int>(random())));
                break;
            }
        }
        const Reading r(text);
        EXPECT_NE(r.status, rib::ReadStatus::Environment);
    }
}

TEST(Hostile, Garbage) {
    std::mt19937 random(5);
    for (int i = 0; i < 20; ++i) {
        std::string text(20'000, ' ');
        for (char& c : text) {
            c = static_cast<char>(random() & (i % 2 == 0 ? 0xff : 0x7f));
        }
        const Reading r(text + " \xff");
        EXPECT_LT(r.messages.size(), 1000u); // not one per token
    }
}

TEST(Hostile, HugeCountsAllocateNothing) {
    for (const char* text :
         {"PatchMesh \"bilinear\" 2147483647 \"nonperiodic\" 2147483647 \"nonperiodic\" \"P\" [0 0 "
          "0]",
          "PatchMesh \"bicubic\" 2147483647 \"periodic\" 2 \"periodic\" \"P\" [0 0 0]",
          "NuPatch 2147483647 2147483647 [0] 0 1 2147483647 2 [0] 0 1 \"P\" [0 0 0]",
          "NuPatch 1 2147483647 [0 1] 0 1 1 -2147483648 [0 1] 0 1 \"P\" [0 0 0]",
          "PointsPolygons [2147483647] [0 1 2] \"P\" [0 0 0 1 0 0 0 1 0]",
          "PointsPolygons [3] [0 1 2147483647] \"P\" [0 0 0 1 0 0 0 1 0]",
          "PointsPolygons [3] [0 1 -1] \"P\" [0 0 0 1 0 0 0 1 0]",
          "GeneralPolygon [2147483647 2147483647] \"P\" [0 0 0 1 0 0 0 1 0]",
          "PointsGeneralPolygons [2147483647] [3] [0 1 2] \"P\" [0 0 0 1 0 0 0 1 0]",
          "SubdivisionMesh \"catmull-clark\" [2147483647] [0 1 2] \"P\" [0 0 0]",
          "Curves \"cubic\" [2147483647] \"nonperiodic\" \"P\" [0 0 0]",
          "Curves \"linear\" [2147483647 2147483647 2147483647] \"periodic\" \"P\" [0 0 0]",
          "Blobby 2147483647 [0 2147483647 0] [] []", "Blobby 1 [1001 2147483647] [1] []",
          "Blobby 1 [0] [] []", "Blobby 1 [9000] [] []", "Blobby 1 [1003 0] [1] []",
          "Polygon \"P\" [0 0 0 1 0 0 0 1 0] \"uniform float[2000000000] x\" [1]",
          "Polygon \"P\" [0 0 0 1 0 0 0 1 0] \"vertex float[1000000] x\" [1]"}) {
        const Reading r(world(text));
        EXPECT_GE(r.messages.size(), 1u) << text;
        EXPECT_TRUE(r.said("test.rib:2:")) << r.said();
        for (const rib::Primitive& p : r.scene().primitives) {
            EXPECT_EQ(p.params.params.size(), 1u) << text; // only the parameter was at fault
        }
    }
    EXPECT_EQ(
        Reading(world("TrimCurve [2147483647] [2] [0 0 1 1] [0] [1] [2147483647] [0] [0] [1]"))
            .code(),
        base::Code::Consistency);
    EXPECT_EQ(Reading("Format 2147483647 2147483647 1").code(), base::Code::Range);
    EXPECT_EQ(Reading("ColorSamples [2147483648] Format 1 1 1").code(), base::Code::Consistency);
    EXPECT_EQ(Reading("FrameBegin 2147483648").code(), base::Code::Range);
}

TEST(Hostile, NumbersThatAreNone) {
    for (const char* text : {"Sphere nan -1 1 360", "Sphere inf -1 1 360", "Translate 1e 0 0",
                             "Sphere 0x10 -1 1 360"}) {
        const Reading r(world(text));
        EXPECT_GE(r.messages.size(), 1u) << text;
        EXPECT_EQ(r.scene().primitives.size(), 0u);
    }
    const Reading huge(
        world("Translate 1e999 0 0 Scale 1e999 1 1 Scale 1e999 1 1 Sphere 1e999 -1e999 1e999 360"));
    for (const rib::Transform& t : huge.scene().transforms) {
        EXPECT_TRUE(std::isfinite(t.still().m[0][0]));
    }
}

TEST(Hostile, DeepNesting) {
    std::string text, ends;
    for (int i = 0; i < 10'000; ++i) {
        text += i % 3 == 0   ? "AttributeBegin "
                : i % 3 == 1 ? "TransformBegin "
                             : "SolidBegin \"union\" ";
    }
    const Reading r("WorldBegin " + text);
    EXPECT_TRUE(r.said("end of input inside"));
    EXPECT_LT(r.messages.size(), 100u); // the outermost tell enough

    std::string conditions;
    for (int i = 0; i < 10'000; ++i) {
        conditions += "IfBegin \"1\" ";
    }
    EXPECT_GE(Reading(conditions).messages.size(), 1u);
    EXPECT_EQ(Reading("IfBegin \"" + std::string(10'000, '(') + "\" IfEnd").code(),
              base::Code::Syntax);
    EXPECT_GE(Reading(std::string(10'000, '[')).messages.size(), 1u);

    std::string archives;
    for (int i = 0; i < 200; ++i) {
        archives += "ArchiveBegin \"" + std::to_string(i) + "\" ReadArchive \"" +
                    std::to_string(i + 1) + "\" ArchiveEnd ";
    }
    EXPECT_EQ(Reading(archives + "ReadArchive \"0\"").code(), base::Code::Limit);
}

TEST(Hostile, TooManyBlocksAreRefused) {
    std::string text;
    for (int i = 0; i < 100'100; ++i) {
        text += "TransformBegin ";
    }
    std::string ends;
    for (int i = 0; i < 100'100; ++i) {
        ends += "TransformEnd ";
    }
    const Reading r("Color 1 0 0 " + text + ends + world("Sphere 1 -1 1 360"));
    EXPECT_EQ(r.messages.size(), 1u) << r.said().substr(0, 400);
    EXPECT_EQ(r.scene().primitives.size(), 1u);
}

TEST(Hostile, LongTokens) {
    EXPECT_GE(Reading(std::string(3'000'000, 'x')).messages.size(), 1u);
    EXPECT_GE(Reading("Sphere " + std::string(3'000'000, '1')).messages.size(), 1u);
    EXPECT_GE(Reading("Surface \"" + std::string(3'000'000, 'x')).messages.size(), 1u);
    const Reading r("Declare \"" + std::string(1'000'000, 'x') + "\" \"uniform " +
                    std::string(1'000'000, 'y') + "\"");
    ASSERT_EQ(r.messages.size(), 1u);
    EXPECT_LT(r.messages[0].size(), 500u);
}

TEST(Hostile, StringsWithControlBytesDoNotReachTheTerminal) {
    const Reading r("Sfere\x1b[31m 1 Surface \"a\" Imager \"\\033[2J\" Hider \"\\033x\" Procedural "
                    "\"\\033\" \"\" 0 0 0 0 0 0 " +
                    world(""));
    EXPECT_EQ(r.said().find('\x1b'), std::string::npos);
}

} // namespace
