// SPDX-License-Identifier: Apache-2.0
// Values: how operands and pure operations read in emitted text.
#include "slc/emit_common.h"

#include <algorithm>
#include <cmath>

namespace slc {

std::string Emitter::wrap(const Expr& e, Prec around, bool right) {
    const bool bare = e.prec < around || (e.prec == around && !right);
    return bare ? e.text : "(" + e.text + ")";
}

Expr Emitter::apply(std::string_view function, Form result, bool is_varying,
                    std::initializer_list<std::string> arguments) {
    Expr e;
    e.text = is_varying ? "slv_" : "slu_";
    e.text += function;
    e.text += '(';
    bool first = true;
    for (const std::string& a : arguments) {
        e.text += (first ? "" : ", ") + a;
        first = false;
    }
    e.text += ')';
    e.form = result;
    e.varying = is_varying;
    return e;
}

std::string_view Emitter::type_word(Form form, bool is_varying) const {
    const auto i = static_cast<std::size_t>(form);
    return is_varying ? dialect_.varying_types[i] : dialect_.uniform_types[i];
}

std::string Emitter::declarator(VarId v, bool constant) const {
    const bool is_restored = waits_ != nullptr && waits_->is_saved(v);
    std::string text = constant && !is_restored ? "const " : "";
    if (is_truth(v)) {
        text += varying(v) ? dialect_.varying_truth : dialect_.uniform_truth;
    } else {
        text += type_word(form(v), varying(v));
    }
    text += ' ';
    text += names_[static_cast<std::size_t>(v)];
    if (var(v).array_length > 0) {
        text += "[" + std::to_string(var(v).array_length) + "]";
    }
    return text;
}

std::string Emitter::zero_of(Form form, bool is_varying) {
    static constexpr std::string_view uniform[] = {"0", "{0}", "{{0}}"};
    static constexpr std::string_view lanes[] = {"{0}", "{{0}, {0}, {0}}", "{{{0}}}"};
    if (form == Form::String) {
        const std::string text = string_literal("");
        return is_varying ? "slv_spread_s(" + text + ")" : text;
    }
    return std::string((is_varying ? lanes : uniform)[static_cast<std::size_t>(form)]);
}

// The initialiser of a variable nothing has been assigned to.
std::string Emitter::zero(VarId v) {
    const std::string one = zero_of(form(v), varying(v));
    std::string all = one;
    for (int n = 1; form(v) == Form::String && n < var(v).array_length; ++n) {
        all += ", " + one;
    }
    return var(v).array_length > 0 ? "{" + all + "}" : all;
}

std::string Emitter::string_literal(const std::string& text) {
    std::string comment;
    for (const char c : text) {
        comment += c == '*' || c == '/' || c < 32 || c > 126 ? '_' : c;
    }
    return "strings[" + std::to_string(strings_.add(text)) + " /* \"" + comment + "\" */]";
}

Expr Emitter::constant(const Var& v) {
    Expr e;
    e.form = form_of(v.type);
    const auto component = [&](std::size_t i) {
        return float_literal(i < v.values.size() ? v.values[i] : 0.0F);
    };
    switch (e.form) {
    case Form::Float:
        e.text = component(0);
        e.prec = e.text[0] == '-' ? Prec::Unary : Prec::Atom;
        break;
    case Form::Triple:
        e.text = "slu_make_3(" + component(0) + ", " + component(1) + ", " + component(2) + ")";
        break;
    case Form::Matrix:
        e.text = "(";
        e.text += type_word(Form::Matrix, false);
        e.text += "){{";
        for (std::size_t i = 0; i < 16; ++i) {
            e.text += (i > 0 ? ", " : "") + component(i);
        }
        e.text += "}}";
        break;
    case Form::String:
        e.text = string_literal(v.text);
        break;
    }
    return e;
}

Expr Emitter::name_of(VarId v) const {
    Expr e;
    e.form = form(v);
    e.varying = varying(v);
    e.truth = is_truth(v);
    e.text = names_[static_cast<std::size_t>(v)];
    if (mode_ == Mode::Init && var(v).kind == VarKind::Param) {
        e.text = "params->" + e.text + (var(v).detail == Detail::Varying ? "_default" : "");
    }
    return e;
}

Expr Emitter::use(VarId v) {
    const Var& variable = var(v);
    if (variable.kind == VarKind::Const && variable.array_length == 0) {
        return constant(variable);
    }
    const auto it = std::find_if(deferred_.begin(), deferred_.end(),
                                 [&](const Deferred& d) { return d.var == v; });
    if (it != deferred_.end()) {
        Expr e = std::move(it->value);
        reading_.insert(reading_.end(), it->reads.begin(), it->reads.end());
        deferred_.erase(it);
        return e;
    }
    reading_.push_back(v);
    return name_of(v);
}

Expr Emitter::as_float(Expr e) const {
    if (!e.truth) {
        return e;
    }
    if (e.varying) {
        return apply("f_of_mask", Form::Float, true, {e.text});
    }
    Expr r;
    r.text = wrap(e, Prec::Choose, true) + " ? 1.0f : 0.0f";
    r.prec = Prec::Choose;
    return r;
}

Expr Emitter::as_truth(Expr e) const {
    if (e.truth) {
        return e;
    }
    if (e.varying) {
        Expr r = apply("mask_of_f", Form::Float, true, {e.text});
        r.truth = true;
        return r;
    }
    e.text = wrap(e, Prec::Compare, true) + " != 0.0f";
    e.prec = Prec::Compare;
    e.truth = true;
    return e;
}

Expr Emitter::as_varying(Expr e) const {
    if (e.varying) {
        return e;
    }
    if (e.truth) {
        e = apply("spread_i", Form::Float, true, {wrap(e, Prec::Choose, true) + " ? -1 : 0"});
        e.truth = true;
        return e;
    }
    return apply("spread_" + std::string(form_suffix(e.form)), e.form, true, {e.text});
}

// The value of the lowest live lane. The inference leaves no such conversion; arguments that are
// uniform by definition (names of textures, channels) may still be given varying values.
Expr Emitter::as_uniform(Expr e, const Block& b) const {
    if (!e.varying) {
        return e;
    }
    const std::string suffix(form_suffix(e.form));
    e = as_float(std::move(e));
    Expr r = apply("lane_" + suffix, e.form, true, {e.text, "sl_first_lane(" + mask(b) + ")"});
    r.varying = false;
    return r;
}

Expr Emitter::as_form(Expr e, Form form) const {
    e = as_float(std::move(e));
    if (e.form == form || e.form != Form::Float) {
        return e;
    }
    if (form == Form::Triple) {
        return apply("f_to_3", Form::Triple, e.varying, {e.text});
    }
    if (form == Form::Matrix) {
        return apply("f_to_m", Form::Matrix, e.varying, {e.text});
    }
    return e;
}

Expr Emitter::fit(Expr e, Form form, bool is_varying) const {
    e = as_form(std::move(e), form);
    return is_varying ? as_varying(std::move(e)) : e;
}

Expr Emitter::value_of(const Stmt& s, const Block&) {
    bool any_varying = false;
    for (const VarId a : s.args) {
        any_varying = any_varying || varying(a);
    }
    switch (s.op) {
    case Op::Copy:
        return use(s.args[0]);
    case Op::Add:
    case Op::Sub:
    case Op::Mul:
    case Op::Div:
    case Op::Neg:
        return arithmetic(s, any_varying);
    case Op::Dot: {
        const Expr a = fit(use(s.args[0]), Form::Triple, any_varying);
        const Expr b = fit(use(s.args[1]), Form::Triple, any_varying);
        return apply("dot_3", Form::Float, any_varying, {a.text, b.text});
    }
    case Op::Cross: {
        const Expr a = fit(use(s.args[0]), Form::Triple, any_varying);
        const Expr b = fit(use(s.args[1]), Form::Triple, any_varying);
        return apply("cross_3", Form::Triple, any_varying, {a.text, b.text});
    }
    case Op::Eq:
    case Op::Ne:
    case Op::Lt:
    case Op::Le:
    case Op::Gt:
    case Op::Ge:
        return compare(s, any_varying);
    case Op::And:
    case Op::Or:
    case Op::Not:
        return logic(s, any_varying);
    case Op::Select:
        return choose(s, any_varying);
    case Op::Triple:
    case Op::Matrix16:
        return compose(s, any_varying);
    case Op::Component:
        return component(s, any_varying);
    case Op::Load:
        return load(s, any_varying);
    default:
        return {};
    }
}

Expr Emitter::arithmetic(const Stmt& s, bool is_varying) {
    const Expr a = as_float(use(s.args[0]));
    const Expr b = s.args.size() > 1 ? as_float(use(s.args[1])) : Expr{};
    Expr r;
    r.varying = is_varying;
    r.form = s.args.size() > 1 ? std::max(a.form, b.form) : a.form;
    if (r.form == Form::Triple) {
        return triple_arithmetic(s, a, b, is_varying);
    }
    if (r.form == Form::Matrix) {
        static constexpr std::string_view functions[] = {"add_m", "sub_m", "mul_m", "div_m",
                                                         "neg_m"};
        const auto function = functions[static_cast<int>(s.op) - static_cast<int>(Op::Add)];
        const Expr left = fit(a, Form::Matrix, is_varying);
        if (s.op == Op::Neg) {
            return apply(function, Form::Matrix, is_varying, {left.text});
        }
        return apply(function, Form::Matrix, is_varying,
                     {left.text, fit(b, Form::Matrix, is_varying).text});
    }
    if (s.op == Op::Neg) {
        r.text = "-" + wrap(a, Prec::Unary, true);
        r.prec = Prec::Unary;
        return r;
    }
    // A vector and a scalar mix in C operators.
    static constexpr std::string_view signs[] = {" + ", " - ", " * ", " / "};
    r.prec = s.op == Op::Add || s.op == Op::Sub ? Prec::Add : Prec::Multiply;
    r.text = wrap(a, r.prec);
    r.text += signs[static_cast<int>(s.op) - static_cast<int>(Op::Add)];
    r.text += wrap(b, r.prec, true);
    return r;
}

Expr Emitter::triple_arithmetic(const Stmt& s, const Expr& a, const Expr& b,
                                bool is_varying) const {
    if (s.op == Op::Neg) {
        return apply("neg_3", Form::Triple, is_varying, {fit(a, Form::Triple, is_varying).text});
    }
    if (s.op == Op::Mul && a.form != b.form) {
        const Expr& triple = a.form == Form::Triple ? a : b;
        const Expr& factor = a.form == Form::Triple ? b : a;
        return apply("scale_3", Form::Triple, is_varying,
                     {fit(triple, Form::Triple, is_varying).text,
                      fit(factor, Form::Float, is_varying).text});
    }
    static constexpr std::string_view functions[] = {"add_3", "sub_3", "mul_3", "div_3"};
    return apply(functions[static_cast<int>(s.op) - static_cast<int>(Op::Add)], Form::Triple,
                 is_varying,
                 {fit(a, Form::Triple, is_varying).text, fit(b, Form::Triple, is_varying).text});
}

Expr Emitter::compare(const Stmt& s, bool is_varying) {
    Expr a = as_float(use(s.args[0]));
    Expr b = as_float(use(s.args[1]));
    const Form form = std::max(a.form, b.form);
    Expr r;
    if (form == Form::Float) {
        static constexpr std::string_view signs[] = {" == ", " != ", " < ", " <= ", " > ", " >= "};
        // Two scalars would make a scalar; at least one side is lanes when is_varying.
        r.text = wrap(a, Prec::Compare, true);
        r.text += signs[static_cast<int>(s.op) - static_cast<int>(Op::Eq)];
        r.text += wrap(b, Prec::Compare, true);
        r.prec = Prec::Compare;
    } else {
        static constexpr std::string_view functions[] = {"eq_", "ne_", "lt_", "le_", "lt_", "le_"};
        if (s.op == Op::Gt || s.op == Op::Ge) {
            std::swap(a, b);
        }
        const std::string function =
            std::string(functions[static_cast<int>(s.op) - static_cast<int>(Op::Eq)]) +
            std::string(form_suffix(form));
        r = apply(function, Form::Float, is_varying,
                  {fit(a, form, is_varying).text, fit(b, form, is_varying).text});
    }
    r.form = Form::Float;
    r.varying = is_varying;
    r.truth = true;
    return r;
}

Expr Emitter::logic(const Stmt& s, bool is_varying) {
    Expr a = as_truth(use(s.args[0]));
    Expr r;
    r.truth = true;
    r.varying = is_varying;
    if (s.op == Op::Not) {
        r.text = (is_varying ? "~" : "!") + wrap(a, Prec::Unary);
        r.prec = Prec::Unary;
        return r;
    }
    Expr b = as_truth(use(s.args[1]));
    if (is_varying) {
        a = as_varying(std::move(a));
        b = as_varying(std::move(b));
        // | and & are both below comparisons; brackets on either side keep the compiler and the
        // reader calm.
        r.prec = s.op == Op::And ? Prec::BitAnd : Prec::Or;
        r.text = wrap(a, Prec::Compare, true) + (s.op == Op::And ? " & " : " | ") +
                 wrap(b, Prec::Compare, true);
        return r;
    }
    r.prec = s.op == Op::And ? Prec::And : Prec::Or;
    r.text = wrap(a, Prec::BitAnd) + (s.op == Op::And ? " && " : " || ") + wrap(b, Prec::BitAnd);
    return r;
}

Expr Emitter::choose(const Stmt& s, bool is_varying) {
    const Expr condition = as_truth(use(s.args[0]));
    const Form form = form_of(var(s.dst).type);
    const Expr yes = fit(use(s.args[1]), form, is_varying);
    const Expr no = fit(use(s.args[2]), form, is_varying);
    if (condition.varying) {
        return apply("select_" + std::string(form_suffix(form)), form, true,
                     {condition.text, yes.text, no.text});
    }
    Expr r;
    r.form = form;
    r.varying = is_varying;
    r.prec = Prec::Choose;
    r.text = wrap(condition, Prec::Choose, true) + " ? " + wrap(yes, Prec::Choose, true) + " : " +
             wrap(no, Prec::Choose, true);
    return r;
}

Expr Emitter::compose(const Stmt& s, bool is_varying) {
    std::vector<std::string> parts;
    for (const VarId a : s.args) {
        parts.push_back(fit(use(a), Form::Float, is_varying).text);
    }
    if (s.op == Op::Triple) {
        return apply("make_3", Form::Triple, is_varying, {parts[0], parts[1], parts[2]});
    }
    Expr r;
    r.form = Form::Matrix;
    r.varying = is_varying;
    r.text = "(";
    r.text += type_word(Form::Matrix, is_varying);
    r.text += "){{";
    for (std::size_t i = 0; i < parts.size(); ++i) {
        r.text += (i > 0 ? ", " : "") + parts[i];
    }
    r.text += "}}";
    return r;
}

Expr Emitter::component(const Stmt& s, bool is_varying) {
    const Var& index = var(s.args[1]);
    Expr a = as_form(use(s.args[0]), Form::Triple);
    if (index.kind == VarKind::Const && !index.values.empty()) {
        const float i = index.values[0];
        a.text = wrap(a, Prec::Atom) + (i >= 2 ? ".z" : i >= 1 ? ".y" : ".x");
        a.form = Form::Float;
        a.prec = Prec::Atom;
        return a;
    }
    return apply(
        "comp_3", Form::Float, is_varying,
        {fit(a, Form::Triple, is_varying).text, fit(use(s.args[1]), Form::Float, is_varying).text});
}

// The C index of an array element; varying when v is.
Expr Emitter::index_of(VarId v, int length) {
    const Var& index = var(v);
    Expr r;
    if (index.kind == VarKind::Const && !index.values.empty() &&
        index.values[0] == index.values[0]) {
        const float last = static_cast<float>(length - 1);
        r.text = std::to_string(static_cast<int>(std::clamp(index.values[0], 0.0F, last)));
        return r;
    }
    const bool is_varying = varying(v);
    const Expr e = as_float(use(v));
    return apply("index", Form::Float, is_varying, {e.text, std::to_string(length)});
}

Expr Emitter::load(const Stmt& s, bool) {
    const VarId array = s.args[0];
    const Expr index = index_of(s.args[1], std::max(var(array).array_length, 1));
    reading_.push_back(array);
    Expr r = name_of(array);
    if (!index.varying) {
        r.text += "[" + index.text + "]";
        return r;
    }
    const std::string suffix(form_suffix(r.form));
    r.text =
        (r.varying ? "slv_at_" : "slu_at_lanes_") + suffix + "(" + r.text + ", " + index.text + ")";
    r.varying = true;
    return r;
}

} // namespace slc
