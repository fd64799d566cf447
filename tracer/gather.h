// SPDX-License-Identifier: Apache-2.0
// Filters the pixels of one bucket: pixel = sum f sample / sum f over its neighbourhood (ri.md 9).
// In: the sample buffers of the bucket and its neighbours. Out: planes of the image. Every pixel
// takes its samples in one order, row by row, which no bucket or thread can change. Per-pixel work:
// plain pointers and four-float registers.
#pragma once

#include "tracer/film.h"

#include <cstdint>
#include <vector>

namespace trace {

class Gather {
public:
    Gather(const Sampler& sampler, const FilterWeights& weights, const FilmSettings& settings,
           const PixelRange& output);

    // Samples of pixels in reach of the output; the buffer must live until run() is done.
    void add(const SampleBuffer& buffer);
    // Computes every output pixel. Returns how many of its own samples were not finite.
    std::uint64_t run(Image& image) const;

private:
    // The samples of one pixel.
    struct Source {
        const Sample* samples = nullptr;
        const float* extra = nullptr;
        std::size_t slot = 0; // of the pattern's first neighbour in the tables of weights
    };
    struct Sum;
    struct Row;

    void add_row(const SampleBuffer& buffer, int y, int x0, int x1);
    template <class Body> void for_samples(const Source* own, const Body& body) const;
    [[nodiscard]] Sum filtered(const Source* own) const;
    [[nodiscard]] Sum careful(const Source* own, bool plain) const;
    // Pixel x of the row; `at` is its place in the image, for the extra channels.
    [[nodiscard]] std::uint64_t pixel(const Source* own, Row& row, std::size_t x, Image& image,
                                      std::size_t at) const;
    [[nodiscard]] float depth(const Source& own) const;
    [[nodiscard]] float extra_channel(const Source* own, std::size_t channel, bool plain) const;

    const Sampler& sampler_;
    const FilterWeights& weights_;
    const FilmSettings& settings_;
    PixelRange output_, pixels_;       // computed; looked at
    std::size_t width_, per_pixel_;    // of pixels_; samples
    std::vector<Source> sources_;      // of pixels_, row by row
    std::vector<std::ptrdiff_t> near_; // offsets of the neighbourhood in sources_, row by row
};

} // namespace trace
