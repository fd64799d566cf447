// SPDX-License-Identifier: Apache-2.0
// The interpreter against closed forms and the language definition: mathematics and control flow,
// functions, lights.
#include "slc/slc_testing.h"

#include <cmath>
#include <numbers>

namespace slc {
namespace {

using testing::compile;
using testing::evaluate;
using testing::evaluate_float;

struct Number {
    const char* expression;
    double value;
};

// Parameters and constants are floats, so 1e-6 relative is their rounding.
void expect_numbers(std::initializer_list<Number> cases, const char* before = "") {
    for (const Number& c : cases) {
        EXPECT_NEAR(evaluate_float(c.expression, before), c.value,
                    1e-6 * std::max(1.0, std::abs(c.value)))
            << c.expression;
    }
}

TEST(Interp, MathematicsEdgeCases) {
    expect_numbers({{"mod(-.2, 1)", .8},
                    {"mod(5, 0)", 0},
                    {"mod(-5, 3)", 1},
                    {"sign(0)", 0},
                    {"sign(-2)", -1},
                    {"smoothstep(0, 0, 0)", 1},
                    {"smoothstep(0, 0, -1)", 0},
                    {"smoothstep(0, 1, .25)", .25 * .25 * 2.5},
                    {"pow(-1, .5)", 0},
                    {"pow(-2, 3)", -8},
                    {"pow(0, 0)", 1},
                    {"pow(0, -1)", 0},
                    {"log(0)", std::log(1.17549435e-38)},
                    {"log(8, 2)", 3},
                    {"atan(0, -1)", std::numbers::pi},
                    {"atan(0, 0)", 0},
                    {"atan(1)", std::numbers::pi / 4},
                    {"acos(2)", 0},
                    {"sqrt(-1)", 0},
                    {"inversesqrt(4)", .5},
                    {"inversesqrt(0)", 0},
                    {"clamp(5, 2, 1)", 1}, // the lower limit is tested first: 5 > 1
                    {"clamp(0, 2, 1)", 2},
                    {"round(-.5)", 0},
                    {"round(2.5)", 3},
                    {"ceil(-1.5)", -1},
                    {"floor(-1.5)", -2},
                    {"step(1, 1)", 1},
                    {"radians(180)", std::numbers::pi},
                    {"degrees(PI)", 180},
                    {"min(3, 1, 2)", 1},
                    {"max(3, 1, 2)", 3},
                    {"mix(1, 3, .25)", 1.5},
                    {"erf(1) + erfc(1)", 1},
                    {"length(normalize((0,0,0)))", 0},
                    {"filterstep(.5, .4, .6)", .5},
                    {"comp(color (1,2,3), 7)", 3},
                    {"ptlined((0,0,0), (1,0,0), (2,1,0))", std::sqrt(2)},
                    {"determinant(matrix 2)", 16},
                    {"arraylength(arr)", 3}},
                   "float arr[3] = {1, 2, 3};");
}

TEST(Interp, Splines) {
    expect_numbers({{"spline(0, 9, 1, 2, 9)", 1},
                    {"spline(1, 9, 1, 2, 9)", 2},
                    {"spline(-3, 9, 1, 2, 9)", 1},
                    {"spline(\"linear\", .5, 9, 1, 2, 9)", 1.5},
                    {"spline(\"linear\", .25, 9, 0, 1, 4, 9)", .5},
                    {"spline(\"bezier\", 0, 3, 1, 2, 9)", 3},
                    {"spline(\"bezier\", 1, 3, 1, 2, 9)", 9},
                    {"spline(\"bezier\", .5, 0, 1, 1, 0)", .75},
                    {"spline(\"bspline\", .5, 1, 1, 1, 1)", 1},
                    {"spline(\"hermite\", 1, 2, 0, 5, 0)", 5},
                    {"spline(\"catmull-rom\", .5, 0, 0, 1, 1)", .5},
                    {"spline(\"solvelinear\", .25, 0, 0, 1, 1)", .25},
                    {"spline(\"solve\", spline(.3, 0, 1, 3, 7), 0, 1, 3, 7)", .3}});
}

TEST(Interp, Geometry) {
    expect_numbers(
        {{"xcomp(rotate(point (1,0,0), PI/2, point (0,0,0), point (0,0,1)))", 0},
         {"ycomp(rotate(point (1,0,0), PI/2, point (0,0,0), point (0,0,1)))", 1},
         {"ycomp(transform(rotate(matrix 1, PI/2, vector (0,0,1)), point (1,0,0)))", 1},
         {"zcomp(transform(translate(matrix 1, (1,2,3)), (0,0,0)))", 3},
         {"xcomp(transform(scale(translate(matrix 1, (1,2,3)), (2,2,2)), (1,0,0)))",
          3}, // scale first
         {"zcomp(vtransform(translate(matrix 1, (1,2,3)), (0,0,1)))", 1},
         {"xcomp(ntransform(scale(matrix 1, (2,1,1)), normal (1,0,0)))", .5},
         {"ycomp(reflect((1,-1,0), (0,1,0)))", 1},
         {"length(refract((1,0,0), (0,1,0), 1.5))", 0}, // total internal reflection
         {"xcomp((1,2,3) ^ (4,5,6))", -3},
         {"(1,2,3) . (4,5,6)", 32},
         {"comp(1 / (matrix 2), 0, 0)", .5},
         {"comp(matrix 2 * 3, 3, 3)", 6},
         {"ycomp(faceforward(normal (0,1,0), (0,1,0), (0,1,0)))", -1},
         {"zcomp(faceforward(normal (0,0,1), (0,1,0), (0,0,1)))", 1}}); // edge-on counts as facing
}

TEST(Interp, Fresnel) {
    const char* const before =
        "float kr, kt; vector r, u; fresnel((0,0,-1), (0,0,1), 1/1.5, kr, kt, r, u); ";
    EXPECT_NEAR(evaluate_float("kr", before), .04, 1e-6); // ((n-1)/(n+1))^2
    EXPECT_NEAR(evaluate_float("kt", before), .96, 1e-6);
    EXPECT_NEAR(evaluate_float("zcomp(r) - zcomp(u)", before), 2, 1e-6);
    EXPECT_NEAR(
        evaluate_float(
            "kr", "float kr, kt; fresnel(normalize(vector (1,0,-.1)), (0,0,1), 1.5, kr, kt); "),
        1, 1e-6);
}

TEST(Interp, Colours) {
    for (const char* space : {"hsv", "hsl", "YIQ", "xyz", "xyY"}) {
        const std::string to = "ctransform(\"" + std::string(space) + "\", color (.2, .7, .4))";
        const Value back =
            evaluate("color", "ctransform(\"" + std::string(space) + "\", \"rgb\", " + to + ")");
        // YIQ's published matrices invert each other to three digits.
        const double tolerance = std::string(space) == "YIQ" ? 2e-3 : 1e-6;
        EXPECT_NEAR(back.at(0), .2, tolerance) << space;
        EXPECT_NEAR(back.at(1), .7, tolerance) << space;
        EXPECT_NEAR(back.at(2), .4, tolerance) << space;
    }
    const Value green = evaluate("color", "color \"hsv\" (1/3, 1, 1)");
    EXPECT_NEAR(green.at(0), 0, 1e-6);
    EXPECT_NEAR(green.at(1), 1, 1e-6);
}

TEST(Interp, NoiseStatistics) {
    EXPECT_EQ(evaluate_float("noise(3)"), .5);
    EXPECT_EQ(evaluate_float("noise(point (1, -2, 3))"), .5);
    EXPECT_EQ(evaluate_float("cellnoise(1.2) - cellnoise(1.9)"), 0);
    EXPECT_NE(evaluate_float("cellnoise(-.5) - cellnoise(.5)"), 0);
    EXPECT_NEAR(evaluate_float("pnoise(.3, 4) - pnoise(4.3, 4)"), 0, 1e-6);
    // Mean 1/2 and range [0, 1]: standard error of 20,000 independent samples of deviation 0.15 is
    // 0.001.
    const PureFunction noise = pure_function("noise_f_3");
    double sum = 0;
    for (int i = 0; i < 20000; ++i) {
        std::vector<Value> args = {Value(Type::Point, i * 1.618, i * .7321, i * .4142)};
        Value r;
        noise(args, r);
        ASSERT_GE(r.f(), 0);
        ASSERT_LE(r.f(), 1);
        sum += r.f();
    }
    EXPECT_NEAR(sum / 20000, .5, .005);
}

TEST(Interp, RandomIsPerPointUnlessTheTargetIsUniform) {
    const auto c =
        compile("surface t(output varying float a = 0, b = 0, d = 0) { uniform float u = random(); "
                "a = u; b = random(); d = random(); }");
    ASSERT_EQ(c.unit.programs.size(), 1U) << c.messages;
    InterpHost host;
    Interpreter interpreter(c.unit.programs[0], host, 2);
    EXPECT_TRUE(interpreter.run());
    EXPECT_EQ(interpreter.param("a", 0).f(), interpreter.param("a", 1).f());
    EXPECT_NE(interpreter.param("b", 0).f(), interpreter.param("b", 1).f());
    EXPECT_NE(interpreter.param("b", 0).f(), interpreter.param("d", 0).f());
}

TEST(Interp, Strings) {
    EXPECT_EQ(evaluate("string", "concat(\"a\", \"b\", \"c\")").text(), "abc");
    EXPECT_EQ(evaluate("string",
                       "format(\"%s=%f %04d %.2p %d%% %m\", \"x\", .5, 7, point (1,2,3), 3.7, 1)")
                  .text(),
              "x=0.500000 0007 1.00 2.00 3.00 3% 1.000000");
    expect_numbers({{"match(\"^a.c$\", \"abc\")", 1},
                    {"match(\"b\", \"abc\")", 1},
                    {"match(\"^b\", \"abc\")", 0},
                    {"match(\"[\", \"abc\")", 0},
                    {"\"a\" == \"a\"", 1},
                    {"\"a\" != \"A\"", 1}});
}

TEST(Interp, ControlFlow) {
    expect_numbers({{"x", 10}}, "float i, x; for (i = 0; i < 5; i += 1) x += i;");
    expect_numbers({{"x", 4}},
                   "float i, x; for (i = 0; i < 5; i += 1) { if (i == 2) continue; x += 1; }");
    expect_numbers({{"x", 2}}, "float i, x; while (1) { if (x == 2) break; x += 1; }");
    expect_numbers({{"x", 3}}, "float i, j, x; for (i = 0; i < 9; i += 1) { for (j = 0; j < 9; j "
                               "+= 1) { x += 1; if (x == 3) break 2; } }");
    expect_numbers({{"x", 9}}, "float i, j, x; for (i = 0; i < 9; i += 1) { for (j = 0; j < 9; j "
                               "+= 1) { x += 1; continue 2; } }");
    expect_numbers({{"x", 7}}, "float x = 5; { float x = 1; x += 1; } x += 2;");
    expect_numbers({{"x", 3}}, "float a[3] = {1, 2, 3}; float x = a[99]; ");
    expect_numbers({{"x", 1}}, "float a[3] = {1, 2, 3}; float x = a[-4]; ");
    expect_numbers({{"a[1] + a[2]", 7}}, "float a[3] = {1, 2, 3}; float i = 0; a[i + 1] += 2; ");
    expect_numbers({{"b[0] + b[1]", 3}}, "float a[2] = {1, 2}, b[2]; b = a; a[0] = 9; ");
    expect_numbers({{"(x = 2) * x + x", 6}}, "float x = 1; ");
    expect_numbers({{"x + (x = 5)", 6}}, "float x = 1; ");
    expect_numbers({{"0 && (x = 5)", 0}}, "float x = 1; ");
    expect_numbers({{"x", 1}}, "float x = 1; float y = 0 && (x = 5); ");
    expect_numbers({{"2 * x", 2}},
                   "float f(float y) { if (y > 0) { return 1; } return 2; } float x = f(s); ");
    expect_numbers({{"x", 4}}, "float f(float y) { float i; for (i = 0; i < 9; i += 1) { if (i == "
                               "y) return i; } return -1; } float x = f(4); ");
    expect_numbers({{"f()", 0}}, "float f() { if (s > 2) return 1; } ");
    expect_numbers({{"x + y", 3}},
                   "void f(output float a, b) { a = 1; b = 2; } float x, y; f(x, y); ");
    expect_numbers({{"a[1]", 2}},
                   "void f(output float b) { b += 1; } float a[2] = {1, 1}; f(a[1]); ");
    expect_numbers({{"x", 1}}, "float f(float y) { y = 5; return y; } float x = 1; f(x); ");
    expect_numbers({{"f(f(2))", 16}}, "float f(float y) { return y * y; } ");
    expect_numbers({{"xcomp(v) + zcomp(v)", 4}},
                   "void f(output point p) { p = (1, 2, 3); } vector v; f(v); ");
    expect_numbers({{"f(1) + f(1)", 2}},
                   "float n = 0; float f(float y) { extern float n; n += 1; return y; } ");
}

// Points that take different ways in one program.
TEST(Interp, PointsDiverge) {
    const auto c =
        compile("surface t(output varying float r = 0) { float i; for (i = 0; i < 10; i += 1) { "
                "if (i > s) break; if (mod(i, 2) == 1) continue; r += 1; } r += 100; }");
    ASSERT_EQ(c.unit.programs.size(), 1U) << c.messages;
    InterpHost host;
    Interpreter interpreter(c.unit.programs[0], host, 4);
    const double limits[] = {-1, 0, 3.5, 100};
    for (int p = 0; p < 4; ++p) {
        interpreter.set_global(SL_VAR_s, p, Value(limits[p]));
    }
    EXPECT_TRUE(interpreter.run());
    const double expected[] = {100, 101, 102, 105};
    for (int p = 0; p < 4; ++p) {
        EXPECT_EQ(interpreter.param("r", p).f(), expected[p]) << p;
    }
}

TEST(Interp, EndlessLoopsAreStopped) {
    const auto c = compile("surface t() { while (1) { Ci += 1; } }");
    InterpHost host;
    Interpreter interpreter(c.unit.programs.at(0), host, 1);
    EXPECT_FALSE(interpreter.run());
}

// Lights along +z with Cl = index + 1, and one behind; messages by name.
class TwoLights : public InterpHost {
public:
    int num_lights() override { return 3; }
    bool light(int index, int, const Triple3&, const Triple3&, double, const std::string& category,
               LightSample& sample) override {
        if (category == "odd" && index % 2 == 0) {
            return false;
        }
        sample.L = {0, 0, index == 2 ? -2.0 : 2.0};
        const double v = index + 1;
        sample.Cl = {v, v, v};
        sample.nonspecular = index == 0 ? 1 : 0;
        return true;
    }
    Triple3 ambient(int, const Triple3&) override { return {.5, .5, .5}; }
    bool message(std::string_view function, const std::string& name, int, Value& value) override {
        if (function != "surface" || name != "Kd") {
            return false;
        }
        value = Value(.75);
        return true;
    }
};

double with_lights(const std::string& body) {
    const auto c = compile(
        "surface t(output varying float r = 0) { normal n = (0, 0, 1); vector V = (0, 0, 1); " +
        body + " }");
    EXPECT_EQ(c.unit.num_errors, 0U) << c.messages;
    TwoLights host;
    Interpreter interpreter(c.unit.programs.at(0), host, 1);
    EXPECT_TRUE(interpreter.run());
    return interpreter.param("r", 0).f();
}

TEST(Interp, LightLoops) {
    EXPECT_NEAR(with_lights("r = comp(diffuse(n), 0);"), 3, 1e-12);
    EXPECT_NEAR(with_lights("r = comp(specular(n, V, .1), 0);"), 2,
                1e-12); // the first is non-specular
    EXPECT_NEAR(with_lights("r = comp(ambient(), 0);"), .5, 1e-12);
    EXPECT_NEAR(with_lights("illuminance(P) r += comp(Cl, 0);"), 6, 1e-12);
    EXPECT_NEAR(with_lights("illuminance(P, n, PI/2) r += comp(Cl, 0) * zcomp(L);"), 6, 1e-12);
    EXPECT_NEAR(with_lights("illuminance(P, n, PI) r += 1;"), 3, 1e-12);
    EXPECT_NEAR(with_lights("illuminance(\"odd\", P) r += comp(Cl, 0);"), 2, 1e-12);
    EXPECT_NEAR(with_lights("illuminance(P) { r += 1; break; }"), 1, 1e-12);
    EXPECT_NEAR(with_lights("illuminance(P) { if (comp(Cl, 0) == 2) continue; r += 1; }"), 2,
                1e-12);
    EXPECT_NEAR(with_lights("float k = 5; r = surface(\"Kd\", k) * 10 + k;"), 10.75, 1e-6);
    EXPECT_NEAR(with_lights("float k = 5; r = surface(\"Ks\", k) * 10 + k;"), 5, 1e-12);
}

TEST(Interp, LightShaders) {
    const auto c = compile(
        "light t(float i = 8; point from = (0, 0, 0)) { illuminate(from, vector (0, 0, 1), PI / 4) "
        "Cl = i / (L . L); }");
    ASSERT_EQ(c.unit.programs.size(), 1U) << c.messages;
    InterpHost host;
    Interpreter interpreter(c.unit.programs[0], host, 2);
    interpreter.set_global(SL_VAR_Ps, 0, Value(Type::Point, 0, 0, 2));
    interpreter.set_global(SL_VAR_Ps, 1, Value(Type::Point, 2, 0, 1));
    EXPECT_TRUE(interpreter.run());
    EXPECT_NEAR(interpreter.global(SL_VAR_Cl, 0).at(0), 2, 1e-12);
    EXPECT_NEAR(interpreter.global(SL_VAR_L, 0).at(2), 2, 1e-12);
    EXPECT_TRUE(interpreter.lit(0));
    EXPECT_NEAR(interpreter.global(SL_VAR_Cl, 1).at(0), 0, 1e-12); // outside the cone
    EXPECT_FALSE(interpreter.lit(1));
}

// Neighbours as in auxiliary evaluation: point 1 at u + du, point 2 at v + dv.
class Neighbours : public InterpHost {
public:
    void neighbours(int point, int& at_u, int& at_v) override {
        at_u = point == 0 ? 1 : -1;
        at_v = point == 0 ? 2 : -1;
    }
};

TEST(Interp, Derivatives) {
    const auto c = compile(
        "surface t(output varying float a = 0, b = 0, c = 0, d = 0; output varying normal n = 0) "
        "{ a = Du(u * u); b = Dv(u); c = area(P); d = Deriv(P, u) . vector (1, 0, 0); n = "
        "calculatenormal(P); }");
    ASSERT_EQ(c.unit.programs.size(), 1U) << c.messages;
    Neighbours host;
    Interpreter interpreter(c.unit.programs[0], host, 3);
    constexpr double step = .125;
    for (int p = 0; p < 3; ++p) {
        const double u = .5 + (p == 1 ? step : 0);
        const double v = .5 + (p == 2 ? step : 0);
        interpreter.set_global(SL_VAR_u, p, Value(u));
        interpreter.set_global(SL_VAR_du, p, Value(step));
        interpreter.set_global(SL_VAR_dv, p, Value(step));
        interpreter.set_global(SL_VAR_P, p, Value(Type::Point, 2 * u, 3 * v, 0));
        interpreter.set_global(SL_VAR_Ng, p, Value(Type::Normal, 0, 0, -1));
    }
    EXPECT_TRUE(interpreter.run());
    EXPECT_NEAR(interpreter.param("a", 0).f(), 1 + step, 1e-12); // ((u+h)^2 - u^2) / h
    EXPECT_NEAR(interpreter.param("b", 0).f(), 0, 1e-12);
    EXPECT_NEAR(interpreter.param("c", 0).f(), 6 * step * step, 1e-12);
    EXPECT_NEAR(interpreter.param("d", 0).f(), 2, 1e-12);
    EXPECT_NEAR(interpreter.param("n", 0).at(2), -6, 1e-12); // on the side of Ng
}

} // namespace
} // namespace slc
