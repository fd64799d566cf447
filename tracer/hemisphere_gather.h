// SPDX-License-Identifier: Apache-2.0
// The light that reaches points of surfaces from all over their hemispheres. In: points with their
// normals and seeds. Out: mean radiance, 1/pi of the irradiance (design.md, section 7), or whole
// irradiance records. Every result is a function of its point alone.
#pragma once

#include "geometry/hit.h"
#include "tracer/diffuse_rays.h"
#include "tracer/hemisphere_samples.h"
#include "tracer/indirect_light.h"

#include <span>
#include <vector>

namespace trace {

// A point of a surface whose hemisphere is asked for; camera space.
struct DiffusePoint {
    geo::Hit hit;
    base::V3f P, N, Ng; // unit normals on the side that is seen
    std::uint32_t seed = 0;
    MediumId medium = 0;
    IndirectSettings settings;
};

// Points that no record covered, while it is found out where records are needed.
using WantedPoints = std::vector<DiffusePoint>;

// The hemispheres of points: rays, and what they brought.
class HemisphereGather {
public:
    HemisphereGather(const DiffuseRays::Asker& asker) : asker_(asker) {}

    [[nodiscard]] base::Color mean(const DiffusePoint& point, std::uint32_t num_rays);
    // One result per point; num_rays each. Rays of many points are shaded together.
    void means(std::span<const DiffusePoint> points, std::uint32_t num_rays,
               std::span<base::Color> out);
    // With gradients; its radius is not set.
    [[nodiscard]] IrradianceRecord record(const DiffusePoint& point, float& harmonic_mean);

private:
    void add(const DiffusePoint& point, const HemisphereStrata& strata);
    DiffuseRays::Asker asker_;
    DiffuseRays rays_;
    std::vector<base::V3f> local_;
    std::vector<base::Color> radiance_;
    std::vector<float> distance_;
};

} // namespace trace
