// SPDX-License-Identifier: Apache-2.0
// Runs a program without a shell: arguments as a list, input from memory, bounded output captured.
// The program is the head of a process group of its own, so that ending it ends what it started.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace slc {

struct ProcessSettings {
    std::size_t output_bytes = 64u << 20; // of each stream; beyond it the program is ended
    unsigned cpu_seconds = 60;
    std::size_t memory_bytes = std::size_t{4} << 30;
    std::string temp_dir;            // TMPDIR of the program; "" = as it is here
    std::function<bool()> cancelled; // asked every few hundredths of a second; may be empty
};

struct ProcessResult {
    bool started = false;   // false: not found or not executable
    bool cut_off = false;   // a limit was reached
    bool cancelled = false; // ended because `cancelled` said so
    int exit_code = -1;     // -1: ended by a signal
    std::string out, err;
};

// argv[0] is looked up on PATH. Messages of the program are asked for in English (LC_ALL=C).
[[nodiscard]] ProcessResult run_process(const std::vector<std::string>& argv,
                                        std::string_view input,
                                        const ProcessSettings& settings = {});

} // namespace slc
