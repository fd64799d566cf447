// SPDX-License-Identifier: Apache-2.0
// `slc --explain`: what the compiler found out about a shader, for its writer.
#pragma once

#include "slc/compiler.h"

#include <string>

namespace slc {

// Of a program after run_passes, its area operators still in place.
[[nodiscard]] std::string explain_text(const Program& program, const CompileOptions& options);

} // namespace slc
