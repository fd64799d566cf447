// SPDX-License-Identifier: Apache-2.0
// One bucket: camera rays of its samples in, composited samples out (ri.md 9.1). One per thread.
// Where samples of one pixel have a say about others (adaptive sampling, shading reuse) whole tiles
// of the frame are sampled.
#pragma once

#include "tracer/adaptive.h"
#include "tracer/camera.h"
#include "tracer/film.h"
#include "tracer/hit_shader.h"
#include "tracer/ray_layers.h"
#include "tracer/sampler.h"
#include "tracer/shading_reuse.h"

#include <array>
#include <cstdint>
#include <vector>

namespace trace {

class BucketRenderer {
public:
    BucketRenderer(const FrameContext& frame, const Camera& camera, const Sampler& sampler,
                   const ShadingClasses& classes, const OutputBindings* outputs,
                   const VisibilityOptions& options);

    // Renders a bucket and hands its samples to the film; false: it was interrupted in a shader.
    [[nodiscard]] bool render(std::size_t bucket, Film& film);

    [[nodiscard]] ThreadState& thread() { return thread_; }

private:
    [[nodiscard]] SampleBuffer render_fixed(std::size_t bucket, Film& film);
    [[nodiscard]] SampleBuffer render_adaptive(std::size_t bucket, Film& film);
    // The samples of block_, in its order.
    void run_pass(SampleBuffer& samples);
    void clear(SampleBuffer& samples) const;
    // Outputs that show the finished sample.
    void fill_sample_channels(SampleBuffer& samples) const;

    const Camera& camera_;
    const Sampler& sampler_;
    const OutputBindings* outputs_; // null: none
    ThreadState thread_;
    HitShader shader_;
    Adaptive adaptive_;
    ShadingReuse reuse_;
    RayLayers layers_;

    SampleBlock block_;
    std::vector<geo::RayPacket> camera_packets_; // as shaders see the rays
    std::array<SampleBuffer, 2> passes_;         // samples that are not the film's yet
    std::vector<std::uint16_t> counts_;          // of samples, by pixel of the bucket
    std::vector<PixelSamples> more_;
};

} // namespace trace
