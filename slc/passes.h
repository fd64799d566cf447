// SPDX-License-Identifier: Apache-2.0
// Passes change the program and say which facts they spoil; analyses never change it. The order is
// in pipeline.cpp.
#pragma once

#include "slc/ir.h"
#include "slc/messages.h"

namespace slc {

// Uniform or varying for every local and temporary; see pass_detail.cpp. Messages may be null.
void pass_detail(Program& program, Messages* messages);
// Predefined variables (bits) whose differences a displacement shader hands on.
[[nodiscard]] std::uint64_t aux_results(const Program& program);
// Each returns whether it changed something.
bool pass_area(Program& program);
// Values of folded operations are rounded once, from double. Exact: only operations of which the
// compiled code would make the same bits (SL_EXACT) are folded.
enum class Folding : std::uint8_t { Rounded, Exact };
bool pass_fold(Program& program, Folding folding = Folding::Rounded);
bool pass_copies(Program& program);
bool pass_cse(Program& program);
bool pass_hoist(Program& program);
bool pass_dead_code(Program& program);
// Removes variables nothing refers to; parameters stay.
void pass_compact(Program& program);

} // namespace slc
