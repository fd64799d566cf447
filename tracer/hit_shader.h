// SPDX-License-Identifier: Apache-2.0
// Shades the hits of rays: hits in, colour and opacity out, in the order of the hits. Hits are
// grouped by shading class, groups are cut into batches, batches run displacement, surface and
// atmosphere shaders (sl.md 5.1). One per thread; holds all scratch, so that nothing is allocated
// per ray. What a point gets does not depend on the batch it falls into.
#pragma once

#include "geometry/world.h"
#include "tracer/camera.h"
#include "tracer/displaced_batch.h"
#include "tracer/execution.h"
#include "tracer/film.h"
#include "tracer/output_bindings.h"
#include "tracer/shading_classes.h"

#include <array>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

namespace trace {

// One ray per hit, in the same order.
struct ShadingRays {
    // Ray of hit i is lane ray[i] % 8 of packet ray[i] / 8; an empty span means ray i. These are
    // the rays as the shaders see them (I, E): those of the camera even where tracing restarted
    // behind a surface.
    std::span<const geo::RayPacket> packets;
    std::span<const std::uint32_t> ray;
    std::span<const std::uint32_t> seed; // by ray
    // Distance of hit i along that ray; empty: the hit's own t.
    std::span<const float> t;
    std::uint32_t layer = 0; // surfaces met before on these rays
};

class HitShader {
public:
    // outputs: what displays show besides colour and opacity; nullptr: nothing.
    HitShader(const FrameContext& frame, const Camera& camera, const ShadingClasses& classes,
              const OutputBindings* outputs, ThreadState& thread);

    // Sets colour and opacity, clamped to 0..1, of out[i] where hits[i] is valid, and of outputs
    // the channels from out_extra[i * num_channels] on.
    void shade(const ShadingRays& rays, std::span<const geo::Hit> hits, std::span<Sample> out,
               std::span<float> out_extra);

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
        std::uint32_t shading_class;
        std::uint32_t attributes; // of the first hit
        std::uint32_t begin = 0, count = 0;
    };
    struct Key {
        std::uint32_t shading_class, a, b;
        friend bool operator==(const Key&, const Key&) = default;
    };
    struct KeyHash {
        std::size_t operator()(const Key& key) const;
    };
    // Gathered inputs and results of the batch in work.
    struct Batch {
        static constexpr std::size_t size = SL_BATCH_MAX;
        std::array<geo::Hit, size> hits;
        alignas(64) std::array<float, size> ox, oy, oz, dx, dy, dz, footprint;
        alignas(64) std::array<float, 3 * size> Ci, Oi;   // planes of stride_
        alignas(64) std::array<float, 3 * size> P_u, P_v; // for lights
    };

    void group_hits(std::span<const geo::Hit> hits);
    [[nodiscard]] std::uint32_t group_of(const geo::Hit& hit);
    [[nodiscard]] std::uint32_t keyed_group(const geo::Hit& hit, const geo::Binding& binding,
                                            std::uint32_t shading_class);
    std::uint32_t new_group(std::uint32_t shading_class, std::uint32_t attributes);

    void shade_group(const Group& group);
    [[nodiscard]] std::uint64_t shown_variables(std::uint32_t shading_class) const {
        return outputs_ != nullptr ? outputs_->variables(shading_class) : 0;
    }
    void shade_batch(const Group& group, std::span<const std::uint32_t> members);
    // False if nothing depends on the rays: then they are not gathered.
    bool gather(const ShadingClass& c, NeededVariables needed,
                std::span<const std::uint32_t> members);
    void gather_hits(const ShadingClass& c, std::span<const std::uint32_t> members);
    // Returns the planes of the variables, those of `shown` among them.
    sl_points run_surface(const ShadingClass& c, std::uint64_t shown, Execution& execution,
                          BatchSubject& subject, std::span<const std::uint32_t> members);
    // Where the differences at the auxiliary points go.
    struct AuxPlanes {
        sl_points u{}, v{};
        bool wanted = false;
        [[nodiscard]] const sl_points* at_u() const { return wanted ? &u : nullptr; }
        [[nodiscard]] const sl_points* at_v() const { return wanted ? &v : nullptr; }
    };
    [[nodiscard]] AuxPlanes aux_planes(const ShadingClass& c, const rt::ShadeBatch& batch);
    void run_atmosphere(const ShadingClass& c, BatchSubject& subject,
                        std::span<const std::uint32_t> members);
    // hit_displacement.cpp
    [[nodiscard]] NeededVariables needed_after(const Group& group) const;
    [[nodiscard]] bool is_displaced(const Group& group, NeededVariables after) const;
    void run_displacement(const ShadingClass& c, NeededVariables after, BatchSubject& subject,
                          std::span<const std::uint32_t> members);
    // The displaced values in place of those of the geometry.
    void displace(const sl_points& main, const sl_points* aux_u, const sl_points* aux_v,
                  std::uint32_t count) const {
        if (is_displaced_) {
            displaced_.apply(main, aux_u, aux_v, {incident(count), camera_.perspective()});
        }
    }
    [[nodiscard]] geo::Incident incident(std::uint32_t count) const;
    void fill_own_variables(rt::ShadeBatch& batch, std::uint32_t count) const;
    void fill_seeds(rt::ShadeBatch& batch, std::span<const std::uint32_t> members) const;
    void run(rt::ShadeBatch& batch, Execution& execution);
    // False if some result is no number.
    [[nodiscard]] bool scatter(std::span<const std::uint32_t> members);
    void drop_bad_surface(const ShaderEntry& shader, std::uint32_t count);
    void blacken_bad(std::span<const std::uint32_t> members, const ShaderEntry& shader);

    // What displays show: hit_outputs.cpp.
    void add_shown_planes(std::uint64_t variables, sl_points& planes);
    void scatter_outputs(std::uint32_t shading_class, const sl_points& planes,
                         std::span<const std::uint32_t> members, const ShaderEntry& shader);

    // Primitive variables in place of parameters: hit_overrides.cpp.
    // Uniform parameters take one value per batch: brings members from `begin` on with the value of
    // the first to the front and returns where they end.
    [[nodiscard]] std::size_t equal_values(const ShadingClass& c, std::span<std::uint32_t> members,
                                           std::size_t begin);
    void bind_overrides(const ShadingClass& c, Stage stage, rt::ShadeBatch& batch);
    [[nodiscard]] const rib::Param* overriding(const ShadingClass& c, const ParamOverride& o,
                                               const geo::Hit& hit) const;

    [[nodiscard]] std::uint32_t ray_of(std::uint32_t hit) const {
        return rays_.ray.empty() ? hit : rays_.ray[hit];
    }

    const FrameContext& frame_;
    const Camera& camera_;
    const ShadingClasses& classes_;
    const OutputBindings* outputs_;
    ThreadState& thread_;

    ShadingRays rays_;
    std::span<const geo::Hit> hits_;
    std::span<const geo::Hit> subject_hits_; // of the batch in work
    std::span<Sample> out_;
    std::span<float> out_extra_;
    std::vector<Group> groups_;
    std::vector<std::uint32_t> group_of_class_; // no_id: none yet
    std::unordered_map<Key, std::uint32_t, KeyHash> group_of_key_;
    std::vector<std::uint32_t> group_of_hit_, members_;
    Batch batch_;
    DisplacedBatch displaced_;
    bool is_displaced_ = false;           // the batch in work
    float *Ci_ = nullptr, *Oi_ = nullptr; // results of the batch in work, planes of stride_
    std::uint32_t stride_ = 0;
    std::vector<float> values_;
    // Planes of one variable that only displays ask for.
    struct alignas(64) ShownPlanes {
        std::array<float, 3 * Batch::size> values;
    };
    std::vector<ShownPlanes> shown_planes_;
};

} // namespace trace
