// SPDX-License-Identifier: Apache-2.0
// Private to the PNG files of this module: one encoder for rendered and for merged pictures, so
// that equal pixels become equal bytes.
#pragma once

#include "runtime/base/output_file.h"
#include "tracer/pixel_range.h"

#include <cstddef>
#include <png.h>
#include <span>
#include <string>

namespace trace {

struct PngLayout {
    PixelRange pixels;      // in the frame
    int xres = 0, yres = 0; // of the frame
    int bits = 8;           // per channel: 8 or 16
    int color_type = 0;     // PNG_COLOR_TYPE_*
    int dots_per_metre[2] = {0, 0};
    int level = 4; // of zlib
};

// Rows from top to bottom, 16 bits in native order. False ends the file as failed.
class PngRows {
public:
    virtual ~PngRows() = default;
    virtual bool row(int y, std::span<std::byte> out) = 0;
};

// "" or why not; the file's own errno comes first.
[[nodiscard]] std::string encode_png(const PngLayout& layout, PngRows& rows,
                                     base::OutputFile& file);
[[nodiscard]] std::size_t png_pixel_bytes(const PngLayout& layout);

// A tile says in a text of this name what frame it is part of: "xres yres level". PNG itself knows
// a place only (oFFs).
inline constexpr char png_tile_key[] = "Perigee tile";

} // namespace trace
