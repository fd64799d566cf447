// SPDX-License-Identifier: Apache-2.0
// Emitted code against the interpreter: every built-in function on lanes, under a mask and on
// uniform values, and whole shaders. The interpreter works in double precision and shares nothing
// with the emitted code or its library, so values agree up to float rounding; points where a value
// sits on a discontinuity are avoided by the inputs.
#include "slc/oracle_compare.h"
#include "slc/program_builder.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <set>

#ifndef SLC_TEST_ROOT
#error "SLC_TEST_ROOT names the source tree"
#endif

namespace slc {
namespace {

void expect_same(const Program& program, BuildWay way, const std::string& what) {
    Comparison comparison(program, way);
    ASSERT_TRUE(comparison.built()) << what << "\n" << comparison.text();
    for (const std::uint32_t n : {1U, 7U, 64U, 256U}) {
        const std::string difference = comparison.run(n);
        ASSERT_EQ(difference, "") << what << ", batch of " << n << "\n" << comparison.text();
    }
}

std::vector<BuildWay> oracle_ways() {
    std::vector<BuildWay> ways = {{4, 1}};
    if (native_lanes() == 8) {
        ways.push_back({8, 2});
        ways.push_back({8, 0});
    }
    return ways;
}

// --- every row of the table

// A string argument that makes sense to the function.
std::string text_for(const BuiltinRow& row, std::size_t arg) {
    const std::string_view body = row.body;
    if (row.name == "ctransform") {
        return arg == 0 && row.args.size() == 3 ? "hsv" : "YIQ";
    }
    if (row.name == "spline") {
        return "bspline";
    }
    if (row.name == "match") {
        return arg == 0 ? "^a.c*$" : "abccc";
    }
    if (row.name == "printf" || row.name == "format") {
        return "%f|%p|%s %%\n";
    }
    if (body.find("transform") != std::string_view::npos) {
        return arg == 0 ? "object" : "shader";
    }
    return row.has(PropMessage) ? "known" : "text";
}

bool is_comparable(const BuiltinRow& row) {
    // Derivatives need auxiliary points, random numbers are compared by their own tests, files are
    // not there.
    return !row.has(PropArea) && !row.has(PropRandom) && !row.has(PropTraces) &&
           !row.has(PropTextures) && row.body != "arraylength" &&
           row.body != "rayinfo"; // its keys are the engine's own
}

// Calls a row three ways: on lanes, on lanes under a mask, on uniform values.
class RowProgram {
public:
    RowProgram() : builder_("rows") {
        zero_ = builder_.constant(0);
        for (int i = 0; i < 4; ++i) {
            const std::string n = std::to_string(i);
            floats_[i] = builder_.param("f" + n, Type::Float, Detail::Varying, zero_);
            triples_[i] = builder_.param("v" + n, Type::Vector, Detail::Varying, zero_);
        }
        matrix_ = builder_.param("m", Type::Matrix, Detail::Varying, zero_);
        uniform_float_ =
            builder_.param("uf", Type::Float, Detail::Uniform, builder_.constant(0.625F));
        uniform_triple_ = builder_.param("uv", Type::Vector, Detail::Uniform,
                                         builder_.constant({0.75F, -0.5F, 0.375F}, Type::Vector));
        std::vector<float> values(16, 0.125F);
        for (std::size_t i = 0; i < 16; i += 5) {
            values[i] = 2;
        }
        uniform_matrix_ = builder_.param("um", Type::Matrix, Detail::Uniform,
                                         builder_.constant(values, Type::Matrix));
        condition_ =
            builder_.value(builder_.program.body, Op::Lt, {floats_[0], builder_.constant(0.9F)});
    }

    void add(int row_index) {
        const BuiltinRow& row = builtin_rows()[static_cast<std::size_t>(row_index)];
        Block& body = builder_.program.body;
        make_call(row_index, body, Detail::Varying, "lanes_");
        Block arm;
        make_call(row_index, arm, Detail::Varying, "masked_");
        body.push_back(
            builder_.with_bodies(builder_.statement(Op::If, no_var, {condition_}), {arm, {}}));
        if (!row.has(PropVaries) && !row.has(PropSpaces) && !row.has(PropMessage) &&
            row.reads == 0) {
            make_call(row_index, body, Detail::Uniform, "uniform_");
        }
    }

    [[nodiscard]] const Program& program() const { return builder_.program; }

private:
    void make_call(int row_index, Block& b, Detail detail, const std::string& prefix) {
        const BuiltinRow& row = builtin_rows()[static_cast<std::size_t>(row_index)];
        const std::string stem = prefix + std::to_string(row_index) + "_" + std::string(row.body);
        Stmt s = builder_.statement(Op::Call, no_var);
        s.builtin = row_index;
        for (std::size_t i = 0; i < row.args.size(); ++i) {
            s.args.push_back(argument(row, i, detail, stem));
            if (i == 0 && row.has(PropChannel)) {
                s.args.push_back(zero_);
            }
        }
        if (row.repeats_last) {
            s.args.push_back(argument(row, row.args.size() - 1, detail, stem));
        }
        if (row.takes_values) {
            const bool lanes = detail == Detail::Varying;
            s.args.insert(s.args.end(),
                          {lanes ? floats_[1] : uniform_float_,
                           lanes ? triples_[1] : uniform_triple_, builder_.text("some")});
        }
        if (row.result.type != Type::Void || row.result.kind != ArgKind::Exact) {
            s.dst = output(stem, row.result.kind == ArgKind::Exact ? row.result.type : Type::Vector,
                           detail);
        }
        b.push_back(s);
    }

    VarId output(const std::string& name, Type type, Detail detail) {
        const VarId initial = type == Type::String ? builder_.text("") : zero_;
        return builder_.param(name, type, detail, initial, true);
    }

    VarId argument(const BuiltinRow& row, std::size_t i, Detail detail, const std::string& stem) {
        const ArgSpec& spec = row.args[i];
        const bool lanes = detail == Detail::Varying;
        const Type type = spec.kind == ArgKind::Exact      ? spec.type
                          : spec.kind == ArgKind::Anything ? Type::Color
                                                           : Type::Vector;
        if (spec.is_output) {
            return output(stem + "_out" + std::to_string(i), type, detail);
        }
        if (spec.is_array) {
            const bool triple = is_triple(type);
            std::vector<float> knots;
            for (int k = 0; k < (triple ? 15 : 5); ++k) {
                knots.push_back(OracleWorld::input(50, k, 0));
            }
            return builder_.constant(knots, type, 5);
        }
        switch (type) {
        case Type::Float:
            return lanes ? floats_[i % 4] : uniform_float_;
        case Type::Matrix:
            return lanes ? matrix_ : uniform_matrix_;
        case Type::String:
            return builder_.text(text_for(row, i));
        default:
            return lanes ? triples_[i % 4] : uniform_triple_;
        }
    }

    ProgramBuilder builder_;
    VarId zero_, matrix_, uniform_float_, uniform_triple_, uniform_matrix_, condition_;
    VarId floats_[4], triples_[4];
};

class Oracle : public ::testing::TestWithParam<BuildWay> {};

TEST_P(Oracle, EveryBuiltin) {
    constexpr std::size_t rows_per_program = 24;
    const std::size_t num_rows = builtin_rows().size();
    std::size_t row = 0;
    while (row < num_rows) {
        RowProgram rows;
        std::string names;
        for (std::size_t n = 0; n < rows_per_program && row < num_rows; ++row) {
            if (is_comparable(builtin_rows()[row])) {
                rows.add(static_cast<int>(row));
                names += " " + std::string(builtin_rows()[row].body);
                ++n;
            }
        }
        expect_same(rows.program(), GetParam(), "built-ins" + names);
    }
}

// --- whole shaders

class Shaders : public ::testing::TestWithParam<BuildWay> {
protected:
    void compare_file(const std::string& path) {
        base::Diag diag(std::tmpfile());
        CompileOptions options;
        options.include_dirs = {std::string(SLC_TEST_ROOT) + "/testsuite/shaders"};
        const Unit unit = compile_file(path, options, diag);
        for (const Program& program : unit.programs) {
            if ((analyse(program).facts & (SL_FACT_random | SL_FACT_textures)) == 0) {
                expect_same(program, GetParam(), path + ": " + program.name);
            }
        }
    }
};

TEST_P(Shaders, Standard) {
    int num_files = 0;
    for (const auto& entry :
         std::filesystem::directory_iterator(std::string(SLC_TEST_ROOT) + "/shaders")) {
        if (entry.path().extension() == ".sl") {
            compare_file(entry.path().string());
            ++num_files;
        }
    }
    EXPECT_GE(num_files, 15);
}

TEST_P(Shaders, LanguageCases) {
    for (const char* name : {"arrays", "colours", "control_flow", "functions", "geometry_rules",
                             "illuminance_category", "illuminance_forms", "math_edges", "operators",
                             "splines", "steps", "strings"}) {
        compare_file(std::string(SLC_TEST_ROOT) + "/testsuite/cases/sl/" + name + ".sl");
    }
}

// The corpus of whole shaders, one way: what the other ways add is in the tests above.
TEST(OracleCorpus, Agrees) {
    const std::string root = SLC_TEST_ROOT;
    CompileOptions options;
    options.standard_headers = root + "/shaders/headers";
    int num_compared = 0;
    for (const auto& entry : std::filesystem::directory_iterator(root + "/testsuite/sl/corpus")) {
        if (entry.path().extension() != ".sl") {
            continue;
        }
        base::Diag diag(std::tmpfile());
        const Unit unit = compile_file(entry.path().string(), options, diag);
        for (const Program& program : unit.programs) {
            constexpr auto incomparable =
                SL_FACT_area_operators | SL_FACT_random | SL_FACT_textures | SL_FACT_traces;
            if ((analyse(program).facts & incomparable) == 0) {
                expect_same(program, {native_lanes(), 0},
                            entry.path().string() + ": " + program.name);
                ++num_compared;
            }
        }
    }
    EXPECT_GE(num_compared, 30);
}

std::string way_name(const ::testing::TestParamInfo<BuildWay>& info) {
    return "Lanes" + std::to_string(info.param.lanes) + "O" +
           std::to_string(info.param.optimisation);
}

INSTANTIATE_TEST_SUITE_P(Ways, Oracle, ::testing::ValuesIn(oracle_ways()), way_name);
INSTANTIATE_TEST_SUITE_P(Ways, Shaders, ::testing::ValuesIn(oracle_ways()), way_name);

} // namespace
} // namespace slc
