// SPDX-License-Identifier: Apache-2.0
// One bucket: camera rays of its samples in, composited samples out (ri.md 9.1). One per thread.
#pragma once

#include "tracer/camera.h"
#include "tracer/film.h"
#include "tracer/hit_shader.h"
#include "tracer/ray_layers.h"
#include "tracer/sampler.h"

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
    // Outputs that show the finished sample.
    void fill_sample_channels(SampleBuffer& samples) const;

    const Camera& camera_;
    const Sampler& sampler_;
    const OutputBindings* outputs_; // null: none
    ThreadState thread_;
    HitShader shader_;
    RayLayers layers_;

    SampleBlock block_;
    std::vector<geo::RayPacket> camera_packets_; // as shaders see the rays
};

} // namespace trace
