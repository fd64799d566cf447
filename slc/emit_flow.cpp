// SPDX-License-Identifier: Apache-2.0
#include "slc/emit_flow.h"

#include "slc/ir_util.h"

namespace slc {

namespace {

bool is_construct(const Stmt& s) {
    return is_loop(s.op) || s.op == Op::Scope;
}

// Lanes of the body are chosen by the lights, whatever the control flow around it.
bool is_light_statement(const Stmt& s) {
    return s.op == Op::Illuminance || s.op == Op::Illuminate || s.op == Op::Solar;
}

} // namespace

Flow::Flow(const Program& program, const Block& body, std::uint64_t results, bool all_uniform)
    : program_(program), body_(body), all_uniform_(all_uniform), places_(program.vars.size()),
      first_block_(program.vars.size()), first_sets_(program.vars.size()) {
    std::vector<const Stmt*> enclosing;
    index(body, nullptr, nullptr, enclosing);
    decide_masks();
    note_losses();
    place_block(body);
    settle_places(results);
}

void Flow::settle_places(std::uint64_t results) {
    for (std::size_t i = 0; i < places_.size(); ++i) {
        VarPlace& place = places_[i];
        const Var& var = program_.vars[i];
        if (!place.home) {
            continue;
        }
        const bool is_result = var.kind == VarKind::Param ||
                               (is_global(var) && (results >> var.index & 1U) != 0) ||
                               (var.kind == VarKind::Global && var.aux != 0);
        if (is_result) {
            place.home = &body_; // read after the body ends
        }
        place.set_first = first_block_[i] == place.home && first_sets_[i];
        if (!place.set_first) {
            place.home = &body_; // keeps its value between visits: declared, and zero, at the top
        }
    }
}

VarId Flow::global(sl_variable id) const {
    for (std::size_t i = 0; i < program_.vars.size(); ++i) {
        if (is_global(program_.vars[i], id)) {
            return static_cast<VarId>(i);
        }
    }
    return no_var;
}

bool Flow::is_varying(VarId v) const {
    return !all_uniform_ && program_.vars[static_cast<std::size_t>(v)].detail == Detail::Varying;
}

void Flow::index(const Block& b, const Block* parent, const Stmt* owner,
                 std::vector<const Stmt*>& enclosing) {
    blocks_[&b] = BlockInfo{parent, owner, true};
    for (const Stmt& s : b) {
        if (s.op == Op::Break || s.op == Op::Continue || s.op == Op::Leave) {
            note_exit(s, enclosing);
            exit_blocks_[&s] = &b;
        }
        if (is_construct(s)) {
            constructs_[&s] = {};
        }
        enclosing.push_back(&s);
        for (const Block& inner : s.bodies) {
            index(inner, &b, &s, enclosing);
        }
        enclosing.pop_back();
    }
}

void Flow::note_exit(const Stmt& s, const std::vector<const Stmt*>& enclosing) {
    int levels = s.levels;
    ExitInfo info;
    for (std::size_t i = enclosing.size(); i-- > 0 && !info.target;) {
        const bool counts =
            s.op == Op::Leave ? enclosing[i]->op == Op::Scope : is_loop(enclosing[i]->op);
        if (counts && --levels <= 0) {
            info.target = enclosing[i];
        }
    }
    exits_[&s] = info;
    exit_order_.push_back(&s);
}

void Flow::update_sharing() {
    for (auto& [b, info] : blocks_) {
        if (!info.owner) {
            continue;
        }
        const Stmt& s = *info.owner;
        info.shares_mask = true;
        if (s.op == Op::If) {
            info.shares_mask = !is_varying(s.args[0]);
        } else if (is_light_statement(s)) {
            info.shares_mask = false;
        } else if (is_construct(s)) {
            info.shares_mask = !constructs_[&s].masked;
        }
    }
}

// True if the decision changed something, so that others must be looked at again.
bool Flow::decide_exit(const Stmt& s, ExitInfo& info) {
    if (!info.target || info.masked) {
        return false;
    }
    bool together = true;
    for (const Block* b = exit_blocks_[&s]; blocks_[b].owner != info.target;
         b = blocks_[b].parent) {
        together = together && blocks_[b].shares_mask;
        const Stmt* owner = blocks_[b].owner;
        // Lanes that skipped the rest of a crossed loop's iteration are still in that loop.
        together = together && !(owner->op == Op::Loop && constructs_[owner].has_masked_continue);
    }
    const ConstructInfo& target = constructs_[info.target];
    if (s.op == Op::Break) {
        together = together && info.target->op == Op::Loop && !target.has_masked_continue;
    }
    if (together) {
        return false;
    }
    info.masked = true;
    for (const Block* b = exit_blocks_[&s];; b = blocks_[b].parent) {
        const Stmt* owner = blocks_[b].owner;
        if (is_construct(*owner)) {
            constructs_[owner].masked = true;
        }
        if (owner == info.target) {
            constructs_[owner].has_masked_continue |= s.op == Op::Continue;
            return true;
        }
    }
}

void Flow::decide_masks() {
    for (auto& [s, info] : constructs_) {
        info.masked = s->op == Op::Loop ? is_varying(s->args[0]) : is_light_statement(*s);
    }
    for (bool changed = true; changed;) {
        changed = false;
        update_sharing();
        for (const Stmt* s : exit_order_) {
            changed = decide_exit(*s, exits_[s]) || changed;
        }
    }
}

void Flow::note_losses() {
    for (const Stmt* s : exit_order_) {
        const ExitInfo& info = exits_[s];
        if (!info.masked) {
            continue;
        }
        for (const Block* b = exit_blocks_[s]; blocks_[b].owner != info.target;
             b = blocks_[b].parent) {
            losing_[blocks_[b].owner] = true;
        }
    }
}

bool Flow::must_blend(VarId v, const Block& b) const {
    const Block* home = place(v).home;
    for (const Block* at = &b; at != home && at; at = blocks_.at(at).parent) {
        if (!blocks_.at(at).shares_mask) {
            return true;
        }
    }
    return false;
}

const Block* Flow::common(const Block* a, const Block* b) const {
    std::unordered_map<const Block*, bool> above;
    for (; a; a = blocks_.at(a).parent) {
        above[a] = true;
    }
    while (b && above.count(b) == 0) {
        b = blocks_.at(b).parent;
    }
    return b;
}

void Flow::access(VarId v, const Block& b, bool sets_all) {
    const auto i = static_cast<std::size_t>(v);
    VarPlace& place = places_[i];
    if (!place.home) {
        place.home = &b;
        first_block_[i] = &b;
        first_sets_[i] = sets_all;
    } else if (place.home != &b) {
        place.home = common(place.home, &b);
    }
}

void Flow::read(VarId v, const Block& b) {
    if (v == no_var) {
        return;
    }
    access(v, b, false);
    places_[static_cast<std::size_t>(v)].is_read = true;
    ++places_[static_cast<std::size_t>(v)].num_reads;
}

void Flow::write(VarId v, const Block& b, bool sets_all) {
    if (v == no_var) {
        return;
    }
    access(v, b, sets_all);
    places_[static_cast<std::size_t>(v)].is_written = true;
    ++places_[static_cast<std::size_t>(v)].num_writes;
}

void Flow::place_block(const Block& b) {
    for (const Stmt& s : b) {
        place_statement(s, b);
    }
}

void Flow::place_statement(const Stmt& s, const Block& b) {
    if (s.op == Op::Loop) {
        // The condition is computed in the first body and read there.
        place_block(s.bodies[0]);
        read(s.args[0], s.bodies[0]);
        place_block(s.bodies[1]);
        place_block(s.bodies[2]);
        return;
    }
    for_each_read(s, [&](VarId v) { read(v, b); });
    for_each_write(s, [&](VarId v, bool whole) {
        // Options are set inside the loop, element stores leave the rest of the array.
        const bool here = s.op != Op::Illuminance;
        write(v, b, whole && here);
    });
    if (s.op == Op::Illuminance) {
        for (const sl_variable id : {SL_VAR_L, SL_VAR_Cl, SL_VAR_Ol}) {
            write(global(id), s.bodies[0], true);
        }
    } else if (s.op == Op::Illuminate || s.op == Op::Solar) {
        write(global(SL_VAR_L), b, true);
    }
    for (const Block& inner : s.bodies) {
        place_block(inner);
    }
    if (s.op == Op::Illuminate || s.op == Op::Solar) {
        read(global(SL_VAR_Cl), b); // lanes outside the cone get no light
        write(global(SL_VAR_Cl), b, false);
    }
}

} // namespace slc
