// SPDX-License-Identifier: Apache-2.0
#include "ribtools/number.h"

#include <cfloat>
#include <charconv>
#include <cmath>
#include <system_error>

namespace rib {

namespace {

constexpr double exact_powers[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                   1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                   1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
constexpr int max_exact_power = 22;
constexpr int max_digits = 19; // of an uint64
constexpr int exponent_limit = 100'000;

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

// Digits into the mantissa; those that do not fit are counted in *dropped.
const char* scan_digits(const char* p, Decimal& d, int& significant, int& dropped) {
    for (; is_digit(*p); ++p) {
        if (significant < max_digits) {
            d.mantissa = d.mantissa * 10 + static_cast<unsigned>(*p - '0');
            significant += d.mantissa != 0;
        } else {
            d.truncated |= *p != '0';
            dropped += dropped < exponent_limit;
        }
    }
    return p;
}

// Exact to double rounding: nullopt-like false when the fast path does not apply.
bool fast_double(const Decimal& d, double& value) {
    if (d.truncated || d.mantissa > (1ull << 53) || d.exponent10 < -max_exact_power ||
        d.exponent10 > max_exact_power) {
        return false;
    }
    const double m = static_cast<double>(d.mantissa);
    value = d.exponent10 < 0 ? m / exact_powers[-d.exponent10] : m * exact_powers[d.exponent10];
    return true;
}

template <class T> T slow(const Decimal& d, T largest) {
    T value = 0;
    const auto result = std::from_chars(d.begin, d.end, value);
    if (result.ec == std::errc::result_out_of_range) {
        // 19 digits at most lie before the exponent: its sign tells overflow from underflow.
        value = d.mantissa != 0 && d.exponent10 > 0 ? largest : T(0);
    }
    return d.negative ? -value : value;
}

} // namespace

Decimal scan_decimal(const char* p) {
    Decimal d;
    if (*p == '-' || *p == '+') {
        d.negative = *p == '-';
        ++p;
    }
    d.begin = p;
    int significant = 0, dropped = 0;
    const char* after = scan_digits(p, d, significant, dropped);
    bool has_digits = after != p;
    d.is_integer = true;
    d.exponent10 = dropped;
    p = after;
    if (*p == '.') {
        d.is_integer = false;
        int dropped_fraction = 0;
        after = scan_digits(p + 1, d, significant, dropped_fraction);
        const auto fraction = after - (p + 1);
        has_digits |= fraction > 0;
        d.exponent10 -= static_cast<int>(fraction < exponent_limit ? fraction : exponent_limit) -
                        dropped_fraction;
        p = after;
    }
    if (!has_digits) {
        return d;
    }
    if (*p == 'e' || *p == 'E') {
        d.is_integer = false;
        ++p;
        const bool negative = *p == '-';
        p += *p == '-' || *p == '+';
        if (!is_digit(*p)) {
            return d;
        }
        int exponent = 0;
        for (; is_digit(*p); ++p) {
            exponent = exponent < exponent_limit ? exponent * 10 + (*p - '0') : exponent;
        }
        d.exponent10 += negative ? -exponent : exponent;
    }
    d.end = p;
    return d;
}

double to_double(const Decimal& d) {
    double value = 0;
    if (fast_double(d, value)) {
        return d.negative ? -value : value;
    }
    return slow(d, DBL_MAX);
}

float to_float(const Decimal& d) {
    double value = 0;
    if (fast_double(d, value) && rounds_once(value)) {
        return static_cast<float>(d.negative ? -value : value);
    }
    return slow(d, FLT_MAX);
}

float narrow(double value) {
    constexpr double largest = FLT_MAX;
    return static_cast<float>(std::fmin(std::fmax(value, -largest), largest));
}

} // namespace rib
