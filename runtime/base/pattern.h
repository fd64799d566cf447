// SPDX-License-Identifier: Apache-2.0
// Basic regular expressions of POSIX (ed style: . * [] ^ $ \( \) \{m,n\}, and GNU's \| \+ \?), for
// match(). Time and memory of a search grow linearly with the subject, whatever the pattern: so
// back-references are no part of it. Immutable once made; safe from any thread.
#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace re2 {
class RE2;
}

namespace base {

class Pattern {
public:
    explicit Pattern(std::string_view text);
    ~Pattern();
    Pattern(Pattern&& other) noexcept;
    Pattern& operator=(Pattern&& other) noexcept;

    // Why it matches nothing; "" for an expression.
    [[nodiscard]] const std::string& error() const { return error_; }
    // Anywhere in the subject.
    [[nodiscard]] bool matches(std::string_view subject) const;

private:
    std::unique_ptr<re2::RE2> compiled_;
    std::string error_;
};

} // namespace base
