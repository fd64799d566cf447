// SPDX-License-Identifier: Apache-2.0
// Where a packet may be suspended while the engine traces rays, and what must outlive each of those
// points. In: a program as it is emitted (area operators resolved). Out: a table that all emitters
// share; masks and other state of control flow are each emitter's own business. Only surface
// shaders wait; others are answered at once.
//
// Saved: variables any lane of the packet reads later, wherever it is; not what is loaded anew at
// every entry (parameters and predefined variables nothing is assigned to), nor what lies in the
// parameter block (uniform arrays).
#pragma once

#include "slc/ir.h"

#include <cstddef>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace slc {

struct SuspensionPoint {
    const Stmt* call = nullptr;
    std::vector<VarId> saved; // in the order of the variables
};

class Suspensions {
public:
    explicit Suspensions(const Program& program);

    [[nodiscard]] bool empty() const { return points_.empty(); }
    // In the order of the text; point i resumes state i + 1.
    [[nodiscard]] const std::vector<SuspensionPoint>& points() const { return points_; }
    // The state that resumes after the call; 0: it does not wait.
    [[nodiscard]] int state(const Stmt& s) const {
        const auto it = states_.find(&s);
        return it == states_.end() ? 0 : it->second;
    }
    [[nodiscard]] bool is_saved(VarId v) const { return saved_.contains(v); }

private:
    std::vector<SuspensionPoint> points_;
    std::unordered_map<const Stmt*, int> states_;
    std::unordered_set<VarId> saved_;
};

// Bytes of a variable in a frame.
[[nodiscard]] std::size_t saved_bytes(const Var& v, int lanes);

} // namespace slc
