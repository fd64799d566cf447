// SPDX-License-Identifier: Apache-2.0
#include "tracer/hemisphere_gather.h"

#include "tracer/execution.h"

#include <algorithm>
#include <cmath>

namespace trace {

namespace {

// Rays in work at a time: their hits fill batches, their records fit the cache.
constexpr std::size_t rays_at_once = 8192;

} // namespace

// Where the shading normal leans away from the surface, rays below the surface are mirrored at it:
// they would start inside.
void HemisphereGather::add(const DiffusePoint& point, const HemisphereStrata& strata) {
    const HemisphereFrame frame = HemisphereFrame::about(point.N);
    const HemisphereCone cone = HemisphereCone::of(2, HemisphereDensity::Cosine);
    SampleStream stream(point.seed);
    for (std::uint32_t cell = 0; cell < strata.count(); ++cell) {
        const float x = stream.next(), y = stream.next();
        const base::V3f local = direction_in(strata, cone, cell, x, y);
        base::V3f direction = frame.from_local(local.x, local.y, local.z);
        const float height = base::dot(direction, point.Ng);
        direction -= std::min(2 * height, 0.0f) * point.Ng;
        local_.push_back(local);
        rays_.add({.origin = asker_.frame.world->spawn_origin(point.hit, direction),
                   .direction = direction,
                   .time = point.hit.time,
                   .seed = stream.next_bits(),
                   .medium = point.medium});
    }
}

void HemisphereGather::means(std::span<const DiffusePoint> points, std::uint32_t num_rays,
                             std::span<base::Color> out) {
    const HemisphereStrata strata = HemisphereStrata::of(num_rays);
    const std::uint32_t each = strata.count();
    const std::size_t points_at_once = std::max<std::size_t>(rays_at_once / each, 1);
    asker_.spread = std::sqrt(2.0f / static_cast<float>(each));
    for (std::size_t begin = 0; begin < points.size(); begin += points_at_once) {
        const std::size_t end = std::min(begin + points_at_once, points.size());
        rays_.clear();
        local_.clear();
        for (std::size_t i = begin; i < end; ++i) {
            add(points[i], strata);
        }
        rays_.shade(asker_);
        for (std::size_t i = begin; i < end; ++i) {
            base::Color sum;
            for (std::size_t ray = (i - begin) * each; ray < (i - begin + 1) * each; ++ray) {
                sum += rays_.radiance(ray);
            }
            out[i] = sum * (1 / static_cast<float>(each));
        }
    }
}

IrradianceRecord HemisphereGather::record(const DiffusePoint& point, float& harmonic_mean) {
    HemisphereAnswers answers;
    answers.strata = HemisphereStrata::of(point.settings.num_rays);
    asker_.spread = std::sqrt(2.0f / static_cast<float>(answers.strata.count()));
    rays_.clear();
    local_.clear();
    add(point, answers.strata);
    rays_.shade(asker_);
    radiance_.resize(rays_.size());
    distance_.resize(rays_.size());
    for (std::size_t i = 0; i < rays_.size(); ++i) {
        radiance_[i] = rays_.radiance(i);
        distance_[i] = rays_.distance(i);
    }
    answers.direction = local_;
    answers.radiance = radiance_;
    answers.distance = distance_;
    harmonic_mean = harmonic_mean_distance(answers);
    IrradianceRecord record;
    record.P = point.P;
    record.N = point.N;
    record.mean = mean_radiance(answers);
    const IrradianceGradients gradients = irradiance_gradients(answers);
    const HemisphereFrame frame = HemisphereFrame::about(point.N);
    for (std::size_t k = 0; k < 3; ++k) {
        const base::V3f &r = gradients.rotation[k], &t = gradients.translation[k];
        record.rotation[k] = frame.from_local(r.x, r.y, r.z);
        record.translation[k] = frame.from_local(t.x, t.y, t.z);
    }
    record.max_error = point.settings.max_error;
    return record;
}

} // namespace trace
