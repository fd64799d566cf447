// SPDX-License-Identifier: Apache-2.0
// Area operators: the program in which auxiliary points are explicit against record and replay of
// the program as written (aux_oracle.h), on the interpreter in double (which shows that the rules
// of propagation are exact), and as emitted code with 8 and 4 lanes in float.
#include "slc/area_cases.h"
#include "slc/aux_oracle.h"
#include "slc/explain.h"
#include "slc/oracle_compare.h"
#include "slc/slc_testing.h"

#include <cmath>
#include <gtest/gtest.h>

namespace slc {
namespace {

using testing::compile;

struct Tolerance {
    double relative, absolute;
};
constexpr Tolerance exact = {1e-7, 1e-9}; // double; 1e-9 over steps of 1/32

bool close(double got, double expected, Tolerance t) {
    return std::abs(got - expected) <= t.absolute + t.relative * std::abs(expected) ||
           (std::isnan(got) && std::isnan(expected)) || got == expected;
}

class Shader {
public:
    explicit Shader(const std::string& text, bool optimise = true) {
        const auto c = compile(text, optimise);
        EXPECT_EQ(c.unit.num_errors, 0U) << c.messages << text;
        if (c.unit.programs.empty()) {
            return;
        }
        original = c.unit.programs[0];
        resolved = original;
        CompileOptions options;
        options.optimise = optimise;
        resolve_area_operators(resolved, options);
        const auto complaints = verify_ir(resolved);
        EXPECT_TRUE(complaints.empty()) << complaints.front() << print_ir(resolved);
    }
    Program original, resolved;
};

// Everything the shader hands out at one point.
std::vector<std::pair<std::string, Value>> results(const Program& program,
                                                   const Interpreter& interpreter) {
    std::vector<std::pair<std::string, Value>> all;
    for (const Param& p : program.params) {
        const Var& v = program.vars[static_cast<std::size_t>(p.var)];
        if (v.is_output) {
            all.emplace_back(v.name, interpreter.param(v.name, 0));
        }
    }
    for (const int id : {SL_VAR_P, SL_VAR_N}) { // results of displacement shaders only
        if (program.shader_type != SL_SHADER_displacement) {
            continue;
        }
        all.emplace_back(std::string(variable_rows()[static_cast<std::size_t>(id)].name),
                         interpreter.global(id, 0));
    }
    return all;
}

void expect_like_replay(const std::string& text, bool optimise = true, int num_points = 40) {
    const Shader shader(text, optimise);
    rt::StringTable strings;
    OracleWorld world(strings);
    for (int point = 0; point < num_points; ++point) {
        OnePoint host(world, point);
        AuxOracle oracle(shader.original, host, [&](Interpreter& i, int aux) {
            set_area_inputs(shader.original, i, point, aux);
        });
        ASSERT_TRUE(oracle.run());
        Interpreter mine(shader.resolved, host, 1);
        set_area_inputs(shader.resolved, mine, point, 0);
        for (int id = 0; id < SL_VAR_COUNT; ++id) {
            for (int aux = 1; aux <= 2; ++aux) {
                Value d = area_input(id, point, aux);
                const Value here = area_input(id, point, 0);
                for (std::size_t k = 0; k < d.x.size(); ++k) {
                    d.x[k] -= here.x[k];
                }
                mine.set_aux(id, aux, 0, d);
            }
        }
        for (const Param& p : shader.resolved.params) {
            for (int aux = 1; aux <= 2; ++aux) {
                mine.set_param_aux(p.var, aux, 0, Value(0.03125 * aux));
            }
        }
        ASSERT_TRUE(mine.run());
        const auto expected = results(shader.original, oracle.main());
        const auto got = results(shader.resolved, mine);
        for (std::size_t i = 0; i < expected.size(); ++i) {
            for (std::size_t k = 0; k < expected[i].second.x.size(); ++k) {
                ASSERT_TRUE(close(got[i].second.x[k], expected[i].second.x[k], exact))
                    << expected[i].first << " component " << k << " of point " << point << ": "
                    << got[i].second.x[k] << " instead of " << expected[i].second.x[k] << "\n"
                    << text << "\n"
                    << print_ir(shader.resolved);
            }
        }
        const std::uint64_t handed_on = analyse(shader.resolved).written_aux;
        for (int id = 0; id < SL_VAR_COUNT; ++id) {
            for (int aux = 1; aux <= 2 && (handed_on >> id & 1) != 0; ++aux) {
                const Value there = oracle.at_end(aux, id);
                for (std::size_t k = 0; k < there.x.size(); ++k) {
                    ASSERT_TRUE(close(mine.aux(id, aux, 0).x[k],
                                      there.x[k] - oracle.main().global(id, 0).x[k], exact))
                        << "difference of " << id << " at point " << point << "\n"
                        << text << print_ir(shader.resolved);
                }
            }
        }
    }
}

class Area : public ::testing::TestWithParam<AreaCase> {};

TEST_P(Area, LikeReplay) {
    expect_like_replay(GetParam().text());
}

TEST_P(Area, LikeReplayWithoutOptimisation) {
    expect_like_replay(GetParam().text(), false, 12);
}

std::string case_name(const ::testing::TestParamInfo<AreaCase>& info) {
    return info.param.name;
}

INSTANTIATE_TEST_SUITE_P(Cases, Area, ::testing::ValuesIn(area_cases().begin(), area_cases().end()),
                         case_name);

TEST(Explain, TellsSlices) {
    const auto c = compile("surface t(float k = 2; varying float w = 0;) {\n"
                           "    float x = s * k;\n"
                           "    float y = Du(x * w);\n"
                           "    Ci = Cs * y + texture(\"map\") + Du(k);\n"
                           "}");
    ASSERT_EQ(c.unit.programs.size(), 1U) << c.messages;
    const std::string text = explain_text(c.unit.programs[0], {});
    for (const char* wanted :
         {"  s       read at test.sl:2:17\n", "at auxiliary points  s t w\n",
          "  Du()               test.sl:3:15, along u\n                     from s w; slice: 2 "
          "operations, lines 2-3\n",
          "its argument is the same at all points\n",
          "auxiliary evaluation ends after test.sl:4:36\n",
          "texture()          test.sl:4:19, maps\n", "facts: area_operators textures"}) {
        EXPECT_NE(text.find(wanted), std::string::npos) << wanted << "\n" << text;
    }
}

TEST(Explain, NothingToTell) {
    const auto c = compile("surface t() { Ci = 1; }");
    const std::string text = explain_text(c.unit.programs[0], {});
    EXPECT_NE(text.find("needed variables\n  none\n"), std::string::npos) << text;
    EXPECT_NE(text.find("no auxiliary evaluation\n"), std::string::npos) << text;
}

TEST(AreaDisplacement, HandsDifferencesOn) {
    for (const char* body :
         {"P += .1 * noise(P * 3) * normalize(N); N = calculatenormal(P);",
          "if (s > .9) P += N * t; s *= 2;", "float h = s > .5 ? s : 0; N += h * dPdu; t = 0;",
          "float i; for (i = 0; i < 3; i += 1) { P += .1 * N * s; if (t > .9) break; } N = "
          "calculatenormal(P);"}) {
        expect_like_replay("displacement t(uniform float k = .5) { " + std::string(body) + " }");
    }
}

} // namespace
} // namespace slc
