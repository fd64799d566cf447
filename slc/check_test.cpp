// SPDX-License-Identifier: Apache-2.0
// Types, conversions, overloads and scopes: sl.md 1.4 - 1.7, 2, and the cases of section 10.
#include "slc/slc_testing.h"

namespace slc {
namespace {

using testing::compile;
using testing::evaluate;
using testing::surface;

const char* const declarations =
    "color C = (1, 2, 3); point p = P; vector v = (0, 0, 1); normal n = N; matrix m = 1; "
    "string str = \"a\"; float f = .5; float arr[4] = {0, 1, 2, 3}; color carr[2] = {1, 2}; ";

// The signature of the row a call takes, found in the IR.
std::string row_of(const std::string& statement, const std::string& function) {
    const auto c = compile(surface(declarations + statement + " Oi = 1;"), false);
    EXPECT_EQ(c.unit.num_errors, 0U) << statement << "\n" << c.messages;
    if (c.unit.programs.empty()) {
        return "";
    }
    const std::string ir = print_ir(c.unit.programs[0]);
    const std::string mark = "call \"" + function + "\" \"";
    const std::size_t at = ir.find(mark);
    return at == std::string::npos
               ? "no call"
               : ir.substr(at + mark.size(), ir.find('"', at + mark.size()) - at - mark.size());
}

struct Overload {
    const char* statement;
    const char* function;
    const char* row;
};

TEST(Overload, ResultByContext) {
    const Overload cases[] = {
        {"C = noise(P);", "noise", "t(g)"},
        {"f = noise(P);", "noise", "f(g)"},
        {"p = noise(2 * p);", "noise", "t(g)"},
        {"p = random();", "random", "t()"},
        {"C = noise(P) * color (1, 1, 1);", "noise", "f(g)"},
        {"C = 2 * color noise(P) - 1;", "noise", "t(g)"},
        {"C = f > 1 ? noise(P) : 0;", "noise", "t(g)"},
        {"f = abs(noise(p));", "noise", "f(g)"},
        {"f = length(noise(p));", "noise", "t(g)"},
        {"f = v . noise(p);", "noise", "t(g)"},
        {"f = C == noise(p);", "noise", "t(g)"},
        {"f = 1 < noise(p);", "noise", "f(g)"},
        {"printf(\"%f\", noise(p));", "noise", "f(g)"},
        {"noise(p);", "noise", "f(g)"},
        {"C = mix(C, C, noise(P));", "noise", "f(g)"},
        {"C += noise(p);", "noise", "f(g)"},
        {"C = (noise(p));", "noise", "t(g)"},
        {"carr[0] = noise(p);", "noise", "t(g)"},
        {"color q[2] = {noise(p), 1};", "noise", "t(g)"},
        {"f = noise(f, f);", "noise", "f(f,f)"},
        {"f = noise(p, f);", "noise", "f(g,f)"},
        {"C = pnoise(p, 4);", "pnoise", "t(g,g)"},
        {"f = float texture(\"x\");", "texture", "f(s*)"},
        {"C = texture(\"x\", s, t);", "texture", "c(s,f,f*)"},
        {"C = texture(\"x\", s, t, \"blur\", f);", "texture", "c(s,f,f*)"},
        {"C = texture(\"x\", 0, 0, 1, 0, 0, 1, 1, 1);", "texture", "c(s,f,f,f,f,f,f,f,f*)"},
        {"texture(\"x\");", "texture", "c(s*)"},
        {"f = 1 - shadow(\"x\", p);", "shadow", "f(s,p*)"},
        {"C = environment(\"x\", v);", "environment", "c(s,v*)"},
    };
    for (const Overload& c : cases) {
        EXPECT_EQ(row_of(c.statement, c.function), c.row) << c.statement;
    }
}

TEST(Overload, ByArguments) {
    const Overload cases[] = {
        {"C = clamp(C, color 0, color 1);", "clamp", "c(c,c,c)"},
        {"f = clamp(f, 0, 1);", "clamp", "f(f,f,f)"},
        {"C = max(0, C);", "max", "c(c,c+)"},
        {"v = max(0, v, n);", "max", "g(g,g+)"},
        {"f = min(1, 2, 3, f);", "min", "f(f,f+)"},
        {"C = mix(C, C, C);", "mix", "c(c,c,c)"},
        {"C = mix(C, C, f);", "mix", "c(c,c,f)"},
        {"p = mix(p, v, f);", "mix", "g(g,g,f)"},
        {"p = mix(p, v, C);", "mix", "g(g,g,c)"},
        {"f = spline(f, 0, 1, 2, 3);", "spline", "f(f,f,f,f,f+)"},
        {"C = spline(f, 0, C, C, 1);", "spline", "c(f,c,c,c,c+)"},
        {"C = spline(\"bspline\", f, C, C, C, C, C);", "spline", "c(s,f,c,c,c,c+)"},
        {"f = spline(f, arr);", "spline", "f(f,[f])"},
        {"C = spline(\"linear\", f, carr);", "spline", "c(s,f,[c])"},
        {"p = transform(\"world\", p);", "transform", "p(s,p)"},
        {"p = transform(\"world\", \"object\", v);", "transform", "p(s,s,p)"},
        {"p = transform(m, p);", "transform", "p(m,p)"},
        {"p = transform(\"world\", m, p);", "transform", "p(s,m,p)"},
        {"v = vtransform(\"world\", p);", "vtransform", "v(s,v)"},
        {"v = rotate(v, 1, 0, v);", "rotate", "g(g,f,p,p)"},
        {"m = rotate(m, 1, v);", "rotate", "m(m,f,v)"},
        {"f = comp(C, 1);", "comp", "f(c,f)"},
        {"f = comp(m, 1, 2);", "comp", "f(m,f,f)"},
        {"setcomp(C, 0, 1);", "setcomp", "void(C,f,f)"},
        {"setcomp(m, 0, 1, 2);", "setcomp", "void(M,f,f,f)"},
        {"setxcomp(n, 1);", "setxcomp", "void(G,f)"},
        {"f = log(f, 10);", "log", "f(f,f)"},
        {"f = atan(1, 2);", "atan", "f(f,f)"},
        {"f = occlusion(p, n, 16);", "occlusion", "f(p,n,f*)"},
        {"f = occlusion(\"m\", p, n, 16, 2);", "occlusion", "f(s,p,n,f,f*)"},
        {"v = faceforward(n, I);", "faceforward", "g(g,g)"},
        {"f = arraylength(carr);", "arraylength", "f([x])"},
        {"f = attribute(\"a\", arr);", "attribute", "f(s,X)"},
        {"f = textureinfo(\"a\", \"exists\", 0);", "textureinfo", "f(s,s,X)"},
    };
    for (const Overload& c : cases) {
        EXPECT_EQ(row_of(c.statement, c.function), c.row) << c.statement;
    }
}

TEST(Overload, NoiseChannels) {
    const Value different = evaluate("color", "noise(P * 1.37)");
    EXPECT_NE(different.at(0), different.at(1));
    const Value equal = evaluate("color", "noise(P * 1.37) * color (1, 1, 1)");
    EXPECT_EQ(equal.at(0), equal.at(1));
}

TEST(Overload, UserFunctionsByTypeAndScope) {
    const std::string f = "float kind(float x) { return 1; } float kind(color x) { return 2; } "
                          "float kind(point x) { return 3; } float kind(float a, b) { return 4; } ";
    const auto value = [&](const std::string& call, const std::string& before = "") {
        const auto c = compile(f + "surface t(output varying float result = 0) { " + before +
                               "result = " + call + "; }");
        EXPECT_EQ(c.unit.num_errors, 0U) << c.messages;
        InterpHost host;
        Interpreter interpreter(c.unit.programs.at(0), host, 1);
        EXPECT_TRUE(interpreter.run());
        return interpreter.param("result", 0).f();
    };
    EXPECT_EQ(value("kind(1)"), 1);
    EXPECT_EQ(value("kind(Cs)"), 2);
    EXPECT_EQ(value("kind(N)"), 3);
    EXPECT_EQ(value("kind(1, 2)"), 4);
    EXPECT_EQ(value("kind(1)", "float kind(float x) { return 9; } "), 9); // inner scope hides
    EXPECT_EQ(value("sqrt(4)", "float sqrt(float x) { return 7; } "), 7); // a built-in redefined
    EXPECT_EQ(value("max(1, 2)", "float max(float a, b, c) { return 7; } "),
              2); // unless it does not fit
}

struct Failure {
    const char* body;
    const char* message;
};

TEST(Check, Errors) {
    const Failure cases[] = {
        {"Ci = zork;", "'zork' is not declared"},
        {"float roughness = 1; Ci = roughnes;", "did you mean 'roughness'?"},
        {"Ci = nois(P);", "function 'nois' is not defined, did you mean 'noise'?"},
        {"float x = (1, 2, 3);", "the value of 'x' is float, but point is given"},
        {"string x = 1;", "the value of 'x' is string, but float is given"},
        {"float x = \"a\" + \"b\";", "operator + does not take string and string"},
        {"float x = \"a\" < \"b\";", "operator < does not take string"},
        {"float x = float P;", "cannot cast point to float"},
        {"float x = sin(1, 2);", "no form of 'sin' takes (float, float)"},
        {"setxcomp(1, 2);", "no form of 'setxcomp'"},
        {"float a[2]; float x = a;", "array 'a' is used without an index"},
        {"float a; float x = a[0];", "'a' is not an array"},
        {"float a[2], b[3]; a = b;", "array 'a' takes an array of the same type and length"},
        {"break;", "'break' outside a loop"},
        {"while (1) break 2;", "'break' names 2 loops, but there are only 1 here"},
        {"float f(float x) { return f(x); } Ci = f(1);", "there is no recursion"},
        {"PI = 3;", "PI is a constant"},
        {"extern float nothing;", "no variable 'nothing' encloses this one"},
        {"illuminate(P) ;", "'illuminate' belongs in light shaders"},
        {"illuminance(P) { illuminance(P) ; }", "'illuminance' inside another illuminance"},
        {"illuminance(P, N) ;", "'illuminance' has an axis but no angle"},
        {"matrix m = 1; m = m + m;", "operator + does not take matrix and matrix"},
        {"matrix m = -(matrix 1);", "operator - does not take matrix"},
        {"if (\"a\") ;", "a condition is float, but string is given"},
        {"float x = s ? \"a\" : 1;", "the two values of '?' have types without a common one"},
    };
    for (const Failure& c : cases) {
        const auto r = compile(surface(c.body));
        EXPECT_NE(r.messages.find(c.message), std::string::npos) << c.body << "\n" << r.messages;
        EXPECT_GT(r.unit.num_errors, 0U) << c.body;
        EXPECT_TRUE(r.unit.programs.empty());
    }
}

TEST(Check, ParameterDefaultsAreForInstances) {
    EXPECT_GT(compile("surface a(float f = texture(\"x\")) {}").unit.num_errors, 0U);
    EXPECT_EQ(
        compile("surface a(float a = 1, b = a * radians(30); color c = color \"hsv\" (b, 1, 1); "
                "point p = point \"camera\" (0, 0, a); vector v = normalize(vector (1, 1, a))) {}")
            .unit.num_errors,
        0U);
}

TEST(Check, Warnings) {
    const Failure cases[] = {
        {"float f(float x) { x += 1; return x; } Ci = f(s);",
         "formal 'x' is not 'output'; a local copy is assigned"},
        {"float f() { return s; } Ci = f();", "'s' is not declared in function 'f'"},
        {"u = 1; Ci = u;", "'u' is read-only in surface shaders; a local copy is assigned"},
        {"Ci = Cl;", "'Cl' has a value only inside illuminance"},
        {"if (!s == t) Ci = 1;", "'!' applies to the left operand only"},
        {"s + t;", "this expression has no effect"},
        {"texture(\"x\");", "'texture' can give several types here"},
        {"uniform float x = s; Ci = x;", "uniform variable 'x' is assigned a varying value"},
        {"float f(float x) { return 1; } float f(float y) { return 2; } Ci = f(1);",
         "is defined again"},
    };
    for (const Failure& c : cases) {
        const auto r = compile(surface(c.body));
        EXPECT_NE(r.messages.find(c.message), std::string::npos) << c.body << "\n" << r.messages;
        EXPECT_EQ(r.unit.num_errors, 0U) << r.messages;
    }
}

TEST(Check, QuietWhereRulesAllow) {
    const char* const cases[] = {
        "surface a() { extern float s; float f() { extern float s; extern vector I; return s * "
        "length(I); } Ci = f(); }",
        "float f() { extern point N; return length(N); } surface a() { Ci = f(); }", // 3.1: all are
                                                                                     // points
        "surface a(output varying color c = 0) { c = Cs; Ci = c; }",
        "void f(output point p) { p = 0; } surface a() { normal n = N; f(n); Ci = color n; }",
        "surface a() { point p = (0,0,0); vector v = p - P; normal n = v ^ N; p += v; Ci = Oi = 0; "
        "}",
        "surface a() { color c; float x = Ci.c + (c == 1) + (c < 2); }",
        "displacement a(float Km = 1) { N = calculatenormal(P + Km * noise(P) * normalize(N)); }",
        "imager a() { Ci = mix(color 1, Ci, alpha); }",
        "surface a() { illuminance(\"key\", P, N, PI/2) Ci += Cl * normalize(L).N; }",
        "light a() { solar(vector \"shader\" (0,0,1), 0) Cl = 1; }",
        "surface a() { if (s > .5) return; Ci = 1; }",
        "surface a() { uniform float i; for (i = 0; i < 3; i += 1) if (s > i) Ci += 1; }",
        "surface a() { float x; matrix m = 2; m *= 2; m = m / 3; x = m == 1; }",
    };
    for (const char* text : cases) {
        const auto r = compile(text);
        EXPECT_EQ(r.messages, "") << text;
        EXPECT_EQ(r.unit.num_errors, 0U);
    }
}

} // namespace
} // namespace slc
