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
    return exposure_over({options.gain, options.gamma}, display.params, {});
}

Exposure exposure_over(Exposure base, const rib::ParamList& first, const rib::ParamList& second) {
    Exposure e = base;
    for (const rib::ParamList* params : {&second, &first}) {
        if (const std::vector<float> both = params->get_numbers("exposure"); both.size() >= 2) {
            e = {both[0], both[1]};
        }
        e.gain = params->get_float("gain", e.gain);
        e.gamma = params->get_float("gamma", e.gamma);
    }
    e.gamma = positive_or(e.gamma, 1);
    return e;
}

Exposer::Exposer(const Exposure& exposure)
    : gain_(exposure.gain), power_(1 / positive_or(exposure.gamma, 1)) {}

void apply_exposure(Image& image, const Exposure& exposure) {
    if (exposure == Exposure{}) {
        return;
    }
    const Exposer exposed(exposure);
    for (const Plane p : {Plane::R, Plane::G, Plane::B}) {
        for (float& c : image.plane(p)) {
            c = exposed(c);
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

Levels::Levels(const Quantizer& q)
    : zero_(q.zero), scale_(q.one - q.zero), dither_(q.dither), low_(std::min(q.min, q.max)),
      high_(std::max(q.min, q.max)) {
    const StorageRange& r = range_for(low_, high_);
    low_ = std::max(low_, r.min);
    high_ = std::min(high_, r.max);
}

Quantizer quantizer(const rib::Quantize& q) {
    const auto number = [](float x) { return std::isfinite(x) ? static_cast<double>(x) : 0.0; };
    return {0, number(q.one), number(q.min), number(q.max), number(q.dither)};
}

} // namespace trace
