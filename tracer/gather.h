// SPDX-License-Identifier: Apache-2.0
// Filters the pixels of one bucket: pixel = sum f sample / sum f over its neighbourhood (ri.md 9).
// In: the sample buffers of the bucket and its neighbours. Out: planes of the image. Every pixel
// takes its samples in one order, row by row, which no bucket or thread can change. Per-pixel work:
// plain pointers and four-float registers.
#pragma once

#include "tracer/film.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace trace {

class Gather {
public:
    Gather(const Sampler& sampler, const FilterWeights& weights,
           std::span<const ExtraChannel> extra, DepthFilter depth, const PixelRange& output);

    // Samples of pixels in reach of the output; the buffer must live until run() is done.
    void add(const SampleBuffer& buffer);
    // Computes every output pixel. Returns how many of its own samples were not finite.
    std::uint64_t run(Image& image) const;

private:
    // The samples of one pixel.
    struct Source {
        const Sample* samples = nullptr;
        const float* extra = nullptr;
        std::uint32_t slot = 0; // in the weights of reach_: pattern of the sampler times neighbours
        std::uint32_t count = 0;
        const std::uint32_t* begins = nullptr; // of its quarters; null: it has all samples
    };
    // A filter and where the pixels in its reach lie: offsets in sources_, row by row.
    struct Reach {
        const FilterWeights* weights;
        std::vector<std::ptrdiff_t> near;
    };
    // Neighbouring extra channels that are computed alike.
    struct Run {
        std::size_t first, count;
        ExtraChannel how;
        Reach reach;
    };
    struct Sum;
    struct Row;

    [[nodiscard]] Reach reach_of(const FilterWeights& weights) const;
    void make_runs();
    void make_mean_weights();
    void add_row(const SampleBuffer& buffer, int y, int x0, int x1);
    template <class Body>
    void for_quarters(const Source& source, std::size_t near, const float* weights,
                      const Body& body) const;
    template <class Body>
    void for_samples(const Source* own, const Reach& reach, const Body& body) const;
    [[nodiscard]] Sum filtered(const Source* own) const;
    [[nodiscard]] Sum careful(const Source* own, bool plain) const;
    [[nodiscard]] std::uint64_t pixel(const Source* own, Row& row, std::size_t x) const;
    [[nodiscard]] float depth(const Source& own) const;
    // Extra channels: gather_extra.cpp. out: a value per channel of the run.
    void extra_values(const Source* own, const Run& run, float* out) const;
    void means(const Source* own, const Run& run, float* out) const;
    template <class Clean> // of each value. False: a mean is not finite
    [[nodiscard]] bool try_means(const Source* own, const Run& run, bool plain, float* out,
                                 const Clean& clean) const;
    void covered_means(const Source* own, const Run& run, float* out) const;
    void extremes(const Source* own, const Run& run, float* out) const;
    void outermost(const Source* own, const Run& run, float* out) const;

    const Sampler& sampler_;
    std::span<const ExtraChannel> extra_;
    DepthFilter depth_;
    PixelRange output_, pixels_;                  // computed; looked at
    std::size_t width_, per_pixel_, per_quarter_; // of pixels_; samples at most
    std::vector<Source> sources_;                 // of pixels_, row by row
    Reach reach_;
    std::vector<Run> runs_;
    std::vector<float> mean_weights_; // adaptive: of the picture's filter, [neighbour][quarter]
};

// Calls body(source, sample, weight) for all samples in reach, in the one order there is.
template <class Body>
void Gather::for_samples(const Source* own, const Reach& reach, const Body& body) const {
    const FilterWeights& weights = *reach.weights;
    const std::size_t num_near = reach.near.size();
    for (std::size_t k = 0; k < num_near; ++k) {
        const Source& source = own[reach.near[k]];
        const std::size_t first =
            &reach == &reach_ ? source.slot : source.slot / reach_.near.size() * num_near;
        const std::size_t slot = first + k;
        const FilterWeights::Span span = weights.span(slot);
        const float* w = weights.weights(slot);
        if (source.begins != nullptr) {
            for_quarters(source, &reach == &reach_ ? k : num_near, w, body);
            continue;
        }
        for (std::size_t s = span.first; s < span.last; ++s) {
            body(source, s, w[s]);
        }
    }
}

// A quarter counts by what the filter has there, however many samples it has: few samples meet the
// filter's mean by chance only, and the picture would show it at every edge (film-012).
template <class Body>
void Gather::for_quarters(const Source& source, std::size_t near, const float* weights,
                          const Body& body) const {
    std::size_t s = 0;
    for (std::size_t q = 0; q < quarters; ++q, weights += per_quarter_) {
        const std::size_t count = source.begins[q + 1] - source.begins[q];
        const float density = static_cast<float>(per_quarter_) / static_cast<float>(count);
        float missing = 0;
        if (near < mean_weights_.size() / quarters) {
            float sum = 0;
            for (std::size_t k = 0; k < count; ++k) {
                sum += weights[k];
            }
            missing = mean_weights_[near * quarters + q] - sum / static_cast<float>(count);
        }
        for (std::size_t k = 0; k < count; ++k, ++s) {
            body(source, s, (weights[k] + missing) * density);
        }
    }
}

} // namespace trace
