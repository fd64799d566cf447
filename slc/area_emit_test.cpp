// SPDX-License-Identifier: Apache-2.0
// Area operators in emitted code, 8 and 4 lanes in float, against record and replay of the program
// as written (aux_oracle.h), in double.
#include "slc/area_cases.h"
#include "slc/aux_oracle.h"
#include "slc/emit_runner.h"
#include "slc/slc_testing.h"

#include <cmath>
#include <gtest/gtest.h>

namespace slc {
namespace {

// Values of order 1 in float, over steps of 1/32 and more; noise and divisions multiply rounding.
constexpr double tolerance = 1e-3;
constexpr std::uint32_t num_points = 64;

bool close(double got, double expected) {
    return std::abs(got - expected) <= tolerance * std::max(1.0, std::abs(expected)) ||
           (std::isnan(got) && std::isnan(expected));
}

class AreaEmit : public ::testing::TestWithParam<BuildWay> {
protected:
    void compare(const AreaCase& c);
    void fill(const Program& program, const Facts& facts, rt::ShadeBatch& batch) const;
};

void AreaEmit::fill(const Program& program, const Facts& facts, rt::ShadeBatch& batch) const {
    for (int id = 0; id < SL_VAR_COUNT; ++id) {
        const VariableRow& row = variable_rows()[static_cast<std::size_t>(id)];
        const auto variable = static_cast<sl_variable>(id);
        for (std::uint32_t i = 0; i < num_points; ++i) {
            const Value here = area_input(id, static_cast<int>(i), 0);
            for (int k = 0; k < num_components(row.type); ++k) {
                const double x = here.x[static_cast<std::size_t>(k)];
                if (batch.has(variable)) {
                    (row.detail == Detail::Uniform ? batch.uniform(variable) + k
                                                   : batch.plane(variable, k) + i)[0] =
                        static_cast<float>(x);
                }
                for (int aux = 1; aux <= 2 && (facts.needed_aux >> id & 1) != 0; ++aux) {
                    const double there =
                        area_input(id, static_cast<int>(i), aux).x[static_cast<std::size_t>(k)];
                    (aux == 1 ? batch.aux_u(variable, k) : batch.aux_v(variable, k))[i] =
                        static_cast<float>(there - x);
                }
            }
        }
    }
    for (std::size_t p = 0; p < program.params.size(); ++p) {
        const Var& v = program.vars[static_cast<std::size_t>(program.params[p].var)];
        const auto index = static_cast<int>(p);
        for (std::uint32_t i = 0; i < num_points; ++i) {
            if (v.detail != Detail::Varying || v.is_output || v.type != Type::Float) {
                continue;
            }
            const auto at = [&](int aux) {
                return area_param(program, program.params[p], static_cast<int>(i), aux);
            };
            batch.param_plane(index)[i] = static_cast<float>(at(0));
            for (int aux = 1; aux <= 2 && facts.aux_params[p]; ++aux) {
                batch.param_aux(index, aux)[i] = static_cast<float>(at(aux) - at(0));
            }
        }
    }
}

void AreaEmit::compare(const AreaCase& c) {
    const auto compiled = testing::compile(c.text());
    ASSERT_EQ(compiled.unit.num_errors, 0U) << compiled.messages;
    const Program& original = compiled.unit.programs[0];
    Program resolved = original;
    resolve_area_operators(resolved, {});
    const Facts facts = analyse(resolved);
    EmitRunner runner;
    const rt::ShaderObject* object = runner.build(resolved, facts, GetParam());
    ASSERT_NE(object, nullptr) << runner.last_c;
    OracleWorld world(runner.strings);
    world.set_lanes(static_cast<std::uint32_t>(GetParam().lanes));
    const sl_services services = OracleWorld::services();
    const rt::ShaderInstance instance(*object, {}, services, &world, runner.strings, runner.diag);
    rt::ShadeBatch batch;
    batch.begin(instance, num_points);
    fill(original, facts, batch);
    for (std::uint32_t i = 0; i < num_points; ++i) {
        batch.seeds()[i] = i;
    }
    ASSERT_EQ(batch.run({&services, &world}), 0U);
    for (std::uint32_t i = 0; i < num_points; ++i) {
        OnePoint host(world, static_cast<int>(i));
        AuxOracle oracle(original, host, [&](Interpreter& interpreter, int aux) {
            set_area_inputs(original, interpreter, static_cast<int>(i), aux);
        });
        ASSERT_TRUE(oracle.run());
        for (int p = 0; p < 2; ++p) {
            const Value& expected = oracle.main().param(p == 0 ? "r" : "q", 0);
            for (int k = 0; k < (p == 0 ? 1 : 3); ++k) {
                const float got = batch.param_plane(p, k)[i];
                ASSERT_TRUE(close(got, expected.x[static_cast<std::size_t>(k)]))
                    << c.name << ": " << (p == 0 ? "r" : "q") << " component " << k << " of point "
                    << i << " is " << got << " instead of "
                    << expected.x[static_cast<std::size_t>(k)] << "\n"
                    << runner.last_c;
            }
        }
    }
}

TEST_P(AreaEmit, LikeReplay) {
    for (const AreaCase& c : area_cases()) {
        SCOPED_TRACE(c.name);
        compare(c);
    }
}

std::vector<BuildWay> ways() {
    std::vector<BuildWay> all = {{4, 1}};
    if (native_lanes() == 8) {
        all.push_back({8, 1});
    }
    return all;
}

std::string way_name(const ::testing::TestParamInfo<BuildWay>& info) {
    return "Lanes" + std::to_string(info.param.lanes);
}

INSTANTIATE_TEST_SUITE_P(Ways, AreaEmit, ::testing::ValuesIn(ways()), way_name);

} // namespace
} // namespace slc
