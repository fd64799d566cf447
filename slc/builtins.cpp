// SPDX-License-Identifier: Apache-2.0
// Decodes the signatures of sl_builtins.def once, at first use, into immutable rows.
// The notation is described in the head of that file.
#include "slc/builtins.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace slc {

namespace {

// Names the tables' cells use.
#define SL_R(name) (1ull << SL_VAR_##name)
constexpr std::uint32_t SL_PURE = PropPure, SL_CONTEXT = PropContext, SL_VARIES = PropVaries,
                        SL_EFFECT = PropEffect, SL_LIGHTS = PropLights, SL_AREA = PropArea,
                        SL_TRACES = PropTraces, SL_TEXTURES = PropTextures,
                        SL_MESSAGE = PropMessage, SL_SPACES = PropSpaces, SL_STATE = PropState,
                        SL_RANDOM = PropRandom, SL_CHANNEL = PropChannel, SL_INOUT = PropInout,
                        SL_DIFF [[maybe_unused]] = PropDiff,
                        SL_LINEAR [[maybe_unused]] = PropLinear, SL_HIDDEN = PropHidden,
                        SL_EXACT = PropExact, SL_WAITS = PropWaits, SL_ASKED = PropAsked;

struct RawRow {
    std::string_view name, signature, body;
    std::uint64_t reads;
    std::uint32_t properties;
    std::string_view note;
};

constexpr RawRow raw_rows[] = {
#define SL_BUILTIN(name, signature, body, reads, properties, note)                                 \
    {#name, signature, #body, reads, properties, note},
#include "runtime/abi/sl_builtins.def"
#undef SL_BUILTIN
};
#undef SL_R

struct OutputPairs {
    std::string_view body, names;
};

constexpr OutputPairs output_pairs[] = {
#define SL_OUTPUT_PAIRS(body, names, note) {#body, names},
#include "runtime/abi/sl_output_pairs.def"
#undef SL_OUTPUT_PAIRS
};

bool matches(std::string_view pattern, std::string_view name) {
    if (pattern == ":") {
        return name.find(':') != std::string_view::npos;
    }
    return pattern == "*" || pattern == name ||
           (pattern.ends_with(':') && name.starts_with(pattern));
}

ArgSpec decode_letter(char letter) {
    ArgSpec spec;
    spec.is_output = std::isupper(static_cast<unsigned char>(letter)) != 0;
    switch (std::tolower(static_cast<unsigned char>(letter))) {
    case 'f':
        spec.type = Type::Float;
        break;
    case 'c':
        spec.type = Type::Color;
        break;
    case 'p':
        spec.type = Type::Point;
        break;
    case 'v':
        spec.type = Type::Vector;
        break;
    case 'n':
        spec.type = Type::Normal;
        break;
    case 'm':
        spec.type = Type::Matrix;
        break;
    case 's':
        spec.type = Type::String;
        break;
    case 'g':
        spec.kind = ArgKind::Pvn;
        spec.type = Type::Point;
        break;
    case 't':
        spec.kind = ArgKind::Triple;
        spec.type = Type::Color;
        break;
    default:
        spec.kind = ArgKind::Anything;
        break;
    }
    return spec;
}

// Arguments between the parentheses: letters, [letter], commas, and the marks + and *.
void decode_args(std::string_view text, BuiltinRow& row) {
    for (std::size_t i = 0; i < text.size(); ++i) {
        switch (text[i]) {
        case ',':
        case ']':
            break;
        case '[':
            row.args.push_back(decode_letter(text[++i]));
            row.args.back().is_array = true;
            break;
        case '+':
            row.repeats_last = true;
            break;
        case '*':
            if (row.args.back().kind == ArgKind::Anything) {
                row.args.pop_back();
                row.takes_values = true;
            } else {
                row.takes_pairs = true;
            }
            break;
        default:
            row.args.push_back(decode_letter(text[i]));
            break;
        }
    }
}

BuiltinRow decode(const RawRow& raw) {
    BuiltinRow row;
    row.name = raw.name;
    row.signature = raw.signature;
    row.body = raw.body;
    row.note = raw.note;
    row.reads = raw.reads;
    row.properties = raw.properties;
    const std::size_t open = raw.signature.find('(');
    const std::string_view result = raw.signature.substr(0, open);
    if (result == "void") {
        row.result.type = Type::Void;
    } else {
        row.result = decode_letter(result[0]);
    }
    for (const OutputPairs& pairs : output_pairs) {
        row.output_pairs = pairs.body == raw.body ? pairs.names : row.output_pairs;
    }
    decode_args(raw.signature.substr(open + 1, raw.signature.size() - open - 2), row);
    return row;
}

std::vector<BuiltinRow> decode_all() {
    std::vector<BuiltinRow> rows;
    rows.reserve(std::size(raw_rows));
    for (const RawRow& raw : raw_rows) {
        rows.push_back(decode(raw));
    }
    return rows;
}

// Rows that repeat their last argument after four of a kind are splines: those are knots.
std::size_t num_without_knots(const BuiltinRow& row) {
    constexpr std::size_t least_knots = 4;
    const bool has_knots = row.repeats_last && row.args.size() > least_knots;
    return row.args.size() - (has_knots ? least_knots : 0);
}

std::vector<int> places_of(const BuiltinRow& row) {
    std::vector<int> places;
    for (std::size_t i = 0; i < num_without_knots(row); ++i) {
        const ArgSpec& a = row.args[i];
        const bool is_numeric = a.kind != ArgKind::Anything && a.type != Type::String;
        if (is_numeric && !a.is_output && !a.is_array) {
            places.push_back(static_cast<int>(i) + (row.has(PropChannel) && i > 0 ? 1 : 0));
        }
    }
    return places;
}

constexpr std::array<VariableRow, SL_VAR_COUNT> variables = {{
#define SL_TABLE_TYPE_float     Type::Float
#define SL_TABLE_TYPE_color     Type::Color
#define SL_TABLE_TYPE_point     Type::Point
#define SL_TABLE_TYPE_vector    Type::Vector
#define SL_TABLE_TYPE_normal    Type::Normal
#define SL_TABLE_DETAIL_uniform Detail::Uniform
#define SL_TABLE_DETAIL_varying Detail::Varying
#define SL_VAR(name, type, detail, readable, writable, note)                                       \
    {#name, SL_TABLE_TYPE_##type, SL_TABLE_DETAIL_##detail, readable, writable, note},
#include "runtime/abi/sl_variables.def"
#undef SL_VAR
}};

} // namespace

BuiltinRow decode_row(std::string_view name, std::string_view signature, std::uint32_t properties) {
    return decode({name, signature, "", 0, properties, ""});
}

bool BuiltinRow::sets_pair(std::string_view name_of_pair) const {
    bool sets = false;
    for (std::size_t at = 0; at < output_pairs.size();) {
        const std::size_t end = std::min(output_pairs.find(' ', at), output_pairs.size());
        const std::string_view pattern = output_pairs.substr(at, end - at);
        if (pattern.starts_with('-')) {
            sets = sets && !matches(pattern.substr(1), name_of_pair);
        } else {
            sets = sets || matches(pattern, name_of_pair);
        }
        at = end + 1;
    }
    return sets;
}

std::span<const BuiltinRow> builtin_rows() {
    static const std::vector<BuiltinRow> rows = decode_all();
    return rows;
}

std::vector<int> find_builtins(std::string_view name) {
    std::vector<int> found;
    const auto rows = builtin_rows();
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (rows[i].name == name && !rows[i].has(PropHidden)) {
            found.push_back(static_cast<int>(i));
        }
    }
    return found;
}

int find_builtin_by_body(std::string_view body) {
    const auto rows = builtin_rows();
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (rows[i].body == body) {
            return static_cast<int>(i);
        }
    }
    return -1;
}

const std::vector<int>& difference_places(int row) {
    static const std::vector<std::vector<int>> places = [] {
        std::vector<std::vector<int>> all;
        for (const BuiltinRow& r : builtin_rows()) {
            all.push_back(places_of(r));
        }
        return all;
    }();
    return places[static_cast<std::size_t>(row)];
}

std::span<const VariableRow> variable_rows() {
    return variables;
}

int find_variable(std::string_view name) {
    for (std::size_t i = 0; i < variables.size(); ++i) {
        if (variables[i].name == name) {
            return static_cast<int>(i);
        }
    }
    return -1;
}

std::string_view type_name(Type type) {
    constexpr std::string_view names[] = {"void",   "float",  "color",  "point",
                                          "vector", "normal", "matrix", "string"};
    return names[static_cast<std::size_t>(type)];
}

std::string_view detail_name(Detail detail) {
    return detail == Detail::Uniform ? "uniform" : "varying";
}

std::string_view shader_type_name(sl_shader_type type) {
    constexpr std::string_view names[] = {"surface", "displacement", "light",
                                          "volume",  "imager",       "transformation"};
    return names[static_cast<std::size_t>(type)];
}

} // namespace slc
