// SPDX-License-Identifier: Apache-2.0
// Typed syntax tree to IR: one Program per shader, user functions inlined, control flow structured,
// conversions explicit. Also decides what depends on the shader type: which predefined variables
// and light statements are legal. Invariant: without recursion a symbol has at most one live
// activation, so one map from symbols to variables serves all inlined bodies.
#pragma once

#include "slc/ast.h"
#include "slc/messages.h"

#include <optional>
#include <string>
#include <unordered_map>
#include <unordered_set>

namespace slc {

// nullopt after messages. Program::files is left empty.
[[nodiscard]] std::optional<Program> lower(const ast::Shader& shader, Messages& messages);

class Lowering {
public:
    Lowering(const ast::Shader& shader, Messages& messages)
        : shader_(shader), messages_(messages) {}
    std::optional<Program> run();

private:
    struct Overflow {}; // the program is too large; thrown after the message, caught in run()
    // One level of machine recursion.
    class Deeper {
    public:
        Deeper(Lowering& lowering, Loc loc);
        ~Deeper() { --lowering_.depth_; }
        Deeper(const Deeper&) = delete;
        Deeper& operator=(const Deeper&) = delete;

    private:
        Lowering& lowering_;
    };

    // lower.cpp: variables and statements of the IR
    void params();
    void local_copies();
    std::string unique_name(const std::string& wanted);
    VarId new_var(Var var);
    VarId temp(Type type, Loc loc);
    VarId local(const std::string& name, Type type, int array_length, Loc loc);
    VarId local_for(const ast::Symbol& symbol);
    VarId constant(Type type, std::vector<float> values, int array_length = 0);
    VarId constant(float value) { return constant(Type::Float, {value}); }
    VarId text(const std::string& value);
    VarId zero(Type type);
    [[nodiscard]] const Var& var(VarId id) const {
        return program_.vars[static_cast<std::size_t>(id)];
    }
    Stmt& emit(Op op, VarId dst, std::vector<VarId> args, Loc loc);
    // Fills a body of the statement last emitted.
    template <class Fill> Block block(Fill fill);
    VarId global(int id, Loc loc);
    VarId variable(const ast::Symbol& symbol, Loc loc);
    VarId assignable(const ast::Symbol& symbol, Loc loc);
    VarId copy_of_global(const ast::Symbol& symbol, VarId source, Loc loc);
    void check_light_variable(int id, Loc loc);

    // lower_stmt.cpp
    void statements(const std::vector<ast::Stmt*>& list, bool is_tail);
    void statement(const ast::Stmt& s, bool is_tail);
    void declaration(const ast::Stmt& s);
    void initialise(const ast::Variable& variable, VarId target);
    bool constant_elements(const ast::Variable& variable, VarId target);
    void if_statement(const ast::Stmt& s, bool is_tail);
    void loop(const ast::Stmt& s);
    void return_statement(const ast::Stmt& s, bool is_tail);
    void illuminate(const ast::Stmt& s);
    void illuminance(const ast::Stmt& s);
    void gather(const ast::Stmt& s);
    std::vector<std::pair<std::string, VarId>> option_values(const ast::Stmt& s, std::size_t first);
    void body(const std::vector<ast::Stmt*>&
                  list); // a function's or the shader's, in a Scope if it returns early

    // lower_expr.cpp: the value of an expression, in a variable. `into`: where the caller wants it,
    // a hint.
    VarId value(const ast::Expr& e, VarId into = no_var);
    VarId value_as(const ast::Expr& e, Type wanted);
    void store_into(const ast::Expr& e, VarId target);
    VarId convert(VarId id, Type wanted, Loc loc);
    VarId target(Type type, VarId into, Loc loc);
    std::vector<VarId> operands(const std::vector<ast::Expr*>& list,
                                const std::vector<Type>& types);
    VarId protect(VarId id, Loc loc);
    VarId unary(const ast::Expr& e, VarId into);
    VarId binary(const ast::Expr& e, VarId into);
    VarId arithmetic(Op op, VarId left, VarId right, Type result, VarId into, Loc loc);
    VarId logical(const ast::Expr& e, VarId into);
    VarId ternary(const ast::Expr& e, VarId into);
    VarId tuple(const ast::Expr& e, VarId into);
    VarId cast(const ast::Expr& e, VarId into);
    VarId index(const ast::Expr& e, VarId into);
    VarId assign(const ast::Expr& e);
    VarId assign_element(const ast::Expr& e);
    VarId component(const ast::Expr& e, VarId into);
    VarId assign_component(const ast::Expr& e);
    VarId component_of(VarId whole, const std::vector<VarId>& at, VarId into, Loc loc);
    [[nodiscard]] Type compound_type(const ast::Expr& e) const;

    // lower_call.cpp
    VarId call(const ast::Expr& e, VarId into);
    VarId builtin_call(const ast::Expr& e, VarId into);
    VarId external_call(const ast::Expr& e);
    VarId call_by_component(const ast::Expr& e, VarId into);
    static int row_of_body(std::string_view body);
    VarId builtin_by_body(std::string_view body, std::vector<VarId> args, Type result, Loc loc);
    struct WriteBack { // element of an array that a call sets
        VarId array = no_var, index = no_var, element = no_var;
    };
    struct BuiltinArgs { // of a call in the making
        std::vector<VarId> args;
        std::vector<std::pair<std::string, VarId>> outputs; // pairs the function sets
        std::vector<WriteBack> back;
        bool has_outputs = false;
    };
    BuiltinArgs builtin_args(const ast::Expr& e);
    VarId output_argument(const ast::Expr& e, std::vector<WriteBack>& back);
    void write_back(const std::vector<WriteBack>& back, Loc loc);
    VarId inline_call(const ast::Expr& e);

    // lower_rays.cpp: maps that are rays
    VarId map_or_rays(const ast::Expr& e, const BuiltinRow& row, BuiltinArgs call, VarId into);
    VarId reflection(const BuiltinRow& row, const std::vector<VarId>& args, Loc loc);
    VarId traced_shadow(const BuiltinRow& row, const std::vector<VarId>& args, Loc loc);
    VarId mean_of_corners(const BuiltinRow& row, const std::vector<VarId>& args, Loc loc);

    void bind_reference(const ast::Symbol& formal, const ast::Expr& arg,
                        std::vector<WriteBack>& back);

    static constexpr std::size_t max_statements = 200'000;
    static constexpr std::size_t max_values = 4'000'000; // floats in all arrays
    static constexpr int max_depth = 1500;

    const ast::Shader& shader_;
    Messages& messages_;
    Program program_;
    Block* block_ = nullptr; // where emit() appends
    Block prologue_;         // goes before the body: copies of read-only variables
    std::unordered_map<const ast::Symbol*, VarId> variables_;
    std::unordered_map<std::string, VarId> constants_;
    std::unordered_set<std::string> names_;
    std::unordered_map<std::string, int> name_counts_;
    VarId globals_[SL_VAR_COUNT];
    VarId global_copies_[SL_VAR_COUNT]; // local copies of predefined variables that may not be
                                        // assigned
    VarId result_ = no_var;             // of the function being inlined
    bool in_init_ = false;              // in a parameter's default
    int illuminance_depth_ = 0;
    int illuminate_depth_ = 0;
    std::size_t num_statements_ = 0;
    std::size_t num_values_ = 0;
    int num_temps_ = 0;
    int num_constants_ = 0;
    int depth_ = 0;
};

// Argument i of a call of a built-in function is the value of a pair that the function sets.
[[nodiscard]] bool sets_pair_at(const ast::Expr& e, std::size_t i);

// The name that makes a map function trace rays; null: none does.
[[nodiscard]] const char* ray_name(const BuiltinRow& row);

// True if evaluating e may change a variable.
[[nodiscard]] bool has_effects(const ast::Expr& e);

template <class Fill> Block Lowering::block(Fill fill) {
    Block inner;
    Block* const outer = block_;
    block_ = &inner;
    fill();
    block_ = outer;
    return inner;
}

} // namespace slc
