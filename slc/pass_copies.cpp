// SPDX-License-Identifier: Apache-2.0
// Copies: a variable that still equals the one it was copied from is replaced by it; the copy then
// dies.
//   x = copy k1                   x = copy k1
//   t1 = mul x Cs            ->   t1 = mul k1 Cs
// Forward over the tree; what a body assigns is forgotten around it, so that no path is misjudged.
// Needs: nothing. Provides: nothing. Spoils: nothing.
#include "slc/ir_util.h"
#include "slc/passes.h"

#include <unordered_map>
#include <unordered_set>

namespace slc {

namespace {

class CopyPropagation {
public:
    explicit CopyPropagation(Program& program) : program_(program), written_(program) {}
    bool run();

private:
    using Copies = std::unordered_map<VarId, VarId>;
    using Vars = std::unordered_set<VarId>;
    void block(Block& b, Copies& copies);
    void statement(Stmt& s, Copies& copies);
    void nested(Stmt& s, Copies& copies);
    void loop(Stmt& s, Copies& copies);
    void replace_reads(Stmt& s, const Copies& copies, const Vars& kept);
    void replace(VarId& id, const Copies& copies, const Vars& kept);
    void note(const Stmt& s, Copies& copies) const;
    static void forget(const Vars& written, Copies& copies);
    [[nodiscard]] const Var& var(VarId id) const {
        return program_.vars[static_cast<std::size_t>(id)];
    }

    Program& program_;
    WrittenVars written_;
    bool changed_ = false;
};

bool CopyPropagation::run() {
    for (Param& p : program_.params) {
        Copies copies;
        block(p.init, copies);
    }
    Copies copies;
    block(program_.body, copies);
    return changed_;
}

void CopyPropagation::block(Block& b, Copies& copies) {
    for (Stmt& s : b) {
        statement(s, copies);
    }
}

void CopyPropagation::statement(Stmt& s, Copies& copies) {
    if (s.op == Op::Loop) {
        loop(s, copies);
    } else if (!s.bodies.empty()) {
        nested(s, copies);
    } else {
        replace_reads(s, copies, {});
        Vars gone;
        written_.add(s, gone);
        forget(gone, copies);
        note(s, copies);
    }
}

// Bodies that run at most once or per light; each starts with what holds before.
void CopyPropagation::nested(Stmt& s, Copies& copies) {
    Vars inside;
    written_.add(s, inside);
    replace_reads(s, copies, inside);
    if (is_loop(s.op)) {
        forget(inside, copies);
    }
    const Copies before = copies;
    for (Block& b : s.bodies) {
        Copies local = before;
        if (s.op == Op::Illuminate || s.op == Op::Solar) { // L is set before the body
            Vars light;
            written_.add_lights(light);
            forget(light, local);
        }
        block(b, local);
    }
    forget(inside, copies);
}

void CopyPropagation::loop(Stmt& s, Copies& copies) {
    Vars inside;
    written_.add(s, inside);
    forget(inside, copies);
    Copies test = copies;
    block(s.bodies[0], test);
    replace(s.args[0], test, {});
    for (std::size_t i = 1; i < s.bodies.size(); ++i) {
        Copies local = copies;
        block(s.bodies[i], local);
    }
}

void CopyPropagation::replace(VarId& id, const Copies& copies, const Vars& kept) {
    const auto it = copies.find(id);
    if (it != copies.end() && !kept.contains(it->second)) {
        id = it->second;
        changed_ = true;
    }
}

// Arguments that the statement may change stay what they are.
void CopyPropagation::replace_reads(Stmt& s, const Copies& copies, const Vars& kept) {
    std::vector<bool> is_output(s.args.size(), false);
    if (s.op == Op::Call) {
        const BuiltinRow& row = builtin_of(s);
        for (std::size_t i = 0; i < row.args.size(); ++i) {
            is_output[arg_position(row, i)] = row.args[i].is_output;
        }
    }
    for (std::size_t i = 0; i < s.args.size(); ++i) {
        if (!is_output[i]) {
            replace(s.args[i], copies, kept);
        }
    }
    if (s.category != no_var) {
        replace(s.category, copies, kept);
    }
}

void CopyPropagation::note(const Stmt& s, Copies& copies) const {
    if (s.op != Op::Copy || s.dst == s.args[0]) {
        return;
    }
    const Var& to = var(s.dst);
    const Var& from = var(s.args[0]);
    if (to.array_length == 0 && from.array_length == 0 && same_class(to.type, from.type)) {
        copies[s.dst] = s.args[0];
    }
}

void CopyPropagation::forget(const Vars& written, Copies& copies) {
    if (written.empty() || copies.empty()) {
        return;
    }
    std::erase_if(copies, [&](const auto& c) {
        return written.contains(c.first) || written.contains(c.second);
    });
}

} // namespace

bool pass_copies(Program& program) {
    return CopyPropagation(program).run();
}

} // namespace slc
