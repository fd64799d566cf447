// SPDX-License-Identifier: Apache-2.0
// What readers of the running picture get: every change once, the newest state, across frames and
// with threads.
#include "tracer/live_view.h"

#include <gtest/gtest.h>
#include <thread>

namespace {

using trace::LiveMark;
using trace::LiveState;
using trace::LiveUpdate;
using trace::LiveView;
using trace::Plane;

constexpr trace::PixelRange whole{3, 5, 19, 13}; // 16 by 8, in four buckets
constexpr trace::PixelRange buckets[] = {
    {3, 5, 11, 9}, {11, 5, 19, 9}, {3, 9, 11, 13}, {11, 9, 19, 13}};
constexpr std::size_t all = 1000;

double test_time_s = 0; // LiveView takes a plain function as its clock
double test_clock() {
    return test_time_s;
}

trace::LiveFrame frame() {
    trace::LiveFrame f;
    f.name = "a";
    f.pixels = whole;
    f.exposure = {2, 1};
    return f;
}

trace::Image picture(float value) {
    trace::Image image;
    image.pixels = whole;
    for (auto& plane : image.planes) {
        plane.assign(whole.area(), value);
    }
    return image;
}

trace::SampleBuffer samples(const trace::PixelRange& pixels, float value) {
    trace::SampleBuffer out;
    out.pixels = pixels.grown(1, 1); // as at the border of a film
    trace::Sample sample;
    for (std::size_t c = 0; c < 3; ++c) {
        sample.color[c] = value;
        sample.opacity[c] = 1;
    }
    out.samples.assign(out.pixels.area() * 4, sample);
    return out;
}

TEST(LiveView, SamplesFirstThenFinalPixels) {
    LiveView view;
    ASSERT_TRUE(view.begin_frame(frame(), 4));
    view.samples_in(1, buckets[1], samples(buckets[1], 0.25f));
    LiveUpdate update = view.read({}, all);
    EXPECT_TRUE(update.restart);
    EXPECT_EQ(update.state, LiveState::Rendering);
    EXPECT_EQ(update.num_done, 1U);
    ASSERT_EQ(update.tiles.size(), 1U);
    EXPECT_EQ(update.tiles[0].pixels, buckets[1]);
    EXPECT_FALSE(update.tiles[0].final);
    EXPECT_EQ(update.tiles[0].rgba[0], 0.5f); // exposed
    EXPECT_EQ(update.tiles[0].rgba[3], 1.0f); // opacity is not

    view.bucket_done(1, buckets[1], picture(0.75f));
    view.samples_in(0, buckets[0], samples(buckets[0], 0));
    update = view.read(update.mark, all);
    EXPECT_FALSE(update.restart);
    EXPECT_EQ(update.num_done, 2U);
    ASSERT_EQ(update.tiles.size(), 2U);
    EXPECT_TRUE(update.tiles[0].final);
    EXPECT_EQ(update.tiles[0].rgba[0], 1.5f);
    EXPECT_EQ(update.tiles[0].rgba[3], 0.75f);
    EXPECT_TRUE(view.read(update.mark, all).tiles.empty());
}

TEST(LiveView, ALateReaderGetsEachBucketOnceAndInPieces) {
    LiveView view;
    ASSERT_TRUE(view.begin_frame(frame(), 4));
    for (std::size_t i = 0; i < 4; ++i) {
        view.samples_in(i, buckets[i], samples(buckets[i], 1));
    }
    for (std::size_t i = 0; i < 4; ++i) {
        view.bucket_done(i, buckets[i], picture(1));
    }
    LiveMark mark;
    std::size_t tiles = 0, reads = 0;
    while (!(mark == view.newest())) {
        EXPECT_TRUE(view.wait(mark, 0));
        const LiveUpdate update = view.read(mark, 1); // one bucket at a time
        EXPECT_LE(update.tiles.size(), 1U);
        tiles += update.tiles.size();
        mark = update.mark;
        ASSERT_LE(++reads, 8U);
    }
    EXPECT_EQ(tiles, 4U);
    EXPECT_FALSE(view.wait(mark, 0));
}

TEST(LiveView, OnlyWhatTheImagerChangedIsSentAgain) {
    LiveView view;
    ASSERT_TRUE(view.begin_frame(frame(), 4));
    for (std::size_t i = 0; i < 4; ++i) {
        view.bucket_done(i, buckets[i], picture(1));
    }
    const LiveMark mark = view.read({}, all).mark;
    trace::Image developed = picture(2); // what exposure made of it
    for (float& a : developed.planes[static_cast<std::size_t>(Plane::A)]) {
        a = 1;
    }
    view.show_final(developed);
    EXPECT_TRUE(view.read(mark, all).tiles.empty());
    developed.planes[0].back() = 7;
    view.show_final(developed);
    view.end_frame(LiveState::Done);
    const LiveUpdate update = view.read(mark, all);
    ASSERT_EQ(update.tiles.size(), 1U);
    EXPECT_EQ(update.tiles[0].pixels, buckets[3]);
    EXPECT_EQ(update.state, LiveState::Done);
}

TEST(LiveView, ANewFrameReplacesTheOld) {
    LiveView view;
    ASSERT_TRUE(view.begin_frame(frame(), 4));
    view.bucket_done(0, buckets[0], picture(1));
    const LiveMark old = view.read({}, all).mark;
    view.end_frame(LiveState::Done);
    trace::LiveFrame second = frame();
    second.name = "b";
    ASSERT_TRUE(view.begin_frame(second, 4));
    const LiveUpdate update = view.read(old, all);
    EXPECT_TRUE(update.restart);
    EXPECT_TRUE(update.tiles.empty());
    EXPECT_EQ(update.frame.name, "b");
}

TEST(LiveView, TimeLeftAndTheEnd) {
    LiveView view(test_clock);
    test_time_s = 100;
    EXPECT_EQ(view.read({}, all).state, LiveState::Waiting);
    ASSERT_TRUE(view.begin_frame(frame(), 4));
    EXPECT_EQ(view.read({}, all).left_s, -1);
    test_time_s = 103;
    view.samples_in(0, buckets[0], samples(buckets[0], 0));
    EXPECT_EQ(view.read({}, all).elapsed_s, 3);
    EXPECT_EQ(view.read({}, all).left_s, 9);
    view.end_frame(LiveState::Stopped);
    test_time_s = 500;
    EXPECT_EQ(view.read({}, all).elapsed_s, 3);
    const LiveMark mark = view.newest();
    view.close();
    EXPECT_TRUE(view.wait(mark, 0));
    EXPECT_TRUE(view.read(mark, all).closing);
}

TEST(LiveView, TooLargeIsRefused) {
    LiveView view;
    trace::LiveFrame large = frame();
    large.pixels = {0, 0, 1 << 14, 1 << 14};
    EXPECT_FALSE(view.begin_frame(large, 1));
    EXPECT_EQ(view.newest(), LiveMark{});
}

// For ThreadSanitizer, and that nothing is lost: the reader rebuilds the picture while it grows.
TEST(LiveView, ReadersAndWritersAtOnce) {
    LiveView view;
    ASSERT_TRUE(view.begin_frame(frame(), 4));
    const auto write = [&](std::size_t first) {
        for (std::size_t i = first; i < 4; i += 2) {
            view.samples_in(i, buckets[i], samples(buckets[i], 3));
            view.bucket_done(i, buckets[i], picture(static_cast<float>(i)));
        }
    };
    std::thread one(write, 0), two(write, 1);
    float seen[4] = {-1, -1, -1, -1};
    LiveMark mark;
    for (std::size_t num_final = 0; num_final < 4;) {
        view.wait(mark, 1);
        const LiveUpdate update = view.read(mark, 40);
        mark = update.mark;
        for (const trace::LiveTile& tile : update.tiles) {
            const auto* bucket = std::ranges::find(buckets, tile.pixels);
            seen[bucket - buckets] = tile.rgba[0];
            num_final += tile.final ? 1 : 0;
        }
    }
    one.join();
    two.join();
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(seen[i], 2 * static_cast<float>(i));
    }
}

} // namespace
