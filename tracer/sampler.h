// SPDX-License-Identifier: Apache-2.0
// Samples of pixels: position in the pixel, time, lens position, seed.
//
// Every value is a pure function of (pixel in the whole frame, sample index, dimension): crop
// windows, buckets and threads have no influence. A dimension is a table of precomputed patterns,
// each a correlated multi-jittered set of nx*ny points ([Kensler13]); a hash of the pixel picks the
// pattern, so that filter weights can be tabulated per pattern (film-002). Immutable; safe from any
// thread.
#pragma once

#include "ribtools/scene.h"
#include "runtime/base/diag.h"
#include "tracer/pixel_range.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace trace {

struct SamplerSettings {
    int nx = 2, ny = 2;
    float jitter = 1; // 0: regular grid; between: part of the way from the centre of the cell
    float shutter_open = 0, shutter_close = 0;
    bool wants_lens = false;
    // Adaptive sampling: what every pixel gets, nx * ny is the most; both are multiples of four. 0:
    // all pixels get them all. Otherwise each quarter of a pixel has a sequence of its own, whose
    // first n are well spread for any n, and which is independent of the others.
    int least = 0;
    std::uint32_t seed = 0; // other samples, as good: for tests and studies
};
// From PixelSamples, PixelVariance, Hider "jitter", Shutter and DepthOfField. Excessive sample
// counts are reported and limited.
[[nodiscard]] SamplerSettings sampler_settings(const rib::Options& options, base::Diag& diag);

// The quarters of a pixel in adaptive sampling: upper left, upper right, lower left, lower right.
// Samples of quarter q are numbered from q * per_pixel / 4 on.
constexpr int quarters = 4;

// Some samples of one pixel.
struct PixelSamples {
    std::int32_t px, py;
    std::uint16_t first, last; // samples first .. last - 1
};

// Samples of pixels, structure of arrays: pixels row by row, samples in index order.
// Arrays are padded to a multiple of eight (padding repeats the last sample).
struct SampleBlock {
    std::size_t count = 0;
    std::vector<std::int32_t> px, py;  // pixel
    std::vector<float> x, y;           // position in the pixel, [0,1)
    std::vector<float> time;           // in [shutter open, close]
    std::vector<float> lens_x, lens_y; // on the unit disc; empty if no lens was asked for
    std::vector<std::uint32_t> seed;   // for random(): differs for every sample of the frame

    [[nodiscard]] std::size_t num_packets() const { return (count + 7) / 8; }
};

// 32 bits of a pixel; everything random about it starts here. The row's part is done once.
class PixelHash {
public:
    explicit PixelHash(int py) : row_(mix(static_cast<std::uint32_t>(py) + 0x85ebca6bU)) {}
    std::uint32_t operator()(int px) const { return mix(static_cast<std::uint32_t>(px) + row_); }

    // A bijection of 32 bits with low bias (C. Wellons' "lowbias32" constants).
    static constexpr std::uint32_t mix(std::uint32_t x) {
        x = (x ^ (x >> 16)) * 0x7feb352dU;
        x = (x ^ (x >> 15)) * 0x846ca68bU;
        return x ^ (x >> 16);
    }

private:
    std::uint32_t row_;
};

class Sampler {
public:
    explicit Sampler(const SamplerSettings& settings);

    [[nodiscard]] const SamplerSettings& settings() const { return settings_; }
    [[nodiscard]] int per_pixel() const { return per_pixel_; }
    [[nodiscard]] int per_quarter() const { return per_pixel_ / quarters; }

    // All samples of a rectangle of pixels. Reuses the block's memory.
    void fill(const PixelRange& pixels, SampleBlock& out) const;
    // Adaptive sampling: those that every pixel gets, quarter by quarter.
    void fill_firsts(const PixelRange& pixels, SampleBlock& out) const;
    // The samples asked for.
    void fill(std::span<const PixelSamples> wanted, SampleBlock& out) const;

    // Positions: pattern of a pixel, by its hash, and the per_pixel() offsets of a pattern.
    [[nodiscard]] std::size_t num_patterns() const { return num_patterns_; }
    [[nodiscard]] std::size_t pattern(std::uint32_t pixel_hash) const {
        return pixel_hash & pattern_mask_;
    }
    [[nodiscard]] std::span<const float> pattern_x(std::size_t pattern) const;
    [[nodiscard]] std::span<const float> pattern_y(std::size_t pattern) const;

private:
    [[nodiscard]] std::span<const float> slice(const std::vector<float>& table,
                                               std::size_t pattern) const;
    void make_stratified(std::size_t pattern);
    void make_progressive(std::size_t pattern);
    template <class Seed>
    void make_progressive_sample(std::uint32_t index, std::uint32_t quarter, std::size_t at,
                                 const Seed& seed);
    [[nodiscard]] std::size_t numbered(std::size_t pattern) const;
    void begin(std::size_t count, SampleBlock& out) const;
    void fill_pixel(std::uint32_t hash, const PixelSamples& wanted, std::size_t at,
                    SampleBlock& out) const;
    static void finish(SampleBlock& out);

    SamplerSettings settings_;
    int per_pixel_ = 4;
    std::size_t num_patterns_ = 1, pattern_mask_ = 0;
    bool moving_ = false;
    std::vector<float> x_, y_, time_, lens_x_, lens_y_; // [pattern][sample]
};

} // namespace trace
