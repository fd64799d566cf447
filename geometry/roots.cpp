// SPDX-License-Identifier: Apache-2.0
#include "geometry/roots.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace geo {

Roots solve_quadratic(double a, double b, double c) {
    Roots r;
    const double disc = b * b - a * c;
    if (!(disc >= 0) || !std::isfinite(disc)) {
        return r;
    }
    const double q = -(b + std::copysign(std::sqrt(disc), b));
    if (q == 0) { // b = 0 and a c = 0
        if (a != 0) {
            r.add(0);
        }
        return r;
    }
    const double t0 = c / q, t1 = q / a;
    for (const double t : {std::min(t0, t1), std::max(t0, t1)}) {
        if (std::isfinite(t)) {
            r.add(t);
        }
    }
    return r;
}

namespace {

// Horner; c holds rising powers.
double value(std::span<const double> c, double t) {
    double f = 0;
    for (std::size_t i = c.size(); i-- > 0;) {
        f = f * t + c[i];
    }
    return f;
}

// Bound of the rounding error of value().
double rounding(std::span<const double> c, double t) {
    double sum = 0;
    for (std::size_t i = c.size(); i-- > 0;) {
        sum = sum * std::fabs(t) + std::fabs(c[i]);
    }
    return 2 * static_cast<double>(c.size()) * std::numeric_limits<double>::epsilon() * sum;
}

// The root between lo and hi, where the values have different signs.
double bracketed_root(std::span<const double> c, std::span<const double> derivative, double lo,
                      double hi, double f_lo) {
    double t = 0.5 * (lo + hi);
    for (int i = 0; i < 100 && lo < t && t < hi; ++i) {
        const double f = value(c, t);
        if (f == 0) {
            return t;
        }
        ((f < 0) == (f_lo < 0) ? lo : hi) = t;
        const double newton = t - f / value(derivative, t);
        const double next = newton > lo && newton < hi ? newton : 0.5 * (lo + hi);
        if (std::fabs(next - t) <= 2 * std::numeric_limits<double>::epsilon() * std::fabs(t)) {
            return next;
        }
        t = next;
    }
    return t;
}

// Roots of a polynomial between ends, given the rising roots of its derivative.
Roots roots_between(std::span<const double> c, std::span<const double> derivative,
                    const Roots& extrema, double t0, double t1) {
    Roots r;
    double lo = t0, f_lo = value(c, t0);
    for (int i = 0; i <= extrema.count; ++i) {
        const double hi =
            i < extrema.count ? std::clamp(extrema.t[static_cast<std::size_t>(i)], lo, t1) : t1;
        const double f_hi = value(c, hi);
        if (std::size_t(r.count) + 1 >= c.size()) {
            break;
        }
        if (f_lo == 0) {
            r.add(lo);
        } else if ((f_lo < 0) != (f_hi < 0) && f_hi != 0) {
            r.add(bracketed_root(c, derivative, lo, hi, f_lo));
        } else if (i < extrema.count && f_hi != 0 && std::fabs(f_hi) <= rounding(c, hi)) {
            r.add(hi); // touches
        }
        lo = hi;
        f_lo = f_hi;
    }
    if (f_lo == 0 && std::size_t(r.count) + 1 < c.size()) {
        r.add(lo);
    }
    return r;
}

} // namespace

Roots solve_quartic(const std::array<double, 5>& c, double t0, double t1) {
    const std::array<double, 4> d1{c[1], 2 * c[2], 3 * c[3], 4 * c[4]};
    const std::array<double, 3> d2{d1[1], 2 * d1[2], 3 * d1[3]};
    for (const double x : c) {
        if (!std::isfinite(x)) {
            return {};
        }
    }
    Roots inflections;
    for (const double t : solve_quadratic(d2[2], 0.5 * d2[1], d2[0])) {
        if (t > t0 && t < t1) {
            inflections.add(t);
        }
    }
    const Roots extrema = roots_between(d1, d2, inflections, t0, t1);
    return roots_between(c, d1, extrema, t0, t1);
}

} // namespace geo
