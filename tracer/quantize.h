// SPDX-License-Identifier: Apache-2.0
// Exposure and quantisation (ri.md 9.4, 9.5).
// Order of the pipeline: film -> apply_exposure -> imager -> Quantizer (in the display). Depth is
// not exposed.
#pragma once

#include "ribtools/scene.h"
#include "tracer/film.h"

#include <cmath>
#include <cstdint>

namespace trace {

struct Exposure {
    float gain = 1, gamma = 1;
    friend bool operator==(const Exposure&, const Exposure&) = default;
};

// Options with the display's own "exposure", "gain", "gamma" over them. Displays that differ here
// need their own copy of the picture, exposed and run through the imager.
[[nodiscard]] Exposure exposure_of(const rib::Options& options, const rib::Display& display);
// An exposure with the "exposure", "gain" and "gamma" of one list over it; those of `first` come
// before.
[[nodiscard]] Exposure exposure_over(Exposure base, const rib::ParamList& first,
                                     const rib::ParamList& second);
// (color gain)^(1/gamma); negative values keep their sign. gamma <= 0 counts as 1.
class Exposer {
public:
    explicit Exposer(const Exposure& exposure);
    [[nodiscard]] float operator()(float color) const {
        const float c = color * gain_;
        return power_ == 1 ? c : std::copysign(std::pow(std::fabs(c), power_), c);
    }

private:
    float gain_, power_;
};
// The same on R G B of a picture.
void apply_exposure(Image& image, const Exposure& exposure);

enum class Storage : std::uint8_t { U8, S8, U16, S16, U32, S32, Float };
// The smallest type that holds min..max; signed if min is negative.
[[nodiscard]] Storage storage_for(double min, double max);
[[nodiscard]] int storage_bytes(Storage storage);
[[nodiscard]] bool storage_signed(Storage storage);

struct Quantizer {
    double zero = 0, one = 255, min = 0, max = 255, dither = 0.5;

    // one = 0: Float.
    [[nodiscard]] Storage storage() const;
};

// A quantizer made ready for many values.
class Levels {
public:
    explicit Levels(const Quantizer& quantizer);
    // round(zero + value (one - zero) + dither noise), clamped to min..max and to the storage type.
    // noise in [-1, 1); NaN counts as 0. Not for Float.
    [[nodiscard]] std::int64_t operator()(float value, float noise) const {
        const double v = value == value ? static_cast<double>(value) : 0;
        const double level = zero_ + v * scale_ + dither_ * static_cast<double>(noise);
        // Written so that a NaN (infinity times 0) ends at the lowest level.
        const double clamped = level > low_ ? (level < high_ ? level : high_) : low_;
        const double shifted = clamped + 0.5;
        const auto truncated = static_cast<std::int64_t>(shifted);
        return truncated - (shifted < static_cast<double>(truncated) ? 1 : 0); // floor
    }

private:
    double zero_, scale_, dither_, low_, high_;
};
[[nodiscard]] Quantizer quantizer(const rib::Quantize& options);

// Uniform in [-1, 1): a pure function of the pixel in the whole frame and the channel.
[[nodiscard]] inline float dither_noise(int px, int py, int channel) {
    // The finaliser of SplitMix64, a bijection of the pixel with full avalanche.
    std::uint64_t h = (static_cast<std::uint64_t>(static_cast<std::uint32_t>(px)) << 32) |
                      static_cast<std::uint32_t>(py);
    h ^= static_cast<std::uint64_t>(static_cast<std::uint32_t>(channel) + 1U) *
         0x9e3779b97f4a7c15ULL;
    h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9ULL;
    h = (h ^ (h >> 27)) * 0x94d049bb133111ebULL;
    h ^= h >> 31;
    return static_cast<float>(h >> 40) * 0x1p-23f - 1.0f;
}

} // namespace trace
