// SPDX-License-Identifier: Apache-2.0
// One batch of hits on its way through the shaders: everything that belongs to it, so that it may
// wait for rays while others are shaded. A ShadeJobs is one thread's supply of them; what a job
// holds is only valid between take() and give(). Memory only grows, bounded by how many batches may
// wait at once (HitShader::max_waiting per ray level).
#pragma once

#include "tracer/displaced_batch.h"
#include "tracer/execution.h"
#include "tracer/shading_classes.h"

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace trace {

// Where the deepest ray of a tree that met nothing began, and its direction (fulltrace()).
struct DeepestMiss {
    int level = 0; // 0: none missed
    float origin[3] = {}, direction[3] = {};
};

// Planes of one variable that only displays ask for.
struct alignas(64) ShownPlanes {
    std::array<float, 3 * SL_BATCH_MAX> values;
};

struct ShadeJob {
    static constexpr std::size_t size = SL_BATCH_MAX;

    // What is shaded.
    std::uint32_t shading_class = 0;        // no_id: only a volume, behind which there is nothing
    std::span<const std::uint32_t> members; // hits of the call
    std::span<const geo::Hit> hits;         // the same
    const ShaderEntry* volume_shader =
        nullptr; // between here and where the rays come from; or none
    bool is_displaced = false;
    bool has_rays = false;

    // The rays, by point.
    std::array<geo::Hit, size> own_hits;
    alignas(64) std::array<float, size> ox, oy, oz, dx, dy, dz, footprint, widening, spread, length;
    std::array<std::uint32_t, size> seeds, media, samples;
    std::array<sl_string, size> labels;
    std::vector<DeepestMiss> misses; // of the rays that points asked for; empty: none missed

    // The shaders. Batches are kept by role, so that a volume sees the surface it follows.
    BatchSubject subject;
    rt::ShadeBatch displacement, surface, volume;
    std::optional<Execution> surface_execution;
    DisplacedBatch displaced;

    // Results, planes of `stride`.
    sl_points planes{}; // of the surface
    float *Ci = nullptr, *Oi = nullptr;
    std::uint32_t stride = 0;
    alignas(64) std::array<float, 3 * size> own_Ci, own_Oi; // where the shader has none
    alignas(64) std::array<float, 3 * size> P_u, P_v;       // for lights
    std::vector<ShownPlanes> shown_planes;

    [[nodiscard]] std::uint32_t count() const { return static_cast<std::uint32_t>(members.size()); }
    [[nodiscard]] geo::Incident incident() const;
};

class ShadeJobs {
public:
    // A job that nobody uses: the one that was given back last, whose memory is warm.
    [[nodiscard]] ShadeJob& take();
    void give(ShadeJob& job);
    [[nodiscard]] std::size_t size() const { return all_.size(); }

private:
    std::vector<std::unique_ptr<ShadeJob>> all_;
    std::vector<ShadeJob*> free_;
};

} // namespace trace
