// SPDX-License-Identifier: Apache-2.0
// Conditional RIB: IfBegin, ElseIf, Else, IfEnd and their expressions (ri.md 6.12).
#pragma once

#include "ribtools/request.h"
#include "ribtools/scene.h"
#include "runtime/base/diag.h"

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace rib {

// The nesting of one stream's conditionals.
class Conditions {
public:
    // False: requests are read but not executed.
    [[nodiscard]] bool active() const { return levels_.empty() || levels_.back().active; }
    // A request of the family. evaluate is called only where its value decides.
    void step(const Request& request, const std::function<bool(const std::string&)>& evaluate,
              base::Diag& diag);
    // The stream ended: reports what is still open.
    void finish(base::SourcePos end, base::Diag& diag);

private:
    struct Level {
        bool parent_active;
        bool taken;  // some branch was
        bool active; // this branch is
    };
    std::vector<Level> levels_;
};

// Value of an expression; false, reported, where it is malformed. Undefined variables are empty,
// with a warning.
[[nodiscard]] bool evaluate_condition(std::string_view text, const Options& options,
                                      const Attributes& attributes, base::Diag& diag,
                                      base::SourcePos pos);

} // namespace rib
