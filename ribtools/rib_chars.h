// SPDX-License-Identifier: Apache-2.0
// What the bytes of a RIB stream are (ri.md 2.1): for the lexer and for whoever writes what it
// shall read.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace rib {

enum CharClass : std::uint8_t { Regular, White, LineEnd, Delimiter, High };

constexpr std::array<CharClass, 256> make_classes() {
    std::array<CharClass, 256> c{};
    for (std::size_t i = 128; i < 256; ++i) {
        c[i] = High;
    }
    c[' '] = c['\t'] = c['\f'] = c['\v'] = White;
    c['\n'] = c['\r'] = LineEnd;
    c['"'] = c['['] = c[']'] = c['#'] = Delimiter;
    return c;
}
constexpr std::array<CharClass, 256> classes = make_classes();

[[nodiscard]] constexpr CharClass class_of(char c) {
    return classes[static_cast<unsigned char>(c)];
}

[[nodiscard]] constexpr bool starts_number(char c) {
    return (c >= '0' && c <= '9') || c == '-' || c == '+' || c == '.';
}

// The longest name or number; a longer run of regular characters is garbage.
constexpr std::size_t max_run = 64 * 1024;

// Whether the text, standing between delimiters, is one token: a name or number, well-formed or
// not.
[[nodiscard]] constexpr bool is_run(std::string_view text) {
    if (text.empty() || text.size() >= max_run) {
        return false;
    }
    for (const char c : text) {
        if (class_of(c) != Regular) {
            return false;
        }
    }
    return true;
}
[[nodiscard]] constexpr bool is_request_name(std::string_view text) {
    return is_run(text) && !starts_number(text.front());
}

} // namespace rib
