// SPDX-License-Identifier: Apache-2.0
// What differs between a shading point and its auxiliary points u + du and v + dv, found before
// differences are propagated (pass_area). In: a program with uniform and varying decided. Out: per
// variable the axes along which it may differ, whatever the place; per construct whether the points
// may part in it. "May" is safe: what is not marked is equal at all three points. Method: paper of
// REFERENCES.md [Gritz96] turned into data flow.
#pragma once

#include "slc/ir.h"

#include <cstdint>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace slc {

class Liveness;

// Sets of auxiliary points.
using Axes = unsigned;
constexpr Axes NoAxis = 0, AxisU = 1, AxisV = 2, BothAxes = 3;

// What becomes of a built-in at the auxiliary points.
enum class AuxRule : std::uint8_t {
    Function, // a value of its arguments: f(a + d) - f(a)
    Operator, // an area operator; rays: their footprint, the results are the same at all points
    MainOnly  // runs for the main point only; its results are the same at all points
};
[[nodiscard]] AuxRule aux_rule(const Stmt& call);
// The axes an area operator takes differences along.
[[nodiscard]] Axes axes_of_operator(std::string_view name);
// Predefined variables that the engine gives differences for, in shaders of that type.
[[nodiscard]] Axes axes_of_global(sl_shader_type type, int variable);
// Area operators of a block, in the order of the text.
[[nodiscard]] std::vector<const Stmt*> area_operators(const Block& b);

class AuxAnalysis {
public:
    // `results`: predefined variables whose differences are results (bits; displacement).
    // `slice`: a coarse slice, for what constructs hand on.
    AuxAnalysis(const Program& program, std::uint64_t results, const Liveness& slice);

    // Predefined variables that the program did not mention count too, once it has them.
    [[nodiscard]] Axes differs(VarId id) const;
    [[nodiscard]] bool differs(VarId id, int axis) const { return (differs(id) >> axis & 1) != 0; }
    // Loop, Scope, Illuminance: some points may leave before others.
    [[nodiscard]] bool splits(const Stmt& s) const { return splits_.contains(&s); }
    // ... may skip the rest of an iteration.
    [[nodiscard]] bool splits_iteration(const Stmt& s) const { return iterations_.contains(&s); }
    // Holds (or is) a jump that only some points take, to something outside of the statement.
    [[nodiscard]] bool loses_points(const Stmt& s) const { return losing_.contains(&s); }
    // Read or written outside of the statement or block; predefined variables and parameters are.
    [[nodiscard]] bool used_outside(VarId id, const Stmt& s) const;
    [[nodiscard]] bool used_outside(VarId id, const Block& b) const;
    // Axes somebody takes differences along.
    [[nodiscard]] Axes axes() const { return axes_; }

private:
    struct Interval {
        int first, last;
    };
    struct Step { // from a block into one of a statement's
        const Stmt* stmt;
        const Block* block;
        std::size_t body;
    };
    void number(const Block& b);
    void note_use(VarId id);
    void seed(std::uint64_t results);
    void block(const Block& b);
    void statement(const Stmt& s);
    void jump(const Stmt& s);
    void mark_losing(const Stmt& s);
    void raise(VarId id, unsigned axes);
    void raise_assigned(VarId id, unsigned axes);
    [[nodiscard]] unsigned value_axes(const Stmt& s) const;
    [[nodiscard]] unsigned call_axes(const Stmt& s) const;
    [[nodiscard]] unsigned operator_axes(const Stmt& s) const;
    [[nodiscard]] unsigned global_axes(int variable) const;
    [[nodiscard]] static bool is_body(const Step& step);
    [[nodiscard]] static bool is_target(const Step& step, const Stmt& jump);
    bool grow(std::unordered_map<const Stmt*, unsigned>& set, const Stmt* s, unsigned axes) const;
    [[nodiscard]] static unsigned of(const std::unordered_map<const Stmt*, unsigned>& set,
                                     const Stmt* s);
    [[nodiscard]] bool outside(VarId id, Interval where) const;
    [[nodiscard]] const Var& var(VarId id) const {
        return program_.vars[static_cast<std::size_t>(id)];
    }

    const Program& program_;
    const Liveness& slice_;
    Axes axes_ = NoAxis;
    std::vector<std::uint8_t> differs_; // by variable
    std::vector<Interval> uses_;        // by variable: statement numbers
    std::unordered_map<const Stmt*, Interval> statements_;
    std::unordered_map<const Block*, Interval> blocks_;
    std::unordered_map<const Stmt*, unsigned> splits_, iterations_; // axes
    std::unordered_set<const Stmt*> losing_;
    std::vector<Step> steps_;
    int next_ = 0;
    bool changed_ = false;
};

} // namespace slc
