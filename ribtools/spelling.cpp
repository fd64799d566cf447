// SPDX-License-Identifier: Apache-2.0
#include "ribtools/spelling.h"

#include <algorithm>
#include <array>
#include <cstdio>

namespace rib {

namespace {

constexpr std::size_t max_length = 64;

char lower(char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

} // namespace

std::size_t edit_distance(std::string_view a, std::string_view b) {
    if (a.size() > max_length || b.size() > max_length) {
        return 1000;
    }
    std::array<std::size_t, max_length + 1> line{};
    for (std::size_t j = 0; j <= b.size(); ++j) {
        line[j] = j;
    }
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = line[0];
        line[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t change = diagonal + (lower(a[i - 1]) == lower(b[j - 1]) ? 0 : 1);
            diagonal = line[j];
            line[j] = std::min({change, line[j] + 1, line[j - 1] + 1});
        }
    }
    return line[b.size()];
}

void Nearest::offer(std::string_view candidate) {
    const std::size_t distance = edit_distance(wanted_, candidate);
    // A third of the letters may differ; short names tolerate one.
    const std::size_t limit = std::max<std::size_t>(1, wanted_.size() / 3);
    if (distance <= limit && distance < best_distance_) {
        best_distance_ = distance;
        best_ = candidate;
    }
}

std::string printable(std::string_view text) {
    constexpr std::size_t max_shown = 60;
    std::string out;
    for (const char c : text.substr(0, max_shown)) {
        if (c >= ' ' && c < 0x7f) {
            out += c;
        } else {
            char code[8];
            std::snprintf(code, sizeof code, "\\%03o",
                          static_cast<unsigned>(static_cast<unsigned char>(c)));
            out += code;
        }
    }
    return text.size() > max_shown ? out + "..." : out;
}

} // namespace rib
