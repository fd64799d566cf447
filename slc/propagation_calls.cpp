// SPDX-License-Identifier: Apache-2.0
// Differences of built-in functions, and area operators as arithmetic on differences.
#include "slc/ir_util.h"
#include "slc/propagation.h"

#include <algorithm>

namespace slc {

namespace {

std::size_t at(int axis) {
    return static_cast<std::size_t>(axis);
}

bool has_outputs(const BuiltinRow& row) {
    return std::any_of(row.args.begin(), row.args.end(),
                       [](const ArgSpec& a) { return a.is_output; });
}

bool is_minmax(const BuiltinRow& row) {
    return row.repeats_last && row.args.size() == 2 && row.result.type != Type::String;
}

} // namespace

void Propagation::call(const Stmt& s) {
    switch (aux_rule(s)) {
    case AuxRule::Operator:
        if (builtin_of(s).has(PropTraces)) {
            call_for_main(s, with_footprint(s));
        } else {
            area_operator(s);
        }
        return;
    case AuxRule::Function:
        function(s);
        return;
    case AuxRule::MainOnly:
        call_for_main(s, mapped(s));
        return;
    }
}

// The same value for all points; where the main point is not, 0. `now`: what `s` has become.
void Propagation::call_for_main(const Stmt& s, Stmt now) {
    if (s.dst != no_var && main_here() != no_var && var(s.dst).type != Type::String) {
        emit(Op::Copy, current(s.dst), {zero(s.dst)});
    }
    emit_for_main(std::move(now));
    for_each_write(s, [&](VarId id, bool whole) {
        if (whole || builtin_of(s).has(PropTraces)) {
            set_differences(id, {no_var, no_var});
        } else if (s.dst != no_var && analysis_.differs(id) != NoAxis) { // set if the call succeeds
            for (int axis = 0; axis < 2; ++axis) {
                const VarId d = difference(id, axis);
                if (d != no_var && var(d).array_length == 0) {
                    assign(d, value(Op::Select, var(d).type, {current(s.dst), zero(d), d}));
                }
            }
        }
    });
}

// f(a + d) - f(a), unless the table knows something better.
void Propagation::function(const Stmt& s) {
    const BuiltinRow& row = builtin_of(s);
    bool differs = false;
    for_each_write(s,
                   [&](VarId id, bool) { differs = differs || analysis_.differs(id) != NoAxis; });
    if (!differs) {
        out_->push_back(mapped(s));
        return;
    }
    if (is_minmax(row) && s.args.size() > 2) {
        chain(s);
        return;
    }
    if (has_outputs(row)) {
        if (!set_component(s)) {
            with_outputs(s);
        }
        return;
    }
    std::vector<Dual> a;
    for (const VarId id : s.args) {
        a.push_back(read(id));
    }
    const int like = explicit_row(s, a);
    Stmt m = mapped(s);
    const VarId target = m.dst;
    const bool aliased = std::find(m.args.begin(), m.args.end(), target) != m.args.end();
    if (aliased) {
        m.dst = temp(var(target).type);
    }
    const VarId result = m.dst;
    out_->push_back(std::move(m));
    for (int axis = 0; axis < 2; ++axis) {
        if (analysis_.differs(s.dst, axis)) {
            set_difference(s.dst, axis, call_rule(like, var(s.dst).type, a, result, axis));
        }
    }
    if (aliased) {
        emit(Op::Copy, target, {result});
    }
}

VarId Propagation::call_value(int row, Type type, std::vector<VarId> args) {
    const VarId t = temp(type);
    emit(Op::Call, t, std::move(args)).builtin = row;
    return t;
}

// faceforward(N, I) looks at Ng by itself, which differs too: the form that is told.
int Propagation::explicit_row(const Stmt& s, std::vector<Dual>& a) {
    if (builtin_of(s).body != "faceforward") {
        return s.builtin;
    }
    const bool has_Ng = axes_of_global(program_.shader_type, SL_VAR_Ng) != NoAxis;
    a.push_back(has_Ng ? read(global(SL_VAR_Ng, 0)) : a[0]);
    return find_builtin_by_body("faceforward_ref");
}

VarId Propagation::call_rule(int number, Type type, const std::vector<Dual>& a, VarId result,
                             int axis) {
    const BuiltinRow& row = builtin_rows()[static_cast<std::size_t>(number)];
    const std::vector<int>& places = difference_places(number);
    std::vector<VarId> here;
    std::vector<std::size_t> differing;
    bool elsewhere = false; // in knots
    for (std::size_t i = 0; i < a.size(); ++i) {
        here.push_back(a[i].value);
        if (a[i].d[at(axis)] != no_var) {
            differing.push_back(i);
            elsewhere = elsewhere || std::find(places.begin(), places.end(), static_cast<int>(i)) ==
                                         places.end();
        }
    }
    if (differing.empty()) {
        return no_var;
    }
    if (row.has(PropLinear) && differing.size() == 1 && !elsewhere) {
        here[differing[0]] = a[differing[0]].d[at(axis)];
        return call_value(number, type, std::move(here));
    }
    if (row.has(PropDiff) && !elsewhere) {
        for (const int place : places) {
            const Dual& x = a[static_cast<std::size_t>(place)];
            here.push_back(x.d[at(axis)] == no_var ? zero(x.value) : x.d[at(axis)]);
        }
        const VarId t = temp(type);
        emit(Op::Difference, t, std::move(here)).builtin = number;
        return t;
    }
    std::vector<VarId> there;
    for (const Dual& x : a) {
        there.push_back(moved(x, axis));
    }
    return minus(call_value(number, type, std::move(there)), result);
}

// min(a, b, c) = min(min(a, b), c)
void Propagation::chain(const Stmt& s) {
    std::vector<Dual> a;
    for (const VarId id : s.args) {
        a.push_back(read(id));
    }
    Dual sum = a[0];
    for (std::size_t i = 1; i < a.size(); ++i) {
        const std::vector<Dual> two = {sum, a[i]};
        Dual next;
        next.value = call_value(s.builtin, var(s.dst).type, {sum.value, a[i].value});
        for (int axis = 0; axis < 2; ++axis) {
            if (analysis_.differs(s.dst, axis)) {
                next.d[at(axis)] = call_rule(s.builtin, var(s.dst).type, two, next.value, axis);
            }
        }
        sum = next;
    }
    set_differences(s.dst, sum.d);
    emit(Op::Copy, current(s.dst), {sum.value});
}

// setcomp(x, i, value): the components of the difference, when all points set the same one.
bool Propagation::set_component(const Stmt& s) {
    const BuiltinRow& row = builtin_of(s);
    if (!row.has(PropInout) || row.has(PropContext) || s.dst != no_var) {
        return false;
    }
    for (std::size_t i = 1; i + 1 < s.args.size(); ++i) {
        if (analysis_.differs(s.args[i]) != NoAxis) {
            return false;
        }
    }
    const Dual x = read(s.args.back());
    out_->push_back(mapped(s));
    for (int axis = 0; axis < 2; ++axis) {
        const VarId d = difference(s.args[0], axis);
        if (d != no_var) {
            Stmt m = mapped(s);
            m.args[0] = d;
            m.args.back() = x.d[at(axis)] == no_var ? constant(Type::Float, 0) : x.d[at(axis)];
            out_->push_back(std::move(m));
        }
    }
    return true;
}

// Calls that set variables: once more at each point, with outputs of its own.
void Propagation::with_outputs(const Stmt& s) {
    const BuiltinRow& row = builtin_of(s);
    std::vector<bool> is_output(s.args.size(), false);
    for (std::size_t i = 0; i < row.args.size(); ++i) {
        is_output[arg_position(row, i)] = row.args[i].is_output;
    }
    std::array<Stmt, 2> there;
    for (int axis = 0; axis < 2; ++axis) {
        Stmt& m = there[at(axis)];
        m = mapped(s);
        for (std::size_t i = 0; i < s.args.size(); ++i) {
            const Dual x = read(s.args[i]);
            if (!is_output[i]) {
                const VarId v = moved(x, axis);
                m.args[i] = v != x.value || var(v).kind == VarKind::Const ? v : copy_of(v);
                continue;
            }
            m.args[i] = fresh(var(x.value).name + "_there", var(x.value), VarKind::Local);
            if (row.has(PropInout)) {
                emit(Op::Copy, m.args[i], {moved(x, axis)});
            }
        }
        if (s.dst != no_var) {
            m.dst = fresh("there", var(s.dst), VarKind::Local);
        }
    }
    out_->push_back(mapped(s));
    for (int axis = 0; axis < 2; ++axis) {
        const Stmt& m = there[at(axis)];
        if ((analysis_.axes() >> axis & 1) == 0) {
            continue;
        }
        out_->push_back(m);
        const auto apart = [&](VarId source, VarId value_there) {
            const VarId d = difference(source, axis);
            if (d != no_var && var(d).array_length == 0) {
                assign(d, minus(value_there, current(source)));
            }
        };
        for (std::size_t i = 0; i < s.args.size(); ++i) {
            if (is_output[i]) {
                apart(s.args[i], m.args[i]);
            }
        }
        if (s.dst != no_var) {
            apart(s.dst, m.dst);
        }
    }
}

// --- area operators

void Propagation::area_operator(const Stmt& s) {
    const std::string_view name = builtin_of(s).name;
    Pair d = {no_var, no_var};
    VarId result = no_var;
    if (name == "Du" || name == "Dv" || name == "Deriv") {
        result = derivative(s);
    } else if (name == "area") {
        result = area(s);
    } else if (name == "calculatenormal") {
        result = normal(s, d);
    } else if (name == "filterstep") {
        result = filter_step(s, d);
    } else {
        result = map(s, d);
    }
    set_differences(s.dst, d);
    assign(current(s.dst), result);
}

// a / b, 0 where b is 0.
VarId Propagation::ratio(VarId a, VarId b, Type type) {
    return guarded_quotient(value(Op::Div, type, {a, b}), b, no_var);
}

// Du(x) = x_u / du; Deriv(x, y) = x_u / y_u + x_v / y_v without terms that have a denominator of 0.
// Du(u) is 1.
VarId Propagation::derivative(const Stmt& s) {
    const std::string_view name = builtin_of(s).name;
    const Type type = var(s.dst).type;
    const Dual x = read(s.args[0]);
    if (name != "Deriv") {
        const int axis = name == "Du" ? 0 : 1;
        const VarId step = global(axis == 0 ? SL_VAR_du : SL_VAR_dv, 0);
        const VarId d = x.d[at(axis)];
        // In lights the engine may have no step.
        const bool has_step = program_.shader_type != SL_SHADER_light;
        return d == no_var ? constant(type, 0)
               : d == step ? constant(type, 1)
               : has_step  ? value(Op::Div, type, {d, step})
                           : ratio(d, step, type);
    }
    const Dual y = read(s.args[1]);
    VarId sum = no_var;
    for (std::size_t k = 0; k < 2; ++k) {
        if (x.d[k] != no_var && y.d[k] != no_var) {
            const VarId term = ratio(x.d[k], y.d[k], type);
            sum = sum == no_var ? term : value(Op::Add, type, {sum, term});
        }
    }
    return sum == no_var ? constant(type, 0) : sum;
}

// |p_u ^ p_v|, with either strategy.
VarId Propagation::area(const Stmt& s) {
    const Dual p = read(s.args[0]);
    if (p.d[0] == no_var || p.d[1] == no_var) {
        return constant(Type::Float, 0);
    }
    const VarId cross = value(Op::Cross, Type::Vector, {p.d[0], p.d[1]});
    return call_value(find_builtin_by_body("length"), Type::Float, {cross});
}

// The difference of a normal is taken to be that of the surface, as long as the normal itself.
VarId Propagation::normal(const Stmt& s, Pair& d) {
    const Dual p = read(s.args[0]);
    const VarId none = constant(Type::Vector, 0);
    const VarId n =
        call_value(find_builtin_by_body("calculatenormal_d"), Type::Normal,
                   {p.d[0] == no_var ? none : p.d[0], p.d[1] == no_var ? none : p.d[1]});
    if (analysis_.differs(s.dst) != NoAxis) {
        const VarId length = call_value(find_builtin_by_body("length"), Type::Float, {n});
        for (int axis = 0; axis < 2; ++axis) {
            const VarId turn = difference_of(global(SL_VAR_Ng, 0), axis);
            d[at(axis)] = analysis_.differs(s.dst, axis)
                              ? value(Op::Mul, Type::Normal, {turn, length})
                              : no_var;
        }
    }
    return n;
}

// The step over [x - w/2, x + w/2], w = |x_u| + |x_v|, moved to the origin so that w is not rounded
// against x. At the other points the edge is elsewhere, the width stays.
VarId Propagation::filter_step(const Stmt& s, Pair& d) {
    const Dual edge = read(s.args[0]), x = read(s.args[1]);
    const int absolute = find_builtin_by_body("abs");
    VarId width = constant(Type::Float, 0);
    for (const VarId part : x.d) {
        if (part != no_var) {
            width = value(Op::Add, Type::Float, {width, call_value(absolute, Type::Float, {part})});
        }
    }
    const VarId high = value(Op::Mul, Type::Float, {width, constant(Type::Float, 0.5F)});
    const VarId low = value(Op::Neg, Type::Float, {high});
    const VarId apart = minus(edge.value, x.value);
    std::vector<VarId> args = {apart, low, high};
    for (std::size_t i = 2; i < s.args.size(); ++i) {
        args.push_back(current(s.args[i]));
    }
    const int row = find_builtin_by_body("filterstep_between");
    const VarId result = call_value(row, Type::Float, args);
    for (int axis = 0; axis < 2; ++axis) {
        if (analysis_.differs(s.dst, axis)) {
            const VarId p = edge.d[at(axis)], q = x.d[at(axis)];
            VarId there = apart;
            there = p == no_var ? there : value(Op::Add, Type::Float, {there, p});
            there = q == no_var ? there : value(Op::Sub, Type::Float, {there, q});
            args[0] = there;
            d[at(axis)] = minus(call_value(row, Type::Float, args), result);
        }
    }
    return result;
}

namespace {

// What an operator with a footprint becomes, and how many of its arguments have differences.
struct FootprintForm {
    std::string_view body, with_differences;
    std::size_t first, count; // coordinates among Stmt::args
    bool takes_st;            // they are the predefined s and t
};

constexpr FootprintForm footprint_forms[] = {{"texture_c", "texture_c_d", 2, 0, true},
                                             {"texture_f", "texture_f_d", 2, 0, true},
                                             {"texture_c_st", "texture_c_d", 2, 2, false},
                                             {"texture_f_st", "texture_f_d", 2, 2, false},
                                             {"environment_c", "environment_c_d", 2, 1, false},
                                             {"environment_f", "environment_f_d", 2, 1, false},
                                             {"shadow_c", "shadow_c_d", 2, 1, false},
                                             {"shadow_f", "shadow_f_d", 2, 1, false},
                                             {"bump", "bump_d", 5, 0, true},
                                             {"bump_st", "bump_d", 5, 2, false},
                                             {"trace_c", "trace_c_d", 0, 2, false},
                                             {"fulltrace", "fulltrace_d", 0, 2, false},
                                             {"gather_ray", "gather_ray_d", 1, 2, false}};

const FootprintForm& footprint_form(const Stmt& s) {
    return *std::find_if(std::begin(footprint_forms), std::end(footprint_forms),
                         [&](const FootprintForm& f) { return f.body == builtin_of(s).body; });
}

} // namespace

// Rays from the main point alone; the differences of their arguments are their footprint.
Stmt Propagation::with_footprint(const Stmt& s) {
    const FootprintForm& form = footprint_form(s);
    Stmt m = mapped(s);
    m.builtin = find_builtin_by_body(form.with_differences);
    std::vector<VarId> differences;
    for (std::size_t k = 0; k < 2; ++k) {
        for (std::size_t i = 0; i < form.count; ++i) {
            const Dual x = read(s.args[form.first + i]);
            differences.push_back(x.d[k] == no_var ? zero(x.value) : x.d[k]);
        }
    }
    m.args.insert(m.args.begin() + static_cast<std::ptrdiff_t>(form.first + form.count),
                  differences.begin(), differences.end());
    return m;
}

// A lookup with the footprint that the differences span; at the other points the same footprint.
VarId Propagation::map(const Stmt& s, Pair& d) {
    const FootprintForm* const form = &footprint_form(s);
    std::vector<Dual> a;
    for (const VarId id : s.args) {
        a.push_back(read(id));
    }
    std::vector<Dual> where(a.begin() + static_cast<std::ptrdiff_t>(form->first),
                            a.begin() + static_cast<std::ptrdiff_t>(form->first + form->count));
    if (form->takes_st) {
        where = {read(global(SL_VAR_s, 0)), read(global(SL_VAR_t, 0))};
    }
    const auto arguments = [&](int axis) {
        std::vector<VarId> args;
        for (std::size_t i = 0; i < form->first; ++i) {
            args.push_back(axis < 0 ? a[i].value : moved(a[i], axis));
        }
        for (const Dual& x : where) {
            args.push_back(axis < 0 ? x.value : moved(x, axis));
        }
        for (std::size_t k = 0; k < 2; ++k) {
            for (const Dual& x : where) {
                args.push_back(x.d[k] == no_var ? zero(x.value) : x.d[k]);
            }
        }
        for (std::size_t i = form->first + form->count; i < a.size(); ++i) {
            args.push_back(a[i].value);
        }
        return args;
    };
    const int row = find_builtin_by_body(form->with_differences);
    const Type type = var(s.dst).type;
    const bool wanted = slice_.result_matters(s);
    if (!wanted) { // nobody but the main point looks at it
        const VarId t = fresh("map", var(s.dst), VarKind::Local);
        Stmt m;
        m.op = Op::Call;
        m.dst = t;
        m.args = arguments(-1);
        m.builtin = row;
        m.loc = loc_;
        emit_for_main(std::move(m));
        return t;
    }
    const VarId result = call_value(row, type, arguments(-1));
    for (int axis = 0; axis < 2; ++axis) {
        if (analysis_.differs(s.dst, axis)) {
            d[at(axis)] = minus(call_value(row, type, arguments(axis)), result);
        }
    }
    return result;
}

} // namespace slc
