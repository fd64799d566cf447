// SPDX-License-Identifier: Apache-2.0
#include "tracer/adaptive.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace trace {

namespace {

constexpr int default_least = 4;
constexpr int max_per_pixel = 4096;
// A step somewhere between two neighbours that lie opposite, or a ramp, has this part of the square
// of their difference as variance in between (a step right there: a quarter).
constexpr float of_step = 1.0f / 12;
// The same for the largest difference among all neighbours: thin things pass through without
// making opposite ones differ.
constexpr float of_range = 1.0f / 48;

int multiple_of_quarters(int n) {
    return (n + quarters - 1) / quarters * quarters;
}

// Integer parameters may come as floats.
int int_of(const rib::Param* p, int fallback) {
    if (p == nullptr) {
        return fallback;
    }
    const double value = !p->ints.empty()     ? static_cast<double>(p->ints[0])
                         : !p->floats.empty() ? static_cast<double>(p->floats[0])
                                              : static_cast<double>(fallback);
    return std::isfinite(value) ? static_cast<int>(std::clamp(value, 0.0, double{max_per_pixel}))
                                : fallback;
}

int limit(const rib::Options& options, const char* option, const char* hider, int fallback) {
    const auto it = options.user.find(option);
    const rib::Param* p = it != options.user.end() ? &it->second : options.hider_params.find(hider);
    return int_of(p, fallback);
}

} // namespace

AdaptiveSettings adaptive_settings(const rib::Options& options, int per_pixel) {
    AdaptiveSettings s;
    if (!(options.pixel_variance > 0)) {
        return s;
    }
    s.variance = options.pixel_variance;
    s.most = multiple_of_quarters(limit(options, "render:maxsamples", "maxsamples", per_pixel));
    s.least = multiple_of_quarters(
        std::max(limit(options, "render:minsamples", "minsamples", default_least), 1));
    return s;
}

Adaptive::Adaptive(const AdaptiveSettings& settings, const rib::Options& options)
    : settings_(settings), gain_(options.gain > 0 ? options.gain : 1),
      power_(options.gamma > 0 ? 1 / options.gamma : 1) {}

// As it is seen; what is no number counts as nothing, as in the film.
Adaptive::Values Adaptive::shown(const Sample& sample) const {
    const float alpha = (sample.opacity[0] + sample.opacity[1] + sample.opacity[2]) / 3;
    Values v = {sample.color[0] * gain_, sample.color[1] * gain_, sample.color[2] * gain_, alpha};
    for (std::size_t c = 0; c < channels; ++c) {
        v[c] = v[c] > 0 ? std::min(v[c], 1.0f) : 0;
        v[c] = power_ == 1 || c == 3 ? v[c] : std::pow(v[c], power_);
    }
    return v;
}

Adaptive::Estimate Adaptive::estimate(std::span<const Sample> samples) const {
    if (samples.size() == 1) {
        return {shown(samples[0]), 0};
    }
    std::array<double, channels> sum{}, squares{};
    for (const Sample& sample : samples) {
        const Values v = shown(sample);
        for (std::size_t c = 0; c < channels; ++c) {
            sum[c] += static_cast<double>(v[c]);
            squares[c] += static_cast<double>(v[c]) * static_cast<double>(v[c]);
        }
    }
    Estimate out{};
    const auto n = static_cast<double>(samples.size());
    for (std::size_t c = 0; c < channels; ++c) {
        const double mean = sum[c] / n;
        out.mean[c] = static_cast<float>(mean);
        out.variance =
            std::max(out.variance, static_cast<float>((squares[c] - n * mean * mean) / (n - 1)));
    }
    return out;
}

void Adaptive::make_estimates(std::span<const Sample> firsts) {
    const auto each = static_cast<std::size_t>(settings_.least / quarters);
    const auto width = 2 * static_cast<std::size_t>(pixels_.width());
    estimates_.resize(pixels_.area() * quarters);
    std::size_t from = 0;
    for (std::size_t pixel = 0; pixel < pixels_.area(); ++pixel) {
        const std::size_t x = 2 * (pixel % (width / 2)), y = 2 * (pixel / (width / 2));
        for (std::size_t q = 0; q < quarters; ++q, from += each) {
            estimates_[(y + q / 2) * width + x + q % 2] = estimate(firsts.subspan(from, each));
        }
    }
}

// Null: another tile.
const Adaptive::Estimate* Adaptive::at(const PixelRange& tile, int x, int y) const {
    const int px = x >> 1, py = y >> 1;
    if (!tile.contains(px, py)) {
        return nullptr;
    }
    return &estimates_[static_cast<std::size_t>(y - 2 * pixels_.y0) *
                           static_cast<std::size_t>(2 * pixels_.width()) +
                       static_cast<std::size_t>(x - 2 * pixels_.x0)];
}

// Of one sample of a quarter, from its up to eight neighbours in the tile.
float Adaptive::expected_variance(int x, int y) const {
    constexpr int half[4][2] = {{1, 0}, {0, 1}, {1, 1}, {1, -1}};
    const PixelRange tile = tile_at(x >> 1, y >> 1).intersected(pixels_);
    Values low, high;
    low.fill(1);
    high.fill(0);
    float expected = 0;
    for (const auto& [dx, dy] : half) {
        const Estimate* a = at(tile, x + dx, y + dy);
        const Estimate* b = at(tile, x - dx, y - dy);
        for (const Estimate* e : {a, b}) {
            for (std::size_t c = 0; e != nullptr && c < channels; ++c) {
                low[c] = std::min(low[c], e->mean[c]);
                high[c] = std::max(high[c], e->mean[c]);
            }
        }
        if (a == nullptr || b == nullptr) { // the tile ends here: the other side is unknown
            const Estimate* one = a != nullptr ? a : b;
            expected = std::max(expected, one != nullptr ? one->variance / 2 : 0);
            continue;
        }
        expected = std::max(expected, std::min(a->variance, b->variance));
        for (std::size_t c = 0; c < channels; ++c) {
            const float step = a->mean[c] - b->mean[c];
            expected = std::max(expected, of_step * step * step);
        }
    }
    for (std::size_t c = 0; c < channels; ++c) {
        const float range = high[c] - low[c];
        expected = std::max(expected, range > 0 ? of_range * range * range : 0);
    }
    return expected;
}

void Adaptive::decide(const PixelRange& tiles, std::span<const Sample> firsts,
                      const PixelRange& wanted, std::vector<std::uint16_t>& counts) {
    pixels_ = tiles;
    make_estimates(firsts);
    counts.clear();
    const int least = settings_.least / quarters, most = settings_.most / quarters;
    for (int y = wanted.y0; y < wanted.y1; ++y) {
        for (int x = wanted.x0; x < wanted.x1; ++x) {
            for (int q = 0; q < quarters; ++q) {
                // The variance of the pixel is a quarter of that of its quarters.
                const float needed = expected_variance(2 * x + q % 2, 2 * y + q / 2) /
                                     (settings_.variance * quarters);
                const auto n = static_cast<unsigned>(
                    std::ceil(std::clamp(needed, 1.0f, static_cast<float>(most))));
                // Powers of two are the best spread.
                counts.push_back(static_cast<std::uint16_t>(
                    std::clamp(static_cast<int>(std::bit_ceil(n)), least, most)));
            }
        }
    }
}

} // namespace trace
