// SPDX-License-Identifier: Apache-2.0
#include "slc/loop_bounds.h"

#include "slc/ir_util.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace slc {

namespace {

// Rounds of a loop that is not counted: few, because they multiply those of the loops around.
constexpr double max_rounds = 64;

std::optional<double> constant(const Program& program, VarId v) {
    const Var& var = program.vars[static_cast<std::size_t>(v)];
    const bool is_number =
        var.kind == VarKind::Const && var.type == Type::Float && var.values.size() == 1;
    return is_number ? std::optional<double>(var.values[0]) : std::nullopt;
}

bool writes(const Block& b, VarId v) {
    return std::any_of(b.begin(), b.end(), [v](const Stmt& s) {
        bool found = false;
        for_each_write(s, [&](VarId w, bool) { found = found || w == v; });
        return found || std::any_of(s.bodies.begin(), s.bodies.end(),
                                    [v](const Block& inner) { return writes(inner, v); });
    });
}

bool holds_loop(const Block& b) {
    return std::any_of(b.begin(), b.end(), [](const Stmt& s) {
        return is_loop(s.op) || std::any_of(s.bodies.begin(), s.bodies.end(), holds_loop);
    });
}

// The constant a variable holds when control reaches statement number `at` of the block.
std::optional<double> value_before(const Program& program, const Block& b, std::size_t at,
                                   VarId v) {
    while (at-- > 0) {
        if (b[at].op == Op::Copy && b[at].dst == v) {
            return constant(program, b[at].args[0]);
        }
        const Block one(b.begin() + static_cast<std::ptrdiff_t>(at),
                        b.begin() + static_cast<std::ptrdiff_t>(at) + 1);
        if (writes(one, v)) {
            break;
        }
    }
    return std::nullopt;
}

// for (i = a; i < b; i += c) over constants, i changed nowhere else, no loop inside.
bool ends_soon(const Program& program, const Block& around, std::size_t at) {
    const Stmt& s = around[at];
    const Block& test = s.bodies[0];
    const Block& step = s.bodies[2];
    if (test.size() != 1 || step.size() != 1 || test[0].dst != s.args[0] ||
        test[0].args.size() != 2 || holds_loop(s.bodies[1])) {
        return false;
    }
    const VarId i = test[0].args[0];
    const bool steps_i = (step[0].op == Op::Add || step[0].op == Op::Sub) && step[0].dst == i &&
                         step[0].args[0] == i;
    if (!steps_i || writes(s.bodies[1], i)) {
        return false;
    }
    const auto first = value_before(program, around, at, i);
    const auto last = constant(program, test[0].args[1]);
    const auto by = constant(program, step[0].args[1]);
    if (!first || !last || !by) {
        return false;
    }
    const double stride = step[0].op == Op::Add ? *by : -*by;
    const bool upwards = test[0].op == Op::Lt || test[0].op == Op::Le;
    const bool downwards = test[0].op == Op::Gt || test[0].op == Op::Ge;
    const double rounds = (*last - *first) / stride;
    return ((upwards && stride > 0) || (downwards && stride < 0)) && rounds < max_rounds &&
           std::abs(stride) > 1e-3 * std::max(std::abs(*first), std::abs(*last)) / max_rounds;
}

} // namespace

CountedLoops::CountedLoops(const Program& program, const Block& body) {
    note(program, body);
}

bool CountedLoops::note(const Program& program, const Block& b) {
    bool any = false;
    for (std::size_t at = 0; at < b.size(); ++at) {
        const Stmt& s = b[at];
        bool inside = s.op == Op::Loop && !ends_soon(program, b, at);
        if (inside) {
            loops_.insert(&s);
        }
        for (const Block& inner : s.bodies) {
            inside = note(program, inner) || inside;
        }
        if (inside) {
            holders_.insert(&s);
        }
        any = any || inside;
    }
    return any;
}

} // namespace slc
