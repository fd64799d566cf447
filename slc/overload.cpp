// SPDX-License-Identifier: Apache-2.0
// Which function a call means: user functions of the innermost scope first, then the rows of
// sl_builtins.def, by the cost of converting arguments; ties go to the earlier one
// (sl.md 1.6, 2.4).
#include "slc/check.h"

#include <algorithm>

namespace slc {

using ast::Expr;
using ast::ExprKind;
using ast::Function;
using ast::no_cost;
using ast::Symbol;

namespace {

bool is_lvalue(const Expr& e) {
    return e.kind == ExprKind::Name || (e.kind == ExprKind::Index && !e.is_component);
}

// An expression where a function sets a variable: what is set is lost.
constexpr std::uint32_t lost_output = 60;
// A row whose type must be asked for (SL_ASKED): below last_resort, so that a cast finds it.
constexpr std::uint32_t unasked = 40;

} // namespace

bool Checker::match_function(Expr& e, Function& f, Candidate& c) {
    if (e.args.size() != f.formals.size()) {
        return false;
    }
    c.function = &f;
    c.result = f.result.value_or(Type::Void);
    for (std::size_t i = 0; i < e.args.size(); ++i) {
        const Symbol& formal = *f.formals[i];
        Expr& arg = *e.args[i];
        const Symbol* array = array_of(arg);
        if (arg.channel != nullptr || (array != nullptr) != (formal.array_length != 0)) {
            return false;
        }
        if (array != nullptr) {
            const bool lengths = formal.array_length == ast::unsized_array ||
                                 array->array_length == ast::unsized_array ||
                                 array->array_length == formal.array_length;
            const std::uint8_t cost = conversion_cost(array->type, formal.type);
            if (cost > 1) {
                return false;
            }
            c.cost += cost + (lengths ? 0U : 20U);
            c.arg_types.push_back(Type::Void);
            continue;
        }
        std::uint32_t cost = cost_to(arg, formal.type);
        if (formal.is_output && !costs(arg).failed && cost != no_cost) {
            const bool back =
                is_lvalue(arg) && (is_triple(formal.type) && is_triple(arg.symbol->type)
                                       ? true
                                       : formal.type == arg.symbol->type);
            cost = back ? cost : !is_lvalue(arg) ? cost + lost_output : no_cost;
        }
        if (cost == no_cost) {
            return false;
        }
        c.cost += cost;
        c.arg_types.push_back(formal.type);
    }
    return true;
}

// The kind a `g` row works on: that of the first argument that is one of the three by itself.
Type Checker::pvn_kind(Expr& e, const BuiltinRow& row) {
    for (std::size_t i = 0; i < e.args.size(); ++i) {
        const ArgSpec& spec = row.args[std::min(i, row.args.size() - 1)];
        if (spec.kind != ArgKind::Pvn || array_of(*e.args[i]) != nullptr) {
            if (spec.is_array && array_of(*e.args[i]) != nullptr &&
                is_pvn(array_of(*e.args[i])->type)) {
                return array_of(*e.args[i])->type;
            }
            continue;
        }
        const ast::Costs& c = costs(*e.args[i]);
        for (const Type t : {Type::Point, Type::Vector, Type::Normal}) {
            if (c[t] == 0) {
                return t;
            }
        }
    }
    return Type::Point;
}

// Output arguments are variables of the row's type, or one that interchanges with it. Any type: X.
bool Checker::match_output(Expr& arg, const ArgSpec& spec, Candidate& c) {
    if (spec.kind == ArgKind::Anything) {
        if (!is_lvalue(arg) && costs(arg).failed) {
            return true;
        }
        const bool constant = arg.kind == ExprKind::Number; // textureinfo(name, "exists", 0)
        c.arg_types.push_back(constant ? Type::Float : Type::Void);
        return is_lvalue(arg) || constant;
    }
    if (array_of(arg) != nullptr || !is_lvalue(arg)) {
        return false;
    }
    if (costs(arg).failed) {
        c.arg_types.push_back(spec.type);
        return true;
    }
    const Type type = arg.symbol->type;
    const bool fits = spec.kind == ArgKind::Pvn ? is_pvn(type)
                                                : conversion_cost(spec.type, type) <= 1 &&
                                                      conversion_cost(type, spec.type) <= 1;
    c.cost += fits && type != spec.type && spec.kind == ArgKind::Exact ? 1 : 0;
    c.arg_types.push_back(Type::Void);
    return fits;
}

bool Checker::match_arg(Expr& arg, const ArgSpec& spec, Type pvn, Candidate& c) {
    if (spec.is_output) {
        return match_output(arg, spec, c);
    }
    if (spec.is_array) {
        const Symbol* array = array_of(arg);
        if (array == nullptr) {
            return false;
        }
        c.arg_types.push_back(Type::Void);
        return spec.kind == ArgKind::Anything ||
               (spec.kind == ArgKind::Pvn ? is_pvn(array->type) : array->type == spec.type);
    }
    if (array_of(arg) != nullptr) {
        return false;
    }
    Type type = spec.type;
    if (spec.kind == ArgKind::Pvn) {
        type = pvn;
        for (const Type t : {Type::Point, Type::Vector, Type::Normal}) {
            type = cost_to(arg, t) < cost_to(arg, type) ? t : type;
        }
    }
    const std::uint8_t cost = cost_to(arg, type);
    c.cost += cost;
    c.arg_types.push_back(type);
    return cost != no_cost;
}

// What follows the fixed arguments: repetitions of the last, any values, or name/value pairs.
bool Checker::match_extras(Expr& e, const BuiltinRow& row, Type pvn, Candidate& c) {
    for (std::size_t i = row.args.size(); i < e.args.size(); ++i) {
        Expr& arg = *e.args[i];
        if (row.repeats_last) {
            if (!match_arg(arg, row.args.back(), pvn, c)) {
                return false;
            }
            continue;
        }
        const bool is_name = row.takes_pairs && (i - row.args.size()) % 2 == 0;
        const Symbol* array = array_of(arg);
        if (is_name && (array != nullptr || cost_to(arg, Type::String) == no_cost)) {
            return false;
        }
        if (array == nullptr) {
            costs(arg);
        }
        c.arg_types.push_back(is_name ? Type::String : Type::Void);
    }
    return true;
}

// c says which row it is.
void Checker::match_row(Expr& e, const BuiltinRow& row, Candidate c, std::vector<Candidate>& out) {
    const std::size_t fixed = row.args.size();
    const bool extras = row.repeats_last || row.takes_pairs || row.takes_values;
    if (e.args.size() < fixed || (e.args.size() > fixed && !extras) ||
        (row.takes_pairs && (e.args.size() - fixed) % 2 != 0)) {
        return;
    }
    c.cost += row.has(PropAsked) ? unasked : 0;
    const Type pvn = row.args.empty() ? Type::Point : pvn_kind(e, row);
    for (std::size_t i = 0; i < fixed; ++i) {
        if ((e.args[i]->channel != nullptr && !(i == 0 && row.has(PropChannel))) ||
            !match_arg(*e.args[i], row.args[i], pvn, c)) {
            return;
        }
    }
    if (!match_extras(e, row, pvn, c)) {
        return;
    }
    if (row.result.kind == ArgKind::Triple) {
        for (const Type t : {Type::Color, Type::Point, Type::Vector, Type::Normal}) {
            c.result = t;
            out.push_back(c);
        }
        return;
    }
    c.result = row.result.kind == ArgKind::Pvn ? pvn : row.result.type;
    out.push_back(c);
}

// User functions hide built-in functions, unless no user function takes the arguments. Functions of
// DSOs come last: they may add forms to built-in ones, not replace any.
std::vector<Checker::Candidate> Checker::candidates(Expr& e) {
    std::vector<Candidate> out;
    for (Function* f : scopes_.find_functions(e.text)) {
        Candidate c;
        if (match_function(e, *f, c)) {
            out.push_back(std::move(c));
        }
    }
    if (!out.empty()) {
        return out;
    }
    for (const int row : find_builtins(e.text)) {
        Candidate c;
        c.builtin = row;
        match_row(e, builtin_rows()[static_cast<std::size_t>(row)], std::move(c), out);
    }
    for (const BuiltinRow* row : externals_.find(e.text)) {
        Candidate c;
        c.external = row;
        match_row(e, *row, std::move(c), out);
    }
    for (const int row : find_builtins(e.text)) {
        if (out.empty()) {
            match_by_component(e, row, out);
        }
    }
    return out;
}

// exp(color): a function of floats, for each component. Not in the language, but meant by whoever
// writes it.
void Checker::match_by_component(Expr& e, int number, std::vector<Candidate>& out) {
    const BuiltinRow& row = builtin_rows()[static_cast<std::size_t>(number)];
    const auto is_float = [](const ArgSpec& spec) {
        return spec.kind == ArgKind::Exact && spec.type == Type::Float && !spec.is_output &&
               !spec.is_array;
    };
    const bool suits = row.has(PropPure) && is_float(row.result) && !row.args.empty() &&
                       row.args.size() == e.args.size() &&
                       std::all_of(row.args.begin(), row.args.end(), is_float);
    if (!suits) {
        return;
    }
    Candidate c;
    c.builtin = number;
    c.by_component = true;
    c.cost = last_resort;
    for (Expr* arg : e.args) {
        Type type = array_of(*arg) == nullptr && arg->channel == nullptr ? Type::Float : Type::Void;
        for (const Type t : {Type::Color, Type::Point, Type::Vector, Type::Normal}) {
            const bool is_triple_only =
                type == Type::Float && cost_to(*arg, Type::Float) == no_cost && costs(*arg)[t] <= 1;
            type = is_triple_only ? t : type;
        }
        if (type == Type::Void || cost_to(*arg, type) == no_cost) {
            return;
        }
        c.result = c.result == Type::Void && type != Type::Float ? type : c.result;
        c.arg_types.push_back(type);
    }
    if (c.result != Type::Void) {
        out.push_back(c);
    }
}

// name[channel] of texture functions: the parser saw an index, but a plain string has none (note
// 7).
void Checker::split_channel(Expr& e) {
    if (e.args.empty() || e.args[0]->kind != ExprKind::Index) {
        return;
    }
    const auto rows = find_builtins(e.text);
    if (rows.empty() || !builtin_rows()[static_cast<std::size_t>(rows[0])].has(PropChannel)) {
        return;
    }
    Expr& name = *e.args[0];
    resolve_name(name);
    const bool is_array = name.symbol != nullptr && name.symbol->array_length != 0;
    if (is_array && name.args.size() == 2) {
        name.channel = name.args[1];
        name.args.pop_back();
    } else if (name.symbol != nullptr && !is_array) {
        name.kind = ExprKind::Name;
        name.channel = name.args[0];
        name.args.clear();
    }
}

std::string Checker::describe_args(Expr& e) {
    std::string text = "(";
    for (Expr* arg : e.args) {
        text += text.size() > 1 ? ", " : "";
        if (const Symbol* array = array_of(*arg)) {
            text += std::string(type_name(array->type)) + "[]";
            continue;
        }
        std::string_view name = "void";
        for (const Type t : {Type::String, Type::Matrix, Type::Color, Type::Normal, Type::Vector,
                             Type::Point, Type::Float}) {
            name = costs(*arg)[t] != no_cost ? type_name(t) : name;
        }
        text += arg->kind == ExprKind::Tuple && arg->args.size() == 3 ? "triple" : name;
    }
    return text + ")";
}

void Checker::no_candidate(Expr& e) {
    const auto rows = find_builtins(e.text);
    const bool is_user = !scopes_.find_functions(e.text).empty();
    const auto& externals = externals_.find(e.text);
    if (rows.empty() && externals.empty() && !is_user) {
        const bool is_open = std::any_of(open_functions_.begin(), open_functions_.end(),
                                         [&](const Function* f) { return f->name == e.text; });
        if (is_open) {
            fail(e, "function " + quoted(e.text) +
                        " calls itself; there is no recursion in the Shading Language");
            return;
        }
        const std::string hint = spelling_hint(e.text, scopes_.function_names());
        fail(e, "function " + quoted(e.text) + " is not defined" +
                    (hint.empty() ? "; if it is a function of a DSO, name the DSO's directory "
                                    "with --shadeops (render: -shadeops)"
                                  : hint));
        return;
    }
    std::string forms;
    std::vector<const BuiltinRow*> all = externals;
    for (const int row : rows) {
        all.push_back(&builtin_rows()[static_cast<std::size_t>(row)]);
    }
    for (const BuiltinRow* row : all) {
        if (forms.size() > 120) {
            forms += " ...";
            break;
        }
        forms += " " + std::string(row->signature);
    }
    fail(e, "no form of " + quoted(e.text) + " takes " + describe_args(e) +
                (forms.empty() ? std::string() : "; forms:" + forms));
}

void Checker::call_costs(Expr& e) {
    split_channel(e);
    bool failed = false;
    for (Expr* arg : e.args) {
        if (arg->channel != nullptr) {
            deliver(*arg->channel, Type::Float, "a texture channel");
        }
        failed = (array_of(*arg) == nullptr && costs(*arg).failed) || failed;
    }
    if (failed) { // reported; guessing an overload would only add noise
        e.costs.failed = true;
        return;
    }
    std::vector<Candidate> found = candidates(e);
    if (found.empty()) {
        check_later_function(e.text);
        found = candidates(e);
    }
    if (found.empty()) {
        no_candidate(e);
        return;
    }
    for (const Candidate& c : found) {
        const auto cost = static_cast<std::uint8_t>(std::min<std::uint32_t>(c.cost, 254));
        e.costs[c.result] = std::min(e.costs[c.result], cost);
    }
}

void Checker::settle_call(Expr& e, std::optional<Type> natural) {
    const std::vector<Candidate> found = candidates(e);
    const Candidate* best = nullptr;
    bool other_result = false;
    for (const Candidate& c : found) {
        if (natural && c.result != *natural) {
            continue;
        }
        other_result =
            other_result || (best != nullptr && c.result != best->result && c.cost == best->cost);
        if (best == nullptr || c.cost < best->cost) {
            best = &c;
        }
    }
    if (best == nullptr) {
        return;
    }
    e.type = best->result;
    e.builtin = best->builtin;
    e.external = best->external;
    e.function = best->function;
    e.arg_types = best->arg_types;
    e.by_component = best->by_component;
    if (!natural && other_result && e.builtin >= 0 &&
        builtin_rows()[static_cast<std::size_t>(e.builtin)].has(PropTextures)) {
        messages_.warning(e.loc, quoted(e.text) + " can give several types here; " +
                                     std::string(type_name(e.type)) +
                                     " is taken, a cast would say which");
    }
    warn_about_call(e);
    settle_arguments(e);
}

// The value of a name/value pair that the function sets.
bool sets_pair_at(const Expr& e, std::size_t i) {
    if (e.builtin < 0) {
        return false;
    }
    const BuiltinRow& row = builtin_rows()[static_cast<std::size_t>(e.builtin)];
    return row.takes_pairs && i > row.args.size() && (i - row.args.size()) % 2 == 1 &&
           e.args[i - 1]->kind == ExprKind::Text && row.sets_pair(e.args[i - 1]->text) &&
           e.args[i]->kind != ExprKind::Number;
}

// What a call asks for that the language does not have, once it is settled.
void Checker::warn_about_call(const Expr& e) {
    for (std::size_t i = 0; i < e.args.size(); ++i) {
        if (sets_pair_at(e, i) && array_of(*e.args[i]) == nullptr && !is_lvalue(*e.args[i])) {
            messages_.warning(e.args[i]->loc, quoted(e.args[i - 1]->text) + " of " +
                                                  quoted(e.text) +
                                                  " sets a value, but this is not a variable; "
                                                  "what is set is lost");
        }
    }
    if (e.by_component) {
        messages_.warning(e.loc, quoted(e.text) + " takes floats; it is applied to each component");
    }
    if (e.function == nullptr) {
        return;
    }
    for (std::size_t i = 0; i < e.args.size(); ++i) {
        const Symbol& formal = *e.function->formals[i];
        Expr& arg = *e.args[i];
        const std::string place = "argument " + std::to_string(i + 1) + " of " + quoted(e.text);
        if (formal.array_length == 0 && formal.is_output && !is_lvalue(arg)) {
            messages_.warning(arg.loc, place + " is set by the function, but is not a variable; "
                                               "what is set is lost");
        }
        const Symbol* array = formal.array_length != 0 ? array_of(arg) : nullptr;
        if (array != nullptr && array->array_length != ast::unsized_array &&
            array->array_length < formal.array_length) {
            messages_.warning(arg.loc, place + " has " + std::to_string(array->array_length) +
                                           " elements, fewer than the " +
                                           std::to_string(formal.array_length) +
                                           " the function declares");
        }
    }
}

void Checker::settle_arguments(Expr& e) {
    for (std::size_t i = 0; i < e.args.size(); ++i) {
        Expr& arg = *e.args[i];
        if (e.arg_types[i] != Type::Void) {
            deliver(arg, e.arg_types[i],
                    "argument " + std::to_string(i + 1) + " of " + quoted(e.text));
        } else if (array_of(arg) == nullptr) {
            deliver_any(arg, true);
        }
        const auto is_output = [&] {
            if (e.function != nullptr) {
                return e.function->formals[i]->is_output;
            }
            const auto& args = e.external != nullptr
                                   ? e.external->args
                                   : builtin_rows()[static_cast<std::size_t>(e.builtin)].args;
            return (i < args.size() && args[i].is_output) || sets_pair_at(e, i);
        };
        if (is_lvalue(arg) && is_output()) {
            mark_assigned(arg);
        }
    }
}

} // namespace slc
