// SPDX-License-Identifier: Apache-2.0
// Search path values (ri.md 14.1): lists of directories with &, @, ~ and environment variables.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace base {

// Directories separated by ':' or ';'. "&" = previous, "@" = defaults, "~" = home, $NAME ${NAME}
// %NAME% = environment variables (empty if unset). Empty elements are dropped. After a backslash
// these signs and the backslash mean themselves.
[[nodiscard]] std::vector<std::string>
expand_search_path(std::string_view value, const std::vector<std::string>& previous = {},
                   const std::vector<std::string>& defaults = {});

} // namespace base
