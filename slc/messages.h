// SPDX-License-Identifier: Apache-2.0
// Messages of one compilation: file:line:col: severity: text, then the source line with a caret.
// Only this class writes to the Diag; the number of messages is bounded, so that garbage input ends
// soon.
#pragma once

#include "runtime/base/diag.h"
#include "slc/compiler.h"
#include "slc/ir.h"
#include "slc/source.h"

#include <set>
#include <span>
#include <string>
#include <string_view>

namespace slc {

class Messages {
public:
    using Observer = std::function<void(const Message&)>;
    Messages(base::Diag& diag, Sources& sources, Observer observer = {})
        : diag_(diag), sources_(sources), observer_(std::move(observer)) {}

    void error(Loc loc, std::string_view text, base::Code code = base::Code::Syntax);
    void warning(Loc loc, std::string_view text);
    // Once per place and text: code that is lowered many times complains once.
    void error_once(Loc loc, std::string_view text);
    void warning_once(Loc loc, std::string_view text);
    // A message about the environment, without a place (no compiler, unreadable file).
    void count_error() { ++num_errors_; } // one that needs no words
    void system_error(std::string_view text, base::Code code);

    [[nodiscard]] std::size_t num_errors() const { return num_errors_; }
    // True when errors have reached the limit and compilation should stop.
    [[nodiscard]] bool too_many() const { return num_errors_ >= max_errors; }
    [[nodiscard]] Sources& sources() { return sources_; }

private:
    static constexpr std::size_t max_errors = 20;
    static constexpr std::size_t max_warnings = 100;
    void report(base::Severity severity, base::Code code, Loc loc, std::string_view text);
    bool first_time(Loc loc, std::string_view text);
    base::Diag& diag_;
    Sources& sources_;
    Observer observer_;
    std::size_t num_errors_ = 0;
    std::size_t num_warnings_ = 0;
    std::set<std::string> seen_;
};

// ", did you mean 'x'?" for the nearest of the candidates, or "" when none is near.
[[nodiscard]] std::string spelling_hint(std::string_view wrong,
                                        std::span<const std::string_view> candidates);

// One line of JSON for a message, without the newline.
[[nodiscard]] std::string json_line(const Message& message);

// 'name'
[[nodiscard]] std::string quoted(std::string_view name);

} // namespace slc
