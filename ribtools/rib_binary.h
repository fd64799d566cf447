// SPDX-License-Identifier: Apache-2.0
// The binary encoding of RIB (ri.md, section 3): first bytes, and the numbers that fit a few bytes.
// Shared by lexer and writer, so that both have one idea of it.
//
// All quantities are most significant byte first; numbers are signed, lengths and codes are not.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace rib {

namespace bin {
// First bytes of tokens; the last one of a range is named where the range has a meaning.
enum Code : unsigned char {
    Fixed = 0x80, // + 4 d + w: w+1 bytes, divided by 256^d
    LastFixed = 0x8f,
    ShortString = 0x90, // + w: w bytes
    LastShortString = 0x9f,
    LongString = 0xa0, // + l: l+1 bytes of length
    LastLongString = 0xa3,
    Float = 0xa4,
    Double = 0xa5,
    Request = 0xa6,    // 1 byte of code
    FloatArray = 0xc8, // + l: l+1 bytes of count
    LastFloatArray = 0xcb,
    DefineRequest = 0xcc, // 1 byte of code, a string
    DefineString = 0xcd,  // + w: w+1 bytes of code, a string
    LastDefineString = 0xce,
    StringRef = 0xcf, // + w: w+1 bytes of code
    LastStringRef = 0xd0,
    EndOfReply = 0xff
};
} // namespace bin

template <class T> [[nodiscard]] inline T big_endian(const char* p) {
    T x = 0;
    for (std::size_t i = 0; i < sizeof x; ++i) {
        x = static_cast<T>(x << 8 | static_cast<unsigned char>(p[i]));
    }
    return x;
}

// w+1 bytes, two's complement, divided by 256^d.
[[nodiscard]] inline double fixed_value(std::uint64_t bytes, unsigned d, unsigned w) {
    constexpr double scale[] = {1, 1.0 / 256, 1.0 / 65536, 1.0 / 16777216};
    const unsigned unused = 56 - 8 * w;
    return static_cast<double>(static_cast<std::int64_t>(bytes << unused) >> unused) * scale[d];
}

// A number of any form that lies before `end` as a whole and is finite; else end is null.
struct BinaryNumber {
    const char* end = nullptr;
    double value = 0;
};
[[nodiscard]] inline BinaryNumber binary_number(const char* p, const char* end) {
    const auto first = static_cast<unsigned char>(*p);
    if (first <= bin::LastFixed) {
        const unsigned w = first & 3u;
        if (end - p <= static_cast<std::ptrdiff_t>(w) + 1) {
            return {};
        }
        std::uint64_t bytes = 0;
        for (unsigned i = 1; i <= w + 1; ++i) {
            bytes = bytes << 8 | static_cast<unsigned char>(p[i]);
        }
        return {p + w + 2, fixed_value(bytes, (first - bin::Fixed) >> 2, w)};
    }
    if (first == bin::Float && end - p > 4) {
        const double value =
            static_cast<double>(std::bit_cast<float>(big_endian<std::uint32_t>(p + 1)));
        return std::isfinite(value) ? BinaryNumber{p + 5, value} : BinaryNumber{};
    }
    if (first == bin::Double && end - p > 8) {
        const double value = std::bit_cast<double>(big_endian<std::uint64_t>(p + 1));
        return std::isfinite(value) ? BinaryNumber{p + 9, value} : BinaryNumber{};
    }
    return {};
}

[[nodiscard]] inline bool is_binary_string(char c) {
    const auto first = static_cast<unsigned char>(c);
    return (first >= bin::ShortString && first <= bin::LastLongString) || first == bin::StringRef ||
           first == bin::LastStringRef;
}

} // namespace rib
