// SPDX-License-Identifier: Apache-2.0
// What published shaders contain and how it is taken: one list of sources, each with the outcome
// and, where something is said, a part of the message. A source that other compilers accept is
// accepted, with a warning only where its author would want to know.
#include "slc/slc_testing.h"

namespace slc {
namespace {

using testing::QuietDiag;

enum class Expect { Clean, Warns, Fails };

struct Probe {
    const char* what;
    const char* text;
    Expect outcome = Expect::Clean;
    const char* message = "";
};

Unit compile_whole(std::string_view text, QuietDiag& diag, bool preprocessed) {
    CompileOptions options;
    options.is_preprocessed = preprocessed;
    return compile_text(text, "probe.sl", options, diag.get());
}

void expect_outcome(const Probe& probe, bool preprocessed) {
    QuietDiag diag;
    const Unit unit = compile_whole(probe.text, diag, preprocessed);
    const bool silent = diag.text().empty();
    SCOPED_TRACE(std::string(probe.what) + "\n" + diag.text());
    EXPECT_EQ(unit.ok(), probe.outcome != Expect::Fails);
    EXPECT_EQ(silent, probe.outcome == Expect::Clean);
    EXPECT_NE(diag.text().find(probe.message), std::string::npos) << probe.message;
    for (const Program& program : unit.programs) {
        const auto complaints = verify_ir(program);
        EXPECT_TRUE(complaints.empty()) << complaints.front();
    }
}

constexpr Probe language[] = {
    // --- names
    {"vector, normal and matrix as names, as in 3.1",
     "surface t() { point normal = normalize(N); point vector = -I; float matrix = 2;\n"
     "  Ci = diffuse(normal) * matrix + (normal . vector) - matrix; normal = vector * 2; }"},
    {"and still as types beside them",
     "surface t() { point normal = N; vector V = vector (normal - P); normal += 1;\n"
     "  normal Nf = normal (1, 0, 0); Ci = color (Nf + V + normal); }"},
    {"as formals",
     "float f(point normal, vector; float matrix) { return normal.vector * matrix; }\n"
     "surface t() { Ci = f(N, I, 2); }"},
    {"a shader named by a type word", "surface vector() { Ci = 1; }"},
    {"words of later versions are names",
     "surface t(float class = 1, method = 2, public = 3, do = 4; float constant = 5) {\n"
     "  Ci = class + method + public + do + constant; }"},
    {"variables named as functions", "surface t() { float noise = 2, area = area(P), texture = 3;\n"
                                     "  Ci = noise(P) * noise + area + texture; }"},
    // --- declarations
    {"no default", "surface t(float a; color c; string s1; float k[3]) { Ci = a * c + k[1]; }",
     Expect::Warns, "parameter 'a' has no default value; it is 0"},
    {"commas before types, at the end, and none",
     "float f(float a float b, uniform float c,) { return a + b + c; }\n"
     "surface t(float a = 1, color c = 2, float b = 1, string s1 = \"\" float d = 1,) {\n"
     "  Ci = f(a, b, d) * c; }"},
    {"stray semicolons", "surface t(;;float a = 1;;;float b = 2;;) { ; ; Ci = a; };;"},
    {"qualifiers on either side of the type",
     "void f(float output x; varying float y; output uniform float z) { x = y; }\n"
     "surface t(color varying output c = 1; point uniform p = 0) { float uniform k;\n"
     "  f(k, 1, k); c = k; Ci = k; }"},
    {"array length after the type", "surface t() { float[3] a = {1, 2, 3}; Ci = a[0]; }"},
    {"one value for an array, and parentheses for a list",
     "surface t() { float a[3] = 1, b[3] = (1, 2, 3); Ci = a[2] + b[0]; }"},
    {"a list for a value", "surface t() { color c = {1, 0, 0}; float f = {2}; Ci = c * f; }",
     Expect::Warns, "the list is taken as the value in parentheses"},
    {"too many elements", "surface t() { float a[2] = {1, 2, 3}; Ci = a[1]; }", Expect::Warns,
     "2 elements, but 3 are given; the last are left out"},
    {"too few elements", "surface t() { float a[3] = {1, 2}; Ci = a[2]; }", Expect::Warns,
     "only 2 given; the rest is 0"},
    {"a variable declared twice", "surface t() { float a = 1; Ci = a; color a = 2; Ci += a; }",
     Expect::Warns, "'a' is declared again in this scope"},
    {"a parameter declared twice", "surface t(float Kd = 1; float Kd = 2) { Ci = Kd; }",
     Expect::Warns, "parameter 'Kd' is declared again; the first stands"},
    {"a default that reads a predefined variable", "surface t(color c = Cs) { Ci = c; }",
     Expect::Warns, "cannot use 'Cs'; 0 is used"},
    {"defaults that call functions and use earlier ones",
     "surface t(float a = radians(30); float b = sin(a) + PI; color c = color \"hsv\" (.5, 1, b);\n"
     "  point p = point \"world\" (0, 0, 0); vector v = normalize(vector \"shader\" (0, 1, 1));\n"
     "  matrix m = matrix \"shader\" 1; point q = transform(\"world\", p)) { Ci = a * c; }"},
    {"assigning a parameter", "surface t(float Ks = 1) { Ks *= 2; Ci = Ks; }", Expect::Warns,
     "parameter 'Ks' is not 'output'; a local copy is assigned"},
    {"chained assignments", "surface t() { float x, y; float z = x = y = 1; Ci = Oi = x + z; }"},
    {"unsized arrays",
     "color f(color c[]; float n) { return c[n]; }\n"
     "surface t(float k[] = {1, 2}) { color a[2] = {(1, 0, 0), color (0, 1, 0)};\n"
     "  Ci = f(a, k[0]); }"},
    {"resizable arrays are of a later language", "surface t() { color c[]; push(c, 1); Ci = 1; }",
     Expect::Fails, "array 'c' needs a length"},
    // --- functions
    {"no result type", "sq(float x) { return x * x; } say(string x) { printf(x); }\n"
                       "surface t() { Ci = sq(s); say(\"a\"); }"},
    {"a prototype", "float f(float x);\nsurface t() { Ci = f(s); }\n"
                    "float f(float x) { return x * 2; }"},
    {"defined after its use", "surface t() { Ci = f(s) + g(t); }\n"
                              "float g(float x) { return f(x); } float f(float x) { return x; }"},
    {"recursion through a later function",
     "surface t() { Ci = f(s); }\n"
     "float f(float x) { return f(x); }",
     Expect::Fails, "there is no recursion"},
    {"return from the middle", "float f(float x) { if (x > .5) return 1; return x; }\n"
                               "surface t() { if (s > .5) return; Ci = f(s); }"},
    {"a value returned where there is none",
     "void f() { return 1; }\n"
     "surface t() { f(); Ci = 1; return Ci; }",
     Expect::Warns, "returns no value; this one is left out"},
    {"an expression for an output",
     "void f(output float x) { x = 1; }\n"
     "surface t() { f(0); f(s + 1); Ci = 1; }",
     Expect::Warns, "what is set is lost"},
    {"an output of another kind", "void f(output vector x) { x = 1; }\n"
                                  "surface t() { normal n; point p[2]; f(n); f(p[1]); Ci = n.n; }"},
    {"arrays of other lengths", "float f(float a[2]) { return a[1]; }\n"
                                "surface t() { float b[4] = {1, 2, 3, 4}; Ci = f(b); }"},
    {"a shorter array",
     "float f(float a[4]) { return a[3]; }\n"
     "surface t() { float b[2] = {1, 2}; Ci = f(b); }",
     Expect::Warns, "fewer than the 4"},
    {"nested functions and extern",
     "surface t(float Kd = 1) { float k = 2; float f(float x) { extern float k; extern point P;\n"
     "  extern uniform float Kd; float g(float y) { extern float x; return x * y; };\n"
     "  return g(2) * k * xcomp(P) * Kd; }; Ci = f(s); }"},
    {"without extern", "float f() { return du + xcomp(P); } surface t() { Ci = f(); }",
     Expect::Warns, "the outer variable is used, as with 'extern'"},
    {"extern of another type",
     "float f() { extern color P; return P.P; } surface t() { Ci = f(); }", Expect::Warns,
     "'P' is point, not color; it is used as what it is"},
    {"old points for directions in extern", "float f() { extern point N, I; return N.I; }\n"
                                            "surface t() { Ci = f(); }"},
    {"a built-in defined again", "float smoothstep(float a, b, x) { return step(a, x); }\n"
                                 "float raylevel() { return 0; }\n"
                                 "surface t() { Ci = smoothstep(0, 1, s) + raylevel(); }"},
    {"a function defined twice",
     "float f(float x) { return 1; } float f(float x) { return 2; }\n"
     "surface t() { Ci = f(1); }",
     Expect::Warns, "'f' is defined again; this one is used from here on"},
    {"an unknown function", "surface t() { Ci = nosuchfunction(P, 3); }", Expect::Fails,
     "probe.sl:1:20: error: function 'nosuchfunction' is not defined"},
    // --- statements
    {"empty branches", "surface t() { if (s > .5) ; else Ci = 1; if (s > 1) {} else {}; }"},
    {"assignments as conditions and arguments",
     "surface t() { float a; if (a = s) Ci = noise(a = t) + a; while ((a -= .5) > 0) ; }"},
    {"comma between statements", "surface t() { float a, b; a = 1, b = 2; Ci = a + b; }"},
    {"x++ where its value is not used",
     "surface t() { float i; for (i = 0; i < 3; i++) Ci += .1; --i; Ci *= i; }", Expect::Warns,
     "the Shading Language writes i += 1"},
    {"do", "surface t() { float i = 0; do { i += 1; } while (i < 4); Ci = i; }"},
    {"a declaration in for", "surface t() { for (float i = 0; i < 2; i += 1) Ci += i; }"},
    {"break and continue of several loops",
     "surface t() { float i, j; for (i = 0; i < 3; i += 1) for (j = 0; j < 3; j += 1) {\n"
     "  if (i == j) continue 2; if (j > 1) break 2; } Ci = i * j; }"},
    {"solar with an axis alone", "light t() { solar(vector (0, 0, 1)) Cl = 1; }", Expect::Warns,
     "the angle is taken as 0"},
    {"a word before a condition",
     "surface t() { float i = 0; while \"any\" (i < 2) i += 1; Ci = i; }", Expect::Warns,
     "every point decides for itself"},
    {"expressions without effect", "surface t() { s; Ci = 1; }", Expect::Warns, "has no effect"},
    {"a brace too many", "surface t() { Ci = 1; } }\nsurface q() { Ci = 1; }", Expect::Warns,
     "closes nothing"},
    {"illuminate outside lights", "surface t() { illuminate(P) Cl = 1; }", Expect::Fails,
     "belongs in light shaders"},
    // --- expressions
    {"numbers", "surface t() { Ci = 1.f + .5e3 + 1.e5 + 1E-6 + 1.0e+6F + 07 + 3. + 1.-.5; }"},
    {"unary plus", "surface t() { float a = + 1; Ci = +a + +Cs; }"},
    {"casts of C", "surface t() { Ci = (float) noise(P) + (color) (1, 0, 0); }", Expect::Warns,
     "a cast is written without parentheses"},
    {"casts", "surface t() { vector v = vector -I; color c = color -1; point q = point 0;\n"
              "  Ci = color (v) + c * float noise(q) + color \"hsv\" noise(P) + color point "
              "\"world\" -P; }"},
    {"remainder", "surface t() { Ci = s * 10 % 2; }", Expect::Warns, "mod() is taken"},
    {"components by index",
     "surface t() { color c = Cs; c[0] = .5; c[1] += .1; matrix m = 1; m[3][0] = c[2];\n"
     "  point p[2]; p[1][0] = 1; p[1] += 2; Ci = color (c[0], P[2], m[3][0]) * p[1][0]; }"},
    {"the channel of an array's texture",
     "surface t(string n[2] = {\"a\", \"b\"}) { Ci = float texture(n[1][2], s, t); }"},
    {"color for point", "surface t() { color c = P; Ci = c; }", Expect::Warns,
     "the value of 'c' is color, but point is given; its components are taken as they are"},
    {"color and point in one sum", "surface t() { Ci = Cs * N; Ci += P; }", Expect::Warns,
     "does not take color and normal; the normal is taken as a color"},
    {"functions of floats on colors", "surface t() { Ci = exp(-Cs) + pow(Cs, .5) + abs(Cs); }",
     Expect::Warns, "'exp' takes floats; it is applied to each component"},
    {"comparisons of triples", "surface t() { if (Oi < .999 && P >= 0) Ci = N != 0; }"},
    {"not before equal", "surface t() { if (!s == t) Ci = 1; }", Expect::Warns,
     "applies to the left operand only"},
    {"a color for a float",
     "float g() { return Os; }\n"
     "surface t() { float f = visibility(P, E), k[2] = {1, 2}; k[0] = Cs; if (Oi) Ci = f * g() * "
     "k[0]; }",
     Expect::Warns, "the value of 'f' is float, but color is given; its first component is taken"},
    {"a point for a float", "surface t() { float f = P; Ci = f; }", Expect::Fails,
     "the value of 'f' is float, but point is given"},
    // --- predefined variables
    {"results in a displacement", "displacement t() { P += N; Ci = 1; Oi = 1; }", Expect::Warns,
     "'Ci' does not exist in displacement shaders; a local variable"},
    {"geometry in a volume", "volume t() { Ci *= N.I + s + xcomp(Ng); }", Expect::Warns,
     "'N' does not exist in volume shaders"},
    {"alpha in a surface", "surface t() { alpha = 1; Ci = alpha; }", Expect::Warns,
     "'alpha' does not exist in surface shaders"},
    {"uniform that varies", "surface t() { uniform float x = s; Ci = x; }", Expect::Warns,
     "it becomes varying"},
    {"components set one by one",
     "surface t() { point q = P; color c = Cs; setcomp(q, 0, 1); setcomp(c, 0, 1);\n"
     "  setxcomp(c, 1); setycomp(q, 2); Ci = c * (q.q); }"},
    {"photon maps are not there, the names are",
     "surface t() { Ci = caustic(P, N) + photonmap(\"x\", P, N) + subsurface(P, N) +\n"
     "  irradiance(P, N, 16); }"},
    // --- other languages
    {"a class", "class t(float Kd = 1;) { public void surface(output color Ci, Oi) { Ci = 1; } }",
     Expect::Fails, "'class' belongs to version 2 of the Shading Language"},
    {"a structure", "struct A { float x; }\nsurface t() { Ci = 1; }", Expect::Fails,
     "'struct' belongs to version 2"},
    {"types of C", "surface t() { int i = 1; Ci = i; }", Expect::Fails,
     "'int' is no type of the Shading Language"},
    {"declarations of C", "static char rcsid[] = \"x\";\nsurface t() { Ci = 1; }", Expect::Fails,
     "'static' is no type of the Shading Language"},
};

TEST(Leniency, Language) {
    for (const Probe& probe : language) {
        expect_outcome(probe, true);
    }
}

constexpr Probe files[] = {
    {"byte order mark", "\xef\xbb\xbfsurface t() { Ci = 1; }\n"},
    {"DOS lines and end mark",
     "surface t()\r\n{\r\n#define X(a) \\\r\n (a)\r\n Ci = X(1);\r\n}\r\n\x1a"},
    {"Mac lines", "surface t()\r{\r#define X 1\r Ci = X;\r}\r"},
    {"no newline at the end", "surface t() { Ci = 1; } // end"},
    {"Latin-1 in comments and strings",
     "/* caf\xe9 */ surface t(string x = \"na\xefve\") { Ci = 1; } // \xe9\n"},
    {"apostrophes in dead text",
     "#if 0\nthis isn't \"it\n#endif\nsurface t() { Ci = 1; } // don't\n"},
    {"words after #else and #endif", "#ifdef FOO\n#else FOO\nsurface t() { Ci = 1; }\n#endif FOO\n",
     Expect::Warns, "extra tokens"},
    {"pasting what is no word",
     "#define CAT(a,b) a##b\n#define F(x) CAT(x,(1))\n"
     "surface t() { Ci = F(abs); }\n",
     Expect::Warns, "pasting"},
    {"strings from macros", "#define S(x) #x\nsurface t() { printf(S(a b) \"c\"); Ci = 1; }\n"},
    {"pragmas", "#pragma nolint 3\n#pragma annotation \"a\" \"b\"\n#ident \"x\"\n"
                "surface t() { Ci = 1; }\n"},
    {"unknown directives", "#foo bar\nsurface t() { Ci = 1; }\n", Expect::Warns,
     "invalid preprocessing directive"},
    {"macros of renderers", "#if !defined(BMRT) || !defined PERIGEE\n#error none\n#endif\n"
                            "#ifdef PRMAN\n#error other\n#endif\nsurface t() { Ci = 1; }\n"},
    {"PI as macro and as name", "#ifndef PI\n#define PI 3.14159\n#endif\n"
                                "surface t(float TWOPI = 2 * PI) { Ci = PI * TWOPI; }\n"},
    {"parameters from a macro", "#define DECLARE float a = 1; string m = \"\"\n#define NOTHING\n"
                                "surface t(DECLARE;; NOTHING; float b = 2;) { Ci = a * b; }\n"},
    {"a missing header", "#include \"nothere.h\"\nsurface t() { Ci = 1; }\n", Expect::Fails,
     "probe.sl:1:10: error: included file 'nothere.h' is not found"},
    {"a macro without its arguments", "#define F(a,b) a b\nsurface t() { Ci = F(1); }\n",
     Expect::Fails, "requires 2 arguments"},
};

TEST(Leniency, Files) {
    for (const Probe& probe : files) {
        expect_outcome(probe, false);
    }
}

// What lenient readings compute.
TEST(Leniency, Values) {
    using testing::evaluate_float;
    EXPECT_EQ(evaluate_float("c[0] + 10 * c[1] + 100 * c[2]", "color c = 1; c[1] = 2; c[2] += 3;"),
              421);
    EXPECT_EQ(evaluate_float("p[1][2]", "point p[2]; p[1] = (1, 2, 3); p[1][2] *= 2;"), 6);
    EXPECT_EQ(evaluate_float("f", "color c = (3, 4, 5); float f = c;"), 3);
    EXPECT_EQ(evaluate_float("m[3][1]", "matrix m = 2; m[3][1] = 5;"), 5);
    EXPECT_EQ(evaluate_float("-1 % 3"), 2);
    EXPECT_EQ(evaluate_float("i", "float i = 7; do { i += 1; } while (i < 5);"), 8);
    EXPECT_EQ(evaluate_float("i", "float i = 0; do { i += 1; if (i == 3) break; } while (1);"), 3);
    EXPECT_EQ(evaluate_float("i", "float i = 5; i++; ++i; i--;"), 6);
    EXPECT_EQ(evaluate_float("ycomp(sqrt(p))", "point p = (1, 4, 9);"), 2);
    EXPECT_EQ(evaluate_float("comp(max(c, 2) + pow(c, 2), 2)", "color c = (1, 2, 3);"), 12);
    EXPECT_EQ(evaluate_float("zcomp(normal)", "point normal = (1, 2, 3); normal = normal * 2;"), 6);
    EXPECT_EQ(evaluate_float("a[2]", "float a[3] = {1, 2, 3, 4};"), 3);
    EXPECT_EQ(
        evaluate_float("f(1)", "float f(float x) { float y = x; float y = x + 4; return y; }"), 5);
}

} // namespace
} // namespace slc
