// SPDX-License-Identifier: Apache-2.0
// Search path values (ri.md 14.1): lists of directories with &, @, ~ and environment variables; and
// where an archive may lie.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace rib {

// Directories separated by ':' or ';'. "&" = previous, "@" = defaults, "~" = home, $NAME ${NAME}
// %NAME% = environment variables (empty if unset). Empty elements are dropped.
[[nodiscard]] std::vector<std::string> expand_search_path(std::string_view value,
                                                          const std::vector<std::string>& previous,
                                                          const std::vector<std::string>& defaults);

// Names that start with "/", "./" or "../" bypass the search path.
[[nodiscard]] bool bypasses_search_path(std::string_view name);

// The paths to try for ReadArchive (ri.md 6.12): in the directories, then as given, then beside the
// files that are being read, innermost first.
[[nodiscard]] std::vector<std::string>
archive_candidates(const std::string& name, const std::vector<std::string>& directories,
                   const std::vector<std::string>& readers);

} // namespace rib
