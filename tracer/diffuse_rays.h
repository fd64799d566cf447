// SPDX-License-Identifier: Apache-2.0
// Rays that gather indirect light: many at once, so that what they meet is shaded in full batches.
// In: rays and the seeds of what they start. Out: the colour that arrives along each, and how far
// away its first surface is. Radiometry: a hit's Ci is radiance in the units of Cl (design.md,
// section 7).
#pragma once

#include "tracer/ray_layers.h"

#include <cstdint>
#include <limits>
#include <vector>

namespace trace {

class DiffuseRays {
public:
    static constexpr float nothing = std::numeric_limits<float>::infinity();

    struct Ray {
        base::V3f origin, direction; // unit
        float max_distance = nothing;
        float time = 0;
        float width = 0; // of the surface that asked, as far as it is known
        std::uint32_t seed = 0;
        MediumId medium = 0;
    };

    void clear();
    void add(const Ray& ray);
    [[nodiscard]] std::size_t size() const { return seeds_.size(); }
    [[nodiscard]] bool empty() const { return seeds_.empty(); }

    struct Asker {
        const FrameContext& frame;
        ThreadState& thread;
        int level = 0, diffuse_level = 0; // of the point the rays start from
        float spread = 0;                 // growth of their width per unit of length
        RayFilter filter{};
    };
    // Shades what they meet. Rays beyond the ray level limit are black and meet nothing.
    void shade(const Asker& asker);
    // Distances only ...
    void intersect(const Asker& asker);
    // ... or whether there is anything: 0 or `nothing`.
    void occlude(const Asker& asker);

    [[nodiscard]] const base::Color& radiance(std::size_t ray) const { return radiance_[ray]; }
    [[nodiscard]] float distance(std::size_t ray) const { return distance_[ray]; }

private:
    [[nodiscard]] RayBundle bundle(const Asker& asker);
    void note_distances();

    std::vector<geo::RayPacket> packets_;
    std::vector<std::uint32_t> seeds_;
    std::vector<float> widths_;
    std::vector<RayCone> cones_;
    std::vector<MediumId> media_;
    std::vector<geo::Hit> hits_; // 8 per packet
    std::vector<Sample> samples_;
    std::vector<base::Color> radiance_;
    std::vector<float> distance_;
};

} // namespace trace
