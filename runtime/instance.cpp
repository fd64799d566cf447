// SPDX-License-Identifier: Apache-2.0
// A shader with its parameters: bound values first, then the shader's own init code fills in the
// rest, because defaults may name spaces and earlier parameters. reference/ri.md 16.8, sl.md 5.8.
#include "runtime/shader.h"

#include <algorithm>
#include <cstring>

namespace rt {

namespace {

// Past the pointer slot of varying parameters.
constexpr std::size_t staging_offset = 16;

bool is_point_like(int type) {
    return type == SL_TYPE_point || type == SL_TYPE_vector || type == SL_TYPE_normal;
}

// Exact types, or points, vectors and normals among themselves.
bool type_fits(int declared, int given) {
    return declared == given || (is_point_like(declared) && is_point_like(given));
}

std::size_t elements(const sl_param& param) {
    return static_cast<std::size_t>(std::max(param.array_length, 1));
}

std::size_t num_floats(const sl_param& param) {
    return elements(param) * static_cast<std::size_t>(components_of(param.type));
}

bool length_fits(const sl_param& param, const BoundValue& value) {
    const bool same = std::max(param.array_length, 1) == std::max(value.array_length, 1);
    const std::size_t given =
        param.type == SL_TYPE_string ? value.strings.size() : value.floats.size();
    return same && given >= (param.type == SL_TYPE_string ? elements(param) : num_floats(param));
}

} // namespace

int components_of(int type) {
    switch (type) {
    case SL_TYPE_void:
        return 0;
    case SL_TYPE_float:
    case SL_TYPE_string:
        return 1;
    case SL_TYPE_matrix:
        return 16;
    default:
        return 3;
    }
}

std::string type_text(int type, int array_length) {
    static constexpr const char* names[] = {"void",   "float",  "color",  "point",
                                            "vector", "normal", "matrix", "string"};
    std::string text = type >= 0 && type <= SL_TYPE_string ? names[type] : "?";
    return array_length > 0 ? text + "[" + std::to_string(array_length) + "]" : text;
}

bool have_same_block(const ShaderObject& a, const ShaderObject& b) {
    const sl_object &x = a.object(), &y = b.object();
    const auto same = [](const sl_param& p, const sl_param& q) {
        return std::strcmp(p.name, q.name) == 0 && p.type == q.type && p.detail == q.detail &&
               p.array_length == q.array_length && p.is_output == q.is_output &&
               p.offset == q.offset;
    };
    return x.type == y.type && x.params_size == y.params_size && x.num_params == y.num_params &&
           std::equal(x.params, x.params + x.num_params, y.params, same) &&
           a.variant().lanes == b.variant().lanes;
}

ShaderInstance::ShaderInstance(const ShaderObject& object, std::span<const BoundValue> values,
                               const sl_services& services, void* engine, StringTable& strings,
                               base::Diag& diag)
    : object_(object), params_(object.object().params_size),
      bound_(static_cast<std::size_t>(object.object().num_params)) {
    const sl_object& o = object.object();
    const sl_string empty = strings.intern("");
    for (int i = 0; i < o.num_params; ++i) {
        if (o.params[i].type == SL_TYPE_string) {
            auto* slot = reinterpret_cast<sl_string*>(value_slot(o.params[i]));
            std::fill_n(slot, elements(o.params[i]), empty);
        }
    }
    for (const BoundValue& value : values) {
        bind(value, strings, diag);
    }
    const sl_init init{params_.data(), bound_.data(), object.strings().data(), &services, engine};
    object.variant().init(&init);
}

bool ShaderInstance::bind(const BoundValue& value, StringTable& strings, base::Diag& diag) {
    const sl_object& o = object();
    const std::string where = std::string(o.name) + ": parameter \"" + value.name + "\"";
    const int index = object_.find_param(value.name);
    if (index < 0) {
        diag.report_once("param " + where, base::Severity::Warning, base::Code::BadToken, value.pos,
                         "shader " + std::string(o.name) + " has no parameter \"" + value.name +
                             "\"; ignored");
        return false;
    }
    const sl_param& param = o.params[index];
    if (!type_fits(param.type, value.type) || !length_fits(param, value)) {
        diag.report(base::Severity::Error, base::Code::Consistency, value.pos,
                    "shader " + where + " is declared " +
                        type_text(param.type, param.array_length) + " but given " +
                        type_text(value.type, value.array_length) + "; its default is used");
        return false;
    }
    std::byte* slot = value_slot(param);
    if (param.type == SL_TYPE_string) {
        auto* to = reinterpret_cast<sl_string*>(slot);
        for (std::size_t i = 0; i < elements(param); ++i) {
            to[i] = strings.intern(value.strings[i]);
        }
    } else {
        std::memcpy(slot, value.floats.data(), num_floats(param) * sizeof(float));
    }
    bound_[static_cast<std::size_t>(index)] = 1;
    return true;
}

std::byte* ShaderInstance::value_slot(const sl_param& param) {
    return params_.data() + param.offset +
           (param.detail == SL_DETAIL_varying ? staging_offset : std::size_t{0});
}

const std::byte* ShaderInstance::value_slot(const sl_param& param) const {
    return params_.data() + param.offset +
           (param.detail == SL_DETAIL_varying ? staging_offset : std::size_t{0});
}

std::span<const std::byte> ShaderInstance::params() const {
    return params_;
}

const float* ShaderInstance::uniform_floats(int param) const {
    return reinterpret_cast<const float*>(value_slot(object().params[param]));
}

const sl_string* ShaderInstance::uniform_strings(int param) const {
    return reinterpret_cast<const sl_string*>(value_slot(object().params[param]));
}

} // namespace rt
