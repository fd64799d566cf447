// SPDX-License-Identifier: Apache-2.0
// Calls to IR: rows of the built-in table become Call statements, user functions are inlined.
// Arguments go by value; output arguments and whole arrays by reference; elements of arrays are
// copied in and back.
#include "slc/ir_util.h"
#include "slc/lower.h"

#include <algorithm>

namespace slc {

using ast::Expr;
using ast::ExprKind;
using ast::Symbol;

namespace {

bool is_whole_array(const Expr& e) {
    return e.kind == ExprKind::Name && e.symbol != nullptr && e.symbol->array_length != 0;
}

} // namespace

VarId Lowering::call(const Expr& e, VarId into) {
    if (e.function != nullptr) {
        return inline_call(e);
    }
    if (e.external != nullptr) {
        return external_call(e);
    }
    return e.builtin >= 0 ? builtin_call(e, into) : constant(0);
}

// A built-in found by the name of its body, for calls the language makes itself (space casts).
VarId Lowering::builtin_by_body(std::string_view body, std::vector<VarId> args, Type result,
                                Loc loc) {
    const VarId dst = temp(result, loc);
    emit(Op::Call, dst, std::move(args), loc).builtin = row_of_body(body);
    return dst;
}

int Lowering::row_of_body(std::string_view body) {
    const auto rows = builtin_rows();
    const auto it =
        std::find_if(rows.begin(), rows.end(), [&](const BuiltinRow& r) { return r.body == body; });
    return static_cast<int>(it - rows.begin());
}

// A function of floats, called for each component of its triples.
VarId Lowering::call_by_component(const Expr& e, VarId into) {
    const std::vector<VarId> given = operands(e.args, e.arg_types);
    std::vector<VarId> parts;
    for (int k = 0; k < 3; ++k) {
        std::vector<VarId> args;
        for (const VarId id : given) {
            const bool whole = is_triple(var(id).type);
            args.push_back(
                whole ? component_of(id, {constant(static_cast<float>(k))}, no_var, e.loc) : id);
        }
        parts.push_back(temp(Type::Float, e.loc));
        emit(Op::Call, parts.back(), std::move(args), e.loc).builtin = e.builtin;
    }
    const VarId result = target(e.type, into, e.loc);
    emit(Op::Triple, result, parts, e.loc);
    return result;
}

VarId Lowering::output_argument(const Expr& e, std::vector<WriteBack>& back) {
    if (e.kind == ExprKind::Name) {
        return assignable(*e.symbol, e.loc);
    }
    if (e.kind != ExprKind::Index) { // a constant where only success matters
        const VarId ignored = local("ignored", e.type, 0, e.loc);
        emit(Op::Copy, ignored, {value(e)}, e.loc);
        return ignored;
    }
    WriteBack w;
    w.index = protect(value_as(*e.args[0], Type::Float), e.loc);
    w.array = assignable(*e.symbol, e.loc);
    w.element = local("element", e.symbol->type, 0, e.loc);
    emit(Op::Load, w.element, {w.array, w.index}, e.loc);
    back.push_back(w);
    return w.element;
}

void Lowering::write_back(const std::vector<WriteBack>& back, Loc loc) {
    for (const WriteBack& w : back) {
        emit(Op::Store, w.array, {w.index, w.element}, loc);
    }
}

VarId Lowering::builtin_call(const Expr& e, VarId into) {
    const BuiltinRow& row = builtin_rows()[static_cast<std::size_t>(e.builtin)];
    constexpr std::uint32_t needs_a_point = PropVaries | PropLights | PropArea | PropTraces |
                                            PropTextures | PropMessage | PropEffect | PropState;
    if (in_init_ && (row.properties & needs_a_point) != 0) {
        messages_.error_once(e.loc, "the default of a parameter is evaluated once per instance and "
                                    "cannot call " +
                                        quoted(row.name));
    }
    if (e.by_component) {
        return call_by_component(e, into);
    }
    BuiltinArgs call = builtin_args(e);
    if (ray_name(row) != nullptr) {
        return map_or_rays(e, row, std::move(call), into);
    }
    VarId dst = no_var;
    if (e.type != Type::Void) {
        dst = call.has_outputs ? temp(e.type, e.loc) : target(e.type, into, e.loc);
    }
    Stmt& s = emit(Op::Call, dst, std::move(call.args), e.loc);
    s.builtin = e.builtin;
    s.options = std::move(call.outputs);
    write_back(call.back, e.loc);
    return dst;
}

Lowering::BuiltinArgs Lowering::builtin_args(const Expr& e) {
    const BuiltinRow& row = builtin_rows()[static_cast<std::size_t>(e.builtin)];
    BuiltinArgs call;
    for (std::size_t i = 0; i < e.args.size(); ++i) {
        const Expr& arg = *e.args[i];
        const bool is_output = i < row.args.size() && row.args[i].is_output;
        const bool is_pair = i + 1 < e.args.size() && sets_pair_at(e, i + 1);
        call.has_outputs = call.has_outputs || is_output || is_pair;
        if (is_pair && !is_whole_array(*e.args[i + 1])) {
            ++i;
            call.outputs.emplace_back(arg.text, output_argument(*e.args[i], call.back));
        } else if (is_output) {
            call.args.push_back(output_argument(arg, call.back));
        } else if (is_whole_array(arg)) {
            call.args.push_back(variable(*arg.symbol, arg.loc));
        } else {
            const VarId id =
                e.arg_types[i] == Type::Void ? value(arg) : value_as(arg, e.arg_types[i]);
            const bool changes_later =
                std::any_of(e.args.begin() + static_cast<std::ptrdiff_t>(i) + 1, e.args.end(),
                            [](const Expr* x) { return has_effects(*x); });
            call.args.push_back(changes_later ? protect(id, arg.loc) : id);
        }
        if (i == 0 && row.has(PropChannel)) {
            call.args.push_back(arg.channel != nullptr ? value_as(*arg.channel, Type::Float)
                                                       : constant(0));
        }
    }
    return call;
}

// A function of a DSO: a hidden row takes its name with the signature, then the result and the
// outputs, then the inputs.
VarId Lowering::external_call(const Expr& e) {
    const BuiltinRow& row = *e.external;
    if (in_init_) {
        messages_.error_once(e.loc, "the default of a parameter is evaluated once per instance and "
                                    "cannot call " +
                                        quoted(row.name));
    }
    std::vector<VarId> outputs, inputs;
    std::vector<WriteBack> back;
    VarId result = no_var;
    if (e.type != Type::Void) {
        result = local(std::string(row.name) + "_result", e.type, 0, e.loc);
        emit(Op::Copy, result, {zero(e.type)}, e.loc);
        outputs.push_back(result);
    }
    for (std::size_t i = 0; i < e.args.size(); ++i) {
        if (row.args[i].is_output) {
            outputs.push_back(output_argument(*e.args[i], back));
        } else {
            inputs.push_back(protect(value_as(*e.args[i], row.args[i].type), e.args[i]->loc));
        }
    }
    std::vector<VarId> args = {text(std::string(row.name) + " " + std::string(row.signature))};
    args.insert(args.end(), outputs.begin(), outputs.end());
    args.insert(args.end(), inputs.begin(), inputs.end());
    emit(Op::Call, no_var, std::move(args), e.loc).builtin =
        row_of_body("shadeop_" + std::to_string(outputs.size()));
    write_back(back, e.loc);
    return result;
}

// Output formals and arrays are names of the actual variable. An array formal that is assigned
// without being output gets a copy.
void Lowering::bind_reference(const Symbol& formal, const Expr& arg, std::vector<WriteBack>& back) {
    const bool is_variable =
        arg.kind == ExprKind::Name || (arg.kind == ExprKind::Index && !arg.is_component);
    if (formal.array_length == 0 && !is_variable) { // what is set is lost
        const VarId given = value_as(arg, formal.type);
        emit(Op::Copy, local_for(formal), {given}, arg.loc);
        return;
    }
    if (formal.array_length == 0) {
        variables_[&formal] = output_argument(arg, back);
        return;
    }
    const VarId actual =
        formal.is_output ? assignable(*arg.symbol, arg.loc) : variable(*arg.symbol, arg.loc);
    variables_[&formal] = actual;
    if (formal.assigned && !formal.is_output) {
        const VarId copy = local(formal.name, formal.type, var(actual).array_length, formal.loc);
        emit(Op::Copy, copy, {actual}, arg.loc);
        variables_[&formal] = copy;
    }
}

VarId Lowering::inline_call(const Expr& e) {
    const Deeper deeper(*this, e.loc);
    const ast::Function& f = *e.function;
    std::vector<WriteBack> back;
    // All arguments are evaluated before any formal is bound, since they may call the same
    // function.
    std::vector<VarId> given(e.args.size(), no_var);
    for (std::size_t i = 0; i < e.args.size(); ++i) {
        if (!f.formals[i]->is_output && f.formals[i]->array_length == 0) {
            given[i] = protect(value(*e.args[i]), e.args[i]->loc);
        }
    }
    for (std::size_t i = 0; i < e.args.size(); ++i) {
        if (given[i] != no_var) {
            emit(Op::Copy, local_for(*f.formals[i]), {given[i]}, e.args[i]->loc);
        } else {
            bind_reference(*f.formals[i], *e.args[i], back);
        }
    }
    const VarId outer_result = result_;
    result_ = no_var;
    if (e.type != Type::Void) {
        result_ = local(f.name + "_result", e.type, 0, e.loc);
        emit(Op::Copy, result_, {zero(e.type)}, e.loc);
    }
    body(f.body);
    const VarId result = result_;
    result_ = outer_result;
    write_back(back, e.loc);
    return result;
}

} // namespace slc
