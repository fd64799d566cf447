// SPDX-License-Identifier: Apache-2.0
// What a point costs in a shader, as far as its text tells: a number to compare two forms of one
// program with, not a time.
#pragma once

#include "slc/ir.h"

namespace slc {

// In units of about one operation on a float; loops and branches count as their typical trips.
[[nodiscard]] double cost_of(const Program& program);

// Statements, bodies included: what the C compiler's time goes by.
[[nodiscard]] std::size_t num_statements(const Program& program);

} // namespace slc
