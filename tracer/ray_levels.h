// SPDX-License-Identifier: Apache-2.0
// Who shades what rays of shaders meet. While hits of one ray level are shaded, their rays need a
// HitShader of their own, and so on down: one of each per nesting of calls, made on first use, kept
// by the thread. Batches that wait are answered by answer(); functions that run inside a shader (a
// light, shadow(), occlusion()) take a DeeperShader.
#pragma once

#include "tracer/hit_shader.h"
#include "tracer/light_run.h"
#include "tracer/ray_layers.h"
#include "tracer/ray_wave.h"

#include <memory>
#include <span>
#include <vector>

namespace trace {

class RayLevels {
public:
    RayLevels(const FrameContext& frame, const Camera& camera, const ShadingClasses& classes,
              const VisibilityOptions& visibility, ThreadState& thread);
    ~RayLevels();

    // Answers all that the suspended packets of these batches ask.
    void answer(std::span<ShadeJob* const> waiting);

    [[nodiscard]] Media& media() { return media_; }
    [[nodiscard]] const Media& media() const { return media_; }
    [[nodiscard]] const RayOptions& options() const { return options_; }

private:
    friend class DeeperShader;
    struct Level {
        Level(RayLevels& all);
        HitShader shader;
        RayLayers layers;
        RayWave wave;
        std::unique_ptr<LightScratch> lights; // while a shader above runs
    };
    [[nodiscard]] Level& enter();
    void leave() { --depth_; }

    const FrameContext& frame_;
    const Camera& camera_;
    const ShadingClasses& classes_;
    VisibilityOptions visibility_;
    ThreadState& thread_;
    RayOptions options_;
    Media media_;
    std::vector<std::unique_ptr<Level>> levels_;
    std::size_t depth_ = 0; // of them in use
};

// The shader for rays asked for by a shader that runs now. While it lives, lights run in memory of
// its own: the light that asks may be one of those that the hits need.
class DeeperShader {
public:
    explicit DeeperShader(ThreadState& thread);
    ~DeeperShader();
    DeeperShader(const DeeperShader&) = delete;
    DeeperShader& operator=(const DeeperShader&) = delete;

    // Colours of the surfaces that hits lie on, one by one.
    [[nodiscard]] HitShader& hits() const { return level_.shader; }
    // Colours from along rays, through all that is not opaque.
    [[nodiscard]] RayLayers& rays() const { return level_.layers; }
    // Answers to queries.
    [[nodiscard]] RayWave& wave() const { return level_.wave; }

private:
    ThreadState& thread_;
    RayLevels::Level& level_;
    std::vector<std::uint32_t> traced_; // --trace-pixel: samples of the batch that asks
};

} // namespace trace
