// SPDX-License-Identifier: Apache-2.0
// Exposure and quantisation (ri.md 9.4, 9.5).
// Order of the pipeline: film -> apply_exposure -> imager -> Quantizer (in the display). Depth is
// not exposed.
#pragma once

#include "ribtools/scene.h"
#include "tracer/film.h"

#include <cstdint>

namespace trace {

struct Exposure {
    float gain = 1, gamma = 1;
    friend bool operator==(const Exposure&, const Exposure&) = default;
};

// Options with the display's own "exposure", "gain", "gamma" over them. Displays that differ here
// need their own copy of the picture, exposed and run through the imager.
[[nodiscard]] Exposure exposure_of(const rib::Options& options, const rib::Display& display);
// color = (color gain)^(1/gamma) on R G B; negative values keep their sign. gamma <= 0 counts as 1.
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
    // round(zero + value (one - zero) + dither noise), clamped to min..max and to the storage type.
    // noise in [-1, 1); NaN counts as 0. Not for Float.
    [[nodiscard]] std::int64_t apply(float value, float noise) const;
};
[[nodiscard]] Quantizer quantizer(const rib::Quantize& options);

// Uniform in [-1, 1): a pure function of the pixel in the whole frame and the channel.
[[nodiscard]] float dither_noise(int px, int py, int channel);

} // namespace trace
