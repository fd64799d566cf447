// SPDX-License-Identifier: Apache-2.0
// The binary encoding as it is read: every form of token, in any mix with text, whole or cut.
#include "ribtools/rib_lex.h"
#include "ribtools/test_util.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace {

using rib::Lexer;
using rib::Token;
using rib::TokenKind;
using rib_test::Reading;
using rib_test::world;

// "81 00 c8" to bytes; what stands in quotes is text.
std::string bytes(const std::string& hex) {
    std::string out;
    for (std::size_t i = 0; i < hex.size(); ++i) {
        if (hex[i] == '\'') {
            const std::size_t end = hex.find('\'', i + 1);
            out += hex.substr(i + 1, end - i - 1);
            i = end;
        } else if (hex[i] != ' ') {
            out += static_cast<char>(std::stoi(hex.substr(i, 2), nullptr, 16));
            ++i;
        }
    }
    return out;
}

// Hands out a few bytes at a time.
class Trickle final : public rib::ByteSource {
public:
    Trickle(std::string text, std::size_t step) : text_(std::move(text)), step_(step) {}
    std::size_t read(char* buffer, std::size_t size) override {
        const std::size_t n = std::min({step_, size, text_.size() - at_});
        text_.copy(buffer, n, at_);
        at_ += n;
        return n;
    }
    std::size_t size_hint() const override { return 64; }
    const std::string& error() const override { return error_; }

private:
    std::string text_, error_;
    std::size_t step_, at_ = 0;
};

std::vector<Token> tokens(const std::string& stream, std::size_t step = 1000) {
    Lexer lexer(std::make_unique<Trickle>(stream, step), {1, 1, 1}, nullptr);
    std::vector<Token> all;
    for (lexer.advance(); lexer.token().kind != TokenKind::End; lexer.advance()) {
        all.push_back(lexer.token());
    }
    return all;
}

double number(const std::string& hex) {
    const auto t = tokens(bytes(hex));
    EXPECT_EQ(t.size(), 1u) << hex;
    EXPECT_EQ(t.at(0).kind, TokenKind::Number) << hex;
    return t.at(0).number;
}

// Token kinds as letters, with their contents.
std::string shape(const std::vector<Token>& all) {
    std::string text;
    for (const Token& t : all) {
        switch (t.kind) {
        case TokenKind::Name:
            text += t.text + " ";
            break;
        case TokenKind::Number: {
            char digits[32];
            std::snprintf(digits, sizeof digits, "%g ", t.number);
            text += digits;
            break;
        }
        case TokenKind::String:
            text += "\"" + t.text + "\" ";
            break;
        case TokenKind::ArrayBegin:
            text += "[ ";
            break;
        case TokenKind::ArrayEnd:
            text += "] ";
            break;
        case TokenKind::Bad:
            text += "! ";
            break;
        case TokenKind::End:
            break;
        }
    }
    return text;
}

TEST(Binary, IntegersAreSigned) {
    EXPECT_EQ(number("80 05"), 5);
    EXPECT_EQ(number("80 ff"), -1);
    EXPECT_EQ(number("81 00 b4"), 180);
    EXPECT_EQ(number("82 80 00 00"), -8388608);
    EXPECT_EQ(number("83 7f ff ff ff"), 2147483647);
    EXPECT_EQ(number("83 80 00 00 00"), -2147483648.0);
    EXPECT_TRUE(tokens(bytes("80 05"))[0].is_integer);
    EXPECT_FALSE(tokens(bytes("85 00 90"))[0].is_integer);
}

TEST(Binary, FixedPoint) {
    EXPECT_EQ(number("85 ff 70"), -0.5625);
    EXPECT_EQ(number("85 00 90"), 0.5625);
    EXPECT_EQ(number("89 19 99"), 0x1999 / 65536.0);
    EXPECT_EQ(number("89 b3 34"), -0x4ccc / 65536.0);
    EXPECT_EQ(number("8a 03 07 ae"), 0x307ae / 65536.0);
    EXPECT_EQ(number("8a 01 eb 23"), 0x1eb23 / 65536.0);
    EXPECT_EQ(number("8c 80"), -128 / 16777216.0);
    EXPECT_EQ(number("84 80"), -.5);
    EXPECT_EQ(number("8f 7f ff ff ff"), 2147483647 / 16777216.0);
}

TEST(Binary, Reals) {
    EXPECT_EQ(number("a4 3f 80 00 00"), 1);
    EXPECT_TRUE(std::signbit(number("a4 80 00 00 00")));
    EXPECT_EQ(number("a4 00 00 00 01"), std::ldexp(1., -149));
    EXPECT_EQ(number("a5 40 09 21 fb 54 44 2d 18"), 3.14159265358979311600);
    EXPECT_EQ(number("a5 00 00 00 00 00 00 00 01"), std::numeric_limits<double>::denorm_min());
}

TEST(Binary, StringsOfAllForms) {
    EXPECT_EQ(shape(tokens(bytes("90 92 'lh' a0 03 'abc' a1 00 01 'x' a2 00 00 01 'y' "
                                 "a3 00 00 00 01 'z'"))),
              "\"\" \"lh\" \"abc\" \"x\" \"y\" \"z\" ");
    EXPECT_EQ(tokens(bytes("93 5c 6e 22"))[0].text, "\\n\""); // no escapes
    EXPECT_EQ(tokens(bytes("92 ff a6"))[0].text, "\xff\xa6"); // nor tokens
    const std::string lengthy(70'000, 'q');
    EXPECT_EQ(tokens(bytes("a2 01 11 70") + lengthy, 999)[0].text, lengthy);
}

TEST(Binary, DefinitionsAndReferences) {
    EXPECT_EQ(shape(tokens(bytes("cc 37 9b 'Orientation' a6 37 cd 00 92 'lh' cf 00"))),
              "Orientation \"lh\" ");
    // One and two bytes name the same code; a definition replaces; quoted text, a reference.
    EXPECT_EQ(shape(tokens(bytes("ce 00 07 91 'a' cf 07 d0 00 07 cd 07 '\"b\\n\"' cf 07 "
                                 "ce ff ff cf 07 d0 ff ff"))),
              "\"a\" \"a\" \"b\n\" \"b\n\" ");
    // Anywhere between tokens: in arrays, between a parameter and its value.
    EXPECT_EQ(shape(tokens(bytes("'[1 ' cd 01 91 'x' ' 2]' '[' cd 02 91 'y' cf 02 ']'"))),
              "[ 1 2 ] [ \"y\" ] ");
}

TEST(Binary, ArraysOfFloats) {
    EXPECT_EQ(shape(tokens(bytes("c8 02 3f 80 00 00 40 00 00 00 c9 00 01 40 40 00 00 c8 00 "
                                 "ca 00 00 00 cb 00 00 00 01 bf 80 00 00 'X'"))),
              "[ 1 2 ] [ 3 ] [ ] [ ] [ -1 ] X ");
}

TEST(Binary, TextAndBinaryInOneStream) {
    EXPECT_EQ(shape(tokens(bytes("5b 80 01 5d"))), "[ 1 ] ");
    EXPECT_EQ(shape(tokens(bytes("'version' 8a 03 07 ae '#c' 0a 'A 1' 80 02 '3\"s\"' 91 't[1' a4 "
                                 "3f 80 00 00 ']B'"))),
              "version 3.03 A 1 2 3 \"s\" \"t\" [ 1 1 ] B ");
}

TEST(Binary, WorkedExampleOfTheReference) {
    const std::string stream = bytes(
        "cc 10 96 'Format' a6 10 81 00 c8 81 00 96 a4 3f 80 00 00 cc 14 9a 'Projection' a6 14 "
        "cd 0b 9b 'perspective' cf 0b cd 0c 93 'fov' cf 0c c8 01 42 10 00 00 cc 40 96 'Rotate' "
        "a6 40 a4 43 34 00 00 a4 00 00 00 00 a4 3f 80 00 00 a4 00 00 00 00 "
        "'WorldBegin Sphere 1 -1 1 360 WorldEnd'");
    const Reading r(stream);
    EXPECT_EQ(r.said(), "");
    const rib::Options& o = r.scene().options;
    EXPECT_EQ(o.xres, 200);
    EXPECT_EQ(o.yres, 150);
    EXPECT_EQ(o.projection, "perspective");
    EXPECT_EQ(o.fov_deg, 36.f);
}

// The tokens do not depend on where blocks end.
TEST(Binary, AnyBlocks) {
    const std::string stream =
        bytes("cc 00 95 'Scale' a6 00 a4 3f 80 00 00 a5 3f f0 00 00 00 00 00 00 83 00 00 00 01 "
              "'Color[' 84 40 cd 05 a0 03 'abc' 8a 01 00 00 ']' '\"x\"' c8 03 3f 80 00 00 40 00 00 "
              "00 40 40 00 00 cf 05 'T'");
    const std::string whole = shape(tokens(stream));
    EXPECT_EQ(whole, "Scale 1 1 1 Color [ 0.25 1 ] \"x\" [ 1 2 3 ] \"abc\" T ");
    for (std::size_t step = 1; step < 20; ++step) {
        EXPECT_EQ(shape(tokens(stream, step)), whole) << step;
    }
}

TEST(Binary, ArraysGoStraightToVectors) {
    std::string stream = bytes("ca 00 9c 40"); // 40,000 floats
    for (int i = 0; i < 40'000; ++i) {
        const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(i) * .5f);
        for (int shift = 24; shift >= 0; shift -= 8) {
            stream += static_cast<char>(bits >> shift);
        }
    }
    for (const std::size_t step : {7u, 1000u, 300'000u}) {
        Lexer lexer(std::make_unique<Trickle>(stream + "End", step), {1, 1, 1}, nullptr);
        lexer.advance();
        std::vector<float> values;
        ASSERT_TRUE(lexer.read_floats(values));
        ASSERT_EQ(values.size(), 40'000u);
        EXPECT_EQ(values[39'999], 19'999.5f);
        lexer.advance();
        EXPECT_EQ(lexer.token().text, "End");
    }
}

TEST(Binary, MistakesAreNamedWithTheirByte) {
    const struct {
        const char *hex, *message;
    } cases[] = {
        {"'Sides ' a7 'Sides 1'", "test.rib:byte 6: error: Sides: expected a number for 'sides', "
                                  "got reserved binary code '\\247'; request skipped"},
        {"'Sides ' cf 09 'Sides 1'", "undefined binary string code '9'"},
        {"a6 30 80 01 'Sides 1'", "test.rib:byte 0: error: expected a request name, got "
                                  "undefined binary request code '48'"},
        {"cd 01 80 05 'Sides 1'", "no string in a binary definition"},
        {"cc 01 93 'a b' a6 01 'Sides 1'", "the string of a binary definition is no request name"},
        {"'Sides ' 83 00 00", "test.rib:byte 6: error: Sides: expected a number for 'sides', got "
                              "binary data cut short by the end of the stream"},
        {"'MotionBegin' c8 03 3f 80 00 00 3f", "cut short"},
        {"'Surface' a3 ff ff ff ff 'abc'", "cut short"},
        {"'Declare' 91 'x' d1 80", "reserved binary code '\\321'"},
        {"'Color[' c8 01 3f 80 00 00 ']'", "expected numbers"},
    };
    for (const auto& c : cases) {
        const Reading r(bytes(c.hex));
        EXPECT_TRUE(r.said(c.message)) << c.hex << "\n" << r.said();
        EXPECT_LE(r.messages.size(), 2u) << r.said();
    }
}

TEST(Binary, NumbersThatAreNotFiniteCostTheRequest) {
    const Reading r(world(bytes("'Polygon \"P\"' c8 09 7f c0 00 00 7f 80 00 00 ff 80 00 00 "
                                "00 00 00 00 00 00 00 00 00 00 00 00 3f 80 00 00 3f 80 00 00 "
                                "00 00 00 00 'Sphere 1 -1 1 360'")));
    EXPECT_TRUE(r.said("Polygon: 3 numbers that are not finite; request skipped")) << r.said();
    EXPECT_EQ(r.messages.size(), 1u);
    EXPECT_EQ(r.scene().primitives.size(), 1u);
    // A block is opened all the same, with numbers that RIB text can hold.
    const Reading motion(bytes("'MotionBegin' c8 02 7f c0 00 00 7f 80 00 00 "
                               "'Translate 0 0 1 Translate 0 0 2 MotionEnd'"));
    EXPECT_TRUE(motion.said("NaN is read as 0, infinity as the largest number")) << motion.said();
    EXPECT_EQ(motion.messages.size(), 1u) << motion.said();
}

// The codes of a stream hold in what it records, even when they change afterwards.
TEST(Binary, InlineArchivesKeepTheirCodes) {
    const Reading r(bytes(
        "cd 01 98 'constant' cc 02 96 'Sphere' cc 03 8a 00 00 00 cc 03 9a 'ArchiveEnd' "
        "'ArchiveBegin \"a\"' cd 07 96 'smooth' 'ShadingInterpolation' cf 07 'Surface' cf 01 a6 02 "
        "80 01 80 ff 80 01 81 01 68 a6 03 cd 01 93 'xyz' cc 02 95 'Scale' "
        "'WorldBegin ReadArchive \"a\" ReadArchive\"a\" WorldEnd'"));
    EXPECT_TRUE(r.said("no string in a binary definition")) << r.said();
    ASSERT_EQ(r.backend.scenes.size(), 1u);
    EXPECT_EQ(r.scene().primitives.size(), 2u);
    EXPECT_EQ(r.scene().shaders.at(0).name, "constant");
}

// Two bytes must not make megabytes, over and over.
TEST(Binary, CodesCannotFillTheMemory) {
    std::string stream = bytes("cd 00 a2 10 00 00") + std::string(1 << 20, 'x') +
                         "Attribute \"user\" \"string[2] s\" [";
    for (int i = 0; i < 1'000'000; ++i) {
        stream += "\xcf";
        stream += '\0';
    }
    const Reading r(stream + "]");
    EXPECT_TRUE(r.said("too much text called up by binary string codes")) << r.said();
}

TEST(Binary, CutAnywhere) {
    const std::string stream = bytes(
        "cc 00 95 'Scale' a6 00 a4 3f 80 00 00 a5 3f f0 00 00 00 00 00 00 83 00 00 00 01 "
        "'Color[' 84 40 cd 05 a0 03 'abc' 8a 01 00 00 80 00 ']Polygon\"P\"' c8 03 3f 80 00 00 "
        "40 00 00 00 40 40 00 00 'Surface' cf 05");
    for (std::size_t n = 0; n < stream.size(); ++n) {
        const Reading r(stream.substr(0, n));
        EXPECT_LE(r.messages.size(), 3u) << r.said();
    }
}

} // namespace
