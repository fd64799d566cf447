// SPDX-License-Identifier: Apache-2.0
// Differences of operations: D(f(a, b)) = f(a + Da, b + Db) - f(a, b), in forms without
// cancellation (docs/area_operators.md lists them). no_var is a difference of 0.
#include "slc/ir_util.h"
#include "slc/propagation.h"

#include <algorithm>

namespace slc {

namespace {

std::size_t at(int axis) {
    return static_cast<std::size_t>(axis);
}

} // namespace

// `result` holds the main value; the operands still have theirs.
VarId Propagation::rule(const Stmt& s, const std::vector<Dual>& a, VarId result, int axis) {
    const auto d = [&](std::size_t i) { return a[i].d[at(axis)]; };
    switch (s.op) {
    case Op::Copy:
        return d(0);
    case Op::Add:
    case Op::Sub:
        return sum_rule(s, a, axis);
    case Op::Neg:
        return d(0) == no_var ? no_var : value(Op::Neg, var(d(0)).type, {d(0)});
    case Op::Mul:
        return product_rule(Op::Mul, var(result).type, a[0], a[1], axis);
    case Op::Dot:
        return product_rule(Op::Dot, Type::Float, a[0], a[1], axis);
    case Op::Cross:
        return product_rule(Op::Cross, Type::Vector, a[0], a[1], axis);
    case Op::Div:
        return quotient_rule(s, a, result, axis);
    case Op::Select:
        return select_rule(s, a, axis);
    case Op::Triple:
    case Op::Matrix16:
        return compose_rule(s, a, axis);
    case Op::Component:
    case Op::Load:
        return element_rule(s, a, result, axis);
    default:
        return no_var;
    }
}

VarId Propagation::sum_rule(const Stmt& s, const std::vector<Dual>& a, int axis) {
    const VarId p = a[0].d[at(axis)], q = a[1].d[at(axis)];
    if (q == no_var) {
        return p;
    }
    if (p == no_var) {
        return s.op == Op::Add ? q : value(Op::Neg, var(q).type, {q});
    }
    const Type type = var(p).type == Type::Float ? var(q).type : var(p).type;
    return value(s.op, type, {p, q});
}

// D(ab) = Da (b + Db) + a Db; the order counts for matrices and the cross product.
VarId Propagation::product_rule(Op op, Type type, const Dual& a, const Dual& b, int axis) {
    const VarId p = a.d[at(axis)], q = b.d[at(axis)];
    const VarId second = q == no_var ? no_var : value(op, type, {a.value, q});
    if (p == no_var) {
        return second;
    }
    const VarId first = value(op, type, {p, moved(b, axis)});
    return second == no_var ? first : value(Op::Add, type, {first, second});
}

// D(a/b) = (Da - (a/b) Db) / (b + Db); 0 where either denominator is 0, as no difference is finite
// there. By component where the denominator is a triple.
VarId Propagation::quotient_rule(const Stmt& s, const std::vector<Dual>& a, VarId result,
                                 int axis) {
    const Type type = var(s.dst).type;
    const VarId p = a[0].d[at(axis)], q = a[1].d[at(axis)];
    if (q == no_var) {
        const VarId exact = value(Op::Div, type, {p, a[1].value});
        return type == Type::Matrix ? exact : guarded_quotient(exact, a[1].value, no_var);
    }
    if (type == Type::Matrix) {
        const VarId there = value(Op::Div, type, {moved(a[0], axis), moved(a[1], axis)});
        return minus(there, result);
    }
    const VarId loss = value(Op::Mul, type, {result, q});
    const VarId top = p == no_var ? value(Op::Neg, type, {loss}) : value(Op::Sub, type, {p, loss});
    const VarId below = moved(a[1], axis);
    return guarded_quotient(value(Op::Div, type, {top, below}), a[1].value, below);
}

VarId Propagation::guarded_quotient(VarId exact, VarId below, VarId below_there) {
    const Type type = var(exact).type;
    const VarId zero_f = constant(Type::Float, 0);
    if (is_triple(var(below).type)) {
        std::vector<VarId> parts;
        for (int i = 0; i < 3; ++i) {
            const auto part = [&](VarId id) {
                return value(Op::Component, Type::Float,
                             {id, constant(Type::Float, static_cast<float>(i))});
            };
            parts.push_back(guarded_quotient(part(exact), part(below),
                                             below_there == no_var ? no_var : part(below_there)));
        }
        return value(Op::Triple, type, parts);
    }
    VarId bad = value(Op::Eq, Type::Float, {below, zero_f});
    if (below_there != no_var) {
        bad = value(Op::Or, Type::Float, {bad, value(Op::Eq, Type::Float, {below_there, zero_f})});
    }
    return value(Op::Select, type, {bad, constant(type, 0), exact});
}

// What the other point chooses, minus what the main point chose.
VarId Propagation::select_rule(const Stmt& s, const std::vector<Dual>& a, int axis) {
    const Type type = var(s.dst).type;
    const VarId none = constant(type, 0);
    const VarId p = a[1].d[at(axis)] == no_var ? none : a[1].d[at(axis)];
    const VarId q = a[2].d[at(axis)] == no_var ? none : a[2].d[at(axis)];
    const VarId here = a[0].value;
    if (!analysis_.differs(s.args[0], axis)) {
        return p == none && q == none ? no_var : value(Op::Select, type, {here, p, q});
    }
    const VarId there = condition_at(s.args[0], axis);
    const VarId delta = minus(a[1].value, a[2].value);
    const VarId to_first = p == none ? delta : value(Op::Add, type, {p, delta});
    const VarId to_second = value(Op::Sub, type, {q, delta});
    return value(Op::Select, type,
                 {there, value(Op::Select, type, {here, p, to_first}),
                  value(Op::Select, type, {here, to_second, q})});
}

VarId Propagation::compose_rule(const Stmt& s, const std::vector<Dual>& a, int axis) {
    std::vector<VarId> parts;
    for (const Dual& x : a) {
        const VarId d = x.d[at(axis)];
        parts.push_back(d == no_var ? constant(Type::Float, 0) : d);
    }
    return value(s.op, var(s.dst).type, parts);
}

// Component and Load. Where the index differs, the element there against the element here.
VarId Propagation::element_rule(const Stmt& s, const std::vector<Dual>& a, VarId result, int axis) {
    const Type type = var(s.dst).type;
    const VarId p = a[0].d[at(axis)], q = a[1].d[at(axis)];
    if (q == no_var) {
        return p == no_var ? no_var : value(s.op, type, {p, a[1].value});
    }
    const VarId index = moved(a[1], axis);
    const VarId apart = minus(value(s.op, type, {a[0].value, index}), result);
    return p == no_var ? apart : value(Op::Add, type, {apart, value(s.op, type, {p, index})});
}

// array[i] = x. Where the index differs, the element i keeps its old value at the other point and
// the element there gets the new one.
void Propagation::store(const Stmt& s) {
    const VarId array = current(s.dst);
    const Dual index = read(s.args[0]), x = read(s.args[1]);
    const Type type = var(array).type;
    Pair old = {no_var, no_var}; // value at the other point of the element that is overwritten
    for (int axis = 0; axis < 2; ++axis) {
        if (analysis_.differs(s.dst, axis) && index.d[at(axis)] != no_var) {
            const VarId was = value(Op::Load, type, {array, index.value});
            const VarId d = value(Op::Load, type, {difference_of(array, axis), index.value});
            old[at(axis)] = value(Op::Add, type, {minus(was, x.value), d});
        }
    }
    out_->push_back(mapped(s));
    for (int axis = 0; axis < 2; ++axis) {
        if (!analysis_.differs(s.dst, axis)) {
            continue;
        }
        const VarId to = difference_of(array, axis);
        const VarId d = x.d[at(axis)] == no_var ? constant(type, 0) : x.d[at(axis)];
        if (old[at(axis)] == no_var) {
            emit(Op::Store, to, {index.value, d});
            continue;
        }
        emit(Op::Store, to, {index.value, old[at(axis)]});
        const VarId there = moved(index, axis);
        const VarId apart = minus(x.value, value(Op::Load, type, {array, there}));
        emit(Op::Store, to, {there, value(Op::Add, type, {apart, d})});
    }
}

} // namespace slc
