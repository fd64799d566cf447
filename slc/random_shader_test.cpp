// SPDX-License-Identifier: Apache-2.0
// Random shaders in four worlds: 8 lanes and 4 lanes with the passes, 4 lanes without them, and
// everything uniform; and on the interpreter. Lanes and uniform values agree bit for bit; the
// interpreter, and the program without passes (whose constants are computed in float instead of
// double), within what float arithmetic makes of the shader: the interpreter rounds at random, and
// the spread of a few runs is the tolerance. Results it spreads too far are skipped and counted.
//
// SLC_RANDOM_SEED first seed, SLC_RANDOM_COUNT how many, SLC_RANDOM_PRINT=1 prints each shader.
#include "slc/emit_runner.h"
#include "slc/oracle_world.h"
#include "slc/random_shader.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <gtest/gtest.h>
#include <limits>

namespace slc {
namespace {

constexpr int num_points = 13;    // a full packet of 8 and a part of one
constexpr int uniform_points = 3; // of them in the uniform world
constexpr int num_roundings = 5;
constexpr double spread_factor = 4;      // few runs do not find the worst rounding
constexpr double floor_tolerance = 4e-6; // what every result may be off
constexpr double ill_conditioned = 1e-2; // nothing is learnt from such a result

using Results = std::vector<float>; // output components of all points

struct Compiled {
    Program program;
    Facts facts;
};

std::optional<Compiled> compile(const std::string& source, bool optimise) {
    base::Diag diag;
    diag.set_threshold(base::Severity::Error);
    CompileOptions options;
    options.is_preprocessed = true;
    options.optimise = optimise;
    Unit unit = compile_text(source, "random.sl", options, diag);
    if (!unit.ok() || unit.programs.size() != 1) {
        return std::nullopt;
    }
    Compiled c{std::move(unit.programs.front()), {}};
    c.facts = analyse(c.program);
    return c;
}

const Var& param(const Program& program, std::size_t i) {
    return program.vars[static_cast<std::size_t>(program.params[i].var)];
}

class World {
public:
    World(const RandomShader& shader, bool optimise)
        : shader_(shader), compiled_(compile(shader.source, optimise)) {}

    [[nodiscard]] bool ok() const { return compiled_.has_value(); }

    // All points in one batch; empty: not built.
    Results lanes(BuildWay way) {
        const rt::ShaderObject* object = runner_.build(program(), compiled_->facts, way);
        Results results;
        if (object != nullptr) {
            run(*object, {}, num_points, results);
        }
        return results;
    }

    // A batch of its own for each of the first points, inputs bound as parameters.
    Results uniform(BuildWay way) {
        const rt::ShaderObject* object = runner_.build(program(), compiled_->facts, way);
        Results results;
        for (int point = 0; object != nullptr && point < uniform_points; ++point) {
            std::vector<rt::BoundValue> values;
            for (std::size_t p = 0; p < num_inputs(); ++p) {
                rt::BoundValue v;
                v.name = param(program(), p).name;
                v.type = static_cast<sl_type>(param(program(), p).type);
                for (int k = 0; k < num_components(param(program(), p).type); ++k) {
                    v.floats.push_back(OracleWorld::input(100 + p, k, point));
                }
                values.push_back(std::move(v));
            }
            run(*object, values, 1, results);
        }
        return results;
    }

    // rounding 0: double precision.
    Results interpreted(std::uint32_t rounding) {
        OracleWorld world(runner_.strings);
        Interpreter interpreter(program(), world, num_points);
        for (std::size_t p = 0; p < num_inputs(); ++p) {
            const Var& v = param(program(), p);
            for (int i = 0; i < num_points; ++i) {
                Value value = Value::zero(v.type);
                for (std::size_t k = 0; k < value.x.size(); ++k) {
                    value.x[k] = OracleWorld::input(100 + p, static_cast<int>(k), i);
                }
                interpreter.set_param(v.name, i, value);
            }
        }
        if (rounding != 0) {
            interpreter.round_at_random(rounding);
        }
        Results results;
        if (!interpreter.run()) {
            return results;
        }
        for (int i = 0; i < num_points; ++i) {
            for (std::size_t p = num_inputs(); p < program().params.size(); ++p) {
                for (const double x : interpreter.param(param(program(), p).name, i).x) {
                    const bool is_defined = !interpreter.left_numbers(i);
                    results.push_back(is_defined ? static_cast<float>(x)
                                                 : std::numeric_limits<float>::quiet_NaN());
                }
            }
        }
        return results;
    }

    [[nodiscard]] const std::string& text() const { return runner_.last_c; }

private:
    [[nodiscard]] const Program& program() const { return compiled_->program; }
    [[nodiscard]] std::size_t num_inputs() const {
        return static_cast<std::size_t>(shader_.num_inputs);
    }

    void run(const rt::ShaderObject& object, const std::vector<rt::BoundValue>& values, int n,
             Results& results) {
        const rt::ShaderInstance instance(object, values, runner_.services, nullptr,
                                          runner_.strings, runner_.diag);
        rt::ShadeBatch batch;
        batch.begin(instance, static_cast<std::uint32_t>(n));
        for (std::size_t p = 0; p < num_inputs() && values.empty(); ++p) {
            for (int k = 0; k < num_components(param(program(), p).type); ++k) {
                float* plane = batch.param_plane(static_cast<int>(p), k);
                for (int i = 0; i < n; ++i) {
                    plane[i] = OracleWorld::input(100 + p, k, i);
                }
            }
        }
        batch.run({&runner_.services, nullptr});
        for (int i = 0; i < n; ++i) {
            for (std::size_t p = num_inputs(); p < program().params.size(); ++p) {
                for (int k = 0; k < num_components(param(program(), p).type); ++k) {
                    results.push_back(batch.param_plane(static_cast<int>(p), k)[i]);
                }
            }
        }
    }

    EmitRunner runner_;
    RandomShader shader_;
    std::optional<Compiled> compiled_;
};

// Not a number is not a number, whatever its bits.
bool same_bits(float a, float b) {
    return std::memcmp(&a, &b, sizeof a) == 0 || (std::isnan(a) && std::isnan(b));
}

std::string first_difference(const Results& a, const Results& b) {
    const std::size_t n = std::min(a.size(), b.size());
    for (std::size_t i = 0; i < n; ++i) {
        if (!same_bits(a[i], b[i])) {
            return "result " + std::to_string(i) + ": " + std::to_string(a[i]) + " and " +
                   std::to_string(b[i]);
        }
    }
    return n == 0 ? "no results" : "";
}

struct Tolerances {
    Results expected;
    std::vector<double> tolerance; // negative: skip
};

Tolerances expectations(World& world) {
    Tolerances t{world.interpreted(0), {}};
    t.tolerance.assign(t.expected.size(), 0);
    for (std::uint32_t round = 1; round <= num_roundings; ++round) {
        const Results other = world.interpreted(round * 2654435761U);
        for (std::size_t i = 0; i < t.tolerance.size() && i < other.size(); ++i) {
            const double spread =
                std::abs(static_cast<double>(other[i]) - static_cast<double>(t.expected[i]));
            const bool usable = std::isfinite(spread) && t.tolerance[i] >= 0;
            t.tolerance[i] = usable ? std::max(t.tolerance[i], spread) : -1;
        }
    }
    for (std::size_t i = 0; i < t.tolerance.size(); ++i) {
        const double size = std::max(1.0, std::abs(static_cast<double>(t.expected[i])));
        if (t.tolerance[i] > ill_conditioned * size) {
            t.tolerance[i] = -1;
        } else if (t.tolerance[i] >= 0) {
            t.tolerance[i] = spread_factor * t.tolerance[i] + floor_tolerance * size;
        }
    }
    return t;
}

struct Count {
    std::size_t compared = 0, skipped = 0, differ_without_passes = 0;
};

std::string first_far(const Results& got, const Tolerances& t, Count& count) {
    for (std::size_t i = 0; i < got.size() && i < t.expected.size(); ++i) {
        if (t.tolerance[i] < 0) {
            ++count.skipped;
            continue;
        }
        ++count.compared;
        const double off =
            std::abs(static_cast<double>(got[i]) - static_cast<double>(t.expected[i]));
        if (!(off <= t.tolerance[i])) {
            return "result " + std::to_string(i) + ": " + std::to_string(got[i]) + " instead of " +
                   std::to_string(t.expected[i]) + " +- " + std::to_string(t.tolerance[i]);
        }
    }
    return got.empty() ? "no results" : "";
}

std::string told(unsigned seed, const RandomShader& shader) {
    if (std::getenv("SLC_RANDOM_PRINT") != nullptr) {
        std::printf("/* seed %u */\n%s\n", seed, shader.source.c_str());
    }
    return "seed " + std::to_string(seed) + "\n" + shader.source;
}

void compare_bits(unsigned seed) {
    const RandomShader shader = random_shader(seed, false);
    SCOPED_TRACE(told(seed, shader));
    World lanes(shader, true);
    World uniform(random_shader(seed, true), true);
    ASSERT_TRUE(lanes.ok() && uniform.ok());
    const Results narrow = lanes.lanes({4, 1});
    if (native_lanes() == 8) {
        EXPECT_EQ(first_difference(lanes.lanes({8, 1}), narrow), "") << "8 lanes, 4 lanes";
    }
    EXPECT_EQ(first_difference(uniform.uniform({4, 0}), narrow), "") << "uniform values, lanes";
}

void compare_values(unsigned seed, Count& count) {
    const RandomShader shader = random_shader(seed, false);
    SCOPED_TRACE(told(seed, shader));
    World with(shader, true);
    World without(shader, false);
    ASSERT_TRUE(with.ok() && without.ok());
    const Results lanes = with.lanes({native_lanes(), 1});
    EXPECT_EQ(first_far(lanes, expectations(with), count), "") << "against the interpreter";
    const Results plain = without.lanes({4, 0});
    EXPECT_EQ(first_far(plain, expectations(without), count), "") << "without passes";
    count.differ_without_passes += first_difference(lanes, plain).empty() ? 0 : 1;
}

unsigned from_environment(const char* name, unsigned otherwise) {
    const char* text = std::getenv(name);
    return text != nullptr ? static_cast<unsigned>(std::strtoul(text, nullptr, 10)) : otherwise;
}

TEST(RandomShaders, SameBits) {
    const unsigned first = from_environment("SLC_RANDOM_SEED", 1);
    const unsigned n = from_environment("SLC_RANDOM_COUNT", 24);
    for (unsigned seed = first; seed < first + n && !HasFailure(); ++seed) {
        compare_bits(seed);
    }
}

TEST(RandomShaders, SameValues) {
    const unsigned first = from_environment("SLC_RANDOM_SEED", 1);
    const unsigned n = from_environment("SLC_RANDOM_COUNT", 24);
    Count count;
    for (unsigned seed = first; seed < first + n && !HasFailure(); ++seed) {
        compare_values(seed, count);
    }
    std::printf("%zu results compared, %zu skipped; of %u shaders %zu change in the last places "
                "without passes\n",
                count.compared, count.skipped, n, count.differ_without_passes);
    EXPECT_GT(count.compared, 3 * count.skipped);
}

} // namespace
} // namespace slc
