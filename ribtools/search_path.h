// SPDX-License-Identifier: Apache-2.0
// Where files that a RIB names are looked for. Values of paths: runtime/base/search_path.h.
#pragma once

#include "ribtools/scene.h"

#include <string>
#include <string_view>
#include <vector>

namespace rib {

// The directories for one kind of file, "shader", "texture" ..., then those for all kinds,
// "resource".
[[nodiscard]] std::vector<std::string> search_directories(const Options& options,
                                                          const std::string& kind);

// Names that start with "/", "./" or "../" bypass the search path.
[[nodiscard]] bool bypasses_search_path(std::string_view name);

// The paths to try for ReadArchive (ri.md 6.12): in the directories, then as given, then beside the
// files that are being read, innermost first.
[[nodiscard]] std::vector<std::string>
archive_candidates(const std::string& name, const std::vector<std::string>& directories,
                   const std::vector<std::string>& readers);

} // namespace rib
