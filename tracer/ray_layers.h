// SPDX-License-Identifier: Apache-2.0
// Rays through all surfaces they see: hits, shades, samples composited front to back. In: rays of
// one kind, camera's or others'. Out: one Sample per ray. Rays go on behind what is not opaque; all
// rays that reached the same layer are traced and shaded together (trace-002).
#pragma once

#include "tracer/hit_shader.h"
#include "tracer/shading_reuse.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace trace {

struct VisibilityOptions {
    std::array<float, 3>
        opaque_from; // Option "limits" "othreshold": nothing behind matters from there on
    std::array<float, 3> depth_from; // "zthreshold": opacity that counts for depth
};
[[nodiscard]] VisibilityOptions visibility_options(const rib::Options& options);

// Surfaces that rays do not meet, besides those their visibility says. Null: no such wish.
struct RayFilter {
    sl_string subset = nullptr; // groups, one of which the surface must be a member of
    sl_string sides = nullptr;  // "front", "back"
    [[nodiscard]] bool is_empty() const { return subset == nullptr && sides == nullptr; }
    friend bool operator==(const RayFilter&, const RayFilter&) = default;
};

struct RayBundle {
    std::uint32_t count = 0;
    std::span<const geo::RayPacket> packets; // ray i is lane i % 8 of packet i / 8
    std::span<const std::uint32_t> seeds;    // by ray, as the rest
    int level = 0;
    int kind = SL_RAY_camera;
    int diffuse_level = 0;
    std::span<const RayCone> cones = {};
    std::span<const MediumId> media = {}; // where the rays start; empty: where cameras are
    std::span<const sl_string> labels = {};
    std::span<const std::uint32_t> samples = {}; // of the bucket; empty: the ray's number
    RayFilter filter = {};
};

struct RayResults {
    std::span<Sample> samples;          // uncovered when given
    std::span<float> extra;             // outputs
    std::span<geo::Hit> first = {};     // what was met first; 8 per packet
    std::span<DeepestMiss> misses = {}; // of the trees of rays that begin with these
};

class RayLayers : private ShadeObserver {
public:
    // The shader and the rest outlive it. outputs: nullptr: none. reuse: shares the shades of hits
    // among them; nullptr: nobody does.
    RayLayers(const FrameContext& frame, const ShadingClasses& classes,
              const OutputBindings* outputs, const VisibilityOptions& options, HitShader& shader,
              ThreadState& thread, ShadingReuse* reuse = nullptr);

    // observer: told of the batches of all layers; nullptr: nobody. Returns the number of layers.
    std::uint32_t trace(const RayBundle& rays, const RayResults& results,
                        ShadeObserver* observer = nullptr);

    // The nearest surfaces only, 8 hits per packet.
    void intersect(const RayBundle& rays, std::span<geo::Hit> hits);

    // Ray and layer of a batch's member, while an observer is told.
    [[nodiscard]] std::uint32_t ray_of(std::uint32_t member) const {
        return layer_ == 0 ? member : behind_[member].ray;
    }
    [[nodiscard]] std::uint32_t layer() const { return layer_; }

private:
    // A ray that goes on behind what it met.
    struct Behind {
        std::uint32_t ray;
        float t;      // so far, from the ray's origin
        geo::Hit hit; // where it left off
        MediumId medium;
        std::array<float, 3> transmitted;
    };
    void starting(ShadeJob& job) override { observer_->starting(job); }
    [[nodiscard]] bool sends() const override { return observer_ != nullptr && observer_->sends(); }
    void finished(ShadeJob& job) override;
    void trace_first();
    void trace_behind();
    void make_behind(geo::RayPacket& to, std::size_t lane, const Behind& from) const;
    void tell_rays(std::span<const geo::RayPacket> packets, std::size_t count) const;
    void skip_filtered(std::span<const geo::RayPacket> packets, std::span<geo::Hit> hits);
    [[nodiscard]] bool passes(const geo::Hit& hit, const base::V3f& direction) const;
    [[nodiscard]] ShadingRays shading_rays() const;
    void note_misses();
    void note_miss(std::uint32_t ray, const base::V3f& origin, const base::V3f& direction,
                   int level);
    void tell_layer() const;
    void shade(std::span<const geo::Hit> hits, std::span<Sample> out, std::span<float> out_extra);
    void composite_first();
    void composite_behind();
    void cross_surfaces();
    // Adds a shade to a sample; true if something behind it still shows.
    bool composite(Sample& sample, std::array<float, 3>& transmitted, const geo::Hit& hit,
                   const Sample& shade, float z_hit) const;
    // The same for outputs. is_front: the surface is the first that counts for depth. The first
    // surface's values stand in the sample already.
    void composite_first_outputs(float* sample, bool is_matte, bool is_front) const;
    void composite_outputs(float* sample, const float* shade,
                           const std::array<float, 3>& transmitted, bool is_front) const;
    [[nodiscard]] bool is_matte(const geo::Hit& hit) const;
    [[nodiscard]] bool is_opaque(const Sample& shade) const;
    [[nodiscard]] base::V3f direction_of(std::uint32_t ray) const;
    [[nodiscard]] std::uint32_t sample_of(std::uint32_t ray) const {
        return rays_.samples.empty() ? ray : rays_.samples[ray];
    }

    const FrameContext& frame_;
    const ShadingClasses& classes_;
    const OutputBindings* outputs_; // null: none
    VisibilityOptions options_;
    bool opaque_counts_for_depth_; // a zthreshold above 1 is never reached
    HitShader& shader_;
    ShadingReuse* reuse_;
    ThreadState& thread_;

    RayBundle rays_; // of the call in work
    RayResults results_;
    ShadeObserver* observer_ = nullptr;
    std::vector<geo::RayPacket> packets_; // restarted rays of the layer in work
    std::vector<geo::Hit> hits_;
    std::vector<Sample> shades_;      // of restarted rays
    std::vector<float> shades_extra_; // their outputs
    std::vector<Behind> behind_, next_;
    std::vector<std::uint32_t> behind_rays_;
    std::vector<MediumId> behind_media_;
    std::vector<float> behind_t_, behind_since_;
    std::uint32_t layer_ = 0;
};

} // namespace trace
