// SPDX-License-Identifier: Apache-2.0
// Pixel filters (ri.md 9.3): the functions by name, and their weights for a sampler's patterns.
//
// In: filter name and full widths in pixels. Out: f(x, y), zero outside |x| <= wx/2, |y| <= wy/2,
// not normalised; weights per (pattern, neighbouring pixel, sample) for the film's gather.
// Evaluated in double.
#pragma once

#include "ribtools/scene.h"
#include "runtime/base/diag.h"
#include "tracer/sampler.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace trace {

struct FilterRow; // one row of the table of filters

class Filter {
public:
    // Unknown names and impossible widths are reported at pos; the default (gaussian 2 2) or a
    // clamped width is used.
    Filter(std::string_view name, float width_x_px, float width_y_px, base::Diag& diag,
           base::SourcePos pos = {});

    [[nodiscard]] std::string_view name() const;
    [[nodiscard]] double width_x() const { return width_x_; }
    [[nodiscard]] double width_y() const { return width_y_; }
    // x, y relative to the pixel centre, pixels.
    [[nodiscard]] double value(double x_px, double y_px) const;
    // The two factors of a separable filter; false if it is not one.
    bool axis_values(double x_px, double y_px, double& fx, double& fy) const;
    // How many pixels beyond its own a pixel takes samples from, along each axis.
    [[nodiscard]] int reach_x() const;
    [[nodiscard]] int reach_y() const;

private:
    const FilterRow* row_;
    double width_x_, width_y_;
};

// Weights of every sample of every pattern for every pixel in reach.
class FilterWeights {
public:
    FilterWeights(const Filter& filter, const Sampler& sampler);

    [[nodiscard]] int reach_x() const { return reach_x_; }
    [[nodiscard]] int reach_y() const { return reach_y_; }
    // Pixels that contribute to one.
    [[nodiscard]] std::size_t neighbours() const {
        return static_cast<std::size_t>(2 * reach_x_ + 1) *
               static_cast<std::size_t>(2 * reach_y_ + 1);
    }
    // Where the weights are not all zero: samples first .. last-1 of the pixel.
    struct Span {
        std::uint16_t first = 0, last = 0;
    };
    // A slot is pattern * neighbours() + neighbour; neighbours are numbered row by row: number
    // (dy + reach_y) * (2 reach_x + 1) + dx + reach_x is the pixel at (dx, dy) from the one being
    // computed, and `pattern` is that of the neighbour.
    [[nodiscard]] Span span(std::size_t slot) const { return spans_[slot]; }
    [[nodiscard]] const float* weights(std::size_t slot) const {
        return weights_.data() + slot * static_cast<std::size_t>(per_pixel_);
    }
    // A sum of weights below this says nothing: 1/1000 of the filter's centre.
    [[nodiscard]] float least_sum() const { return floor_; }

private:
    void fill_sample(const Filter& filter, double x, double y, float* out) const;
    static Span used_span(std::span<const float> weights);

    int reach_x_, reach_y_, per_pixel_;
    float floor_;
    std::vector<Span> spans_;    // [pattern][neighbour]
    std::vector<float> weights_; // [pattern][neighbour][sample]
};

} // namespace trace
