// SPDX-License-Identifier: Apache-2.0
// Calls of built-in functions, by their rows in sl_builtins.def: slv_<body> on lanes, slu_<body> on
// uniform values.
#include "slc/emit_call.h"

#include "slc/builtins.h"
#include "slc/ir_util.h"

#include <algorithm>

namespace slc {

namespace {

constexpr std::string_view sl_type_names[] = {"SL_TYPE_void",   "SL_TYPE_float",  "SL_TYPE_color",
                                              "SL_TYPE_point",  "SL_TYPE_vector", "SL_TYPE_normal",
                                              "SL_TYPE_matrix", "SL_TYPE_string"};

// Is about the light of the loop around it.
bool asks_light(const BuiltinRow& row) {
    return row.body == "message_lightsource" || row.body == "shadername_of";
}

} // namespace

std::string joined(const std::vector<std::string>& parts) {
    std::string text;
    for (const std::string& p : parts) {
        text += (text.empty() ? "" : ", ") + p;
    }
    return text;
}

bool Emitter::runs_on_lanes(const Stmt& s) const {
    if (mode_ == Mode::Init || (s.dst != no_var && !varying(s.dst))) {
        return false;
    }
    const BuiltinRow& row = builtin_rows()[static_cast<std::size_t>(s.builtin)];
    const bool any_varying =
        std::any_of(s.args.begin(), s.args.end(), [this](VarId a) { return varying(a); });
    return any_varying || (s.dst != no_var && (row.has(PropVaries) || row.has(PropContext)));
}

void Emitter::call(const Stmt& s, const Block& b) {
    if (waits(s)) {
        waiting_call(s, b);
        return;
    }
    const BuiltinRow& row = builtin_rows()[static_cast<std::size_t>(s.builtin)];
    const bool is_difference = s.op == Op::Difference;
    const std::size_t num_args =
        s.args.size() - (is_difference ? difference_places(s.builtin).size() : 0);
    Call c{s, b, row, runs_on_lanes(s), num_args, is_difference ? "_d" : ""};
    refresh_planes(row.reads, b);
    if (shows_outputs(s)) {
        store_outputs(b);
    }
    Expr value;
    value.varying = c.lanes;
    value.form = form_of(row.result.kind == ArgKind::Exact ? row.result.type : Type::Vector);
    if (row.body == "arraylength") {
        value = Expr{float_literal(static_cast<float>(var(s.args[0]).array_length)), Form::Float,
                     false, false, Prec::Atom};
    } else if (!is_difference && row.repeats_last &&
               (row.body.starts_with("min_") || row.body.starts_with("max_"))) {
        value = chained(c);
    } else {
        name_texts(c);
        if (row.has(PropContext)) {
            c.arguments.push_back(c.lanes ? "call, " + c.mask : "call");
        }
        if (row.body.starts_with("spline_")) {
            spline_arguments(c);
        } else if (row.body == "concat") {
            c.arguments.push_back(knot_array(c, 0));
            c.arguments.push_back(std::to_string(s.args.size()));
        } else {
            fixed_arguments(c);
        }
        if (is_difference) {
            differences(c);
        }
        value.text = (c.lanes ? "slv_" : "slu_") + std::string(row.body) + c.form + "(" +
                     joined(c.arguments) + ")";
    }
    if (may_defer(s, b) && c.through.empty() && c.texts.empty()) {
        defer(s.dst, std::move(value));
        return;
    }
    note_place(s.loc);
    if (asks_light(row)) {
        out_.line("call->lights = " + lights_around(b) + ";");
    }
    if (!c.texts.empty()) {
        value = for_each_text(c, value);
        if (s.dst == no_var) {
            return;
        }
    }
    finish_call(c, value);
}

// The call's text, and where its results go.
void Emitter::finish_call(const Call& c, const Expr& value) {
    if (c.s.dst != no_var) {
        assign(c.s.dst, value, c.b);
    } else {
        out_.line(value.text + ";");
    }
    for (const auto& [v, temporary] : c.through) {
        Expr result;
        result.text = temporary;
        result.form = form(v);
        result.varying = c.lanes;
        assign(v, result, c.b);
    }
}

// Built-ins read predefined variables from the batch: what the shader has changed must be there.
void Emitter::refresh_planes(std::uint64_t reads, const Block& b) {
    if ((reads & results_) == 0 || mode_ != Mode::Shade) {
        return;
    }
    for (std::size_t i = 0; i < program_.vars.size(); ++i) {
        const Var& v = program_.vars[i];
        if (!is_global(v) || (reads & results_ & std::uint64_t{1} << v.index) == 0 ||
            !flow_.place(static_cast<VarId>(i)).is_written ||
            declared_.count(static_cast<VarId>(i)) == 0) {
            continue;
        }
        out_.line("sl_store_" + std::string(form_suffix(form(static_cast<VarId>(i)))) + "(call, " +
                  mask(b) + ", batch->main->var[SL_VAR_" + v.name + "], " + names_[i] + ");");
    }
}

// Output parameters as they stand, for shaders that ask for them meanwhile. Those that nothing has
// been assigned to yet hold the value of the instance.
void Emitter::store_outputs(const Block& b) {
    for (const Param& p : program_.params) {
        if (var(p.var).is_output && flow_.place(p.var).is_written && declared_.count(p.var) > 0 &&
            mode_ == Mode::Shade) {
            store_param(p.var, mask(b));
        }
    }
}

void Emitter::fixed_arguments(Call& c) {
    std::size_t next = 0;
    const bool name_first = c.row.has(PropChannel);
    for (std::size_t r = 0; r < c.row.args.size() && next < c.num_args; ++r) {
        const ArgSpec& spec = c.row.args[r];
        const VarId v = c.s.args[next++];
        if (spec.is_output) {
            output_argument(c, v);
        } else if (var(v).type == Type::String) {
            c.arguments.push_back(text_argument(c, v));
        } else {
            const Form wanted =
                spec.kind == ArgKind::Exact ? form_of(spec.type) : form_of(Type::Vector);
            c.arguments.push_back(fit(use(v), wanted, c.lanes).text);
        }
        if (name_first && r == 0 && next < c.num_args) {
            c.arguments.push_back(as_uniform(as_float(use(c.s.args[next++])), c.b).text);
        }
    }
    if (c.row.takes_pairs || c.row.takes_values) {
        value_arguments(c, next);
    }
    output_pairs(c);
}

// Pairs that set variables: a list of their own. The body leaves masked lanes alone.
void Emitter::output_pairs(Call& c) {
    if (c.row.output_pairs.empty()) {
        return;
    }
    std::string list;
    for (const auto& [name, v] : c.s.options) {
        settle_readers(v);
        list += (list.empty() ? "" : ", ") + std::string("{SL_TYPE_string, 0, 0, (sl_string[]){") +
                string_literal(name) + "}}, " +
                typed_value(v).substr(std::string("(sl_value)").size());
    }
    c.arguments.push_back(list.empty() ? "0" : "(sl_value[]){" + list + "}");
    c.arguments.push_back(std::to_string(2 * c.s.options.size()));
}

// What a body <body>_d takes after the arguments of <body>.
void Emitter::differences(Call& c) {
    const std::vector<int>& places = difference_places(c.s.builtin);
    for (std::size_t i = 0; i < places.size(); ++i) {
        const Form wanted = form(c.s.args[static_cast<std::size_t>(places[i])]);
        c.arguments.push_back(fit(use(c.s.args[c.num_args + i]), wanted, c.lanes).text);
    }
}

void Emitter::output_argument(Call& c, VarId v) {
    settle_readers(v);
    const VarPlace& place = flow_.place(v);
    if (place.set_first && place.home == &c.b && declared_.insert(v).second) {
        out_.line(declarator(v, false) + ";"); // the call sets it
    }
    const bool any_type = std::any_of(c.row.args.begin(), c.row.args.end(), [](const ArgSpec& a) {
        return a.is_output && a.kind == ArgKind::Anything;
    });
    if (any_type) {
        c.arguments.push_back("&" + typed_value(v)); // the body leaves masked lanes alone
        return;
    }
    const bool keeps_mask = c.row.has(PropContext) || !flow_.must_blend(v, c.b);
    if (varying(v) == c.lanes && keeps_mask) {
        c.arguments.push_back("&" + name_of(v).text);
        return;
    }
    const std::string temporary = fresh("out");
    std::string initial;
    if (c.row.has(PropInout)) {
        initial = " = " + fit(name_of(v), form(v), c.lanes).text;
    }
    out_.line(std::string(type_word(form(v), c.lanes)) + " " + temporary + initial + ";");
    c.arguments.push_back("&" + temporary);
    c.through.emplace_back(v, temporary);
}

void Emitter::value_arguments(Call& c, std::size_t first) {
    std::string list;
    for (std::size_t i = first; i < c.num_args; ++i) {
        list += (i > first ? ", " : "") +
                typed_value(c.s.args[i]).substr(std::string("(sl_value)").size());
    }
    const std::size_t n = c.num_args - first;
    c.arguments.push_back(n == 0 ? "0" : "(sl_value[]){" + list + "}");
    c.arguments.push_back(std::to_string(n));
}

// [basis,] value, knots as arguments or as one array.
void Emitter::spline_arguments(Call& c) {
    std::size_t next = 0;
    if (var(c.s.args[0]).type == Type::String) {
        c.arguments.push_back(text_argument(c, c.s.args[next++]));
    } else {
        c.arguments.emplace_back("0");
    }
    c.arguments.push_back(fit(use(c.s.args[next++]), Form::Float, c.lanes).text);
    const VarId knots = c.s.args[next];
    // Knots that all lanes share are looked up, not spread.
    const auto first_knot = c.s.args.begin() + static_cast<std::ptrdiff_t>(next);
    const auto end = c.s.args.begin() + static_cast<std::ptrdiff_t>(c.num_args);
    const bool are_uniform = c.form.empty() && c.lanes &&
                             std::none_of(first_knot, end, [this](VarId v) { return varying(v); });
    if (are_uniform) {
        c.form = "_shared";
    }
    if (var(knots).array_length == 0) {
        c.arguments.push_back(knot_array(c, next));
        c.arguments.push_back(std::to_string(c.num_args - next));
        return;
    }
    const std::string length = std::to_string(var(knots).array_length);
    reading_.push_back(knots);
    if (varying(knots) == c.lanes || are_uniform) {
        c.arguments.push_back(name_of(knots).text);
    } else {
        const std::string copy = fresh("out");
        Expr element = name_of(knots);
        element.text += "[sl_k]";
        out_.line(std::string(type_word(form(knots), c.lanes)) + " " + copy + "[" + length + "];");
        out_.line("for (int sl_k = 0; sl_k < " + length + "; sl_k++)");
        out_.line("    " + copy + "[sl_k] = " + fit(element, form(knots), c.lanes).text + ";");
        c.arguments.push_back(copy);
    }
    c.arguments.push_back(length);
}

std::string Emitter::knot_array(Call& c, std::size_t first) {
    Form wanted = Form::Float;
    for (std::size_t i = first; i < c.num_args; ++i) {
        wanted = std::max(wanted, form(c.s.args[i]));
    }
    const bool lanes = c.lanes && wanted != Form::String && c.form != "_shared";
    std::string list;
    for (std::size_t i = first; i < c.num_args; ++i) {
        list += i > first ? ", " : "";
        const Var& knot = var(c.s.args[i]);
        if (!lanes && wanted == Form::Triple && knot.kind == VarKind::Const &&
            is_triple(knot.type)) {
            list += "{" + float_literal(knot.values[0]) + ", " + float_literal(knot.values[1]) +
                    ", " + float_literal(knot.values[2]) + "}"; // the array can be a constant
            continue;
        }
        const VarId v = c.s.args[i];
        list += wanted == Form::String ? text_argument(c, v) : fit(use(v), wanted, lanes).text;
    }
    return std::string(lanes ? "(" : "(const ") + std::string(type_word(wanted, lanes)) + "[]){" +
           list + "}";
}

// min(a, b, c) = min(min(a, b), c)
Expr Emitter::chained(Call& c) {
    const Form wanted = c.row.body.ends_with("_3") ? Form::Triple : Form::Float;
    Expr e = fit(use(c.s.args[0]), wanted, c.lanes);
    for (std::size_t i = 1; i < c.s.args.size(); ++i) {
        e = apply(c.row.body, wanted, c.lanes,
                  {e.text, fit(use(c.s.args[i]), wanted, c.lanes).text});
    }
    return e;
}

std::string Emitter::typed_value(VarId v) {
    return "(sl_value){" + std::string(sl_type_names[static_cast<std::size_t>(var(v).type)]) +
           ", " + (varying(v) ? "1" : "0") + ", " + std::to_string(var(v).array_length) + ", " +
           address_of(v) + "}";
}

std::string Emitter::address_of(VarId v) {
    settle(v);
    const Expr e = use(v);
    if (var(v).kind == VarKind::Const && var(v).array_length == 0) {
        return "(" + std::string(type_word(e.form, false)) + "[]){" + e.text + "}";
    }
    if (e.truth) {
        return "(" + std::string(type_word(Form::Float, e.varying)) + "[]){" + as_float(e).text +
               "}";
    }
    return (var(v).array_length > 0 ? "(void *)" : "(void *)&") + e.text;
}

} // namespace slc
