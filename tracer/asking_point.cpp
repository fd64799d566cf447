// SPDX-License-Identifier: Apache-2.0
#include "tracer/asking_point.h"

#include "tracer/execution.h"

namespace trace {

const geo::Hit* hit_at(const Execution& execution, std::uint32_t point, const base::V3f& P) {
    const BatchSubject* subject = execution.subject;
    if (subject == nullptr || point >= subject->hits.size() || execution.batch == nullptr ||
        !execution.batch->has(SL_VAR_P)) {
        return nullptr;
    }
    for (int k = 0; k < 3; ++k) {
        if (execution.batch->plane(SL_VAR_P, k)[point] != P[k]) {
            return nullptr;
        }
    }
    return &subject->hits[point];
}

base::V3f ray_origin(const Execution& execution, std::uint32_t point, const base::V3f& P,
                     const base::V3f& direction) {
    const geo::Hit* hit = hit_at(execution, point, P);
    return hit != nullptr ? execution.frame.world->spawn_origin(*hit, direction) : P;
}

std::uint32_t point_seed(const Execution& execution, std::uint32_t point) {
    const BatchSubject* subject = execution.subject;
    const bool is_known = subject != nullptr && point < subject->rays.seeds.size();
    return is_known ? subject->rays.seeds[point] : point;
}

float point_time(const Execution& execution, std::uint32_t point) {
    const BatchSubject* subject = execution.subject;
    return subject != nullptr && point < subject->hits.size()
               ? subject->hits[point].time
               : execution.frame.spaces.shutter_open();
}

MediumId point_medium(const Execution& execution, std::uint32_t point) {
    const BatchSubject* subject = execution.subject;
    const bool is_known = subject != nullptr && point < subject->rays.media.size();
    return is_known ? subject->rays.media[point] : 0;
}

int diffuse_level(const Execution& execution) {
    return execution.subject != nullptr ? execution.subject->rays.diffuse_level : 0;
}

} // namespace trace
