// SPDX-License-Identifier: Apache-2.0
// Which loops are counted while they run. In: a block of IR. Out: the loops whose end nobody can
// see from the text; short innermost loops over constants end for certain and cost nothing. What
// the limit is and what happens there: docs/robustness.md.
#pragma once

#include "slc/ir.h"

#include <unordered_set>

namespace slc {

class CountedLoops {
public:
    CountedLoops(const Program& program, const Block& body);

    [[nodiscard]] bool empty() const { return loops_.empty(); }
    [[nodiscard]] bool counts(const Stmt& loop) const { return loops_.count(&loop) > 0; }
    // The statement is a counted loop or holds one: lanes may have been stopped in it.
    [[nodiscard]] bool may_stop(const Stmt& s) const { return holders_.count(&s) > 0; }

private:
    bool note(const Program& program, const Block& b);

    std::unordered_set<const Stmt*> loops_;
    std::unordered_set<const Stmt*> holders_;
};

} // namespace slc
