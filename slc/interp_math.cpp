// SPDX-License-Identifier: Apache-2.0
// Mathematical functions, sl.md 4.1, with the recommended edge cases; splines, 4.1.2.
#include "slc/interp_value.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace slc {

double pow_sl(double x, double y) {
    if (x == 0) {
        return y == 0 ? 1 : 0; // 0^0 = 1, 0^negative = 0
    }
    return x < 0 && y != std::floor(y) ? 0 : std::pow(x, y);
}

namespace {

using Args = std::vector<Value>&;

double log_sl(double x) {
    return std::log(x > 0 ? x : static_cast<double>(std::numeric_limits<float>::min()));
}

double sqrt_sl(double x) {
    return x > 0 ? std::sqrt(x) : 0;
}
double inversesqrt_sl(double x) {
    return x > 0 ? 1 / std::sqrt(x) : 0;
}
double sign_sl(double x) {
    return x < 0 ? -1 : x > 0 ? 1 : 0;
}

double smoothstep(double lo, double hi, double x) {
    if (x < lo) {
        return 0;
    }
    if (x >= hi) {
        return 1;
    }
    const double t = (x - lo) / (hi - lo);
    return t * t * (3 - 2 * t);
}

double clamp_sl(double a, double lo, double hi) {
    return a < lo ? lo : a > hi ? hi : a;
}

// result[i] = f(arg components i ...) for float and triple results alike.
template <class F> void by_component(Value& result, F f) {
    for (std::size_t i = 0; i < result.x.size(); ++i) {
        result.x[i] = f(i);
    }
}

void extreme(Args a, Value& r, bool largest) {
    by_component(r, [&](std::size_t i) {
        double best = a[0].at(i);
        for (const Value& v : a) {
            best = largest ? std::max(best, v.at(i)) : std::min(best, v.at(i));
        }
        return best;
    });
}

void mix(Args a, Value& r) {
    by_component(
        r, [&](std::size_t i) { return a[0].at(i) * (1 - a[2].at(i)) + a[1].at(i) * a[2].at(i); });
}

void clamp(Args a, Value& r) {
    by_component(r, [&](std::size_t i) { return clamp_sl(a[0].at(i), a[1].at(i), a[2].at(i)); });
}

// Integral of the step over the interval, sl.md 4.1.1.
void filterstep_between(Args a, Value& r) {
    const double edge = a[0].f();
    const double lo = std::min(a[1].f(), a[2].f());
    const double hi = std::max(a[1].f(), a[2].f());
    r.x[0] = hi > lo ? clamp_sl((hi - edge) / (hi - lo), 0, 1) : hi < edge ? 0 : 1;
}

// Basis matrices for [t^3 t^2 t 1] B [k0 k1 k2 k3]^T, sl.md 4.1.2.
struct Basis {
    std::string_view name;
    std::size_t step;
    double m[16];
};
constexpr double sixth = 1.0 / 6.0;
constexpr Basis bases[] = {
    {"catmull-rom", 1, {-.5, 1.5, -1.5, .5, 1, -2.5, 2, -.5, -.5, 0, .5, 0, 0, 1, 0, 0}},
    {"bspline",
     1,
     {-sixth, .5, -.5, sixth, .5, -1, .5, 0, -.5, 0, .5, 0, sixth, 4 * sixth, sixth, 0}},
    {"b-spline",
     1,
     {-sixth, .5, -.5, sixth, .5, -1, .5, 0, -.5, 0, .5, 0, sixth, 4 * sixth, sixth, 0}},
    {"bezier", 3, {-1, 3, -3, 1, 3, -6, 3, 0, -3, 3, 0, 0, 1, 0, 0, 0}},
    {"hermite", 2, {2, 1, -2, 1, -3, -2, 3, -1, 0, 1, 0, 0, 1, 0, 0, 0}},
    {"linear", 1, {0, 0, 0, 0, 0, 0, 0, 0, 0, -1, 1, 0, 0, 1, 0, 0}}};

const Basis& find_basis(std::string_view name) {
    const auto* const it = std::find_if(std::begin(bases), std::end(bases),
                                        [&](const Basis& b) { return b.name == name; });
    return it == std::end(bases) ? bases[0] : *it;
}

double spline_at(const Basis& basis, double value, const std::vector<double>& knots) {
    if (knots.size() < 4) {
        return 0;
    }
    const std::size_t segments = (knots.size() - 4) / basis.step + 1;
    const double x = clamp_sl(value, 0, 1) * static_cast<double>(segments);
    const std::size_t segment = std::min(static_cast<std::size_t>(x), segments - 1);
    const double t = x - static_cast<double>(segment);
    const double powers[] = {t * t * t, t * t, t, 1};
    double sum = 0;
    for (std::size_t row = 0; row < 4; ++row) {
        for (std::size_t k = 0; k < 4; ++k) {
            sum += powers[row] * basis.m[4 * row + k] * knots[segment * basis.step + k];
        }
    }
    return sum;
}

// x with spline(x) = value for monotone knots, by bisection; values outside the range clamp.
double spline_inverse(const Basis& basis, double value, const std::vector<double>& knots) {
    double lo = 0;
    double hi = 1;
    const bool rising = spline_at(basis, 0, knots) <= spline_at(basis, 1, knots);
    for (int i = 0; i < 60; ++i) {
        const double middle = (lo + hi) / 2;
        const bool below = rising == (spline_at(basis, middle, knots) < value);
        (below ? lo : hi) = middle;
    }
    return (lo + hi) / 2;
}

void spline(Args a, Value& r) {
    std::size_t first = 0;
    std::string name = "catmull-rom";
    if (a[0].type == Type::String) {
        name = a[0].text();
        first = 1;
    }
    const double value = a[first].f();
    const bool solve = name.starts_with("solve");
    if (solve) {
        name.erase(0, 5);
    }
    const Basis& basis = find_basis(name);
    const std::size_t n = r.x.size();
    for (std::size_t c = 0; c < n; ++c) {
        std::vector<double> knots;
        for (std::size_t i = first + 1; i < a.size(); ++i) { // values, or one array of them
            for (std::size_t k = c; k < a[i].x.size(); k += n) {
                knots.push_back(a[i].x[k]);
            }
        }
        r.x[c] = solve ? spline_inverse(basis, value, knots) : spline_at(basis, value, knots);
    }
}

// Function objects without state, as pure functions of one or two floats.
template <class F> PureFunction unary(F) {
    return [](Args a, Value& r) { r.x[0] = F{}(a[0].f()); };
}
template <class F> PureFunction binary(F) {
    return [](Args a, Value& r) { r.x[0] = F{}(a[0].f(), a[1].f()); };
}

constexpr double degree = std::numbers::pi / 180;

} // namespace

std::vector<PureEntry> pure_math() {
    return {
        {"radians", unary([](double x) { return x * degree; })},
        {"degrees", unary([](double x) { return x / degree; })},
        {"sin", unary([](double x) { return std::sin(x); })},
        {"asin", unary([](double x) { return std::asin(clamp_sl(x, -1, 1)); })},
        {"cos", unary([](double x) { return std::cos(x); })},
        {"acos", unary([](double x) { return std::acos(clamp_sl(x, -1, 1)); })},
        {"tan", unary([](double x) { return std::tan(x); })},
        {"atan", unary([](double x) { return std::atan(x); })},
        {"atan2",
         binary([](double y, double x) { return y == 0 && x == 0 ? 0.0 : std::atan2(y, x); })},
        {"pow", binary([](double x, double y) { return pow_sl(x, y); })},
        {"exp", unary([](double x) { return std::exp(x); })},
        {"sqrt", unary([](double x) { return sqrt_sl(x); })},
        {"inversesqrt", unary([](double x) { return inversesqrt_sl(x); })},
        {"log", unary([](double x) { return log_sl(x); })},
        {"log_base", binary([](double x, double base) { return log_sl(x) / log_sl(base); })},
        {"mod",
         binary([](double a, double b) { return b == 0 ? 0.0 : a - b * std::floor(a / b); })},
        {"abs", unary([](double x) { return std::abs(x); })},
        {"sign", unary([](double x) { return sign_sl(x); })},
        {"floor", unary([](double x) { return std::floor(x); })},
        {"ceil", unary([](double x) { return std::ceil(x); })},
        {"round", unary([](double x) { return std::floor(x + 0.5); })},
        {"step", binary([](double edge, double x) { return x < edge ? 0.0 : 1.0; })},
        {"smoothstep", [](Args a, Value& r) { r.x[0] = smoothstep(a[0].f(), a[1].f(), a[2].f()); }},
        {"erf", unary([](double x) { return std::erf(x); })},
        {"erfc", unary([](double x) { return std::erfc(x); })},
        {"min_f", [](Args a, Value& r) { extreme(a, r, false); }},
        {"min_3", [](Args a, Value& r) { extreme(a, r, false); }},
        {"max_f", [](Args a, Value& r) { extreme(a, r, true); }},
        {"max_3", [](Args a, Value& r) { extreme(a, r, true); }},
        {"clamp_f", clamp},
        {"clamp_3", clamp},
        {"filterstep_between", filterstep_between},
        {"mix_f", mix},
        {"mix_3", mix},
        {"mix_33", mix},
        {"spline_f", spline},
        {"spline_3", spline},
    };
}

} // namespace slc
