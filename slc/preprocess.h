// SPDX-License-Identifier: Apache-2.0
// SL text through the system's C preprocessor (sl.md 1.2). PERIGEE and BMRT are defined, nothing
// else is: no system macros, no system include directories. Markers in the output keep the places
// of the original.
#pragma once

#include "slc/compiler.h"
#include "slc/messages.h"

#include <optional>
#include <string>
#include <string_view>

namespace slc {

// nullopt after messages; they have been mapped to SL places. `name` is file 0 of the messages'
// sources.
[[nodiscard]] std::optional<std::string> preprocess(std::string_view text, const std::string& name,
                                                    const CompileOptions& options,
                                                    Messages& messages);

} // namespace slc
