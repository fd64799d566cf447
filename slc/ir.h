// SPDX-License-Identifier: Apache-2.0
// The typed, structured intermediate form of one shader, after user functions have been inlined.
// A shader is a table of variables and a tree of statements. Every operand is a variable (constants
// are variables of kind Const), every statement has at most one result, control flow is structured
// (If, Loop, Scope and the light statements hold bodies), so that masks, slices and suspension
// points can be found by walking it. The text form (ir_text.h) prints and parses back to the same
// program.
#pragma once

#include "runtime/abi/sl_abi.h"

#include <cstdint>
#include <string>
#include <vector>

namespace slc {

enum class Type : std::uint8_t {
    Void,
    Float,
    Color,
    Point,
    Vector,
    Normal,
    Matrix,
    String
};                                                     // = sl_type
enum class Detail : std::uint8_t { Uniform, Varying }; // = sl_detail

constexpr int num_components(Type t) {
    return t == Type::Void                         ? 0
           : t == Type::Float || t == Type::String ? 1
           : t == Type::Matrix                     ? 16
                                                   : 3;
}
constexpr bool is_triple(Type t) {
    return t >= Type::Color && t <= Type::Normal;
}

struct Loc {
    std::uint32_t file = 0; // index into Program::files
    std::uint32_t line = 0;
    std::uint32_t col = 0;
};

enum class VarKind : std::uint8_t {
    Const,  // literal; values or text hold it; always uniform
    Param,  // shader parameter, index = position in the parameter list
    Global, // predefined shader variable, index = sl_variable
    Local,  // declared by the user (inlined functions' formals and locals included)
    Temp    // made by lowering or a pass; assigned in one place
};

struct Var {
    std::string name; // unique in the program; Temps are t1, t2, ...; a Global that a parameter
                      // hides has another name
    Type type = Type::Float;
    // Locals and Temps: result of the uniform/varying inference. A uniform variable is assigned
    // only uniform values, by all points that are in its home: Locals, the innermost block that
    // holds all uses; Temps, where they are made.
    Detail detail = Detail::Varying;
    int array_length = 0; // 0: not an array
    VarKind kind = VarKind::Temp;
    int index = -1;
    // Global, Param: 0 the value, 1 and 2 its difference at the auxiliary points u + du and v + dv.
    // A Param with aux is not in Program::params; its index tells which it belongs to.
    int aux = 0;
    bool is_output = false; // Param
    bool declared_uniform =
        false; // the user wrote `uniform`; if it gets varying values it is varying all the same
    std::vector<float> values; // Const: components (arrays: all elements)
    std::string text;          // Const string
    Loc loc;
};

using VarId = std::int32_t; // index into Program::vars
constexpr VarId no_var = -1;

enum class Op : std::uint8_t {
    // dst = op(args). Numeric operands may differ in type: a float operand of a triple operation is
    // spread. dst may
    // also be one of the args: all of them are read before it is written. Arguments of statements
    // with bodies are
    // read once, before the bodies run (a Loop's condition: each time, after bodies[0]).
    Copy, // dst = a; converts float->triple (spread), float->matrix (diagonal), P/V/N/C by
          // component;
          // dst array: a is an array of the same length, or one value given to every element
    Add,
    Sub,
    Mul,
    Div,
    Neg, // component-wise; Matrix: Mul, Div (a * inverse(b)); both operands matrices
    Dot,
    Cross,
    Eq,
    Ne,
    Lt,
    Le,
    Gt,
    Ge, // float 0/1; triples: all components (Ne: any); Eq, Ne also matrix and string
    And,
    Or,
    Not,      // of floats; both operands are already evaluated
    Select,   // dst = a != 0 ? b : c; b and c have the class of dst (float, triple, matrix, string)
    Triple,   // dst = (a, b, c)
    Matrix16, // dst = 16 floats
    Component, // dst = component (args[1] constant or float) of triple args[0]
    Load,      // dst = array args[0] [ args[1] ]; index truncated toward zero, clamped to the array
    Store,     // array dst [ args[0] ] = args[1]
    Call, // dst (or none) = builtin row `builtin`(args); output arguments are assigned in place.
          // Arguments
    // are already of the class the row wants (float, triple, matrix, string); rows with SL_CHANNEL
    // have the channel (float) after the name; then repetitions (+), name/value pairs (*)
    Difference, // dst = f(a + d) - f(a) for the row `builtin` with SL_DIFF; args: the row's, then
                // the
                // differences d of those at difference_places(row)
    // control; bodies as noted
    If,       // args[0] condition; bodies[0] then, bodies[1] else (may be empty)
    Loop,     // bodies[0] computes the condition args[0]; bodies[1] the body; bodies[2] the step
              // (Continue goes there)
    Break,    // leaves `levels` enclosing loops (Loop, Illuminance)
    Continue, // leaves levels-1 loops, continues the next
    Scope,    // bodies[0]; Leave inside ends it (inlined function with early return, or the shader
              // body)
    Leave,    // ends the `levels`-th enclosing Scope for the lanes that get here
    Illuminance, // args: P [, axis, angle]; category in args of name `category`: see has_*;
                 // bodies[0]
    Illuminate,  // args: from [, axis, angle]; bodies[0]
    Solar        // args: [axis, angle]; bodies[0]
};

struct Stmt {
    Op op = Op::Copy;
    VarId dst = no_var;
    std::vector<VarId> args;
    int builtin = -1;        // Call: row in sl_builtins.def
    int levels = 1;          // Break, Continue, Leave
    VarId category = no_var; // Illuminance: string operand, or no_var
    // Illuminance options as pairs: "lightcache", "light:x" (variable that is set), "send:light:x";
    // Call: pairs that set a variable (BuiltinRow::sets_pair)
    std::vector<std::pair<std::string, VarId>> options;
    std::vector<std::vector<Stmt>> bodies;
    Loc loc;
};

using Block = std::vector<Stmt>;

struct Param {
    VarId var = no_var;
    Block init; // evaluates the default into var; reads constants and earlier parameters only
};

struct Program {
    std::string name;
    sl_shader_type shader_type = SL_SHADER_surface;
    std::vector<Var> vars;
    std::vector<Param> params;
    Block body;
    std::vector<std::string> files;
};

// What the analyses found; side tables, never stored in the program.
struct Facts {
    std::uint64_t needed = 0; // bits 1 << sl_variable: must be filled before the shader runs
    std::uint64_t written = 0;
    std::uint64_t needed_aux = 0;     // differences at the auxiliary points that are read
    std::uint64_t written_aux = 0;    // and that are results (displacement)
    std::vector<bool> aux_params;     // by parameter: its differences are read
    std::uint32_t facts = 0;          // SL_FACT_*
    std::vector<std::string> reasons; // for --explain: one line per needed variable
};

} // namespace slc
