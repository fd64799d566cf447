// SPDX-License-Identifier: Apache-2.0
// One frame from its scene to its files: shaders are loaded and bound, the world is built, buckets
// are rendered in parallel, the picture is exposed, run through the imager and written. The same
// bytes whatever the thread count.
#pragma once

#include "ribtools/scene.h"
#include "runtime/base/diag.h"
#include "runtime/shader.h"
#include "tracer/checkpoint.h"
#include "tracer/film.h"
#include "tracer/progress.h"
#include "tracer/run_record.h"
#include "tracer/special_mode.h"
#include "tracer/stats.h"

#include <string>
#include <utility>
#include <vector>

namespace base {
class ShadeopLibrary;
}

namespace trace {

class LiveDisplay;
class ShaderListing;
class Textures;

struct RenderSettings {
    int num_threads = 0; // 0: all
    ProgressMode progress = ProgressMode::None;
    // True once the user wants to stop; asked between buckets. May be null.
    bool (*interrupted)() = nullptr;
    // The file of a scene without Display; "" = nothing is written.
    std::string default_output;
    // --trace-pixel: what these pixels did is printed, and no picture is made.
    std::vector<std::pair<int, int>> trace_pixels;
    bool check_energy = false; // --check-energy: shaders are checked, and no picture is made
    SpecialMode specialise = SpecialMode::Auto;
    bool is_verbose = false;    // say what is being done
    bool keep_existing = false; // frames whose files are all there already are skipped (-safe)
    CheckpointSettings checkpoint;
    LiveDisplay* live = nullptr;              // shows frames while they render
    base::ShadeopLibrary* shadeops = nullptr; // functions of DSOs that shaders may call
};

// From good to bad.
enum class FrameResult { Done, Interrupted, Failed /* the environment: exit code 3 */ };

// Everything a frame is made with; all outlive the call.
struct FrameTools {
    rt::ShaderLibrary& library;
    rt::StringTable& strings;
    base::Diag& diag;
    Stats& stats;
    ShaderListing* listing = nullptr; // --profile-shaders
    Preview* preview = nullptr;       // a small picture of the first display, for reports
    Textures* textures = nullptr;     // the maps of the run; null: of this frame only
};

// The filtered picture, before exposure and imager; for tests and other users of the picture.
// Interrupted: the buckets that were finished.
FrameResult render_image(const rib::Scene& scene, const RenderSettings& settings,
                         const FrameTools& tools, Image& image);

// The same, then exposed, imaged and written to every display. Nothing appears under a final name
// unless complete.
FrameResult render_frame(const rib::Scene& scene, const RenderSettings& settings,
                         const FrameTools& tools);

} // namespace trace
