// SPDX-License-Identifier: Apache-2.0
#include "tracer/quantize.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace trace {

namespace {

struct StorageRange {
    Storage storage;
    double min, max;
};
// Smallest first; unsigned before signed.
constexpr StorageRange storage_ranges[] = {
    {Storage::U8, 0, 255},           {Storage::S8, -128, 127},
    {Storage::U16, 0, 65535},        {Storage::S16, -32768, 32767},
    {Storage::U32, 0, 4294967295.0}, {Storage::S32, -2147483648.0, 2147483647.0},
};

const StorageRange& range_for(double min, double max) {
    for (const StorageRange& r : storage_ranges) {
        if (max <= r.max && (min < 0) == (r.min < 0) && min >= r.min) {
            return r;
        }
    }
    return min < 0 ? storage_ranges[5] : storage_ranges[4];
}

float positive_or(float value, float fallback) {
    return value > 0 && std::isfinite(value) ? value : fallback;
}

} // namespace

Exposure exposure_of(const rib::Options& options, const rib::Display& display) {
    Exposure e{options.gain, options.gamma};
    if (const rib::Param* both = display.params.find("exposure");
        both != nullptr && both->floats.size() >= 2) {
        e = {both->floats[0], both->floats[1]};
    }
    e.gain = display.params.get_float("gain", e.gain);
    e.gamma = positive_or(display.params.get_float("gamma", e.gamma), 1);
    return e;
}

void apply_exposure(Image& image, const Exposure& exposure) {
    if (exposure == Exposure{}) {
        return;
    }
    const float power = 1 / positive_or(exposure.gamma, 1);
    for (const Plane p : {Plane::R, Plane::G, Plane::B}) {
        for (float& c : image.plane(p)) {
            c *= exposure.gain;
            if (power != 1) {
                c = std::copysign(std::pow(std::fabs(c), power), c);
            }
        }
    }
}

Storage storage_for(double min, double max) {
    return range_for(min, max).storage;
}

int storage_bytes(Storage storage) {
    switch (storage) {
    case Storage::U8:
    case Storage::S8:
        return 1;
    case Storage::U16:
    case Storage::S16:
        return 2;
    case Storage::U32:
    case Storage::S32:
    case Storage::Float:
        return 4;
    }
    return 4;
}

bool storage_signed(Storage storage) {
    return storage == Storage::S8 || storage == Storage::S16 || storage == Storage::S32;
}

Storage Quantizer::storage() const {
    return one == 0 ? Storage::Float : storage_for(std::min(min, max), std::max(min, max));
}

std::int64_t Quantizer::apply(float value, float noise) const {
    const double v = std::isnan(value) ? 0 : static_cast<double>(value);
    const StorageRange& r = range_for(std::min(min, max), std::max(min, max));
    const double low = std::max(std::min(min, max), r.min);
    const double high = std::min(std::max(min, max), r.max);
    const double level = zero + v * (one - zero) + dither * static_cast<double>(noise);
    return static_cast<std::int64_t>(std::floor(std::clamp(level, low, high) + 0.5));
}

Quantizer quantizer(const rib::Quantize& q) {
    const auto number = [](float x) { return std::isfinite(x) ? static_cast<double>(x) : 0.0; };
    return {0, number(q.one), number(q.min), number(q.max), number(q.dither)};
}

float dither_noise(int px, int py, int channel) {
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
