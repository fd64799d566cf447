// SPDX-License-Identifier: Apache-2.0
// Specialised shaders give the bits of the general ones: every corpus shader and every standard
// shader, with random values of its parameters, points of the oracle's world, results and output
// parameters compared as integers. Values are drawn from those that decide branches (0, 1, -1) and
// from numbers whose sums and products round.
#include "slc/emit_runner.h"
#include "slc/ir_text.h"
#include "slc/oracle_world.h"
#include "slc/specialise.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <gtest/gtest.h>
#include <random>

namespace slc {
namespace {

constexpr std::uint32_t num_points = 61;

class Draw {
public:
    explicit Draw(unsigned seed) : random_(seed) {}
    float number() {
        static constexpr float plain[] = {0, 1, -1, 0.5F, 2, 0.1F, 3, 1e-3F};
        return below(3) > 0 ? plain[below(std::size(plain))]
                            : std::uniform_real_distribution<float>(-2, 4)(random_);
    }
    std::string text() {
        static constexpr const char* texts[] = {"", "shader", "world", "spot", "rgb", "hsv"};
        return texts[below(std::size(texts))];
    }
    std::size_t below(std::size_t n) {
        return std::uniform_int_distribution<std::size_t>(0, n - 1)(random_);
    }

private:
    std::mt19937 random_;
};

std::vector<rt::BoundValue> draw_values(const sl_object& object, Draw& draw) {
    std::vector<rt::BoundValue> values;
    for (int i = 0; i < object.num_params; ++i) {
        const sl_param& p = object.params[i];
        rt::BoundValue v;
        v.name = p.name;
        v.type = static_cast<sl_type>(p.type);
        v.array_length = p.array_length;
        const int elements = std::max(p.array_length, 1);
        for (int k = 0; p.type == SL_TYPE_string && k < elements; ++k) {
            v.strings.push_back(draw.text());
        }
        for (int k = 0; p.type != SL_TYPE_string && k < elements * rt::components_of(p.type); ++k) {
            v.floats.push_back(draw.number());
        }
        if (draw.below(4) > 0) { // the rest keep their defaults
            values.push_back(std::move(v));
        }
    }
    return values;
}

// What is fixed in this specialisation: about three parameters in four.
std::vector<ConstantParam> constants_of(const rt::ShaderInstance& instance, Draw& draw) {
    std::vector<ConstantParam> constants;
    const sl_object& object = instance.object();
    for (int i = 0; i < object.num_params; ++i) {
        const sl_param& p = object.params[i];
        ConstantParam c{p.name, {}, ""};
        if (draw.below(4) == 0 || (p.type == SL_TYPE_string && p.array_length > 0)) {
            continue;
        }
        if (p.type == SL_TYPE_string) {
            c.text = instance.uniform_string(i);
        } else {
            const int n = std::max(p.array_length, 1) * rt::components_of(p.type);
            c.floats.assign(instance.uniform_floats(i), instance.uniform_floats(i) + n);
        }
        constants.push_back(std::move(c));
    }
    return constants;
}

using Bits = std::vector<std::uint32_t>;

void append(Bits& bits, const float* plane, std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) {
        // Every NaN is alike: none reaches a pixel.
        const bool is_number = plane[i] == plane[i];
        std::uint32_t word = 0x7fc00000;
        if (is_number) {
            std::memcpy(&word, plane + i, sizeof word);
        }
        bits.push_back(word);
    }
}

template <class T> T nothing() {
    return T(); // also for void
}

// The oracle's world has no maps: here they are formulas of the place. What else it does not answer
// finds nothing.
sl_services bit_services() {
    sl_services s = OracleWorld::services();
    s.map = [](void*, const sl_map_query* query, float* result) {
        for (std::uint32_t lane = 0; lane < query->lanes; ++lane) {
            for (int c = 0; c < query->num_channels; ++c) {
                const std::size_t at = static_cast<std::size_t>(c) * query->lanes + lane;
                if ((query->mask >> lane & 1U) != 0) {
                    result[at] = 0.25F + 0.125F * query->at[lane] + 0.0625F * static_cast<float>(c);
                }
            }
        }
    };
#define SL_SERVICE(name, result, arguments, note)                                                  \
    if (s.name == nullptr) {                                                                       \
        s.name = [] arguments -> result { return nothing<result>(); };                             \
    }
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-parameter"
#include "runtime/abi/sl_services.def"
#pragma GCC diagnostic pop
#undef SL_SERVICE
    return s;
}

// To the auxiliary points: small, of either sign, no two alike.
void fill_differences(rt::ShadeBatch& batch) {
    for (int id = 0; id < SL_VAR_COUNT; ++id) {
        const auto v = static_cast<sl_variable>(id);
        const auto row = static_cast<std::size_t>(id);
        for (int k = 0; batch.aux_u(v) != nullptr && k < num_components(variable_rows()[row].type);
             ++k) {
            for (std::uint32_t i = 0; i < num_points; ++i) {
                const float x = OracleWorld::input(row, k, static_cast<int>(i));
                batch.aux_u(v, k)[i] = 0.01F * (x - 0.5F);
                batch.aux_v(v, k)[i] = 0.02F * (0.25F - x);
            }
        }
    }
}

// What a run leaves in the variables and parameters that `object` assigns.
Bits run(const rt::ShaderInstance& instance, const sl_object& object, OracleWorld& world) {
    rt::ShadeBatch batch;
    batch.begin(instance, num_points);
    world.set_lanes(static_cast<std::uint32_t>(instance.shader().variant().lanes));
    world.begin_batch();
    for (int id = 0; id < SL_VAR_COUNT; ++id) {
        const auto v = static_cast<sl_variable>(id);
        const VariableRow& row = variable_rows()[static_cast<std::size_t>(id)];
        for (int k = 0; batch.has(v) && k < num_components(row.type); ++k) {
            const bool is_uniform = row.detail == Detail::Uniform;
            float* plane = is_uniform ? batch.uniform(v) + k : batch.plane(v, k);
            for (std::uint32_t i = 0; i < (is_uniform ? 1 : num_points); ++i) {
                plane[i] = OracleWorld::input(static_cast<std::size_t>(id), k, static_cast<int>(i));
            }
        }
    }
    fill_differences(batch);
    for (std::uint32_t i = 0; i < num_points; ++i) {
        batch.seeds()[i] = i;
    }
    const sl_services services = bit_services();
    batch.run({&services, &world});
    Bits bits;
    for (int id = 0; id < SL_VAR_COUNT; ++id) {
        const auto v = static_cast<sl_variable>(id);
        const VariableRow& row = variable_rows()[static_cast<std::size_t>(id)];
        for (int k = 0; (object.written >> id & 1U) != 0 && k < num_components(row.type); ++k) {
            append(bits, batch.plane(v, k), num_points);
        }
    }
    for (int i = 0; i < object.num_params; ++i) {
        const sl_param& p = object.params[i];
        const int planes = std::max(p.array_length, 1) * rt::components_of(p.type);
        for (int k = 0; p.is_output != 0 && k < planes; ++k) {
            if (const float* plane = batch.param_plane(i, k)) {
                append(bits, plane, num_points);
            }
        }
    }
    return bits;
}

Program resolved(Program program, bool exact) {
    CompileOptions options;
    options.exact = exact;
    resolve_area_operators(program, options);
    return program;
}

void expect_same_bits(const Program& program, const std::string& what, unsigned seed) {
    EmitRunner runner;
    OracleWorld world(runner.strings);
    const sl_services services = bit_services();
    const BuildWay way{native_lanes(), 1};
    const Program resolved_general = resolved(program, false);
    const rt::ShaderObject* general =
        runner.build(resolved_general, analyse(resolved_general), way);
    ASSERT_NE(general, nullptr) << what << "\n" << runner.last_c;
    const std::string ir = print_ir(program);
    Draw draw(seed);
    const std::vector<rt::BoundValue> values = draw_values(general->object(), draw);
    const rt::ShaderInstance instance(*general, values, services, &world, runner.strings,
                                      runner.diag);
    std::string error;
    const auto special = specialise(ir, constants_of(instance, draw), error);
    ASSERT_TRUE(special) << what << ": " << error;
    const Program resolved_special = resolved(special->program, true);
    const Facts facts = analyse(resolved_special);
    const rt::ShaderObject* object = runner.build(resolved_special, facts, way);
    ASSERT_NE(object, nullptr) << what << "\n" << runner.last_c;
    ASSERT_TRUE(rt::have_same_block(*object, *general)) << what;
    EXPECT_EQ(facts.needed & ~general->object().needed, 0U) << what;
    // What the special one no longer assigns keeps in either what it was filled with.
    const rt::ShaderInstance fixed(*object, instance);
    EXPECT_TRUE(run(fixed, object->object(), world) == run(instance, object->object(), world))
        << what << ", values " << seed << "\n"
        << print_ir(special->program);
}

TEST(SpecialBits, CorpusAndStandardShaders) {
    const char* root = SLC_TEST_ROOT;
    std::vector<std::string> files;
    for (const char* folder : {"/testsuite/sl/corpus", "/shaders"}) {
        for (const auto& entry : std::filesystem::directory_iterator(root + std::string(folder))) {
            if (entry.path().extension() == ".sl") {
                files.push_back(entry.path().string());
            }
        }
    }
    std::sort(files.begin(), files.end());
    ASSERT_GT(files.size(), 30U);
    unsigned seed = 0;
    for (const std::string& file : files) {
        base::Diag diag(base::Diag::Deferred::Yes);
        const Unit unit = compile_file(file, {}, diag);
        for (const Program& program : unit.programs) {
            expect_same_bits(program, file, ++seed);
        }
    }
}

} // namespace
} // namespace slc
