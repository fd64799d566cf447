// SPDX-License-Identifier: Apache-2.0
#include "tracer/options.h"

#include <gtest/gtest.h>

namespace trace {
namespace {

ParsedOptions parse(std::vector<const char*> arguments) {
    return parse_options(arguments);
}

TEST(RenderOptions, SpellingsOfProgramsThatCallUs) {
    const auto ayam = parse({"-d", "4", "-Progress", "f.rib"});
    EXPECT_EQ(ayam.error, "");
    EXPECT_EQ(ayam.options.progress, ProgressMode::R90000);
    EXPECT_EQ(ayam.options.files, std::vector<std::string>{"f.rib"});
    EXPECT_TRUE(ayam.options.show);
    EXPECT_EQ(ayam.options.show_every, 4);

    const auto wings = parse({"-silent", "-res", "320", "200", "-d", "16", "f.rib"});
    EXPECT_EQ(wings.error, "");
    EXPECT_TRUE(wings.options.silent);
    EXPECT_EQ(wings.options.res, std::pair(320, 200));

    EXPECT_EQ(wings.options.show_every, 16);
    EXPECT_EQ(parse({"-d", "f.rib"}).options.files, std::vector<std::string>{"f.rib"});
    EXPECT_EQ(parse({"-d", "f.rib"}).options.show_every, 1);
    EXPECT_EQ(parse({"-d", "-3", "f.rib"}).options.show_every, 1);
    EXPECT_TRUE(parse({"--display-server=host:1234", "f.rib"}).options.show);
    EXPECT_NE(parse({"--display-server", "host"}).error, "");
    EXPECT_EQ(parse({"-var", "0.1", "2", "8", "-radio", "10", "-"}).options.files,
              std::vector<std::string>{"-"});
}

TEST(RenderOptions, Frames) {
    const auto range = parse({"-frames", "3", "5", "a.rib"}).options;
    EXPECT_FALSE(wants_frame(range, 2));
    EXPECT_TRUE(wants_frame(range, 3));
    EXPECT_TRUE(wants_frame(range, 5));
    EXPECT_FALSE(wants_frame(range, 6));
    const auto list = parse({"-frames", "1,4-6", "a.rib"}).options;
    EXPECT_TRUE(wants_frame(list, 1));
    EXPECT_FALSE(wants_frame(list, 2));
    EXPECT_TRUE(wants_frame(list, 5));
    EXPECT_EQ(list.files.size(), 1U);
    EXPECT_TRUE(wants_frame(parse({"a.rib"}).options, 77));
    EXPECT_NE(parse({"-frames", "x"}).error, "");
    EXPECT_EQ(frame_file_name("a.####.exr", 12), "a.0012.exr");
    EXPECT_EQ(frame_file_name("a#.exr", 123), "a123.exr");
    EXPECT_EQ(frame_file_name("a.exr", 1), "a.exr");
}

TEST(RenderOptions, WrongUsageIsNamed) {
    EXPECT_NE(parse({"-bogus"}).error.find("-bogus"), std::string::npos);
    EXPECT_NE(parse({"-res", "10"}).error.find("-res"), std::string::npos);
    EXPECT_NE(parse({"-res", "10", "ten"}).error.find("ten"), std::string::npos);
    EXPECT_NE(parse({"-res", "0", "10"}).error, "");
    EXPECT_NE(parse({"-t", "0"}).error, "");
    EXPECT_NE(parse({"-o"}).error, "");
    EXPECT_NE(parse({"--progress=wild"}).error, "");
    EXPECT_NE(parse({"--stats=1"}).error, "");
    EXPECT_NE(parse({"-crop", "0", "1", "nan", "1"}).error, "");
}

TEST(RenderOptions, LongSwitchesTakeBothForms) {
    EXPECT_EQ(parse({"--progress=lines"}).options.progress, ProgressMode::Lines);
    EXPECT_EQ(parse({"--progress", "none"}).options.progress, ProgressMode::None);
    EXPECT_EQ(parse({"--stats-json", "s.json"}).options.stats_json, "s.json");
    EXPECT_EQ(parse({"--stats-json=s.json"}).options.stats_json, "s.json");
    EXPECT_EQ(parse({"--", "-odd.rib"}).options.files, std::vector<std::string>{"-odd.rib"});
}

TEST(RenderOptions, HelpNamesEverySwitch) {
    const std::string text = usage_text("render");
#define RENDER_OPTION(id, name, arguments, metavar, state, help)                                   \
    EXPECT_NE(text.find(std::string("  ") + name), std::string::npos) << name;
#include "tracer/options.def"
#undef RENDER_OPTION
}

TEST(RenderOptions, Paths) {
    EXPECT_EQ(parse({"-shaders", "a::b/c:", "-shaders", "lib.slpkg"}).options.shader_path,
              (std::vector<std::string>{"a", "b/c", "lib.slpkg"}));
    EXPECT_TRUE(parse({"-shaders", ""}).options.shader_path.empty());
}

} // namespace
} // namespace trace
