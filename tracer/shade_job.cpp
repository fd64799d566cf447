// SPDX-License-Identifier: Apache-2.0
#include "tracer/shade_job.h"

namespace trace {

geo::Incident ShadeJob::incident() const {
    const auto all = [this](const std::array<float, size>& values) {
        return std::span<const float>(values.data(), count());
    };
    geo::Incident incident{all(ox), all(oy), all(oz), all(dx), all(dy), all(dz), all(footprint)};
    if (subject.rays.level > 0) {
        incident.widening = all(widening);
    }
    return incident;
}

ShadeJob& ShadeJobs::take() {
    if (free_.empty()) {
        free_.push_back(all_.emplace_back(std::make_unique<ShadeJob>()).get());
    }
    ShadeJob& job = *free_.back();
    free_.pop_back();
    return job;
}

void ShadeJobs::give(ShadeJob& job) {
    job.surface_execution.reset();
    job.misses.clear();
    free_.push_back(&job);
}

} // namespace trace
