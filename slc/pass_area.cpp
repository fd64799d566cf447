// SPDX-License-Identifier: Apache-2.0
// Area operators: everything about the auxiliary points becomes explicit (docs/area_operators.md).
//   x = mul s k1                         x = mul s k1
//   y = call "Du" "f(f)" x          ->   x_u = mul s_u k1
//                                        y = div x_u du
// Only statements that an operator's argument depends on are rewritten (liveness.h, LiveMode::Aux);
// of the differences made here, pass_dead_code keeps what is read, so nothing is left of them after
// the last operator, and Du() costs no differences along v. Needs: pass_detail. Spoils:
// Var::detail.
#include "slc/compiler.h"
#include "slc/ir_util.h"
#include "slc/passes.h"
#include "slc/propagation.h"

#include <algorithm>
#include <utility>

namespace slc {

// What a displacement shader hands on to the surface.
std::uint64_t aux_results(const Program& program) {
    if (program.shader_type != SL_SHADER_displacement) {
        return 0;
    }
    constexpr std::uint64_t handed_on =
        1ull << SL_VAR_P | 1ull << SL_VAR_N | 1ull << SL_VAR_s | 1ull << SL_VAR_t;
    return written_globals(program, program.body) & handed_on;
}

bool pass_area(Program& program) {
    const std::uint64_t results = aux_results(program);
    if (results == 0 && area_operators(program.body).empty()) {
        return false;
    }
    const Liveness coarse(program, nullptr, results);
    const AuxAnalysis analysis(program, results, coarse);
    const Liveness slice(program, &analysis, results);
    Block body = Propagation(program, analysis, slice).run(results);
    program.body = std::move(body);
    return true;
}

Block Propagation::run(std::uint64_t results) {
    Block body;
    out_ = &body;
    prologue();
    block(program_.body);
    epilogue(results);
    return body;
}

// Differences of predefined variables and parameters that are assigned live in locals.
void Propagation::prologue() {
    for (std::size_t i = 0; i < current_.size(); ++i) {
        const auto id = static_cast<VarId>(i);
        const Var v = var(id);
        const bool is_input = v.kind == VarKind::Global || v.kind == VarKind::Param;
        if (!is_input || !written_.contains(id)) {
            continue;
        }
        for (int axis = 0; axis < 2; ++axis) {
            if (!analysis_.differs(id, axis)) {
                continue;
            }
            const VarId local = difference_of(id, axis);
            VarId given = no_var;
            if (v.kind == VarKind::Param) {
                given = fresh(v.name + (axis == 0 ? "_given_u" : "_given_v"), v, VarKind::Param);
                program_.vars[static_cast<std::size_t>(given)].index = v.index;
                program_.vars[static_cast<std::size_t>(given)].aux = axis + 1;
                program_.vars[static_cast<std::size_t>(given)].detail = Detail::Varying;
            } else if (axes_of_global(program_.shader_type, v.index) != NoAxis) {
                given = global(v.index, axis + 1);
            }
            emit(Op::Copy, local, {given == no_var ? zero(local) : given});
        }
    }
}

void Propagation::epilogue(std::uint64_t results) {
    for (int id = 0; id < SL_VAR_COUNT; ++id) {
        if ((results >> id & 1) == 0) {
            continue;
        }
        for (int axis = 0; axis < 2; ++axis) {
            const VarId d = difference(global(id, 0), axis);
            if (d != no_var) {
                emit(Op::Copy, global(id, axis + 1), {d});
            }
        }
    }
}

// After a statement that points may leave for good, the rest runs while one of them is still in
// what they would leave.
void Propagation::block(const Block& b) {
    Block* const outer = out_;
    for (std::size_t i = 0; i < b.size(); ++i) {
        loc_ = b[i].loc;
        if (!slice_.matters(b[i])) {
            main_only(b[i]);
            continue;
        }
        const std::size_t before = std::exchange(outermost_left_, nothing_left);
        statement(b[i]);
        const std::size_t left = outermost_left_;
        outermost_left_ = std::min(before, left);
        if (i + 1 < b.size() && left < regions_.size()) {
            Stmt& rest = emit(Op::If, no_var, {present(regions_[left])});
            rest.bodies.resize(2);
            out_ = &rest.bodies[0];
            guard_block_ = nullptr;
        }
    }
    out_ = outer;
    guard_block_ = nullptr;
}

Block Propagation::nested(const Block& b) {
    Block inner;
    Block* const outer = out_;
    out_ = &inner;
    guard_block_ = nullptr;
    block(b);
    out_ = outer;
    return inner;
}

// Statements no operator depends on. Neighbours in the text share one condition.
void Propagation::main_only(const Stmt& s) {
    const VarId here = main_here();
    Stmt m = mapped_deep(s);
    if (here == no_var) {
        out_->push_back(std::move(m));
        return;
    }
    if (guard_block_ != out_ || guard_at_ != out_->size()) {
        emit(Op::If, no_var, {here}).bodies.resize(2);
        guard_block_ = out_;
        guard_at_ = out_->size();
    }
    out_->back().bodies[0].push_back(std::move(m));
}

void Propagation::statement(const Stmt& s) {
    switch (s.op) {
    case Op::If:
        branch(s);
        break;
    case Op::Loop:
        loop(s);
        break;
    case Op::Scope:
        scope(s);
        break;
    case Op::Illuminance:
        light_loop(s);
        break;
    case Op::Illuminate:
    case Op::Solar:
        illuminate(s);
        break;
    case Op::Break:
    case Op::Continue:
    case Op::Leave:
        jump(s);
        break;
    case Op::Call:
        call(s);
        break;
    case Op::Store:
        store(s);
        break;
    default:
        assignment(s);
        break;
    }
}

void Propagation::assignment(const Stmt& s) {
    const bool is_comparison = s.op >= Op::Eq && s.op <= Op::Not;
    if (analysis_.differs(s.dst) == NoAxis) {
        out_->push_back(mapped(s));
        if (is_comparison && var(out_->back().dst).kind == VarKind::Temp) {
            conditions_.insert(out_->back().dst);
        }
        return;
    }
    if (is_comparison) {
        comparison(s);
        return;
    }
    std::vector<Dual> a;
    for (const VarId id : s.args) {
        const bool is_choice = s.op == Op::Select && &id == s.args.data();
        a.push_back(is_choice ? plain(current(id)) : read(id));
    }
    // A target that is also an operand is written last.
    Stmt m = mapped(s);
    const VarId target = m.dst;
    const bool aliased = std::find(m.args.begin(), m.args.end(), target) != m.args.end() &&
                         !(s.op == Op::Copy && var(target).array_length != 0);
    if (aliased) {
        m.dst = temp(var(target).type);
    }
    const VarId result = m.dst;
    out_->push_back(std::move(m));
    for (int axis = 0; axis < 2; ++axis) {
        if (analysis_.differs(s.dst, axis)) {
            set_difference(s.dst, axis, rule(s, a, result, axis));
        }
    }
    if (aliased) {
        emit(Op::Copy, target, {result});
    }
}

// A statement whose bodies all points enter together.
void Propagation::shell(const Stmt& s) {
    Stmt m = mapped(s);
    for (const Block& b : s.bodies) {
        m.bodies.push_back(nested(b));
    }
    loc_ = s.loc;
    out_->push_back(std::move(m));
}

void Propagation::branch(const Stmt& s) {
    if (analysis_.differs(s.args[0]) != NoAxis) {
        parted_branch(s);
    } else {
        shell(s);
    }
}

void Propagation::loop(const Stmt& s) {
    if (analysis_.splits(s) || analysis_.splits_iteration(s)) {
        parted_loop(s);
        return;
    }
    targets_.push_back({&s, -1, -1});
    Stmt m = mapped(s);
    for (const Block& b : s.bodies) {
        m.bodies.push_back(nested(b));
    }
    m.args[0] = current(s.args[0]);
    out_->push_back(std::move(m));
    targets_.pop_back();
}

void Propagation::scope(const Stmt& s) {
    if (analysis_.splits(s)) {
        parted_scope(s);
        return;
    }
    targets_.push_back({&s, -1, -1});
    shell(s);
    targets_.pop_back();
}

// Lights are those of the main point: L, Cl and Ol are the same for the others.
void Propagation::light_loop(const Stmt& s) {
    if (analysis_.splits(s) || analysis_.splits_iteration(s)) {
        parted_light_loop(s);
        return;
    }
    Stmt m = mapped(s);
    targets_.push_back({&s, -1, -1});
    for (const Block& b : s.bodies) {
        m.bodies.push_back(nested(b));
    }
    targets_.pop_back();
    loc_ = s.loc;
    emit_for_main(std::move(m));
}

// Where points have parted, for those whose main point is there.
void Propagation::emit_for_main(Stmt s) {
    const VarId here = main_here();
    if (here == no_var) {
        out_->push_back(std::move(s));
        return;
    }
    Stmt& guard = emit(Op::If, no_var, {here});
    guard.bodies.resize(2);
    guard.bodies[0].push_back(std::move(s));
}

// In the cone L is Ps - from or the axis; outside of it Cl becomes 0.
void Propagation::illuminate(const Stmt& s) {
    const bool has_cone = s.op == Op::Illuminate && s.args.size() > 1;
    const VarId L = globals_.contains(SL_VAR_L) ? global(SL_VAR_L, 0) : no_var;
    const VarId Cl = globals_.contains(SL_VAR_Cl) ? global(SL_VAR_Cl, 0) : no_var;
    Pair kept = {no_var, no_var};
    Block start;
    Block* const outer = out_;
    for (int axis = 0; axis < 2; ++axis) {
        const auto k = static_cast<std::size_t>(axis);
        const VarId Cl_d = Cl == no_var || !has_cone ? no_var : difference(Cl, axis);
        if (Cl_d != no_var) {
            kept[k] = copy_of(Cl_d);
            emit(Op::Copy, Cl_d, {zero(Cl_d)});
            out_ = &start;
            emit(Op::Copy, Cl_d, {kept[k]});
            out_ = outer;
        }
        const VarId L_d = L == no_var ? no_var : difference(L, axis);
        if (L_d == no_var) {
            continue;
        }
        const VarId from = s.args.empty() ? no_var : difference(s.args[0], axis);
        if (s.op == Op::Solar) {
            emit(Op::Copy, L_d, {from == no_var ? zero(L_d) : from});
        } else {
            const VarId to = difference_of(global(SL_VAR_Ps, 0), axis);
            emit(Op::Copy, L_d, {from == no_var ? to : minus(to, from)});
        }
    }
    Stmt m = mapped(s);
    out_ = &start;
    block(s.bodies[0]);
    out_ = outer;
    m.bodies.push_back(std::move(start));
    emit_for_main(std::move(m));
}

Propagation::Target* Propagation::find_target(const Stmt& s) {
    int levels = s.levels;
    for (auto t = targets_.rbegin(); t != targets_.rend(); ++t) {
        const bool counts = s.op == Op::Leave ? t->stmt->op == Op::Scope : is_loop(t->stmt->op);
        if (counts && --levels == 0) {
            return &*t;
        }
    }
    return nullptr;
}

// A jump all points take together stays what it is.
void Propagation::jump(const Stmt& s) {
    const Target* t = find_target(s);
    const int region = t == nullptr ? -1 : s.op == Op::Continue ? t->iteration : t->region;
    if (region < 0) {
        out_->push_back(mapped(s));
    } else {
        leave(static_cast<std::size_t>(region));
    }
}

} // namespace slc
