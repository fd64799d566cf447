// SPDX-License-Identifier: Apache-2.0
// Syntax tree to typed syntax tree (sl.md 1.4 - 1.7, 2): names, types, conversions, overloads.
// Two phases per expression: costs() finds, from the leaves up, which types it can deliver and at
// what cost, and reports errors; deliver() then fixes, from the root down, the cheapest way to the
// wanted type. Legality by shader type is decided in lowering, where functions have become part of
// a shader.
#pragma once

#include "slc/ast.h"
#include "slc/builtins.h"
#include "slc/externals.h"
#include "slc/messages.h"
#include "slc/scope.h"

#include <set>

namespace slc {

void check(ast::File& file, Externals& externals, Messages& messages);

// Implicit conversion costs (sl.md 2.4): exact 0, P/V/N 1, float to P/V/N 8, float to color 9,
// float to matrix 10; color to P/V/N and back, which the language does not have, last_resort.
constexpr std::uint8_t last_resort = 100;
[[nodiscard]] std::uint8_t conversion_cost(Type from, Type to);
[[nodiscard]] constexpr bool is_pvn(Type t) {
    return t >= Type::Point && t <= Type::Normal;
}

class Checker {
public:
    Checker(ast::File& file, Externals& externals, Messages& messages)
        : file_(file), externals_(externals), messages_(messages), scopes_(file) {}
    void run();

private:
    // check.cpp: definitions, declarations
    void check_shader(ast::Shader& shader);
    void check_function(ast::Function& function);
    void declare(ast::Symbol& symbol);
    void check_initialiser(ast::Variable& variable);
    void declare_extern(ast::Variable& variable);
    void declare_function(ast::Function& function);

    // check_stmt.cpp
    void statements(const std::vector<ast::Stmt*>& list);
    void statement(ast::Stmt& s);
    void declaration(ast::Stmt& s);
    void condition(ast::Expr& e);
    void expression_statement(ast::Expr& e);
    void loop(ast::Stmt& s);
    void jump(ast::Stmt& s);
    void return_statement(ast::Stmt& s);
    void illuminance(ast::Stmt& s);
    void gather(ast::Stmt& s);
    void options(ast::Stmt& s, std::size_t first, const BuiltinRow* row);
    void body(ast::Stmt& s, bool is_loop);

    // check_expr.cpp
    const ast::Costs& costs(ast::Expr& e);
    void name_costs(ast::Expr& e);
    void index_costs(ast::Expr& e);
    void cast_costs(ast::Expr& e);
    void unary_costs(ast::Expr& e);
    void binary_costs(ast::Expr& e);
    void ternary_costs(ast::Expr& e);
    void tuple_costs(ast::Expr& e);
    void assign_costs(ast::Expr& e);
    bool assign_array(ast::Expr& e);
    void fail(ast::Expr& e, std::string_view text);
    void resolve_name(ast::Expr& e);
    void mark_assigned(ast::Expr& target);
    [[nodiscard]] ast::Symbol* array_of(ast::Expr& e);
    std::uint8_t cost_to(ast::Expr& e, Type wanted);
    struct Operands {
        Type left = Type::Void, right = Type::Void, result = Type::Void;
    };
    Operands choose_operands(Op op, ast::Expr& left, ast::Expr& right);
    bool cast_mixed_operand(ast::Expr& e);
    void component_costs(ast::Expr& e);

    // Delivers e as `wanted`; `what` names the place for the message ("the angle").
    void deliver(ast::Expr& e, Type wanted, std::string_view what);
    // Without a wanted type: float if it can be one (prefer_float), else what the call's first row
    // gives.
    Type deliver_any(ast::Expr& e, bool prefer_float);
    void settle(ast::Expr& e, Type natural);

    // overload.cpp
    struct Candidate {
        int builtin = -1;
        const BuiltinRow* external = nullptr;
        ast::Function* function = nullptr;
        Type result = Type::Void;
        std::uint32_t cost = 0;
        std::vector<Type> arg_types; // Void: array, or output argument taken as it is
        bool by_component = false;
    };
    void call_costs(ast::Expr& e);
    void settle_call(ast::Expr& e, std::optional<Type> natural);
    std::vector<Candidate> candidates(ast::Expr& e);
    bool match_function(ast::Expr& e, ast::Function& f, Candidate& c);
    void match_row(ast::Expr& e, const BuiltinRow& row, Candidate c, std::vector<Candidate>& out);
    void match_by_component(ast::Expr& e, int row, std::vector<Candidate>& out);
    void check_later_function(std::string_view name);
    void settle_arguments(ast::Expr& e);
    void warn_about_call(const ast::Expr& e);
    bool match_arg(ast::Expr& arg, const ArgSpec& spec, Type pvn, Candidate& c);
    bool match_output(ast::Expr& arg, const ArgSpec& spec, Candidate& c);
    bool match_extras(ast::Expr& e, const BuiltinRow& row, Type pvn, Candidate& c);
    Type pvn_kind(ast::Expr& e, const BuiltinRow& row);
    void split_channel(ast::Expr& e);
    void no_candidate(ast::Expr& e);
    std::string describe_args(ast::Expr& e);

    ast::File& file_;
    Externals& externals_;
    Messages& messages_;
    Scopes scopes_;
    ast::Function* function_ = nullptr; // being checked
    std::vector<ast::Function*> open_functions_;
    int loop_depth_ = 0;
    std::set<std::pair<const ast::Function*, std::string>> warned_extern_;
    std::set<const ast::Symbol*> warned_assigned_;
    std::set<std::string> declared_params_; // of the shader being checked
};

} // namespace slc
