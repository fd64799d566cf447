// SPDX-License-Identifier: Apache-2.0
// Runs a program without a shell: arguments as a list, input from memory, bounded output captured.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace slc {

struct ProcessLimits {
    std::size_t output_bytes = 64u << 20; // of each stream; beyond it the program is ended
    unsigned cpu_seconds = 60;
    std::size_t memory_bytes = std::size_t{4} << 30;
};

struct ProcessResult {
    bool started = false; // false: not found or not executable
    bool cut_off = false; // a limit was reached
    int exit_code = -1;   // -1: ended by a signal
    std::string out, err;
};

// argv[0] is looked up on PATH. Messages of the program are asked for in English (LC_ALL=C).
[[nodiscard]] ProcessResult run_process(const std::vector<std::string>& argv,
                                        std::string_view input, const ProcessLimits& limits = {});

} // namespace slc
