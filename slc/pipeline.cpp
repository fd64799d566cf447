// SPDX-License-Identifier: Apache-2.0
// The list of passes, in order. Inlining of functions is part of lowering (lower_call.cpp).
#include "slc/compiler.h"
#include "slc/passes.h"

namespace slc {

namespace {
// Of the simplifying passes, each of which feeds the next; most shaders settle in four.
constexpr int max_rounds = 16;
} // namespace

void run_passes(Program& program, const CompileOptions& options, Messages* messages) {
    pass_detail(program, messages); // first on the program as written, for its warnings
    if (options.optimise) {
        for (int round = 0; round < max_rounds; ++round) {
            bool changed = pass_fold(program);
            changed = pass_copies(program) || changed;
            changed = pass_dead_code(program) || changed;
            if (!changed) {
                break;
            }
        }
        pass_detail(program, nullptr); // what was removed may have been what made something varying
    }
    pass_compact(program);
}

} // namespace slc
