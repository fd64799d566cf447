// SPDX-License-Identifier: Apache-2.0
#include "runtime/base/option_table.h"

#include <algorithm>

namespace base {

std::string option_lines(std::span<const OptionRow> rows, std::size_t column, char separator) {
    std::string text;
    for (const OptionRow& row : rows) {
        std::string line = "  " + std::string(row.name);
        if (!row.metavar.empty()) {
            line += row.name.starts_with("--") ? separator : ' ';
            line += row.metavar;
        }
        line.resize(std::max(column, line.size() + 1), ' ');
        text += line + std::string(row.help) + "\n";
    }
    return text;
}

} // namespace base
