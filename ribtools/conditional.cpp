// SPDX-License-Identifier: Apache-2.0
#include "ribtools/conditional.h"

#include "ribtools/number.h"
#include "ribtools/spelling.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <regex.h>

namespace rib {

namespace {

constexpr int max_expression_depth = 200;

// Numbers or a string.
struct Value {
    std::vector<double> numbers;
    std::string text;
    bool is_text = false;

    [[nodiscard]] bool truth() const {
        return is_text
                   ? !text.empty()
                   : std::any_of(numbers.begin(), numbers.end(), [](double x) { return x != 0; });
    }
    [[nodiscard]] double number() const { return numbers.empty() ? 0 : numbers.front(); }
};

Value number_value(double x) {
    return {{x}, {}, false};
}

Value text_value(std::string text) {
    return {{}, std::move(text), true};
}

std::string to_text(const Value& v) {
    if (v.is_text) {
        return v.text;
    }
    char buffer[40];
    const auto result = std::to_chars(buffer, std::end(buffer), v.number());
    return {buffer, result.ptr};
}

Value value_of(const Param& p) {
    if (!p.strings.empty()) {
        return text_value(p.strings.front());
    }
    Value v;
    v.numbers.assign(p.ints.begin(), p.ints.end());
    v.numbers.insert(v.numbers.end(), p.floats.begin(), p.floats.end());
    return v;
}

// Recursive descent over the grammar of ri.md 6.12, a production above each function.
class Expression {
public:
    Expression(std::string_view text, const Options& options, const Attributes& attributes)
        : text_(text), options_(options), attributes_(attributes) {}

    Value parse() {
        const Value v = disjunction();
        skip_blanks();
        if (at_ < text_.size()) {
            fail("unexpected '" + printable(text_.substr(at_)) + "'");
        }
        return v;
    }
    [[nodiscard]] const std::string& error() const { return error_; }
    [[nodiscard]] const std::string& undefined() const { return undefined_; }

private:
    // or := and { '||' and }
    Value disjunction() {
        Value v = conjunction();
        while (accept("||")) {
            const Value right = conjunction();
            v = number_value(v.truth() || right.truth());
        }
        return v;
    }

    // and := not { '&&' not }
    Value conjunction() {
        Value v = negation();
        while (accept("&&")) {
            const Value right = negation();
            v = number_value(v.truth() && right.truth());
        }
        return v;
    }

    // not := ['!'|'~'] cmp
    Value negation() {
        bool negate = false, any = false;
        while (!starts_with("!=") && (accept("!") || accept("~"))) {
            negate = !negate;
            any = true;
        }
        const Value v = comparison();
        return any ? number_value(v.truth() != negate) : v;
    }

    // cmp := sum [ ('=='|'!='|'<'|'<='|'>'|'>='|'=~') sum ]
    Value comparison() {
        const Value left = sum();
        for (const std::string_view op : {"==", "!=", "<=", ">=", "=~", "<", ">"}) {
            if (accept(op)) {
                return number_value(compare(left, op, sum()));
            }
        }
        return left;
    }

    // sum := term { ('+'|'-') term }
    Value sum() {
        Value v = term();
        for (;;) {
            if (accept("+")) {
                v = number_value(v.number() + term().number());
            } else if (accept("-")) {
                v = number_value(v.number() - term().number());
            } else {
                return v;
            }
        }
    }

    // term := pow { ('*'|'/') pow }
    Value term() {
        Value v = power();
        for (;;) {
            if (!starts_with("**") && accept("*")) {
                v = number_value(v.number() * power().number());
            } else if (accept("/")) {
                const double divisor = power().number();
                v = number_value(divisor == 0 ? 0 : v.number() / divisor);
            } else {
                return v;
            }
        }
    }

    // pow := atom { ('**'|'^') atom }
    Value power() {
        Value v = atom();
        while (accept("**") || accept("^")) {
            v = number_value(std::pow(v.number(), atom().number()));
        }
        return v;
    }

    // atom := number | 'chars' | variable | 'defined(' name ')' | 'concat(' expr ',' expr ')' | '('
    // expr ')'
    Value atom() {
        if (++depth_ > max_expression_depth) {
            fail("nested too deeply");
        }
        skip_blanks();
        Value v;
        if (!error_.empty()) {
            at_ = text_.size();
        } else if (accept("(")) {
            v = disjunction();
            expect(")");
        } else if (accept("'")) {
            v = quoted_text();
        } else if (accept("$")) {
            v = variable();
        } else if (accept("defined")) {
            expect("(");
            v = number_value(lookup(name()) != std::nullopt);
            expect(")");
        } else if (accept("concat")) {
            expect("(");
            const Value a = disjunction();
            expect(",");
            v = text_value(to_text(a) + to_text(disjunction()));
            expect(")");
        } else {
            v = number();
        }
        --depth_;
        return v;
    }

    Value number() {
        const std::string rest(text_.substr(at_, 64));
        const Decimal d = scan_decimal(rest.c_str());
        if (!d.end) {
            fail(at_ < text_.size() ? "unexpected '" + printable(text_.substr(at_)) + "'"
                                    : "it ends too early");
            return {};
        }
        at_ += static_cast<std::size_t>(d.end - rest.c_str());
        return number_value(to_double(d));
    }

    Value quoted_text() {
        const std::size_t end = text_.find('\'', at_);
        if (end == std::string_view::npos) {
            fail("a quote is not closed");
            return {};
        }
        Value v = text_value(std::string(text_.substr(at_, end - at_)));
        at_ = end + 1;
        return v;
    }

    // '$' name | '${' name '}' | '$(' expr ')'
    Value variable() {
        std::string wanted;
        if (accept("(")) {
            wanted = to_text(disjunction());
            expect(")");
        } else if (accept("{")) {
            wanted = name();
            expect("}");
        } else {
            wanted = name();
        }
        if (std::optional<Value> v = lookup(wanted)) {
            return *v;
        }
        if (undefined_.empty()) {
            undefined_ = wanted;
        }
        return text_value("");
    }

    std::string name() {
        skip_blanks();
        const std::size_t begin = at_;
        const auto is_name = [](char c) {
            return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                   c == '_' || c == ':';
        };
        while (at_ < text_.size() && is_name(text_[at_])) {
            ++at_;
        }
        return std::string(text_.substr(begin, at_ - begin));
    }

    // [ 'Attribute:' | 'Option:' ] group ':' item | item, attributes before options, a bare item in
    // "user" first.
    [[nodiscard]] std::optional<Value> lookup(std::string wanted) const {
        bool attributes = true, options = true;
        if (wanted.starts_with("Attribute:")) {
            wanted.erase(0, 10);
            options = false;
        } else if (wanted.starts_with("Option:")) {
            wanted.erase(0, 7);
            attributes = false;
        }
        if (wanted == "Ri:Frame" || wanted == "Frame") {
            return number_value(options_.frame);
        }
        const std::string key = wanted.find(':') == std::string::npos ? "user:" + wanted : wanted;
        if (const Param* p = attributes ? attributes_.find(key) : nullptr) {
            return value_of(*p);
        }
        const auto it = options_.user.find(key);
        return options && it != options_.user.end() ? std::optional(value_of(it->second))
                                                    : std::nullopt;
    }

    bool compare(const Value& a, std::string_view op, const Value& b) {
        if (op == "=~") {
            return matches(to_text(a), to_text(b));
        }
        if (a.is_text || b.is_text) {
            if (op != "==" && op != "!=") {
                fail("strings compare by ==, != and =~ only");
            }
            return (to_text(a) == to_text(b)) == (op == "==");
        }
        if (op == "==" || op == "!=") {
            return (a.numbers == b.numbers) == (op == "==");
        }
        const std::size_t n = std::min(a.numbers.size(), b.numbers.size());
        for (std::size_t i = 0; i < n; ++i) {
            const double x = a.numbers[i], y = b.numbers[i];
            if (!(op == "<" ? x < y : op == "<=" ? x <= y : op == ">" ? x > y : x >= y)) {
                return false;
            }
        }
        return n > 0;
    }

    bool matches(const std::string& text, const std::string& pattern) {
        regex_t compiled;
        if (pattern.size() > 1000 ||
            ::regcomp(&compiled, pattern.c_str(), REG_EXTENDED | REG_NOSUB) != 0) {
            fail("'" + printable(pattern) + "' is no pattern");
            return false;
        }
        const bool found = ::regexec(&compiled, text.c_str(), 0, nullptr, 0) == 0;
        ::regfree(&compiled);
        return found;
    }

    void skip_blanks() {
        while (at_ < text_.size() &&
               (text_[at_] == ' ' || text_[at_] == '\t' || text_[at_] == '\n')) {
            ++at_;
        }
    }
    bool starts_with(std::string_view word) {
        skip_blanks();
        return text_.substr(at_).starts_with(word);
    }
    bool accept(std::string_view word) {
        if (!starts_with(word)) {
            return false;
        }
        at_ += word.size();
        return true;
    }
    void expect(std::string_view word) {
        if (!accept(word)) {
            fail("'" + std::string(word) + "' is missing");
        }
    }
    void fail(const std::string& what) {
        if (error_.empty()) {
            error_ = what;
        }
    }

    std::string_view text_;
    const Options& options_;
    const Attributes& attributes_;
    std::size_t at_ = 0;
    int depth_ = 0;
    std::string error_, undefined_;
};

} // namespace

void Conditions::step(const Request& request,
                      const std::function<bool(const std::string&)>& evaluate, base::Diag& diag) {
    if (request.id == RequestId::IfBegin) {
        const bool parent = active();
        const bool value = parent && evaluate(request.string(0));
        levels_.push_back({parent, value, value});
        return;
    }
    if (levels_.empty()) {
        diag.report(base::Severity::Error, base::Code::Nesting, request.pos,
                    std::string(row(request.id).name) + ": no IfBegin is open; ignored");
        return;
    }
    Level& level = levels_.back();
    if (request.id == RequestId::IfEnd) {
        levels_.pop_back();
    } else {
        const bool may_take = level.parent_active && !level.taken;
        level.active = may_take && (request.id == RequestId::Else || evaluate(request.string(0)));
        level.taken |= level.active;
    }
}

void Conditions::finish(base::SourcePos end, base::Diag& diag) {
    if (!levels_.empty()) {
        diag.report(base::Severity::Error, base::Code::Nesting, end,
                    "end of input inside IfBegin; closed");
        levels_.clear();
    }
}

bool evaluate_condition(std::string_view text, const Options& options, const Attributes& attributes,
                        base::Diag& diag, base::SourcePos pos) {
    Expression expression(text, options, attributes);
    const Value v = expression.parse();
    if (!expression.error().empty()) {
        diag.report(base::Severity::Error, base::Code::Syntax, pos,
                    "IfBegin: " + expression.error() + " in \"" + printable(text) +
                        "\"; taken as false");
        return false;
    }
    if (!expression.undefined().empty()) {
        diag.report_once("undefined:" + expression.undefined(), base::Severity::Warning,
                         base::Code::BadToken, pos,
                         "IfBegin: '" + printable(expression.undefined()) + "' is not defined");
    }
    return v.truth();
}

} // namespace rib
