// SPDX-License-Identifier: Apache-2.0
// Basic regular expressions are rewritten in the syntax of RE2, which matches in linear time.
#include "runtime/base/pattern.h"

#include <cctype>
#include <cstdint>
#include <re2/re2.h>

namespace base {

namespace {

constexpr std::int64_t max_memory = 1 << 20; // of a compiled pattern and its search

class Rewriter {
public:
    explicit Rewriter(std::string_view text) : rest_(text) {}

    // False after an error.
    bool run() {
        while (!rest_.empty() && error.empty()) {
            one();
        }
        return error.empty();
    }

    std::string out, error;

private:
    // Before this place nothing has been said that * could repeat and ^ stand behind.
    bool at_start_ = true;
    std::string_view rest_;

    char take() {
        const char c = rest_.front();
        rest_.remove_prefix(1);
        return c;
    }

    void one() {
        const bool at_start = at_start_;
        const char c = take();
        at_start_ = false;
        if (c == '\\') {
            escaped();
        } else if (c == '[') {
            bracket();
        } else if (c == '*' && !at_start) {
            repeat("*");
        } else if (c == '^' && at_start) {
            out += '^';
            at_start_ = true;
        } else if (c == '$' && at_end()) {
            out += '$';
        } else if (c == '.') {
            out += c;
        } else {
            literal(c);
        }
    }

    [[nodiscard]] bool at_end() const {
        return rest_.empty() || rest_.starts_with("\\)") || rest_.starts_with("\\|");
    }

    void literal(char c) {
        const bool is_plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || (c & 0x80) != 0;
        out += is_plain ? "" : "\\";
        out += c;
    }

    // a** means a*, and RE2 refuses it.
    void repeat(std::string_view mark) {
        if (out.empty() || out.back() != '*' || out.ends_with("\\*") || mark != "*") {
            out += mark;
        }
    }

    void escaped() {
        if (rest_.empty()) {
            error = "it ends with a backslash";
            return;
        }
        const char c = take();
        switch (c) {
        case '(':
            out += "(?:";
            at_start_ = true;
            break;
        case '|':
            out += '|';
            at_start_ = true;
            break;
        case ')':
            out += ')';
            break;
        case '+':
        case '?':
            repeat(std::string_view(&c, 1));
            break;
        case '{':
            interval();
            break;
        case '<':
        case '>':
            out += "\\b";
            break;
        case 'b':
        case 'B':
        case 'w':
        case 'W':
            out += '\\';
            out += c;
            break;
        default:
            if (c >= '1' && c <= '9') {
                error = "back-references are not supported";
            } else {
                literal(c);
            }
        }
    }

    void interval() {
        const std::size_t end = rest_.find("\\}");
        const std::string_view range = rest_.substr(0, end);
        if (end == std::string_view::npos || range.empty() ||
            range.find_first_not_of("0123456789,") != std::string_view::npos) {
            error = "\\{ needs numbers and \\}";
            return;
        }
        out += (range.front() == ',' ? "{0" : "{") + std::string(range) + "}";
        rest_.remove_prefix(end + 2);
    }

    // In brackets a backslash is itself, ] is too at the beginning, and [: :] names a class.
    void bracket() {
        out += '[';
        if (rest_.starts_with("^")) {
            out += take();
        }
        for (bool first = true;; first = false) {
            if (rest_.empty()) {
                error = "[ without ]";
                return;
            }
            const char c = take();
            if (c == ']' && !first) {
                out += ']';
                return;
            }
            if (c == '[' && !rest_.empty() &&
                std::string_view(":.=").find(rest_.front()) != std::string_view::npos) {
                named(take());
            } else {
                out += c == '\\' || c == '[' || c == ']' || c == '^' ? "\\" : "";
                out += c;
            }
        }
    }

    void named(char kind) {
        const std::string close = std::string(1, kind) + "]";
        const std::size_t end = rest_.find(close);
        if (end == std::string_view::npos) {
            error = "[" + std::string(1, kind) + " without " + close;
            return;
        }
        const std::string_view name = rest_.substr(0, end);
        if (kind == ':') {
            out += "[:" + std::string(name) + ":]";
        } else {
            for (const char c : name) {
                literal(c);
            }
        }
        rest_.remove_prefix(end + 2);
    }
};

} // namespace

Pattern::Pattern(std::string_view text) {
    Rewriter rewriter(text);
    if (!rewriter.run()) {
        error_ = rewriter.error;
        return;
    }
    re2::RE2::Options options;
    options.set_encoding(re2::RE2::Options::EncodingLatin1); // bytes
    options.set_log_errors(false);
    options.set_never_capture(true);
    options.set_dot_nl(true);
    options.set_max_mem(max_memory);
    compiled_ = std::make_unique<re2::RE2>(rewriter.out, options);
    if (!compiled_->ok()) {
        error_ = compiled_->error();
    }
}

Pattern::~Pattern() = default;
Pattern::Pattern(Pattern&& other) noexcept = default;
Pattern& Pattern::operator=(Pattern&& other) noexcept = default;

bool Pattern::matches(std::string_view subject) const {
    return error_.empty() && re2::RE2::PartialMatch(subject, *compiled_);
}

} // namespace base
