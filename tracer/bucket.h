// SPDX-License-Identifier: Apache-2.0
// The visibility loop of one bucket: camera rays, hits, shades, composited samples (ri.md 9.1). One
// per thread. Rays go on behind what is not opaque; all rays of a bucket that reached the same
// layer are traced and shaded together.
#pragma once

#include "tracer/camera.h"
#include "tracer/film.h"
#include "tracer/hit_shader.h"
#include "tracer/sampler.h"

#include <array>
#include <cstdint>
#include <vector>

namespace trace {

struct VisibilityOptions {
    std::array<float, 3>
        opaque_from; // Option "limits" "othreshold": nothing behind matters from there on
    std::array<float, 3> depth_from; // "zthreshold": opacity that counts for depth
};
[[nodiscard]] VisibilityOptions visibility_options(const rib::Options& options);

class BucketRenderer {
public:
    BucketRenderer(const FrameContext& frame, const Camera& camera, const Sampler& sampler,
                   const ShadingClasses& classes, const OutputBindings* outputs,
                   const VisibilityOptions& options);

    // Renders a bucket and hands its samples to the film; false: it was interrupted in a shader.
    [[nodiscard]] bool render(std::size_t bucket, Film& film);

    [[nodiscard]] ThreadState& thread() { return thread_; }

private:
    // A ray that goes on behind what it met.
    struct Behind {
        std::uint32_t ray; // sample of the block
        float t;           // so far, from the camera ray's origin
        geo::Hit hit;      // where it left off
        std::array<float, 3> transmitted;
    };
    void trace_camera_rays();
    void trace_behind();
    void tell_layer(const SampleBuffer& samples) const;
    void composite_first(SampleBuffer& samples);
    void composite_behind(SampleBuffer& samples);
    // Adds a shade to a sample; true if something behind it still shows.
    bool composite(Sample& sample, std::array<float, 3>& transmitted, const geo::Hit& hit,
                   const Sample& shade, float z_hit) const;
    // The same for outputs. is_front: the surface is the first that counts for depth. The first
    // surface's values stand in the sample already.
    void composite_first_outputs(float* sample, bool is_matte, bool is_front) const;
    void composite_outputs(float* sample, const float* shade,
                           const std::array<float, 3>& transmitted, bool is_front) const;
    // Outputs that show the finished sample.
    void fill_sample_channels(SampleBuffer& samples) const;
    [[nodiscard]] bool is_matte(const geo::Hit& hit) const;
    [[nodiscard]] bool is_opaque(const Sample& shade) const;

    const FrameContext& frame_;
    const Camera& camera_;
    const Sampler& sampler_;
    const ShadingClasses& classes_;
    const OutputBindings* outputs_; // null: none
    VisibilityOptions options_;
    bool opaque_counts_for_depth_; // a zthreshold above 1 is never reached
    ThreadState thread_;
    HitShader shader_;

    SampleBlock block_;
    std::vector<geo::RayPacket> camera_packets_; // as shaders see the rays
    std::vector<geo::RayPacket> packets_;        // restarted rays of the layer in work
    std::vector<geo::Hit> hits_;
    std::vector<Sample> shades_;      // of restarted rays
    std::vector<float> shades_extra_; // their outputs
    std::vector<Behind> behind_, next_;
    std::vector<std::uint32_t> behind_rays_;
    std::vector<float> behind_t_;
    std::uint32_t layer_ = 0;
};

} // namespace trace
