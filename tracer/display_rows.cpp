// SPDX-License-Identifier: Apache-2.0
// Rows of pixels in the storage type of a file: quantised with dither, or floats as they are
// (ri.md 9.5).
#include "tracer/display_format.h"

#include <cstring>

namespace trace {

namespace {

template <class T> void put(std::byte*& at, T value) {
    std::memcpy(at, &value, sizeof value);
    at += sizeof value;
}

void put_level(std::byte*& at, Storage storage, std::int64_t level) {
    switch (storage) {
    case Storage::U8:
        put(at, static_cast<std::uint8_t>(level));
        return;
    case Storage::S8:
        put(at, static_cast<std::int8_t>(level));
        return;
    case Storage::U16:
        put(at, static_cast<std::uint16_t>(level));
        return;
    case Storage::S16:
        put(at, static_cast<std::int16_t>(level));
        return;
    case Storage::U32:
        put(at, static_cast<std::uint32_t>(level));
        return;
    case Storage::S32:
        put(at, static_cast<std::int32_t>(level));
        return;
    case Storage::Float:
        put(at, static_cast<float>(level));
        return;
    }
}

// Color over its alpha; where nothing covers the pixel there is no color to tell.
float unassociated(float color, float alpha) {
    return alpha > 0 ? color / alpha : 0;
}

} // namespace

void quantise_row(const FilePicture& picture, int y, bool alpha_divides, std::span<std::byte> out) {
    const auto width = static_cast<std::size_t>(picture.width());
    const std::size_t first = static_cast<std::size_t>(y) * width;
    const FileChannel* alpha = alpha_divides ? picture.find(ChannelRole::Alpha) : nullptr;
    std::byte* at = out.data();
    for (std::size_t x = 0; x < width; ++x) {
        const int px = picture.pixels.x0 + static_cast<int>(x), py = picture.pixels.y0 + y;
        for (const FileChannel& c : picture.channels) {
            float value = c.values[first + x];
            if (alpha != nullptr && c.role == ChannelRole::Color) {
                value = unassociated(value, alpha->values[first + x]);
            }
            if (picture.storage == Storage::Float) {
                put(at, value);
            } else {
                put_level(at, picture.storage,
                          c.quantizer.apply(value, dither_noise(px, py, c.dither_channel)));
            }
        }
    }
}

} // namespace trace
