// SPDX-License-Identifier: Apache-2.0
// Where the three points part: predicates, private copies, commits (see propagation.h).
//   if c { x = add x s }    ->   if (c or c_u or c_v) {
//                                  p = x; p_u = x_u           the copy
//                                  p = p + s; p_u = p_u + s_u  as if all were here
//                                  x, x_u = p, p_u where c, c_u say so
//                                }
// A point that leaves a loop or returns commits to what lies outside of it and clears its
// predicates; the others go on, and take it along "as if it had come here".
#include "slc/ir_util.h"
#include "slc/propagation.h"

#include <algorithm>

namespace slc {

namespace {

constexpr Three always = {no_var, no_var, no_var};

} // namespace

// Variables that statements of the slice assign; arrays and output arguments included.
void Propagation::collect_assigned(const Block& b, std::unordered_set<VarId>& seen,
                                   std::vector<VarId>& out) const {
    for (const Stmt& s : b) {
        if (!slice_.matters(s)) {
            continue;
        }
        const auto add = [&](VarId id) {
            if (seen.insert(id).second) {
                out.push_back(id);
            }
        };
        for_each_write(s, [&](VarId id, bool) { add(id); });
        for (const Block& inner : s.bodies) {
            collect_assigned(inner, seen, out);
        }
    }
}

// The innermost region's copies of variables that are also used outside of it.
void Propagation::privatise(const std::vector<VarId>& assigned) {
    for (const VarId source : assigned) {
        const VarId outer = current(source);
        const VarId own = fresh(var(outer).name + "_here", var(outer), VarKind::Local);
        emit(Op::Copy, own, {outer});
        for (int axis = 0; axis < 2; ++axis) {
            const VarId d = difference(source, axis);
            if (d != no_var) {
                emit(Op::Copy, difference_of(own, axis), {d});
            }
        }
        regions_.back().vars.push_back({source, outer});
        current_[static_cast<std::size_t>(source)] = own;
    }
}

void Propagation::withdraw() {
    for (const Private& p : regions_.back().vars) {
        current_[static_cast<std::size_t>(p.source)] = p.outer;
    }
    regions_.pop_back();
}

// A region points enter under `in`. If nobody leaves it early (`fixed`) the conditions are
// constant.
Propagation::Region& Propagation::enter(const Three& in, bool fixed, bool wants_all) {
    Region r;
    r.wants_all = wants_all;
    const Three outer = regions_.empty() ? always : regions_.back().real;
    const auto variable = [&](VarId id, const char* name) {
        const VarId v = fresh(name, Var{}, VarKind::Local);
        emit(Op::Copy, v, {id == no_var ? constant(Type::Float, 1) : id});
        return v;
    };
    static constexpr const char* names[] = {"in", "in_u", "in_v"};
    static constexpr const char* real_names[] = {"here", "here_u", "here_v"};
    for (std::size_t k = 0; k < 3; ++k) {
        const VarId real = both(outer[k], in[k]);
        r.in[k] = fixed ? in[k] : variable(in[k], names[k]);
        r.real[k] = fixed ? real : variable(real, real_names[k]);
    }
    regions_.push_back(std::move(r));
    return regions_.back();
}

// Whether the region still has somebody to run for.
VarId Propagation::present(const Region& r) {
    if (!r.wants_all) {
        return r.real[0];
    }
    return either(r.real[0], either(r.real[1], r.real[2]));
}

// --- commits

// What the outer difference becomes: the chosen values at the auxiliary point minus the chosen main
// value. Exact where both points take the same side.
VarId Propagation::committed(VarId from, VarId to, const Pair& d, const Three& who, int axis,
                             VarId delta) {
    const Type type = var(to).type;
    const VarId zero_d = constant(type, 0);
    const VarId inside = d[0] == no_var ? zero_d : d[0], outside = d[1] == no_var ? zero_d : d[1];
    const VarId main = who[0], there = who[static_cast<std::size_t>(axis) + 1];
    (void)from;
    if (main == there) {
        return value(Op::Select, type, {main, inside, outside});
    }
    const VarId moved_in = value(Op::Add, type, {inside, delta});
    const VarId moved_out = value(Op::Sub, type, {outside, delta});
    return value(Op::Select, type,
                 {there, value(Op::Select, type, {main, inside, moved_in}),
                  value(Op::Select, type, {main, moved_out, outside})});
}

void Propagation::commit_value(VarId from, VarId to, const Three& who, bool differs_u,
                               bool differs_v) {
    const Type type = var(to).type;
    const bool differs[] = {differs_u, differs_v};
    VarId delta = no_var;
    if (differs_u || differs_v) {
        delta = minus(from, to);
    }
    for (int axis = 0; axis < 2; ++axis) {
        if (differs[axis]) {
            const VarId d = difference_of(to, axis);
            assign(d, committed(from, to, {difference_of(from, axis), d}, who, axis, delta));
        }
    }
    emit(Op::Copy, to, {value(Op::Select, type, {who[0], from, to})});
}

// Element by element.
void Propagation::commit_array(VarId from, VarId to, const Three& who, VarId source) {
    const Var v = var(to);
    VarId index = fresh("k", Var{}, VarKind::Local);
    Block body;
    Block* const outer = out_;
    out_ = &body;
    const auto load = [&](VarId array) {
        const VarId t = temp(v.type);
        emit(Op::Load, t, {array, index});
        return t;
    };
    const VarId inside = load(from), outside = load(to);
    const bool numeric = v.type != Type::String;
    const VarId delta = numeric ? minus(inside, outside) : no_var;
    for (int axis = 0; axis < 2; ++axis) {
        if (numeric && analysis_.differs(source, axis)) {
            const VarId to_d = difference_of(to, axis);
            const Pair d = {load(difference_of(from, axis)), load(to_d)};
            emit(Op::Store, to_d, {index, committed(inside, outside, d, who, axis, delta)});
        }
    }
    emit(Op::Store, to, {index, value(Op::Select, v.type, {who[0], inside, outside})});
    out_ = outer;
    for_elements(v.array_length, index, body);
}

// The points `who` leave the region `from`: its variables' values become those outside.
void Propagation::commit(const Region& from, const Three& who) {
    for (const Private& p : from.vars) {
        const VarId now = current(p.source);
        if (now == p.outer) {
            continue;
        }
        if (var(now).array_length != 0) {
            commit_array(now, p.outer, who, p.source);
        } else {
            commit_value(now, p.outer, who, analysis_.differs(p.source, 0),
                         analysis_.differs(p.source, 1));
        }
    }
}

// The points that are in all regions from `target` on inwards leave it. For the code that follows
// they are taken along as if they had not, and had not taken the side of the condition that the
// jump stands on.
void Propagation::leave(std::size_t target) {
    outermost_left_ = std::min(outermost_left_, target);
    Three who = always;
    for (std::size_t r = target; r < regions_.size(); ++r) {
        for (std::size_t k = 0; k < 3; ++k) {
            who[k] = both(who[k], regions_[r].in[k]);
        }
    }
    for (VarId& w : who) { // the predicates are about to change
        w = w == no_var ? constant(Type::Float, 1) : condition_of(copy_of(w));
    }
    const Region left = regions_[target]; // by value: code below may add variables
    commit(left, who);
    for (std::size_t r = target; r < regions_.size(); ++r) {
        for (std::size_t k = 0; k < 3; ++k) {
            const Region& at = regions_[r];
            const VarId stays = negated(who[k]);
            if (r == target || (at.is_arm && r + 1 == regions_.size())) {
                emit(Op::And, at.in[k], {at.in[k], stays});
            }
            emit(Op::And, at.real[k], {at.real[k], stays});
        }
    }
}

// --- constructs

namespace {

bool loses(const AuxAnalysis& analysis, const Block& b) {
    return std::any_of(b.begin(), b.end(), [&](const Stmt& s) { return analysis.loses_points(s); });
}

} // namespace

std::vector<VarId> Propagation::private_candidates(const Block& b) const {
    std::unordered_set<VarId> seen;
    std::vector<VarId> assigned;
    collect_assigned(b, seen, assigned);
    std::erase_if(assigned, [&](VarId id) { return !analysis_.used_outside(id, b); });
    return assigned;
}

// The second side still sees what was before the first: the first one's commit comes last.
void Propagation::parted_branch(const Stmt& s) {
    const Three yes = conditions(s.args[0]);
    Three no = yes;
    for (std::size_t k = 0; k < 3; ++k) {
        no[k] = k > 0 && yes[k] == yes[0] ? no[0] : negated(yes[k]);
    }
    const Three* const taken[] = {&yes, &no};
    const bool wants_all = slice_.hands_on(s);
    std::vector<Stmt> late;
    for (std::size_t i = 0; i < 2; ++i) {
        const Block& b = s.bodies[i];
        if (b.empty()) {
            continue;
        }
        const bool lossy = loses(analysis_, b);
        const std::vector<VarId> assigned = private_candidates(b);
        enter(*taken[i], !lossy, (wants_all && !assigned.empty()) || lossy).is_arm = true;
        const VarId run = present(regions_.back());
        Block inner;
        Block* const outer = out_;
        out_ = &inner;
        guard_block_ = nullptr;
        privatise(assigned);
        block(b);
        loc_ = s.loc;
        Block commits;
        out_ = i == 0 && !s.bodies[1].empty() ? &commits : &inner;
        const Region r = regions_.back();
        commit(r, r.in);
        out_ = outer;
        guard_block_ = nullptr;
        withdraw();
        Stmt& arm = emit(Op::If, no_var, {run});
        arm.bodies.resize(2);
        arm.bodies[0] = std::move(inner);
        late.insert(late.end(), std::make_move_iterator(commits.begin()),
                    std::make_move_iterator(commits.end()));
    }
    out_->insert(out_->end(), std::make_move_iterator(late.begin()),
                 std::make_move_iterator(late.end()));
}

// One round of a loop's body, which points may skip the rest of.
Block Propagation::iteration(const Stmt& s, const Block& b, bool parts) {
    Block inner;
    Block* const outer = out_;
    out_ = &inner;
    guard_block_ = nullptr;
    if (!parts) {
        block(b);
    } else {
        enter(always, false, true);
        targets_.back().iteration = static_cast<int>(regions_.size()) - 1;
        privatise(private_candidates(b));
        block(b);
        loc_ = s.loc;
        const Region r = regions_.back();
        commit(r, r.in);
        withdraw();
        targets_.back().iteration = -1;
    }
    out_ = outer;
    guard_block_ = nullptr;
    return inner;
}

// Runs while a point that is really here wants another round.
void Propagation::parted_loop(const Stmt& s) {
    const bool region = analysis_.splits(s);
    targets_.push_back({&s, -1, -1});
    if (region) {
        enter(always, false, slice_.hands_on(s));
        targets_.back().region = static_cast<int>(regions_.size()) - 1;
        privatise(loop_candidates(s));
    }
    Stmt m = mapped(s);
    m.bodies.resize(3);
    Block* const outer = out_;
    out_ = &m.bodies[0];
    guard_block_ = nullptr;
    block(s.bodies[0]);
    loc_ = s.loc;
    m.args[0] = region ? another_round(s) : current(s.args[0]);
    out_ = outer;
    m.bodies[1] = iteration(s, s.bodies[1], analysis_.splits_iteration(s));
    m.bodies[2] = nested(s.bodies[2]);
    loc_ = s.loc;
    out_->push_back(std::move(m));
    if (region) {
        const Region r = regions_.back();
        commit(r, r.in); // points that were taken along
        withdraw();
    }
    targets_.pop_back();
}

// Points whose condition has become false leave; the condition of the whole loop.
VarId Propagation::another_round(const Stmt& s) {
    const Three c = conditions(s.args[0]);
    const Region r = regions_.back();
    Three gone = always;
    for (std::size_t k = 0; k < 3; ++k) {
        gone[k] = both(r.in[k], negated(c[k]));
    }
    commit(r, gone);
    for (std::size_t k = 0; k < 3; ++k) {
        emit(Op::And, r.in[k], {r.in[k], c[k]});
        emit(Op::And, r.real[k], {r.real[k], c[k]});
    }
    return present(r);
}

std::vector<VarId> Propagation::loop_candidates(const Stmt& s) const {
    std::unordered_set<VarId> seen;
    std::vector<VarId> assigned;
    for (const Block& b : s.bodies) {
        collect_assigned(b, seen, assigned);
    }
    std::erase_if(assigned, [&](VarId id) { return !analysis_.used_outside(id, s); });
    return assigned;
}

// The lights of the main point, for the points that have not left.
void Propagation::parted_light_loop(const Stmt& s) {
    const bool region = analysis_.splits(s);
    targets_.push_back({&s, -1, -1});
    if (region) {
        enter(always, false, false);
        targets_.back().region = static_cast<int>(regions_.size()) - 1;
        privatise(loop_candidates(s));
    }
    Stmt m = mapped(s);
    for (const Block& b : s.bodies) {
        Block body = iteration(s, b, analysis_.splits_iteration(s));
        if (region) {
            Stmt guard;
            guard.op = Op::If;
            guard.args = {regions_.back().real[0]};
            guard.loc = s.loc;
            guard.bodies.resize(2);
            guard.bodies[0] = std::move(body);
            body.clear();
            body.push_back(std::move(guard));
        }
        m.bodies.push_back(std::move(body));
    }
    loc_ = s.loc;
    emit_for_main(std::move(m));
    if (region) {
        const Region r = regions_.back();
        commit(r, r.in);
        withdraw();
    }
    targets_.pop_back();
}

void Propagation::parted_scope(const Stmt& s) {
    enter(always, false, slice_.hands_on(s) || (!regions_.empty() && regions_.back().wants_all));
    targets_.push_back({&s, static_cast<int>(regions_.size()) - 1, -1});
    privatise(loop_candidates(s));
    block(s.bodies[0]);
    loc_ = s.loc;
    const Region r = regions_.back();
    commit(r, r.in);
    withdraw();
    targets_.pop_back();
}

} // namespace slc
