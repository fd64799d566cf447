// SPDX-License-Identifier: Apache-2.0
// LightSource "indirect" (bmrt.md): where it shines, by which settings, and the irradiance records
// of the frame. In: the scene's attribute states. What its light is: indirect_ambient.h.
#pragma once

#include "ribtools/scene.h"
#include "tracer/irradiance_cache.h"

#include <cstdint>
#include <vector>

namespace trace {

// The attributes "indirect", and "irradiance" where those are not given.
struct IndirectSettings {
    std::uint32_t num_rays = 256; // per point; 0: no indirect light
    float max_error = 0.25f;      // 0: nothing is interpolated
    float max_pixel_distance = 20;
};
[[nodiscard]] IndirectSettings indirect_settings(const rib::Attributes& attributes);

// LightSource "indirect": no shader of that name is looked for.
[[nodiscard]] bool is_indirect_light(const rib::Scene& scene, const rib::Light& light);

class IndirectLight {
public:
    // Where the light named "indirect" shines, by the scene's attribute states.
    explicit IndirectLight(const rib::Scene& scene);

    // Some surface is lit by it.
    [[nodiscard]] bool is_used() const { return is_used_; }
    [[nodiscard]] bool interpolates() const { return interpolates_; }
    [[nodiscard]] const IndirectSettings& settings(std::uint32_t attributes) const {
        return settings_[attributes];
    }
    // Rays of a point that no record covers: the samples of its pixel share the work.
    [[nodiscard]] std::uint32_t rays_uncovered(const IndirectSettings& settings) const;
    // Diffuse rays that may follow each other: Option "indirect" "maxbounce".
    [[nodiscard]] int max_bounces() const { return max_bounces_; }

    IrradianceCache cache; // filled before rendering, then only read

private:
    std::vector<IndirectSettings> settings_; // num_rays 0 where it does not shine
    bool is_used_ = false, interpolates_ = false;
    int max_bounces_ = 0;
    std::uint32_t samples_per_pixel_ = 1;
};

} // namespace trace
