// SPDX-License-Identifier: Apache-2.0
// What shaders ask of rays (sl_ray_query): questions of packets in, answers out.
#pragma once

#include "runtime/abi/sl_abi.h"

namespace trace {

class Execution;

// The service `rays`: answers at once, for the lanes of one packet.
void answer_rays(Execution& execution, sl_ray_query& query);

} // namespace trace
