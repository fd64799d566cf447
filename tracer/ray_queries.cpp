// SPDX-License-Identifier: Apache-2.0
#include "tracer/ray_queries.h"

#include "tracer/execution.h"
#include "tracer/hemisphere.h"
#include "tracer/ray_levels.h"
#include "tracer/ray_packets.h"
#include "tracer/transmission.h"

#include <algorithm>
#include <bit>

namespace trace {

namespace {

// The ray of a lane goes on for ever.
void miss(sl_ray_query& query, std::uint32_t lane, int ray_level) {
    const bool passes = query.kind == SL_RAYS_transmission || query.kind == SL_RAYS_shadow;
    for (std::uint32_t k = 0; k < 3; ++k) {
        const std::uint32_t at = k * query.lanes + lane;
        query.C[at] = passes ? 1.0f : 0.0f;
        query.Phit[at] = query.Nhit[at] = 0;
        query.Pmiss[at] = query.P[at];
        query.Rmiss[at] = query.D[at];
    }
    query.distance[lane] = very_far;
    query.level_missed[lane] = static_cast<float>(ray_level + 1);
}

void miss_all(const Execution& execution, sl_ray_query& query) {
    query.hit = 0;
    for (std::uint32_t rest = query.mask; rest != 0; rest &= rest - 1) {
        miss(query, static_cast<std::uint32_t>(std::countr_zero(rest)), execution.ray_level);
    }
}

} // namespace

void answer_rays(Execution& execution, sl_ray_query& query) {
    ThreadState* thread = execution.thread;
    if (thread == nullptr || thread->levels == nullptr || execution.frame.world == nullptr) {
        miss_all(execution, query); // parameters are being bound, or an imager runs: no rays
        return;
    }
    switch (query.kind) {
    case SL_RAYS_transmission:
    case SL_RAYS_shadow:
        answer_transmission(execution, query);
        return;
    case SL_RAYS_trace:
    case SL_RAYS_fulltrace:
    case SL_RAYS_hittest:
    case SL_RAYS_gather: {
        const DeeperShader deeper(*thread);
        const RayAsk ask{&query, &execution};
        deeper.wave().answer({&ask, 1});
        return;
    }
    case SL_RAYS_occlusion:
    case SL_RAYS_indirect:
        answer_hemisphere(execution, query);
        return;
    default: // transmission and its like are answered elsewhere: nothing is in the way
        miss_all(execution, query);
    }
}

} // namespace trace
