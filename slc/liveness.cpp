// SPDX-License-Identifier: Apache-2.0
#include "slc/liveness.h"

#include "slc/aux_analysis.h"
#include "slc/ir_util.h"

#include <algorithm>

namespace slc {

bool VarSet::merge(const VarSet& other) {
    bool grew = false;
    for (std::size_t i = 0; i < words_.size(); ++i) {
        const std::uint64_t sum = words_[i] | other.words_[i];
        grew = grew || sum != words_[i];
        words_[i] = sum;
    }
    return grew;
}

std::uint64_t VarSet::globals(int aux) const {
    std::uint64_t mask = 0;
    for (int i = 0; i < SL_VAR_COUNT; ++i) {
        mask |= contains(global_slot(i, aux)) ? 1ull << i : 0;
    }
    return mask;
}

Liveness::Liveness(const Program& program, LiveMode mode, const AuxAnalysis* aux,
                   std::uint64_t results, const Stmt* only)
    : program_(program), mode_(mode), aux_(aux), results_(results), only_(only), entry_(program),
      elsewhere_(program) {
    if (mode != LiveMode::Packets) {
        solve();
    }
}

Liveness::Across Liveness::across(const Program& program,
                                  const std::unordered_set<const Stmt*>& wait) {
    Liveness liveness(program, LiveMode::Packets, nullptr, 0, nullptr);
    liveness.wait_ = &wait;
    liveness.solve();
    return std::move(liveness.across_);
}

void Liveness::solve() {
    do {
        changed_ = false;
        VarSet live(program_);
        exit_set(live);
        block(program_.body, live);
        // Defaults are evaluated before anything else, in order; all of them matter.
        entry_ = std::move(live);
    } while (changed_);
}

namespace {

bool assigns(const Block& b, VarId wanted) {
    return std::any_of(b.begin(), b.end(), [&](const Stmt& s) {
        bool found = false;
        for_each_write(s, [&](VarId id, bool) { found = found || id == wanted; });
        return found || std::any_of(s.bodies.begin(), s.bodies.end(),
                                    [&](const Block& inner) { return assigns(inner, wanted); });
    });
}

std::uint64_t results_of(sl_shader_type type) {
    const auto bits = [](std::initializer_list<int> ids) {
        std::uint64_t mask = 0;
        for (const int id : ids) {
            mask |= 1ull << id;
        }
        return mask;
    };
    switch (type) {
    case SL_SHADER_surface:
    case SL_SHADER_volume:
        return bits({SL_VAR_Ci, SL_VAR_Oi});
    case SL_SHADER_displacement:
        return bits({SL_VAR_P, SL_VAR_N, SL_VAR_s, SL_VAR_t});
    case SL_SHADER_transformation:
        return bits({SL_VAR_P, SL_VAR_N});
    case SL_SHADER_light:
        return bits({SL_VAR_L, SL_VAR_Cl, SL_VAR_Ol});
    case SL_SHADER_imager:
        return bits({SL_VAR_Ci, SL_VAR_Oi, SL_VAR_alpha});
    }
    return 0;
}

} // namespace

std::uint64_t written_globals(const Program& program, const Block& b) {
    std::uint64_t mask = 0;
    for (const Stmt& s : b) {
        for_each_write(s, [&](VarId id, bool) {
            const Var& v = program.vars[static_cast<std::size_t>(id)];
            mask |= is_global(v) ? 1ull << v.index : 0;
        });
        if (s.op == Op::Illuminate || s.op == Op::Solar) {
            mask |= 1ull << SL_VAR_L | 1ull << SL_VAR_Cl;
        }
        for (const Block& inner : s.bodies) {
            mask |= written_globals(program, inner);
        }
    }
    return mask;
}

std::vector<VarId> written_differences(const Program& program) {
    std::vector<VarId> ids;
    for (std::size_t i = 0; i < program.vars.size(); ++i) {
        const Var& v = program.vars[i];
        const bool is_result = v.kind == VarKind::Global && v.aux != 0 &&
                               program.shader_type == SL_SHADER_displacement;
        if (is_result && assigns(program.body, static_cast<VarId>(i))) {
            ids.push_back(static_cast<VarId>(i));
        }
    }
    return ids;
}

// What the engine reads when the shader has ended: the results of its type that it writes (the
// others keep what the engine has), and output parameters.
void Liveness::exit_set(VarSet& live) const {
    // The end of a packet stores all it has changed.
    const std::uint64_t all = mode_ == LiveMode::Packets ? ~0ull : results_of(program_.shader_type);
    const std::uint64_t results =
        mode_ == LiveMode::Aux ? results_ : all & written_globals(program_, program_.body);
    for (int i = 0; i < SL_VAR_COUNT; ++i) {
        if ((results >> i & 1) != 0) {
            live.insert(live.global_slot(i));
        }
    }
    if (mode_ == LiveMode::Aux) {
        return;
    }
    for (const VarId id : written_differences(program_)) {
        live.insert(live.slot(program_, id));
    }
    for (const Param& p : program_.params) {
        if (program_.vars[static_cast<std::size_t>(p.var)].is_output ||
            mode_ == LiveMode::Packets) {
            live.insert(live.slot(program_, p.var));
        }
    }
}

void Liveness::keep(const Stmt& s) {
    if (kept_.insert(&s).second) {
        changed_ = true; // enclosing statements and jumps may have been judged without it
    }
}

bool Liveness::any_kept(const Stmt& s) const {
    return mode_ == LiveMode::Packets ||
           std::any_of(s.bodies.begin(), s.bodies.end(), [&](const Block& b) {
               return std::any_of(b.begin(), b.end(),
                                  [&](const Stmt& inner) { return kept_.contains(&inner); });
           });
}

VarSet& Liveness::head(const Stmt& s) {
    return heads_.try_emplace(&s, program_).first->second;
}

void Liveness::read(VarId id, VarSet& live) const {
    if (program_.vars[static_cast<std::size_t>(id)].kind != VarKind::Const) {
        live.insert(live.slot(program_, id));
    }
}

void Liveness::add_reads(const Stmt& s, VarSet& live) const {
    for_each_read(s, [&](VarId id) { read(id, live); });
    if (shows_outputs(s)) {
        for (const Param& p : program_.params) {
            if (program_.vars[static_cast<std::size_t>(p.var)].is_output) {
                read(p.var, live);
            }
        }
    }
    if (s.op != Op::Call) {
        return;
    }
    const std::uint64_t reads = builtin_of(s).reads;
    for (int i = 0; i < SL_VAR_COUNT; ++i) {
        const bool exists = (variable_rows()[static_cast<std::size_t>(i)].readable &
                             shader_type_bit(program_.shader_type)) != 0;
        if ((reads >> i & 1) != 0 && exists) {
            live.insert(live.global_slot(i));
        }
    }
}

// An area operator takes differences of its arguments; texture(name) those of s and t.
void Liveness::add_area_reads(const Stmt& s, VarSet& live) const {
    for_each_read(s, [&](VarId id) {
        const bool may_differ =
            aux_ != nullptr ? aux_->differs(id) != NoAxis
                            : program_.vars[static_cast<std::size_t>(id)].detail == Detail::Varying;
        if (may_differ) {
            read(id, live);
        }
    });
    for (const int id : {SL_VAR_s, SL_VAR_t}) {
        if ((builtin_of(s).reads >> id & 1) != 0) {
            live.insert(live.global_slot(id));
        }
    }
}

// Prints or stores something outside the shader.
bool Liveness::has_effect(const Stmt& s) const {
    if (s.op != Op::Call || mode_ == LiveMode::Aux) {
        return false;
    }
    const BuiltinRow& row = builtin_of(s);
    return row.has(PropEffect) && !row.has(PropRandom) &&
           std::none_of(row.args.begin(), row.args.end(),
                        [](const ArgSpec& a) { return a.is_output; });
}

void Liveness::block(const Block& b, VarSet& live) {
    for (auto s = b.rbegin(); s != b.rend(); ++s) {
        statement(*s, live);
    }
}

void Liveness::note_across(const Stmt& s, const VarSet& live) {
    VarSet kept = live;
    for_each_write(s, [&](VarId id, bool whole) {
        if (whole) {
            kept.erase(kept.slot(program_, id));
        }
    });
    kept.merge(elsewhere_);
    across_.insert_or_assign(&s, std::move(kept));
}

void Liveness::block_beside(const Block& b, VarSet& inside, const VarSet& live) {
    if (mode_ != LiveMode::Packets) {
        block(b, inside);
        return;
    }
    const VarSet outer = elsewhere_;
    elsewhere_.merge(live);
    block(b, inside);
    elsewhere_ = outer;
}

void Liveness::statement(const Stmt& s, VarSet& live) {
    if (mode_ == LiveMode::Packets) {
        keep(s);
        if (wait_->contains(&s)) {
            note_across(s, live);
        }
    }
    switch (s.op) {
    case Op::If:
        branch(s, live);
        break;
    case Op::Loop:
        loop(s, live);
        break;
    case Op::Scope:
        scope(s, live);
        break;
    case Op::Illuminance:
        light_loop(s, live);
        break;
    case Op::Illuminate:
    case Op::Solar:
        illuminate(s, live);
        break;
    case Op::Break:
    case Op::Continue:
    case Op::Leave:
        jump(s, live);
        break;
    default:
        simple(s, live);
        break;
    }
}

void Liveness::simple(const Stmt& s, VarSet& live) {
    const bool is_area = mode_ == LiveMode::Aux && s.op == Op::Call && builtin_of(s).has(PropArea);
    bool is_read = has_effect(s) || mode_ == LiveMode::Packets;
    for_each_write(
        s, [&](VarId id, bool) { is_read = is_read || live.contains(live.slot(program_, id)); });
    if (is_area && is_read) {
        read_operators_.insert(&s);
    }
    if (!is_read && (!is_area || (only_ != nullptr && only_ != &s))) {
        return;
    }
    keep(s);
    for_each_write(s, [&](VarId id, bool whole) {
        if (whole) {
            live.erase(live.slot(program_, id));
        }
    });
    // At the auxiliary points light and rays give zero, whatever their arguments.
    const bool is_same = mode_ == LiveMode::Aux && s.op == Op::Call &&
                         (aux_rule(s) == AuxRule::MainOnly || builtin_of(s).has(PropTraces));
    if (is_area) {
        add_area_reads(s, live);
    }
    if (is_read && !is_same) {
        add_reads(s, live);
    }
}

std::size_t Liveness::find_target(const Stmt& s) const {
    const bool wants_loop = s.op != Op::Leave;
    int levels = s.levels;
    for (std::size_t i = targets_.size(); i-- > 0;) {
        if (targets_[i].is_loop == wants_loop && --levels == 0) {
            return i;
        }
    }
    return targets_.size();
}

// A jump matters if what it leaves does.
void Liveness::jump(const Stmt& s, VarSet& live) {
    const std::size_t i = find_target(s);
    if (i == targets_.size() || !kept_.contains(targets_[i].construct)) {
        return;
    }
    keep(s);
    live = s.op == Op::Continue ? targets_[i].after_continue : targets_[i].after_break;
}

void Liveness::branch(const Stmt& s, VarSet& live) {
    const VarSet after = live;
    VarSet otherwise = live;
    const Var& condition = program_.vars[static_cast<std::size_t>(s.args[0])];
    if (condition.detail == Detail::Varying) { // the second arm runs after the first
        block_beside(s.bodies[1], otherwise, after);
        VarSet beside = after;
        beside.merge(otherwise);
        block_beside(s.bodies[0], live, beside);
    } else {
        block(s.bodies[0], live);
        block(s.bodies[1], otherwise);
    }
    live.merge(otherwise);
    if (any_kept(s)) {
        keep(s);
        note_handed_on(s, after);
        add_reads(s, live);
    }
}

// For slices: what points that do not come along need to know.
void Liveness::note_handed_on(const Stmt& s, const VarSet& after) {
    if (mode_ != LiveMode::Aux) {
        return;
    }
    std::unordered_set<VarId> found;
    for (const Block& b : s.bodies) {
        assigned_live(b, after, found);
    }
    if (!found.empty()) {
        handed_on_[&s].merge(found);
    }
}

void Liveness::assigned_live(const Block& b, const VarSet& after,
                             std::unordered_set<VarId>& found) const {
    for (const Stmt& s : b) {
        for_each_write(s, [&](VarId id, bool) {
            if (after.contains(after.slot(program_, id))) {
                found.insert(id);
            }
        });
        for (const Block& inner : s.bodies) {
            assigned_live(inner, after, found);
        }
    }
}

void Liveness::scope(const Stmt& s, VarSet& live) {
    targets_.push_back({&s, live, {}, false});
    const VarSet after = live;
    block_beside(s.bodies[0], live, after);
    targets_.pop_back();
    if (any_kept(s)) {
        keep(s);
        note_handed_on(s, after);
    }
}

// test (bodies[0]) -> out, or body (bodies[1]) -> step (bodies[2]) -> test
void Liveness::loop(const Stmt& s, VarSet& live) {
    const VarSet after = live;
    VarSet at_step = head(s);
    targets_.push_back({&s, after, {}, true});
    block_beside(s.bodies[2], at_step, after);
    targets_.back().after_continue = at_step;
    VarSet at_body = at_step;
    VarSet beside = after;
    beside.merge(at_step);
    block_beside(s.bodies[1], at_body, beside);
    live.merge(at_body);
    if (mode_ == LiveMode::Aux) {
        assigned_live(s.bodies[1], targets_.back().after_continue, next_round_[&s]);
    }
    if (any_kept(s)) {
        keep(s);
        note_handed_on(s, after);
        add_reads(s, live);
    }
    block_beside(s.bodies[0], live, after);
    targets_.pop_back();
    changed_ = head(s).merge(live) || changed_;
}

// The body runs for each light that reaches the point, with L, Cl and Ol set anew.
void Liveness::light_loop(const Stmt& s, VarSet& live) {
    const VarSet after = live;
    VarSet next = head(s); // at the start of the body, without what the statement sets
    next.merge(after);
    if (mode_ == LiveMode::Packets) { // sent to each light
        for (const auto& [name, id] : s.options) {
            read(id, next);
        }
    }
    for (const Block& b : s.bodies) {
        VarSet at_body = next;
        targets_.push_back({&s, after, next, true});
        block_beside(b, at_body, next);
        targets_.pop_back();
        if (mode_ == LiveMode::Aux) {
            assigned_live(b, next, next_round_[&s]);
        }
        if (s.op == Op::Illuminance) {
            for (const int id : {SL_VAR_L, SL_VAR_Cl, SL_VAR_Ol}) {
                at_body.erase(at_body.global_slot(id));
            }
        }
        live.merge(at_body);
    }
    changed_ = head(s).merge(live) || changed_;
    bool wanted = any_kept(s);
    for_each_write(
        s, [&](VarId id, bool) { wanted = wanted || live.contains(live.slot(program_, id)); });
    if (wanted) {
        keep(s);
        note_handed_on(s, after);
        add_reads(s, live);
    }
}

// In its cone the statement sets L and runs the body; elsewhere Cl becomes 0 (sl.md 5.4).
void Liveness::illuminate(const Stmt& s, VarSet& live) {
    const bool has_cone = s.op == Op::Illuminate && s.args.size() > 1;
    VarSet outside = live;
    outside.erase(outside.global_slot(SL_VAR_Cl));
    block(s.bodies[0], live);
    live.erase(live.global_slot(SL_VAR_L));
    if (has_cone) {
        live.merge(outside);
    }
    if (mode_ == LiveMode::Results || any_kept(s)) {
        keep(s);
        add_reads(s, live);
        if (s.op == Op::Illuminate) { // L = Ps - from
            live.insert(live.global_slot(SL_VAR_Ps));
        } else if (s.args.empty()) { // L = -normalize(Ns)
            live.insert(live.global_slot(SL_VAR_Ns));
        }
    }
}

} // namespace slc
