// SPDX-License-Identifier: Apache-2.0
// What a run did, for people and programs that ask afterwards: machine, command line, frames with
// their options and Stats, messages. Filled by the Renderer frame by frame; written as text
// (--stats, Option "statistics"), JSON (--stats-json) and HTML (--report). docs/statistics.md
// describes the fields.
#pragma once

#include "ribtools/scene.h"
#include "runtime/base/diag.h"
#include "tracer/stats.h"

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace trace {

// Of the JSON form and of the tables' meaning.
constexpr int statistics_version = 1;

struct Machine {
    std::string processor, system;
    unsigned num_threads = 0;
    std::uint64_t memory_bytes = 0;
};
[[nodiscard]] Machine this_machine();

// A small picture of what a frame shows.
struct Preview {
    int width = 0, height = 0;
    std::string png; // empty: none was made
};

// The options of a frame that decide about its picture and its cost.
struct FrameOptions {
    int resolution[2] = {0, 0}, samples[2] = {0, 0};
    float pixel_aspect = 1, crop[4] = {0, 1, 0, 1}, shutter[2] = {0, 0}, filter_width[2] = {0, 0};
    float gain = 1, gamma = 1;
    std::string filter, projection, hider;
    struct Display {
        std::string name, type, mode;
    };
    std::vector<Display> displays;
};
[[nodiscard]] FrameOptions frame_options(const rib::Options& options);

struct FrameRecord {
    int number = 0;
    bool is_numbered = false; // stands in FrameBegin .. FrameEnd
    std::string file;         // the RIB file it was read from
    std::string result;       // done, skipped, interrupted, failed
    FrameOptions options;
    Stats stats;
    std::array<std::uint64_t, 4> num_messages{}; // by base::Severity, since the frame before
    Preview preview;

    [[nodiscard]] std::string title() const; // "frame 3 of a.rib"
};

struct RunRecord {
    std::vector<std::string> arguments; // of the command line
    std::vector<std::string> files;
    std::vector<FrameRecord> frames;
    Stats total;
    std::vector<base::MessageRecord> messages;
    Machine machine;
    double seconds = 0; // of the run
};

// What a text tells: each level more than the one before (Option "statistics" "endofframe").
enum class StatsLevel : std::uint8_t { None = 0, Brief = 1, Shaders = 2, Full = 3 };

[[nodiscard]] std::string stats_text(const Stats& stats, StatsLevel level);
// The run and, where there are several, each frame.
[[nodiscard]] std::string run_text(const RunRecord& run);
[[nodiscard]] std::string run_json(const RunRecord& run);
[[nodiscard]] std::string run_html(const RunRecord& run);

} // namespace trace
