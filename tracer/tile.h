// SPDX-License-Identifier: Apache-2.0
// Pictures that were rendered with a crop window, read back exactly as they were written, and one
// writer per format that makes of their rows the very file the whole picture would have been.
// Between merge.cpp and the formats. Failures are texts; exceptions and longjmp of the libraries
// stay inside.
#pragma once

#include "runtime/base/output_file.h"
#include "tracer/pixel_range.h"

#include <cstddef>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace trace {

// What a tile says about itself.
struct TileInfo {
    const char* format = "";
    PixelRange pixels;      // in the frame
    int xres = 0, yres = 0; // of the frame
    // A row is stored plane after plane: bytes per pixel of each. Interleaved formats have one.
    using Planes = std::vector<std::size_t>;
    std::vector<Planes> parts; // OpenEXR may hold several pictures of one size
    // All that must agree among the tiles of a picture, by the name users know.
    std::map<std::string, std::string> facts;
    std::string note; // something the user should know about merging such files

    [[nodiscard]] std::size_t row_bytes(std::size_t part, int width) const;
};

// Rows of a picture from top to bottom: a tile that is read, or tiles being put together.
class RowSource {
public:
    virtual ~RowSource() = default;
    // "" or why not. Asked for part after part, rows in order from 0.
    virtual std::string row(std::size_t part, int y, std::span<std::byte> out) = 0;
};

class Tile : public RowSource {
public:
    [[nodiscard]] const TileInfo& info() const { return info_; }
    // Writes a picture of this tile's kind over `pixels` of the frame. "" or why not.
    virtual std::string write(const PixelRange& pixels, RowSource& rows,
                              base::OutputFile& file) = 0;

protected:
    TileInfo info_;
};

struct OpenedTile {
    std::unique_ptr<Tile> tile; // null: `error` says why
    std::string error;
};
// The format is told by the first bytes.
[[nodiscard]] OpenedTile open_tile(const std::string& path);

[[nodiscard]] OpenedTile open_tiff_tile(const std::string& path);
[[nodiscard]] OpenedTile open_png_tile(const std::string& path);
[[nodiscard]] OpenedTile open_exr_tile(const std::string& path);

} // namespace trace
