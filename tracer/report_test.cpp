// SPDX-License-Identifier: Apache-2.0
// Statistics that add up, and reports that hold whatever names a RIB file uses.
#include "tracer/html_text.h"
#include "tracer/run_record.h"

#include <gtest/gtest.h>

namespace trace {
namespace {

Counters counted(std::uint32_t shader, std::uint64_t points, std::uint64_t packets) {
    Counters c;
    c.shader(shader).add_batch(points, packets, 8);
    c.shader(shader).add_time(1000);
    c.add(Counter::hits, points);
    c.max_layers = points;
    return c;
}

TEST(Stats, ThreadsAndFramesAddUpByShader) {
    const std::vector<ShaderName> names = {{"matte", "matte.sl", SL_SHADER_surface, 2},
                                           {"fog", "fog.sl", SL_SHADER_volume, 1},
                                           {"unused", "unused.sl", SL_SHADER_surface, 1}};
    Counters both = counted(0, 10, 2);
    both += counted(1, 3, 1);
    Stats frame;
    frame.add(both, names, 1e-3);
    ASSERT_EQ(frame.shaders.size(), 2U); // what never ran is not told
    EXPECT_EQ(frame.counters[Counter::hits], 13U);
    EXPECT_EQ(frame.amounts[Amount::max_layers], 10U);
    EXPECT_EQ(frame.shaders[0].value[ShaderCount::instances], 2U);
    EXPECT_DOUBLE_EQ(frame.shaders[0].seconds, 1);
    EXPECT_DOUBLE_EQ(frame.shaders[0].mean_live_lanes(), 5);
    Stats run;
    run += frame;
    run += frame;
    ASSERT_EQ(run.shaders.size(), 2U);
    EXPECT_EQ(run.shaders[0].value[ShaderCount::points], 20U);
    EXPECT_EQ(run.amounts[Amount::max_layers], 10U); // the largest, not the sum
}

TEST(Stats, SomeTimedRunsStandForAll) {
    Counters c;
    for (int i = 0; i < 32; ++i) {
        c.shader(0).add_batch(8, 1, 8);
    }
    c.shader(0).add_time(10);
    c.shader(0).add_time(30);
    Stats stats;
    const std::vector<ShaderName> names = {{"light", "", SL_SHADER_light, 1}};
    stats.add(c, names, 1);
    EXPECT_DOUBLE_EQ(stats.shaders.at(0).seconds, 640); // 32 runs of 20 ticks
}

TEST(HtmlText, MarkupAndBadBytesAreMadeHarmless) {
    EXPECT_EQ(escaped("<a href=\"x\">'&"), "&lt;a href=&quot;x&quot;&gt;&#39;&amp;");
    EXPECT_EQ(escaped("grün 界"), "grün 界");
    EXPECT_EQ(escaped("\xff\xc0\xaf"), "\xEF\xBF\xBD\xEF\xBF\xBD\xEF\xBF\xBD");
    EXPECT_EQ(escaped("\xed\xa0\x80"), "\xEF\xBF\xBD\xEF\xBF\xBD\xEF\xBF\xBD"); // a surrogate
    EXPECT_EQ(escaped("\xe7\x95"), "\xEF\xBF\xBD\xEF\xBF\xBD");                 // cut off
    EXPECT_EQ(escaped(std::string_view("a\0\x1b[2J", 6)), "a\xEF\xBF\xBD\xEF\xBF\xBD[2J");
}

TEST(HtmlText, Base64) { // RFC 4648, section 10
    EXPECT_EQ(base64(""), "");
    EXPECT_EQ(base64("f"), "Zg==");
    EXPECT_EQ(base64("fo"), "Zm8=");
    EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
    EXPECT_EQ(base64("\xff\xfe\xfd"), "//79");
}

RunRecord hostile_run() {
    const std::string name = "</script><script>alert(1)</script>\"'>\xff\n\x1b[31m";
    RunRecord run;
    run.files = {name};
    run.arguments = {name};
    FrameRecord frame;
    frame.file = name;
    frame.result = "done";
    frame.options.filter = frame.options.hider = frame.options.projection = name;
    frame.options.displays.push_back({name, name, name});
    frame.stats.shaders.push_back({{name, name, SL_SHADER_surface, 1}, {}, 0});
    run.frames = {frame, frame};
    run.total = frame.stats;
    run.messages.push_back(
        {base::Severity::Error, base::Code::NoShader, "no shader " + name, 1, {name + ":1"}});
    return run;
}

TEST(Report, HostileNamesStayText) {
    const std::string page = run_html(hostile_run());
    EXPECT_EQ(page.find("<script>alert"), std::string::npos);
    EXPECT_EQ(page.find('\xff'), std::string::npos);
    std::size_t scripts = 0;
    for (std::size_t at = page.find("<script"); at != std::string::npos;
         at = page.find("<script", at + 1)) {
        ++scripts;
    }
    EXPECT_EQ(scripts, 1U);                                // the page's own
    EXPECT_EQ(page.find("http"), page.find("http-equiv")); // nothing from elsewhere
    EXPECT_EQ(page.find("http", page.find("http-equiv") + 1), std::string::npos);
}

TEST(Report, JsonTakesAnyBytes) {
    const std::string json = run_json(hostile_run());
    EXPECT_EQ(json.find('\xff'), std::string::npos);
    EXPECT_EQ(json.find('\x1b'), std::string::npos);
}

TEST(Report, TextObeysNoControlCharacters) {
    const std::string text = run_text(hostile_run());
    EXPECT_EQ(text.find('\x1b'), std::string::npos);
}

} // namespace
} // namespace trace
