// SPDX-License-Identifier: Apache-2.0
// How values read in --trace-pixel: numbers in the shortest form that gives the same float again,
// names as the scene has them.
#pragma once

#include "ribtools/scene.h"
#include "runtime/abi/sl_abi.h"
#include "runtime/base/vec.h"
#include "runtime/batch.h"

#include <span>
#include <string>
#include <string_view>

namespace trace {

[[nodiscard]] std::string number_text(float value);
// Separated by blanks.
[[nodiscard]] std::string numbers_text(std::span<const float> values);
[[nodiscard]] std::string vector_text(const base::V3d& v);
// In quotes, control characters escaped: names come from RIB files.
[[nodiscard]] std::string quoted(std::string_view name);

// "color", "float[3]" ...: the value of parameter `param` at a point of a batch.
[[nodiscard]] std::string parameter_text(rt::ShadeBatch& batch, int param, std::uint32_t point);
// The value of a variable the batch has.
[[nodiscard]] std::string variable_text(rt::ShadeBatch& batch, sl_variable id, std::uint32_t point);
[[nodiscard]] std::string_view variable_name(sl_variable id);
// "point", "color" ...
[[nodiscard]] std::string_view variable_type(sl_variable id);

// Sphere, PointsGeneralPolygons ...: the request a shape stands for.
[[nodiscard]] std::string shape_name(const rib::Primitive& primitive);

} // namespace trace
