// SPDX-License-Identifier: Apache-2.0
// Imager shaders: run on every pixel of the finished, exposed picture, covered or not
// (sl.md 3.5, 5.7; ri.md 9).
#pragma once

#include "tracer/execution.h"
#include "tracer/film.h"

namespace trace {

struct ShaderEntry;

// Changes colour, opacity and alpha of the picture in place; depth and extra channels stay. What is
// no number becomes 0. prints: printf is heard.
void run_imager(const FrameContext& frame, const ShaderEntry& imager, Image& image, int num_threads,
                Counters& counters, bool prints = true);

} // namespace trace
