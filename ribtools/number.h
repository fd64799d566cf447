// SPDX-License-Identifier: Apache-2.0
// Decimal text to numbers, correctly rounded, at memory speed: most of a RIB file is numbers.
//
// In: a pointer into a buffer that is followed by a byte that cannot continue a number (the lexer's
// sentinel). Out: the value and the first byte behind it. Source of the fast path: Clinger, "How to
// Read Floating Point Numbers Accurately" (PLDI 1990): an integer below 2^53 times or over an exact
// power of ten rounds once.
#pragma once

#include <cstdint>

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

} // namespace rib
