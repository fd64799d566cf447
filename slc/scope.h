// SPDX-License-Identifier: Apache-2.0
// What names mean at one place of the source: variables and functions, in separate name spaces
// (sl.md 1.1, 1.5). A stack of lexical levels above the predefined variables. A function body is a
// boundary: names found beyond it need `extern` by the rules, and are used with a warning without
// it.
#pragma once

#include "slc/ast.h"

#include <string_view>
#include <unordered_map>
#include <vector>

namespace slc {

class Scopes {
public:
    // Predefined variables become symbols of the file, so that they outlive the checker.
    explicit Scopes(ast::File& file);
    void push(bool is_function);
    void pop() { levels_.pop_back(); }

    struct Found {
        ast::Symbol* symbol = nullptr;
        bool beyond_function =
            false; // outside the innermost function body, and not declared extern there
    };
    [[nodiscard]] Found find(std::string_view name) const;
    // As `extern` looks: past the innermost function body, or past the innermost level outside
    // functions.
    [[nodiscard]] ast::Symbol* find_outer(std::string_view name) const;
    // False when the innermost level already has the name.
    bool declare(std::string_view name, ast::Symbol* symbol);
    void replace(std::string_view name, ast::Symbol* symbol) {
        levels_.back().variables[name] = symbol;
    }

    void declare_function(ast::Function* function) { levels_.back().functions.push_back(function); }
    // Innermost first; within a level the latest first.
    [[nodiscard]] std::vector<ast::Function*> find_functions(std::string_view name) const;

    [[nodiscard]] std::vector<std::string_view> variable_names() const;
    [[nodiscard]] std::vector<std::string_view> function_names() const;

private:
    struct Level {
        bool is_function = false;
        std::unordered_map<std::string_view, ast::Symbol*> variables;
        std::vector<ast::Function*> functions;
    };

public:
    // All levels but that of the file are put aside, and taken up again.
    using Inner = std::vector<Level>;
    [[nodiscard]] Inner leave_for_file();
    void come_back(Inner inner);

private:
    std::vector<Level> levels_;
    std::unordered_map<std::string_view, ast::Symbol*> globals_;
};

} // namespace slc
