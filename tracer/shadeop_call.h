// SPDX-License-Identifier: Apache-2.0
// Calls of functions of DSOs (docs/shadeops.md), point by point, with the values of a packet.
#pragma once

#include "runtime/abi/sl_abi.h"

#include <cstdint>
#include <span>

namespace base {
class Shadeop;
}

namespace trace {

class Execution;

// What a thread has looked up: by the address of the interned name.
struct ShadeopItem {
    sl_string function = nullptr;
    const base::Shadeop* shadeop = nullptr; // nullptr: there is none
};

// The service `shadeop`.
void call_shadeop(const Execution& execution, sl_string function, std::uint32_t mask,
                  std::span<const sl_value> outputs, std::span<const sl_value> inputs);

} // namespace trace
