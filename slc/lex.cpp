// SPDX-License-Identifier: Apache-2.0
// One pass over the preprocessed text. Directive lines left by the preprocessor set the place or
// are skipped.
#include "slc/lex.h"

#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>

namespace slc {

namespace {

struct Spelling {
    Tok kind;
    std::string_view text;
};

constexpr Spelling words[] = {
#define SLC_WORD(enumerator, text) {Tok::Word##enumerator, text},
#include "slc/tokens.def"
};

constexpr Spelling marks[] = {
#define SLC_MARK(enumerator, text) {Tok::enumerator, text},
#include "slc/tokens.def"
};

bool is_letter(char c) {
    return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_';
}
bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

class Lexer {
public:
    Lexer(std::string_view text, Messages& messages) : text_(text), messages_(messages) {}
    TokenList run();

private:
    [[nodiscard]] char at(std::size_t ahead = 0) const {
        return pos_ + ahead < text_.size() ? text_[pos_ + ahead] : '\0';
    }
    [[nodiscard]] Loc here() const {
        return {file_, line_, static_cast<std::uint32_t>(pos_ - line_start_ + 1)};
    }
    void new_line() {
        ++pos_;
        ++line_;
        line_start_ = pos_;
    }
    void directive();
    bool skip_space();
    void skip_block_comment();
    void token();
    void name();
    void number();
    void string();
    char escape();
    bool mark();
    void unexpected();
    void push(Tok kind, std::string_view text, Loc loc, double number = 0) {
        out_.tokens.push_back({kind, text, number, loc});
    }

    std::string_view text_;
    Messages& messages_;
    TokenList out_;
    std::size_t pos_ = 0;
    std::size_t line_start_ = 0;
    std::uint32_t file_ = 0;
    std::uint32_t line_ = 1;
};

TokenList Lexer::run() {
    while (pos_ < text_.size() && !messages_.too_many()) {
        if (skip_space()) {
            continue;
        }
        if (at() == '#' && text_.substr(line_start_, pos_ - line_start_).find_first_not_of(" \t") ==
                               std::string_view::npos) {
            directive();
            continue;
        }
        token();
        if (out_.tokens.size() >= max_tokens) {
            messages_.error(here(), "the shader is too long", base::Code::Limit);
            break;
        }
    }
    push(Tok::End, "", here());
    return std::move(out_);
}

// "# 12 "file" 1", "#line 12 "file"": the place of the next line. Other directives (#pragma) are
// skipped.
void Lexer::directive() {
    const std::size_t end = std::min(text_.find('\n', pos_), text_.size());
    std::string_view rest = text_.substr(pos_ + 1, end - pos_ - 1);
    const auto skip_blanks = [&] {
        rest.remove_prefix(std::min(rest.find_first_not_of(" \t"), rest.size()));
    };
    skip_blanks();
    if (rest.starts_with("line")) {
        rest.remove_prefix(4);
        skip_blanks();
    }
    std::uint32_t line = 0;
    const auto [after, ec] = std::from_chars(rest.data(), rest.data() + rest.size(), line);
    pos_ = end;
    if (ec != std::errc()) {
        return;
    }
    rest.remove_prefix(static_cast<std::size_t>(after - rest.data()));
    skip_blanks();
    if (rest.starts_with('"')) {
        std::string name;
        for (std::size_t i = 1; i < rest.size() && rest[i] != '"'; ++i) {
            i += rest[i] == '\\' && i + 1 < rest.size() ? 1 : 0;
            name += rest[i];
        }
        if (!name.starts_with('<')) { // <built-in>, <command-line>
            file_ = messages_.sources().add(name);
        }
    }
    if (pos_ < text_.size()) {
        new_line();
    }
    line_ = line;
}

bool Lexer::skip_space() {
    const char c = at();
    if (c == '\n') {
        new_line();
    } else if (c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v') {
        ++pos_;
    } else if (c == '/' && at(1) == '/') { // text that did not pass the preprocessor
        pos_ = std::min(text_.find('\n', pos_), text_.size());
    } else if (c == '/' && at(1) == '*') {
        skip_block_comment();
    } else {
        return false;
    }
    return true;
}

void Lexer::skip_block_comment() {
    const Loc start = here();
    pos_ += 2;
    while (pos_ < text_.size() && !(at() == '*' && at(1) == '/')) {
        if (at() == '\n') {
            new_line();
        } else {
            ++pos_;
        }
    }
    if (pos_ >= text_.size()) {
        messages_.error(start, "comment without end");
    }
    pos_ = std::min(pos_ + 2, text_.size());
}

void Lexer::token() {
    if (is_letter(at())) {
        name();
    } else if (is_digit(at()) || (at() == '.' && is_digit(at(1)))) {
        number();
    } else if (at() == '"') {
        string();
    } else if (!mark()) {
        unexpected();
    }
}

void Lexer::name() {
    const Loc loc = here();
    const std::size_t start = pos_;
    while (is_letter(at()) || is_digit(at())) {
        ++pos_;
    }
    const std::string_view spelling = text_.substr(start, pos_ - start);
    for (const Spelling& word : words) {
        if (word.text == spelling) {
            push(word.kind, spelling, loc);
            return;
        }
    }
    push(Tok::Name, spelling, loc);
}

// Longest match: "1." is a number, so "2.N" is "2." and "N".
void Lexer::number() {
    const Loc loc = here();
    const std::size_t start = pos_;
    while (is_digit(at())) {
        ++pos_;
    }
    if (at() == '.') {
        ++pos_;
    }
    while (is_digit(at())) {
        ++pos_;
    }
    const std::size_t sign = at(1) == '+' || at(1) == '-' ? 1 : 0;
    if ((at() == 'e' || at() == 'E') && is_digit(at(1 + sign))) {
        pos_ += 1 + sign;
        while (is_digit(at())) {
            ++pos_;
        }
    }
    const std::string_view spelling = text_.substr(start, pos_ - start);
    if (at() == 'f' || at() == 'F') {
        ++pos_;
    }
    double value = 0;
    const auto [end, ec] =
        std::from_chars(spelling.data(), spelling.data() + spelling.size(), value);
    (void)end;
    constexpr double largest = std::numeric_limits<float>::max();
    if (ec == std::errc::result_out_of_range) { // from_chars leaves the value; small or large?
        const std::size_t e = spelling.find_first_of("eE");
        value = e != std::string_view::npos && spelling[e + 1] == '-' ? 0 : 2 * largest;
    }
    if (value > largest) {
        messages_.warning(loc, "number is too large, the largest float is used");
        value = largest;
    }
    push(Tok::Number, spelling, loc, value);
}

char Lexer::escape() {
    const char c = at();
    ++pos_;
    switch (c) {
    case 'n':
        return '\n';
    case 't':
        return '\t';
    case 'r':
        return '\r';
    case 'b':
        return '\b';
    default:
        break;
    }
    if (c < '0' || c > '7') {
        return c;
    }
    int value = c - '0';
    for (int i = 0; i < 2 && at() >= '0' && at() <= '7'; ++i, ++pos_) {
        value = value * 8 + (at() - '0');
    }
    return static_cast<char>(value);
}

void Lexer::string() {
    const Loc loc = here();
    std::string value;
    ++pos_;
    while (pos_ < text_.size() && at() != '"' && at() != '\n') {
        if (at() == '\\' && at(1) != '\n' && pos_ + 1 < text_.size()) {
            ++pos_;
            const char c = escape();
            if (c != '\0') { // strings end at NUL in the run time
                value += c;
            }
        } else {
            value += at();
            ++pos_;
        }
    }
    if (at() == '"') {
        ++pos_;
    } else {
        messages_.error(loc, "string without closing quote");
    }
    out_.strings.push_back(std::move(value));
    push(Tok::Text, out_.strings.back(), loc);
}

bool Lexer::mark() {
    const std::string_view rest = text_.substr(pos_, 2);
    for (const Spelling& mark : marks) {
        if (rest.starts_with(mark.text)) {
            push(mark.kind, text_.substr(pos_, mark.text.size()), here());
            pos_ += mark.text.size();
            return true;
        }
    }
    return false;
}

void Lexer::unexpected() {
    const char c = at();
    std::string text = "unexpected character";
    if (std::isprint(static_cast<unsigned char>(c)) != 0) {
        text += " " + quoted(std::string(1, c));
    } else {
        static constexpr std::string_view hex = "0123456789abcdef";
        const auto u = static_cast<unsigned char>(c);
        text += " (byte 0x" + std::string(1, hex[u >> 4]) + std::string(1, hex[u & 15]) + ")";
    }
    if (c == '\'') {
        text += "; there are no character constants, strings use double quotes";
    }
    messages_.error(here(), text);
    while (pos_ < text_.size() && at() == c) { // one message for a run of the same
        ++pos_;
    }
}

} // namespace

TokenList lex(std::string_view text, Messages& messages) {
    return Lexer(text, messages).run();
}

std::string token_name(Tok kind) {
    switch (kind) {
    case Tok::End:
        return "the end of the file";
    case Tok::Name:
        return "a name";
    case Tok::Number:
        return "a number";
    case Tok::Text:
        return "a string";
    default:
        break;
    }
    for (const Spelling& word : words) {
        if (word.kind == kind) {
            return quoted(word.text);
        }
    }
    for (const Spelling& mark : marks) {
        if (mark.kind == kind) {
            return quoted(mark.text);
        }
    }
    return "?";
}

std::string dump_tokens(const std::vector<Token>& tokens, const Sources& sources) {
    std::string out;
    for (const Token& token : tokens) {
        out += sources.names().empty() ? std::string() : sources.names()[token.loc.file];
        out += ":" + std::to_string(token.loc.line) + ":" + std::to_string(token.loc.col) + ": ";
        out += token_name(token.kind);
        if (token.kind == Tok::Name || token.kind == Tok::Number || token.kind == Tok::Text) {
            out += " " + std::string(token.text);
        }
        out += "\n";
    }
    return out;
}

} // namespace slc
