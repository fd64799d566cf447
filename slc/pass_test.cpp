// SPDX-License-Identifier: Apache-2.0
// Passes on IR text, before and after; the text form and the verifier themselves.
#include "slc/builtins.h"
#include "slc/passes.h"
#include "slc/slc_testing.h"

namespace slc {
namespace {

// A program around a body: globals Cs, Ci, N, s, uniform parameter k, constants zero, one, two,
// locals x, y, temps.
std::string with_body(const std::string& body) {
    return "surface \"t\"\nfile \"t.sl\"\n"
           "var k param uniform float index 0 @0:0:0\n"
           "var zero const uniform float = 0 @0:0:0\nvar one const uniform float = 1 @0:0:0\n"
           "var two const uniform float = 2 @0:0:0\nvar word const uniform string = \"w\" @0:0:0\n"
           "var Cs global varying color index 13 @0:0:0\nvar Ci global varying color index 20 "
           "@0:0:0\n"
           "var s global varying float index 11 @0:0:0\nvar L global varying vector index 15 "
           "@0:0:0\n"
           "var P global varying point index 0 @0:0:0\n"
           "var x local varying float @0:0:0\nvar y local varying float @0:0:0\n"
           "var c local varying color @0:0:0\nvar a local varying float[3] @0:0:0\n"
           "var t1 temp varying float @0:0:0\nvar t2 temp varying float @0:0:0\nvar t3 temp "
           "varying color @0:0:0\n"
           "default k {\n  k = copy one @0:0:0\n}\n" +
           body + "\n";
}

Program parse(const std::string& text) {
    std::string error;
    auto program = parse_ir(text, error);
    EXPECT_TRUE(program) << error << "\n" << text;
    return program ? std::move(*program) : Program{};
}

// Body text without places and indentation, for comparison.
std::string body_of(const Program& program) {
    std::string text = print_ir(program);
    text = text.substr(text.find("body {"));
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text.compare(i, 2, " @") == 0) {
            while (i < text.size() && text[i] != '\n' && text.compare(i, 2, " {") != 0) {
                ++i;
            }
        }
        if (i < text.size() && !(text[i] == ' ' && (out.empty() || out.back() == '\n'))) {
            out += text[i];
        }
    }
    return out;
}

std::string block(const std::string& statements) {
    std::string out = "body {\n";
    out += statements;
    return out + "}";
}

struct Case {
    const char* before;
    const char* after;
};

std::string plain(const std::string& statements) {
    return body_of(parse(with_body(block(statements))));
}

TEST(Passes, DeadCode) {
    const Case cases[] = {
        {"x = copy one @0:1:1\nx = copy two @0:1:1\nCi = mul Cs x @0:1:1\n",
         "x = copy two @0:1:1\nCi = mul Cs x @0:1:1\n"},
        {"t1 = call \"noise\" \"f(f)\" s @0:1:1\nCi = copy Cs @0:1:1\n", "Ci = copy Cs @0:1:1\n"},
        {"call \"printf\" \"void(s,x*)\" word s @0:1:1\n",
         "call \"printf\" \"void(s,x*)\" word s @0:1:1\n"},
        {"if s @0:1:1 {\nx = copy one @0:1:1\n} {\n}\nCi = copy Cs @0:1:1\n",
         "Ci = copy Cs @0:1:1\n"},
        {"a = copy zero @0:1:1\na = store zero s @0:1:1\nt1 = load a k @0:1:1\nCi = copy t1 "
         "@0:1:1\n",
         "a = copy zero @0:1:1\na = store zero s @0:1:1\nt1 = load a k @0:1:1\nCi = copy t1 "
         "@0:1:1\n"},
        {"loop s @0:1:1 {\n} {\nx = add x one @0:1:1\n} {\n}\nCi = copy Cs @0:1:1\n",
         "Ci = copy Cs @0:1:1\n"},
        {"scope @0:1:1 {\nif s @0:1:1 {\nleave @0:1:1\n} {\n}\nCi = copy Cs @0:1:1\n}\n",
         "scope @0:1:1 {\nif s @0:1:1 {\nleave @0:1:1\n} {\n}\nCi = copy Cs @0:1:1\n}\n"},
    };
    for (const Case& c : cases) {
        Program p = parse(with_body(block(c.before)));
        pass_dead_code(p);
        EXPECT_EQ(body_of(p), plain(c.after)) << c.before;
        EXPECT_FALSE(pass_dead_code(p));
    }
}

TEST(Passes, CommonSubexpressions) {
    const Case cases[] = {
        // what a variable still holds is not computed again
        {"t1 = mul s k @0:1:1\nx = add t1 one @0:1:1\nt2 = mul s k @0:1:1\ny = add t2 one @0:1:1\n",
         "t1 = mul s k @0:1:1\nx = add t1 one @0:1:1\nt2 = copy t1 @0:1:1\ny = copy x @0:1:1\n"},
        // not when an operand changed, or the holder was overwritten
        {"x = mul s k @0:1:1\ns = copy one @0:1:1\ny = mul s k @0:1:1\n",
         "x = mul s k @0:1:1\ns = copy one @0:1:1\ny = mul s k @0:1:1\n"},
        {"x = mul s k @0:1:1\nx = copy one @0:1:1\ny = mul s k @0:1:1\nx = mul s k @0:1:1\n",
         "x = mul s k @0:1:1\nx = copy one @0:1:1\ny = mul s k @0:1:1\nx = copy y @0:1:1\n"},
        // into a body, not out of it
        {"x = mul s k @0:1:1\nif s @0:1:1 {\ny = mul s k @0:1:1\nt1 = add s k @0:1:1\n} {\n}\n"
         "t2 = add s k @0:1:1\n",
         "x = mul s k @0:1:1\nif s @0:1:1 {\ny = copy x @0:1:1\nt1 = add s k @0:1:1\n} {\n}\n"
         "t2 = add s k @0:1:1\n"},
        // what a loop changes is new in every round
        {"x = add y one @0:1:1\nloop s @0:1:1 {\n} {\nt1 = add y one @0:1:1\ny = copy t1 @0:1:1\n} "
         "{\n}\n",
         "x = add y one @0:1:1\nloop s @0:1:1 {\n} {\nt1 = add y one @0:1:1\ny = copy t1 @0:1:1\n} "
         "{\n}\n"},
        // random() is another number each time
        {"x = call \"random\" \"f()\" @0:1:1\ny = call \"random\" \"f()\" @0:1:1\n",
         "x = call \"random\" \"f()\" @0:1:1\ny = call \"random\" \"f()\" @0:1:1\n"},
        {"x = call \"noise\" \"f(f)\" s @0:1:1\ny = call \"noise\" \"f(f)\" s @0:1:1\n",
         "x = call \"noise\" \"f(f)\" s @0:1:1\ny = copy x @0:1:1\n"},
    };
    for (const Case& c : cases) {
        Program p = parse(with_body(block(c.before)));
        pass_cse(p);
        EXPECT_EQ(body_of(p), plain(c.after)) << c.before;
        EXPECT_TRUE(verify_ir(p).empty());
    }
}

TEST(Passes, LoopInvariants) {
    const Case cases[] = {
        {"loop s @0:1:1 {\n} {\nt1 = mul s two @0:1:1\nt2 = add t1 x @0:1:1\nx = copy t2 @0:1:1\n} "
         "{\n}\n",
         "t1 = mul s two @0:1:1\nloop s @0:1:1 {\n} {\nt2 = add t1 x @0:1:1\nx = copy t2 @0:1:1\n} "
         "{\n}\n"},
        // behind a branch nobody knows whether it is reached
        {"loop s @0:1:1 {\n} {\nif x @0:1:1 {\nbreak @0:1:1\n} {\n}\nt1 = mul s two @0:1:1\n"
         "x = copy t1 @0:1:1\n} {\n}\n",
         "loop s @0:1:1 {\n} {\nif x @0:1:1 {\nbreak @0:1:1\n} {\n}\nt1 = mul s two @0:1:1\n"
         "x = copy t1 @0:1:1\n} {\n}\n"},
    };
    for (const Case& c : cases) {
        Program p = parse(with_body(block(c.before)));
        pass_hoist(p);
        EXPECT_EQ(body_of(p), plain(c.after)) << c.before;
        EXPECT_TRUE(verify_ir(p).empty());
    }
}

TEST(Passes, Copies) {
    const Case cases[] = {
        {"x = copy k @0:1:1\nCi = mul Cs x @0:1:1\n", "x = copy k @0:1:1\nCi = mul Cs k @0:1:1\n"},
        {"x = copy s @0:1:1\ns = copy one @0:1:1\nCi = mul Cs x @0:1:1\n",
         "x = copy s @0:1:1\ns = copy one @0:1:1\nCi = mul Cs x @0:1:1\n"},
        {"x = copy k @0:1:1\nif s @0:1:1 {\nx = copy one @0:1:1\n} {\ny = add x x @0:1:1\n}\nCi = "
         "copy x @0:1:1\n",
         "x = copy k @0:1:1\nif s @0:1:1 {\nx = copy one @0:1:1\n} {\ny = add k k @0:1:1\n}\nCi = "
         "copy x @0:1:1\n"},
        {"x = copy k @0:1:1\nloop x @0:1:1 {\n} {\ny = add x one @0:1:1\nx = copy y @0:1:1\n} "
         "{\n}\nCi = copy x @0:1:1\n",
         "x = copy k @0:1:1\nloop x @0:1:1 {\n} {\ny = add x one @0:1:1\nx = copy y @0:1:1\n} "
         "{\n}\nCi = copy x @0:1:1\n"},
        {"c = copy L @0:1:1\nilluminance P @0:1:1 {\nCi = copy c @0:1:1\n}\n",
         "c = copy L @0:1:1\nilluminance P @0:1:1 {\nCi = copy c @0:1:1\n}\n"},
        {"c = copy s @0:1:1\nCi = copy c @0:1:1\n",
         "c = copy s @0:1:1\nCi = copy c @0:1:1\n"}, // a conversion is no copy
    };
    for (const Case& c : cases) {
        Program p = parse(with_body(block(c.before)));
        pass_copies(p);
        EXPECT_EQ(body_of(p), plain(c.after)) << c.before;
    }
}

TEST(Passes, Fold) {
    const Case cases[] = {
        {"t1 = add one two @0:1:1\nt2 = mul two two @0:1:1\nx = sub two one @0:1:1\n",
         "t1 = copy folded1 @0:1:1\nt2 = copy folded2 @0:1:1\nx = copy one @0:1:1\n"},
        {"x = call \"max\" \"f(f,f+)\" one two zero @0:1:1\n", "x = copy two @0:1:1\n"},
        {"x = call \"sqrt\" \"f(f)\" k @0:1:1\n", "x = call \"sqrt\" \"f(f)\" k @0:1:1\n"},
        {"x = div one zero @0:1:1\n",
         "x = div one zero @0:1:1\n"}, // no infinities from the compiler
        {"x = mul s one @0:1:1\ny = div s one @0:1:1\n", "x = copy s @0:1:1\ny = copy s @0:1:1\n"},
        {"if one @0:1:1 {\nx = copy s @0:1:1\n} {\nx = copy k @0:1:1\n}\n", "x = copy s @0:1:1\n"},
        {"loop zero @0:1:1 {\nx = copy s @0:1:1\n} {\nx = copy k @0:1:1\n} {\n}\n",
         "x = copy s @0:1:1\n"},
        {"x = select zero s k @0:1:1\n", "x = copy k @0:1:1\n"},
        {"scope @0:1:1 {\nx = copy s @0:1:1\n}\n", "x = copy s @0:1:1\n"},
        {"scope @0:1:1 {\nx = copy s @0:1:1\nleave @0:1:1\nx = copy k @0:1:1\n}\n",
         "scope @0:1:1 {\nx = copy s @0:1:1\nleave @0:1:1\n}\n"},
        {"x = call \"random\" \"f()\" @0:1:1\n", "x = call \"random\" \"f()\" @0:1:1\n"},
    };
    for (const Case& c : cases) {
        Program p = parse(with_body(block(c.before)));
        pass_fold(p);
        std::string after = with_body(block(c.after));
        const std::string folded = "var folded1 const uniform float = 3 @0:0:0\nvar folded2 const "
                                   "uniform float = 4 @0:0:0\n";
        after.insert(after.find("default"), folded);
        EXPECT_EQ(body_of(p), body_of(parse(after))) << c.before;
        EXPECT_TRUE(verify_ir(p).empty());
    }
}

TEST(Passes, CompactKeepsParameters) {
    Program p = parse(with_body(block("Ci = copy Cs @0:1:1\n")));
    pass_compact(p);
    ASSERT_EQ(p.vars.size(), 4U); // k, one (its default), Cs, Ci
    EXPECT_EQ(p.vars[0].name, "k");
    EXPECT_TRUE(verify_ir(p).empty());
}

TEST(IrText, RejectsWhatIsBroken) {
    const char* const broken[] = {
        "",
        "surface",
        "surface \"t\"",
        "banana \"t\" body { }",
        "surface \"t\" body {",
        "surface \"t\" body { x = copy y @0:0:0 }",
        "surface \"t\" var x local varying float @0:0:0 var x local varying float @0:0:0 body { }",
        "surface \"t\" var x local varying floot @0:0:0 body { }",
        "surface \"t\" var x local varying float[0] @0:0:0 body { }",
        "surface \"t\" var x local varying float @0:0:0 body { x = frobnicate x @0:0:0 }",
        "surface \"t\" var x local varying float @0:0:0 body { x = call \"sin\" \"f(c)\" x @0:0:0 "
        "}",
        "surface \"t\" body { if @0:0:0 { } }",
        "surface \"t\" body { scope @0:0 { } }",
    };
    for (const char* text : broken) {
        std::string error;
        EXPECT_FALSE(parse_ir(text, error)) << text;
        EXPECT_EQ(error.substr(0, 5), "line ") << text;
    }
    std::string deep = "surface \"t\" body {";
    for (int i = 0; i < 100000; ++i) {
        deep += " scope @0:0:0 {";
    }
    std::string error;
    EXPECT_FALSE(parse_ir(deep, error));
    EXPECT_NE(error.find("nested too deeply"), std::string::npos);
}

TEST(IrText, DifferencesOfPredefinedVariables) {
    const std::string text = "surface \"t\"\n"
                             "var s global varying float index 11 @0:1:1\n"
                             "var s_u global varying float index 11 aux 1 @0:1:1\n"
                             "var w param varying float index 0 @0:1:1\n"
                             "var w_v param varying float index 0 aux 2 @0:1:1\n"
                             "var k1 const uniform float = 0 @0:0:0\n"
                             "var x local varying float @0:1:1\n"
                             "default w {\n  w = copy k1 @0:1:1\n}\n"
                             "body {\n  x = add s_u w_v @0:2:1\n}\n";
    std::string error;
    const auto program = parse_ir(text, error);
    ASSERT_TRUE(program) << error;
    EXPECT_EQ(print_ir(*program), text);
    EXPECT_TRUE(verify_ir(*program).empty());
    Program broken = *program;
    broken.vars[5].aux = 1; // a local has its own variables for its differences
    EXPECT_FALSE(verify_ir(broken).empty());
    broken = *program;
    broken.vars[1].aux = 3;
    EXPECT_FALSE(verify_ir(broken).empty());
}

TEST(IrText, DifferencesOfBuiltins) {
    // Only rows that have a body for it, with as many differences as numeric arguments.
    const int step = find_builtin_by_body("smoothstep");
    EXPECT_EQ(difference_places(step), (std::vector<int>{0, 1, 2}));
    EXPECT_EQ(difference_places(find_builtin_by_body("spline_3")), (std::vector<int>{0}));
    EXPECT_EQ(difference_places(find_builtin_by_body("min_f")), (std::vector<int>{0, 1}));
    EXPECT_EQ(difference_places(find_builtin_by_body("texture_f_d")),
              (std::vector<int>{2, 3, 4, 5, 6, 7}));
    EXPECT_EQ(difference_places(find_builtin_by_body("fresnel")), (std::vector<int>{0, 1, 2}));
    EXPECT_EQ(difference_places(find_builtin_by_body("transform_to")), (std::vector<int>{1}));
    const std::string text = "surface \"t\"\n"
                             "var s global varying float index 11 @0:1:1\n"
                             "var s_u global varying float index 11 aux 1 @0:1:1\n"
                             "var x local varying float @0:1:1\n"
                             "body {\n  x = diff \"printf\" \"void(s,x*)\" s s_u @0:2:1\n}\n";
    std::string error;
    const auto program = parse_ir(text, error);
    ASSERT_TRUE(program) << error;
    EXPECT_EQ(print_ir(*program), text);
    EXPECT_FALSE(verify_ir(*program).empty()) << "printf has no difference";
}

TEST(Builtins, HiddenRowsAreNotForUsers) {
    EXPECT_GE(find_builtin_by_body("texture_c_d"), 0);
    EXPECT_TRUE(find_builtins("texture_d").empty());
    const auto c = testing::compile(testing::surface("Ci = texture_d(\"x\", s, t, 0, 0, 0, 0);"));
    EXPECT_NE(c.unit.num_errors, 0U);
    EXPECT_EQ(c.messages.find("texture_d\"?"), std::string::npos) << c.messages;
}

TEST(IrText, VerifierFindsBrokenInvariants) {
    const char* const broken[] = {
        "x = copy word @0:0:0\n",    // string to float
        "word = copy word @0:0:0\n", // constant assigned
        "x = add s @0:0:0\n",        // operand missing
        "c = dot s s @0:0:0\n",      // floats
        "x = load s s @0:0:0\n",     // not an array
        "break @0:0:0\n",            // no loop
        "leave @0:0:0\n",            // no scope
        "k = copy s @0:0:0\n",       // varying into uniform
        "x = call \"sin\" \"f(f)\" c @0:0:0\n",
        "x = call \"sin\" \"f(f)\" @0:0:0\n",
        "c = call \"sin\" \"f(f)\" s @0:0:0\n",
        "call \"setxcomp\" \"void(G,f)\" one one @0:0:0\n",
    };
    for (const char* body : broken) {
        EXPECT_FALSE(verify_ir(parse(with_body(block(body)))).empty()) << body;
    }
    EXPECT_TRUE(verify_ir(parse(with_body(block("")))).empty());
}

} // namespace
} // namespace slc
