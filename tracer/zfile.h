// SPDX-License-Identifier: Apache-2.0
// Pixar's zfile: a header of magic number, width and height (16 bits), world-to-screen and
// world-to-camera (row vectors), then depths as floats, rows from the top; native byte order, which
// readers tell by the magic number.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace trace {

inline constexpr std::uint32_t zfile_magic = 0x2f0867ab;
inline constexpr std::uint32_t swapped_zfile_magic = 0xab67082f;

struct ZfileHeader {
    std::uint32_t magic = zfile_magic;
    std::int16_t width = 0, height = 0;
    float screen_from_world[16] = {};
    float camera_from_world[16] = {};
};
static_assert(sizeof(ZfileHeader) == 136);

// To the other byte order.
template <class T> void swap_bytes(T& value) {
    auto* bytes = reinterpret_cast<unsigned char*>(&value);
    std::reverse(bytes, bytes + sizeof value);
}

inline void swap_zfile_values(std::span<float> values, bool swapped) {
    for (std::size_t i = 0; swapped && i < values.size(); ++i) {
        swap_bytes(values[i]);
    }
}

inline void swap_zfile_header(ZfileHeader& header, bool swapped) {
    if (swapped) {
        swap_bytes(header.magic);
        swap_bytes(header.width);
        swap_bytes(header.height);
    }
    swap_zfile_values(header.screen_from_world, swapped);
    swap_zfile_values(header.camera_from_world, swapped);
}

} // namespace trace
