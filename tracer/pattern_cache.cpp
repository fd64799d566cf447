// SPDX-License-Identifier: Apache-2.0
#include "tracer/pattern_cache.h"

#include "tracer/execution.h"

namespace trace {

const base::Pattern& PatternCache::find(sl_string text) {
    const auto it = patterns_.find(text);
    if (it != patterns_.end()) {
        return it->second;
    }
    if (patterns_.size() == max_patterns) {
        patterns_.clear();
    }
    return patterns_.emplace(text, base::Pattern(text)).first->second;
}

bool match_pattern(const Execution& execution, sl_string pattern, sl_string subject) {
    if (pattern == nullptr || subject == nullptr) {
        return false;
    }
    const auto search = [&](const base::Pattern& compiled) {
        if (!compiled.error().empty()) {
            report_shader(execution, base::Severity::Warning, 0,
                          "match(): \"" + std::string(pattern) +
                              "\" is no basic regular expression: " + compiled.error() +
                              "; it matches nothing");
        }
        return compiled.matches(subject);
    };
    ThreadState* thread = execution.thread;
    if (thread == nullptr) { // defaults of parameters
        return search(base::Pattern(pattern));
    }
    if (!thread->patterns) {
        thread->patterns = std::make_unique<PatternCache>();
    }
    return search(thread->patterns->find(pattern));
}

} // namespace trace
