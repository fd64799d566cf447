// SPDX-License-Identifier: Apache-2.0
// Input that nobody should write: it ends with messages, never with a crash, and in bounded time
// and memory.
#include "slc/slc_testing.h"

namespace slc {
namespace {

using testing::compile;
using testing::surface;

std::string repeat(const std::string& text, int n) {
    std::string out;
    for (int i = 0; i < n; ++i) {
        out += text;
    }
    return out;
}

struct Hostile {
    std::string text;
    const char* message; // some part of what is said; "" = anything
};

TEST(Hostile, DeepNesting) {
    const Hostile cases[] = {
        {surface(repeat("{", 10000)), "nested more than"},
        {surface("Ci = " + repeat("(", 10000)), "nested more than"},
        {surface("Ci = " + repeat("-", 10000) + "1;"), "nested more than"},
        {surface("Ci = " + repeat("color ", 10000) + "1;"), "nested more than"},
        {surface("Ci = " + repeat("sin(", 10000)), "nested more than"},
        {surface("Ci = " + repeat("s ? 1 : ", 10000) + "1;"), "nested more than"},
        {surface(repeat("if (s) ", 10000) + ";"), "nested more than"},
        {surface(repeat("float f() { ", 10000)), "nested more than"},
        {surface("Ci = " + repeat("s = ", 10000) + "1;"), "nested more than"},
        {surface("Ci = 1" + repeat(" + 1", 10000) + ";"), "more than 1000 operators"},
    };
    for (const Hostile& c : cases) {
        const auto r = compile(c.text);
        EXPECT_GT(r.unit.num_errors, 0U);
        EXPECT_NE(r.messages.find(c.message), std::string::npos) << r.messages.substr(0, 500);
        EXPECT_LT(r.messages.size(), 20000U);
    }
}

TEST(Hostile, LongButLegal) {
    EXPECT_EQ(compile(surface("Ci = 1" + repeat(" + 1", 900) + ";")).unit.num_errors, 0U);
    EXPECT_EQ(compile(surface(repeat("Ci = 1;", 20000))).unit.num_errors, 0U);
    EXPECT_EQ(compile(surface(repeat("{", 200) + "Ci = 1;" + repeat("}", 200))).unit.num_errors,
              0U);
    EXPECT_EQ(compile(repeat("float f(float x) { return x; }\n", 50) + surface("Ci = f(1);"))
                  .unit.num_errors,
              0U);
}

// Each function calls the one before twice: 2^40 statements if inlined.
TEST(Hostile, InliningIsBounded) {
    std::string text = "float f0(float x) { return x + 1; }\n";
    for (int i = 1; i <= 40; ++i) {
        const std::string inner = "f" + std::to_string(i - 1);
        text += "float f" + std::to_string(i) + "(float x) { return " + inner + "(x) + " + inner +
                "(x); }\n";
    }
    const auto wide = compile(text + surface("Ci = f40(s);"));
    EXPECT_NE(wide.messages.find("statements"), std::string::npos) << wide.messages;
    std::string chain = "float f0(float x) { return x + 1; }\n";
    for (int i = 1; i <= 5000; ++i) {
        chain += "float f" + std::to_string(i) + "(float x) { return f" + std::to_string(i - 1) +
                 "(x); }\n";
    }
    const auto deep = compile(chain + surface("Ci = f5000(s);"));
    EXPECT_NE(deep.messages.find("nested too deeply"), std::string::npos) << deep.messages;
}

TEST(Hostile, Lists) {
    const auto arguments = compile(surface("printf(\"x\"" + repeat(", s", 100000) + ");"));
    EXPECT_NE(arguments.messages.find("more than 1000 arguments"), std::string::npos);
    EXPECT_EQ(compile(surface("printf(\"x\"" + repeat(", s", 900) + ");")).unit.num_errors, 0U);
    std::string params;
    for (int i = 0; i < 10000; ++i) {
        params += "float p" + std::to_string(i) + " = 1; ";
    }
    const auto many = compile("surface a(" + params + ") { Ci = p1; }");
    EXPECT_NE(many.messages.find("more than 2000 parameters"), std::string::npos);
    EXPECT_EQ(compile(surface("printf(\"" + std::string(1 << 20, 'x') + "\");")).unit.num_errors,
              0U);
}

TEST(Hostile, Arrays) {
    EXPECT_GT(compile(surface("float a[2147483648];")).unit.num_errors, 0U);
    EXPECT_GT(compile(surface("float a[1e30];")).unit.num_errors, 0U);
    EXPECT_GT(compile(surface("float a[-1];")).unit.num_errors, 0U);
    EXPECT_GT(compile(surface("float a[0/0];")).unit.num_errors, 0U);
    std::string many;
    for (int i = 0; i < 100; ++i) {
        many += "matrix m" + std::to_string(i) + "[65536]; ";
    }
    EXPECT_NE(compile(surface(many)).messages.find("too many variables"), std::string::npos);
}

// Nested loops must not make the analyses exponential.
TEST(Hostile, NestedLoops) {
    const std::string text =
        repeat("while (s > 0) { if (t > 0) break; ", 100) + "Ci += s; s -= 1; " + repeat("}", 100);
    EXPECT_EQ(compile(surface(text)).unit.num_errors, 0U);
}

const char* const sample =
    "#pragma x\n"
    "float f(float a; output color b[2]) { extern vector I; b[1] += a; return a . 1 ? 2 : (3); }\n"
    "surface t(string s2 = \"x\\n\"; float m[3] = {1, -2e3, .5}; output varying point p = point "
    "\"shader\" (1, 2, 3);) {\n"
    "  float i; color c[2] = {(1, 2, 3), 0}; /* note */ for (i = 0; i < 3; i += 1) { if (noise(P) "
    "> .5) break; else continue; }\n"
    "  illuminance(\"a\", P, N, PI/2, \"light:x\", i) { Ci += Cl * L.N ^ N; } // end\n"
    "  Ci = mix(texture(s2[1], s, t), c[i], f(1, c)) * !i && 1 || 0; return; }\n";

TEST(Hostile, TruncatedAtEveryByte) {
    const std::string text = sample;
    for (std::size_t n = 0; n < text.size(); ++n) {
        compile(text.substr(0, n));
    }
}

TEST(Hostile, EveryByteChanged) {
    const std::string text = sample;
    constexpr char bytes[] = "(){}[];,\"=.-+0a\0\x80\xff\n";
    const std::string replacements(bytes, sizeof bytes - 1);
    for (std::size_t n = 0; n < text.size(); ++n) {
        std::string changed = text;
        changed[n] = replacements[n % replacements.size()];
        compile(changed);
        changed.erase(n, 1);
        compile(changed);
    }
}

// Random sequences of the language's own tokens get further than random bytes.
TEST(Hostile, TokenSoup) {
    const char* const words[] = {
        "float",   "color",       "point", "string", "matrix",     "void",  "uniform", "varying",
        "output",  "extern",      "if",    "else",   "while",      "for",   "break",   "return",
        "surface", "illuminance", "(",     ")",      "{",          "}",     "[",       "]",
        ";",       ",",           "=",     "+=",     "+",          "-",     "*",       "/",
        "^",       ".",           "<",     "==",     "&&",         "!",     "?",       ":",
        "1",       ".5",          "\"a\"", "x",      "P",          "N",     "Ci",      "noise",
        "f",       "texture",     "s",     "solar",  "illuminate", "gather"};
    std::uint32_t state = 1;
    const auto next = [&](std::size_t n) {
        state = state * 1664525u + 1013904223u;
        return (state >> 8) % n;
    };
    for (int round = 0; round < 2000; ++round) {
        std::string text = "surface a(float x = 1;) { ";
        const std::size_t length = next(60);
        for (std::size_t i = 0; i < length; ++i) {
            text += words[next(std::size(words))];
            text += ' ';
        }
        compile(text + (round % 2 == 0 ? "}" : ""));
    }
}

TEST(Hostile, Bytes) {
    std::uint32_t state = 7;
    for (int round = 0; round < 300; ++round) {
        std::string text;
        for (int i = 0; i < 200; ++i) {
            state = state * 1664525u + 1013904223u;
            text += static_cast<char>(state >> 24);
        }
        compile(text);
    }
    compile(std::string(1 << 20, '"'));
    compile(std::string(1 << 20, '('));
    compile(std::string(1 << 20, '\n') + "x");
    compile("# 4294967295 \"x\"\nsurface a() { Ci = q; }");
    compile("# 999999999999999999999 \"x\n");
}

} // namespace
} // namespace slc
