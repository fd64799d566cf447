// SPDX-License-Identifier: Apache-2.0
// The parser's class, shared by parse.cpp (definitions), parse_stmt.cpp and parse_expr.cpp.
// Internal. Every parse function carries its production of sl.md 1.3 and starts at the production's
// first token.
#pragma once

#include "slc/parse.h"

#include <set>

namespace slc {

class Parser {
public:
    Parser(const std::vector<Token>& tokens, Messages& messages)
        : tokens_(tokens), messages_(messages), file_(std::make_unique<ast::File>()) {}
    std::unique_ptr<ast::File> run();

private:
    struct SyntaxError {}; // thrown after a message, caught where parsing can go on

    // One level of nesting; the limit ends parsing, since every level costs machine stack in all
    // later stages.
    class Nest {
    public:
        explicit Nest(Parser& parser);
        ~Nest() { --parser_.depth_; }
        Nest(const Nest&) = delete;
        Nest& operator=(const Nest&) = delete;

    private:
        Parser& parser_;
    };

    // Tokens
    [[nodiscard]] const Token& peek(std::size_t ahead = 0) const;
    [[nodiscard]] bool is(Tok kind, std::size_t ahead = 0) const {
        return peek(ahead).kind == kind;
    }
    // Type a word at this place stands for, or nothing. vector, normal and matrix were ordinary
    // names in 3.1, and shaders of its time call variables so.
    [[nodiscard]] std::optional<Type> type_at(std::size_t ahead = 0) const;
    [[nodiscard]] bool is_name(std::size_t ahead = 0) const;
    const Token& take();
    bool accept(Tok kind);
    const Token& expect(Tok kind, std::string_view where);
    [[noreturn]] void fail(const Token& at, std::string_view text);
    void stop();
    // Index of the parenthesis that closes the one at `open` (absolute), or of the end.
    [[nodiscard]] std::size_t matching_paren(std::size_t open) const;
    void skip_statement(std::size_t start);
    void skip_definition(std::size_t start);

    // Definitions, parse.cpp
    void definition();
    [[nodiscard]] bool at_shader() const;
    void shader_def();
    ast::Function* function_def();
    void shader_formals(ast::Shader& shader);
    void fn_formals(ast::Function& function);
    [[nodiscard]] bool at_formal_group() const;
    struct TypeSpec {
        bool is_output = false;
        std::optional<Detail> detail;
        std::optional<Type> type;
        int array_length = 0; // type[N] name
        Loc loc;
    };
    TypeSpec typespec(bool output_allowed);
    void qualifiers(TypeSpec& spec, bool output_allowed);
    void later_language();
    ast::Expr* default_value(const ast::Symbol& symbol);
    ast::Symbol* new_symbol(const TypeSpec& spec, ast::SymbolKind kind, bool unsized_allowed);
    void initialiser(ast::Variable& variable);
    void array_init(ast::Variable& variable);
    void count_elements(ast::Variable& variable, Loc open);
    void list_for_value(ast::Variable& variable, Loc open);
    int array_length(bool unsized_allowed);

    // Statements, parse_stmt.cpp
    ast::Stmt* statement();
    ast::Stmt* statement_at();
    void statements(std::vector<ast::Stmt*>& into);
    ast::Stmt* new_stmt(ast::StmtKind kind, Loc loc);
    ast::Stmt* typed_statement();
    [[nodiscard]] bool at_function_def() const;
    ast::Stmt* nested_function();
    ast::Stmt* declaration();
    ast::Stmt* expression_statement();
    ast::Expr* statement_expr();
    void foreign_type();
    ast::Stmt* if_statement();
    ast::Stmt* while_statement();
    ast::Stmt* for_statement();
    ast::Stmt* jump();
    ast::Stmt* return_statement();
    ast::Stmt* light_statement(ast::StmtKind kind, std::size_t min_args, std::size_t max_args);
    ast::Stmt* gather_statement();
    ast::Stmt* do_statement();
    ast::Expr* condition();
    std::vector<ast::Expr*> expr_list(Tok end);

    // Expressions, parse_expr.cpp
    ast::Expr* expr();
    ast::Expr* ternary();
    ast::Expr* binary(int lowest);
    ast::Expr* unary();
    ast::Expr* cast();
    [[nodiscard]] bool at_c_cast() const;
    ast::Expr* c_cast();
    ast::Expr* primary();
    ast::Expr* parenthesised();
    ast::Expr* name_or_call();
    ast::Expr* call(const Token& name);
    ast::Expr* string_literal();
    ast::Expr* new_expr(ast::ExprKind kind, Loc loc);
    std::optional<double> constant_value(const ast::Expr& e) const;

    const std::vector<Token>& tokens_;
    Messages& messages_;
    std::unique_ptr<ast::File> file_;
    std::size_t pos_ = 0;
    std::set<std::string_view> type_words_as_names_; // declared in this definition
    int depth_ = 0;
    bool stopped_ = false;
};

// Type a type word names, or nothing.
[[nodiscard]] std::optional<Type> type_of_word(Tok kind);

} // namespace slc
