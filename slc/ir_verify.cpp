// SPDX-License-Identifier: Apache-2.0
// The invariants of ir.h, checked. Run after every pass in tests, and on IR text before it is used.
#include "slc/ir_text.h"
#include "slc/ir_util.h"

namespace slc {

namespace {

class Verifier {
public:
    explicit Verifier(const Program& program) : program_(program) {}
    std::vector<std::string> run();

private:
    static constexpr std::size_t max_complaints = 50;
    void complain(const Stmt& s, const std::string& what);
    [[nodiscard]] bool exists(VarId id) const {
        return id >= 0 && static_cast<std::size_t>(id) < program_.vars.size();
    }
    [[nodiscard]] const Var& var(VarId id) const {
        return program_.vars[static_cast<std::size_t>(id)];
    }
    void variables();
    void block(const Block& b, int loops, int scopes);
    void statement(const Stmt& s, int loops, int scopes);
    bool shape(const Stmt& s);
    void types(const Stmt& s);
    void call(const Stmt& s);
    void arguments(const Stmt& s, std::size_t num_args);
    void difference(const Stmt& s);
    void details(const Stmt& s);
    [[nodiscard]] bool fits(VarId id, const ArgSpec& spec) const;
    [[nodiscard]] static bool comparable(Type a, Type b);
    [[nodiscard]] bool light_operands(const Stmt& s) const;

    const Program& program_;
    std::vector<std::string> complaints_;
    int depth_ = 0;
};

void Verifier::complain(const Stmt& s, const std::string& what) {
    if (complaints_.size() < max_complaints) {
        complaints_.push_back(std::string(op_info(s.op).text) + " at line " +
                              std::to_string(s.loc.line) + ": " + what);
    }
}

std::vector<std::string> Verifier::run() {
    variables();
    for (const Param& p : program_.params) {
        if (!exists(p.var) || var(p.var).kind != VarKind::Param) {
            complaints_.emplace_back("a parameter has no variable");
        }
        block(p.init, 0, 0);
    }
    block(program_.body, 0, 0);
    return std::move(complaints_);
}

void Verifier::variables() {
    for (const Var& v : program_.vars) {
        const auto count = static_cast<std::size_t>(num_components(v.type)) *
                           static_cast<std::size_t>(v.array_length == 0 ? 1 : v.array_length);
        if (v.type == Type::Void || v.array_length < 0) {
            complaints_.push_back("variable " + v.name + " has no proper type");
        }
        if (v.kind == VarKind::Const && v.type != Type::String && v.values.size() != count) {
            complaints_.push_back("constant " + v.name + " has the wrong number of values");
        }
        if (v.kind == VarKind::Global && (v.index < 0 || v.index >= SL_VAR_COUNT)) {
            complaints_.push_back("variable " + v.name + " is no predefined variable");
        }
        const bool may_have_aux =
            (v.kind == VarKind::Global || v.kind == VarKind::Param) && v.type != Type::String;
        if (v.aux < 0 || v.aux > (may_have_aux ? 2 : 0)) {
            complaints_.push_back("variable " + v.name + " has no place at the auxiliary points");
        }
        if (v.kind == VarKind::Const && v.detail != Detail::Uniform) {
            complaints_.push_back("constant " + v.name + " is varying");
        }
    }
}

void Verifier::block(const Block& b, int loops, int scopes) {
    for (const Stmt& s : b) {
        statement(s, loops, scopes);
    }
}

// Numbers of operands, results and bodies; nothing else may be looked at when they are wrong.
bool Verifier::shape(const Stmt& s) {
    const OpInfo& info = op_info(s.op);
    const int n = static_cast<int>(s.args.size());
    bool ok = n >= info.min_args && n <= info.max_args &&
              static_cast<int>(s.bodies.size()) == info.bodies;
    for (const VarId id : s.args) {
        ok = ok && exists(id);
    }
    for (const auto& [name, id] : s.options) {
        ok = ok && exists(id);
    }
    ok = ok && (s.category == no_var || exists(s.category));
    if (s.dst != no_var) {
        ok = ok && exists(s.dst) && info.result != ResultUse::None &&
             var(s.dst).kind != VarKind::Const;
    } else {
        ok = ok && (info.result == ResultUse::None || info.result == ResultUse::Optional);
    }
    if (s.op == Op::Call || s.op == Op::Difference) {
        ok = ok && s.builtin >= 0 && static_cast<std::size_t>(s.builtin) < builtin_rows().size();
    }
    if (!ok) {
        complain(s, "wrong number or kind of operands");
    }
    return ok;
}

void Verifier::statement(const Stmt& s, int loops, int scopes) {
    if (!shape(s)) {
        return;
    }
    types(s);
    details(s);
    if ((s.op == Op::Break || s.op == Op::Continue) && (s.levels < 1 || s.levels > loops)) {
        complain(s, "not inside that many loops");
    }
    if (s.op == Op::Leave && (s.levels < 1 || s.levels > scopes)) {
        complain(s, "not inside a scope");
    }
    if (++depth_ > 4000) {
        complain(s, "nested too deeply");
        return;
    }
    for (const Block& b : s.bodies) {
        block(b, loops + (is_loop(s.op) ? 1 : 0), scopes + (s.op == Op::Scope ? 1 : 0));
    }
    --depth_;
}

void Verifier::types(const Stmt& s) {
    const auto type = [&](std::size_t i) { return var(s.args[i]).type; };
    const auto is_value = [&](std::size_t i) { return var(s.args[i]).array_length == 0; };
    bool ok = true;
    // Arrays are only copied, indexed and handed to built-ins.
    if (s.op != Op::Copy && s.op != Op::Load && s.op != Op::Store && s.op != Op::Call) {
        for (std::size_t i = 0; i < s.args.size(); ++i) {
            ok = ok && is_value(i);
        }
    }
    if (s.dst != no_var && s.op != Op::Copy && s.op != Op::Store) {
        ok = ok && var(s.dst).array_length == 0;
    }
    if (!ok) {
        complain(s, "an array where one value is wanted");
        return;
    }
    switch (s.op) {
    case Op::Copy: {
        const Var& to = var(s.dst);
        const Var& from = var(s.args[0]);
        ok = (from.array_length == 0 || from.array_length == to.array_length) &&
             (same_class(from.type, to.type) ||
              (from.type == Type::Float && to.type != Type::String));
        break;
    }
    case Op::Add:
    case Op::Sub:
    case Op::Mul:
    case Op::Div: {
        const Type to = var(s.dst).type;
        for (std::size_t i = 0; i < 2; ++i) {
            ok = ok && is_value(i) &&
                 (same_class(type(i), to) || (type(i) == Type::Float && is_triple(to)));
        }
        ok = ok && to != Type::String && var(s.dst).array_length == 0;
        break;
    }
    case Op::Neg:
        ok = same_class(type(0), var(s.dst).type) && type(0) != Type::String;
        break;
    case Op::Dot:
        ok = is_triple(type(0)) && is_triple(type(1)) && var(s.dst).type == Type::Float;
        break;
    case Op::Cross:
        ok = is_triple(type(0)) && is_triple(type(1)) && is_triple(var(s.dst).type);
        break;
    case Op::Eq:
    case Op::Ne:
        ok = comparable(type(0), type(1)) && var(s.dst).type == Type::Float;
        break;
    case Op::Lt:
    case Op::Le:
    case Op::Gt:
    case Op::Ge:
        ok = comparable(type(0), type(1)) && type(0) != Type::String && type(0) != Type::Matrix &&
             type(1) != Type::Matrix && var(s.dst).type == Type::Float;
        break;
    case Op::And:
    case Op::Or:
        ok = type(0) == Type::Float && type(1) == Type::Float && var(s.dst).type == Type::Float;
        break;
    case Op::Not:
        ok = type(0) == Type::Float && var(s.dst).type == Type::Float;
        break;
    case Op::Select:
        ok = type(0) == Type::Float && same_class(type(1), var(s.dst).type) &&
             same_class(type(2), var(s.dst).type);
        break;
    case Op::Component:
        ok = is_triple(type(0)) && type(1) == Type::Float && var(s.dst).type == Type::Float;
        break;
    case Op::Triple:
    case Op::Matrix16:
        for (std::size_t i = 0; i < s.args.size(); ++i) {
            ok = ok && type(i) == Type::Float;
        }
        ok = ok &&
             (s.op == Op::Triple ? is_triple(var(s.dst).type) : var(s.dst).type == Type::Matrix);
        break;
    case Op::Illuminance:
    case Op::Illuminate:
    case Op::Solar:
        ok = light_operands(s);
        break;
    case Op::Load:
        ok = !is_value(0) && same_class(type(0), var(s.dst).type) && type(1) == Type::Float &&
             is_value(1);
        break;
    case Op::Store:
        ok = var(s.dst).array_length != 0 && type(0) == Type::Float &&
             same_class(type(1), var(s.dst).type) && is_value(1);
        break;
    case Op::If:
    case Op::Loop:
        ok = type(0) == Type::Float && is_value(0);
        break;
    case Op::Call:
        call(s);
        break;
    case Op::Difference:
        difference(s);
        break;
    default:
        break;
    }
    if (!ok) {
        complain(s, "operands of the wrong type");
    }
}

bool Verifier::comparable(Type a, Type b) {
    return same_class(a, b) || (a == Type::Float && is_triple(b)) ||
           (b == Type::Float && is_triple(a));
}

// Places and axes are triples, angles are floats, categories texts.
bool Verifier::light_operands(const Stmt& s) const {
    const auto type = [&](std::size_t i) { return var(s.args[i]).type; };
    const std::size_t n = s.args.size();
    bool ok = s.category == no_var ||
              (var(s.category).type == Type::String && var(s.category).array_length == 0);
    for (const auto& [name, id] : s.options) {
        ok = ok && (var(id).kind != VarKind::Const || !option_is_output(s, name));
    }
    const std::size_t axis = s.op == Op::Solar ? 0 : 1;
    return ok && (n == axis || n == axis + 2) && (axis == 0 || is_triple(type(0))) &&
           (n == axis || (is_triple(type(axis)) && type(axis + 1) == Type::Float));
}

bool Verifier::fits(VarId id, const ArgSpec& spec) const {
    const Var& v = var(id);
    if (spec.kind == ArgKind::Anything) {
        return !spec.is_array || v.array_length != 0;
    }
    if (spec.is_output && v.kind == VarKind::Const) {
        return false;
    }
    return (v.array_length != 0) == spec.is_array && same_class(v.type, spec.type);
}

void Verifier::call(const Stmt& s) {
    arguments(s, s.args.size());
}

void Verifier::difference(const Stmt& s) {
    const BuiltinRow& row = builtin_of(s);
    const std::vector<int>& places = difference_places(s.builtin);
    if (!row.has(PropDiff) || s.args.size() < 2 * places.size() || places.empty()) {
        complain(s, "no difference of " + std::string(row.name) + " with these arguments");
        return;
    }
    const std::size_t num_args = s.args.size() - places.size();
    arguments(s, num_args);
    for (std::size_t i = 0; i < places.size(); ++i) {
        const auto place = static_cast<std::size_t>(places[i]);
        if (place >= num_args ||
            !same_class(var(s.args[place]).type, var(s.args[num_args + i]).type)) {
            complain(s, "a difference has another type than its argument");
        }
    }
}

// The first `num_args` operands are the row's arguments.
void Verifier::arguments(const Stmt& s, std::size_t num_args) {
    const BuiltinRow& row = builtin_of(s);
    for (const auto& [name, id] : s.options) {
        if (!row.sets_pair(name) || var(id).kind == VarKind::Const) {
            complain(s, "pair " + name + " of " + std::string(row.name) + " sets no variable");
        }
    }
    const std::size_t channel = row.has(PropChannel) ? 1 : 0;
    const std::size_t fixed = row.args.size() + channel;
    const bool extras = row.repeats_last || row.takes_pairs || row.takes_values;
    if (num_args < fixed || (num_args > fixed && !extras)) {
        complain(s, "wrong number of arguments for " + std::string(row.name));
        return;
    }
    for (std::size_t i = 0; i < row.args.size(); ++i) {
        if (!fits(s.args[arg_position(row, i)], row.args[i])) {
            complain(s, "argument " + std::to_string(i + 1) + " of " + std::string(row.name) +
                            " has the wrong type");
        }
    }
    for (std::size_t i = fixed; i < num_args && row.repeats_last; ++i) {
        if (!fits(s.args[i], row.args.back())) {
            complain(s, "argument " + std::to_string(i + 1) + " of " + std::string(row.name) +
                            " has the wrong type");
        }
    }
    if (s.dst != no_var &&
        (row.result.type == Type::Void || !same_class(row.result.type, var(s.dst).type))) {
        complain(s, "result of " + std::string(row.name) + " has the wrong type");
    }
}

// A uniform variable gets uniform values only. random() has one value for a uniform target
// (sl.md 4.1.3).
void Verifier::details(const Stmt& s) {
    const bool is_call = s.op == Op::Call;
    const bool is_random = is_call && builtin_of(s).has(PropRandom);
    bool varying = is_call && !is_random && builtin_of(s).has(PropVaries);
    for_each_read(s, [&](VarId id) { varying = varying || var(id).detail == Detail::Varying; });
    if (!varying) {
        return;
    }
    for_each_write(s, [&](VarId id, bool) {
        if (var(id).detail == Detail::Uniform) {
            complain(s, "uniform variable " + var(id).name + " gets a varying value");
        }
    });
}

} // namespace

std::vector<std::string> verify_ir(const Program& program) {
    return Verifier(program).run();
}

} // namespace slc
