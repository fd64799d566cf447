// SPDX-License-Identifier: Apache-2.0
#include "tracer/diffuse_rays.h"

#include "tracer/execution.h"
#include "tracer/lights.h"
#include "tracer/ray_levels.h"
#include "tracer/ray_packets.h"

#include <utility>

namespace trace {

namespace {

constexpr std::uint32_t lanes = geo::RayPacket::size;

// The surface of an area light: who asks for its light samples it as a light.
bool is_sampled_light(const FrameContext& frame, const geo::Hit& hit) {
    const rib::LightId light =
        frame.scene.attributes[frame.world->binding(hit).attributes].area_light;
    return frame.lights != nullptr && light < frame.lights->size() &&
           (*frame.lights)[light].shader != nullptr;
}

} // namespace

void DiffuseRays::clear() {
    packets_.clear();
    seeds_.clear();
    widths_.clear();
    media_.clear();
}

void DiffuseRays::add(const Ray& ray) {
    const std::size_t lane = size() % lanes;
    if (lane == 0) {
        packets_.emplace_back();
        packets_.back().active = 0;
    }
    set_ray(packets_.back(), lane,
            {ray.origin, ray.direction, ray.max_distance, ray.time, geo::ReflectionRay});
    seeds_.push_back(ray.seed);
    widths_.push_back(ray.width);
    media_.push_back(ray.medium);
}

RayBundle DiffuseRays::bundle(const Asker& asker) {
    cones_.resize(size());
    for (std::size_t i = 0; i < size(); ++i) {
        cones_[i] = RayCone::from(widths_[i], asker.spread);
    }
    RayBundle rays;
    rays.count = static_cast<std::uint32_t>(size());
    rays.packets = packets_;
    rays.seeds = seeds_;
    rays.level = asker.level + 1;
    rays.kind = SL_RAY_diffuse;
    rays.diffuse_level = asker.diffuse_level + 1;
    rays.cones = cones_;
    rays.media = media_;
    rays.filter = asker.filter;
    return rays;
}

// Directions are unit: a hit's t is its distance.
void DiffuseRays::note_distances() {
    distance_.resize(size());
    for (std::size_t i = 0; i < size(); ++i) {
        distance_[i] = hits_[i].valid() ? hits_[i].t : nothing;
    }
}

void DiffuseRays::shade(const Asker& asker) {
    hits_.assign(packets_.size() * lanes, {});
    samples_.assign(size(), {});
    if (!empty() && asker.level < asker.thread.levels->options().max_level()) {
        asker.thread.counters.add(Counter::rays_diffuse, size());
        const DeeperShader deeper(asker.thread);
        // --trace-pixel tells of samples; these rays are too many to be told.
        PixelTrace* const told = std::exchange(asker.thread.trace, nullptr);
        deeper.rays().trace(bundle(asker), {.samples = samples_, .extra = {}, .first = hits_});
        asker.thread.trace = told;
    }
    note_distances();
    radiance_.resize(size());
    for (std::size_t i = 0; i < size(); ++i) {
        const float* c = samples_[i].color;
        const bool is_dark = hits_[i].valid() && is_sampled_light(asker.frame, hits_[i]);
        radiance_[i] = is_dark ? base::Color() : base::Color(c[0], c[1], c[2]);
    }
}

void DiffuseRays::intersect(const Asker& asker) {
    hits_.assign(packets_.size() * lanes, {});
    asker.thread.counters.add(Counter::rays_occlusion, size());
    if (!empty()) {
        const DeeperShader deeper(asker.thread);
        deeper.rays().intersect(bundle(asker), hits_);
    }
    note_distances();
}

void DiffuseRays::occlude(const Asker& asker) {
    asker.thread.counters.add(Counter::rays_occlusion, size());
    distance_.resize(size());
    for (std::size_t p = 0; p < packets_.size(); ++p) {
        const std::uint32_t blocked = asker.frame.world->occluded(packets_[p]);
        for (std::size_t lane = 0; lane < lanes && p * lanes + lane < size(); ++lane) {
            distance_[p * lanes + lane] = (blocked >> lane & 1U) != 0 ? 0.0f : nothing;
        }
    }
}

} // namespace trace
