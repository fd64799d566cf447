// SPDX-License-Identifier: Apache-2.0
// A small picture of a finished one, for reports: averaged down, eight bits, as PNG in memory.
#pragma once

#include "tracer/film.h"
#include "tracer/outputs.h"
#include "tracer/run_record.h"

namespace trace {

constexpr int max_preview_px = 480; // on the longer side

// The image is exposed and imaged. Shows what the display's file shows: its levels where the
// display quantises, else (a display of floats) the values encoded as sRGB; transparent only where
// the mode has alpha.
[[nodiscard]] Preview make_preview(const Image& image, const DisplayPlan& plan);

} // namespace trace
