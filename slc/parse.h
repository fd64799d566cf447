// SPDX-License-Identifier: Apache-2.0
// Tokens to syntax tree: recursive descent over the grammar of sl.md 1.3, names not yet resolved.
#pragma once

#include "slc/ast.h"
#include "slc/lex.h"
#include "slc/messages.h"

#include <memory>

namespace slc {

constexpr int max_nesting = 256;            // statements and expressions inside each other
constexpr std::size_t max_arguments = 1000; // of one call
constexpr std::size_t max_params = 2000;    // of one shader
constexpr int max_chain = 1000; // operators in one expression of equal rank: a + b + c ...
constexpr int max_array_length = 65536;

// Never fails: after an error it goes on at the next statement or definition. Errors are in
// `messages`.
[[nodiscard]] std::unique_ptr<ast::File> parse(const std::vector<Token>& tokens,
                                               Messages& messages);

} // namespace slc
