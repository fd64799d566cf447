// SPDX-License-Identifier: Apache-2.0
#include "tracer/adaptive.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace trace {

namespace {

constexpr int default_least = 4;
constexpr int max_per_pixel = 4096;
// An edge through a pixel passes two of its neighbours that lie opposite; where only others have
// variance it may still end here or turn, which is worth this share.
constexpr float share_of_others = 0.25f;

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
    s.most = limit(options, "render:maxsamples", "maxsamples", per_pixel);
    // Two samples are the fewest that tell a variance.
    s.least = std::max(2, limit(options, "render:minsamples", "minsamples", default_least));
    return s;
}

Adaptive::Adaptive(const AdaptiveSettings& settings, const rib::Options& options)
    : settings_(settings), gain_(options.gain > 0 ? options.gain : 1),
      power_(options.gamma > 0 ? 1 / options.gamma : 1) {}

Adaptive::Estimate Adaptive::estimate(std::span<const Sample> samples) const {
    std::array<double, channels> sum{}, squares{};
    for (const Sample& sample : samples) {
        const float alpha = (sample.opacity[0] + sample.opacity[1] + sample.opacity[2]) / 3;
        const float values[channels] = {sample.color[0] * gain_, sample.color[1] * gain_,
                                        sample.color[2] * gain_, alpha};
        for (std::size_t c = 0; c < channels; ++c) {
            // As it is shown; what is no number counts as nothing, as in the film.
            float v = values[c] > 0 ? std::min(values[c], 1.0f) : 0;
            v = power_ == 1 || c == 3 ? v : std::pow(v, power_);
            sum[c] += static_cast<double>(v);
            squares[c] += static_cast<double>(v) * static_cast<double>(v);
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

// Of a sample of pixel (x, y), from its up to eight neighbours in the tile.
float Adaptive::expected_variance(const PixelRange& tile, int x, int y) const {
    constexpr int half[4][2] = {{1, 0}, {0, 1}, {1, 1}, {1, -1}};
    float across = 0, sum = 0;
    int count = 0;
    for (const auto& [dx, dy] : half) {
        const bool has_a = tile.contains(x + dx, y + dy), has_b = tile.contains(x - dx, y - dy);
        const Estimate* a = has_a ? &at(x + dx, y + dy) : nullptr;
        const Estimate* b = has_b ? &at(x - dx, y - dy) : nullptr;
        sum += (has_a ? a->variance : 0) + (has_b ? b->variance : 0);
        count += (has_a ? 1 : 0) + (has_b ? 1 : 0);
        if (has_a && has_b) {
            across = std::max(across, std::min(a->variance, b->variance));
            for (std::size_t c = 0; c < channels; ++c) { // a ramp from a to b, its part in here
                const float ramp = (a->mean[c] - b->mean[c]) / 2;
                across = std::max(across, ramp * ramp / 12);
            }
        } else if (has_a || has_b) { // the tile ends here: the other side is unknown
            across = std::max(across, (has_a ? a : b)->variance / 2);
        }
    }
    const float mean = count > 0 ? sum / static_cast<float>(count) : 0;
    return std::max(across, share_of_others * mean);
}

void Adaptive::decide(const PixelRange& tiles, std::span<const Sample> firsts,
                      const PixelRange& wanted, std::vector<std::uint16_t>& counts) {
    pixels_ = tiles;
    const auto least = static_cast<std::size_t>(settings_.least);
    estimates_.resize(tiles.area());
    for (std::size_t i = 0; i < estimates_.size(); ++i) {
        estimates_[i] = estimate(firsts.subspan(i * least, least));
    }
    counts.clear();
    for (int y = wanted.y0; y < wanted.y1; ++y) {
        for (int x = wanted.x0; x < wanted.x1; ++x) {
            const PixelRange tile = tile_at(x, y).intersected(tiles);
            const float needed = expected_variance(tile, x, y) / settings_.variance;
            const auto most = static_cast<float>(settings_.most);
            const auto n = static_cast<unsigned>(std::clamp(needed, 1.0f, most));
            // Powers of two are the best spread.
            counts.push_back(static_cast<std::uint16_t>(
                std::clamp(static_cast<int>(std::bit_ceil(n)), settings_.least, settings_.most)));
        }
    }
}

} // namespace trace
