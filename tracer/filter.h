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

#include <span>
#include <string_view>
#include <vector>

namespace trace {

struct FilterRow; // one row of the table of filters

class Filter {
public:
    // Unknown names and impossible widths are reported; the default (gaussian 2 2) or a clamped
    // width is used.
    Filter(std::string_view name, float width_x_px, float width_y_px, base::Diag& diag);

    [[nodiscard]] std::string_view name() const;
    [[nodiscard]] double width_x() const { return width_x_; }
    [[nodiscard]] double width_y() const { return width_y_; }
    // x, y relative to the pixel centre, pixels.
    [[nodiscard]] double value(double x_px, double y_px) const;
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
    // Weights of the samples of a pixel with this pattern for the pixel (dx, dy) *pixels before*
    // it: the sample's pixel is at output pixel + (dx, dy). per_pixel values.
    [[nodiscard]] std::span<const float> weights(std::size_t pattern, int dx, int dy) const;

private:
    int reach_x_, reach_y_, per_pixel_;
    std::vector<float> weights_; // [pattern][dy][dx][sample]
};

} // namespace trace
