// SPDX-License-Identifier: Apache-2.0
// What the fuzz targets of the compiler have in common: the promises about programs that verify.
#pragma once

#include "slc/ir.h"

namespace slc_fuzz {

// Text of the program parses back to the same text; the analyses and the emitter take it. Aborts
// where that does not hold.
void check_program(const slc::Program& program);

// Aborts with the complaints and the program if there are complaints.
void check_verified(const slc::Program& program, const char* stage);

// Runs it on the interpreter for a few points; bounded. False: it is too large to be run here.
bool interpret(const slc::Program& program);

} // namespace slc_fuzz
