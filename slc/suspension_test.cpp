// SPDX-License-Identifier: Apache-2.0
// Shaders that wait for rays: emitted code whose packets are suspended and resumed in random order
// agrees with the interpreter, which is answered at once, wherever the waiting call stands. Rays
// are answered by a smooth function of origin, direction, footprint and options (OracleWorld). Also
// the table of suspension points itself: what is saved, and what is not.
#include "slc/builtins.h"
#include "slc/ir_util.h"
#include "slc/oracle_compare.h"
#include "slc/slc_testing.h"
#include "slc/suspension.h"

#include <algorithm>
#include <gtest/gtest.h>

namespace slc {
namespace {

struct WaitingCase {
    const char* name;
    const char* text; // a shader
};

constexpr WaitingCase cases[] = {
    {"Once", R"(surface t() { Ci = trace(P, reflect(I, N)) * Cs; Oi = Os; })"},
    {"TwiceInOneExpression",
     R"(surface t() { Ci = Cs * color trace(P, N) + color trace(P, I) / 2; Oi = Os; })"},
    {"InItsOwnArgument",
     R"(surface t() { Ci = color trace(P, vector(color trace(P, N)) + I); Oi = 1; })"},
    {"DivergentIf", R"(surface t() {
        color c = Cs; float k = u + 1;
        if (u > 0.9) { c += color trace(P, N) * k; k = 3; } else { c *= color trace(P, I); }
        Ci = c * k; Oi = c; })"},
    {"OnlyOneArm", R"(surface t() {
        color c = Cs; float a = v;
        if (u > 0.9) { float b = u * v; c = color trace(P, N) * b; a = 2; }
        else if (v > 0.9) { a = c; c = 0.5; }
        Ci = c * a; Oi = a; })"},
    {"UniformIf", R"(surface t(float on = 1; uniform float off = 0) {
        Ci = Cs;
        if (on > 0) Ci += color trace(P, N);
        if (off > 0) Ci += color trace(P, I); else Ci *= 2;
        Oi = Os; })"},
    {"UniformLoop", R"(surface t() {
        color c = 0; float i;
        for (i = 0; i < 3; i += 1) c = 0.5 * c + color trace(P + c, N * (i + 1));
        Ci = c; Oi = i; })"},
    {"VaryingLoop", R"(surface t() {
        color c = 0; float i = 0, sum = 0;
        while (i < 3 * u) { c += color trace(P, N + i); sum += i * comp(c, 0); i += 1; }
        Ci = c; Oi = sum; })"},
    {"BreakAndContinue", R"(surface t() {
        color c = 0; float i, n = 0;
        for (i = 0; i < 4; i += 1) {
            if (u + i > 3.2) break;
            n += 1;
            if (v > 0.9 + 0.2 * i) continue;
            c += color trace(P * i, N);
            if (comp(c, 1) > 1.4) break;
            c *= 0.75;
        }
        Ci = c; Oi = n; })"},
    {"BreakTwoLoops", R"(surface t() {
        color c = 0; float i, j;
        for (i = 0; i < 3; i += 1) {
            for (j = 0; j < 3; j += 1) {
                c += color trace(P + i, N - j) * (i + 1);
                if (comp(c, 0) > 4 * u) break 2;
                if (comp(c, 1) > 3 * v) continue 2;
            }
            c *= 0.9;
        }
        Ci = c; Oi = i + j; })"},
    {"InStep", R"(surface t() {
        color c = 0; float i;
        for (i = 0; i < 2 + u; i += 0.5 + comp(color trace(P, N), 0)) { c += i; if (v > 1.2) break; }
        Ci = c; Oi = i; })"},
    {"InCondition", R"(surface t() {
        float i = 0;
        while (comp(color trace(P, N * (i + 1)), 0) * 3 > i) i += 1;
        Ci = i; Oi = i; })"},
    {"Illuminance", R"(surface t() {
        color c = 0; normal n = normalize(N);
        illuminance (P, n, PI) { c += Cl * color trace(P, L) * (1 + normalize(L) . n); }
        Ci = c; Oi = Os; })"},
    {"IlluminanceBreak", R"(surface t() {
        color c = Cs; float n = 0;
        illuminance (P) {
            vector l = L;
            if (u > 1.1) { c += color trace(P, l); break; }
            n += 1;
            c += Cl * color trace(P, -l) + L . N + Ol;
        }
        Ci = c * n; Oi = n; })"},
    {"LightMessages", R"(surface t() {
        color c = 0; float x = 0.5;
        illuminance (P, "send:light:boost", x, "light:known", x) {
            c += x * color trace(P, L);
            float y = 0.25; lightsource("known", y); c += y;
        }
        Ci = c; Oi = x; })"},
    {"Functions", R"(
        color twice(vector d; float k) {
            if (k > 1) return trace(P, d) * k;
            color c = trace(P, d + k);
            return c + color trace(P, N);
        }
        surface t() { extern point P; extern normal N;
            Ci = twice(N, u) + twice(I, 2 * v) * twice(N + I, 0.25); Oi = Os; })"},
    {"ReturnsFromMain", R"(surface t() {
        Ci = Cs; Oi = 1;
        if (u > 1) { Ci = trace(P, N); return; }
        Ci += color trace(P, I); Oi = 0.5; })"},
    {"Fulltrace", R"(surface t() {
        color c; float d; point p, pm; vector n, rm;
        float level = fulltrace(P, N, c, d, p, n, pm, rm);
        if (u > 1) level += fulltrace(p, n, c, d, p, n, pm, rm);
        Ci = c + color(n) + level; Oi = color(p) + color(pm) * color(rm);
        if (d < 1e20) Oi += d; })"},
    {"FulltraceIntoOutputs", R"(surface t(output varying color c = 0.5; output varying float d = 2;
            output varying point p = point(1, 2, 3)) {
        point pm; vector n, rm; varying float x = u;
        if (u > 1) x += fulltrace(P, N, c, d, p, n, pm, rm);
        Ci = x; Oi = 1; d = min(d, 100); })"},
    {"Random", R"(surface t() {
        color c = random();
        if (u > 0.8) c += random() * color trace(P, N);
        Ci = c + color random() * color trace(P, I); Oi = float random(); })"},
    {"Arrays", R"(surface t() {
        float a[4]; color b[2]; uniform float k[2] = {0.25, 0.75}; float i;
        for (i = 0; i < 4; i += 1) a[i] = i * u;
        b[0] = Cs; b[1] = trace(P, N * a[1]);
        a[u * 2] = 3;
        b[0] += color trace(P, I + a[2]);
        k[1] = 2;
        Ci = b[0] + b[1] * a[3] + a[u * 2] * k[0]; Oi = k[1] * color trace(P, N); })"},
    {"Strings", R"(surface t() {
        string s = "shader"; uniform string w = "world";
        if (u > 1) s = "object";
        color c = trace(P, N);
        Ci = c * color(transform(s, P)) + color(transform(w, P)); Oi = 1; })"},
    {"Matrices", R"(surface t() {
        matrix m = translate(1, vector(u, v, 1)); matrix k = matrix "world" 1;
        color c = trace(transform(m, P), N);
        Ci = c + color(transform(m, P)) + color(transform(k, P)); Oi = 1; })"},
    {"WritesInputs", R"(surface t() {
        P = P + 0.25 * N; N = normalize(N);
        color c = trace(P, N);
        Cs = c * Cs; s = u;
        Ci = Cs * color trace(P, I) + diffuse(N) + s; Oi = color(P); })"},
    {"WritesTexturePlace", R"(surface t(varying float Kd = 0.5; output varying float seen = 0) {
        seen = 0.25;
        Ci = ambient() * color trace(P, N);
        seen += Kd;
        Ci += diffuse(N) * color trace(P, I); Oi = seen; })"},
    {"Options", R"(surface t(float b = 0.5) {
        Ci = color trace(P, N, "bias", b, "samples", u * 4, "label", "mirror", "unknown", 3);
        Oi = color trace(P, N, "maxdist", 10); })"},
    {"Conditions", R"(surface t() {
        float a = u > v, b = s < t;
        color c = trace(P, N);
        if (a && b) c += 1; else if (a || !b) c *= color trace(P, I);
        Ci = c * a; Oi = (u > 1 && v < 1) ? c : color b; })"},
    {"TracesNothingNew", R"(surface t() {
        float d = float trace(P, N); point ph; vector nh;
        d += rayhittest(P, I, ph, nh);
        Ci = visibility(P, P + N) * transmission(P, point(0, 0, 0), "samples", 4) * color(nh);
        Oi = occlusion(P, N, 16) + indirectdiffuse(P, N, 8, "maxdist", 5);
        if (d < 1e20) Oi += d; })"},
    {"Derivatives", R"(surface t() {
        float x = u * v; color c = 0;
        if (u > 0.8) { c += color trace(P * x, N * v); x *= 2; }
        Ci = c + Du(x) + color(Dv(P)); Oi = color trace(P, N) * area(P); })"},
    {"DerivativeOfTrace", R"(surface t() {
        color c = trace(P, N) * u;
        Ci = Du(c); Oi = c; })"},
    {"Gather", R"(surface t() {
        color c = 0, x = 0.25; float d = 0, n = 0; vector r = 0;
        gather("illuminance", P, N, 0.5, 4, "surface:Ci", x, "ray:length", d, "ray:direction", r,
               "bias", 0.1, "send:surface:Kd", u, "label", "g") {
            c += x + d; n += 1;
        } else { c += color(r) * 0.125; }
        Ci = c; Oi = n; })"},
    {"GatherJumps", R"(surface t() {
        color c = 0, x = 0; float n = 0;
        gather("", P, N, 0.5, 2 + 2 * u, "surface:Ci", x) {
            if (v > 1) continue;
            c += x * color trace(P, N + n);
            if (comp(c, 0) > 1.2) break;
        } else n += 1;
        Ci = c + x; Oi = n; })"},
    {"GatherInGather", R"(surface t() {
        color c = 0, x, y; float i;
        gather("samplepattern", P, N, 1, 2, "surface:Ci", x)
            gather("", P + vector(x), I, 1, 3, "surface:Ci", y) { c += x * y; x = y; }
            else if (u > 1) break;
        Ci = c; Oi = c; })"},
    {"OutputPairs", R"(surface t(output varying color env = 0.5) {
        vector open = 1; float o = 0.25;
        float occ = occlusion(P, N, 8, "environmentdir", open, "environmentcolor", env);
        color e = indirectdiffuse(P, N, 4, "occlusion", o, "maxdist", 3);
        Ci = e * occ + color(open) * color trace(P, open); Oi = o; })"},
    {"Reflection", R"(surface t(string name = "reflection") {
        vector r = reflect(I, N);
        Ci = environment("reflection", r, "samples", 2) + color environment(name, r);
        Oi = float environment("reflection"[1], r) + float environment(name, r, r * 2, N, I);
    })"},
    {"TracedShadow", R"(surface t(string name = "raytrace") {
        color c = 0;
        illuminance (P) {
            c += Cl * (1 - float shadow("raytrace", P, "samples", 4));
            c += color shadow(name, P + L) * float shadow(name, P, P, P, N + P);
        }
        Ci = c + shadow(name, P) * color trace(P, N); Oi = 1; })"},
    {"TracedShadowInALight", R"(light t(string name = "raytrace") {
        illuminate (point(1, 2, 3)) { Cl = 1 - color shadow(name, Ps); }
    })"},
    {"Nested", R"(surface t() {
        color c = 0; float i;
        illuminance (P) {
            float k = L . N;
            for (i = 0; i < 2; i += 1) {
                if (u + i > 0.9) {
                    c += k * color trace(P, L * (i + 1));
                    if (v > 1.1) { c += color trace(P, N) + Cl; break; }
                }
                k += 0.5;
            }
            c += k;
        }
        Ci = c; Oi = i; })"},
};

class Suspension : public ::testing::TestWithParam<BuildWay> {};

TEST_P(Suspension, AgreesWithTheInterpreter) {
    for (const WaitingCase& c : cases) {
        for (const bool optimise : {true, false}) {
            const auto compiled = testing::compile(c.text, optimise);
            ASSERT_EQ(compiled.unit.num_errors, 0U) << c.name << "\n" << compiled.messages;
            Comparison comparison(compiled.unit.programs[0], GetParam());
            ASSERT_TRUE(comparison.built()) << c.name << "\n" << comparison.text();
            for (const std::uint32_t n : {1U, 13U, 61U}) {
                EXPECT_EQ(comparison.run(n), "")
                    << c.name << (optimise ? "" : " without passes") << ", batch of " << n << "\n"
                    << comparison.text();
            }
        }
    }
}

std::vector<BuildWay> ways() {
    std::vector<BuildWay> all = {{4, 2}};
    if (native_lanes() == 8) {
        all.push_back({8, 2});
    }
    return all;
}

std::string way_name(const ::testing::TestParamInfo<BuildWay>& info) {
    return "Lanes" + std::to_string(info.param.lanes);
}

INSTANTIATE_TEST_SUITE_P(Ways, Suspension, ::testing::ValuesIn(ways()), way_name);

Program resolved(const char* text) {
    Program program = testing::compile(text).unit.programs.at(0);
    resolve_area_operators(program, {});
    return program;
}

std::vector<std::string> saved_at(const Program& program, std::size_t point) {
    const Suspensions waits(program);
    std::vector<std::string> names;
    for (const VarId v : waits.points().at(point).saved) {
        names.push_back(program.vars[static_cast<std::size_t>(v)].name);
    }
    return names;
}

TEST(SuspensionTable, SavesWhatIsReadLater) {
    const Program program = resolved(
        "surface t(float Kr = 1) { float a = u * 2, b = v * 3; Ci = a * color trace(P, N) * Kr; "
        "Oi = b; }");
    EXPECT_EQ(saved_at(program, 0), (std::vector<std::string>{"a", "b"}));
}

TEST(SuspensionTable, NothingThatIsLoadedAnew) {
    const Program program =
        resolved("surface t(float Kr = 1) { Ci = Kr * color trace(P, N) * u; Oi = Os; }");
    EXPECT_TRUE(saved_at(program, 0).empty());
}

TEST(SuspensionTable, OtherArmsAreYetToRun) {
    const Program program =
        resolved("surface t() { float a = u * v; color c;"
                 "if (u > 0.5) c = trace(P, N); else c = a; Ci = c; Oi = Os; }");
    const auto saved = saved_at(program, 0);
    EXPECT_NE(std::find(saved.begin(), saved.end(), "a"), saved.end());
}

TEST(SuspensionTable, NamesThatAreKnownAskForNothing) {
    const Program program =
        resolved("surface t() { Ci = color environment(\"room.env\", N); Oi = Os; }");
    EXPECT_TRUE(Suspensions(program).empty());
    EXPECT_EQ(analyse(program).facts & SL_FACT_traces, 0U);
    EXPECT_EQ(analyse(program).needed >> SL_VAR_P & 1U, 0U);
}

std::size_t count_calls(const Block& b, std::string_view body) {
    std::size_t n = 0;
    for (const Stmt& s : b) {
        n += s.op == Op::Call && builtin_of(s).body == body ? 1 : 0;
        for (const Block& inner : s.bodies) {
            n += count_calls(inner, body);
        }
    }
    return n;
}

// The colour, unless a float is asked for outright.
TEST(TraceOverload, IsAColourInExpressions) {
    const auto count = [](const char* body, std::string_view wanted) {
        const Program program = resolved(testing::surface(body).c_str());
        return count_calls(program.body, wanted);
    };
    for (const char* body :
         {"Ci = 0; Ci += trace(P, N) * (1 + u);", "float Kr = u; Ci = Kr * trace(P, N);",
          "color a = u; color x = a + u * trace(P, N); Ci = x;", "Ci = -trace(P, N);",
          "Ci = trace(P, N) / 2 + trace(P, N) * trace(P, I);", "Ci = u > v ? trace(P, N) : 0;",
          "Ci = mix(trace(P, N), Cs, u);"}) {
        EXPECT_EQ(count(body, "trace_f"), 0U) << body;
        EXPECT_GE(count(body, "trace_c_d"), 1U) << body;
    }
    for (const char* body : {"Ci = float trace(P, N);", "float d = trace(P, N); Ci = d;",
                             "float d; d = trace(P, N); Ci = d;", "Ci = 2 * float trace(P, N);"}) {
        EXPECT_EQ(count(body, "trace_f"), 1U) << body;
    }
}

TEST(SuspensionTable, OnlySurfacesWait) {
    const Program light =
        resolved("light t() { illuminate (point(0, 0, 0)) { Cl = trace(Ps, L); } }");
    EXPECT_TRUE(Suspensions(light).empty());
    const Program plain = resolved("surface t() { Ci = Cs * visibility(P, E); Oi = 1; }");
    EXPECT_TRUE(Suspensions(plain).empty());
}

} // namespace
} // namespace slc
