// SPDX-License-Identifier: Apache-2.0
// Parameters as constants: what vanishes, what stays, what may not be folded.
#include "slc/slc_testing.h"
#include "slc/specialise.h"

namespace slc::testing {
namespace {

std::string ir_of(std::string_view text) {
    const Compiled c = compile(text);
    EXPECT_EQ(c.unit.num_errors, 0U) << c.messages;
    return c.unit.programs.empty() ? "" : print_ir(c.unit.programs.front());
}

Specialised made(std::string_view text, const std::vector<ConstantParam>& constants) {
    std::string error;
    auto special = specialise(ir_of(text), constants, error);
    EXPECT_TRUE(special) << error;
    if (!special) {
        return {};
    }
    const auto complaints = verify_ir(special->program);
    EXPECT_TRUE(complaints.empty()) << complaints.front() << print_ir(special->program);
    return std::move(*special);
}

bool calls(const Block& b, std::string_view name) {
    for (const Stmt& s : b) {
        if (s.op == Op::Call && builtin_rows()[static_cast<std::size_t>(s.builtin)].name == name) {
            return true;
        }
        for (const Block& inner : s.bodies) {
            if (calls(inner, name)) {
                return true;
            }
        }
    }
    return false;
}

constexpr std::string_view textured =
    "surface t(string name = \"\"; float Kr = 0, blur = 2; output varying float seen = 0;) {\n"
    "    color c = Cs;\n"
    "    if (name != \"\") c *= color texture(name, s, t);\n"
    "    if (Kr * blur > 0) { c += Kr * noise(P); seen = 1; }\n"
    "    Ci = c;\n}\n";

TEST(Specialise, DecidedBranchesGoWithWhatTheyNeed) {
    const Specialised off = made(textured, {{"name", {}, ""}, {"Kr", {0}, ""}, {"blur", {2}, ""}});
    const Facts facts = analyse(off.program);
    EXPECT_EQ(facts.facts & SL_FACT_textures, 0U);
    EXPECT_EQ(facts.needed, 1ULL << SL_VAR_Cs);
    EXPECT_LE(off.num_statements, 2U);
    const Specialised on = made(textured, {{"name", {}, "wood"}, {"Kr", {1}, ""}});
    EXPECT_TRUE(calls(on.program.body, "texture"));
    EXPECT_TRUE(calls(on.program.body, "noise"));
}

TEST(Specialise, TheParameterBlockStays) {
    const Specialised s = made(textured, {{"Kr", {1}, ""}, {"seen", {1}, ""}});
    ASSERT_EQ(s.program.params.size(), 4U);
    for (const char* name : {"name", "Kr", "blur", "seen"}) {
        const auto& params = s.program.params;
        EXPECT_TRUE(std::any_of(params.begin(), params.end(), [&](const Param& p) {
            return s.program.vars[static_cast<std::size_t>(p.var)].name == name;
        }));
    }
    EXPECT_TRUE(calls(s.program.body, "texture"));                     // `name` was not given
    EXPECT_NE(print_ir(s.program).find("seen = "), std::string::npos); // outputs are not constants
}

TEST(Specialise, FoldsOnlyWhatIsExact) {
    const std::string_view text = "surface t(float a = 1, b = 2;) {\n"
                                  "    Ci = Cs * max(a, b) * (a + b * 3) * sqrt(b);\n"
                                  "    Oi = sin(a) * pow(b, a) * mix(a, b, .3);\n}\n";
    const Specialised s = made(text, {{"a", {0.7F}, ""}, {"b", {2}, ""}});
    EXPECT_FALSE(calls(s.program.body, "max"));
    EXPECT_FALSE(calls(s.program.body, "sqrt"));
    EXPECT_TRUE(calls(s.program.body, "sin"));
    EXPECT_TRUE(calls(s.program.body, "pow"));
    EXPECT_TRUE(calls(s.program.body, "mix"));
}

// Zeros have signs, subnormals may be flushed, infinities are not constants of the language.
TEST(Specialise, LeavesDelicateNumbersToTheProcessor) {
    const std::string_view text =
        "surface t(float a = 1, b = 2;) { Ci = Cs * (a / b); Oi = a * b; }";
    EXPECT_NE(print_ir(made(text, {{"a", {1}, ""}, {"b", {0}, ""}}).program).find("div"),
              std::string::npos);
    EXPECT_NE(print_ir(made(text, {{"a", {1e-30F}, ""}, {"b", {1e-15F}, ""}}).program).find("mul"),
              std::string::npos);
}

TEST(Specialise, ArraysAndMatricesOfNumbers) {
    const std::string_view text =
        "surface t(float knots[3] = {1, 2, 3}; matrix m = 1; float i = 1;) {\n"
        "    if (knots[i] > 2) { Ci = noise(P); } else { Ci = Cs; }\n"
        "    P = transform(m, P);\n}\n";
    std::vector<float> m(16, 0.25F);
    const Specialised s = made(text, {{"knots", {1, 2, 3}, ""}, {"m", m, ""}, {"i", {1}, ""}});
    EXPECT_FALSE(calls(s.program.body, "noise"));
    const Specialised wrong = made(text, {{"knots", {1}, ""}, {"i", {1, 2}, ""}});
    EXPECT_TRUE(calls(wrong.program.body, "noise")); // values that do not fit are passed over
}

TEST(Specialise, BrokenTextIsAnError) {
    std::string error;
    EXPECT_FALSE(specialise("surface \"t\"\nbody {", {}, error));
    EXPECT_FALSE(error.empty());
    error.clear();
    EXPECT_FALSE(specialise("", {}, error));
    EXPECT_FALSE(error.empty());
}

} // namespace
} // namespace slc::testing
