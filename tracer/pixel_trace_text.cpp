// SPDX-License-Identifier: Apache-2.0
#include "tracer/pixel_trace_text.h"

#include <array>
#include <charconv>
#include <cstdio>

namespace trace {

namespace {

struct VariableRow {
    std::string_view name, type;
    int components;
    bool is_uniform;
};

constexpr int components_of_type(std::string_view type) {
    return type == "float" ? 1 : 3;
}

enum class Detail : std::uint8_t { uniform, varying }; // as the rows write it

constexpr VariableRow variable_rows[] = {
#define SL_VAR(name, type, detail, readable, writable, note)                                       \
    {#name, #type, components_of_type(#type), Detail::detail == Detail::uniform},
#include "runtime/abi/sl_variables.def"
#undef SL_VAR
};

constexpr std::array<std::string_view, 7> quadric_names = {
    "Sphere", "Cone", "Cylinder", "Hyperboloid", "Paraboloid", "Disk", "Torus"};

struct ShapeName {
    std::string operator()(const rib::Quadric& q) const {
        return std::string(quadric_names[static_cast<std::size_t>(q.kind)]);
    }
    std::string operator()(const rib::Polygons&) const { return "polygon"; }
    std::string operator()(const rib::Patches& p) const {
        return p.is_mesh ? "PatchMesh" : "Patch";
    }
    std::string operator()(const rib::NuPatch&) const { return "NuPatch"; }
    std::string operator()(const rib::SubdivisionMesh&) const { return "SubdivisionMesh"; }
    std::string operator()(const rib::Points&) const { return "Points"; }
    std::string operator()(const rib::Curves&) const { return "Curves"; }
    std::string operator()(const rib::Blobby&) const { return "Blobby"; }
    std::string operator()(const rib::Geometry& g) const { return "Geometry " + quoted(g.name); }
    std::string operator()(const rib::Procedural& p) const {
        return "Procedural " + quoted(p.kind);
    }
};

} // namespace

std::string number_text(float value) {
    char text[32];
    value = value == 0 ? 0 : value; // no minus sign
    const auto [end, error] = std::to_chars(std::begin(text), std::end(text), value);
    return error == std::errc() ? std::string(text, end) : "?";
}

std::string numbers_text(std::span<const float> values) {
    std::string text;
    for (const float value : values) {
        text += (text.empty() ? "" : " ") + number_text(value);
    }
    return text;
}

std::string vector_text(const base::V3d& v) {
    const float values[] = {static_cast<float>(v.x), static_cast<float>(v.y),
                            static_cast<float>(v.z)};
    return numbers_text(values);
}

std::string quoted(std::string_view name) {
    std::string text = "\"";
    for (const char c : name) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte < 0x20 || byte == 0x7f) {
            char code[8];
            std::snprintf(code, sizeof code, "\\%03o", static_cast<unsigned>(byte));
            text += code;
        } else {
            text += c == '"' || c == '\\' ? "\\" : "";
            text += c;
        }
    }
    return text + "\"";
}

std::string parameter_text(rt::ShadeBatch& batch, int param, std::uint32_t point) {
    const sl_param& p = batch.instance().object().params[param];
    const int elements = std::max(p.array_length, 1);
    std::string text;
    if (p.type == SL_TYPE_string) {
        const sl_string* varying = batch.param_strings(param);
        const sl_string* uniform = batch.param_uniform_string(param);
        for (int i = 0; i < elements; ++i) {
            const sl_string value =
                varying != nullptr ? varying[static_cast<std::size_t>(i) * batch.stride() + point]
                                   : uniform[i];
            text += (i == 0 ? "" : " ") + quoted(value != nullptr ? value : "");
        }
        return text;
    }
    const float* uniform = batch.param_uniform(param);
    for (int k = 0; k < elements * rt::components_of(p.type); ++k) {
        text += (k == 0 ? "" : " ") +
                number_text(uniform != nullptr ? uniform[k] : batch.param_plane(param, k)[point]);
    }
    return text;
}

std::string variable_text(rt::ShadeBatch& batch, sl_variable id, std::uint32_t point) {
    const VariableRow& row = variable_rows[id];
    std::string text;
    for (int k = 0; k < row.components; ++k) {
        text += (k == 0 ? "" : " ") +
                number_text(row.is_uniform ? batch.uniform(id)[k] : batch.plane(id, k)[point]);
    }
    return text;
}

std::string_view variable_name(sl_variable id) {
    return variable_rows[id].name;
}

std::string_view variable_type(sl_variable id) {
    return variable_rows[id].type;
}

std::string shape_name(const rib::Primitive& primitive) {
    return std::visit(ShapeName(), primitive.shape);
}

} // namespace trace
