// SPDX-License-Identifier: Apache-2.0
// Values at the hit of a ray, by name (sl.md 4.9): "surface:Kd", "displacement:x", "volume:x",
// "primitive:N", "attribute:user:x", "ray:length", and parameters sent there, "send:surface:Kd".
// In: the channels of a query. Out: their values in one lane. Values come from the batch that has
// just shaded the hit, or, for primitives, attributes and rays, from the hit itself.
#pragma once

#include "runtime/abi/sl_abi.h"
#include "tracer/film.h"
#include "tracer/shade_job.h"

#include <span>

namespace trace {

[[nodiscard]] std::span<sl_ray_channel> channels_of(sl_ray_query& query);

// Some value that is asked for needs the hit to be shaded.
[[nodiscard]] bool asks_for_shading(const sl_ray_query& query);
[[nodiscard]] bool sends(const sl_ray_query& query);
// What is sent in these two lanes is the same.
[[nodiscard]] bool sends_alike(const sl_ray_query& a, std::uint32_t lane_a, const sl_ray_query& b,
                               std::uint32_t lane_b);

// From shaders: point `point` of a batch that is done.
void read_shaded(sl_ray_query& query, std::uint32_t lane, ShadeJob& job, std::uint32_t point);
// From the hit alone.
void read_hit(sl_ray_query& query, std::uint32_t lane, const FrameContext& frame,
              const geo::Hit& hit);
// Of the ray, whatever it met.
struct ChannelRay {
    base::V3f origin, direction;
    float length = 0;
};
void read_ray(sl_ray_query& query, std::uint32_t lane, const ChannelRay& ray);
// "surface:Ci" and "surface:Oi": with what lies behind.
void read_color(sl_ray_query& query, std::uint32_t lane, const Sample& color);

// Sets what is sent in a lane as parameters of the batch that is about to shade the hits.
void bind_sent(const sl_ray_query& query, std::uint32_t lane, ShadeJob& job);

} // namespace trace
