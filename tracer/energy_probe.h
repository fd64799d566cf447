// SPDX-License-Identifier: Apache-2.0
// One point of a surface, seen from many directions under light that is known: for checks of
// shaders. In: a surface shader's instance, a hit, directions to the eye. Out: what the shader
// returns. Lights of the scene, what its rays meet and its ambient light are replaced; maps,
// messages and everything else are those of the scene.
#pragma once

#include "geometry/world.h"
#include "runtime/base/vec.h"
#include "runtime/batch.h"

#include <cstdint>
#include <span>

namespace trace {

struct FrameContext;
struct ShaderEntry;
struct ThreadState;

// What the shader is lit by.
struct ProbeLight {
    bool has_light = false; // one, from far away: Cl = 1
    base::V3f to_light;     // unit
    float ambient = 0;      // ambient()
    float surroundings = 0; // trace() and its relatives; environments that trace
};

class EnergyProbe {
public:
    static constexpr std::size_t max_views = SL_BATCH_MAX;

    EnergyProbe(const FrameContext& frame, ThreadState& thread) : frame_(frame), thread_(thread) {}

    struct Place {
        const ShaderEntry& shader;
        const geo::Hit& hit;
        float footprint; // distance between shading samples there
    };
    struct View {
        base::V3f to_eye; // unit
        std::uint32_t seed = 0;
    };
    struct Response {
        base::Color Ci, Oi; // Oi within 0 .. 1; both 0 where the shader gave no numbers
    };
    // At most max_views.
    void shade(const Place& place, const ProbeLight& light, std::span<const View> views,
               std::span<Response> out);
    // Side that N points to, at the hit.
    [[nodiscard]] base::V3f normal(const geo::Hit& hit) const;

private:
    void fill(const Place& place, std::span<const View> views, std::span<const geo::Hit> hits);

    const FrameContext& frame_;
    ThreadState& thread_;
    rt::ShadeBatch batch_;
};

} // namespace trace
