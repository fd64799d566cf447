// SPDX-License-Identifier: Apache-2.0
// sl_builtins.def and sl_variables.def as tables: rows with their signatures decoded once.
// Row numbers (Stmt::builtin) are positions in sl_builtins.def.
#pragma once

#include "slc/ir.h"

#include <span>
#include <string_view>
#include <vector>

namespace slc {

// Properties of a row, see the head of sl_builtins.def.
enum Property : std::uint32_t {
    PropPure = 1u << 0,
    PropContext = 1u << 1,
    PropVaries = 1u << 2,
    PropEffect = 1u << 3,
    PropLights = 1u << 4,
    PropArea = 1u << 5,
    PropTraces = 1u << 6,
    PropTextures = 1u << 7,
    PropMessage = 1u << 8,
    PropSpaces = 1u << 9,
    PropState = 1u << 10,
    PropRandom = 1u << 11,
    PropChannel = 1u << 12,
    PropInout = 1u << 13,
    PropDiff = 1u << 14,
    PropLinear = 1u << 15,
    PropHidden = 1u << 16,
    PropExact = 1u << 17,
    PropWaits = 1u << 18,
    PropAsked = 1u << 19
};

// One place of a signature.
enum class ArgKind : std::uint8_t {
    Exact,   // `type`
    Pvn,     // g: point, vector or normal
    Triple,  // t: result only, whatever triple the context asks for
    Anything // x: value, X: output, of any type
};

struct ArgSpec {
    ArgKind kind = ArgKind::Exact;
    Type type = Type::Float;
    bool is_output = false;
    bool is_array = false;
};

struct BuiltinRow {
    std::string_view name;
    std::string_view signature;
    std::string_view body;
    std::string_view note;
    std::uint64_t reads = 0;       // bits 1 << sl_variable
    std::uint32_t properties = 0;  // Property
    ArgSpec result;                // Type::Void for none
    std::vector<ArgSpec> args;     // without repetitions
    bool repeats_last = false;     // +
    bool takes_pairs = false;      // *: name/value pairs follow
    bool takes_values = false;     // x*: any number of values follow (printf, format)
    std::string_view output_pairs; // names of pairs that set a variable (sl_output_pairs.def)
    // The pair sets its variable, which then is in Stmt::options, not among the arguments.
    [[nodiscard]] bool sets_pair(std::string_view name_of_pair) const;
    [[nodiscard]] bool has(Property p) const { return (properties & p) != 0; }
};

[[nodiscard]] std::span<const BuiltinRow> builtin_rows();
// A row that is not in the table; the texts must live as long as it.
[[nodiscard]] BuiltinRow decode_row(std::string_view name, std::string_view signature,
                                    std::uint32_t properties);
// Rows of one name that a user may call, in table order; returns their numbers.
[[nodiscard]] std::vector<int> find_builtins(std::string_view name);
// The first row with that body, hidden ones included; -1: none.
[[nodiscard]] int find_builtin_by_body(std::string_view body);
// Places in Stmt::args of the numeric arguments that an Op::Difference of the row has differences
// for, in order. Arrays, knots of splines, channels, name/value pairs, outputs and strings have
// none.
[[nodiscard]] const std::vector<int>& difference_places(int row);

struct VariableRow {
    std::string_view name;
    Type type = Type::Float;
    Detail detail = Detail::Varying;
    std::uint32_t readable = 0; // bits SL_IN_*
    std::uint32_t writable = 0;
    std::string_view note;
};

[[nodiscard]] std::span<const VariableRow> variable_rows(); // index = sl_variable
[[nodiscard]] int find_variable(std::string_view name);     // -1: none

[[nodiscard]] std::string_view type_name(Type type);
[[nodiscard]] std::string_view detail_name(Detail detail);
[[nodiscard]] std::string_view shader_type_name(sl_shader_type type); // "surface" ...
// SL_IN_* bit of a shader type.
[[nodiscard]] constexpr std::uint32_t shader_type_bit(sl_shader_type type) {
    return 1u << type;
}

} // namespace slc
