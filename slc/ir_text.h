// SPDX-License-Identifier: Apache-2.0
// IR as text and back, and the checks every program must pass. print(parse(print(p))) == print(p).
#pragma once

#include "slc/ir.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace slc {

[[nodiscard]] std::string print_ir(const Program& program);

// nullopt with the reason in `error` ("line 12: ..."). Input is untrusted: bounded, never crashes.
[[nodiscard]] std::optional<Program> parse_ir(std::string_view text, std::string& error);

// Broken invariants, one line each; empty when the program is sound.
[[nodiscard]] std::vector<std::string> verify_ir(const Program& program);

} // namespace slc
