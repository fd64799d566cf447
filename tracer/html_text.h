// SPDX-License-Identifier: Apache-2.0
// Text for HTML pages. Everything that comes from a file or the command line goes through
// escaped(): names in RIB files are untrusted.
#pragma once

#include <string>
#include <string_view>

namespace trace {

// For element content and quoted attributes: markup characters become entities, control characters
// and bytes that are no UTF-8 the replacement character.
[[nodiscard]] std::string escaped(std::string_view text);
[[nodiscard]] std::string base64(std::string_view bytes);

} // namespace trace
