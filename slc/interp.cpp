// SPDX-License-Identifier: Apache-2.0
// Control flow and operations of the interpreter.
#include "slc/interp.h"

#include "slc/ir_util.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace slc {

bool InterpHost::light(int, int, const Triple3&, const Triple3&, double, const std::string&,
                       LightSample&) {
    return false;
}
Triple3 InterpHost::ambient(int, const Triple3&) {
    return {0, 0, 0};
}
bool InterpHost::space(const std::string&, const std::string&, int, Matrix16&) {
    return false;
}
bool InterpHost::message(std::string_view, const std::string&, int, Value&) {
    return false;
}
void InterpHost::shadeop(const std::string&, int, std::vector<Value>&, std::size_t) {}
void InterpHost::print(const std::string&) {}
void InterpHost::depth_range(double& near_z, double& far_z) {
    near_z = 0;
    far_z = 1;
}
void InterpHost::neighbours(int, int& at_u, int& at_v) {
    at_u = at_v = -1;
}

Interpreter::Interpreter(const Program& program, InterpHost& host, int num_points)
    : program_(program), host_(host), num_points_(num_points) {
    const auto n = static_cast<std::size_t>(num_points);
    for (const Var& v : program.vars) {
        Value initial = Value::zero(v.type, v.array_length);
        if (v.kind == VarKind::Const && v.type == Type::String) {
            initial.s[0] = v.text;
        } else if (v.kind == VarKind::Const) {
            initial.x.assign(v.values.begin(), v.values.end());
        }
        values_.emplace_back(v.kind == VarKind::Global ? 0 : n, initial);
    }
    for (int aux = 0; aux < 3; ++aux) {
        for (const VariableRow& row : variable_rows()) {
            globals_.emplace_back(n, Value::zero(row.type));
        }
    }
    bound_.resize(program.vars.size(), 0);
    random_counts_.resize(n, 0);
    random_uniform_counts_.resize(n, 0);
    lit_.resize(n, 0);
    wild_.resize(n, 0);
}

Value& Interpreter::at(VarId id, int point) {
    const Var& v = var(id);
    auto& plane = v.kind == VarKind::Global
                      ? globals_[static_cast<std::size_t>(v.aux * SL_VAR_COUNT + v.index)]
                      : values_[static_cast<std::size_t>(id)];
    return plane[static_cast<std::size_t>(point)];
}

const Value& Interpreter::at(VarId id, int point) const {
    return const_cast<Interpreter*>(this)->at(id, point);
}

Triple3 Interpreter::global3(int variable, int point) const {
    return global(variable, point).triple();
}

const Value& Interpreter::global(int variable, int point) const {
    return globals_[static_cast<std::size_t>(variable)][static_cast<std::size_t>(point)];
}

void Interpreter::set_global(int variable, int point, const Value& value) {
    globals_[static_cast<std::size_t>(variable)][static_cast<std::size_t>(point)] = value;
}

const Value& Interpreter::aux(int variable, int aux, int point) const {
    return globals_[static_cast<std::size_t>(aux * SL_VAR_COUNT + variable)]
                   [static_cast<std::size_t>(point)];
}

void Interpreter::set_aux(int variable, int aux, int point, const Value& value) {
    globals_[static_cast<std::size_t>(aux * SL_VAR_COUNT + variable)]
            [static_cast<std::size_t>(point)] = value;
}

std::size_t Interpreter::find(std::string_view name) const {
    for (const Param& p : program_.params) {
        if (var(p.var).name == name) {
            return static_cast<std::size_t>(p.var);
        }
    }
    return values_.size();
}

void Interpreter::set_param(std::string_view name, int point, const Value& value) {
    const std::size_t id = find(name);
    if (id < values_.size()) {
        values_[id][static_cast<std::size_t>(point)] = value;
        bound_[id] = 1;
    }
}

void Interpreter::set_param_aux(VarId id, int aux, int point, const Value& value) {
    for (std::size_t i = 0; i < program_.vars.size(); ++i) {
        const Var& v = program_.vars[i];
        if (v.kind == VarKind::Param && v.aux == aux && v.index == var(id).index &&
            v.type == value.type) {
            values_[i][static_cast<std::size_t>(point)] = value;
        }
    }
}

const Value& Interpreter::param(std::string_view name, int point) const {
    static const Value missing;
    const std::size_t id = find(name);
    return id < values_.size() ? values_[id][static_cast<std::size_t>(point)] : missing;
}

bool Interpreter::run() {
    Mask all(static_cast<std::size_t>(num_points_), 1);
    for (const Param& p : program_.params) {
        if (bound_[static_cast<std::size_t>(p.var)] == 0) {
            block(p.init, all);
        }
    }
    block(program_.body, all);
    return steps_ < max_steps_;
}

namespace {

bool any(const std::vector<char>& mask) {
    return std::any_of(mask.begin(), mask.end(), [](char c) { return c != 0; });
}

} // namespace

void Interpreter::block(const Block& b, Mask& mask) {
    for (const Stmt& s : b) {
        if (!any(mask) || steps_ >= max_steps_) {
            return;
        }
        statement(s, mask);
    }
}

void Interpreter::statement(const Stmt& s, Mask& mask) {
    steps_ += static_cast<std::size_t>(num_points_);
    switch (s.op) {
    case Op::If:
        branch(s, mask);
        break;
    case Op::Loop:
        loop(s, mask);
        break;
    case Op::Scope:
        scope(s, mask);
        break;
    case Op::Break:
    case Op::Continue:
    case Op::Leave:
        jump(s, mask);
        break;
    case Op::Illuminance:
        illuminance(s, mask);
        break;
    case Op::Illuminate:
    case Op::Solar:
        illuminate(s, mask);
        break;
    case Op::Call:
        call(s, mask);
        round(s, mask);
        break;
    case Op::Difference:
        for (int p = 0; p < num_points_; ++p) {
            if (mask[static_cast<std::size_t>(p)] != 0) {
                row_difference(s, mask, p);
            }
        }
        break;
    default:
        for (int p = 0; p < num_points_; ++p) {
            if (mask[static_cast<std::size_t>(p)] != 0) {
                operation(s, p);
            }
        }
        round(s, mask);
        break;
    }
}

void Interpreter::round(const Stmt& s, const Mask& mask) {
    if (rounding_ == 0 || s.dst == no_var || var(s.dst).type == Type::String) {
        return;
    }
    constexpr double place = 6e-8; // half a unit in the last place of a float, relative
    const double size = s.op == Op::Call ? 8 * place : place;
    for (int p = 0; p < num_points_; ++p) {
        if (mask[static_cast<std::size_t>(p)] == 0) {
            continue;
        }
        for (double& x : at(s.dst, p).x) {
            if (!(std::abs(x) < 1e6)) {
                wild_[static_cast<std::size_t>(p)] = 1;
            }
            if (x == static_cast<float>(x) || std::isnan(x)) {
                continue; // exact, or rounded before
            }
            rounding_ = rounding_ * 1664525U + 1013904223U;
            const double sign = (rounding_ >> 31) != 0 ? 1 : -1;
            const double base = s.op == Op::Call ? std::max(std::abs(x), 0.25) : std::abs(x);
            x = static_cast<float>(x + sign * size * base);
        }
    }
}

// Runs both sides under their masks; points that left inside are gone afterwards.
void Interpreter::branch(const Stmt& s, Mask& mask) {
    if (director_ != nullptr) {
        directed_branch(s, mask);
        return;
    }
    Mask then = mask;
    Mask otherwise = mask;
    for (std::size_t p = 0; p < mask.size(); ++p) {
        const bool taken = at(s.args[0], static_cast<int>(p)).f() != 0;
        then[p] = static_cast<char>(mask[p] != 0 && taken);
        otherwise[p] = static_cast<char>(mask[p] != 0 && !taken);
    }
    block(s.bodies[0], then);
    block(s.bodies[1], otherwise);
    for (std::size_t p = 0; p < mask.size(); ++p) {
        mask[p] = static_cast<char>(then[p] != 0 || otherwise[p] != 0);
    }
}

void Interpreter::directed_branch(const Stmt& s, Mask& mask) {
    const int arm = director_->decide(s, 0, at(s.args[0], 0).f() != 0) ? 0 : 1;
    const auto values = values_;
    const auto globals = globals_;
    director_->enter(s, arm, 0);
    block(s.bodies[static_cast<std::size_t>(arm)], mask);
    if (director_->leave()) {
        values_ = values;
        globals_ = globals;
        mask.assign(mask.size(), 1);
    }
}

// One of a statement's bodies, in its round-th round.
void Interpreter::part(const Stmt& s, int body, int round, Mask& mask) {
    if (director_ != nullptr) {
        director_->enter(s, body, round);
    }
    block(s.bodies[static_cast<std::size_t>(body)], mask);
    if (director_ != nullptr) {
        director_->leave();
    }
}

void Interpreter::loop(const Stmt& s, Mask& mask) {
    const Mask none(mask.size(), 0);
    Mask running = mask;
    Mask ended(mask.size(), 0);
    for (int round = 0; any(running) && steps_ < max_steps_; ++round) {
        frames_.push_back({true, none, none});
        part(s, 0, round, running);
        for (std::size_t p = 0; p < mask.size(); ++p) {
            bool again = at(s.args[0], static_cast<int>(p)).f() != 0;
            if (director_ != nullptr && running[p] != 0) {
                again = director_->decide(s, round, again);
            }
            if (running[p] != 0 && !again) {
                running[p] = 0;
                ended[p] = 1;
            }
        }
        part(s, 1, round, running);
        for (std::size_t p = 0; p < mask.size(); ++p) {
            running[p] = static_cast<char>(running[p] != 0 || frames_.back().continued[p] != 0);
            ended[p] = static_cast<char>(ended[p] != 0 || frames_.back().left[p] != 0);
        }
        part(s, 2, round, running);
        frames_.pop_back();
        steps_ += mask.size();
    }
    mask = ended;
}

// The target's frame remembers the points; they take part in nothing until it is reached.
void Interpreter::jump(const Stmt& s, Mask& mask) {
    if (director_ != nullptr && !director_->may_jump(s)) {
        std::fill(mask.begin(), mask.end(), 0); // up to where leave() says so
        return;
    }
    int levels = s.levels;
    for (auto f = frames_.rbegin(); f != frames_.rend(); ++f) {
        if (f->is_loop != (s.op != Op::Leave) || --levels > 0) {
            continue;
        }
        Mask& into = s.op == Op::Continue ? f->continued : f->left;
        for (std::size_t p = 0; p < mask.size(); ++p) {
            into[p] = static_cast<char>(into[p] != 0 || mask[p] != 0);
        }
        break;
    }
    std::fill(mask.begin(), mask.end(), 0);
}

void Interpreter::scope(const Stmt& s, Mask& mask) {
    const Mask none(mask.size(), 0);
    frames_.push_back({false, none, none});
    part(s, 0, 0, mask);
    for (std::size_t p = 0; p < mask.size(); ++p) {
        mask[p] = static_cast<char>(mask[p] != 0 || frames_.back().left[p] != 0);
    }
    frames_.pop_back();
}

void Interpreter::operation(const Stmt& s, int point) {
    const auto arg = [&](std::size_t i) -> const Value& { return at(s.args[i], point); };
    switch (s.op) {
    case Op::Copy:
        copy(s, point);
        break;
    case Op::Add:
    case Op::Sub:
    case Op::Mul:
    case Op::Div:
    case Op::Neg:
        arithmetic(s, point);
        break;
    case Op::Dot:
        at(s.dst, point) = Value(dot3(arg(0).triple(), arg(1).triple()));
        break;
    case Op::Cross: {
        const Triple3 r = cross3(arg(0).triple(), arg(1).triple());
        at(s.dst, point) = Value(var(s.dst).type, r[0], r[1], r[2]);
        break;
    }
    case Op::And:
        at(s.dst, point) = Value(arg(0).f() != 0 && arg(1).f() != 0 ? 1.0 : 0.0);
        break;
    case Op::Or:
        at(s.dst, point) = Value(arg(0).f() != 0 || arg(1).f() != 0 ? 1.0 : 0.0);
        break;
    case Op::Not:
        at(s.dst, point) = Value(arg(0).f() == 0 ? 1.0 : 0.0);
        break;
    case Op::Select: {
        Value chosen = arg(0).f() != 0 ? arg(1) : arg(2);
        chosen.type = var(s.dst).type;
        at(s.dst, point) = std::move(chosen);
        break;
    }
    case Op::Triple:
        at(s.dst, point) = Value(var(s.dst).type, arg(0).f(), arg(1).f(), arg(2).f());
        break;
    case Op::Matrix16: {
        Value m = Value::zero(Type::Matrix);
        for (std::size_t i = 0; i < 16; ++i) {
            m.x[i] = arg(i).f();
        }
        at(s.dst, point) = std::move(m);
        break;
    }
    case Op::Component:
        at(s.dst, point) =
            Value(arg(0).at(static_cast<std::size_t>(std::clamp(arg(1).f(), 0.0, 2.0))));
        break;
    case Op::Load:
    case Op::Store:
        element(s, point);
        break;
    default:
        compare(s, point);
        break;
    }
}

// Index truncated toward zero and clamped to the array.
void Interpreter::element(const Stmt& s, int point) {
    const bool is_load = s.op == Op::Load;
    const VarId array = is_load ? s.args[0] : s.dst;
    const Var& v = var(array);
    const double wanted = std::trunc(at(s.args[is_load ? 1 : 0], point).f());
    const double last = v.array_length - 1;
    const auto index = static_cast<std::size_t>(wanted > 0 ? std::min(wanted, last) : 0.0);
    if (v.type == Type::String) {
        if (is_load) {
            at(s.dst, point).s[0] = at(array, point).s[index];
        } else {
            at(array, point).s[index] = at(s.args[1], point).s[0];
        }
        return;
    }
    const auto n = static_cast<std::size_t>(num_components(v.type));
    for (std::size_t c = 0; c < n; ++c) {
        if (is_load) {
            at(s.dst, point).x[c] = at(array, point).x[index * n + c];
        } else {
            at(array, point).x[index * n + c] = at(s.args[1], point).x[c];
        }
    }
}

void Interpreter::copy(const Stmt& s, int point) {
    const Var& to = var(s.dst);
    const Value from = at(s.args[0], point);
    if (from.type == Type::String) {
        Value& dst = at(s.dst, point);
        for (std::size_t i = 0; i < dst.s.size(); ++i) {
            dst.s[i] = from.s.size() == 1 ? from.s[0] : from.s[i];
        }
        return;
    }
    Value result = Value::zero(to.type, to.array_length);
    const auto n = static_cast<std::size_t>(num_components(to.type));
    const bool whole = var(s.args[0]).array_length != 0;
    const Matrix16 diagonal = to.type == Type::Matrix && !whole ? matrix_of(from) : Matrix16{};
    for (std::size_t i = 0; i < result.x.size(); ++i) {
        result.x[i] = whole                     ? from.x[i]
                      : to.type == Type::Matrix ? diagonal[i % n]
                                                : from.at(i % n);
    }
    at(s.dst, point) = std::move(result);
}

void Interpreter::arithmetic(const Stmt& s, int point) {
    const Type type = var(s.dst).type;
    if (type == Type::Matrix && s.op != Op::Neg) {
        matrix_arithmetic(s, point);
        return;
    }
    const Value a = at(s.args[0], point);
    const Value b = s.args.size() > 1 ? at(s.args[1], point) : Value();
    Value r = Value::zero(type);
    for (std::size_t i = 0; i < r.x.size(); ++i) {
        switch (s.op) {
        case Op::Add:
            r.x[i] = a.at(i) + b.at(i);
            break;
        case Op::Sub:
            r.x[i] = a.at(i) - b.at(i);
            break;
        case Op::Mul:
            r.x[i] = a.at(i) * b.at(i);
            break;
        case Op::Div:
            r.x[i] = a.at(i) / b.at(i);
            break;
        default:
            r.x[i] = -a.at(i);
            break;
        }
    }
    at(s.dst, point) = std::move(r);
}

void Interpreter::matrix_arithmetic(const Stmt& s, int point) {
    const Matrix16 a = matrix_of(at(s.args[0], point));
    const Matrix16 b = matrix_of(at(s.args[1], point));
    Matrix16 r{};
    if (s.op == Op::Mul || s.op == Op::Div) {
        r = multiply(a, s.op == Op::Mul ? b : inverse(b));
    } else {
        for (std::size_t i = 0; i < 16; ++i) {
            r[i] = s.op == Op::Add ? a[i] + b[i] : a[i] - b[i];
        }
    }
    Value v = Value::zero(Type::Matrix);
    v.x.assign(r.begin(), r.end());
    at(s.dst, point) = std::move(v);
}

// Triples: all components must satisfy the relation; != is the negation of ==.
void Interpreter::compare(const Stmt& s, int point) {
    const Value& a = at(s.args[0], point);
    const Value& b = at(s.args[1], point);
    bool all = true;
    if (a.type == Type::String) {
        all = a.text() == b.text();
    }
    const std::size_t n = a.type == Type::String ? 0 : std::max(a.x.size(), b.x.size());
    for (std::size_t i = 0; i < n; ++i) {
        switch (s.op) {
        case Op::Lt:
            all = all && a.at(i) < b.at(i);
            break;
        case Op::Le:
            all = all && a.at(i) <= b.at(i);
            break;
        case Op::Gt:
            all = all && a.at(i) > b.at(i);
            break;
        case Op::Ge:
            all = all && a.at(i) >= b.at(i);
            break;
        default:
            all = all && a.at(i) == b.at(i);
            break;
        }
    }
    at(s.dst, point) = Value(all != (s.op == Op::Ne) ? 1.0 : 0.0);
}

void Interpreter::illuminance(const Stmt& s, Mask& mask) {
    const Mask none(mask.size(), 0);
    Mask running = mask; // points still in the loop over lights
    Mask left(mask.size(), 0);
    for (int light = 0; light < host_.num_lights() && any(running); ++light) {
        frames_.push_back({true, none, none});
        Mask in_body(mask.size(), 0);
        light_body(s, light, running, in_body);
        Mask skipped = running;
        for (std::size_t p = 0; p < mask.size(); ++p) {
            skipped[p] = static_cast<char>(running[p] != 0 && in_body[p] == 0);
        }
        ++light_loops_;
        part(s, 0, light, in_body);
        --light_loops_;
        for (std::size_t p = 0; p < mask.size(); ++p) {
            running[p] = static_cast<char>(skipped[p] != 0 || in_body[p] != 0 ||
                                           frames_.back().continued[p] != 0);
            left[p] = static_cast<char>(left[p] != 0 || frames_.back().left[p] != 0);
        }
        frames_.pop_back();
    }
    for (std::size_t p = 0; p < mask.size(); ++p) {
        mask[p] = static_cast<char>(running[p] != 0 || left[p] != 0);
    }
}

// Asks one light for every point in the mask; those it reaches run the body with L, Cl and Ol set.
void Interpreter::light_body(const Stmt& s, int light, const Mask& mask, Mask& running) {
    const bool has_cone = s.args.size() > 1;
    for (int p = 0; p < num_points_; ++p) {
        if (mask[static_cast<std::size_t>(p)] == 0) {
            continue;
        }
        const Triple3 axis = has_cone ? at(s.args[1], p).triple() : Triple3{0, 0, 0};
        const double angle = has_cone ? at(s.args[2], p).f() : std::numbers::pi;
        const double cos_angle = angle >= std::numbers::pi ? -1 : std::cos(angle);
        const std::string category =
            s.category != no_var ? at(s.category, p).text() : std::string();
        LightSample sample;
        const bool reached =
            host_.light(light, p, at(s.args[0], p).triple(), axis, cos_angle, category, sample);
        const bool in_cone = !has_cone || cos_angle <= -1 ||
                             dot3(normalize3(sample.L), normalize3(axis)) >= cos_angle;
        if (!reached || !in_cone) {
            continue;
        }
        running[static_cast<std::size_t>(p)] = 1;
        set_global(SL_VAR_L, p, Value(Type::Vector, sample.L[0], sample.L[1], sample.L[2]));
        set_global(SL_VAR_Cl, p, Value(Type::Color, sample.Cl[0], sample.Cl[1], sample.Cl[2]));
        set_global(SL_VAR_Ol, p, Value(Type::Color, sample.Ol[0], sample.Ol[1], sample.Ol[2]));
        for (const auto& [name, id] : s.options) {
            if (name.starts_with("light:")) {
                host_.message("lightsource", name.substr(6), p, at(id, p));
            }
        }
    }
}

// Direction from the light to Ps; false if the point is outside the cone (sl.md 5.4).
bool Interpreter::emit_direction(const Stmt& s, int point, Triple3& L) {
    if (s.op == Op::Solar) {
        L = s.args.empty() ? scale3(normalize3(global3(SL_VAR_Ns, point)), -1)
                           : at(s.args[0], point).triple();
        return true;
    }
    L = sub3(global3(SL_VAR_Ps, point), at(s.args[0], point).triple());
    if (s.args.size() < 2) {
        return true;
    }
    const double angle = at(s.args[2], point).f();
    return angle >= std::numbers::pi ||
           dot3(normalize3(L), normalize3(at(s.args[1], point).triple())) >= std::cos(angle);
}

void Interpreter::illuminate(const Stmt& s, Mask& mask) {
    Mask inside = mask;
    Mask outside(mask.size(), 0);
    for (int p = 0; p < num_points_; ++p) {
        const auto i = static_cast<std::size_t>(p);
        Triple3 L{};
        if (mask[i] == 0) {
            continue;
        }
        if (emit_direction(s, p, L)) {
            set_global(SL_VAR_L, p, Value(Type::Vector, L[0], L[1], L[2]));
            lit_[i] = 1;
        } else {
            set_global(SL_VAR_Cl, p, Value(Type::Color, 0, 0, 0));
            inside[i] = 0;
            outside[i] = 1;
        }
    }
    part(s, 0, 0, inside);
    for (std::size_t p = 0; p < mask.size(); ++p) {
        mask[p] = static_cast<char>(inside[p] != 0 || outside[p] != 0);
    }
}

} // namespace slc
