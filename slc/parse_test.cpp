// SPDX-License-Identifier: Apache-2.0
// Grammar of sl.md 1.3 with its notes: what is accepted, how it groups, and what is said about
// errors.
#include "slc/ast.h"
#include "slc/lex.h"
#include "slc/parse.h"
#include "slc/slc_testing.h"

namespace slc {
namespace {

using testing::compile;
using testing::QuietDiag;
using testing::surface;

std::string dump_of(const std::string& text) {
    QuietDiag diag;
    Sources sources;
    sources.set_text(sources.add("test.sl"), text);
    Messages messages(diag.get(), sources);
    const TokenList list = lex(text, messages);
    const auto file = parse(list.tokens, messages);
    EXPECT_EQ(messages.num_errors(), 0U) << diag.text() << text;
    return ast::dump(*file);
}

// How an expression groups, in prefix form.
std::string grouping(const std::string& expression) {
    const std::string dump = dump_of(surface("x = " + expression + ";"));
    const std::size_t start = dump.find("(= x ");
    const std::size_t end = dump.rfind(')');
    return start == std::string::npos ? dump : dump.substr(start + 5, end - start - 5);
}

struct Grouping {
    const char* expression;
    const char* tree;
};

TEST(Parse, Precedence) {
    const Grouping cases[] = {
        {"I.N/(I.I * N.N)", "(/ (. I N) (* (. I I) (. N N)))"},
        {"a * b ^ c", "(^ (* a b) c)"},
        {"a ^ b + c", "(+ (^ a b) c)"},
        {"-I.N", "(. (- I) N)"},
        {"a - b - c", "(- (- a b) c)"},
        {"a / b * c", "(* (/ a b) c)"},
        {"a < b == c > d", "(== (< a b) (> c d))"},
        {"a && b || c && d", "(|| (&& a b) (&& c d))"},
        {"!a == b", "(== (! a) b)"},
        {"a ? b : c ? d : e", "(? a b (? c d e))"},
        {"a = b = c", "(= a (= b c))"},
        {"a += b -= 2", "(+= a (-= b 2))"},
        {"2 * vector noise(p) - 1", "(- (* 2 (cast:vector (noise p))) 1)"},
        {"vector A + vector B", "(+ (cast:vector A) (cast:vector B))"},
        {"point \"shader\" (0, 0, 1)", "(cast:point \"shader\" (tuple 0 0 1))"},
        {"point (a + b)", "(cast:point (+ a b))"},
        {"string \"a\" \"b\"", "(cast:string \"ab\")"},
        {"PI*.5", "(* PI 0.5)"},
        {"1.-x", "(- 1 x)"},
        {"Nf.-In", "(. Nf (- In))"},
        {"- - -a", "(- (- (- a)))"},
        {"+a", "a"},
        {"1e3 + 1.5E-2 + 0.5f", "(+ (+ 1000 0.015) 0.5)"},
        {"texture(\"a\"[2], s)", "(texture \"a\"[2] s)"},
        {"texture(n[1][2])", "(texture n[1][2])"},
        {"arr[i + 1]", "arr[(+ i 1)]"},
        {"float x . y", "(. (cast:float x) y)"},
    };
    for (const Grouping& c : cases) {
        EXPECT_EQ(grouping(c.expression), c.tree) << c.expression;
    }
}

TEST(Parse, Accepts) {
    const char* const cases[] = {
        "",
        ";;",
        "surface a() {}",
        "surface a(;; float x = 1;; float y = 2;;) {};",
        "surface a(float x = 1, float y = 2) {}", // comma before a type
        "float f() { return 1; };",
        "f() {}",
        "void f(float a, b; output color c[]; varying point p) {}",
        "surface a() { float f(float x) { return x; } Ci = f(1); }",
        "surface a() { sqr(float x) { return x * x; }; Ci = sqr(s); }",
        "surface a() { float a, b = 1, c[2] = {1, 2,}; extern float s, t; extern vector I; }",
        "surface a() { point (1, 2, 3); float noise(P); color \"hsv\" (1, 1, 1); }",
        "surface a() { for (;;) break; for (s = 1, t = 2; s < 1; s += 1, t += 1) ; }",
        "surface a() { float gather = 1; gather = 2; color surface = 1; }",
        "surface a() { if (s) ; else if (t) {} else { ; } }",
        "light a() { solar() ; illuminate(P) { } }",
        "surface surface() { surface(\"x\", s); }",
        "transformation a() { P += 1; }",
        "surface a() { float i; while (i < 2) { while (1) { break 1 + 1; } continue; } }",
        "surface a(float m[4 * 4 / 2] = {1,2,3,4,5,6,7,8}) {}",
        "surface a() { string s2 = \"a\\n\\\"\\101\" \"b\"; }",
    };
    for (const char* text : cases) {
        dump_of(text);
    }
}

struct Failure {
    const char* text;
    const char* message; // as printed, place included
};

TEST(Parse, ErrorsHavePlaces) {
    const Failure cases[] = {
        {"surface a() {\n  Ci = 1\n}",
         "test.sl:3:1: error: expected ';' after an expression, found '}'"},
        {"surface a() { Ci = (1, 2); }",
         "test.sl:1:20: error: values in parentheses are 1, 3 or 16, not 2"},
        {"surface a() { 1 = s; }",
         "test.sl:1:17: error: only a variable or an array element can be assigned"},
        {"surface a() { Ci = 2.N; }",
         "test.sl:1:22: error: expected ';' after an expression, found 'N'"},
        {"surface a() { Ci = 'x'; }", "there are no character constants"},
        {"surface a() { string x = \"abc; }", "test.sl:1:26: error: string without closing quote"},
        {"surface a() { float x[0]; }",
         "test.sl:1:23: error: the length of an array is a whole number"},
        {"surface a() { float x[99999999]; }", "whole number from 1 to 65536"},
        {"surface a() { float x[]; }", "needs a length"},
        {"surface a() { void x; }", "a variable cannot be void"},
        {"surface a() { else ; }", "'else' without 'if'"},
        {"surface a() { illuminate(P, N) ; }", "'illuminate' takes 1 or 3 arguments, not 2"},
        {"surface a() { float \"x\" s; }", "a float has no coordinate system"},
        {"banana", "expected '(' after the name of a function"},
        {"surface a() {", "expected '}' at the end of shader 'a', found the end of the file"},
        {"float f(float) { }", "expected a name of a variable"},
        {"surface a() { Ci = ; Oi = 1 +; }",
         "test.sl:1:30: error: expected an expression, found ';'"},
        {"/* surface a() {}", "comment without end"},
    };
    for (const Failure& c : cases) {
        const auto r = compile(c.text);
        EXPECT_NE(r.messages.find(c.message), std::string::npos) << c.text << "\n" << r.messages;
        EXPECT_GT(r.unit.num_errors, 0U);
    }
}

TEST(Parse, SeveralErrorsInOneRunAndCarets) {
    const auto r =
        compile("surface a() {\n  Ci = (;\n  Oi = 1;\n  s = * 2;\n}\nsurface b() { Ci = zork; }\n");
    EXPECT_EQ(r.unit.num_errors, 3U) << r.messages;
    EXPECT_NE(r.messages.find("\n  Ci = (;\n        ^"), std::string::npos) << r.messages;
    EXPECT_NE(r.messages.find("test.sl:4:7:"), std::string::npos);
    EXPECT_NE(r.messages.find("test.sl:6:20: error: 'zork' is not declared"), std::string::npos);
}

TEST(Parse, StopsAfterManyErrors) {
    std::string text;
    for (int i = 0; i < 1000; ++i) {
        text += "surface a() { ) ; }\n";
    }
    const auto r = compile(text);
    EXPECT_NE(r.messages.find("too many errors"), std::string::npos);
    EXPECT_LT(r.messages.size(), 10000U);
}

TEST(Parse, TokensDump) {
    QuietDiag diag;
    Sources sources;
    sources.add("t.sl");
    Messages messages(diag.get(), sources);
    const std::string text = "float x = .5;\n# 10 \"other.sl\"\n\"a\\tb\"";
    const TokenList list = lex(text, messages);
    EXPECT_EQ(dump_tokens(list.tokens, sources),
              "t.sl:1:1: 'float'\nt.sl:1:7: a name x\nt.sl:1:9: '='\n"
              "t.sl:1:11: a number .5\nt.sl:1:13: ';'\n"
              "other.sl:10:1: a string a\tb\nother.sl:10:7: the end of the file\n");
}

} // namespace
} // namespace slc
