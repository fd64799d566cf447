// SPDX-License-Identifier: Apache-2.0
// Types of expressions, sl.md 1.4, 2.2 and 2.4: costs from the leaves up, then delivery from the
// root down.
#include "slc/check.h"

#include <algorithm>

namespace slc {

using ast::Costs;
using ast::Expr;
using ast::ExprKind;
using ast::no_cost;
using ast::op_text;
using ast::Symbol;
using ast::SymbolKind;

namespace {

// Where several operand types are equally cheap: float first (sl.md 2.4 rule 3), a bare triple is a
// point.
constexpr Type preference[] = {Type::Float, Type::Point,  Type::Vector, Type::Normal,
                               Type::Color, Type::Matrix, Type::String};

std::uint8_t add(unsigned a, unsigned b) {
    return a == no_cost || b == no_cost ? no_cost
                                        : static_cast<std::uint8_t>(std::min(a + b, 254u));
}

bool is_comparison(Op op) {
    return op >= Op::Eq && op <= Op::Ge;
}

// Types of sums and differences of points, vectors and normals.
Type pvn_result(Op op, Type l, Type r) {
    if (op == Op::Mul || op == Op::Div || l == r) {
        return op == Op::Sub && l == Type::Point && r == Type::Point ? Type::Vector : l;
    }
    return l == Type::Point || r == Type::Point ? Type::Point : Type::Vector;
}

Type arithmetic_result(Op op, Type l, Type r) {
    if (l == Type::Matrix || r == Type::Matrix) {
        const bool both =
            (l == Type::Matrix || l == Type::Float) && (r == Type::Matrix || r == Type::Float);
        return both && (op == Op::Mul || op == Op::Div) ? Type::Matrix : Type::Void;
    }
    if (l == Type::String || r == Type::String) {
        return Type::Void;
    }
    if (l == Type::Float || r == Type::Float) {
        return l == Type::Float ? r : l;
    }
    if (l == Type::Color || r == Type::Color) {
        return l == r ? l : Type::Void;
    }
    return pvn_result(op, l, r);
}

Type comparison_result(Op op, Type l, Type r) {
    const bool ordered = op != Op::Eq && op != Op::Ne;
    if (l == Type::String || r == Type::String) {
        return l == r && !ordered ? Type::Float : Type::Void;
    }
    if (l == Type::Matrix || r == Type::Matrix) {
        return !ordered && arithmetic_result(Op::Mul, l, r) == Type::Matrix ? Type::Float
                                                                            : Type::Void;
    }
    return arithmetic_result(Op::Add, l, r) == Type::Void ? Type::Void : Type::Float;
}

// Result of l op r, or Void when the operator does not take them.
Type binary_result(Op op, Type l, Type r) {
    switch (op) {
    case Op::And:
    case Op::Or:
        return l == Type::Float && r == Type::Float ? Type::Float : Type::Void;
    case Op::Dot:
    case Op::Cross: {
        const bool fits = (is_pvn(l) && is_pvn(r)) || (l == Type::Color && r == Type::Color);
        if (!fits) {
            return Type::Void;
        }
        return op == Op::Dot ? Type::Float : (l == Type::Color ? Type::Color : Type::Vector);
    }
    default:
        return is_comparison(op) ? comparison_result(op, l, r) : arithmetic_result(op, l, r);
    }
}

std::string describe(const Costs& costs) {
    for (const Type t : preference) {
        if (costs[t] != no_cost) {
            return std::string(type_name(t));
        }
    }
    return "void";
}

} // namespace

std::uint8_t conversion_cost(Type from, Type to) {
    if (from == to) {
        return 0;
    }
    if (is_pvn(from) && is_pvn(to)) {
        return 1;
    }
    if (from != Type::Float) {
        return is_triple(from) && is_triple(to) ? last_resort : no_cost;
    }
    return is_pvn(to) ? 8 : to == Type::Color ? 9 : to == Type::Matrix ? 10 : no_cost;
}

void Checker::fail(Expr& e, std::string_view text) {
    messages_.error(e.loc, text);
    e.costs.failed = true;
}

const Costs& Checker::costs(Expr& e) {
    if (e.costs.known) {
        return e.costs;
    }
    e.costs.known = true;
    switch (e.kind) {
    case ExprKind::Number:
        e.costs[Type::Float] = 0;
        break;
    case ExprKind::Text:
        e.costs[Type::String] = 0;
        break;
    case ExprKind::Name:
        name_costs(e);
        break;
    case ExprKind::Index:
        index_costs(e);
        break;
    case ExprKind::Call:
        call_costs(e);
        break;
    case ExprKind::Cast:
        cast_costs(e);
        break;
    case ExprKind::Unary:
        unary_costs(e);
        break;
    case ExprKind::Binary:
        binary_costs(e);
        break;
    case ExprKind::Ternary:
        ternary_costs(e);
        break;
    case ExprKind::Assign:
        assign_costs(e);
        break;
    case ExprKind::Tuple:
        tuple_costs(e);
        break;
    }
    if (e.channel != nullptr && e.kind != ExprKind::Text && e.kind != ExprKind::Name &&
        e.kind != ExprKind::Index) {
        fail(*e.channel, "a texture channel follows the name of a texture");
    }
    return e.costs;
}

// Looks the name up once; predefined variables and those of enclosing functions need extern, by the
// rules.
void Checker::resolve_name(Expr& e) {
    if (e.symbol != nullptr) {
        return;
    }
    const Scopes::Found found = scopes_.find(e.text);
    e.symbol = found.symbol;
    if (found.symbol == nullptr) {
        if (!e.costs.failed) {
            const auto names = scopes_.variable_names();
            fail(e, quoted(e.text) + " is not declared" + spelling_hint(e.text, names));
        }
        return;
    }
    if (found.beyond_function && warned_extern_.emplace(function_, e.text).second) {
        messages_.warning(e.loc, quoted(e.text) + " is not declared in function " +
                                     quoted(function_->name) +
                                     "; the outer variable is used, as with 'extern'");
    }
}

void Checker::name_costs(Expr& e) {
    resolve_name(e);
    if (e.symbol == nullptr) {
        return;
    }
    if (e.symbol->array_length != 0) {
        fail(e, "array " + quoted(e.text) + " is used without an index");
        return;
    }
    e.costs[e.symbol->type] = 0;
}

void Checker::index_costs(Expr& e) {
    deliver(*e.args[0], Type::Float, "an index");
    resolve_name(e);
    if (e.symbol == nullptr) {
        return;
    }
    const bool is_array = e.symbol->array_length != 0;
    if (is_array && e.args.size() == 1) {
        e.costs[e.symbol->type] = 0;
        return;
    }
    component_costs(e);
}

// c[i], m[row][column], array_of_points[k][i]: as later versions of the language have it.
void Checker::component_costs(Expr& e) {
    const bool is_array = e.symbol->array_length != 0;
    const std::size_t wanted = e.symbol->type == Type::Matrix ? 2 : 1;
    const bool has_parts = is_triple(e.symbol->type) || (!is_array && wanted == 2);
    if (!has_parts || e.args.size() != wanted + (is_array ? 1 : 0)) {
        fail(e, is_array ? "an element of array " + quoted(e.text) + " takes no more indices"
                         : quoted(e.text) + " is not an array");
        return;
    }
    if (e.args.size() == 2) {
        deliver(*e.args[1], Type::Float, "an index");
    }
    e.is_component = true;
    e.costs[Type::Float] = 0;
}

// A cast is decisive: it picks the overload that gives its type, and only then converts
// (sl.md 1.4, 2.4).
void Checker::cast_costs(Expr& e) {
    Expr& operand = *e.args[0];
    const Costs& c = costs(operand);
    const bool triple = is_triple(e.type);
    e.costs[e.type] = 0;
    if (c.failed) {
        return;
    }
    if (cost_to(operand, e.type) < last_resort) {
        deliver(operand, e.type, "the operand of a cast");
        return;
    }
    for (const Type from : {Type::Color, Type::Point, Type::Vector, Type::Normal}) {
        if (triple && c[from] != no_cost) { // color <-> point only with a cast
            settle(operand, from);
            return;
        }
    }
    e.costs.failed = true;
    messages_.error(e.loc, "cannot cast " + describe(c) + " to " + std::string(type_name(e.type)));
}

void Checker::unary_costs(Expr& e) {
    Expr& operand = *e.args[0];
    const Costs& c = costs(operand);
    if (c.failed) {
        e.costs.failed = true;
        return;
    }
    Type best = Type::Void;
    for (const Type t : preference) {
        const bool fits = e.op == Op::Not ? t == Type::Float : t == Type::Float || is_triple(t);
        best = fits && c[t] < (best == Type::Void ? no_cost : c[best]) ? t : best;
    }
    if (best == Type::Void) {
        fail(e, "operator " + std::string(op_text(e.op)) + " does not take " + describe(c));
        return;
    }
    e.operand_types[0] = best;
    e.costs[best] = 0;
    settle(operand, best);
}

// The cheapest pair of operand types the operator takes, sl.md 2.4 rule 3.
Checker::Operands Checker::choose_operands(Op op, Expr& left, Expr& right) {
    const Costs& l = costs(left);
    const Costs& r = costs(right);
    Operands best;
    unsigned best_cost = 1000;
    for (const Type lt : preference) {
        for (const Type rt : preference) {
            const Type result = binary_result(op, lt, rt);
            if (result == Type::Void || l[lt] == no_cost || r[rt] == no_cost) {
                continue;
            }
            const bool mixed_pvn = lt != rt && is_pvn(lt) && is_pvn(rt);
            // A comparison with a triple takes both as triples, if a call offers the choice.
            const bool spread = is_comparison(op) && (lt == Type::Float) != (rt == Type::Float);
            const bool no_vector =
                (op == Op::Dot || op == Op::Cross) && (lt == Type::Color || rt == Type::Color);
            const unsigned cost =
                4u * (l[lt] + r[rt]) + (mixed_pvn ? 1 : 0) + (spread ? 2 : 0) + (no_vector ? 2 : 0);
            if (cost < best_cost) {
                best_cost = cost;
                best = {lt, rt, result};
            }
        }
    }
    return best;
}

void Checker::binary_costs(Expr& e) {
    Expr& left = *e.args[0];
    Expr& right = *e.args[1];
    const bool left_failed = costs(left).failed; // report errors of both sides
    const bool failed = costs(right).failed || left_failed;
    if (failed) {
        e.costs.failed = true;
        return;
    }
    Operands chosen = choose_operands(e.op, left, right);
    if (chosen.result == Type::Void && cast_mixed_operand(e)) {
        chosen = choose_operands(e.op, *e.args[0], *e.args[1]);
    }
    if (chosen.result == Type::Void) {
        std::string text = "operator " + std::string(op_text(e.op)) + " does not take " +
                           describe(costs(left)) + " and " + describe(costs(right));
        const bool mixes =
            (costs(left)[Type::Color] != no_cost) != (costs(right)[Type::Color] != no_cost);
        fail(e, text + (mixes ? "; cast one of them" : ""));
        return;
    }
    if ((e.op == Op::Eq || e.op == Op::Ne) && left.kind == ExprKind::Unary && left.op == Op::Not) {
        messages_.warning(
            left.loc,
            "'!' applies to the left operand only; write !(a == b) for the other meaning");
    }
    e.operand_types[0] = chosen.left;
    e.operand_types[1] = chosen.right;
    e.costs[chosen.result] = 0;
    settle(*e.args[0], chosen.left);
    settle(*e.args[1], chosen.right);
}

// A color beside a point: the language has no operator for them; the right operand is taken as the
// type of the left, for products and the like the point as a color.
bool Checker::cast_mixed_operand(Expr& e) {
    const auto kind = [&](Expr& operand) {
        const Costs& c = costs(operand);
        Type best = Type::Void;
        for (const Type t : {Type::Color, Type::Point, Type::Vector, Type::Normal}) {
            if (c[t] < (best == Type::Void ? no_cost : c[best])) {
                best = t;
            }
        }
        return best;
    };
    const Type left = kind(*e.args[0]);
    const Type right = kind(*e.args[1]);
    const bool mixed =
        (left == Type::Color && is_pvn(right)) || (is_pvn(left) && right == Type::Color);
    if (!mixed) {
        return false;
    }
    // What is assigned keeps its type; otherwise the geometry gives way.
    const bool odd_is_right = e.kind == ExprKind::Assign || left == Type::Color;
    Expr*& odd = e.args[odd_is_right ? 1 : 0];
    const Type kept = odd_is_right ? left : right;
    messages_.warning(e.loc, "operator " + std::string(op_text(e.op)) + " does not take " +
                                 std::string(type_name(left)) + " and " +
                                 std::string(type_name(right)) + "; the " +
                                 std::string(type_name(odd_is_right ? right : left)) +
                                 " is taken as a " + std::string(type_name(kept)));
    Expr& cast = file_.exprs.emplace_back();
    cast.kind = ExprKind::Cast;
    cast.loc = odd->loc;
    cast.type = kept;
    cast.args = {odd};
    odd = &cast;
    return true;
}

// Both values must reach a common type; the request from outside passes through to them.
void Checker::ternary_costs(Expr& e) {
    deliver(*e.args[0], Type::Float, "a condition");
    const Costs& a = costs(*e.args[1]);
    const Costs& b = costs(*e.args[2]);
    if (a.failed || b.failed) {
        e.costs.failed = true;
        return;
    }
    bool any = false;
    for (const Type t : preference) {
        if (a[t] != no_cost || b[t] != no_cost) {
            e.costs[t] = add(cost_to(*e.args[1], t), cost_to(*e.args[2], t));
            any = any || e.costs[t] != no_cost;
        }
    }
    if (!any) {
        fail(e, "the two values of '?' have types without a common one: " + describe(a) + " and " +
                    describe(b));
    }
}

void Checker::tuple_costs(Expr& e) {
    for (Expr* element : e.args) {
        deliver(*element, Type::Float, "a value in parentheses");
    }
    if (e.args.size() == 16) {
        e.costs[Type::Matrix] = 0;
        return;
    }
    for (const Type t : {Type::Color, Type::Point, Type::Vector, Type::Normal}) {
        e.costs[t] = 1;
    }
}

// Warns about what the rules forbid but shaders do; lowering makes the local copy.
void Checker::mark_assigned(Expr& target) {
    Symbol* symbol = target.symbol;
    if (symbol == nullptr) {
        return;
    }
    symbol->assigned = true;
    if (symbol->kind == SymbolKind::Pi) {
        messages_.error(target.loc, "PI is a constant");
        return;
    }
    const bool formal = symbol->kind == SymbolKind::Formal;
    if ((formal || symbol->kind == SymbolKind::Param) && !symbol->is_output &&
        warned_assigned_.insert(symbol).second) {
        messages_.warning(target.loc, std::string(formal ? "formal " : "parameter ") +
                                          quoted(symbol->name) +
                                          " is not 'output'; a local copy is assigned");
    }
}

Symbol* Checker::array_of(Expr& e) {
    if (e.kind != ExprKind::Name) {
        return nullptr;
    }
    resolve_name(e);
    return e.symbol != nullptr && e.symbol->array_length != 0 ? e.symbol : nullptr;
}

// Whole arrays: equal types and lengths.
bool Checker::assign_array(Expr& e) {
    Symbol* target = array_of(*e.args[0]);
    if (target == nullptr) {
        return false;
    }
    const Symbol* source = array_of(*e.args[1]);
    const bool fits =
        source != nullptr && source->type == target->type && e.op == Op::Copy &&
        (source->array_length == target->array_length ||
         source->array_length == ast::unsized_array || target->array_length == ast::unsized_array);
    if (!fits) {
        fail(e, "array " + quoted(target->name) +
                    " takes an array of the same type and length, or use an index");
    }
    mark_assigned(*e.args[0]);
    e.costs.failed = true; // an array assignment has no value
    return true;
}

void Checker::assign_costs(Expr& e) {
    if (assign_array(e)) {
        return;
    }
    Expr& target = *e.args[0];
    Expr& value = *e.args[1];
    if (costs(target).failed) {
        costs(value);
        e.costs.failed = true;
        return;
    }
    mark_assigned(target);
    const Type type = target.is_component ? Type::Float : target.symbol->type;
    target.type = type;
    e.costs[type] = 0;
    if (e.op == Op::Copy) {
        deliver(value, type, "the value of " + quoted(target.text));
        return;
    }
    if (costs(value).failed) {
        return;
    }
    Operands chosen = choose_operands(e.op, target, value);
    if (chosen.result == Type::Void && cast_mixed_operand(e)) {
        chosen = choose_operands(e.op, target, *e.args[1]);
    }
    if (chosen.result == Type::Void || conversion_cost(chosen.result, type) == no_cost) {
        fail(e, "operator " + std::string(op_text(e.op)) + "= does not take " +
                    std::string(type_name(type)) + " and " + describe(costs(value)));
        return;
    }
    e.operand_types[0] = chosen.left;
    e.operand_types[1] = chosen.right;
    settle(*e.args[1], chosen.right);
}

std::uint8_t Checker::cost_to(Expr& e, Type wanted) {
    const Costs& c = costs(e);
    if (c.failed) {
        return 0;
    }
    std::uint8_t best = no_cost;
    for (const Type t : preference) {
        best = std::min(best, add(c[t], conversion_cost(t, wanted)));
    }
    return best;
}

void Checker::deliver(Expr& e, Type wanted, std::string_view what) {
    if (array_of(e) != nullptr) {
        costs(e); // reports the missing index
        return;
    }
    const Costs& c = costs(e);
    if (c.failed) {
        return;
    }
    Type best_type = Type::Void;
    unsigned best = no_cost;
    for (const Type t : preference) {
        const unsigned cost = add(c[t], conversion_cost(t, wanted));
        if (cost < best || (cost == best && t == wanted && cost != no_cost)) {
            best = cost;
            best_type = t;
        }
    }
    if (best == no_cost && wanted == Type::Float && e.kind != ExprKind::Tuple &&
        c[Type::Color] < last_resort) {
        messages_.warning(e.loc, std::string(what) +
                                     " is float, but color is given; its first component is taken");
        settle(e, Type::Color);
        return;
    }
    if (best == no_cost) {
        const std::string from = describe(c);
        const bool castable =
            is_triple(wanted) && (c[Type::Color] != no_cost || c[Type::Point] != no_cost ||
                                  c[Type::Vector] != no_cost || c[Type::Normal] != no_cost);
        fail(e, std::string(what) + " is " + std::string(type_name(wanted)) + ", but " + from +
                    " is given" + (castable ? "; a cast would convert it" : ""));
        return;
    }
    if (best >= last_resort && c[best_type] < last_resort) {
        messages_.warning(e.loc, std::string(what) + " is " + std::string(type_name(wanted)) +
                                     ", but " + std::string(type_name(best_type)) +
                                     " is given; its components are taken as they are");
    }
    settle(e, best_type);
}

Type Checker::deliver_any(Expr& e, bool prefer_float) {
    const Costs& c = costs(e);
    if (c.failed) {
        return Type::Float;
    }
    if (e.kind == ExprKind::Call && !(prefer_float && c[Type::Float] != no_cost)) {
        settle_call(e, std::nullopt);
        return e.type;
    }
    Type best = Type::Void;
    for (const Type t : preference) {
        if (c[t] < (best == Type::Void ? no_cost : c[best])) {
            best = t;
        }
    }
    settle(e, best);
    return best;
}

void Checker::settle(Expr& e, Type natural) {
    switch (e.kind) {
    case ExprKind::Call:
        settle_call(e, natural);
        break;
    case ExprKind::Ternary:
        deliver(*e.args[1], natural, "a value of '?'");
        deliver(*e.args[2], natural, "a value of '?'");
        e.type = natural;
        break;
    default:
        e.type = natural;
        break;
    }
}

} // namespace slc
