// SPDX-License-Identifier: Apache-2.0
// Adaptive sampling: the mean of many estimates is the integral, for edges, small bright features
// and ramps; what a pixel saw has no say in how many samples it gets; the film counts pixels by
// their area, not by their samples.
#include "tracer/adaptive.h"
#include "tracer/film.h"
#include "tracer/progressive.h"

#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <set>

namespace {

using trace::Adaptive;
using trace::AdaptiveSettings;
using trace::PixelRange;
using trace::Sample;
using trace::SampleBlock;
using trace::Sampler;

constexpr int block_px = 8; // the picture repeats after these; tiles hold four of them
constexpr AdaptiveSettings settings{.variance = 0.002f, .least = 4, .most = 32};
constexpr std::size_t per_quarter = settings.most / trace::quarters;

// Position inside the repeated block, pixels.
using Function = std::function<float(float x, float y)>;

Sampler adaptive_sampler(std::uint32_t seed = 0) {
    return Sampler({.nx = settings.most, .ny = 1, .least = settings.least, .seed = seed});
}

std::vector<Sample> samples_of(const SampleBlock& block, const Function& f) {
    std::vector<Sample> out(block.count);
    for (std::size_t i = 0; i < block.count; ++i) {
        const float value = f(static_cast<float>(block.px[i] % block_px) + block.x[i],
                              static_cast<float>(block.py[i] % block_px) + block.y[i]);
        std::fill_n(out[i].color, 3, value);
        std::fill_n(out[i].opacity, 3, 1.0f);
    }
    return out;
}

// How a pixel's number of samples is decided, given the first ones of its tile.
using Decide =
    std::function<void(const PixelRange&, std::span<const Sample>, std::vector<std::uint16_t>&)>;

struct Means { // of the quarters of pixels
    std::array<double, block_px * block_px * trace::quarters> sum{}, squares{};
    std::size_t count = 0; // of each
    double samples = 0;    // per pixel
};

// The means of the samples of every pixel, over many tiles: each draws its own random numbers.
Means estimate(const Function& f, const Decide& decide, int tiles) {
    Means means;
    SampleBlock block;
    std::vector<std::uint16_t> counts;
    for (int ty = 0; ty < tiles; ++ty) {
        // A sampler has some hundred patterns: more pictures need more of them.
        const Sampler sampler = adaptive_sampler(static_cast<std::uint32_t>(ty));
        for (int tx = 0; tx < tiles; ++tx) {
            const PixelRange tile = trace::tile_at(tx * trace::tile_px, ty * trace::tile_px);
            sampler.fill_firsts(tile, block);
            decide(tile, samples_of(block, f), counts);
            sampler.fill(tile, block);
            const std::vector<Sample> all = samples_of(block, f);
            for (std::size_t i = 0; i < counts.size(); ++i) {
                double mean = 0; // of a quarter, all of which are alike
                for (std::size_t s = 0; s < counts[i]; ++s) {
                    mean += static_cast<double>(all[i * per_quarter + s].color[0]) / counts[i];
                }
                const std::size_t pixel = i / trace::quarters;
                const std::size_t at =
                    (pixel / trace::tile_px % block_px * block_px + pixel % block_px) *
                        trace::quarters +
                    i % trace::quarters;
                means.sum[at] += mean;
                means.squares[at] += mean * mean;
                means.samples += counts[i];
            }
            means.count += trace::tile_px * trace::tile_px / (block_px * block_px);
        }
    }
    means.samples /= static_cast<double>(means.count) * block_px * block_px;
    return means;
}

double integral(const Function& f, std::size_t quarter) {
    constexpr int n = 150;
    const std::size_t pixel = quarter / trace::quarters, q = quarter % trace::quarters;
    const float x = static_cast<float>(pixel % block_px) + static_cast<float>(q % 2) / 2;
    const float y = static_cast<float>(pixel / block_px) + static_cast<float>(q / 2) / 2;
    double sum = 0;
    for (int j = 0; j < n; ++j) {
        for (int i = 0; i < n; ++i) {
            sum += static_cast<double>(f(x + (static_cast<float>(i) + 0.5f) / (2 * n),
                                         y + (static_cast<float>(j) + 0.5f) / (2 * n)));
        }
    }
    return sum / (n * n);
}

// The largest error of a mean, in standard errors.
double worst_bias(const Function& f, const Means& means) {
    double worst = 0;
    for (std::size_t i = 0; i < means.sum.size(); ++i) {
        const auto n = static_cast<double>(means.count);
        const double mean = means.sum[i] / n;
        const double variance = std::max(means.squares[i] / n - mean * mean, 0.0);
        // The floor: what the sum over the grid of integral() is off by.
        const double error = std::sqrt(variance / n) + 5e-4;
        worst = std::max(worst, std::fabs(mean - integral(f, i)) / error);
    }
    return worst;
}

void by_neighbours(const PixelRange& tile, std::span<const Sample> firsts,
                   std::vector<std::uint16_t>& counts) {
    const rib::Options options;
    Adaptive(settings, options).decide(tile, firsts, tile, counts);
}

// The method that looks right and is not: a pixel whose own first samples agree gets no more.
void by_own_samples(const PixelRange& tile, std::span<const Sample> firsts,
                    std::vector<std::uint16_t>& counts) {
    counts.clear();
    for (std::size_t i = 0; i < tile.area(); ++i) {
        bool differ = false;
        for (std::size_t s = 1; s < settings.least; ++s) {
            differ |=
                firsts[i * settings.least + s].color[0] != firsts[i * settings.least].color[0];
        }
        counts.insert(counts.end(), trace::quarters,
                      static_cast<std::uint16_t>(differ ? per_quarter : 1));
    }
}

float edge(float x, float y) {
    return x + 0.37f * y > 4.6f ? 1.0f : 0.0f;
}
float bright_speck(float x, float y) {
    return std::hypot(x - 3.8f, y - 4.3f) < 0.35f ? 1.0f : 0.1f;
}
float penumbra(float x, float y) {
    const float t = std::clamp((x - 2.0f + 0.2f * y) / 3, 0.0f, 1.0f);
    return t * t * (3 - 2 * t);
}

constexpr int num_tiles = 40; // a side: 25600 estimates of every pixel
// Of 64 pixels' normal errors the largest exceeds 4.5 in one of 2000 runs; the seeds are fixed.
constexpr double significant = 4.5;

TEST(Adaptive, TheMeanOfManyPicturesIsTheIntegral) {
    for (const Function& f : {Function(edge), Function(bright_speck), Function(penumbra)}) {
        const Means means = estimate(f, by_neighbours, num_tiles);
        EXPECT_LT(worst_bias(f, means), significant);
        EXPECT_GT(means.samples, settings.least) << "some pixels are worth more";
        EXPECT_LT(means.samples, settings.most / 2) << "most are not";
    }
}

TEST(Adaptive, DecidingByThePixelsOwnSamplesWouldBeSeen) {
    const Function f = bright_speck;
    EXPECT_GT(worst_bias(f, estimate(f, by_own_samples, num_tiles)), 2 * significant);
}

TEST(Adaptive, NoQuarterDecidesAboutItself) {
    const Sampler sampler = adaptive_sampler();
    const PixelRange tile = trace::tile_at(0, 0);
    SampleBlock block;
    sampler.fill_firsts(tile, block);
    const std::vector<Sample> firsts = samples_of(block, edge);
    std::vector<std::uint16_t> before, after;
    by_neighbours(tile, firsts, before);
    for (std::size_t quarter = 0; quarter < before.size(); ++quarter) {
        std::vector<Sample> changed = firsts;
        changed[quarter].color[0] = 1 - changed[quarter].color[0];
        by_neighbours(tile, changed, after);
        EXPECT_EQ(before[quarter], after[quarter]) << quarter;
    }
}

TEST(Adaptive, APartOfATileGetsTheSameCounts) {
    const Sampler sampler = adaptive_sampler();
    const PixelRange tiles{-1, 0, 32, 32}, part{9, 3, 27, 20};
    SampleBlock block;
    sampler.fill_firsts(tiles, block);
    for (std::int32_t& px : block.px) {
        px += block_px; // of the left neighbour, too
    }
    const std::vector<Sample> firsts = samples_of(block, edge);
    const rib::Options options;
    Adaptive adaptive(settings, options);
    std::vector<std::uint16_t> all, some;
    adaptive.decide(tiles, firsts, tiles, all);
    adaptive.decide(tiles, firsts, part, some);
    for (std::size_t i = 0; i < some.size(); ++i) {
        const int pixel = static_cast<int>(i / trace::quarters);
        const int x = part.x0 + pixel % part.width(), y = part.y0 + pixel / part.width();
        const auto in_all = static_cast<std::size_t>((y - tiles.y0) * tiles.width() + x - tiles.x0);
        EXPECT_EQ(some[i], all[in_all * trace::quarters + i % trace::quarters]);
    }
}

TEST(Adaptive, OptionsSayHowManySamples) {
    rib::Options options;
    EXPECT_FALSE(trace::adaptive_settings(options, 16).is_on()) << "nobody asked";
    options.pixel_variance = 0.01f;
    EXPECT_EQ(trace::adaptive_settings(options, 16).least, 4);
    EXPECT_EQ(trace::adaptive_settings(options, 16).most, 16) << "PixelSamples";
    EXPECT_FALSE(trace::adaptive_settings(options, 4).is_on()) << "nothing to choose";
    options.user["render:maxsamples"].ints = {64};
    options.user["render:minsamples"].ints = {0};
    EXPECT_EQ(trace::adaptive_settings(options, 4).most, 64);
    EXPECT_EQ(trace::adaptive_settings(options, 4).least, 4) << "one for every quarter";
    options.user["render:maxsamples"].ints = {1 << 30};
    EXPECT_EQ(trace::adaptive_settings(options, 4).most, 4096);
}

TEST(Adaptive, PixelsCountByTheirArea) {
    std::FILE* null = std::fopen("/dev/null", "w");
    base::Diag diag(null);
    rib::Scene scene;
    scene.options.xres = 2;
    scene.options.yres = 1;
    const trace::Camera camera(scene, diag);
    const Sampler sampler = adaptive_sampler();
    // Wide enough for every sample of the neighbours: a pixel is the mean of nine.
    const trace::FilterWeights weights(trace::Filter("box", 3, 3, diag), sampler);
    const auto film = trace::Film::create(camera.raster(), sampler, weights, {}, diag);
    ASSERT_EQ(film->num_buckets(), 1U);
    const PixelRange pixels = film->sample_pixels(0);
    std::vector<std::uint16_t> counts;
    for (std::size_t i = 0; i < pixels.area() * trace::quarters; ++i) {
        counts.push_back(static_cast<std::uint16_t>(1 + i % 7));
    }
    trace::SampleBuffer samples = film->buffer(0, counts);
    for (std::size_t i = 0; i < pixels.area(); ++i) {
        const auto [first, count] = samples.part(i);
        ASSERT_EQ(count, counts[4 * i] + counts[4 * i + 1] + counts[4 * i + 2] + counts[4 * i + 3]);
        for (std::size_t s = first; s < first + count; ++s) {
            samples.samples[s].color[0] = static_cast<float>(i);
        }
    }
    film->submit(0, std::move(samples));
    const auto red = film->image().plane(trace::Plane::R);
    EXPECT_NEAR(red[0], 5, 1e-5) << "the mean of 0 1 2, 4 5 6, 8 9 10";
    EXPECT_NEAR(red[1], 6, 1e-5);
    std::fclose(null);
}

TEST(Progressive, AnyFirstFewAreSpread) {
    for (std::uint32_t seed = 0; seed < 50; ++seed) {
        for (std::uint32_t n = 1; n <= 256; n *= 4) {
            const auto side = static_cast<float>(std::lround(std::sqrt(n)));
            std::set<int> cells, columns, shuffled;
            for (std::uint32_t i = 0; i < n; ++i) {
                const trace::UnitPoint p = trace::progressive_point(i, seed);
                cells.insert(static_cast<int>(p.y * side) * 1000 + static_cast<int>(p.x * side));
                columns.insert(static_cast<int>(p.x * static_cast<float>(n)));
                shuffled.insert(
                    static_cast<int>(trace::shuffled_point(i, seed).x * static_cast<float>(n)));
            }
            EXPECT_EQ(cells.size(), n);
            EXPECT_EQ(columns.size(), n);
            EXPECT_EQ(shuffled.size(), n);
        }
    }
}

} // namespace
