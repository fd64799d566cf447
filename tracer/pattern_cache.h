// SPDX-License-Identifier: Apache-2.0
// Compiled patterns of match(), kept by the thread that uses them: shaders ask for the same few
// again and again.
#pragma once

#include "runtime/abi/sl_abi.h"
#include "runtime/base/pattern.h"

#include <unordered_map>

namespace trace {

class Execution;

class PatternCache {
public:
    // Interned texts: equal ones have equal addresses.
    const base::Pattern& find(sl_string text);

private:
    static constexpr std::size_t max_patterns = 256; // a shader may make a new one per point
    std::unordered_map<sl_string, base::Pattern> patterns_;
};

// The service `match`: a pattern that is no expression is reported once and matches nothing.
[[nodiscard]] bool match_pattern(const Execution& execution, sl_string pattern, sl_string subject);

} // namespace trace
