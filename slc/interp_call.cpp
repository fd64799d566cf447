// SPDX-License-Identifier: Apache-2.0
// Built-in functions that need more than their arguments: lights, spaces, messages, derivatives,
// random numbers.
#include "slc/interp.h"
#include "slc/ir_util.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace slc {

void Interpreter::call(const Stmt& s, const Mask& mask) {
    const bool once = s.dst == no_var && builtin_of(s).body == "printf" &&
                      std::all_of(s.args.begin(), s.args.end(),
                                  [&](VarId id) { return var(id).detail == Detail::Uniform; });
    for (int p = 0; p < num_points_; ++p) {
        if (mask[static_cast<std::size_t>(p)] != 0) {
            call_at(s, mask, p);
            if (once) {
                return;
            }
        }
    }
}

void Interpreter::call_at(const Stmt& s, const Mask& mask, int point) {
    const BuiltinRow& row = builtin_of(s);
    std::vector<Value> args;
    for (const VarId id : s.args) {
        args.push_back(at(id, point));
    }
    Value result = Value::zero(s.dst != no_var ? var(s.dst).type : Type::Float);
    const bool is_known = director_ != nullptr && director_->replace(s, args, result);
    if (is_known) {
        args.clear();
    } else if (const PureFunction f = pure_function(row.body)) {
        f(args, result);
    } else if (!lighting(s, point, result) && !spaces(s, point, args, result) &&
               !area(s, mask, point, result) && !text(s, point, result) &&
               !shadeop(s, point, args) && !rays(s, point, args, result) &&
               !state(s, point, args, result)) {
        fallback(s, point, result);
    }
    if (director_ != nullptr && !is_known) {
        director_->computed(s, args, result);
    }
    for (std::size_t i = 0; i < row.args.size(); ++i) {
        const std::size_t k = arg_position(row, i);
        if (row.args[i].is_output && k < args.size() && var(s.args[k]).kind != VarKind::Const) {
            args[k].type = var(s.args[k]).type;
            at(s.args[k], point) = args[k];
        }
    }
    if (s.dst != no_var) {
        result.type = var(s.dst).type;
        at(s.dst, point) = std::move(result);
    }
}

// f(a + d) - f(a), in double.
void Interpreter::row_difference(const Stmt& s, const Mask&, int point) {
    const BuiltinRow& row = builtin_of(s);
    const std::vector<int>& places = difference_places(s.builtin);
    const std::size_t num_args = s.args.size() - places.size();
    Value results[2];
    for (int moved = 0; moved < 2; ++moved) {
        std::vector<Value> args;
        for (std::size_t i = 0; i < num_args; ++i) {
            args.push_back(at(s.args[i], point));
        }
        for (std::size_t i = 0; i < places.size() && moved != 0; ++i) {
            Value& a = args[static_cast<std::size_t>(places[i])];
            const Value& d = at(s.args[num_args + i], point);
            for (std::size_t k = 0; k < a.x.size(); ++k) {
                a.x[k] += d.at(k);
            }
        }
        Value& result = results[moved];
        result = Value::zero(var(s.dst).type);
        if (const PureFunction f = pure_function(row.body)) {
            f(args, result);
        } else if (!spaces(s, point, args, result)) {
            state(s, point, args, result);
        }
    }
    for (std::size_t k = 0; k < results[0].x.size(); ++k) {
        results[1].x[k] -= results[0].x[k];
    }
    results[1].type = var(s.dst).type;
    at(s.dst, point) = std::move(results[1]);
}

namespace {

void put(Value& r, const Triple3& v) {
    r.x.assign(v.begin(), v.end());
}

// pow(max(0, N.H), 1/roughness) with H = normalize(L + V); nothing else is normalised, sl.md 4.6
double specular_brdf(const Triple3& L, const Triple3& N, const Triple3& V, double roughness) {
    const Triple3 h = normalize3({L[0] + V[0], L[1] + V[1], L[2] + V[2]});
    return pow_sl(std::max(0.0, dot3(N, h)), 1 / roughness);
}

} // namespace

// Sum over lights for diffuse, specular and phong (sl.md 4.6): illuminance(P, N, PI/2).
Triple3 Interpreter::illuminate_sum(const Stmt& s, int point) {
    const std::string_view body = builtin_of(s).body;
    const bool placed = body == "diffuse_at";
    const auto arg = [&](std::size_t i) -> const Value& { return at(s.args[i], point); };
    const Triple3 P = placed ? arg(0).triple() : global3(SL_VAR_P, point);
    const Triple3 N = arg(placed ? 1 : 0).triple();
    const double cos_angle =
        placed ? (arg(2).f() >= std::numbers::pi ? -1 : std::cos(arg(2).f())) : 0;
    Triple3 sum{0, 0, 0};
    for (int light = 0; light < host_.num_lights(); ++light) {
        LightSample sample;
        if (!host_.light(light, point, P, N, cos_angle, "", sample)) {
            continue;
        }
        const Triple3 l = normalize3(sample.L);
        if (cos_angle > -1 && dot3(l, normalize3(N)) < cos_angle) {
            continue;
        }
        double weight = 0;
        if (body.starts_with("diffuse")) {
            // A cone wider than a half space takes light, it does not remove it.
            const double cosine = dot3(l, N);
            weight = (1 - sample.nondiffuse) * (placed ? std::max(0.0, cosine) : cosine);
        } else if (body == "specular") {
            weight = (1 - sample.nonspecular) * specular_brdf(l, N, arg(1).triple(), arg(2).f());
        } else {
            const Triple3 n = normalize3(N);
            const Triple3 v = scale3(normalize3(arg(1).triple()), -1);
            const Triple3 r = sub3(v, scale3(n, 2 * dot3(v, n)));
            weight = (1 - sample.nonspecular) * pow_sl(std::max(0.0, dot3(r, l)), arg(2).f());
        }
        for (std::size_t c = 0; c < 3; ++c) {
            sum[c] += weight * sample.Cl[c];
        }
    }
    return sum;
}

bool Interpreter::lighting(const Stmt& s, int point, Value& result) {
    const std::string_view body = builtin_of(s).body;
    if (body == "ambient") {
        put(result, host_.ambient(point, global3(SL_VAR_P, point)));
    } else if (builtin_of(s).has(PropLights)) {
        put(result, illuminate_sum(s, point));
    } else {
        return false;
    }
    return true;
}

bool Interpreter::spaces(const Stmt& s, int point, const std::vector<Value>& args, Value& result) {
    const BuiltinRow& row = builtin_of(s);
    const auto arg = [&](std::size_t i) -> const Value& { return args[i]; };
    if (row.body == "depth") {
        double near_z = 0;
        double far_z = 1;
        host_.depth_range(near_z, far_z);
        result = Value((arg(0).at(2) - near_z) / (far_z - near_z)); // current is camera space
        return true;
    }
    if (!row.has(PropSpaces)) {
        return false;
    }
    const bool has_from = args.size() > 2;
    const std::string from = has_from ? arg(0).text() : "current";
    Matrix16 m{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    const Value& target = arg(has_from ? 1 : 0);
    if (target.type == Type::Matrix) { // transform(from, m, p)
        host_.space(from, "current", point, m);
        m = multiply(m, matrix_of(target));
    } else {
        host_.space(from, target.text(), point, m);
    }
    const Value& what = arg(args.size() - 1);
    if (row.body.starts_with("mtransform")) {
        const Matrix16 product = multiply(matrix_of(what), m);
        result.x.assign(product.begin(), product.end());
        return true;
    }
    const Type kind = row.body.starts_with('v')   ? Type::Vector
                      : row.body.starts_with('n') ? Type::Normal
                                                  : Type::Point;
    put(result, transform_by(kind, what.triple(), m));
    return true;
}

bool Interpreter::text(const Stmt& s, int point, Value& result) {
    const std::string_view body = builtin_of(s).body;
    std::vector<Value> values;
    for (std::size_t i = 1; i < s.args.size(); ++i) {
        values.push_back(at(s.args[i], point));
    }
    if (body == "printf") {
        host_.print(format_text(at(s.args[0], point).text(), values.data(), values.size()));
    } else if (body == "format") {
        result = Value(format_text(at(s.args[0], point).text(), values.data(), values.size()));
    } else if (body == "concat") {
        std::string all = at(s.args[0], point).text();
        for (const Value& v : values) {
            all += v.text();
        }
        result = Value(all);
    } else {
        return false;
    }
    return true;
}

bool Interpreter::shadeop(const Stmt& s, int point, std::vector<Value>& args) {
    const BuiltinRow& row = builtin_of(s);
    if (row.name != "shadeop") {
        return false;
    }
    std::vector<Value> values(args.begin() + 1, args.end());
    host_.shadeop(args[0].text(), point, values, row.args.size() - 1);
    std::copy(values.begin(), values.end(), args.begin() + 1);
    return true;
}

// The generator of runtime/lib/noise.c: a function of the point's seed, the number of the call and
// the component. A uniform target has its own count and no seed: one value for all points.
void Interpreter::random(int point, bool is_uniform, Value& result) {
    const std::uint32_t seed = is_uniform ? 0 : host_.seed(point);
    auto& counts = is_uniform ? random_uniform_counts_ : random_counts_;
    const std::uint32_t count = counts[static_cast<std::size_t>(point)]++;
    for (std::size_t c = 0; c < result.x.size(); ++c) {
        const auto n = count * 3 + static_cast<std::uint32_t>(c);
        std::uint32_t h = (seed * 0x9e3779b1u ^ n * 0x85ebca77u) + 0x2545f491u;
        h ^= h >> 16;
        h *= 0x85ebca6bu;
        h ^= h >> 13;
        h *= 0xc2b2ae35u;
        h ^= h >> 16;
        result.x[c] = static_cast<double>(h >> 8) * 0x1p-24;
    }
}

bool Interpreter::state(const Stmt& s, int point, std::vector<Value>& args, Value& result) {
    const BuiltinRow& row = builtin_of(s);
    if (row.has(PropRandom)) {
        random(point, s.dst != no_var && var(s.dst).detail == Detail::Uniform, result);
    } else if (row.body == "specularbrdf") {
        const double f =
            specular_brdf(args[0].triple(), args[1].triple(), args[2].triple(), args[3].f());
        put(result, {f, f, f});
    } else if (row.body == "faceforward") {
        const bool has_Ng =
            (variable_rows()[SL_VAR_Ng].readable & shader_type_bit(program_.shader_type)) != 0;
        const Triple3 Ng = global3(SL_VAR_Ng, point);
        std::vector<Value> all = {args[0], args[1],
                                  has_Ng ? Value(Type::Normal, Ng[0], Ng[1], Ng[2]) : args[0]};
        pure_function("faceforward_ref")(all, result);
    } else if (row.body == "raylevel") {
        result = Value(host_.raylevel());
    } else if (row.body == "shadername" || row.body == "shadername_of") {
        result = Value(host_.shader_name(args.empty() ? "" : args[0].text()));
    } else if (row.body == "message_lightsource" && light_loops_ == 0) {
        result = Value(0.0); // no light is asked
    } else if (row.has(PropInout) &&
               row.has(PropContext)) { // messages: (name, X) or (name, key, X)
        const std::size_t name = args.size() - 2;
        result = Value(host_.message(row.name, args[name].text(), point, args.back()) ? 1.0 : 0.0);
    } else {
        return false;
    }
    return true;
}

Value Interpreter::difference(const Stmt& s, std::size_t arg, int point, int aux,
                              int neighbour) const {
    const VarId id = s.args[arg];
    Value d = Value::zero(var(id).type);
    if (director_ != nullptr) {
        const std::vector<Value>& there = director_->arguments_at(s, aux);
        for (std::size_t i = 0; i < d.x.size() && arg < there.size(); ++i) {
            d.x[i] = there[arg].at(i) - at(id, point).at(i);
        }
        return d;
    }
    for (std::size_t i = 0; i < d.x.size() && neighbour >= 0; ++i) {
        d.x[i] = at(id, neighbour).at(i) - at(id, point).at(i);
    }
    return d;
}

// Du(p) ^ Dv(p) turned as Ng is turned from dPdu ^ dPdv; N where p spans no surface (sl.md 4.2,
// 6.4).
Triple3 Interpreter::oriented_normal(int point, const Triple3& p_u, const Triple3& p_v) const {
    const double steps = global(SL_VAR_du, point).f() * global(SL_VAR_dv, point).f();
    const Triple3 n = scale3(cross3(p_u, p_v), steps != 0 ? 1 / steps : 0);
    if (!(dot3(n, n) > 0)) {
        return global3(SL_VAR_N, point);
    }
    const Triple3 Ng = global3(SL_VAR_Ng, point);
    const double side = dot3(cross3(global3(SL_VAR_dPdu, point), global3(SL_VAR_dPdv, point)), Ng);
    return (side != 0 ? side : dot3(n, Ng)) < 0 ? scale3(n, -1) : n;
}

// Finite differences to the neighbours; without neighbours, or where they are not active, 0 (sl.md
// 6).
bool Interpreter::area(const Stmt& s, const Mask& mask, int point, Value& result) {
    const std::string_view name = builtin_of(s).name;
    const bool is_step = name == "filterstep";
    if (name == "calculatenormal_d") {
        put(result,
            oriented_normal(point, at(s.args[0], point).triple(), at(s.args[1], point).triple()));
        return true;
    }
    if (name != "Du" && name != "Dv" && name != "Deriv" && name != "area" &&
        name != "calculatenormal" && !is_step) {
        return false;
    }
    int at_u = -1;
    int at_v = -1;
    host_.neighbours(point, at_u, at_v);
    at_u = at_u >= 0 && mask[static_cast<std::size_t>(at_u)] != 0 ? at_u : -1;
    at_v = at_v >= 0 && mask[static_cast<std::size_t>(at_v)] != 0 ? at_v : -1;
    const double du = global(SL_VAR_du, point).f();
    const double dv = global(SL_VAR_dv, point).f();
    const auto ratio = [](double a, double b) { return b != 0 ? a / b : 0.0; };
    const Value by_u = difference(s, is_step ? 1 : 0, point, 1, at_u);
    const Value by_v = difference(s, is_step ? 1 : 0, point, 2, at_v);
    if (name == "Du" || name == "Dv") {
        for (std::size_t i = 0; i < result.x.size(); ++i) {
            result.x[i] = name == "Du" ? ratio(by_u.at(i), du) : ratio(by_v.at(i), dv);
        }
    } else if (name == "Deriv") {
        const double den_u = difference(s, 1, point, 1, at_u).f();
        const double den_v = difference(s, 1, point, 2, at_v).f();
        for (std::size_t i = 0; i < result.x.size(); ++i) {
            result.x[i] = ratio(by_u.at(i), den_u) + ratio(by_v.at(i), den_v);
        }
    } else if (name == "area") {
        const Triple3 c = cross3(by_u.triple(), by_v.triple());
        result = Value(std::sqrt(dot3(c, c)));
    } else if (is_step) {
        const double edge = at(s.args[0], point).f();
        const double x = at(s.args[1], point).f();
        const double w = std::abs(by_u.f()) + std::abs(by_v.f());
        result = Value(w > 0 ? std::clamp((x + w / 2 - edge) / w, 0.0, 1.0) : x < edge ? 0.0 : 1.0);
    } else {
        put(result, oriented_normal(point, by_u.triple(), by_v.triple()));
    }
    return true;
}

// What has no meaning without an engine: maps are absent (the table's documented fallbacks).
void Interpreter::fallback(const Stmt& s, int point, Value& result) {
    const BuiltinRow& row = builtin_of(s);
    std::fill(result.x.begin(), result.x.end(), 0.0);
    if ((row.name == "texture" || row.name == "texture_d") && row.result.type == Type::Color &&
        at(s.args[0], point).text().empty()) {
        put(result, {1, 1, 1});
    }
}

} // namespace slc
