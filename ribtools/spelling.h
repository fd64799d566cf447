// SPDX-License-Identifier: Apache-2.0
// "did you mean": the nearest of a set of names by edit distance, ignoring case.
#pragma once

#include <string>
#include <string_view>

namespace rib {

class Nearest {
public:
    explicit Nearest(std::string_view wanted) : wanted_(wanted) {}
    void offer(std::string_view candidate);
    // "" when nothing is near enough to be a likely slip.
    [[nodiscard]] std::string_view best() const { return best_; }

private:
    std::string_view wanted_;
    std::string_view best_;
    std::size_t best_distance_ = 1000;
};

// Levenshtein distance of short names (longer than 64 bytes: a large number), ASCII case ignored.
[[nodiscard]] std::size_t edit_distance(std::string_view a, std::string_view b);

// Text of the input for a message: unprintable bytes as \ooo, cut after 60 bytes.
[[nodiscard]] std::string printable(std::string_view text);

} // namespace rib
