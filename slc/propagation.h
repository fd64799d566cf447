// SPDX-License-Identifier: Apache-2.0
// Rewrites a program so that what happens at the auxiliary points is ordinary code: next to each
// variable x of a slice stand x_u and x_v, its differences at u + du and v + dv, and area operators
// become arithmetic on them. One Propagation serves one program; pass_area.cpp drives it.
//
// Invariant: code is written as if all three points were at the same place ("here"). Where points
// part, a Region gives the variables assigned there private copies, runs the code for everybody,
// and commits to the outer variables what belongs to the points that are really there.
#pragma once

#include "slc/aux_analysis.h"
#include "slc/ir.h"
#include "slc/liveness.h"

#include <array>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace slc {

using Three = std::array<VarId, 3>; // of the main point and the two auxiliary ones
using Pair = std::array<VarId, 2>;  // by axis; no_var: nothing, no difference

// A variable's value and its differences.
struct Dual {
    VarId value = no_var;
    Pair d = {no_var, no_var};
    [[nodiscard]] bool differs() const { return d[0] != no_var || d[1] != no_var; }
};

class Propagation {
public:
    Propagation(Program& program, const AuxAnalysis& analysis, const Liveness& slice);
    // The new body, the old one still in place. `results`: see AuxAnalysis.
    Block run(std::uint64_t results);

private:
    struct Private {
        VarId source; // the program's variable
        VarId outer;  // what stands for it outside
    };
    struct Region {
        // Conditions: the point came in and has not left; no_var: always. `real` also counts the
        // regions around it, `in` takes for granted that the point came to the region's start.
        Three in = {no_var, no_var, no_var};
        Three real = {no_var, no_var, no_var};
        std::vector<Private> vars;
        bool is_arm = false;    // a side of a condition
        bool wants_all = false; // auxiliary points run it even where the main point is not there
    };
    struct Target { // a construct that jumps may leave
        const Stmt* stmt;
        int region;    // index, or -1: points leave it together
        int iteration; // the same for the rest of an iteration
    };

    // --- variables and small code (propagation.cpp)
    [[nodiscard]] const Var& var(VarId id) const {
        return program_.vars[static_cast<std::size_t>(id)];
    }
    VarId new_var(const Var& v);
    VarId fresh(const std::string& name, const Var& like, VarKind kind);
    VarId temp(Type type, int array_length = 0);
    VarId constant(Type type, float value);
    VarId zero(VarId like) { return constant(var(like).type, 0); }
    VarId global(int variable, int aux);
    VarId current(VarId source) const { return current_[static_cast<std::size_t>(source)]; }
    VarId difference(VarId source, int axis);
    VarId difference_of(VarId now, int axis);
    Dual read(VarId source);
    [[nodiscard]] static Dual plain(VarId id) { return {id, {no_var, no_var}}; }
    Stmt& emit(Op op, VarId dst, std::vector<VarId> args);
    VarId value(Op op, Type type, std::vector<VarId> args) {
        const VarId t = temp(type);
        emit(op, t, std::move(args));
        return t;
    }
    VarId copy_of(VarId id);
    void assign(VarId to, VarId from); // from: a temporary just computed is computed in place
    void set_difference(VarId source, int axis, VarId value);
    void set_differences(VarId source, const Pair& d);
    VarId moved(const Dual& x, int axis); // x + d
    VarId minus(VarId a, VarId b);
    void for_elements(int length, VarId& index, Block& body);
    [[nodiscard]] Stmt mapped(const Stmt& s) const;
    [[nodiscard]] Stmt mapped_deep(const Stmt& s) const;
    VarId condition_of(VarId now);
    VarId condition_at(VarId source, int axis);
    Three conditions(VarId source);
    VarId both(VarId a, VarId b);
    VarId either(VarId a, VarId b);
    VarId negated(VarId a);

    // --- statements (pass_area.cpp)
    void prologue();
    void epilogue(std::uint64_t results);
    void block(const Block& b);
    Block nested(const Block& b);
    void statement(const Stmt& s);
    void main_only(const Stmt& s);
    void emit_for_main(Stmt s);
    void assignment(const Stmt& s);
    void shell(const Stmt& s);
    void branch(const Stmt& s);
    void loop(const Stmt& s);
    void light_loop(const Stmt& s);
    void illuminate(const Stmt& s);
    void scope(const Stmt& s);
    void jump(const Stmt& s);

    // --- places where points part (propagation_regions.cpp)
    void parted_branch(const Stmt& s);
    void parted_loop(const Stmt& s);
    void parted_light_loop(const Stmt& s);
    void parted_scope(const Stmt& s);
    Block iteration(const Stmt& s, const Block& b, bool parts);
    void privatise(const std::vector<VarId>& assigned);
    std::vector<VarId> private_candidates(const Block& b) const;
    std::vector<VarId> loop_candidates(const Stmt& s) const;
    VarId another_round(const Stmt& s);
    void collect_assigned(const Block& b, std::unordered_set<VarId>& seen,
                          std::vector<VarId>& out) const;
    Region& enter(const Three& in, bool fixed, bool wants_all);
    void withdraw(); // the innermost region's private variables
    void commit(const Region& from, const Three& who);
    void commit_value(VarId from, VarId to, const Three& who, bool differs_u, bool differs_v);
    void commit_array(VarId from, VarId to, const Three& who, VarId source);
    VarId committed(VarId from, VarId to, const Pair& d, const Three& who, int axis, VarId delta);
    void leave(std::size_t target);
    [[nodiscard]] VarId present(const Region& r);
    [[nodiscard]] VarId main_here() const {
        return regions_.empty() ? no_var : regions_.back().real[0];
    }
    Target* find_target(const Stmt& s);

    // --- differences of operations (propagation_rules.cpp)
    VarId rule(const Stmt& s, const std::vector<Dual>& a, VarId result, int axis);
    VarId sum_rule(const Stmt& s, const std::vector<Dual>& a, int axis);
    VarId product_rule(Op op, Type type, const Dual& a, const Dual& b, int axis);
    VarId quotient_rule(const Stmt& s, const std::vector<Dual>& a, VarId result, int axis);
    VarId guarded_quotient(VarId exact, VarId below, VarId below_there);
    VarId select_rule(const Stmt& s, const std::vector<Dual>& a, int axis);
    VarId compose_rule(const Stmt& s, const std::vector<Dual>& a, int axis);
    VarId element_rule(const Stmt& s, const std::vector<Dual>& a, VarId result, int axis);
    void comparison(const Stmt& s);
    void store(const Stmt& s);

    // --- built-ins and area operators (propagation_calls.cpp)
    void call(const Stmt& s);
    void call_for_main(const Stmt& s, Stmt now);
    void function(const Stmt& s);
    bool set_component(const Stmt& s);
    void chain(const Stmt& s);
    void with_outputs(const Stmt& s);
    int explicit_row(const Stmt& s, std::vector<Dual>& a);
    VarId call_rule(int number, Type type, const std::vector<Dual>& a, VarId result, int axis);
    VarId call_value(int row, Type type, std::vector<VarId> args);
    void area_operator(const Stmt& s);
    VarId derivative(const Stmt& s);
    VarId ratio(VarId a, VarId b, Type type);
    VarId area(const Stmt& s);
    VarId normal(const Stmt& s, Pair& d);
    VarId filter_step(const Stmt& s, Pair& d);
    Stmt with_footprint(const Stmt& s);
    VarId map(const Stmt& s, Pair& d);

    Program& program_;
    const AuxAnalysis& analysis_;
    const Liveness& slice_;
    Block* out_ = nullptr;
    Loc loc_;
    std::vector<VarId> current_;                       // by the program's variables
    std::unordered_map<VarId, Pair> differences_;      // by the variable that stands for it now
    std::unordered_map<VarId, Pair> moved_conditions_; // conditions held by temporaries
    std::unordered_set<VarId> conditions_;             // temporaries that are 0 or 1
    std::unordered_set<VarId> loose_; // temporaries of the rules, which nobody else refers to
    std::unordered_map<int, VarId> globals_; // by aux * SL_VAR_COUNT + variable
    std::unordered_map<std::string, VarId> constants_;
    std::unordered_set<std::string> names_;
    std::unordered_map<std::string, int> name_counts_;
    std::unordered_set<VarId> written_; // predefined variables and parameters that are assigned
    static constexpr std::size_t nothing_left = ~std::size_t(0);
    std::vector<Region> regions_;
    std::size_t outermost_left_ = nothing_left; // region that jumps of the statement in work leave
    std::vector<Target> targets_;
    const Block* guard_block_ = nullptr; // its last statement holds main-only statements ...
    std::size_t guard_at_ = 0;           // ... if it still has that size
};

} // namespace slc
