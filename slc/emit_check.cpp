// SPDX-License-Identifier: Apache-2.0
// Checked code: every value is looked at when it has been computed, and the first one in a lane
// that is no number is told to the engine with its place and what was computed. Built only when
// such a value has reached a result (docs/robustness.md); nothing is deferred in it, so that each
// operation is seen at its own line.
#include "slc/builtins.h"
#include "slc/emit_common.h"

namespace slc {

namespace {

std::string what_is_computed(const Stmt& s, const Var& to) {
    std::string text;
    switch (s.op) {
    case Op::Add:
        text = "a sum";
        break;
    case Op::Sub:
        text = "a difference";
        break;
    case Op::Mul:
        text = "a product";
        break;
    case Op::Div:
        text = "a quotient";
        break;
    case Op::Call:
        text = std::string(builtin_rows()[static_cast<std::size_t>(s.builtin)].name) + "()";
        break;
    default:
        text = "a value";
        break;
    }
    return to.kind == VarKind::Temp ? text : text + " that goes to " + to.name;
}

} // namespace

// `value`: text of a numeric value of that form on lanes.
void Emitter::emit_check(Form form, const std::string& value, const std::string& lanes,
                         const Loc& loc, const std::string& what) {
    const std::string file = loc.file < program_.files.size() ? program_.files[loc.file] : "?";
    out_.line("sl_check_" + std::string(form_suffix(form)) + "(call, " + lanes + ", " + value +
              ", " + c_string(file) + ", " + std::to_string(loc.line) + ", " + c_string(what) +
              ");");
}

bool Emitter::is_checkable(VarId v) const {
    return v != no_var && var(v).type != Type::String && var(v).type != Type::Void &&
           var(v).array_length == 0 && !is_truth(v);
}

// Lanes in which a divisor is 0, asked before the quotient may overwrite it; "" where that is no
// question.
std::string Emitter::zero_divisors(const Stmt& s) {
    if (!checked_ || s.op != Op::Div || var(s.args[1]).type == Type::Matrix) {
        return "";
    }
    const Expr divisor = fit(use(s.args[1]), form(s.args[1]), true);
    const std::string name = fresh("zero");
    out_.line("const " + std::string(dialect_.varying_truth) + " " + name + " = sl_some_zero_" +
              std::string(form_suffix(divisor.form)) + "(" + divisor.text + ");");
    return name;
}

void Emitter::check_value(VarId v, const Stmt& s, const Block& b, const std::string& zeros) {
    if (!checked_ || !is_checkable(v)) {
        return;
    }
    const std::string value = fit(name_of(v), form(v), true).text;
    if (!zeros.empty()) {
        emit_check(form(v), value, "(" + mask(b) + " & " + zeros + ")", s.loc,
                   "division by zero" + (var(v).kind == VarKind::Temp
                                             ? std::string()
                                             : " in what goes to " + var(v).name));
    }
    emit_check(form(v), value, mask(b), s.loc, what_is_computed(s, var(v)));
}

// What the shader is given.
void Emitter::check_inputs() {
    for (std::size_t i = 0; checked_ && i < program_.vars.size(); ++i) {
        const auto v = static_cast<VarId>(i);
        const VarPlace& place = flow_.place(v);
        const bool is_input = (var(v).kind == VarKind::Global || var(v).kind == VarKind::Param) &&
                              place.home && !place.set_first && place.is_read &&
                              declared_.count(v) > 0;
        if (is_input && is_checkable(v)) {
            emit_check(form(v), fit(name_of(v), form(v), true).text, "live", var(v).loc,
                       var(v).name + " as the shader gets it");
        }
    }
}

} // namespace slc
