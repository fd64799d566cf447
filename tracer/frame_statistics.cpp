// SPDX-License-Identifier: Apache-2.0
#include "tracer/frame_statistics.h"

#include "runtime/base/file.h"

#include <algorithm>
#include <cstdio>

namespace trace {

namespace {

const rib::Param* find_option(const rib::Options& options, const char* name) {
    const auto it = options.user.find(name);
    return it == options.user.end() ? nullptr : &it->second;
}

int integer_of(const rib::Param* option) {
    if (option == nullptr) {
        return 0;
    }
    return !option->ints.empty() ? option->ints.front()
           : !option->floats.empty()
               ? static_cast<int>(std::clamp(option->floats.front(), 0.f, 9.f))
               : 0;
}

// The more of what the two options ask for.
StatsLevel level_of(const rib::Options& options) {
    const Verbosity verbosity = verbosity_of(options);
    const int by_verbosity = verbosity == Verbosity::Stats   ? 1
                             : verbosity == Verbosity::Debug ? 2
                                                             : 0;
    const int asked = integer_of(find_option(options, "statistics:endofframe"));
    return static_cast<StatsLevel>(
        std::clamp(std::max(asked, by_verbosity), 0, static_cast<int>(StatsLevel::Full)));
}

} // namespace

Verbosity verbosity_of(const rib::Param* option) {
    const std::string value =
        option != nullptr && !option->strings.empty() ? option->strings.front() : "";
    return value == "silent"  ? Verbosity::Silent
           : value == "stats" ? Verbosity::Stats
           : value == "debug" ? Verbosity::Debug
                              : Verbosity::Normal;
}

Verbosity verbosity_of(const rib::Options& options) {
    return verbosity_of(find_option(options, "runtime:verbosity"));
}

bool FrameStatistics::tell(const rib::Options& options, const FrameRecord& frame) {
    const StatsLevel level = level_of(options);
    if (level == StatsLevel::None) {
        return true;
    }
    const std::string text =
        frame.title() + " (" + frame.result + ")\n" + stats_text(frame.stats, level);
    const rib::Param* named = find_option(options, "statistics:filename");
    const std::string file =
        named != nullptr && !named->strings.empty() ? named->strings.front() : "";
    if (file.empty() || file == "stdout") {
        std::fwrite(text.data(), 1, text.size(), stdout);
        return true;
    }
    if (file == "stderr") {
        std::fwrite(text.data(), 1, text.size(), stderr);
        return true;
    }
    std::string& whole = texts_[file];
    whole += text;
    const std::string error = base::write_file_atomically(file, whole);
    if (!error.empty()) {
        diag_.report(base::Severity::Error, base::Code::System, named->pos,
                     "Option: statistics cannot be written: " + error);
    }
    return error.empty();
}

} // namespace trace
