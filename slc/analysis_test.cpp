// SPDX-License-Identifier: Apache-2.0
// Uniform/varying inference, needed variables and facts, as the object records them.
#include "slc/builtins.h"
#include "slc/slc_testing.h"

#include <sstream>

namespace slc {
namespace {

using testing::compile;
using testing::surface;

std::string names(std::uint64_t mask) {
    std::string out;
    for (int i = 0; i < SL_VAR_COUNT; ++i) {
        if ((mask >> i & 1) != 0) {
            out += (out.empty() ? "" : " ") +
                   std::string(variable_rows()[static_cast<std::size_t>(i)].name);
        }
    }
    return out;
}

Facts facts_of(const std::string& text) {
    const auto c = compile(text);
    EXPECT_EQ(c.unit.num_errors, 0U) << c.messages;
    if (c.unit.programs.empty()) {
        return {};
    }
    Program program = c.unit.programs[0];
    resolve_area_operators(program, {});
    const auto complaints = verify_ir(program);
    EXPECT_TRUE(complaints.empty()) << complaints.front() << print_ir(program);
    return analyse(program);
}

struct Need {
    const char* text;
    const char* needed; // in table order
};

TEST(Needed, Exact) {
    const Need cases[] = {
        {"surface a() { Ci = Cs; Oi = Os; }", "Cs Os"},
        {"surface a() { Ci = 1; }", ""},                            // Oi stays what the engine has
        {"surface a() { float x = s; Ci = t; Oi = 1; }", "t"},      // dead code
        {"surface a() { N = 0; Ci = color N; }", ""},               // overwritten before it is read
        {"surface a() { if (s > 0) N = 1; Ci = color N; }", "N s"}, // on some ways only
        {"surface a() { if (s > 0) N = 1; else N = 2; Ci = color N; }", "s"},
        {"surface a() { if (s > 0) Ci = 1; }", "s Ci"},   // result kept on the other way
        {"surface a() { Ci = diffuse(N); }", "P N"},      // what the built-in reads
        {"surface a() { P = 0; Ci = diffuse(N); }", "N"}, // ... unless it was set
        {"surface a() { Ci = faceforward(N, I) . I; }", "N Ng I"},
        {"surface a() { Ci = texture(\"x\"); }", "s t"},
        {"surface a() { Ci = texture(\"x\", u, v, u, v, u, v, u, v); }", "u v"},
        {"surface a() { Ci = 0; while (s > 1) { Ci += Cs; s = 0; } }", "s Cs"},
        {"surface a() { Ci = 0; while (s > 1) { float x = Os . Os; s = 0; } }",
         ""}, // loop without effect
        {"surface a() { if (s > 0) return; Ci = Cs; }", "s Cs Ci"},
        {"surface a() { Ci = Cs; if (u > 0) return; }", "Cs"},
        {"surface a() { illuminance(P) Ci += Cl; }", "P Ci"},
        {"surface a() { Ci = 0; illuminance(Ng, N, 1) { Ci += Cl; if (u > 0) break; } }", "N Ng u"},
        {"surface a() { printf(\"%f\", v); }", "v"},
        {"surface a(output float x = 0) { x = v; }", "v"},
        {"surface a() { float x = v; x = 1; Ci = x; }", ""},
        {"surface a() { float f(float x) { extern float u; return x; } Ci = f(v) + 0 * u; }",
         "u v"},
        {"light a() { Cl = 1; }", ""},
        {"light a() { illuminate(point 0) Cl = 1 / (L . L); }", "Ps"},
        {"light a() { illuminate(P, N, 1) Cl = 1; }", "P N Ps"},
        {"light a() { solar() Cl = 1; }", "Ns"},
        {"light a() { Cl += 1; }", "Cl"},
        {"displacement a() { P += N; }", "P N"},
        {"displacement a() { N = calculatenormal(P); }", "N Ng dPdu dPdv du dv"},
        {"volume a() { Ci = mix(Ci, color 0, length(I)); }", "I Ci"},
        {"imager a() { Ci += 1 - alpha; alpha = 1; }", "Ci alpha"},
    };
    for (const Need& c : cases) {
        EXPECT_EQ(names(facts_of(c.text).needed), c.needed) << c.text;
    }
}

TEST(Needed, FoldedCodeNeedsNothing) {
    EXPECT_EQ(names(facts_of("surface a() { if (\"x\" == \"y\") Ci = Cs; else Ci = 1; }").needed),
              "");
    EXPECT_EQ(
        names(facts_of("surface a() { uniform float k = 0; if (k != 0 && noise(P) > k) Ci = Cs; }")
                  .needed),
        "");
}

TEST(Needed, AuxiliarySlice) {
    EXPECT_EQ(names(facts_of("surface a() { Ci = Cs * Du(s * 2) + v; }").needed_aux), "s");
    EXPECT_EQ(names(facts_of("surface a() { color x = diffuse(N); Ci = Du(x); }").needed_aux),
              ""); // lights are 0 there
    EXPECT_EQ(names(facts_of("surface a() { float x; if (u > .5) x = s; Ci = Du(x); }").needed_aux),
              "s"); // u differs by du
    EXPECT_EQ(names(facts_of("surface a() { Ci = texture(\"x\"); }").needed_aux), "s t");
    EXPECT_EQ(names(facts_of("surface a() { Ci = Cs; }").needed_aux), "");
}

TEST(Needed, Reasons) {
    const Facts f = facts_of("surface a() {\n Ci = diffuse(N);\n}");
    ASSERT_EQ(f.reasons.size(), 2U);
    EXPECT_EQ(f.reasons[0], "N: read at test.sl:2:7");
    EXPECT_EQ(f.reasons[1], "P: read by diffuse() at test.sl:2:7");
}

TEST(Facts, Bits) {
    struct Case {
        const char* text;
        std::uint32_t facts;
    };
    const Case cases[] = {
        {"surface a() { Ci = Os; Oi = Os; }", 0},
        {"surface a() { Oi = .5; }", SL_FACT_writes_opacity},
        {"surface a() { Ci = ambient(); }", SL_FACT_lights | SL_FACT_ambient},
        {"surface a() { illuminance(P) Ci += Cl; }", SL_FACT_lights},
        {"surface a() { Ci = noise(transform(\"object\", P)); }", SL_FACT_object_space},
        {"surface a(string sp = \"x\") { Ci = noise(transform(sp, P)); }",
         SL_FACT_object_space | SL_FACT_shader_space},
        {"surface a() { Ci = noise(transform(\"shader\", P)); }", SL_FACT_shader_space},
        {"surface a(float x = xcomp(point \"shader\" (1, 0, 0))) { Ci = x; }",
         SL_FACT_shader_space},
        {"surface a() { float x; attribute(\"y\", x); Ci = x; }", SL_FACT_attributes},
        {"surface a() { Ci = random(); }", SL_FACT_random},
        {"surface a() { Ci = trace(P, I); }", SL_FACT_traces | SL_FACT_area_operators},
        {"surface a() { Ci = environment(\"x\", I); }", SL_FACT_textures | SL_FACT_area_operators},
        {"light a() { illuminate(P) Cl = 1; }", SL_FACT_directional},
        {"light a() { solar(vector 1, 0) Cl = 1; }", SL_FACT_directional | SL_FACT_solar},
        {"light a() { Cl = 1; }", 0},
    };
    for (const Case& c : cases) {
        EXPECT_EQ(facts_of(c.text).facts, c.facts) << c.text;
    }
}

// Detail of the named variable after the passes; "" if it is gone.
std::string detail_of(const std::string& text, const std::string& name) {
    const auto c = compile(text, false);
    if (c.unit.programs.empty()) {
        return c.messages;
    }
    const Program& program = c.unit.programs[0];
    for (const Var& v : program.vars) {
        if (v.name == name) {
            return std::string(detail_name(v.detail));
        }
    }
    return "";
}

TEST(Detail, Inference) {
    struct Case {
        const char* body;
        const char* detail; // of x
    };
    const Case cases[] = {
        {"float x = 1;", "uniform"},
        {"float x = s;", "varying"},
        {"float x = k * 2;", "uniform"},
        {"float x = 1; x = s;", "varying"},
        {"float x = 0; if (s > 0) x = 1;", "varying"},
        {"float x = 0; if (k > 0) x = 1;", "uniform"},
        {"float i, x = 0; for (i = 0; i < k; i += 1) x += i;", "uniform"},
        {"float i, x = 0; for (i = 0; i < k; i += 1) { x += i; if (s > x) break; }", "varying"},
        {"float i, x = 0; for (i = 0; i < k; i += 1) { if (s > i) continue; x += 1; }", "varying"},
        {"float i, x = 0; for (i = 0; i < k; i += 1) { if (k > i) continue; x += 1; }", "uniform"},
        {"float i, x = 0; for (i = 0; i < s; i += 1) x += 1;", "varying"},
        {"float x = 0; illuminance(P) x += 1;", "varying"},
        {"float x = noise(k);", "uniform"},
        {"float x = noise(P);", "varying"},
        {"float x = random();", "varying"},
        {"uniform float x = random();", "uniform"},
        {"float a[2] = {1, 2}; float x = a[s];", "varying"},
        {"float a[2] = {1, 2}; float x = a[k];", "uniform"},
        {"string x = \"a\"; if (s > 0) x = \"b\";", "varying"},
        {"if (s > 0) return; float x = 1; Ci = x;", "uniform"}, // all that get here are in its home
        {"float x = 0; if (s > 0) return; x = 1; Ci = x;", "uniform"},
        {"float x = 0; while (s > x) { if (t > 0) { x = 2; } }", "varying"},
        {"if (s > 0) { float x = 0, i; for (i = 0; i < 3; i += 1) x += i; Ci = x; }", "uniform"},
        {"while (s > 0) { float x; x += 1; s -= x; }", "uniform"}, // set anew in each round
    };
    for (const Case& c : cases) {
        EXPECT_EQ(detail_of("surface t(uniform float k = 2;) { " + std::string(c.body) + " }", "x"),
                  c.detail)
            << c.body;
    }
}

TEST(Detail, FunctionsTakeTheDetailOfTheirArguments) {
    const std::string f = "float f(float a) { float x = a * 2; return x; } ";
    EXPECT_EQ(detail_of(f + surface("Ci = f(2);"), "x"), "uniform");
    EXPECT_EQ(detail_of(f + surface("Ci = f(s);"), "x"), "varying");
}

} // namespace
} // namespace slc
