// SPDX-License-Identifier: Apache-2.0
#include "tracer/html_text.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace trace {

namespace {

constexpr std::string_view replacement = "\xEF\xBF\xBD"; // U+FFFD

bool is_continuation(char c) {
    return (static_cast<unsigned char>(c) & 0xc0U) == 0x80U;
}

// Bytes of the character that text starts with; 0: not UTF-8 (RFC 3629: no overlong forms, no
// surrogates, nothing beyond U+10FFFF).
std::size_t character_bytes(std::string_view text) {
    const auto first = static_cast<unsigned char>(text[0]);
    const std::size_t n = first < 0x80   ? 1
                          : first < 0xc2 ? 0
                          : first < 0xe0 ? 2
                          : first < 0xf0 ? 3
                          : first < 0xf5 ? 4
                                         : 0;
    if (n == 0 || n > text.size()) {
        return 0;
    }
    for (std::size_t i = 1; i < n; ++i) {
        if (!is_continuation(text[i])) {
            return 0;
        }
    }
    const auto second = n > 1 ? static_cast<unsigned char>(text[1]) : 0U;
    const bool is_bad = (first == 0xe0 && second < 0xa0) || (first == 0xed && second > 0x9f) ||
                        (first == 0xf0 && second < 0x90) || (first == 0xf4 && second > 0x8f);
    return is_bad ? 0 : n;
}

std::string_view entity(char c) {
    switch (c) {
    case '&':
        return "&amp;";
    case '<':
        return "&lt;";
    case '>':
        return "&gt;";
    case '"':
        return "&quot;";
    case '\'':
        return "&#39;";
    default:
        return {};
    }
}

} // namespace

std::string escaped(std::string_view text) {
    std::string out;
    while (!text.empty()) {
        const std::size_t n = character_bytes(text);
        const char c = text[0];
        const bool is_control = n == 1 && (static_cast<unsigned char>(c) < 0x20 || c == 0x7f);
        if (n == 0 || (is_control && c != '\n' && c != '\t')) {
            out += replacement;
        } else if (const std::string_view special = n == 1 ? entity(c) : std::string_view();
                   !special.empty()) {
            out += special;
        } else {
            out += text.substr(0, n);
        }
        text.remove_prefix(n == 0 ? 1 : n);
    }
    return out;
}

std::string base64(std::string_view bytes) { // RFC 4648
    constexpr std::string_view digits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    out.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t at = 0; at < bytes.size(); at += 3) {
        const std::size_t n = bytes.size() - at < 3 ? bytes.size() - at : 3;
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            group = group << 8 | (k < n ? static_cast<unsigned char>(bytes[at + k]) : 0U);
        }
        for (std::size_t k = 0; k < 4; ++k) {
            out += k <= n ? digits[group >> (18 - 6 * k) & 63U] : '=';
        }
    }
    return out;
}

} // namespace trace
