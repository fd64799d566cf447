// SPDX-License-Identifier: Apache-2.0
// Where pictures are shown, which display is, and that nothing is opened without need.
#include "tracer/live_display.h"

#include <cstdlib>
#include <gtest/gtest.h>

namespace {

using trace::LiveDisplay;
using trace::LiveSettings;
using trace::parse_live_servers;

TEST(LiveServers, Spellings) {
    auto servers = parse_live_servers("auto");
    ASSERT_TRUE(servers);
    EXPECT_EQ(servers->web_port, 0);
    EXPECT_TRUE(servers->try_tev);
    servers = parse_live_servers("none");
    ASSERT_TRUE(servers);
    EXPECT_FALSE(servers->web_port || servers->tev || servers->try_tev);
    servers = parse_live_servers("web:8080");
    ASSERT_TRUE(servers);
    EXPECT_EQ(servers->web_port, 8080);
    EXPECT_FALSE(servers->tev || servers->try_tev);
    servers = parse_live_servers("tev,web");
    ASSERT_TRUE(servers && servers->tev);
    EXPECT_EQ(servers->tev->host, "127.0.0.1");
    EXPECT_EQ(servers->tev->port, "14158");
    EXPECT_EQ(servers->web_port, 0);
    servers = parse_live_servers("::1:99");
    ASSERT_TRUE(servers && servers->tev);
    EXPECT_EQ(servers->tev->host, "::1");
    EXPECT_EQ(servers->tev->port, "99");
    for (const char* wrong : {"", "web,", "host", ":80", "web:0", "web:x", "host:70000", "a,,b"}) {
        EXPECT_FALSE(parse_live_servers(wrong)) << wrong;
    }
}

rib::Display display(const char* name, const char* type) {
    rib::Display d;
    d.name = name;
    d.type = type;
    d.mode = "rgb";
    return d;
}

trace::DisplayPlan plan(const char* name, const char* type = "file") {
    return {display(name, type), {}, {}, -1};
}

class Live : public testing::Test {
protected:
    Live() : out_(::open_memstream(&text_, &size_)), diag_(out_) {}
    ~Live() override {
        std::fclose(out_);
        std::free(text_);
    }
    std::string printed() {
        std::fflush(out_);
        return text_;
    }

    char* text_ = nullptr;
    std::size_t size_ = 0;
    std::FILE* out_;
    base::Diag diag_;
};

TEST_F(Live, WhichDisplayIsShown) {
    const std::vector<trace::DisplayPlan> files = {plan("a.tif", "file"), plan("b", "framebuffer")};
    LiveSettings settings;
    EXPECT_EQ(LiveDisplay(settings, diag_, out_).shown(files), nullptr);
    settings.framebuffers = true;
    EXPECT_EQ(LiveDisplay(settings, diag_, out_).shown(files), &files[1]);
    EXPECT_EQ(LiveDisplay(settings, diag_, out_).shown({files.data(), 1}), nullptr);
    settings.every_frame = true;
    EXPECT_EQ(LiveDisplay(settings, diag_, out_).shown({files.data(), 1}), &files[0]);
    EXPECT_EQ(LiveDisplay(settings, diag_, out_).shown({}), nullptr);
    EXPECT_EQ(printed(), "");
}

TEST_F(Live, OpensAPageAndEndsAtOnceWhenNobodyCame) {
    LiveSettings settings;
    settings.every_frame = true;
    settings.servers.web_port = 0;
    LiveDisplay live(settings, diag_, out_);
    live.start();
    live.start(); // once
    EXPECT_TRUE(live.address().starts_with("http://127.0.0.1:")) << live.address();
    EXPECT_EQ(printed(), "perigee: info: the picture is shown at " + live.address() + "\n");
    EXPECT_NE(live.begin_frame(plan("a.exr"), {}, {0, 0, 4, 4}, 1), nullptr);
    live.end_frame(true);
    live.finish([] { return false; });
}

TEST_F(Live, AViewerThatWasAskedForAndIsNotThere) {
    LiveSettings settings;
    settings.every_frame = true;
    settings.servers.tev = trace::TevAddress{"127.0.0.1", "1"};
    LiveDisplay live(settings, diag_, out_);
    EXPECT_EQ(live.begin_frame(plan("a"), {}, {0, 0, 4, 4}, 1), nullptr);
    EXPECT_EQ(diag_.count(base::Severity::Warning), 1U);
    live.finish([] { return false; });
}

} // namespace
