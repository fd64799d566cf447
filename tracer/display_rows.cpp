// SPDX-License-Identifier: Apache-2.0
// Rows of pixels in the storage type of a file: quantised with dither, or floats as they are
// (ri.md 9.5).
#include "tracer/display_format.h"

#include <cstring>

namespace trace {

namespace {

template <class T> void put(std::span<std::byte> out, std::size_t index, T value) {
    std::memcpy(out.data() + index * sizeof value, &value, sizeof value);
}

// Color over its alpha; where nothing covers the pixel there is no color to tell.
float unassociated(float color, float alpha) {
    return alpha > 0 ? color / alpha : 0;
}

} // namespace

RowWriter::RowWriter(const FilePicture& picture, bool alpha_divides)
    : picture_(picture), alpha_(alpha_divides ? picture.find(ChannelRole::Alpha) : nullptr) {
    for (const FileChannel& c : picture.channels) {
        levels_.emplace_back(c.quantizer);
    }
}

float RowWriter::value(const FileChannel& channel, std::size_t pixel) const {
    const float v = channel.values[pixel];
    return alpha_ != nullptr && channel.role == ChannelRole::Color
               ? unassociated(v, alpha_->values[pixel])
               : v;
}

template <class T> void RowWriter::put_levels(int y, std::span<std::byte> out) const {
    const auto width = static_cast<std::size_t>(picture_.width());
    const std::size_t first = static_cast<std::size_t>(y) * width, n = levels_.size();
    for (std::size_t c = 0; c < n; ++c) {
        const FileChannel& channel = picture_.channels[c];
        for (std::size_t x = 0; x < width; ++x) {
            const float noise = dither_noise(picture_.pixels.x0 + static_cast<int>(x),
                                             picture_.pixels.y0 + y, channel.dither_channel);
            put(out, x * n + c, static_cast<T>(levels_[c](value(channel, first + x), noise)));
        }
    }
}

void RowWriter::put_floats(int y, std::span<std::byte> out) const {
    const auto width = static_cast<std::size_t>(picture_.width());
    const std::size_t first = static_cast<std::size_t>(y) * width, n = levels_.size();
    for (std::size_t c = 0; c < n; ++c) {
        for (std::size_t x = 0; x < width; ++x) {
            put(out, x * n + c, value(picture_.channels[c], first + x));
        }
    }
}

void RowWriter::put_row(int y, std::span<std::byte> out) const {
    switch (picture_.storage) {
    case Storage::U8:
        put_levels<std::uint8_t>(y, out);
        return;
    case Storage::S8:
        put_levels<std::int8_t>(y, out);
        return;
    case Storage::U16:
        put_levels<std::uint16_t>(y, out);
        return;
    case Storage::S16:
        put_levels<std::int16_t>(y, out);
        return;
    case Storage::U32:
        put_levels<std::uint32_t>(y, out);
        return;
    case Storage::S32:
        put_levels<std::int32_t>(y, out);
        return;
    case Storage::Float:
        put_floats(y, out);
        return;
    }
}

} // namespace trace
