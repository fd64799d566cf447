// SPDX-License-Identifier: Apache-2.0
// Folding: operations and pure built-ins on constants, conditions that are known, code after a
// jump, scopes nothing leaves.
//   t1 = call "radians" "f(f)" k30       t1 = copy k31
//   if k0 { A } { B }               ->   B
//   t1 = call "pow" "f(f,f)" x k2        t1 = mul x x
// Values come from the interpreter, so there is one definition of each operation here.
// Needs: nothing. Provides: nothing. Spoils: nothing.
#include "slc/interp.h"
#include "slc/ir_util.h"
#include "slc/passes.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <unordered_map>

namespace slc {

namespace {

class Folder {
public:
    Folder(Program& program, Folding folding);
    bool run();

private:
    void block(Block& b);
    bool replaced(Stmt& s, Block& out);
    void fold_value(Stmt& s);
    void simplify(Stmt& s);
    void simplify_power(Stmt& s);
    bool evaluate(const Stmt& s, Value& result) const;
    VarId constant(const Var& like, const Value& value);
    [[nodiscard]] bool has_exact_result(const Stmt& s, const Value& result) const;
    [[nodiscard]] bool is_const(VarId id) const { return var(id).kind == VarKind::Const; }
    [[nodiscard]] bool is_number(VarId id, float x) const {
        return is_const(id) && var(id).type == Type::Float && var(id).array_length == 0 &&
               var(id).values[0] == x;
    }
    [[nodiscard]] const Var& var(VarId id) const {
        return program_.vars[static_cast<std::size_t>(id)];
    }
    static std::string key(const Var& v);

    Program& program_;
    Folding folding_;
    std::unordered_map<std::string, VarId> constants_;
    int next_name_ = 0;
    bool changed_ = false;
};

std::string Folder::key(const Var& v) {
    std::string k = std::to_string(static_cast<int>(v.type)) + ":" + v.text;
    for (const float x : v.values) {
        k += "," + std::to_string(std::bit_cast<std::uint32_t>(x));
    }
    return k;
}

Folder::Folder(Program& program, Folding folding) : program_(program), folding_(folding) {
    for (std::size_t i = 0; i < program.vars.size(); ++i) {
        const Var& v = program.vars[i];
        if (v.kind == VarKind::Const && v.array_length == 0) {
            constants_.emplace(key(v), static_cast<VarId>(i));
        }
        if (v.kind == VarKind::Const && v.name.starts_with("folded")) {
            ++next_name_;
        }
    }
}

bool Folder::run() {
    for (Param& p : program_.params) {
        block(p.init);
    }
    block(program_.body);
    return changed_;
}

void Folder::block(Block& b) {
    Block out;
    out.reserve(b.size());
    for (Stmt& s : b) {
        for (Block& inner : s.bodies) {
            block(inner);
        }
        fold_value(s);
        simplify(s);
        simplify_power(s);
        if (replaced(s, out)) {
            changed_ = true;
        } else {
            out.push_back(std::move(s));
        }
        const bool jumps =
            !out.empty() && (out.back().op == Op::Break || out.back().op == Op::Continue ||
                             out.back().op == Op::Leave);
        if (jumps) { // nothing after it can be reached
            changed_ = changed_ || &s != &b.back();
            break;
        }
    }
    b = std::move(out);
}

// Leaves that end the scope `depth` levels up; also those that end one further out, whose count
// would change.
bool leaves(const Block& b, int depth) {
    return std::any_of(b.begin(), b.end(), [&](const Stmt& s) {
        if (s.op == Op::Leave && s.levels >= depth) {
            return true;
        }
        const int inner = depth + (s.op == Op::Scope ? 1 : 0);
        return std::any_of(s.bodies.begin(), s.bodies.end(),
                           [&](const Block& x) { return leaves(x, inner); });
    });
}

// Puts what remains of a statement with a known fate into `out`.
bool Folder::replaced(Stmt& s, Block& out) {
    const auto splice = [&](Block& inner) {
        out.insert(out.end(), std::make_move_iterator(inner.begin()),
                   std::make_move_iterator(inner.end()));
    };
    if (s.op == Op::If && is_const(s.args[0])) {
        splice(s.bodies[var(s.args[0]).values[0] != 0 ? 0 : 1]);
        return true;
    }
    if (s.op == Op::If && s.bodies[0].empty() && s.bodies[1].empty()) {
        return true;
    }
    if (s.op == Op::Loop && is_number(s.args[0], 0)) {
        splice(s.bodies[0]);
        return true;
    }
    if (s.op == Op::Scope && !leaves(s.bodies[0], 1)) {
        splice(s.bodies[0]);
        return true;
    }
    return s.op == Op::Copy && s.dst == s.args[0];
}

bool Folder::evaluate(const Stmt& s, Value& result) const {
    Program small;
    small.shader_type = program_.shader_type;
    Stmt copy = s;
    for (VarId& id : copy.args) {
        small.vars.push_back(var(id));
        id = static_cast<VarId>(small.vars.size() - 1);
    }
    small.vars.push_back(var(s.dst));
    copy.dst = static_cast<VarId>(small.vars.size() - 1);
    small.vars.back().kind = VarKind::Temp;
    small.body.push_back(std::move(copy));
    InterpHost host;
    Interpreter interpreter(small, host, 1);
    if (!interpreter.run()) {
        return false;
    }
    result = interpreter.value(small.body[0].dst, 0);
    return std::all_of(result.x.begin(), result.x.end(),
                       [](double x) { return std::isfinite(static_cast<float>(x)); });
}

// Operations whose float result is the double one rounded once: sums, products and quotients
// (53 bits are enough that the second rounding changes nothing), choices, comparisons; not those
// that round between their steps, as Dot does.
bool is_exact(const Stmt& s, Type result) {
    switch (s.op) {
    case Op::Add:
    case Op::Sub:
    case Op::Mul:
    case Op::Div:
        return result != Type::Matrix;
    case Op::Dot:
    case Op::Cross:
        return false;
    case Op::Call:
        return builtin_of(s).has(PropExact);
    default:
        return s.op < Op::Call;
    }
}

// Numbers no instruction set treats in its own way: zeros have a sign that depends on the order of
// operands, subnormals may be flushed.
bool is_plain_number(float x) {
    return std::isnormal(x) || std::bit_cast<std::uint32_t>(x) == 0;
}

bool Folder::has_exact_result(const Stmt& s, const Value& result) const {
    const auto plain = [](double x) { return is_plain_number(static_cast<float>(x)); };
    const bool moves_only = s.op == Op::Copy || s.op == Op::Select || s.op == Op::Triple ||
                            s.op == Op::Matrix16 || s.op == Op::Component || s.op == Op::Load;
    return is_exact(s, var(s.dst).type) &&
           (moves_only || (std::all_of(result.x.begin(), result.x.end(), plain) &&
                           std::all_of(s.args.begin(), s.args.end(), [&](VarId id) {
                               return std::all_of(var(id).values.begin(), var(id).values.end(),
                                                  plain);
                           })));
}

VarId Folder::constant(const Var& like, const Value& value) {
    Var v;
    v.type = like.type;
    v.kind = VarKind::Const;
    v.detail = Detail::Uniform;
    v.text = value.s.empty() ? std::string() : value.s[0];
    v.values.assign(value.x.begin(), value.x.end());
    const auto [it, is_new] = constants_.emplace(key(v), static_cast<VarId>(program_.vars.size()));
    if (is_new) {
        const auto taken = [&](const Var& x) { return x.name == v.name; };
        do {
            v.name = "folded" + std::to_string(++next_name_);
        } while (std::any_of(program_.vars.begin(), program_.vars.end(), taken));
        program_.vars.push_back(std::move(v));
    }
    return it->second;
}

// dst = op(constants)  ->  dst = copy constant
void Folder::fold_value(Stmt& s) {
    if (s.dst == no_var || s.op == Op::Store || var(s.dst).array_length != 0 || s.op > Op::Call) {
        return;
    }
    const bool is_call = s.op == Op::Call;
    if (is_call && (!builtin_of(s).has(PropPure) || pure_function(builtin_of(s).body) == nullptr)) {
        return;
    }
    const bool all_known =
        std::all_of(s.args.begin(), s.args.end(), [&](VarId id) { return is_const(id); });
    const bool is_plain = s.op == Op::Copy && all_known && var(s.args[0]).type == var(s.dst).type;
    Value value;
    if (!all_known || is_plain || !evaluate(s, value) ||
        (folding_ == Folding::Exact && !has_exact_result(s, value))) {
        return;
    }
    s.args = {constant(var(s.dst), value)};
    s.op = Op::Copy;
    s.builtin = -1;
    changed_ = true;
}

// Identities that hold for every float: x * 1, x / 1, known choices.
void Folder::simplify(Stmt& s) {
    VarId same = no_var;
    switch (s.op) {
    case Op::Mul:
        same = is_number(s.args[1], 1) ? s.args[0] : is_number(s.args[0], 1) ? s.args[1] : no_var;
        break;
    case Op::Div:
        same = is_number(s.args[1], 1) ? s.args[0] : no_var;
        break;
    case Op::Select:
        if (is_const(s.args[0])) {
            same = var(s.args[0]).values[0] != 0 ? s.args[1] : s.args[2];
        }
        break;
    case Op::And:
        same = is_number(s.args[0], 0) ? s.args[0] : is_number(s.args[1], 0) ? s.args[1] : no_var;
        break;
    default:
        break;
    }
    const bool from_matrix = same != no_var && var(same).type == Type::Matrix;
    if (same != no_var && (!from_matrix || s.op == Op::Select)) {
        s.op = Op::Copy;
        s.args = {same};
        changed_ = true;
    }
}

// pow(x, 2), pow(x, 1) and pow(x, 0.5) as written in the source. Their other forms differ from
// pow() in the last bit, so parameters that become constants later do not take them.
void Folder::simplify_power(Stmt& s) {
    if (folding_ == Folding::Exact || s.op != Op::Call || builtin_of(s).body != "pow") {
        return;
    }
    const VarId x = s.args[0];
    if (is_number(s.args[1], 2)) {
        s.op = Op::Mul;
        s.args = {x, x};
    } else if (is_number(s.args[1], 1)) {
        s.op = Op::Copy;
        s.args = {x};
    } else if (is_number(s.args[1], 0.5F)) {
        s.args = {x};
        s.builtin = find_builtins("sqrt").front();
        changed_ = true;
        return;
    } else {
        return;
    }
    s.builtin = -1;
    changed_ = true;
}

} // namespace

bool pass_fold(Program& program, Folding folding) {
    return Folder(program, folding).run();
}

} // namespace slc
