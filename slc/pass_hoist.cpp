// SPDX-License-Identifier: Apache-2.0
// Loop invariants: pure operations of which nothing changes in a loop are computed once before it.
//   loop t3 {                         t1 = call "normalize" "g(g)" N
//     t1 = call "normalize" ... N     loop t3 {
//     t2 = dot t1 L             ->      t2 = dot t1 L
// Only results that are temporaries assigned in this place; only operations every round executes
// (the condition and the statements of the body itself, up to the first exit): what stands in a
// branch may never be wanted. Pure operations have no effect and no error, so that a loop that runs
// for no point costs time only.
// Needs: nothing. Provides: nothing. Spoils: nothing.
#include "slc/ir_util.h"
#include "slc/passes.h"

#include <algorithm>

namespace slc {

namespace {

class Hoister {
public:
    explicit Hoister(Program& program)
        : program_(program), num_writes_(program.vars.size()), changing_(program.vars.size()) {
        count_writes(program.body);
    }
    bool run() {
        block(program_.body);
        return changed_;
    }

private:
    void count_writes(const Block& b);
    void block(Block& b);
    void mark_changing(const Stmt& s, int step);
    void take(Block& from, Block& out);
    [[nodiscard]] bool may_move(const Stmt& s) const;

    Program& program_;
    std::vector<int> num_writes_; // statements that assign, by variable
    std::vector<int> changing_;   // loops in work that assign it
    bool changed_ = false;
};

void Hoister::count_writes(const Block& b) {
    for (const Stmt& s : b) {
        for_each_write(s, [&](VarId id, bool) { ++num_writes_[static_cast<std::size_t>(id)]; });
        for (const Block& inner : s.bodies) {
            count_writes(inner);
        }
    }
}

void Hoister::mark_changing(const Stmt& s, int step) {
    for_each_write(s, [&](VarId id, bool) { changing_[static_cast<std::size_t>(id)] += step; });
    for (const Block& b : s.bodies) {
        for (const Stmt& inner : b) {
            mark_changing(inner, step);
        }
    }
}

bool Hoister::may_move(const Stmt& s) const {
    const bool is_call = s.op == Op::Call || s.op == Op::Difference;
    const bool is_pure = is_call ? builtin_of(s).has(PropPure) : s.op < Op::Call;
    if (!is_pure || s.dst == no_var || s.op == Op::Store || s.op == Op::Copy) {
        return false;
    }
    const auto i = static_cast<std::size_t>(s.dst);
    if (program_.vars[i].kind != VarKind::Temp || num_writes_[i] != 1) {
        return false;
    }
    bool has_outputs = false;
    for_each_write(s, [&](VarId id, bool) { has_outputs = has_outputs || id != s.dst; });
    return !has_outputs && std::none_of(s.args.begin(), s.args.end(), [&](VarId id) {
        return changing_[static_cast<std::size_t>(id)] > 0;
    });
}

// In order, so that what depends on a moved operation can follow it.
void Hoister::take(Block& from, Block& out) {
    Block rest;
    bool is_certain = true;
    for (Stmt& s : from) {
        if (is_certain && may_move(s)) {
            changing_[static_cast<std::size_t>(s.dst)] = 0;
            out.push_back(std::move(s));
            changed_ = true;
            continue;
        }
        is_certain = is_certain && s.bodies.empty() && s.op < Op::If;
        rest.push_back(std::move(s));
    }
    from = std::move(rest);
}

void Hoister::block(Block& b) {
    Block out;
    out.reserve(b.size());
    for (Stmt& s : b) {
        for (Block& inner : s.bodies) {
            block(inner);
        }
        if (s.op == Op::Loop) {
            mark_changing(s, 1);
            Stmt moving = std::move(s);
            take(moving.bodies[0], out);
            take(moving.bodies[1], out);
            mark_changing(moving, -1);
            out.push_back(std::move(moving));
        } else {
            out.push_back(std::move(s));
        }
    }
    b = std::move(out);
}

} // namespace

bool pass_hoist(Program& program) {
    return Hoister(program).run();
}

} // namespace slc
