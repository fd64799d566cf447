// SPDX-License-Identifier: Apache-2.0
// The renderer's state as shaders may ask for it: attribute(), option(), rendererinfo() of
// sl.md 4.8. Integers come back as floats. Pure.
#pragma once

#include "ribtools/scene.h"
#include "runtime/abi/sl_abi.h"
#include "tracer/spaces.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace trace {

struct StateValue {
    sl_type type = SL_TYPE_float;
    std::vector<float> floats;
    std::vector<std::string> texts; // type string
};

[[nodiscard]] std::optional<StateValue> query_attribute(const rib::Attributes& attributes,
                                                        std::string_view name);
[[nodiscard]] std::optional<StateValue> query_option(const rib::Options& options,
                                                     std::string_view name);
[[nodiscard]] std::optional<StateValue> query_renderer(std::string_view name);
// "Ri:Transformation": depends on the point, so the caller supplies its space.
[[nodiscard]] std::optional<StateValue>
world_from_object_value(const Spaces& spaces, const base::Mat4& camera_from_object);

} // namespace trace
