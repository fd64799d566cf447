// SPDX-License-Identifier: Apache-2.0
// Shades the hits of rays: hits in, colour and opacity out, in the order of the hits. Hits are
// grouped by shading class, groups are cut into batches, batches run displacement, surface and
// volume shaders (sl.md 5.1). Batches whose shaders wait for rays are kept (shade_job.h); all they
// ask is answered together, by the HitShader of the next ray level, and they go on (ray_wave.h).
// One per thread and level; holds all scratch, so that nothing is allocated per ray. What a point
// gets does not depend on the batch it falls into.
#pragma once

#include "geometry/world.h"
#include "tracer/camera.h"
#include "tracer/film.h"
#include "tracer/media.h"
#include "tracer/output_bindings.h"
#include "tracer/ray_cone.h"
#include "tracer/sampler.h"
#include "tracer/shade_job.h"
#include "tracer/shading_classes.h"

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

namespace trace {

// One ray per hit, in the same order. Empty spans: the defaults named.
struct ShadingRays {
    // Ray of hit i is lane ray[i] % 8 of packet ray[i] / 8; empty: ray i. These are the rays as the
    // shaders see them (I, E): whole, even where tracing restarted behind a surface.
    std::span<const geo::RayPacket> packets;
    std::span<const std::uint32_t> ray;
    std::span<const std::uint32_t> seed; // by ray
    // Distance of hit i along that ray; empty: the hit's own t.
    std::span<const float> t;
    std::uint32_t layer = 0; // surfaces met before on these rays

    int level = 0;                        // 0: camera
    int kind = SL_RAY_camera;             // SL_RAY_*
    int diffuse_level = 0;                // diffuse rays among those that led here, these included
    std::span<const RayCone> cones = {};  // by ray, unit directions; empty: the camera's
    std::span<const MediumId> media = {}; // by hit: what lies before it; empty: where cameras are
    std::span<const float> since = {};    // by hit: where on the ray that began; empty: at 0
    std::span<const sl_string> labels = {};      // by ray; empty: none
    std::span<const std::uint32_t> samples = {}; // by ray: of the bucket; empty: the ray's number
};

// Told of every batch when it is done, while its values are still there.
class ShadeObserver {
public:
    virtual ~ShadeObserver() = default;
    // The surface's parameters are bound, its shader has not run. Only if sends().
    virtual void starting(ShadeJob& /*job*/) {}
    [[nodiscard]] virtual bool sends() const { return false; }
    virtual void finished(ShadeJob& job) = 0;
};

class HitShader {
public:
    // Batches that may wait at once, on one level.
    static constexpr std::size_t max_waiting = 64;

    // outputs: what displays show besides colour and opacity; nullptr: nothing.
    HitShader(const FrameContext& frame, const Camera& camera, const ShadingClasses& classes,
              const OutputBindings* outputs, ThreadState& thread);

    // Sets colour and opacity, clamped to 0..1, of out[i] where hits[i] is valid, and of outputs
    // the channels from out_extra[i * num_channels] on. Where a ray that met nothing ends inside a
    // volume that shows, that too. Must not be called while it works: see RayLevels.
    void shade(const ShadingRays& rays, std::span<const geo::Hit> hits, std::span<Sample> out,
               std::span<float> out_extra, ShadeObserver* observer = nullptr);

private:
    // Variables that come from the geometry; the rest of a shader's needs is filled here.
    static constexpr std::uint64_t geometry_variables =
        1ULL << SL_VAR_P | 1ULL << SL_VAR_N | 1ULL << SL_VAR_Ng | 1ULL << SL_VAR_I |
        1ULL << SL_VAR_E | 1ULL << SL_VAR_dPdu | 1ULL << SL_VAR_dPdv | 1ULL << SL_VAR_u |
        1ULL << SL_VAR_v | 1ULL << SL_VAR_du | 1ULL << SL_VAR_dv | 1ULL << SL_VAR_s |
        1ULL << SL_VAR_t | 1ULL << SL_VAR_Cs | 1ULL << SL_VAR_Os | 1ULL << SL_VAR_time |
        1ULL << SL_VAR_dPdtime;

    // Hits that may share a batch.
    struct Group {
        std::uint32_t shading_class; // no_id: misses
        std::uint32_t attributes;    // of the first hit
        MediumId medium;             // before it
        std::uint32_t begin = 0, count = 0;
    };
    struct Key {
        std::uint32_t shading_class, a, b;
        MediumId medium;
        friend bool operator==(const Key&, const Key&) = default;
    };
    struct KeyHash {
        std::size_t operator()(const Key& key) const;
    };

    // --- hit_groups.cpp
    void group_hits(std::span<const geo::Hit> hits);
    [[nodiscard]] std::uint32_t group_of(std::uint32_t hit);
    [[nodiscard]] std::uint32_t group_of_miss(std::uint32_t hit);
    [[nodiscard]] std::uint32_t keyed_group(const Key& key, std::uint32_t attributes);
    std::uint32_t new_group(std::uint32_t shading_class, std::uint32_t attributes, MediumId medium);
    void list_members();

    // --- one batch
    void shade_group(const Group& group);
    void shade_batch(const Group& group, std::span<const std::uint32_t> members);
    void shade_misses(const Group& group, std::span<const std::uint32_t> members);
    // What the volume before a group is; null: none.
    [[nodiscard]] const ShaderEntry* volume_of(const Group& group) const;
    [[nodiscard]] std::uint64_t shown_variables(std::uint32_t shading_class) const {
        return outputs_ != nullptr ? outputs_->variables(shading_class) : 0;
    }
    [[nodiscard]] bool needs_seeds(const ShadeJob& job) const;
    void begin(ShadeJob& job, const Group& group, std::span<const std::uint32_t> members) const;
    void finish(ShadeJob& job);
    void finish_waiting();
    void gather(ShadeJob& job, NeededVariables needed) const;
    void gather_hits(ShadeJob& job) const;
    void gather_footprint(ShadeJob& job, std::size_t i) const;
    void gather_origins(ShadeJob& job) const;
    void prepare_surface(ShadeJob& job);
    // Where the differences at the auxiliary points go.
    struct AuxPlanes {
        sl_points u{}, v{};
        bool wanted = false;
        [[nodiscard]] const sl_points* at_u() const { return wanted ? &u : nullptr; }
        [[nodiscard]] const sl_points* at_v() const { return wanted ? &v : nullptr; }
    };
    [[nodiscard]] static AuxPlanes aux_planes(const ShadingClass& c, ShadeJob& job);
    void fill_own_variables(rt::ShadeBatch& batch) const;
    void fill_seeds(const ShadeJob& job, rt::ShadeBatch& batch) const;
    // Packets that wait afterwards.
    std::uint32_t run(ShadeJob& job, rt::ShadeBatch& batch, Execution& execution);
    void count_run(rt::ShadeBatch& batch, const Execution& execution);

    // --- hit_displacement.cpp
    [[nodiscard]] NeededVariables needed_after(const ShadeJob& job) const;
    [[nodiscard]] bool is_displaced(const ShadeJob& job, NeededVariables after) const;
    void run_displacement(ShadeJob& job, NeededVariables after);
    // The displaced values in place of those of the geometry.
    void displace(const ShadeJob& job, const sl_points& main, const sl_points* aux_u,
                  const sl_points* aux_v) const;

    // --- hit_volume.cpp
    void run_volume(ShadeJob& job);
    void begin_segment(const ShadeJob& job, rt::ShadeBatch& batch) const;
    void finish_misses(ShadeJob& job);
    [[nodiscard]] float far_end(std::uint32_t ray) const;

    // --- results: hit_results.cpp
    // False if some result is no number.
    [[nodiscard]] bool scatter(const ShadeJob& job);
    void drop_bad_surface(ShadeJob& job);
    void blacken_bad(const ShadeJob& job, const ShaderEntry& shader);
    // What displays show: hit_outputs.cpp.
    static void add_shown_planes(ShadeJob& job, std::uint64_t variables);
    void scatter_outputs(ShadeJob& job);

    // Primitive variables in place of parameters: hit_overrides.cpp.
    // Uniform parameters take one value per batch: brings members from `begin` on with the value of
    // the first to the front and returns where they end.
    [[nodiscard]] std::size_t equal_values(const ShadingClass& c, std::span<std::uint32_t> members,
                                           std::size_t begin);
    void bind_overrides(const ShadeJob& job, Stage stage, rt::ShadeBatch& batch);
    [[nodiscard]] const rib::Param* overriding(const ShadingClass& c, const ParamOverride& o,
                                               const geo::Hit& hit) const;

    [[nodiscard]] const ShadingClass& class_of(const ShadeJob& job) const {
        return classes_[job.shading_class];
    }
    [[nodiscard]] std::uint32_t ray_of(std::uint32_t hit) const {
        return rays_.ray.empty() ? hit : rays_.ray[hit];
    }
    // Along the ray of a point, in units of its direction.
    [[nodiscard]] float distance_of(const ShadeJob& job, std::size_t point) const {
        return rays_.t.empty() ? job.hits[point].t : rays_.t[job.members[point]];
    }
    [[nodiscard]] MediumId medium_of(std::uint32_t hit) const {
        return rays_.media.empty() ? 0 : rays_.media[hit];
    }

    const FrameContext& frame_;
    const Camera& camera_;
    const ShadingClasses& classes_;
    const OutputBindings* outputs_;
    ThreadState& thread_;

    ShadingRays rays_; // of the call in work
    std::span<const geo::Hit> hits_;
    std::span<Sample> out_;
    std::span<float> out_extra_;
    ShadeObserver* observer_ = nullptr;
    std::vector<Group> groups_;
    std::vector<std::uint32_t> group_of_class_; // no_id: none yet
    std::unordered_map<Key, std::uint32_t, KeyHash> group_of_key_;
    std::vector<std::uint32_t> group_of_hit_, members_;
    std::vector<ShadeJob*> waiting_;
    std::vector<float> values_;
};

} // namespace trace
