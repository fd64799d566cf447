// SPDX-License-Identifier: Apache-2.0
#include "tracer/progress.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <unistd.h>

namespace trace {

namespace {

constexpr double interval_s = 0.1;
constexpr int bar_width = 30;
constexpr int line_step_percent = 10;

double steady_seconds() {
    using namespace std::chrono;
    return duration<double>(steady_clock::now().time_since_epoch()).count();
}

ProgressMode resolve(ProgressMode mode, std::FILE* out) {
    if (mode != ProgressMode::Auto) {
        return mode;
    }
    return ::isatty(::fileno(out)) != 0 ? ProgressMode::Bar : ProgressMode::None;
}

// Time left if the rest goes on like the past.
std::string time_left(double fraction, double elapsed_s) {
    return fraction > 0 ? format_duration(elapsed_s * (1 - fraction) / fraction) : "?";
}

} // namespace

std::optional<ProgressMode> progress_mode(std::string_view text) {
    constexpr struct {
        std::string_view name;
        ProgressMode mode;
    } names[] = {{"auto", ProgressMode::Auto},
                 {"bar", ProgressMode::Bar},
                 {"lines", ProgressMode::Lines},
                 {"none", ProgressMode::None}};
    for (const auto& row : names) {
        if (row.name == text) {
            return row.mode;
        }
    }
    return std::nullopt;
}

std::string format_duration(double seconds) {
    // A day in every second is more than any estimate means.
    const auto s = static_cast<long>(std::lround(std::clamp(seconds, 0.0, 86400.0 * 365)));
    char text[32];
    if (s < 3600) {
        std::snprintf(text, sizeof text, "%ld:%02ld", s / 60, s % 60);
    } else {
        std::snprintf(text, sizeof text, "%ld:%02ld:%02ld", s / 3600, s / 60 % 60, s % 60);
    }
    return text;
}

Progress::Progress(ProgressMode mode, std::FILE* out, Clock clock)
    : mode_(resolve(mode, out)), out_(out), clock_(clock != nullptr ? clock : steady_seconds) {}

Progress::~Progress() {
    finish();
}

void Progress::clear_line() {
    const std::lock_guard lock(mutex_);
    if (line_open_) {
        std::fputs("\r\x1b[K", out_); // erases to the end of the line
        std::fflush(out_);
        line_open_ = false;
    }
}

void Progress::start(std::string_view name, std::uint64_t total) {
    finish();
    const std::lock_guard lock(mutex_);
    name_ = name;
    total_ = std::max<std::uint64_t>(total, 1);
    done_ = 0;
    start_s_ = clock_();
    shown_s_ = start_s_ - interval_s;
    shown_percent_ = -1;
    running_ = true;
}

void Progress::advance(std::uint64_t steps) {
    if (mode_ == ProgressMode::None) {
        return;
    }
    const std::lock_guard lock(mutex_);
    if (running_) {
        done_ = std::min(done_ + steps, total_);
        show(false);
    }
}

void Progress::finish() {
    const std::lock_guard lock(mutex_);
    if (!running_) {
        return;
    }
    running_ = false;
    if (mode_ != ProgressMode::None) {
        show(true);
        if (line_open_) {
            std::fputc('\n', out_);
            line_open_ = false;
        }
        std::fflush(out_);
    }
}

// Called with the lock held.
void Progress::show(bool last) {
    const double now = clock_();
    const double fraction = static_cast<double>(done_) / static_cast<double>(total_);
    const int percent = static_cast<int>(100 * fraction);
    if (mode_ == ProgressMode::Bar) {
        if (last || now - shown_s_ >= interval_s) {
            shown_s_ = now;
            show_bar(fraction, now - start_s_);
        }
        return;
    }
    const int step = mode_ == ProgressMode::Lines ? line_step_percent : 1;
    if (percent / step <= shown_percent_ / step && shown_percent_ >= 0) {
        return;
    }
    shown_percent_ = percent;
    if (mode_ == ProgressMode::Lines) {
        show_line(fraction, now - start_s_);
    } else {
        std::fprintf(out_, "R90000 %3d%%\n", percent);
        std::fflush(out_);
    }
}

void Progress::show_bar(double fraction, double elapsed_s) {
    const int filled = static_cast<int>(std::lround(fraction * bar_width));
    const std::string bar = std::string(static_cast<std::size_t>(filled), '=') +
                            std::string(static_cast<std::size_t>(bar_width - filled), ' ');
    const std::string time = fraction < 1 ? time_left(fraction, elapsed_s) + " left"
                                          : "in " + format_duration(elapsed_s);
    std::fprintf(out_, "\r%s [%s] %3d %%  %s\x1b[K", name_.c_str(), bar.c_str(),
                 static_cast<int>(100 * fraction), time.c_str());
    std::fflush(out_);
    line_open_ = true;
}

void Progress::show_line(double fraction, double elapsed_s) {
    const std::string time = fraction < 1 ? time_left(fraction, elapsed_s) + " left"
                                          : "in " + format_duration(elapsed_s);
    std::fprintf(out_, "%s: %d %%, %s\n", name_.c_str(), static_cast<int>(100 * fraction),
                 time.c_str());
    std::fflush(out_);
}

} // namespace trace
