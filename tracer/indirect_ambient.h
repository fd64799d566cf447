// SPDX-License-Identifier: Apache-2.0
// What ambient() is where the light "indirect" shines: for the points of a batch the mean radiance
// over their hemispheres, from records where these cover the point, else from rays whose hits ask
// for their own indirect light in turn (trace-022).
#pragma once

#include "runtime/abi/sl_abi.h"

#include <bitset>
#include <cstdint>

namespace trace {

class Execution;

// Indirect light of a batch's points; found when the first of them is asked for.
struct IndirectBatch {
    bool is_found = false;
    std::bitset<SL_BATCH_MAX> is_lit; // the others: ambient lights
    float light[3][SL_BATCH_MAX] = {};
};

// The service `ambient` where the light "indirect" shines: sets planes of C in the lanes it
// returns.
[[nodiscard]] std::uint32_t indirect_ambient(Execution& execution, std::uint32_t first,
                                             std::uint32_t mask, float* C);

} // namespace trace
