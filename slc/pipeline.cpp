// SPDX-License-Identifier: Apache-2.0
// The list of passes, in order. Inlining of functions is part of lowering (lower_call.cpp).
#include "slc/compiler.h"
#include "slc/passes.h"

namespace slc {

namespace {
// Of the simplifying passes, each of which feeds the next; most shaders settle in four.
constexpr int max_rounds = 16;

// Until nothing changes.
void simplify(Program& program, Folding folding) {
    for (int round = 0; round < max_rounds; ++round) {
        bool changed = pass_fold(program, folding);
        changed = pass_copies(program) || changed;
        changed = pass_dead_code(program) || changed;
        if (!changed) {
            break;
        }
    }
}

} // namespace

void run_passes(Program& program, const CompileOptions& options, Messages* messages) {
    pass_detail(program, messages); // first on the program as written, for its warnings
    const Folding folding = options.exact ? Folding::Exact : Folding::Rounded;
    if (options.optimise) {
        simplify(program, folding);
        pass_detail(program, nullptr); // what was removed may have been what made something varying
        const bool merged = pass_cse(program);
        if (pass_hoist(program) || merged) {
            simplify(program, folding);
        }
        pass_detail(program, nullptr);
    }
    pass_compact(program);
}

// Dead code goes even without optimisation: most of the differences that pass_area makes are read
// by nobody, and what the engine must supply depends on those that are.
void resolve_area_operators(Program& program, const CompileOptions& options) {
    if (!pass_area(program)) {
        return;
    }
    if (options.optimise) {
        const Folding folding = options.exact ? Folding::Exact : Folding::Rounded;
        simplify(program, folding);
        pass_detail(program, nullptr);
        if (pass_cse(program)) { // the three points have much in common
            simplify(program, folding);
        }
    } else {
        pass_dead_code(program);
    }
    pass_detail(program, nullptr);
    pass_compact(program);
}

} // namespace slc
