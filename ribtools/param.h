// SPDX-License-Identifier: Apache-2.0
// Declared parameters of requests and shaders: type, storage class, values (ri.md, section 10).
#pragma once

#include "runtime/base/diag.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace rib {

enum class StorageClass : std::uint8_t {
    Constant,
    Uniform,
    Varying,
    Vertex,
    FaceVarying,
    FaceVertex
};
enum class ParamType : std::uint8_t {
    Float,
    Integer,
    String,
    Color,
    Point,
    Vector,
    Normal,
    HPoint,
    Matrix,
    MPoint,
    Pointer
};

// Floats per element (ints and strings per element: 1). Colors always have 3 here: ColorSamples is
// applied when the request is read.
[[nodiscard]] int components(ParamType type);

struct ParamDecl {
    StorageClass storage = StorageClass::Uniform;
    ParamType type = ParamType::Float;
    int array_length = 1;
    bool is_array = false;
    friend bool operator==(const ParamDecl&, const ParamDecl&) = default;
};

// One "token" value pair. Exactly one of the three vectors is used, by type.
struct Param {
    std::string name; // without inline declaration
    ParamDecl decl;
    // The name was declared nowhere: decl is guessed from the value (numbers: float, strings:
    // string). A shader call's parameter takes its type from the shader; BADTOKEN only if the
    // shader lacks it.
    bool guessed = false;
    std::vector<float> floats;        // float, color, point, vector, normal, hpoint, matrix, mpoint
    std::vector<std::int32_t> ints;   // integer
    std::vector<std::string> strings; // string
    base::SourcePos pos;

    // Elements of decl.type[array_length] that the value holds.
    [[nodiscard]] std::size_t num_items() const;
    // Equal name, type and values; the place is not compared.
    friend bool operator==(const Param& a, const Param& b) {
        return a.name == b.name && a.decl == b.decl && a.floats == b.floats && a.ints == b.ints &&
               a.strings == b.strings;
    }
};

struct ParamList {
    std::vector<Param> params;

    [[nodiscard]] const Param* find(std::string_view name) const;
    // First float / int / string of a parameter, or the default.
    [[nodiscard]] float get_float(std::string_view name, float fallback) const;
    [[nodiscard]] int get_int(std::string_view name, int fallback) const;
    // All numbers of a parameter, integers as floats; empty without one.
    [[nodiscard]] std::vector<float> get_numbers(std::string_view name) const;
    [[nodiscard]] std::string get_string(std::string_view name, std::string_view fallback) const;
    friend bool operator==(const ParamList&, const ParamList&) = default;
};

} // namespace rib
