// SPDX-License-Identifier: Apache-2.0
// Message passing between shaders and queries of the renderer's state (sl.md 4.8). A query matches
// when name, type and array length do; the answer goes to the lanes of the mask, other lanes and
// failed queries change nothing.
#pragma once

#include "runtime/abi/sl_abi.h"

#include <cstdint>
#include <string>
#include <string_view>

namespace trace {

class Execution;

struct MessageQuery {
    std::int32_t kind; // SL_MESSAGE_*
    sl_string name;
    std::int32_t type; // sl_type
    std::int32_t array_length;
    std::uint32_t first; // batch index of lane 0
    std::uint32_t mask;
    float* value; // planes of the execution's lanes, or sl_string per lane
};

// The lanes that were set.
std::uint32_t answer_message(const Execution& execution, const MessageQuery& query);

// shadername(type): the shader of that type bound to the point being shaded; "" if there is none.
[[nodiscard]] std::string bound_shader_name(const Execution& execution, std::string_view type);

} // namespace trace
