// SPDX-License-Identifier: Apache-2.0
// Decimal text to numbers, correctly rounded, at memory speed: most of a RIB file is numbers.
//
// In: a pointer into a buffer that is followed by a byte that cannot continue a number (the lexer's
// sentinel). Out: the value and the first byte behind it. Source of the fast path: Clinger, "How to
// Read Floating Point Numbers Accurately" (PLDI 1990): an integer below 2^53 times or over an exact
// power of ten rounds once.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>

namespace rib {

// A number as written: mantissa * 10^exponent10.
struct Decimal {
    const char* begin = nullptr; // behind the sign
    const char* end = nullptr;   // first byte behind; nullptr: not a number
    std::uint64_t mantissa = 0;  // the first 19 significant digits
    int exponent10 = 0;
    bool negative = false;
    bool is_integer = false; // written without point and exponent
    bool truncated = false;  // more digits than the mantissa holds
};

// ri.md 2.2: [+-] (digits [. digits*] | . digits) [(e|E) [+-] digits]. The caller checks that a
// delimiter follows.
[[nodiscard]] Decimal scan_decimal(const char* p);

// Nearest value, ties to even. Beyond the largest finite number: that number with its sign.
[[nodiscard]] float to_float(const Decimal& d);
[[nodiscard]] double to_double(const Decimal& d);
// Nearest float; out of range: the largest finite one with the sign.
[[nodiscard]] float narrow(double value);

// The common case at full speed: no exponent, at most 15 digits. end is nullptr when that does not
// hold; then scan_decimal() decides. Reads up to number_padding bytes behind the number.
struct PlainNumber {
    const char* end = nullptr;
    double value = 0; // correctly rounded
};
[[nodiscard]] PlainNumber scan_plain(const char* p);
constexpr int number_padding = 24;

// value is x correctly rounded to double. Whether rounding value to float rounds x correctly:
// double rounding goes wrong only where value lies exactly between two floats (or in the subnormal
// range).
[[nodiscard]] inline bool rounds_once(double value) {
    constexpr std::uint64_t low_mask = (1ull << 29) - 1, midpoint = 1ull << 28;
    const std::uint64_t bits = std::bit_cast<std::uint64_t>(value) & ~(1ull << 63);
    const std::uint64_t smallest_normal = 0x3810000000000000; // 2^-126
    const std::uint64_t largest = 0x47efffffe0000000;         // FLT_MAX
    return bits == 0 ||
           ((bits & low_mask) != midpoint && bits >= smallest_normal && bits <= largest);
}

// --- inline: called once for every number of a file ---

namespace detail {

constexpr double powers_of_ten[] = {1e0, 1e1, 1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                    1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};
constexpr std::uint64_t integer_powers[] = {1,      10,      100,      1000,     10000,
                                            100000, 1000000, 10000000, 100000000};

// Up to eight digits at once. Source: D. Lemire's parse_eight_digits, widened to shorter runs: the
// first byte that is no digit is found by its high bit, and a shift makes what precedes it an
// eight-digit number with leading zeros.
inline int eight_digits(const char* p, std::uint64_t& mantissa) {
    std::uint64_t x;
    std::memcpy(&x, p, 8);
    x ^= 0x3030303030303030;
    const std::uint64_t beyond = ((x + 0x7676767676767676) | x) & 0x8080808080808080;
    const int n = beyond == 0 ? 8 : std::countr_zero(beyond) / 8;
    if (n == 0) {
        return 0;
    }
    x <<= (8 - n) * 8;
    x = x * 10 + (x >> 8);
    x = (((x & 0x000000ff000000ff) * 0x000f424000000064) +
         (((x >> 16) & 0x000000ff000000ff) * 0x0000271000000001)) >>
        32;
    mantissa = mantissa * integer_powers[n] + (x & 0xffffffff);
    return n;
}

// Two steps: 16 digits always fit the mantissa.
inline int digits(const char* p, std::uint64_t& mantissa) {
    const int n = eight_digits(p, mantissa);
    return n < 8 ? n : 8 + eight_digits(p + 8, mantissa);
}

} // namespace detail

inline PlainNumber scan_plain(const char* p) {
    static_assert(std::endian::native == std::endian::little,
                  "eight_digits reads little-endian words");
    const bool negative = *p == '-';
    p += negative;
    std::uint64_t mantissa = 0;
    const int whole = detail::digits(p, mantissa);
    p += whole;
    int fraction = 0;
    if (*p == '.') {
        ++p;
        fraction = whole <= 8 ? detail::eight_digits(p, mantissa) : 16;
        if (fraction == 8) {
            std::uint64_t more = 0;
            const int n = detail::eight_digits(p + 8, more);
            mantissa = n <= 7 ? mantissa * detail::integer_powers[n] + more : mantissa;
            fraction += n;
        }
        p += fraction;
    }
    const char c = *p;
    if (whole + fraction == 0 || whole + fraction > 15 || c == 'e' || c == 'E') {
        return {};
    }
    const double value = static_cast<double>(mantissa) / detail::powers_of_ten[fraction];
    return {p, negative ? -value : value};
}

} // namespace rib
