// SPDX-License-Identifier: Apache-2.0
// RI types as the Shading Language sees them.
#pragma once

#include "ribtools/param.h"
#include "runtime/abi/sl_abi.h"

namespace trace {

// Integers are floats there; what has no counterpart is void.
[[nodiscard]] constexpr sl_type sl_type_of(rib::ParamType type) {
    switch (type) {
    case rib::ParamType::Float:
    case rib::ParamType::Integer:
        return SL_TYPE_float;
    case rib::ParamType::String:
        return SL_TYPE_string;
    case rib::ParamType::Color:
        return SL_TYPE_color;
    case rib::ParamType::Point:
    case rib::ParamType::HPoint:
        return SL_TYPE_point;
    case rib::ParamType::Vector:
        return SL_TYPE_vector;
    case rib::ParamType::Normal:
        return SL_TYPE_normal;
    case rib::ParamType::Matrix:
    case rib::ParamType::MPoint:
        return SL_TYPE_matrix;
    case rib::ParamType::Pointer:
        return SL_TYPE_void;
    }
    return SL_TYPE_void;
}

// The other way.
[[nodiscard]] constexpr rib::ParamType rib_type_of(int type) {
    switch (type) {
    case SL_TYPE_color:
        return rib::ParamType::Color;
    case SL_TYPE_point:
        return rib::ParamType::Point;
    case SL_TYPE_vector:
        return rib::ParamType::Vector;
    case SL_TYPE_normal:
        return rib::ParamType::Normal;
    case SL_TYPE_matrix:
        return rib::ParamType::Matrix;
    case SL_TYPE_string:
        return rib::ParamType::String;
    default:
        return rib::ParamType::Float;
    }
}

// Points, vectors and normals may stand for each other; everything else must match.
[[nodiscard]] constexpr bool types_agree(int a, int b) {
    const auto is_geometric = [](int type) {
        return type == SL_TYPE_point || type == SL_TYPE_vector || type == SL_TYPE_normal;
    };
    return a == b || (is_geometric(a) && is_geometric(b));
}

} // namespace trace
