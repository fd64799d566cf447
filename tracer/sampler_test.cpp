// SPDX-License-Identifier: Apache-2.0
// Samples: every stratum holds one, the spread beats plain jitter, and nothing but the pixel
// decides.
#include "tracer/sampler.h"

#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <set>

namespace {

using trace::SampleBlock;
using trace::Sampler;

SampleBlock block_of(const Sampler& sampler, const trace::PixelRange& pixels) {
    SampleBlock block;
    sampler.fill(pixels, block);
    return block;
}

TEST(Sampler, EveryCellColumnAndRowHoldsOneSample) {
    for (const auto& [nx, ny] : {std::pair{1, 1}, {2, 2}, {4, 4}, {3, 5}, {7, 2}, {16, 16}}) {
        const Sampler sampler({.nx = nx, .ny = ny});
        for (std::size_t p = 0; p < std::min<std::size_t>(sampler.num_patterns(), 20); ++p) {
            std::set<int> cells, columns, rows;
            const auto x = sampler.pattern_x(p), y = sampler.pattern_y(p);
            const int n = nx * ny;
            for (std::size_t s = 0; s < x.size(); ++s) {
                ASSERT_GE(x[s], 0);
                ASSERT_LT(x[s], 1);
                ASSERT_GE(y[s], 0);
                ASSERT_LT(y[s], 1);
                cells.insert(static_cast<int>(y[s] * float(ny)) * nx +
                             static_cast<int>(x[s] * float(nx)));
                columns.insert(static_cast<int>(x[s] * float(n)));
                rows.insert(static_cast<int>(y[s] * float(n)));
            }
            // Rounding to float may put a sample on the edge of its sub-column.
            EXPECT_EQ(cells.size(), x.size());
            EXPECT_GE(columns.size() + 1, x.size());
            EXPECT_GE(rows.size() + 1, x.size());
        }
    }
}

TEST(Sampler, TimeAndLensAreStratifiedAndShuffled) {
    const Sampler sampler(
        {.nx = 4, .ny = 4, .shutter_open = 2, .shutter_close = 4, .wants_lens = true});
    const SampleBlock b = block_of(sampler, {5, 7, 6, 8});
    std::set<int> parts, octants;
    int inner = 0;
    bool in_order = true;
    for (std::size_t s = 0; s < 16; ++s) {
        ASSERT_GE(b.time[s], 2);
        ASSERT_LE(b.time[s], 4);
        const int part = static_cast<int>((b.time[s] - 2) / 2 * 16);
        parts.insert(part);
        in_order = in_order && part == static_cast<int>(s);
        const double r = std::hypot(b.lens_x[s], b.lens_y[s]);
        ASSERT_LE(r, 1 + 1e-6);
        inner += r < 0.5;
        octants.insert(
            static_cast<int>((std::atan2(b.lens_y[s], b.lens_x[s]) + M_PI) / (M_PI / 4)));
    }
    EXPECT_EQ(parts.size(), 16U);
    // The 4x4 cells of the square: the inner four make the disc of half the radius, every octant
    // has two of 16.
    EXPECT_EQ(inner, 4);
    EXPECT_EQ(octants.size(), 8U);
    EXPECT_FALSE(in_order);
}

TEST(Sampler, RegularGridWithoutJitter) {
    const Sampler sampler({.nx = 3, .ny = 2, .jitter = 0});
    const SampleBlock b = block_of(sampler, {-4, 9, -2, 10});
    for (std::size_t i = 0; i < b.count; ++i) {
        const std::size_t s = i % 6;
        EXPECT_FLOAT_EQ(b.x[i], (static_cast<float>(s % 3) + 0.5f) / 3);
        EXPECT_FLOAT_EQ(b.y[i], (static_cast<float>(s / 3) + 0.5f) / 2);
    }
}

TEST(Sampler, OnlyThePixelDecides) {
    const Sampler sampler(
        {.nx = 2, .ny = 3, .shutter_open = 0, .shutter_close = 1, .wants_lens = true});
    const SampleBlock whole = block_of(sampler, {-2, -2, 30, 20});
    const SampleBlock part = block_of(sampler, {11, 5, 18, 9});
    EXPECT_EQ(part.count, 7U * 4 * 6);
    for (std::size_t i = 0; i < part.count; ++i) {
        const auto pixel = static_cast<std::size_t>((part.py[i] + 2) * 32 + part.px[i] + 2);
        const std::size_t j = pixel * 6 + i % 6;
        EXPECT_EQ(part.px[i], whole.px[j]);
        EXPECT_EQ(part.x[i], whole.x[j]);
        EXPECT_EQ(part.y[i], whole.y[j]);
        EXPECT_EQ(part.time[i], whole.time[j]);
        EXPECT_EQ(part.lens_x[i], whole.lens_x[j]);
        EXPECT_EQ(part.lens_y[i], whole.lens_y[j]);
        EXPECT_EQ(part.seed[i], whole.seed[j]);
    }
    EXPECT_EQ(part.x.size() % 8, 0U); // padded
}

TEST(Sampler, SeedsDiffer) {
    const Sampler sampler({.nx = 4, .ny = 4});
    const SampleBlock b = block_of(sampler, {0, 0, 32, 32});
    const std::set<std::uint32_t> seeds(b.seed.begin(),
                                        b.seed.begin() + static_cast<std::ptrdiff_t>(b.count));
    // 16384 of 2^32: 0.03 collisions are expected.
    EXPECT_GE(seeds.size() + 2, b.count);
}

// Largest difference between area and share of points over boxes anchored at the origin, on a fine
// grid: the star discrepancy to 1/128.
double star_discrepancy(std::span<const float> x, std::span<const float> y) {
    double worst = 0;
    for (int i = 1; i <= 64; ++i) {
        for (int j = 1; j <= 64; ++j) {
            const double a = i / 64.0, b = j / 64.0;
            double inside = 0;
            for (std::size_t s = 0; s < x.size(); ++s) {
                inside += double(x[s]) < a && double(y[s]) < b;
            }
            worst = std::max(worst, std::fabs(inside / double(x.size()) - a * b));
        }
    }
    return worst;
}

TEST(Sampler, LowerDiscrepancyThanJitter) {
    const Sampler sampler({.nx = 4, .ny = 4});
    std::mt19937 random(3);
    std::uniform_real_distribution<float> unit(0, 1);
    double ours = 0, jittered = 0;
    constexpr int trials = 40;
    for (std::size_t p = 0; p < trials; ++p) {
        ours += star_discrepancy(sampler.pattern_x(p), sampler.pattern_y(p));
        std::vector<float> x, y;
        for (int s = 0; s < 16; ++s) {
            x.push_back((float(s % 4) + unit(random)) / 4);
            y.push_back((float(s / 4) + unit(random)) / 4);
        }
        jittered += star_discrepancy(x, y);
    }
    EXPECT_LT(ours, 0.85 * jittered) << ours / trials << " against " << jittered / trials;
}

TEST(Sampler, SettingsFromOptions) {
    base::Diag diag(nullptr);
    rib::Options o;
    o.xsamples = -3;
    o.ysamples = 5;
    o.fstop = 4;
    o.focal_length = 1;
    rib::Param jitter;
    jitter.name = "jitter";
    jitter.decl.type = rib::ParamType::Integer;
    jitter.ints = {0};
    o.hider_params.params.push_back(jitter);
    const auto s = trace::sampler_settings(o, diag);
    EXPECT_EQ(s.nx, 1);
    EXPECT_EQ(s.ny, 5);
    EXPECT_EQ(s.jitter, 0);
    EXPECT_TRUE(s.wants_lens);
    EXPECT_EQ(diag.count(base::Severity::Warning), 0U);
}

TEST(Sampler, HugeCountsAreLimited) {
    std::FILE* null = std::fopen("/dev/null", "w");
    base::Diag diag(null);
    rib::Options o;
    o.xsamples = 2'000'000'000;
    o.ysamples = 2'000'000'000;
    const auto s = trace::sampler_settings(o, diag);
    EXPECT_LE(s.nx * s.ny, 4096);
    EXPECT_EQ(diag.count(base::Severity::Warning), 1U);
    std::fclose(null);
}

} // namespace
