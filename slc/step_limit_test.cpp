// SPDX-License-Identifier: Apache-2.0
// Loops that do not end: their lanes are stopped, alone, keep the results they came with, and the
// engine is asked and told (docs/robustness.md). What may be counted and what need not.
#include "slc/emit_runner.h"
#include "slc/loop_bounds.h"

#include <gtest/gtest.h>

namespace slc {
namespace {

constexpr std::uint32_t limit = 50'000;

struct Engine {
    int num_stops = 0;
    std::int32_t line = 0;
    std::uint32_t stopped = 0; // lanes of the last stop
};

std::uint32_t loop_steps(void* engine, std::uint32_t used, std::uint32_t mask, sl_string,
                         std::int32_t line) {
    if (used < limit) {
        return limit - used;
    }
    auto& e = *static_cast<Engine*>(engine);
    ++e.num_stops;
    e.line = line;
    e.stopped = mask;
    return 0;
}

Unit compile(const std::string& body, const std::string& params = "",
             const std::string& functions = "") {
    base::Diag diag;
    CompileOptions options;
    options.is_preprocessed = true;
    return compile_text(functions + "surface t(varying float x = 0; output varying float o = 7; " +
                            params + ")\n{\n" + body + "\n}\n",
                        "t.sl", options, diag);
}

class Steps : public ::testing::TestWithParam<int> {
protected:
    // x is the number of the point. Results o.
    std::vector<float> run(const Unit& unit, std::uint32_t n = 11) {
        EXPECT_TRUE(unit.ok());
        const Program& program = unit.programs.at(0);
        const rt::ShaderObject* object = runner.build(program, analyse(program), {GetParam(), 1});
        if (object == nullptr) {
            return {};
        }
        sl_services services = empty_services(runner.strings);
        services.loop_steps = loop_steps;
        const rt::ShaderInstance instance(*object, {}, services, &engine, runner.strings,
                                          runner.diag);
        rt::ShadeBatch batch;
        batch.begin(instance, n);
        for (std::uint32_t i = 0; i < n; ++i) {
            batch.param_plane(0, 0)[i] = static_cast<float>(i);
        }
        batch.run({&services, &engine});
        return {batch.param_plane(1, 0), batch.param_plane(1, 0) + n};
    }

    EmitRunner runner;
    Engine engine;
};

TEST_P(Steps, UniformLoopStopsAllLanes) {
    for (const float o : run(compile("o = 1; while (1) o += 1;\no += 2;"))) {
        EXPECT_EQ(o, 7);
    }
    EXPECT_EQ(engine.num_stops, (11 + GetParam() - 1) / GetParam());
    EXPECT_EQ(engine.line, 3);
}

TEST_P(Steps, OtherLanesGoOn) {
    const auto o = run(compile("o = 0; float i = 0;\nwhile (i < x || x == 3) { i += 1; o += 2; }"));
    for (std::size_t i = 0; i < o.size(); ++i) {
        EXPECT_EQ(o[i], i == 3 ? 7 : 2 * static_cast<float>(i)) << i;
    }
    EXPECT_EQ(engine.num_stops, 1);
    EXPECT_EQ(engine.stopped, 1U << 3);
}

TEST_P(Steps, NestedLoops) {
    const auto o =
        run(compile("float i; o = 0;\n"
                    "for (i = 0; i < x; i += 1) {\n"
                    "  o += 1;\n"
                    "  if (x == 2) while (1) { while (1) o += 1; }\n"
                    "  if (x == 5) { while (i >= 0) { o += 1; while (o > 3) o += 1; } }\n"
                    "}"));
    for (std::size_t i = 0; i < o.size(); ++i) {
        EXPECT_EQ(o[i], i == 2 || i == 5 ? 7 : static_cast<float>(i)) << i;
    }
    EXPECT_LE(engine.num_stops, 4);
}

TEST_P(Steps, FunctionsScopesAndNaN) {
    const auto o = run(compile("float never = (x - x) / (x - x);\n"
                               "o = f(x); while (!(never < 1) && x == 4) o += 1;",
                               "",
                               "float f(float a) { float i = 0; while (1) { i += 1; if (i > a) "
                               "return i; if (a == 9) { while (1) i += 0; } } return 0; }\n"));
    for (std::size_t i = 0; i < o.size(); ++i) {
        EXPECT_EQ(o[i], i == 4 || i == 9 ? 7 : static_cast<float>(i) + 1) << i;
    }
}

TEST_P(Steps, Defaults) {
    const auto o = run(compile("o = a + b;", "float a = f(-1); float b = f(3);",
                               "float f(float a) { float i = 0; while (1) { i += 1; if (i == a) "
                               "return i; while (a < 0) i += 1; } return 0; }\n"));
    for (const float value : o) {
        EXPECT_EQ(value, 3); // a stays 0
    }
    EXPECT_EQ(engine.num_stops, 1);
}

TEST_P(Steps, HonestLoopsAreLeftAlone) {
    const auto o = run(compile("float i, j; o = 0; for (i = 0; i < 200; i += 1) for (j = 0; j < "
                               "200; j += 1) o += 1;"));
    for (const float value : o) {
        EXPECT_EQ(value, 40000);
    }
    EXPECT_EQ(engine.num_stops, 0);
}

std::string lanes_name(const ::testing::TestParamInfo<int>& info) {
    return (info.index == 0 ? "Narrow" : "Native") + std::to_string(info.param);
}

INSTANTIATE_TEST_SUITE_P(Lanes, Steps, ::testing::Values(4, native_lanes()), lanes_name);

// What the recogniser sees without running anything.
std::size_t num_counted(const std::string& body) {
    const Unit unit = compile(body, "uniform float n = 4;");
    const Program& program = unit.programs.at(0);
    const CountedLoops counted(program, program.body);
    std::size_t num = 0;
    const auto visit = [&](const auto& self, const Block& b) -> void {
        for (const Stmt& s : b) {
            num += s.op == Op::Loop && counted.counts(s) ? 1 : 0;
            for (const Block& inner : s.bodies) {
                self(self, inner);
            }
        }
    };
    visit(visit, program.body);
    return num;
}

TEST(CountedLoops, ConstantOnesAreFree) {
    EXPECT_EQ(num_counted("float i; for (i = 0; i < 8; i += 1) o += x;"), 0U);
    EXPECT_EQ(num_counted("float i; for (i = 8; i > 0; i -= 2) o += x;"), 0U);
    EXPECT_EQ(num_counted("float i; for (i = 0; i < n; i += 1) o += x;"), 1U);
    EXPECT_EQ(num_counted("float i; for (i = 0; i < 8; i -= 1) o += x;"), 1U);
    EXPECT_EQ(num_counted("float i; for (i = 0; i < 8; i += 0) o += x;"), 1U);
    EXPECT_EQ(num_counted("float i; for (i = 0; i < 8; i += 1) { i -= x; o += x; }"), 1U);
    EXPECT_EQ(num_counted("float i; for (i = 0; i < 1000; i += 1) o += x;"), 1U);
    EXPECT_EQ(num_counted("float i; for (i = 1e20; i < 1e20; i += 1) o += x;"), 1U);
    EXPECT_EQ(num_counted("while (o < 3) o += x;"), 1U);
    // The inner one is free; what holds it is counted.
    EXPECT_EQ(num_counted("float i, j; for (i = 0; i < 9; i += 1) for (j = 0; j < 9; j += 1) o += "
                          "x;"),
              1U);
}

} // namespace
} // namespace slc
