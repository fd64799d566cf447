// SPDX-License-Identifier: Apache-2.0
// A half-open rectangle of pixels in the raster of the whole frame: x right, y down, (0,0) upper
// left. Pixels outside the frame are legal: filters reach beyond its edges.
#pragma once

#include <algorithm>
#include <cstddef>

namespace trace {

struct PixelRange {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;

    [[nodiscard]] int width() const { return std::max(x1 - x0, 0); }
    [[nodiscard]] int height() const { return std::max(y1 - y0, 0); }
    [[nodiscard]] bool empty() const { return x1 <= x0 || y1 <= y0; }
    [[nodiscard]] std::size_t area() const {
        return static_cast<std::size_t>(width()) * static_cast<std::size_t>(height());
    }
    [[nodiscard]] bool contains(int x, int y) const {
        return x >= x0 && x < x1 && y >= y0 && y < y1;
    }
    [[nodiscard]] PixelRange grown(int dx, int dy) const {
        return {x0 - dx, y0 - dy, x1 + dx, y1 + dy};
    }
    [[nodiscard]] PixelRange intersected(const PixelRange& b) const {
        return {std::max(x0, b.x0), std::max(y0, b.y0), std::min(x1, b.x1), std::min(y1, b.y1)};
    }
    friend bool operator==(const PixelRange&, const PixelRange&) = default;
};

// Tiles of the whole frame: what neighbouring pixels tell each other stays inside one, so that it
// depends on no bucket and no crop window (sampling-001). Buckets of the default size are tiles.
constexpr int tile_px = 16;

[[nodiscard]] constexpr int tile_floor(int px) {
    return px >= 0 ? px / tile_px * tile_px : -((tile_px - 1 - px) / tile_px * tile_px);
}
[[nodiscard]] constexpr PixelRange tile_at(int x, int y) {
    return {tile_floor(x), tile_floor(y), tile_floor(x) + tile_px, tile_floor(y) + tile_px};
}
// The pixels of all tiles that hold some of a range.
[[nodiscard]] constexpr PixelRange whole_tiles(const PixelRange& r) {
    return {tile_floor(r.x0), tile_floor(r.y0), tile_floor(r.x1 - 1) + tile_px,
            tile_floor(r.y1 - 1) + tile_px};
}

} // namespace trace
