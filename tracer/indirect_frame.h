// SPDX-License-Identifier: Apache-2.0
// Indirect light of a frame, made ready for rendering: records of Option "indirect" "seedfile" are
// read, those the picture lacks are found, all are written to "savefile". Files hold world space.
#pragma once

#include "tracer/indirect_prepass.h"
#include "tracer/stats.h"

namespace trace {

// False: it was interrupted, and nothing was written. `counted` gets what the threads counted.
[[nodiscard]] bool prepare_indirect(IndirectLight& light, const IndirectPrepass::Tools& tools,
                                    Counters& counted);

// A record in another space: `to_from` may turn, mirror, move and scale evenly.
[[nodiscard]] IrradianceRecord transformed(const IrradianceRecord& record,
                                           const base::Mat4& to_from, const base::Mat4& from_to);

} // namespace trace
