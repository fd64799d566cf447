// SPDX-License-Identifier: Apache-2.0
#include "slc/oracle_compare.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <new>
#include <random>
#include <set>

namespace slc {

namespace {

// Float against double through a few dozen operations; noise multiplies the rounding of its
// argument by its slope.
constexpr double tolerance = 3e-4;

bool close(double got, double expected) {
    if (std::isnan(got) || std::isnan(expected)) {
        return std::isnan(got) && std::isnan(expected);
    }
    return std::abs(got - expected) <= tolerance * std::max(1.0, std::abs(expected)) ||
           got == expected;
}

std::string difference(const std::string& name, std::uint32_t point, int component, double got,
                       double expected) {
    return name + " component " + std::to_string(component) + " of point " + std::to_string(point) +
           ": " + std::to_string(got) + " instead of " + std::to_string(expected);
}

} // namespace

Comparison::Comparison(const Program& program, BuildWay way)
    : program_(program), world_(runner_.strings), way_(way) {
    resolve_area_operators(program_, {});
    facts_ = analyse(program_);
    object_ = runner_.build(program_, facts_, way);
}

std::string Comparison::run(std::uint32_t num_points) {
    const sl_services services = OracleWorld::services();
    world_.set_lanes(static_cast<std::uint32_t>(way_.lanes));
    world_.begin_batch();
    const rt::ShaderInstance instance(*object_, {}, services, &world_, runner_.strings,
                                      runner_.diag);
    rt::ShadeBatch batch;
    batch.begin(instance, num_points);
    Interpreter oracle(program_, world_, static_cast<int>(num_points));
    fill(batch, oracle, num_points);
    if (instance.shader().variant().frame_size > 0) {
        shade_in_any_order(batch, services, instance.shader().variant());
    } else if (batch.run({&services, &world_}) != 0) {
        return "suspended";
    }
    const std::vector<std::string> printed = world_.printed();
    world_.printed().clear();
    if (!oracle.run()) {
        return "the interpreter did not end";
    }
    std::string difference = compare_lit(batch, oracle, num_points);
    if (!difference.empty()) {
        return difference;
    }
    difference = compare_variables(batch, oracle, num_points);
    if (difference.empty()) {
        difference = compare_params(batch, oracle, num_points);
    }
    // Packets print one after the other, the interpreter statement by statement.
    const std::multiset<std::string> mine(printed.begin(), printed.end());
    const std::multiset<std::string> others(world_.printed().begin(), world_.printed().end());
    if (difference.empty() && mine != others) {
        difference = "printed " + std::to_string(printed.size()) + " lines, the interpreter " +
                     std::to_string(world_.printed().size());
    }
    return difference;
}

// Packets of a shader that waits, one step of a packet picked at random after the other. Frames
// hold rubbish at first, and nothing a packet left on the stack is there when it goes on.
void Comparison::shade_in_any_order(rt::ShadeBatch& batch, const sl_services& services,
                                    const sl_variant& variant) {
    batch.bind({&services, &world_});
    const auto lanes = static_cast<std::uint32_t>(variant.lanes);
    const std::align_val_t alignment{variant.frame_align};
    std::vector<std::uint32_t> waiting;
    std::vector<sl_frame*> frames;
    for (std::uint32_t packet = 0; packet < batch.num_packets(); ++packet) {
        void* const memory = ::operator new(variant.frame_size, alignment);
        std::memset(memory, 0xa5, variant.frame_size);
        frames.push_back(static_cast<sl_frame*>(memory));
        frames.back()->state = 0;
        waiting.push_back(packet);
    }
    std::minstd_rand random(batch.count());
    while (!waiting.empty()) {
        const std::size_t i = random() % waiting.size();
        const std::uint32_t first = waiting[i] * lanes;
        sl_frame* const frame = frames[waiting[i]];
        if (frame->state != 0) {
            world_.answer(frame->rays);
        }
        const std::uint32_t count = std::min(lanes, batch.count() - first);
        if (variant.shade(&batch.raw(), first, count, frame) == SL_DONE) {
            ::operator delete(frame, alignment);
            waiting.erase(waiting.begin() + static_cast<std::ptrdiff_t>(i));
        }
    }
}

void Comparison::fill(rt::ShadeBatch& batch, Interpreter& oracle, std::uint32_t n) {
    for (std::size_t id = 0; id < variable_rows().size(); ++id) {
        const VariableRow& row = variable_rows()[id];
        if (((facts_.needed | facts_.written) >> id & 1U) == 0) {
            continue;
        }
        const int components = num_components(row.type);
        for (std::uint32_t i = 0; i < n; ++i) {
            Value value = Value::zero(row.type);
            for (int k = 0; k < components; ++k) {
                // Uniform variables have one value; Cl starts at zero in a light.
                const int point = row.detail == Detail::Uniform ? 0 : static_cast<int>(i);
                const float x = id == SL_VAR_Cl ? 0 : OracleWorld::input(id, k, point);
                value.x[static_cast<std::size_t>(k)] = x;
                if (row.detail == Detail::Uniform) {
                    batch.uniform(static_cast<sl_variable>(id))[k] = x;
                } else {
                    batch.plane(static_cast<sl_variable>(id), k)[i] = x;
                }
            }
            oracle.set_global(static_cast<int>(id), static_cast<int>(i), value);
        }
    }
    fill_differences(batch, oracle, n);
    for (std::uint32_t i = 0; i < n; ++i) {
        batch.seeds()[i] = world_.seed(static_cast<int>(i));
    }
    // Varying parameters that are no outputs differ from point to point.
    for (std::size_t p = 0; p < program_.params.size(); ++p) {
        const Var& v = program_.vars[static_cast<std::size_t>(program_.params[p].var)];
        if (v.detail != Detail::Varying || v.is_output || v.type == Type::String) {
            continue;
        }
        const int components = num_components(v.type) * std::max(v.array_length, 1);
        for (std::uint32_t i = 0; i < n; ++i) {
            Value value = Value::zero(v.type, v.array_length);
            for (int k = 0; k < components; ++k) {
                const float x = OracleWorld::input(100 + p, k, static_cast<int>(i));
                value.x[static_cast<std::size_t>(k)] = x;
                batch.param_plane(static_cast<int>(p), k)[i] = x;
            }
            oracle.set_param(v.name, static_cast<int>(i), value);
        }
    }
}

// Differences at the auxiliary points: small, no two alike.
void Comparison::fill_differences(rt::ShadeBatch& batch, Interpreter& oracle, std::uint32_t n) {
    constexpr float scale = 0.03125F;
    for (std::size_t id = 0; id < variable_rows().size(); ++id) {
        const VariableRow& row = variable_rows()[id];
        if (((facts_.needed_aux | facts_.written_aux) >> id & 1U) == 0) {
            continue;
        }
        for (int aux = 1; aux <= 2; ++aux) {
            for (std::uint32_t i = 0; i < n; ++i) {
                Value value = Value::zero(row.type);
                for (int k = 0; k < num_components(row.type); ++k) {
                    const auto key = static_cast<std::size_t>(aux) * 40 + id;
                    const float x = scale * OracleWorld::input(key, k, static_cast<int>(i));
                    value.x[static_cast<std::size_t>(k)] = x;
                    (aux == 1 ? batch.aux_u(static_cast<sl_variable>(id), k)
                              : batch.aux_v(static_cast<sl_variable>(id), k))[i] = x;
                }
                oracle.set_aux(static_cast<int>(id), aux, static_cast<int>(i), value);
            }
        }
    }
}

std::string Comparison::compare_lit(const rt::ShadeBatch& batch, const Interpreter& oracle,
                                    std::uint32_t n) {
    for (std::uint32_t i = 0; i < n; ++i) {
        if (batch.lit(i) != oracle.lit(static_cast<int>(i))) {
            return "point " + std::to_string(i) + (batch.lit(i) ? " is" : " is not") + " lit";
        }
    }
    return "";
}

std::string Comparison::compare_variables(rt::ShadeBatch& batch, const Interpreter& oracle,
                                          std::uint32_t n) {
    for (std::size_t id = 0; id < variable_rows().size(); ++id) {
        const VariableRow& row = variable_rows()[id];
        if ((facts_.written >> id & 1U) == 0) {
            continue;
        }
        for (std::uint32_t i = 0; i < n; ++i) {
            if (id == SL_VAR_L && !oracle.lit(static_cast<int>(i)) && !batch.lit(i)) {
                continue; // a light that does not shine there has no direction
            }
            const Value& expected = oracle.global(static_cast<int>(id), static_cast<int>(i));
            for (int k = 0; k < num_components(row.type); ++k) {
                const float got = batch.plane(static_cast<sl_variable>(id), k)[i];
                if (!close(got, expected.at(static_cast<std::size_t>(k)))) {
                    return difference(std::string(row.name), i, k, got,
                                      expected.at(static_cast<std::size_t>(k)));
                }
            }
        }
    }
    return "";
}

std::string Comparison::compare_params(rt::ShadeBatch& batch, const Interpreter& oracle,
                                       std::uint32_t n) {
    for (std::size_t p = 0; p < program_.params.size(); ++p) {
        const Var& v = program_.vars[static_cast<std::size_t>(program_.params[p].var)];
        const int components = num_components(v.type) * std::max(v.array_length, 1);
        for (std::uint32_t i = 0; i < n && v.is_output; ++i) {
            const Value& expected = oracle.param(v.name, static_cast<int>(i));
            if (v.type == Type::String) {
                const sl_string* strings = batch.param_strings(static_cast<int>(p));
                const sl_string got =
                    strings ? strings[i] : *batch.param_uniform_string(static_cast<int>(p));
                if (expected.text() != got) {
                    return v.name + ": \"" + got + "\" instead of \"" + expected.text() + "\"";
                }
                continue;
            }
            for (int k = 0; k < components; ++k) {
                const float* plane = batch.param_plane(static_cast<int>(p), k);
                const float got = plane ? plane[i] : batch.param_uniform(static_cast<int>(p))[k];
                if (!close(got, expected.x[static_cast<std::size_t>(k)])) {
                    return difference(v.name, i, k, got, expected.x[static_cast<std::size_t>(k)]);
                }
            }
        }
    }
    return "";
}

} // namespace slc
