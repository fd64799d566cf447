// SPDX-License-Identifier: Apache-2.0
// Passes change the program and say which facts they spoil; analyses never change it. The order is
// in pipeline.cpp.
#pragma once

#include "slc/ir.h"
#include "slc/messages.h"

namespace slc {

// Uniform or varying for every local and temporary; see pass_detail.cpp. Messages may be null.
void pass_detail(Program& program, Messages* messages);
// Each returns whether it changed something.
bool pass_fold(Program& program);
bool pass_copies(Program& program);
bool pass_dead_code(Program& program);
// Removes variables nothing refers to; parameters stay.
void pass_compact(Program& program);

} // namespace slc
