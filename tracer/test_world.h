// SPDX-License-Identifier: Apache-2.0
// For tests: a world of square sheets z = const and shaders written by hand, so that shading,
// lights and visibility can be tested against closed forms without geometry, compiler or files.
#pragma once

#include "geometry/world.h"
#include "runtime/shader.h"

#include <map>
#include <string>
#include <vector>

namespace trace::test {

struct Sheet {
    float z = 1;
    std::uint32_t attributes = 0;
    float half_width = 1e6f; // |x|, |y| up to here
    float side = -1;         // N and Ng point along it, in z
    std::map<std::string, rib::Param> variables;
    base::Mat4 camera_from_object;
};

class SheetWorld : public geo::World {
public:
    SheetWorld(const rib::Scene& scene, std::vector<Sheet> sheets)
        : scene_(scene), sheets_(std::move(sheets)) {}

    void intersect(const geo::RayPacket& rays, geo::Hit* hits) const override;
    void intersect(std::span<const geo::RayPacket> packets, geo::Hit* hits) const override;
    std::uint32_t occluded(const geo::RayPacket& rays) const override;
    geo::Binding binding(const geo::Hit& hit) const override;
    void fill(std::span<const geo::Hit> hits, const geo::Incident& incident, std::uint64_t needed,
              std::uint32_t stride, const sl_points& out, const sl_points* aux_u,
              const sl_points* aux_v) const override;
    const rib::Param* primitive_variable(const geo::Hit& hit, std::string_view name) const override;
    // varying variables: their value times the x of the hit
    void fill_primitive_variable(std::span<const geo::Hit> hits, std::string_view name,
                                 std::uint32_t stride, float* out) const override;
    void fill_primitive_differences(std::span<const geo::Hit> hits, std::string_view name,
                                    const geo::AuxiliaryPlanes& planes) const override;
    base::V3f spawn_origin(const geo::Hit& hit, const base::V3f& direction) const override;
    base::Mat4 camera_from_object(const geo::Hit& hit, float time) const override;
    const geo::Stats& stats() const override { return stats_; }

private:
    [[nodiscard]] geo::Hit closest(const geo::RayPacket& rays, int lane) const;
    const rib::Scene& scene_;
    std::vector<Sheet> sheets_;
    geo::Stats stats_;
};

// Adds the hand-written shaders to a library: surfaces flat (Ci = Os Cs), lit (Ci = ambient() +
// diffuse(N) with N towards the eye, output `lightcount`), tint (uniform color tint, varying float
// scale: Ci = tint scale), unset, bad (not a number), spaces (Ci = transform("object", P)), lights
// ambient, point, distant, cone, volume haze, imager invert.
void adopt_test_shaders(rt::ShaderLibrary& library);
// Those that trace: surfaces mirror, glass, probe, gathering, volume absorb, light tracing_light.
void adopt_test_ray_shaders(rt::ShaderLibrary& library);

} // namespace trace::test
