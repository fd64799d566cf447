// SPDX-License-Identifier: Apache-2.0
// Expressions to IR. Every value is a variable: names deliver their own variable, operations a new
// temporary, or the variable the caller wants the result in.
#include "slc/ir_util.h"
#include "slc/lower.h"

#include <algorithm>

namespace slc {

using ast::Expr;
using ast::ExprKind;

bool has_effects(const Expr& e) {
    if (e.kind == ExprKind::Assign ||
        (e.kind == ExprKind::Call && (e.function != nullptr || e.external != nullptr))) {
        return true;
    }
    if (e.kind == ExprKind::Call && e.builtin >= 0) {
        for (const ArgSpec& spec : builtin_rows()[static_cast<std::size_t>(e.builtin)].args) {
            if (spec.is_output) {
                return true;
            }
        }
        for (std::size_t i = 0; i < e.args.size(); ++i) {
            if (sets_pair_at(e, i)) {
                return true;
            }
        }
    }
    return std::any_of(e.args.begin(), e.args.end(),
                       [](const Expr* arg) { return has_effects(*arg); });
}

namespace {

// Worth evaluating whether needed or not: a few operations without calls and assignments.
bool is_cheap(const Expr& e, int& budget) {
    if (--budget < 0 || e.kind == ExprKind::Call || e.kind == ExprKind::Assign ||
        (e.kind == ExprKind::Cast && !e.text.empty())) {
        return false;
    }
    return std::all_of(e.args.begin(), e.args.end(),
                       [&](const Expr* arg) { return is_cheap(*arg, budget); });
}

bool is_cheap(const Expr& e) {
    int budget = 8;
    return is_cheap(e, budget);
}

} // namespace

VarId Lowering::value(const Expr& e, VarId into) {
    const Deeper deeper(*this, e.loc);
    switch (e.kind) {
    case ExprKind::Number:
        return constant(static_cast<float>(e.number));
    case ExprKind::Text:
        return text(e.text);
    case ExprKind::Name:
        return e.symbol != nullptr ? variable(*e.symbol, e.loc) : constant(0);
    case ExprKind::Index:
        return index(e, into);
    case ExprKind::Call:
        return call(e, into);
    case ExprKind::Cast:
        return cast(e, into);
    case ExprKind::Unary:
        return unary(e, into);
    case ExprKind::Binary:
        return e.op == Op::And || e.op == Op::Or ? logical(e, into) : binary(e, into);
    case ExprKind::Ternary:
        return ternary(e, into);
    case ExprKind::Assign:
        return assign(e);
    case ExprKind::Tuple:
        return tuple(e, into);
    }
    return no_var;
}

// `into` if it can hold the type as it is, else a new temporary.
VarId Lowering::target(Type type, VarId into, Loc loc) {
    const bool fits =
        into != no_var && same_class(var(into).type, type) && var(into).array_length == 0;
    return fits ? into : temp(type, loc);
}

VarId Lowering::convert(VarId id, Type wanted, Loc loc) {
    const Type from = var(id).type;
    if (wanted == Type::Float && is_triple(from)) { // what the checker let pass with a warning
        return component_of(id, {constant(0)}, no_var, loc);
    }
    if (same_class(from, wanted) || from != Type::Float) {
        return id;
    }
    if (var(id).kind == VarKind::Const && is_triple(wanted)) {
        return constant(wanted, std::vector<float>(3, var(id).values[0]));
    }
    const VarId result = temp(wanted, loc);
    emit(Op::Copy, result, {id}, loc);
    return result;
}

VarId Lowering::value_as(const Expr& e, Type wanted) {
    return convert(value(e), wanted, e.loc);
}

void Lowering::store_into(const Expr& e, VarId dst) {
    VarId result = value(e, dst);
    if (result != no_var && var(dst).type == Type::Float) {
        result = convert(result, Type::Float, e.loc);
    }
    if (result != dst && result != no_var) {
        emit(Op::Copy, dst, {result}, e.loc);
    }
}

// A value that later evaluation cannot change.
VarId Lowering::protect(VarId id, Loc loc) {
    const Var& v = var(id);
    if (v.kind == VarKind::Const || v.kind == VarKind::Temp || v.array_length != 0) {
        return id;
    }
    const VarId copy = temp(v.type, loc);
    emit(Op::Copy, copy, {id}, loc);
    return copy;
}

// Left to right; a value is protected if an operand after it may change variables.
std::vector<VarId> Lowering::operands(const std::vector<Expr*>& list,
                                      const std::vector<Type>& types) {
    std::vector<VarId> ids;
    for (std::size_t i = 0; i < list.size(); ++i) {
        VarId id = value_as(*list[i], types[i]);
        const bool changes_later =
            std::any_of(list.begin() + static_cast<std::ptrdiff_t>(i) + 1, list.end(),
                        [](const Expr* e) { return has_effects(*e); });
        ids.push_back(changes_later ? protect(id, list[i]->loc) : id);
    }
    return ids;
}

VarId Lowering::unary(const Expr& e, VarId into) {
    const VarId operand = value(*e.args[0]);
    const VarId result = target(e.type, into, e.loc);
    emit(e.op, result, {operand}, e.loc);
    return result;
}

// A float beside a matrix stands for a diagonal; other mixtures the IR takes as they are.
VarId Lowering::arithmetic(Op op, VarId left, VarId right, Type result, VarId into, Loc loc) {
    if (var(left).type == Type::Matrix || var(right).type == Type::Matrix) {
        left = convert(left, Type::Matrix, loc);
        right = convert(right, Type::Matrix, loc);
    }
    const VarId dst = target(result, into, loc);
    emit(op, dst, {left, right}, loc);
    return dst;
}

VarId Lowering::binary(const Expr& e, VarId into) {
    VarId left = value(*e.args[0]);
    if (has_effects(*e.args[1])) {
        left = protect(left, e.loc);
    }
    const VarId right = value(*e.args[1]);
    return arithmetic(e.op, left, right, e.type, into, e.loc);
}

// && and ||: the right operand is evaluated only where it decides, unless it is as cheap as the
// branch.
VarId Lowering::logical(const Expr& e, VarId into) {
    VarId left = value_as(*e.args[0], Type::Float);
    if (is_cheap(*e.args[1])) {
        const VarId right = value_as(*e.args[1], Type::Float);
        const VarId result = target(Type::Float, into, e.loc);
        emit(e.op, result, {left, right}, e.loc);
        return result;
    }
    const VarId result = local(e.op == Op::And ? "and" : "or", Type::Float, 0, e.loc);
    emit(Op::Ne, result, {left, constant(0)}, e.loc);
    Block decide = block([&] {
        const VarId right = value_as(*e.args[1], Type::Float);
        emit(Op::Ne, result, {right, constant(0)}, e.loc);
    });
    Stmt& s = emit(Op::If, no_var, {result}, e.loc);
    s.bodies.resize(2);
    s.bodies[e.op == Op::And ? 0 : 1] = std::move(decide);
    return result;
}

VarId Lowering::ternary(const Expr& e, VarId into) {
    const VarId condition = value_as(*e.args[0], Type::Float);
    if (is_cheap(*e.args[1]) && is_cheap(*e.args[2])) {
        const VarId a = value_as(*e.args[1], e.type);
        const VarId b = value_as(*e.args[2], e.type);
        const VarId result = target(e.type, into, e.loc);
        emit(Op::Select, result, {condition, a, b}, e.loc);
        return result;
    }
    const VarId result = local("choice", e.type, 0, e.loc);
    Block then = block([&] { store_into(*e.args[1], result); });
    Block otherwise = block([&] { store_into(*e.args[2], result); });
    Stmt& s = emit(Op::If, no_var, {condition}, e.loc);
    s.bodies.push_back(std::move(then));
    s.bodies.push_back(std::move(otherwise));
    return result;
}

VarId Lowering::tuple(const Expr& e, VarId into) {
    const bool is_matrix = e.args.size() == 16;
    const std::vector<VarId> parts =
        operands(e.args, std::vector<Type>(e.args.size(), Type::Float));
    const Type type = is_matrix ? Type::Matrix : e.type;
    if (std::all_of(parts.begin(), parts.end(),
                    [&](VarId p) { return var(p).kind == VarKind::Const; })) {
        std::vector<float> values;
        for (const VarId p : parts) {
            values.push_back(var(p).values[0]);
        }
        return constant(type, std::move(values));
    }
    const VarId result = target(type, into, e.loc);
    emit(is_matrix ? Op::Matrix16 : Op::Triple, result, parts, e.loc);
    return result;
}

// The value in the cast's type; a space converts from that space to current (colors: to rgb),
// sl.md 1.4.
VarId Lowering::cast(const Expr& e, VarId into) {
    const Expr& operand = *e.args[0];
    const bool keeps_space =
        e.text.empty() || e.text == (e.type == Type::Color ? "rgb" : "current");
    if (keeps_space) {
        return convert(value(operand, same_class(operand.type, e.type) ? into : no_var), e.type,
                       e.loc);
    }
    const VarId plain = value_as(operand, e.type);
    const VarId space = text(e.text);
    switch (e.type) {
    case Type::Color:
        return builtin_by_body("ctransform_from_to", {space, text("rgb"), plain}, e.type, e.loc);
    case Type::Point:
        return builtin_by_body("transform_from_to", {space, text("current"), plain}, e.type, e.loc);
    case Type::Vector:
        return builtin_by_body("vtransform_from_to", {space, text("current"), plain}, e.type,
                               e.loc);
    case Type::Normal:
        return builtin_by_body("ntransform_from_to", {space, text("current"), plain}, e.type,
                               e.loc);
    case Type::Matrix:
        return builtin_by_body("mtransform_from_to", {space, text("current"), plain}, e.type,
                               e.loc);
    default:
        return plain;
    }
}

VarId Lowering::index(const Expr& e, VarId into) {
    if (e.symbol == nullptr) {
        return constant(0);
    }
    if (e.is_component) {
        return component(e, into);
    }
    const VarId at = value_as(*e.args[0], Type::Float);
    const VarId array = variable(*e.symbol, e.loc);
    const VarId result = target(e.symbol->type, into, e.loc);
    emit(Op::Load, result, {array, at}, e.loc);
    return result;
}

VarId Lowering::assign(const Expr& e) {
    const Expr& left = *e.args[0];
    if (left.symbol == nullptr) {
        return constant(0);
    }
    if (left.kind == ExprKind::Index) {
        return left.is_component ? assign_component(e) : assign_element(e);
    }
    if (left.symbol->array_length != 0) {
        emit(Op::Copy, assignable(*left.symbol, left.loc), {variable(*e.args[1]->symbol, e.loc)},
             e.loc);
        return no_var;
    }
    const VarId dst = assignable(*left.symbol, left.loc);
    if (e.op == Op::Copy) {
        store_into(*e.args[1], dst);
        return dst;
    }
    const VarId right = value(*e.args[1]);
    const VarId result = arithmetic(e.op, dst, right, compound_type(e), dst, e.loc);
    if (result != dst) {
        emit(Op::Copy, dst, {result}, e.loc);
    }
    return dst;
}

// Type in which `lv op= e` computes, from the operand types the checker chose.
Type Lowering::compound_type(const Expr& e) const {
    const Type l = e.operand_types[0];
    const Type r = e.operand_types[1];
    return l == Type::Matrix || r == Type::Matrix ? Type::Matrix : is_triple(l) ? l : r;
}

// array[i] = e, array[i] op= e: the index is evaluated once.
VarId Lowering::assign_element(const Expr& e) {
    const Expr& left = *e.args[0];
    const Type type = left.symbol->type;
    VarId at = value_as(*left.args[0], Type::Float);
    if (has_effects(*e.args[1])) {
        at = protect(at, e.loc);
    }
    const VarId array = assignable(*left.symbol, left.loc);
    VarId result = no_var;
    if (e.op == Op::Copy) {
        result = value_as(*e.args[1], type);
    } else {
        const VarId right = value(*e.args[1]);
        const VarId old = temp(type, e.loc);
        emit(Op::Load, old, {array, at}, e.loc);
        result =
            convert(arithmetic(e.op, old, right, compound_type(e), no_var, e.loc), type, e.loc);
    }
    emit(Op::Store, array, {at, result}, e.loc);
    return result;
}

// comp(c, i) or comp(m, row, column)
VarId Lowering::component_of(VarId whole, const std::vector<VarId>& at, VarId into, Loc loc) {
    std::vector<VarId> args = {whole};
    args.insert(args.end(), at.begin(), at.end());
    const VarId result = target(Type::Float, into, loc);
    emit(Op::Call, result, std::move(args), loc).builtin =
        row_of_body(at.size() == 2 ? "comp_m" : "comp_3");
    return result;
}

// c[i], m[i][j], a[k][i]: in an array the first index picks the element
VarId Lowering::component(const Expr& e, VarId into) {
    std::vector<VarId> at = operands(e.args, std::vector<Type>(e.args.size(), Type::Float));
    VarId whole = variable(*e.symbol, e.loc);
    if (e.symbol->array_length != 0) {
        const VarId element = temp(e.symbol->type, e.loc);
        emit(Op::Load, element, {whole, at[0]}, e.loc);
        whole = element;
        at.erase(at.begin());
    }
    return component_of(whole, at, into, e.loc);
}

VarId Lowering::assign_component(const Expr& e) {
    const Expr& left = *e.args[0];
    const Type type = left.symbol->type;
    std::vector<VarId> at;
    for (const Expr* index : left.args) {
        at.push_back(protect(value_as(*index, Type::Float), index->loc));
    }
    const VarId right = protect(value_as(*e.args[1], Type::Float), e.loc);
    const VarId variable = assignable(*left.symbol, left.loc);
    const bool is_array = left.symbol->array_length != 0;
    VarId whole = variable;
    const VarId element_at = at[0];
    if (is_array) {
        whole = local("element", type, 0, e.loc);
        emit(Op::Load, whole, {variable, element_at}, e.loc);
        at.erase(at.begin());
    }
    VarId part = right;
    if (e.op != Op::Copy) {
        const VarId old = component_of(whole, at, no_var, e.loc);
        part = arithmetic(e.op, old, right, Type::Float, no_var, e.loc);
    }
    std::vector<VarId> args = {whole};
    args.insert(args.end(), at.begin(), at.end());
    args.push_back(part);
    emit(Op::Call, no_var, std::move(args), e.loc).builtin =
        row_of_body(at.size() == 2 ? "setcomp_m" : "setcomp_3");
    if (is_array) {
        emit(Op::Store, variable, {element_at, whole}, e.loc);
    }
    return part;
}

} // namespace slc
