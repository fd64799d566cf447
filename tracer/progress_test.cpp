// SPDX-License-Identifier: Apache-2.0
// What the progress display prints, with a clock that the test sets.
#include "tracer/progress.h"

#include <algorithm>
#include <cstdlib>
#include <gtest/gtest.h>
#include <string>

namespace {

using trace::Progress;
using trace::ProgressMode;

double test_time_s = 0; // Progress takes a plain function as its clock
double test_clock() {
    return test_time_s;
}

std::string run(ProgressMode mode, int steps, int total) {
    char* text = nullptr;
    std::size_t size = 0;
    std::FILE* out = ::open_memstream(&text, &size);
    {
        Progress progress(mode, out, test_clock);
        test_time_s = 100;
        progress.start("render", static_cast<std::uint64_t>(total));
        for (int i = 0; i < steps; ++i) {
            test_time_s += 1;
            progress.advance();
        }
    }
    std::fclose(out);
    std::string result(text, size);
    std::free(text);
    return result;
}

TEST(Progress, AutoIsSilentWithoutATerminal) {
    std::FILE* out = std::tmpfile();
    {
        Progress progress(ProgressMode::Auto, out, test_clock);
        progress.start("render", 2);
        progress.advance(2);
        progress.finish();
    }
    EXPECT_EQ(std::ftell(out), 0);
    std::fclose(out);
    EXPECT_EQ(run(ProgressMode::None, 3, 3), "");
}

TEST(Progress, LinesForEveryTenth) {
    const std::string text = run(ProgressMode::Lines, 40, 40);
    EXPECT_EQ(text.substr(0, text.find('\n')), "render: 2 %, 0:39 left");
    EXPECT_NE(text.find("render: 50 %, 0:20 left\n"), std::string::npos);
    EXPECT_NE(text.find("render: 100 %, in 0:40\n"), std::string::npos);
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 11);
}

TEST(Progress, R90000) {
    const std::string text = run(ProgressMode::R90000, 4, 4);
    EXPECT_EQ(text, "R90000  25%\nR90000  50%\nR90000  75%\nR90000 100%\n");
}

TEST(Progress, BarShowsTimeLeft) {
    const std::string text = run(ProgressMode::Bar, 10, 10);
    EXPECT_NE(text.find("\rrender [===============               ]  50 %  0:05 left"),
              std::string::npos)
        << text;
    EXPECT_NE(text.find("[==============================] 100 %  in 0:10"), std::string::npos);
    EXPECT_EQ(text.back(), '\n');
}

TEST(Progress, StoppedEarlyDoesNotClaimAll) {
    const std::string text = run(ProgressMode::R90000, 1, 3);
    EXPECT_EQ(text, "R90000  33%\n");
}

TEST(Progress, Names) {
    EXPECT_EQ(trace::progress_mode("bar"), ProgressMode::Bar);
    EXPECT_EQ(trace::progress_mode("auto"), ProgressMode::Auto);
    EXPECT_EQ(trace::progress_mode("loud"), std::nullopt);
}

TEST(Progress, Durations) {
    EXPECT_EQ(trace::format_duration(7.4), "0:07");
    EXPECT_EQ(trace::format_duration(754), "12:34");
    EXPECT_EQ(trace::format_duration(3723), "1:02:03");
    EXPECT_EQ(trace::format_duration(-5), "0:00");
}

} // namespace
