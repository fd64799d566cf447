// SPDX-License-Identifier: Apache-2.0
// Switches of a program as rows of a table (options.def of each program): what --help, the manual
// page and shell completion are made from.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace base {

struct OptionRow {
    std::string_view name;      // as typed, with its dashes
    std::string_view arguments; // a letter each, "" = none; a letter after ? may be missing
    std::string_view metavar;   // how --help and the manual name the arguments
    std::string_view help;
};

// The lines of --help. `separator` stands between a two-dash switch and its value.
[[nodiscard]] std::string option_lines(std::span<const OptionRow> rows, std::size_t column,
                                       char separator);

} // namespace base
