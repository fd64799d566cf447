// SPDX-License-Identifier: Apache-2.0
// Variables and small pieces of code that the rules of propagation are made of.
#include "slc/propagation.h"

#include "slc/ir_util.h"

#include <algorithm>

namespace slc {

namespace {

void collect_written(const Block& b, std::unordered_set<VarId>& out) {
    for (const Stmt& s : b) {
        for_each_write(s, [&](VarId id, bool) { out.insert(id); });
        for (const Block& inner : s.bodies) {
            collect_written(inner, out);
        }
    }
}

bool is_condition(Op op) {
    return op >= Op::Eq && op <= Op::Not;
}

} // namespace

Propagation::Propagation(Program& program, const AuxAnalysis& analysis, const Liveness& slice)
    : program_(program), analysis_(analysis), slice_(slice) {
    for (std::size_t i = 0; i < program.vars.size(); ++i) {
        const Var& v = program.vars[i];
        current_.push_back(static_cast<VarId>(i));
        names_.insert(v.name);
        if (v.kind == VarKind::Global) {
            globals_.emplace(v.aux * SL_VAR_COUNT + v.index, static_cast<VarId>(i));
        }
    }
    collect_written(program.body, written_);
}

VarId Propagation::new_var(const Var& v) {
    program_.vars.push_back(v);
    return static_cast<VarId>(program_.vars.size() - 1);
}

VarId Propagation::fresh(const std::string& name, const Var& like, VarKind kind) {
    Var v;
    v.name = name;
    while (!names_.insert(v.name).second) {
        v.name = name + std::to_string(++name_counts_[name]);
    }
    v.type = like.type;
    v.array_length = like.array_length;
    v.kind = kind;
    v.loc = loc_;
    return new_var(v);
}

VarId Propagation::temp(Type type, int array_length) {
    Var like;
    like.type = type;
    like.array_length = array_length;
    const VarId id = fresh("d", like, array_length == 0 ? VarKind::Temp : VarKind::Local);
    loose_.insert(id);
    return id;
}

// All components alike.
VarId Propagation::constant(Type type, float value) {
    const std::string key = std::to_string(static_cast<int>(type)) + ":" + std::to_string(value);
    const auto it = constants_.find(key);
    if (it != constants_.end()) {
        return it->second;
    }
    Var like;
    like.type = type;
    const VarId id = fresh("same", like, VarKind::Const);
    Var& v = program_.vars[static_cast<std::size_t>(id)];
    v.detail = Detail::Uniform;
    v.values.assign(static_cast<std::size_t>(num_components(type)), value);
    v.loc = {};
    constants_.emplace(key, id);
    return id;
}

VarId Propagation::global(int variable, int aux) {
    const auto it = globals_.find(aux * SL_VAR_COUNT + variable);
    if (it != globals_.end()) {
        return it->second;
    }
    const VariableRow& row = variable_rows()[static_cast<std::size_t>(variable)];
    Var like;
    like.type = row.type;
    const std::string suffix = aux == 0 ? "" : aux == 1 ? "_u" : "_v";
    const VarId id = fresh(std::string(row.name) + suffix, like, VarKind::Global);
    Var& v = program_.vars[static_cast<std::size_t>(id)];
    v.detail = row.detail;
    v.index = variable;
    v.aux = aux;
    globals_.emplace(aux * SL_VAR_COUNT + variable, id);
    if (static_cast<std::size_t>(id) >= current_.size()) {
        current_.resize(static_cast<std::size_t>(id) + 1, no_var);
    }
    current_[static_cast<std::size_t>(id)] = id;
    return id;
}

VarId Propagation::difference(VarId source, int axis) {
    return analysis_.differs(source, axis) ? difference_of(current(source), axis) : no_var;
}

// The variable that holds the difference of `now`. What the program never assigns comes from the
// engine; the difference of u along u is du by definition.
VarId Propagation::difference_of(VarId now, int axis) {
    Pair& pair = differences_.try_emplace(now, Pair{no_var, no_var}).first->second;
    VarId& known = pair[static_cast<std::size_t>(axis)];
    if (known != no_var) {
        return known;
    }
    const Var v = var(now);
    VarId made = no_var;
    const bool is_input =
        (v.kind == VarKind::Global || v.kind == VarKind::Param) && !written_.contains(now);
    if (is_input && v.kind == VarKind::Global) {
        const bool is_parameter = v.index == SL_VAR_u || v.index == SL_VAR_v;
        made =
            is_parameter ? global(axis == 0 ? SL_VAR_du : SL_VAR_dv, 0) : global(v.index, axis + 1);
    } else if (is_input) {
        made = fresh(v.name + (axis == 0 ? "_u" : "_v"), v, VarKind::Param);
        program_.vars[static_cast<std::size_t>(made)].index = v.index;
        program_.vars[static_cast<std::size_t>(made)].aux = axis + 1;
    } else {
        made = fresh(v.name + (axis == 0 ? "_u" : "_v"), v,
                     v.kind == VarKind::Temp ? VarKind::Temp : VarKind::Local);
    }
    differences_[now][static_cast<std::size_t>(axis)] = made;
    return made;
}

// Conditions in temporaries keep their values at the other points; their difference is made when
// somebody asks.
Dual Propagation::read(VarId source) {
    Dual x{current(source), {no_var, no_var}};
    const auto at = moved_conditions_.find(x.value);
    for (int axis = 0; axis < 2; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        if (at != moved_conditions_.end() && at->second[a] != no_var) {
            x.d[a] = value(Op::Sub, Type::Float, {at->second[a], x.value});
        } else if (at == moved_conditions_.end()) {
            x.d[a] = difference(source, axis);
        }
    }
    return x;
}

Stmt& Propagation::emit(Op op, VarId dst, std::vector<VarId> args) {
    Stmt& s = out_->emplace_back();
    s.op = op;
    s.dst = dst;
    s.args = std::move(args);
    s.loc = loc_;
    return s;
}

VarId Propagation::copy_of(VarId id) {
    const VarId t = fresh(var(id).name + "_was", var(id), VarKind::Local);
    emit(Op::Copy, t, {id});
    return t;
}

void Propagation::assign(VarId to, VarId from) {
    const bool just_made = !out_->empty() && out_->back().dst == from &&
                           var(from).kind == VarKind::Temp && loose_.contains(from) &&
                           same_class(var(from).type, var(to).type) && var(to).array_length == 0;
    if (just_made) {
        out_->back().dst = to;
    } else if (to != from) {
        emit(Op::Copy, to, {from});
    }
}

void Propagation::set_differences(VarId source, const Pair& d) {
    for (int axis = 0; axis < 2; ++axis) {
        set_difference(source, axis, d[static_cast<std::size_t>(axis)]);
    }
}

// Variables without a difference along the axis are left; value no_var: the points agree.
void Propagation::set_difference(VarId source, int axis, VarId value) {
    const VarId to = difference(source, axis);
    if (to == no_var) {
        return;
    }
    if (value == no_var) {
        emit(Op::Copy, to, {zero(to)});
    } else {
        assign(to, value);
    }
}

// for (index = 0; index < length; index += 1) body
void Propagation::for_elements(int length, VarId& index, Block& body) {
    const VarId less = temp(Type::Float);
    emit(Op::Copy, index, {constant(Type::Float, 0)});
    Stmt& l = emit(Op::Loop, no_var, {less});
    Stmt test, step;
    test.op = Op::Lt;
    test.dst = less;
    test.args = {index, constant(Type::Float, static_cast<float>(length))};
    step.op = Op::Add;
    step.dst = index;
    step.args = {index, constant(Type::Float, 1)};
    test.loc = step.loc = loc_;
    l.bodies = {{test}, std::move(body), {step}};
}

VarId Propagation::moved(const Dual& x, int axis) {
    const VarId d = x.d[static_cast<std::size_t>(axis)];
    if (d == no_var) {
        return x.value;
    }
    const Var v = var(x.value);
    if (v.array_length == 0) {
        return value(Op::Add, v.type, {x.value, d});
    }
    const VarId sum = temp(v.type, v.array_length);
    VarId index = fresh("k", Var{}, VarKind::Local);
    const VarId a = temp(v.type), b = temp(v.type), c = temp(v.type);
    Block body;
    Block* const outer = out_;
    out_ = &body;
    emit(Op::Load, a, {x.value, index});
    emit(Op::Load, b, {d, index});
    emit(Op::Add, c, {a, b});
    emit(Op::Store, sum, {index, c});
    out_ = outer;
    for_elements(v.array_length, index, body);
    return sum;
}

VarId Propagation::minus(VarId a, VarId b) {
    return value(Op::Sub, var(a).type, {a, b});
}

// The statement with the variables that stand for its own here.
Stmt Propagation::mapped(const Stmt& s) const {
    Stmt m;
    m.op = s.op;
    m.dst = s.dst == no_var ? no_var : current(s.dst);
    m.builtin = s.builtin;
    m.levels = s.levels;
    m.category = s.category == no_var ? no_var : current(s.category);
    m.loc = s.loc;
    for (const VarId id : s.args) {
        m.args.push_back(current(id));
    }
    for (const auto& [name, id] : s.options) {
        m.options.emplace_back(name, current(id));
    }
    return m;
}

Stmt Propagation::mapped_deep(const Stmt& s) const {
    Stmt m = mapped(s);
    for (const Block& b : s.bodies) {
        Block& to = m.bodies.emplace_back();
        for (const Stmt& inner : b) {
            to.push_back(mapped_deep(inner));
        }
    }
    return m;
}

VarId Propagation::condition_of(VarId now) {
    if (conditions_.contains(now)) {
        return now;
    }
    const VarId t = value(Op::Ne, Type::Float, {now, constant(Type::Float, 0)});
    conditions_.insert(t);
    return t;
}

// Whether a condition holds at an auxiliary point.
VarId Propagation::condition_at(VarId source, int axis) {
    const VarId now = current(source);
    const auto it = moved_conditions_.find(now);
    if (it != moved_conditions_.end()) {
        const VarId at = it->second[static_cast<std::size_t>(axis)];
        return at != no_var ? at : condition_of(now);
    }
    const VarId d = difference(source, axis);
    if (d == no_var) {
        return condition_of(now);
    }
    return condition_of(value(Op::Add, Type::Float, {now, d}));
}

Three Propagation::conditions(VarId source) {
    const VarId here = condition_of(current(source));
    Three c = {here, here, here};
    for (int axis = 0; axis < 2; ++axis) {
        if (analysis_.differs(source, axis)) {
            c[static_cast<std::size_t>(axis) + 1] = condition_at(source, axis);
        }
    }
    return c;
}

// no_var stands for "always".
VarId Propagation::both(VarId a, VarId b) {
    if (a == no_var || b == no_var || a == b) {
        return a == no_var ? b : a;
    }
    const VarId t = value(Op::And, Type::Float, {a, b});
    conditions_.insert(t);
    return t;
}

VarId Propagation::either(VarId a, VarId b) {
    if (a == no_var || b == no_var || a == b) {
        return a == b ? a : no_var;
    }
    const VarId t = value(Op::Or, Type::Float, {a, b});
    conditions_.insert(t);
    return t;
}

VarId Propagation::negated(VarId a) {
    const VarId t = value(Op::Not, Type::Float, {a});
    conditions_.insert(t);
    return t;
}

void Propagation::comparison(const Stmt& s) {
    Stmt m = mapped(s);
    const bool in_temp = var(m.dst).kind == VarKind::Temp && is_condition(s.op);
    std::vector<Dual> a;
    const bool logic = s.op == Op::And || s.op == Op::Or || s.op == Op::Not;
    Pair at = {no_var, no_var};
    for (const VarId id : s.args) {
        a.push_back(logic ? plain(current(id)) : read(id));
    }
    for (int axis = 0; axis < 2; ++axis) {
        const auto k = static_cast<std::size_t>(axis);
        const bool differs = std::any_of(s.args.begin(), s.args.end(),
                                         [&](VarId id) { return analysis_.differs(id, axis); });
        if (!differs) {
            continue;
        }
        if (logic) {
            std::vector<VarId> there;
            for (const VarId id : s.args) {
                there.push_back(condition_at(id, axis));
            }
            at[k] = value(s.op, Type::Float, there);
        } else if (var(a[0].value).type == Type::Matrix) {
            at[k] = value(s.op, Type::Float, {moved(a[0], axis), moved(a[1], axis)});
        } else { // a + Da against b + Db without forming them: (a - b) + (Da - Db) against 0
            const Type type = is_triple(var(a[0].value).type)   ? var(a[0].value).type
                              : is_triple(var(a[1].value).type) ? var(a[1].value).type
                                                                : Type::Float;
            const VarId apart = value(Op::Sub, type, {a[0].value, a[1].value});
            const VarId p = a[0].d[k], q = a[1].d[k];
            const VarId there = p == no_var ? value(Op::Sub, type, {apart, q})
                                : q == no_var
                                    ? value(Op::Add, type, {apart, p})
                                    : value(Op::Add, type, {apart, value(Op::Sub, type, {p, q})});
            at[k] = value(s.op, Type::Float, {there, constant(Type::Float, 0)});
        }
        conditions_.insert(at[k]);
    }
    out_->push_back(m);
    if (in_temp) {
        conditions_.insert(m.dst);
        moved_conditions_[m.dst] = at;
        return;
    }
    Pair d = {no_var, no_var};
    for (std::size_t k = 0; k < 2; ++k) {
        d[k] = at[k] == no_var ? no_var : value(Op::Sub, Type::Float, {at[k], m.dst});
    }
    set_differences(s.dst, d);
}

} // namespace slc
