// SPDX-License-Identifier: Apache-2.0
#include "tracer/indirect_light.h"

#include <algorithm>
#include <cmath>

namespace trace {

namespace {

constexpr std::uint32_t max_rays = 1U << 16;
// Uncovered points of one pixel need not be better than what is interpolated, together; each is
// still a hemisphere.
constexpr std::uint32_t least_rays = 16;

const rib::Param* given(const rib::Attributes& attributes, const char* name, const char* other) {
    const rib::Param* param = attributes.find(name);
    return param != nullptr ? param : attributes.find(other);
}

float number_of(const rib::Param* param, float fallback) {
    const bool is_int = param != nullptr && !param->ints.empty();
    const float value = is_int ? static_cast<float>(param->ints[0])
                        : param != nullptr && !param->floats.empty() ? param->floats[0]
                                                                     : fallback;
    return std::isfinite(value) ? std::max(value, 0.0f) : fallback;
}

} // namespace

IndirectSettings indirect_settings(const rib::Attributes& attributes) {
    IndirectSettings s;
    s.max_error = std::min(
        number_of(given(attributes, "indirect:maxerror", "irradiance:maxerror"), s.max_error),
        10.0f);
    s.max_pixel_distance =
        number_of(given(attributes, "indirect:maxpixeldist", "irradiance:maxpixeldist"),
                  s.max_pixel_distance);
    const float rays =
        number_of(attributes.find("indirect:nsamples"), static_cast<float>(s.num_rays));
    s.num_rays = static_cast<std::uint32_t>(std::min(rays, float{max_rays}));
    return s;
}

bool is_indirect_light(const rib::Scene& scene, const rib::Light& light) {
    return !light.is_area && light.shader < scene.shaders.size() &&
           scene.shaders[light.shader].name == "indirect";
}

IndirectLight::IndirectLight(const rib::Scene& scene) {
    const rib::Options& options = scene.options;
    const auto bounces = options.user.find("indirect:maxbounce");
    max_bounces_ = static_cast<int>(
        number_of(bounces != options.user.end() ? &bounces->second : nullptr, 1000.0f));
    samples_per_pixel_ = static_cast<std::uint32_t>(std::max(
        1.0f, static_cast<float>(options.xsamples) * static_cast<float>(options.ysamples)));
    for (const rib::Attributes& attributes : scene.attributes) {
        const bool shines = std::ranges::any_of(attributes.lights, [&](rib::LightId id) {
            return id < scene.lights.size() && is_indirect_light(scene, scene.lights[id]);
        });
        IndirectSettings& s = settings_.emplace_back(indirect_settings(attributes));
        s.num_rays = shines ? s.num_rays : 0;
        is_used_ |= s.num_rays > 0;
        interpolates_ |= s.num_rays > 0 && s.max_error > 0;
    }
}

std::uint32_t IndirectLight::rays_uncovered(const IndirectSettings& settings) const {
    if (settings.max_error == 0) {
        return settings.num_rays;
    }
    const std::uint32_t share = settings.num_rays / samples_per_pixel_;
    return std::clamp(share, std::min(least_rays, settings.num_rays), settings.num_rays);
}

} // namespace trace
