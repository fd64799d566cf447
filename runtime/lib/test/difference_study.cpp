// SPDX-License-Identifier: Apache-2.0
// Accuracy of derivatives: expressions as shaders hold them, at positions 1 ... 1e6 and steps 1e-6
// ... 1e-1, by differences of float values, by propagated differences (what slc emits), and by
// float dual numbers, against the same difference in 80-bit floats; truncation against the analytic
// derivative apart. Out: JSON lines; without arguments a summary, with --all one line per
// expression, position and step (docs/derivatives.md, testsuite/plot_differences.py).
#define SL_LANES 4
#include "runtime/lib/test/reference.h"
#include "sl_shader.h"

#include <cmath>
#include <cstdio>
#include <cstring>
#include <random>
#include <vector>

namespace {

using Real = long double;
namespace ref = lanes_test::reference;

// --- numbers: each with the functions that expressions use

template <class T> struct Plain { T x; };
// A float, by the built-in functions of shaders.
using Value = Plain<float>;
// The real numbers.
using Wide = Plain<Real>;
// A float and its difference to the auxiliary point.
struct Moving {
    float x, d;
};
// A number and its derivative along the step.
template <class T> struct Dual { T x, d; };

template <class T> Plain<T> operator+(Plain<T> a, Plain<T> b) {
    return {a.x + b.x};
}
template <class T> Plain<T> operator-(Plain<T> a, Plain<T> b) {
    return {a.x - b.x};
}
template <class T> Plain<T> operator*(Plain<T> a, Plain<T> b) {
    return {a.x * b.x};
}
template <class T> Plain<T> operator/(Plain<T> a, Plain<T> b) {
    return {a.x / b.x};
}
Value sin(Value a) {
    return {slu_sin(a.x)};
}
Value exp(Value a) {
    return {slu_exp(a.x)};
}
Value abs(Value a) {
    return {slu_abs(a.x)};
}
Value min(Value a, Value b) {
    return {slu_min_f(a.x, b.x)};
}
Value mod(Value a, float b) {
    return {slu_mod(a.x, b)};
}
Value floor(Value a) {
    return {slu_floor(a.x)};
}
Value pow(Value a, float b) {
    return {slu_pow(a.x, b)};
}
Value smoothstep(float lo, float hi, Value a) {
    return {slu_smoothstep(lo, hi, a.x)};
}
Value length(Value x, Value y, Value z) {
    return {slu_length(slu_make_3(x.x, y.x, z.x))};
}
Value noise(Value x, Value y, Value z) {
    return {slu_noise_f_3(slu_make_3(x.x, y.x, z.x))};
}
void normalize(Value& x, Value& y, Value& z) {
    const slu3 n = slu_normalize(slu_make_3(x.x, y.x, z.x));
    x.x = n.x, y.x = n.y, z.x = n.z;
}

Moving operator+(Moving a, Moving b) {
    return {a.x + b.x, a.d + b.d};
}
Moving operator-(Moving a, Moving b) {
    return {a.x - b.x, a.d - b.d};
}
Moving operator*(Moving a, Moving b) {
    return {a.x * b.x, a.d * (b.x + b.d) + a.x * b.d};
}
Moving operator/(Moving a, Moving b) {
    const float q = a.x / b.x;
    return {q, (a.d - q * b.d) / (b.x + b.d)};
}
Moving sin(Moving a) {
    return {slu_sin(a.x), slu_sin_d(a.x, a.d)};
}
Moving exp(Moving a) {
    return {slu_exp(a.x), slu_exp_d(a.x, a.d)};
}
Moving abs(Moving a) {
    return {slu_abs(a.x), slu_abs_d(a.x, a.d)};
}
Moving min(Moving a, Moving b) {
    return {slu_min_f(a.x, b.x), slu_min_f_d(a.x, b.x, a.d, b.d)};
}
Moving mod(Moving a, float b) {
    return {slu_mod(a.x, b), slu_mod_d(a.x, b, a.d, 0)};
}
Moving floor(Moving a) {
    return {slu_floor(a.x), slu_floor_d(a.x, a.d)};
}
Moving pow(Moving a, float b) {
    return {slu_pow(a.x, b), slu_pow_d(a.x, b, a.d, 0)};
}
Moving smoothstep(float lo, float hi, Moving a) {
    return {slu_smoothstep(lo, hi, a.x), slu_smoothstep_d(lo, hi, a.x, 0, 0, a.d)};
}
Moving length(Moving x, Moving y, Moving z) {
    const slu3 p = slu_make_3(x.x, y.x, z.x), d = slu_make_3(x.d, y.d, z.d);
    return {slu_length(p), slu_length_d(p, d)};
}
Moving noise(Moving x, Moving y, Moving z) {
    const slu3 p = slu_make_3(x.x, y.x, z.x), d = slu_make_3(x.d, y.d, z.d);
    return {slu_noise_f_3(p), slu_noise_f_3_d(p, d)};
}
void normalize(Moving& x, Moving& y, Moving& z) {
    const slu3 p = slu_make_3(x.x, y.x, z.x);
    const slu3 n = slu_normalize(p), d = slu_normalize_d(p, slu_make_3(x.d, y.d, z.d));
    x = {n.x, d.x}, y = {n.y, d.y}, z = {n.z, d.z};
}

template <class T> Dual<T> operator+(Dual<T> a, Dual<T> b) {
    return {a.x + b.x, a.d + b.d};
}
template <class T> Dual<T> operator-(Dual<T> a, Dual<T> b) {
    return {a.x - b.x, a.d - b.d};
}
template <class T> Dual<T> operator*(Dual<T> a, Dual<T> b) {
    return {a.x * b.x, a.d * b.x + a.x * b.d};
}
template <class T> Dual<T> operator/(Dual<T> a, Dual<T> b) {
    const T q = a.x / b.x;
    return {q, (a.d - q * b.d) / b.x};
}
template <class T> Dual<T> sin(Dual<T> a) {
    return {std::sin(a.x), std::cos(a.x) * a.d};
}
template <class T> Dual<T> exp(Dual<T> a) {
    return {std::exp(a.x), std::exp(a.x) * a.d};
}
template <class T> Dual<T> abs(Dual<T> a) {
    return {std::abs(a.x), a.x < 0 ? -a.d : a.d};
}
template <class T> Dual<T> min(Dual<T> a, Dual<T> b) {
    return b.x < a.x ? b : a;
}
template <class T> Dual<T> mod(Dual<T> a, float b) {
    return {ref::mod(a.x, T(b)), a.d};
}
template <class T> Dual<T> floor(Dual<T> a) {
    return {std::floor(a.x), 0};
}
template <class T> Dual<T> pow(Dual<T> a, float b) {
    return {ref::power(a.x, T(b)), T(b) * ref::power(a.x, T(b) - 1) * a.d};
}
template <class T> Dual<T> smoothstep(float lo, float hi, Dual<T> a) {
    const T t = (a.x - T(lo)) / (T(hi) - T(lo));
    const bool on = t > 0 && t < 1;
    return {ref::smoothstep(T(lo), T(hi), a.x), on ? 6 * t * (1 - t) * a.d / (T(hi) - T(lo)) : 0};
}
template <class T> Dual<T> length(Dual<T> x, Dual<T> y, Dual<T> z) {
    const T l = std::sqrt(x.x * x.x + y.x * y.x + z.x * z.x);
    return {l, (x.x * x.d + y.x * y.d + z.x * z.d) / l};
}
template <class T> void normalize(Dual<T>& x, Dual<T>& y, Dual<T>& z) {
    const Dual<T> l = length(x, y, z);
    x = x / l, y = y / l, z = z / l;
}
// The polynomial's tangent: the change over a step too short for its curvature.
Dual<float> noise(Dual<float> x, Dual<float> y, Dual<float> z) {
    const slu3 p = slu_make_3(x.x, y.x, z.x);
    const float short_step = 0x1p-30f;
    const slu3 d = slu_make_3(x.d * short_step, y.d * short_step, z.d * short_step);
    return {slu_noise_f_3(p), slu_noise_f_3_d(p, d) / short_step};
}
// Central difference of 80-bit floats; its error, h^2 times the third derivative, is below 1e-8.
Dual<Real> noise(Dual<Real> x, Dual<Real> y, Dual<Real> z) {
    const Real size = std::sqrt(x.d * x.d + y.d * y.d + z.d * z.d), h = size > 0 ? 1e-5L / size : 0;
    const Real p[3] = {x.x, y.x, z.x};
    const Real after[3] = {x.x + h * x.d, y.x + h * y.d, z.x + h * z.d};
    const Real before[3] = {x.x - h * x.d, y.x - h * y.d, z.x - h * z.d};
    const Real rise = ref::noise<Real>(3, 0, after) - ref::noise<Real>(3, 0, before);
    return {ref::noise<Real>(3, 0, p), h > 0 ? rise / (2 * h) : 0};
}

Wide sin(Wide a) {
    return {std::sin(a.x)};
}
Wide exp(Wide a) {
    return {std::exp(a.x)};
}
Wide abs(Wide a) {
    return {std::abs(a.x)};
}
Wide min(Wide a, Wide b) {
    return b.x < a.x ? b : a;
}
Wide mod(Wide a, float b) {
    return {ref::mod<Real>(a.x, b)};
}
Wide floor(Wide a) {
    return {std::floor(a.x)};
}
Wide pow(Wide a, float b) {
    return {ref::power<Real>(a.x, b)};
}
Wide smoothstep(float lo, float hi, Wide a) {
    return {ref::smoothstep<Real>(lo, hi, a.x)};
}
Wide length(Wide x, Wide y, Wide z) {
    return {std::sqrt(x.x * x.x + y.x * y.x + z.x * z.x)};
}
Wide noise(Wide x, Wide y, Wide z) {
    const Real p[3] = {x.x, y.x, z.x};
    return {ref::noise<Real>(3, 0, p)};
}
void normalize(Wide& x, Wide& y, Wide& z) {
    const Wide l = length(x, y, z);
    x = x / l, y = y / l, z = z / l;
}

template <class N> N constant(float x) {
    if constexpr (std::is_same_v<N, Value> || std::is_same_v<N, Wide>)
        return {x};
    else
        return {x, 0};
}

// --- expressions of a point; c is a fixed point about 1 away

template <class N> struct Point { N x, y, z; };

template <class N> Point<N> from(const Point<N>& p, const float* c) {
    return {p.x - constant<N>(c[0]), p.y - constant<N>(c[1]), p.z - constant<N>(c[2])};
}

template <class N> N fbm(const Point<N>& p, int octaves) {
    N sum = constant<N>(0);
    float frequency = 1;
    for (int i = 0; i < octaves; i++, frequency *= 2) {
        const N k = constant<N>(frequency);
        sum = sum + abs(noise(p.x * k, p.y * k, p.z * k) - constant<N>(0.5f)) / k;
    }
    return sum;
}

template <class N> N pulse(float width, N x) {
    return smoothstep(0, width, x) - smoothstep(1 - width, 1, x);
}

template <class N> N polynomial(const Point<N>& p, const float*) {
    return p.x * p.x * p.y - constant<N>(3) * p.x * p.z + p.y;
}
template <class N> N sine(const Point<N>& p, const float*) {
    return sin(constant<N>(10) * p.x);
}
template <class N> N one_noise(const Point<N>& p, const float*) {
    return noise(p.x, p.y, p.z);
}
template <class N> N turbulence(const Point<N>& p, const float*) {
    return fbm(p, 6);
}
template <class N> N marble(const Point<N>& p, const float*) {
    const N wave = sin(p.x + constant<N>(4) * fbm(p, 6));
    return pow(constant<N>(0.5f) + constant<N>(0.5f) * wave, 2.5f);
}
template <class N> N sphere_distance(const Point<N>& p, const float* c) {
    const Point<N> q = from(p, c);
    return length(q.x, q.y, q.z) - constant<N>(1);
}
template <class N> N union_of_spheres(const Point<N>& p, const float* c) {
    const Point<N> q = from(p, c);
    const N other = length(q.x + constant<N>(0.5f), q.y, q.z) - constant<N>(0.5f);
    return min(length(q.x, q.y, q.z) - constant<N>(1), other);
}
template <class N> N unit_vector(const Point<N>& p, const float* c) {
    Point<N> q = from(p, c);
    normalize(q.x, q.y, q.z);
    return q.x * constant<N>(0.5f) + q.y * constant<N>(0.25f) + q.z;
}
template <class N> N soft_ring(const Point<N>& p, const float* c) {
    const Point<N> q = from(p, c);
    return smoothstep(0.2f, 1.6f, length(q.x, q.y, q.z));
}
template <class N> N bricks(const Point<N>& p, const float*) {
    const N t = p.y * constant<N>(2), row = floor(t);
    const N s = p.x + constant<N>(0.5f) * mod(row, 2);
    return pulse(0.15f, mod(s, 1)) * pulse(0.25f, mod(t, 1));
}
template <class N> N quotient(const Point<N>& p, const float* c) {
    const Point<N> q = from(p, c);
    return q.x / (constant<N>(1) + q.x * q.x + q.y * q.y);
}
template <class N> N projection(const Point<N>& p, const float*) {
    return p.x / (p.z * p.z / (abs(p.z) + constant<N>(1)) + abs(p.y));
}
template <class N> N falloff(const Point<N>& p, const float* c) {
    const Point<N> q = from(p, c);
    return exp(constant<N>(-2) * (q.x * q.x + q.y * q.y + q.z * q.z));
}

// --- measuring

struct Sample {
    float p[3], d[3], c[3];
};

struct Expression {
    const char* name;
    Value (*value)(const Point<Value>&, const float*);
    Moving (*moving)(const Point<Moving>&, const float*);
    Dual<float> (*dual)(const Point<Dual<float>>&, const float*);
    Dual<Real> (*analytic)(const Point<Dual<Real>>&, const float*);
    Wide (*wide)(const Point<Wide>&, const float*);
};

#define EXPRESSION(name, f)                                                                        \
    { name, f<Value>, f<Moving>, f<Dual<float>>, f<Dual<Real>>, f<Wide> }
const Expression expressions[] = {
    EXPRESSION("polynomial", polynomial),
    EXPRESSION("sine", sine),
    EXPRESSION("noise", one_noise),
    EXPRESSION("turbulence", turbulence),
    EXPRESSION("marble", marble),
    EXPRESSION("distance", sphere_distance),
    EXPRESSION("union", union_of_spheres),
    EXPRESSION("unit vector", unit_vector),
    EXPRESSION("smoothstep", soft_ring),
    EXPRESSION("bricks", bricks),
    EXPRESSION("quotient", quotient),
    EXPRESSION("projection", projection),
    EXPRESSION("exponential falloff", falloff),
};

std::vector<Sample> samples(double position, double step, int count) {
    std::mt19937 rng(7);
    std::uniform_real_distribution<double> in(-1, 1);
    std::vector<Sample> all(static_cast<std::size_t>(count));
    for (Sample& s : all) {
        double u[3], v[3], squares[2] = {};
        for (int k = 0; k < 3; k++) {
            u[k] = in(rng), v[k] = in(rng);
            squares[0] += u[k] * u[k], squares[1] += v[k] * v[k];
        }
        for (int k = 0; k < 3; k++) {
            s.p[k] = static_cast<float>(position * u[k] / std::sqrt(squares[0]));
            s.d[k] = static_cast<float>(step * v[k] / std::sqrt(squares[1]));
            s.c[k] = static_cast<float>(s.p[k] + in(rng));
        }
    }
    return all;
}

struct Errors {
    double p50, p99, worst;
};

Errors errors(std::vector<double> e, double scale) {
    for (double& x : e)
        x = scale > 0 ? x / scale : x;
    std::sort(e.begin(), e.end());
    return {e[e.size() / 2], e[e.size() * 99 / 100], e.back()};
}

struct Result {
    Errors values, propagated, duals;
    double truncation;    // of derivative times step, median, against the difference
    double dual_rounding; // of the float derivative against the analytic one, 99 %
    bool finite = true;
};

Result measure(const Expression& e, double position, double step) {
    std::vector<double> by_values, by_moving, by_duals, truncation, rounding;
    double squares = 0;
    Result r{};
    const std::vector<Sample> all = samples(position, step, 400);
    for (const Sample& s : all) {
        const float *p = s.p, *d = s.d;
        const Real want =
            e.wide({{Real(p[0]) + d[0]}, {Real(p[1]) + d[1]}, {Real(p[2]) + d[2]}}, s.c).x -
            e.wide({{p[0]}, {p[1]}, {p[2]}}, s.c).x;
        const float moved = e.value({{p[0] + d[0]}, {p[1] + d[1]}, {p[2] + d[2]}}, s.c).x -
                            e.value({{p[0]}, {p[1]}, {p[2]}}, s.c).x;
        const float propagated = e.moving({{p[0], d[0]}, {p[1], d[1]}, {p[2], d[2]}}, s.c).d;
        const float dual = e.dual({{p[0], d[0]}, {p[1], d[1]}, {p[2], d[2]}}, s.c).d;
        const Real tangent = e.analytic({{p[0], d[0]}, {p[1], d[1]}, {p[2], d[2]}}, s.c).d;
        const auto distance = [](Real a, Real b) { return static_cast<double>(std::abs(a - b)); };
        by_values.push_back(distance(moved, want));
        by_moving.push_back(distance(propagated, want));
        by_duals.push_back(distance(dual, want));
        truncation.push_back(distance(tangent, want));
        rounding.push_back(distance(dual, tangent));
        squares += static_cast<double>(want * want);
        r.finite = r.finite && std::isfinite(propagated);
    }
    const double scale = std::sqrt(squares / static_cast<double>(all.size()));
    r.values = errors(by_values, scale);
    r.propagated = errors(by_moving, scale);
    r.duals = errors(by_duals, scale);
    r.truncation = errors(truncation, scale).p50;
    r.dual_rounding = errors(rounding, scale).p99;
    return r;
}

constexpr double positions[] = {1, 10, 100, 1e3, 1e4, 1e5, 1e6};
constexpr double steps[] = {1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1};

void print_all(const Expression& e) {
    for (const double position : positions)
        for (const double step : steps) {
            const Result r = measure(e, position, step);
            std::printf(
                "{\"expression\": \"%s\", \"position\": %g, \"step\": %g, \"values\": %.3g, "
                "\"propagated\": %.3g, \"duals\": %.3g, \"values_median\": %.3g, "
                "\"propagated_median\": %.3g, \"duals_median\": %.3g, \"truncation\": %.3g, "
                "\"dual_rounding\": %.3g}\n",
                e.name, position, step, r.values.p99, r.propagated.p99, r.duals.p99, r.values.p50,
                r.propagated.p50, r.duals.p50, r.truncation, r.dual_rounding);
        }
}

// Non-finite differences count as an error of 1e30.
void print_summary(const Expression& e) {
    double worst = 0, at_position = 0, at_step = 0, values = 0;
    for (const double position : positions)
        for (const double step : steps) {
            const Result r = measure(e, position, step);
            const double error = r.finite ? r.propagated.p99 : 1e30;
            if (error > worst)
                worst = error, at_position = position, at_step = step;
            values = std::max(values, r.values.p99);
        }
    std::printf(
        "{\"name\": \"difference of %s\", \"value\": %.3g, \"unit\": \"relative error\", "
        "\"better\": \"lower\", \"error\": \"99 %% of points\", \"note\": \"worst of 42 "
        "positions and steps, at position %g, step %g; difference of float values: %.2g\"}\n",
        e.name, worst, at_position, at_step, values);
}

} // namespace

int main(int argc, char** argv) {
    const bool all = argc > 1 && std::strcmp(argv[1], "--all") == 0;
    for (const Expression& e : expressions)
        all ? print_all(e) : print_summary(e);
    return 0;
}
