// SPDX-License-Identifier: Apache-2.0
// Progress of a long job on a terminal: a bar with the time left, or lines.
// Thread-safe; writes at most ten times a second. The clock is a parameter, so that tests need not
// wait.
#pragma once

#include <cstdint>
#include <cstdio>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

namespace trace {

enum class ProgressMode : std::uint8_t {
    None,
    Auto, // Bar if the stream is a terminal, else None
    Bar,
    Lines, // "name: 10 %, 0:12 left" for every tenth
    R90000 // "R90000  10%" for every percent, -Progress: programs read these
};
[[nodiscard]] std::optional<ProgressMode> progress_mode(std::string_view text);

// 0:07, 12:34, 1:02:03.
[[nodiscard]] std::string format_duration(double seconds);

class Progress {
public:
    using Clock = double (*)(); // seconds
    Progress(ProgressMode mode, std::FILE* out, Clock clock = nullptr);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    // A bar may stand on the line: call before other output to the same stream.
    void clear_line();
    void start(std::string_view name, std::uint64_t total);
    void advance(std::uint64_t steps = 1);
    // Ends the phase; 100 % is shown only if all steps were made.
    void finish();

private:
    void show(bool last);
    void show_bar(double fraction, double elapsed_s);
    void show_line(double fraction, double elapsed_s);

    std::mutex mutex_;
    ProgressMode mode_;
    std::FILE* out_;
    Clock clock_;
    std::string name_;
    std::uint64_t total_ = 0, done_ = 0;
    double start_s_ = 0, shown_s_ = 0;
    int shown_percent_ = -1;
    bool running_ = false, line_open_ = false;
};

} // namespace trace
