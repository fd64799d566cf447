// SPDX-License-Identifier: Apache-2.0
// Common subexpressions: an operation whose result some variable still holds becomes a copy of it.
//   t1 = call "noise" "f(g)" P        t1 = call "noise" "f(g)" P
//   t2 = mul t1 k1                    t2 = mul t1 k1
//   t3 = call "noise" "f(g)" P   ->   t3 = copy t1
//   t4 = mul t3 k1                    t4 = copy t2
// By value numbers: what a variable holds has a number, equal numbers are equal values in all lanes
// that get there. Values found in a body are forgotten behind it, what a body assigns is new around
// it. The C compiler does this for arithmetic, but not for calls; and less text compiles sooner.
// Needs: pass_detail (a uniform result is not replaced by a varying one). Provides: nothing.
// Spoils: nothing.
#include "slc/ir_util.h"
#include "slc/passes.h"

#include <unordered_map>
#include <unordered_set>

namespace slc {

namespace {

using Number = int;
constexpr Number none = 0;

// What an operation computes: opcode, class of the result, row of a call, numbers of the operands.
using Key = std::vector<int>;

struct KeyHash {
    std::size_t operator()(const Key& key) const {
        std::size_t h = 0;
        for (const int x : key) {
            h = (h ^ static_cast<std::size_t>(x)) * 0x9e3779b97f4a7c15ULL;
            h ^= h >> 29;
        }
        return h;
    }
};

struct Known {
    Number number = none;
    VarId holder = no_var;
};

class ValueNumbering {
public:
    explicit ValueNumbering(Program& program) : program_(program), written_(program) {}
    bool run();

private:
    using Vars = std::unordered_set<VarId>;
    // What to take back at the end of a body.
    struct Mark {
        std::size_t numbers, keys;
    };
    void block(Block& b);
    void body(Block& b, const Vars& renewed);
    void statement(Stmt& s);
    void nested(Stmt& s);
    void loop(Stmt& s);
    void value(Stmt& s);
    [[nodiscard]] bool is_value(const Stmt& s) const;
    [[nodiscard]] Key key_of(const Stmt& s) const;
    void set_number(VarId id, Number n);
    void renew(const Vars& vars);
    [[nodiscard]] Mark mark() const { return {old_numbers_.size(), old_known_.size()}; }
    void take_back(const Mark& mark);
    [[nodiscard]] Number number(VarId id) const { return numbers_[static_cast<std::size_t>(id)]; }
    [[nodiscard]] const Var& var(VarId id) const {
        return program_.vars[static_cast<std::size_t>(id)];
    }

    Program& program_;
    Number last_ = none;
    WrittenVars written_;
    std::vector<Number> numbers_; // by variable
    std::unordered_map<Key, Known, KeyHash> known_;
    std::vector<std::pair<VarId, Number>> old_numbers_;
    std::vector<std::pair<Known*, Known>> old_known_;
    bool changed_ = false;
};

bool ValueNumbering::run() {
    for (std::size_t i = 0; i < program_.vars.size(); ++i) {
        numbers_.push_back(++last_);
    }
    block(program_.body);
    return changed_;
}

void ValueNumbering::set_number(VarId id, Number n) {
    Number& now = numbers_[static_cast<std::size_t>(id)];
    old_numbers_.emplace_back(id, now);
    now = n;
}

void ValueNumbering::renew(const Vars& vars) {
    for (const VarId id : vars) {
        set_number(id, ++last_);
    }
}

void ValueNumbering::take_back(const Mark& mark) {
    for (; old_numbers_.size() > mark.numbers; old_numbers_.pop_back()) {
        const auto& [id, number] = old_numbers_.back();
        numbers_[static_cast<std::size_t>(id)] = number;
    }
    for (; old_known_.size() > mark.keys; old_known_.pop_back()) {
        *old_known_.back().first = old_known_.back().second; // one without a holder is unknown
    }
}

void ValueNumbering::block(Block& b) {
    for (Stmt& s : b) {
        statement(s);
    }
}

// One that starts with what holds before it, but for `renewed`, and leaves nothing behind.
void ValueNumbering::body(Block& b, const Vars& renewed) {
    const Mark before = mark();
    renew(renewed);
    block(b);
    take_back(before);
}

void ValueNumbering::statement(Stmt& s) {
    if (s.op == Op::Loop) {
        loop(s);
    } else if (!s.bodies.empty()) {
        nested(s);
    } else if (is_value(s)) {
        value(s);
    } else {
        Vars gone;
        written_.add(s, gone);
        renew(gone);
    }
}

bool ValueNumbering::is_value(const Stmt& s) const {
    if (s.dst == no_var || s.op == Op::Store || s.op > Op::Difference ||
        var(s.dst).array_length != 0) {
        return false;
    }
    if (s.op < Op::Call) {
        return true;
    }
    const BuiltinRow& row = builtin_of(s);
    bool has_outputs = false;
    for (const ArgSpec& arg : row.args) {
        has_outputs = has_outputs || arg.is_output;
    }
    // Names of spaces mean the same from the beginning of an execution to its end.
    const bool is_stable = row.has(PropPure) || (row.has(PropSpaces) && !row.has(PropEffect));
    return is_stable && !has_outputs;
}

Key ValueNumbering::key_of(const Stmt& s) const {
    const Type type = var(s.dst).type;
    Key key = {static_cast<int>(s.op), static_cast<int>(is_triple(type) ? Type::Color : type),
               s.builtin};
    for (const VarId id : s.args) {
        key.push_back(number(id));
    }
    return key;
}

void ValueNumbering::value(Stmt& s) {
    if (s.op == Op::Copy && same_class(var(s.dst).type, var(s.args[0]).type)) {
        set_number(s.dst, number(s.args[0]));
        return;
    }
    Known& known = known_[key_of(s)];
    if (known.holder == no_var || number(known.holder) != known.number) { // new, or overwritten
        old_known_.emplace_back(&known, known);
        known = {known.holder == no_var ? ++last_ : known.number, s.dst};
    } else if (var(known.holder).detail == Detail::Uniform ||
               var(s.dst).detail == Detail::Varying) {
        s.op = Op::Copy;
        s.builtin = -1;
        s.args = {known.holder};
        changed_ = true;
    }
    set_number(s.dst, known.number);
}

// Bodies that run at most once or per light.
void ValueNumbering::nested(Stmt& s) {
    Vars inside;
    written_.add(s, inside);
    if (is_loop(s.op)) {
        renew(inside);
    }
    Vars light; // L is set before the body
    if (s.op == Op::Illuminate || s.op == Op::Solar) {
        written_.add_lights(light);
    }
    for (Block& b : s.bodies) {
        body(b, light);
    }
    renew(inside);
}

void ValueNumbering::loop(Stmt& s) {
    Vars inside, in_body;
    written_.add(s, inside);
    for (const Stmt& t : s.bodies[1]) {
        written_.add(t, in_body);
    }
    renew(inside);
    const Mark before = mark();
    block(s.bodies[0]);
    body(s.bodies[1], {}); // whoever runs the body has computed the condition
    body(s.bodies[2], in_body);
    take_back(before);
    renew(inside);
}

} // namespace

bool pass_cse(Program& program) {
    return ValueNumbering(program).run();
}

} // namespace slc
