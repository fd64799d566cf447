// SPDX-License-Identifier: Apache-2.0
// Columns of the original line for tokens of the preprocessed one. The preprocessor keeps lines but
// not spacing, and puts macro bodies in place of names; the longest common subsequence of both
// lines' words tells which tokens were written there and which came out of a macro.
#include "slc/lex.h"

#include <algorithm>
#include <cctype>

namespace slc {

namespace {

constexpr std::size_t max_cells =
    200'000; // of the table; longer lines keep their preprocessed columns

struct Word {
    std::string_view text;
    std::uint32_t col;
};

bool is_word_char(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

std::size_t word_length(std::string_view s) {
    if (s[0] == '"') {
        std::size_t i = 1;
        while (i < s.size() && s[i] != '"') {
            i += s[i] == '\\' ? 2 : 1;
        }
        return std::min(i + 1, s.size());
    }
    if (!is_word_char(s[0])) {
        return s.size() > 1 && s[1] == '=' &&
                       std::string_view("+-*/=!<>").find(s[0]) != std::string_view::npos
                   ? 2
                   : (s.starts_with("&&") || s.starts_with("||") ? 2 : 1);
    }
    std::size_t i = 1;
    while (i < s.size() && is_word_char(s[i])) {
        ++i;
    }
    return i;
}

// Words of an original line, comments left out.
std::vector<Word> split(std::string_view line) {
    std::vector<Word> words;
    std::size_t i = 0;
    while (i < line.size()) {
        if (std::isspace(static_cast<unsigned char>(line[i])) != 0) {
            ++i;
        } else if (line.substr(i, 2) == "//") {
            break;
        } else if (line.substr(i, 2) == "/*") {
            const std::size_t end = line.find("*/", i + 2);
            i = end == std::string_view::npos ? line.size() : end + 2;
        } else {
            const std::size_t n = word_length(line.substr(i));
            words.push_back({line.substr(i, n), static_cast<std::uint32_t>(i + 1)});
            i += n;
        }
    }
    return words;
}

// Numbers and strings are spelt in pieces by split(); their beginning is enough to find them.
bool same(const Token& token, const Word& word) {
    if (token.kind == Tok::Text) {
        return word.text.starts_with('"');
    }
    if (token.kind == Tok::Number) {
        return token.text.starts_with(word.text) || word.text.starts_with(token.text);
    }
    return token.text == word.text;
}

void align(Token* tokens, std::size_t n, const std::vector<Word>& words) {
    const std::size_t m = words.size();
    if (m == 0 || n * m > max_cells) {
        return;
    }
    // length[i][j]: longest common subsequence of tokens[i..] and words[j..]
    std::vector<std::uint32_t> length((n + 1) * (m + 1), 0);
    const auto cell = [&](std::size_t i, std::size_t j) -> std::uint32_t& {
        return length[i * (m + 1) + j];
    };
    for (std::size_t i = n; i-- > 0;) {
        for (std::size_t j = m; j-- > 0;) {
            cell(i, j) = same(tokens[i], words[j]) ? cell(i + 1, j + 1) + 1
                                                   : std::max(cell(i + 1, j), cell(i, j + 1));
        }
    }
    std::size_t j = 0;
    for (std::size_t i = 0; i < n; ++i) {
        while (j < m && !same(tokens[i], words[j]) && cell(i, j + 1) > cell(i + 1, j)) {
            ++j;
        }
        const std::size_t at = std::min(j, m - 1);
        tokens[i].loc.col =
            words[at].col; // unmatched: the macro name, which is the next unmatched word
        if (j < m && same(tokens[i], words[j])) {
            ++j;
        }
    }
}

} // namespace

void map_columns(std::vector<Token>& tokens, Sources& sources) {
    std::size_t first = 0;
    while (first < tokens.size() && tokens[first].kind != Tok::End) {
        const Loc loc = tokens[first].loc;
        std::size_t last = first;
        while (last < tokens.size() && tokens[last].kind != Tok::End &&
               tokens[last].loc.file == loc.file && tokens[last].loc.line == loc.line) {
            ++last;
        }
        align(&tokens[first], last - first, split(sources.line(loc.file, loc.line)));
        first = last;
    }
}

} // namespace slc
