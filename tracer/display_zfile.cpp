// SPDX-License-Identifier: Apache-2.0
// Display type "zfile": depth of every pixel as float, with the matrices a shadow map needs
// (zfile.h).
#include "tracer/display_format.h"
#include "tracer/zfile.h"

#include <algorithm>
#include <cstdint>
#include <limits>

namespace trace {

namespace {

void put(const base::Mat4& m, float* out) {
    for (int i = 0; i < 16; ++i) {
        out[i] = static_cast<float>(m.m[i / 4][i % 4]);
    }
}

} // namespace

WriteOutcome write_zfile(const FilePicture& picture, base::OutputFile& file) {
    constexpr int largest = std::numeric_limits<std::int16_t>::max();
    if (picture.width() > largest || picture.height() > largest) {
        return {false, "a zfile holds at most 32767 pixels on a side", ""};
    }
    ZfileHeader header;
    header.width = static_cast<std::int16_t>(picture.width());
    header.height = static_cast<std::int16_t>(picture.height());
    put(screen_from_world(picture.info), header.screen_from_world);
    put(picture.info.camera_from_world, header.camera_from_world);
    bool good = file.write(&header, sizeof header);
    const std::span<const float> values = picture.find(ChannelRole::Depth)->values;
    std::vector<float> row(static_cast<std::size_t>(picture.width()));
    for (std::size_t at = 0; at < values.size() && good; at += row.size()) {
        std::transform(values.begin() + static_cast<std::ptrdiff_t>(at),
                       values.begin() + static_cast<std::ptrdiff_t>(at + row.size()), row.begin(),
                       [](float z) { return std::min(z, rib::ri_infinity); });
        good = file.write(row.data(), row.size() * sizeof(float));
    }
    return {good, "", ""};
}

} // namespace trace
