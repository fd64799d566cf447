// SPDX-License-Identifier: Apache-2.0
// The command line of render: argv in, RenderOptions or a usage message out. Rows of options.def
// drive parsing and help. Precedence (bmrt.md): -res and -samples give way to the RIB; -crop, -o,
// -frames and -shaders override it.
#pragma once

#include "tracer/checkpoint.h"
#include "tracer/live_display.h"
#include "tracer/progress.h"
#include "tracer/special_mode.h"

#include <array>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace trace {

struct RenderOptions {
    int num_threads = 0;
    std::optional<std::pair<int, int>> res, samples;
    struct Variance {
        float variance;
        int least, most;
    };
    std::optional<Variance> variance; // -var
    std::optional<std::array<float, 4>> crop;
    std::vector<std::pair<int, int>> frames; // ranges, first to last; empty: all
    std::string output;                      // "" = as the RIB says
    std::vector<std::string> shader_path;
    std::vector<std::string> shadeop_path; // directories of DSOs
    std::vector<std::string> rib_texts;    // -option
    std::vector<std::string> files;        // "-" is standard input
    std::string stats_json, report, profile_shaders;
    std::vector<std::pair<int, int>> trace_pixels;
    CheckpointSettings checkpoint;
    ProgressMode progress = ProgressMode::Auto;
    SpecialMode specialise = SpecialMode::Auto;
    bool show = false;                  // -d
    int show_every = 1;                 // every Nth line of buckets first
    std::optional<LiveServers> servers; // --display-server
    bool silent = false, safe = false, verbose = false;
    bool stats = false, allow_programs = false, strict = false;
    bool check_energy = false;
    bool merge = false; // `files` are tiles
    bool help = false, version = false;
    std::vector<std::string> not_yet; // accepted switches of later issues, as typed
};

struct ParsedOptions {
    RenderOptions options;
    std::string error; // not empty: wrong usage
};
[[nodiscard]] ParsedOptions parse_options(std::span<const char* const> arguments);

[[nodiscard]] std::string usage_text(const std::string& program);

[[nodiscard]] bool wants_frame(const RenderOptions& options, int frame);
// Runs of '#' become the frame number, padded with zeros to their length.
[[nodiscard]] std::string frame_file_name(const std::string& pattern, int frame);

} // namespace trace
