// SPDX-License-Identifier: Apache-2.0
// From the filtered picture to those the displays show: exposure, then the imager (ri.md 9). In:
// the film's image. Out: per display, an image whose planes are exposed, imaged, and made with the
// display's filter; the extra channels are as they were. Displays that ask for the same share one.
#pragma once

#include "tracer/execution.h"
#include "tracer/film.h"
#include "tracer/outputs.h"

#include <span>

namespace trace {

struct ShaderEntry;

class Developer {
public:
    // imager: may be null. The filtered image is taken, and outlives what developed() gives.
    Developer(const FrameContext& frame, const ShaderEntry* imager, int num_threads,
              Counters& counters, std::span<const DisplayPlan> plans, Image&& filtered);

    // For one of the plans. Valid until the next call.
    [[nodiscard]] const Image& developed(const DisplayPlan& plan);

private:
    void choose_planes(int picture);

    const FrameContext frame_;
    const ShaderEntry* imager_;
    int num_threads_;
    Counters& counters_;
    Image picture_;                    // handed out
    decltype(Image::planes) filtered_; // the film's; empty if all plans share one picture
    Exposure exposure_;
    int source_ = -1; // DisplayPlan::picture
    bool is_developed_ = false;
};

} // namespace trace
