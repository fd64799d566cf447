// SPDX-License-Identifier: Apache-2.0
// How many samples each quarter of a pixel gets (PixelVariance). Every one gets the same first few;
// how many more is decided from the first samples of its *neighbours*, never from its own: so the
// number of samples is independent of what they see, and every mean stays unbiased ([Kirk91] shows
// what happens otherwise).
//
// In: the first samples of whole tiles of the frame. Out: counts. Neighbours across the border of a
// tile are not asked: so no bucket or crop window has an influence.
#pragma once

#include "ribtools/scene.h"
#include "tracer/film.h"
#include "tracer/pixel_range.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace trace {

struct AdaptiveSettings {
    float variance = 0;      // of a pixel's value that is tolerated
    int least = 0, most = 0; // samples per pixel, multiples of four
    [[nodiscard]] bool is_on() const { return variance > 0 && least < most; }
};
// PixelVariance; Option "render", or Hider, "minsamples" and "maxsamples". per_pixel: what
// PixelSamples asks for, the most where nothing else is said.
[[nodiscard]] AdaptiveSettings adaptive_settings(const rib::Options& options, int per_pixel);

class Adaptive {
public:
    Adaptive(const AdaptiveSettings& settings, const rib::Options& options);

    // firsts: settings.least samples of every pixel of `tiles`, quarter by quarter. counts: of the
    // quarters of the pixels of `wanted`, which `tiles` contains.
    void decide(const PixelRange& tiles, std::span<const Sample> firsts, const PixelRange& wanted,
                std::vector<std::uint16_t>& counts);

private:
    static constexpr std::size_t channels = 4;
    using Values = std::array<float, channels>;
    // What the first samples of a quarter say.
    struct Estimate {
        Values mean;
        float variance; // of one sample; the largest of the channels
    };
    [[nodiscard]] Estimate estimate(std::span<const Sample> samples) const;
    [[nodiscard]] Values shown(const Sample& sample) const;
    void make_estimates(std::span<const Sample> firsts);
    // Quarters are numbered through: x = 2 * pixel + 0 or 1.
    [[nodiscard]] float expected_variance(int x, int y) const;
    [[nodiscard]] const Estimate* at(const PixelRange& tile, int x, int y) const;

    AdaptiveSettings settings_;
    float gain_, power_; // Exposure: errors are those of the picture that is seen
    PixelRange pixels_;
    std::vector<Estimate> estimates_;
};

} // namespace trace
