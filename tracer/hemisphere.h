// SPDX-License-Identifier: Apache-2.0
// occlusion() and indirectdiffuse(): what the cone about a normal is full of (sl.md 4.6). In: a
// ray query of one packet, kinds SL_RAYS_occlusion and SL_RAYS_indirect, with the options of
// sl_ray_options.def. Out: its C, and its channels "environmentdir", "environmentcolor",
// "occlusion". What a lane gets depends on its point and seed only.
#pragma once

#include "runtime/abi/sl_abi.h"

namespace trace {

class Execution;

void answer_hemisphere(Execution& execution, sl_ray_query& query);

} // namespace trace
