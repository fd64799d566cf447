// SPDX-License-Identifier: Apache-2.0
// Dead code: statements whose results are never read.
//   t1 = call "noise" "f(g)" P        (gone)
//   x = copy k1                       (gone, x is overwritten)
//   x = copy k2                  ->   x = copy k2
//   Ci = copy x                       Ci = copy x
// Needs: nothing. Provides: exact needed variables for analyse(). Spoils: nothing.
#include "slc/ir_util.h"
#include "slc/liveness.h"
#include "slc/passes.h"

#include <algorithm>

namespace slc {

namespace {

// Judged by address, so the decision for a whole block falls before anything in it moves.
bool sweep(Block& b, const Liveness& liveness) {
    bool changed = false;
    std::vector<bool> keep(b.size());
    for (std::size_t i = 0; i < b.size(); ++i) {
        keep[i] = liveness.matters(b[i]);
        for (Block& inner : b[i].bodies) {
            changed = (keep[i] && sweep(inner, liveness)) || changed;
        }
    }
    std::size_t next = 0;
    const std::size_t before = b.size();
    for (std::size_t i = 0; i < before; ++i) {
        if (keep[i]) {
            if (next != i) {
                b[next] = std::move(b[i]);
            }
            ++next;
        }
    }
    b.resize(next);
    return changed || next != before;
}

void mark(const Block& b, std::vector<bool>& used) {
    for (const Stmt& s : b) {
        const auto use = [&](VarId id) { used[static_cast<std::size_t>(id)] = true; };
        for (const VarId id : s.args) {
            use(id);
        }
        if (s.dst != no_var) {
            use(s.dst);
        }
        if (s.category != no_var) {
            use(s.category);
        }
        for (const auto& [name, id] : s.options) {
            use(id);
        }
        for (const Block& inner : s.bodies) {
            mark(inner, used);
        }
    }
}

} // namespace

bool pass_dead_code(Program& program) {
    const Liveness liveness(program);
    return sweep(program.body, liveness);
}

void pass_compact(Program& program) {
    std::vector<bool> used(program.vars.size(), false);
    for (const Param& p : program.params) {
        used[static_cast<std::size_t>(p.var)] = true;
        mark(p.init, used);
    }
    mark(program.body, used);
    std::vector<VarId> to(program.vars.size(), no_var);
    std::vector<Var> vars;
    for (std::size_t i = 0; i < used.size(); ++i) {
        if (used[i]) {
            to[i] = static_cast<VarId>(vars.size());
            vars.push_back(std::move(program.vars[i]));
        }
    }
    program.vars = std::move(vars);
    for (Param& p : program.params) {
        p.var = to[static_cast<std::size_t>(p.var)];
        renumber(p.init, to);
    }
    renumber(program.body, to);
}

} // namespace slc
