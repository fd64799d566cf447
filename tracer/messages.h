// SPDX-License-Identifier: Apache-2.0
// Message passing between shaders and queries of the renderer's state (sl.md 4.8). A query matches
// when name, type and array length do; the answer goes to the lanes of the mask, other lanes and
// failed queries change nothing.
#pragma once

#include "runtime/abi/sl_abi.h"

#include <cstdint>
#include <string>
#include <string_view>

namespace rt {
class ShadeBatch;
}

namespace trace {

class Execution;
struct ShaderEntry;

struct MessageQuery {
    std::int32_t kind; // SL_MESSAGE_*
    sl_string name;
    std::int32_t type; // sl_type
    std::int32_t array_length;
    std::uint32_t first; // batch index of lane 0
    std::uint32_t mask;
    float* value;        // planes of `lanes`, or sl_string per lane
    std::uint32_t lanes; // of who asks
};

// The lanes that were set.
std::uint32_t answer_message(const Execution& execution, const MessageQuery& query);

// The same of one shader's parameter as its batch holds it now: output parameters have their last
// value. Lane 0 is point `at` of the batch.
std::uint32_t param_of_batch(const MessageQuery& query, const ShaderEntry& shader,
                             rt::ShadeBatch& batch, std::uint32_t at);

// shadername(type): the shader of that type bound to the point being shaded; "" if there is none.
[[nodiscard]] std::string bound_shader_name(const Execution& execution, std::string_view type);

} // namespace trace
