// SPDX-License-Identifier: Apache-2.0
// Fills the irradiance cache before a frame is rendered. In: the frame, with an empty or seeded
// cache. Out: records wherever the picture's surfaces ask for indirect light. The whole frame is
// covered, from a coarse grid of pixels to a fine one: the points of one step are asked against the
// records of the steps before, their records are computed in parallel and inserted in the order of
// the grid. So the cache is the same for any thread count, bucket order and crop window
// (trace-021).
#pragma once

#include "tracer/execution.h"
#include "tracer/hemisphere_gather.h"
#include "tracer/pixel_range.h"

#include <functional>
#include <memory>
#include <vector>

namespace trace {

class Camera;
class ShadingClasses;

class IndirectPrepass {
public:
    struct Tools {
        const FrameContext& frame; // its `indirect` is `light`
        const Camera& camera;
        const ShadingClasses& classes;
        int num_threads = 0;
        std::function<bool()> wants_stop;
    };
    IndirectPrepass(const Tools& tools, IndirectLight& light);
    ~IndirectPrepass();

    // False: it was interrupted.
    bool run();
    // Of all threads.
    [[nodiscard]] Counters counters() const;

private:
    // Pixels of one step: every `spacing` pixels, beginning at an offset.
    struct Step {
        int spacing, x0, y0;
    };
    struct Worker; // what one thread works with
    [[nodiscard]] static std::vector<Step> steps();
    [[nodiscard]] Worker& worker(int slot);
    bool find_wanted(const Step& step, std::vector<WantedPoints>& wanted);
    bool compute(const WantedPoints& points, std::vector<IrradianceRecord>& records);
    void shade_row(const Step& step, int y, Worker& worker, WantedPoints& wanted) const;
    [[nodiscard]] IrradianceRecord make_record(const DiffusePoint& point, Worker& worker) const;

    Tools tools_;
    IndirectLight& light_;
    PixelRange pixels_;
    std::vector<std::unique_ptr<Worker>> workers_;
};

} // namespace trace
