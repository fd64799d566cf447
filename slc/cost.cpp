// SPDX-License-Identifier: Apache-2.0
// Weights are rounded from the benchmark of the built-in functions (docs/benchmarks.md, rows
// "built-in ..."): a float operation takes about a tenth of a nanosecond per point on eight lanes.
#include "slc/cost.h"

#include "slc/ir_util.h"

#include <algorithm>

namespace slc {

namespace {

constexpr double trips_of_loop = 4;      // octaves, layers, steps
constexpr double lights_of_scene = 3;    // per loop over lights
constexpr double share_of_arm = 0.7;     // varying branches: some lane of eight is likely to come
constexpr double share_of_uniform = 0.1; // once per packet instead of once per lane

double cost_of_call(const BuiltinRow& row) {
    if (row.has(PropTraces)) {
        return 5000;
    }
    if (row.has(PropTextures)) {
        return 2000;
    }
    if (row.has(PropLights)) {
        return 300 * lights_of_scene;
    }
    if (row.has(PropSpaces) || row.has(PropMessage) || row.has(PropEffect)) {
        return 50;
    }
    const bool is_noise = row.name.find("noise") != std::string_view::npos;
    if (is_noise) {
        return 15.0 * static_cast<double>(row.args.size() + 1) * num_components(row.result.type);
    }
    return row.name == "spline" ? 60 : 10;
}

class Estimate {
public:
    explicit Estimate(const Program& program) : program_(program) {}
    [[nodiscard]] double block(const Block& b) const {
        double sum = 0;
        for (const Stmt& s : b) {
            sum += statement(s);
        }
        return sum;
    }

private:
    [[nodiscard]] double statement(const Stmt& s) const;
    [[nodiscard]] double operation(const Stmt& s) const;
    [[nodiscard]] const Var& var(VarId id) const {
        return program_.vars[static_cast<std::size_t>(id)];
    }
    const Program& program_;
};

double Estimate::operation(const Stmt& s) const {
    const bool is_uniform = s.dst != no_var && var(s.dst).detail == Detail::Uniform;
    const double size = s.dst == no_var ? 1 : num_components(var(s.dst).type);
    const double cost = s.op == Op::Call ? cost_of_call(builtin_of(s)) : size;
    return cost * (is_uniform ? share_of_uniform : 1);
}

double Estimate::statement(const Stmt& s) const {
    double inside = 0;
    for (const Block& b : s.bodies) {
        inside += block(b);
    }
    switch (s.op) {
    case Op::If:
        return 1 + inside * share_of_arm;
    case Op::Loop:
        return 1 + inside * trips_of_loop;
    case Op::Illuminance:
        return (300 + inside) * lights_of_scene;
    case Op::Gather:
        return 5000 + inside;
    default:
        return inside + operation(s);
    }
}

std::size_t count(const Block& b) {
    std::size_t n = b.size();
    for (const Stmt& s : b) {
        for (const Block& inner : s.bodies) {
            n += count(inner);
        }
    }
    return n;
}

} // namespace

double cost_of(const Program& program) {
    return Estimate(program).block(program.body);
}

std::size_t num_statements(const Program& program) {
    return count(program.body);
}

} // namespace slc
