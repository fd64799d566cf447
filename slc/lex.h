// SPDX-License-Identifier: Apache-2.0
// Preprocessed text to tokens with places in the original files (sl.md 1.1). The list always ends
// with Tok::End.
#pragma once

#include "slc/ir.h"
#include "slc/messages.h"

#include <deque>
#include <string>
#include <string_view>
#include <vector>

namespace slc {

enum class Tok : std::uint8_t {
    End,
    Name,
    Number,
    Text, // string literal
#define SLC_WORD(enumerator, text) Word##enumerator,
#define SLC_MARK(enumerator, text) enumerator,
#include "slc/tokens.def"
};

struct Token {
    Tok kind = Tok::End;
    std::string_view text; // spelling; string literals: the value, escapes resolved
    double number = 0;
    Loc loc;
};

// Tokens view `text` and `strings`; both must outlive them.
struct TokenList {
    std::vector<Token> tokens;
    std::deque<std::string> strings;
};

constexpr std::size_t max_tokens = 4'000'000;

[[nodiscard]] TokenList lex(std::string_view text, Messages& messages);

// As messages and dumps show a kind of token: "';'", "a name", ...
[[nodiscard]] std::string token_name(Tok kind);
[[nodiscard]] std::string dump_tokens(const std::vector<Token>& tokens, const Sources& sources);

// Places refer to the preprocessed line so far, where spacing is lost and macros are expanded;
// finds the column in the original line. A token that came out of a macro gets the column of what
// stands before it.
void map_columns(std::vector<Token>& tokens, Sources& sources);

} // namespace slc
