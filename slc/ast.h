// SPDX-License-Identifier: Apache-2.0
// The syntax tree of one source file. The parser makes it; the checker fills in the members marked
// "checked": types, what names mean, and which overload a call takes; lowering only reads. Nodes
// live in the File's pools and are never moved, so plain pointers between them are safe.
#pragma once

#include "slc/ir.h"

#include <array>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace slc {
struct BuiltinRow;
}

namespace slc::ast {

struct Function;

// One declared variable: parameter, formal, local, or a predefined variable as the checker sees it.
enum class SymbolKind : std::uint8_t { Param, Formal, Local, Global, Pi };

constexpr int unsized_array = -1;

struct Symbol {
    std::string name;
    SymbolKind kind = SymbolKind::Local;
    Type type = Type::Float;
    std::optional<Detail> detail; // as written
    int array_length = 0;         // 0: no array; unsized_array: formal `color c[]`
    bool is_output = false;
    int global = -1;       // Global: sl_variable
    bool assigned = false; // checked: some statement may change it
    Loc loc;
};

enum class ExprKind : std::uint8_t {
    Number,
    Text,
    Name,
    Index,
    Call,
    Cast,
    Unary,
    Binary,
    Ternary,
    Assign,
    Tuple
};

constexpr std::uint8_t no_cost = 255;

// Checked: cost of delivering each type, see overload.h.
struct Costs {
    bool known = false;
    bool failed = false; // an error inside has been reported; anything goes
    std::array<std::uint8_t, 8> by_type{no_cost, no_cost, no_cost, no_cost,
                                        no_cost, no_cost, no_cost, no_cost};
    std::uint8_t& operator[](Type t) { return by_type[static_cast<std::size_t>(t)]; }
    std::uint8_t operator[](Type t) const { return by_type[static_cast<std::size_t>(t)]; }
};

struct Expr {
    ExprKind kind = ExprKind::Number;
    Op op = Op::Copy;       // Unary, Binary; Assign: Copy for "=", Add for "+=" ...
    Type type = Type::Void; // Cast: as written. Otherwise checked
    Loc loc;                // operator, name or first token
    std::string text;       // Name, Index, Call: the name; Text: the value; Cast: the space or ""
    double number = 0;
    std::vector<Expr*> args;   // operands; Index: the index; Call: arguments; Assign: target, value
    Expr* channel = nullptr;   // argument of a call: name[channel]
    Symbol* symbol = nullptr;  // checked: Name, Index
    bool is_component = false; // checked: Index into the last brackets' color, point ... or matrix
    bool by_component = false; // checked: Call of a float function with triples
    int builtin = -1;          // checked: Call of a built-in row
    const BuiltinRow* external = nullptr; // ... of a function of a DSO
    Function* function = nullptr;         // checked: Call of a user function
    Costs costs;                          // checked
    std::vector<Type>
        arg_types; // checked: Call: type each argument is delivered as (Void: array or output)
    Type operand_types[2] = {Type::Void, Type::Void}; // checked: Unary, Binary
};

struct Variable { // one name of a declaration, with its initialiser
    Symbol* symbol = nullptr;
    Expr* init = nullptr;
    std::vector<Expr*> elements; // array initialiser
    bool has_elements = false;
};

enum class StmtKind : std::uint8_t {
    Empty,
    Block,
    Declare,
    Extern,
    Expression,
    If,
    While,
    For,
    Break,
    Continue,
    Return,
    Solar,
    Illuminate,
    Illuminance,
    Gather,
    Function
};

struct Stmt {
    StmtKind kind = StmtKind::Empty;
    Loc loc;
    std::vector<Expr*> exprs; // Expression, conditions (For: 0 or 1), arguments of light statements
    std::vector<Expr*> steps; // For
    std::vector<Stmt*>
        body; // Block; For: [0] first part, [1] body; others: [0] body or then, [1] else
    std::vector<Variable> variables;
    int levels = 1; // Break, Continue
    Function* function = nullptr;
    bool has_category = false; // Illuminance, checked: the first argument is a string
};

struct Function {
    std::string name;
    std::optional<Type> result; // none: decided by the checker from its returns
    std::vector<Symbol*> formals;
    std::vector<Stmt*> body;
    Loc loc;
    bool checked = false;
};

struct Shader {
    std::string name;
    sl_shader_type type = SL_SHADER_surface;
    std::vector<Variable> params;
    std::vector<Stmt*> body;
    Loc loc;
};

// Order matters: a function is visible to what follows it.
struct Definition {
    Function* function = nullptr;
    Shader* shader = nullptr;
};

struct File {
    std::vector<Definition> definitions;
    std::deque<Expr> exprs;
    std::deque<Stmt> stmts;
    std::deque<Symbol> symbols;
    std::deque<Function> functions;
    std::deque<Shader> shaders;
};

// The operator as the Shading Language writes it; "" for plain assignment.
[[nodiscard]] std::string_view op_text(Op op);

// Indented text, for --dump=ast.
[[nodiscard]] std::string dump(const File& file);

} // namespace slc::ast
