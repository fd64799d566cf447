// SPDX-License-Identifier: Apache-2.0
// Environments on the six faces of a cube, filtered without seams: texels beyond the edge of a face
// are those of its neighbours. In: a direction and its differences. Out: the mean over the
// footprint. Immutable; whole in memory, with its mip levels. Faces px nx py ny pz nz as ri.md
// 6.11 orients them; decisions: docs/design/textures.md.
#pragma once

#include "runtime/base/vec.h"
#include "tracer/map_file.h"

#include <array>
#include <span>
#include <vector>

namespace trace {

// Half a picture across, `forward` + a `right` + b `up`, a and b from -1 to 1, is what a face sees.
struct CubeFace {
    base::V3d forward, up, right;
};
inline constexpr int num_cube_faces = 6; // px nx py ny pz nz
[[nodiscard]] const CubeFace& cube_face(int face);
// Place of a face in the picture of a file: three columns px py pz, two rows, p above n.
struct CubeCell {
    int column, row;
};
[[nodiscard]] CubeCell cube_cell(int face);

struct CubeFootprint {
    base::V3d R_u, R_v;  // of the direction, widths multiplied in
    double blur_rad = 0; // full width added all around
};

class CubeMap {
public:
    // The picture of a cube file: 3 by 2 square faces. False (and no map) if it is none.
    [[nodiscard]] static bool fits(const MapImage& image);
    explicit CubeMap(const MapImage& image);

    // Channels from `channel` on; all must exist.
    void lookup(const base::V3d& R, const CubeFootprint& footprint, int channel,
                std::span<float> out) const;

    [[nodiscard]] int size() const { return levels_.front().n; } // of a face
    [[nodiscard]] int num_channels() const { return num_channels_; }
    [[nodiscard]] std::size_t bytes() const;

private:
    struct Level {
        int n = 0;
        std::vector<float> values; // [face][row][column][channel]
    };
    struct Ellipse; // of directions
    [[nodiscard]] Level half(const Level& level) const;
    [[nodiscard]] const float* texel(const Level& level, int face, int x, int y) const;
    void bilinear(const Level& level, const base::V3d& R, int channel, double weight,
                  std::span<double> sum) const;
    void trilinear(double lod, const base::V3d& R, int channel, double weight,
                   std::span<double> sum) const;

    int num_channels_;
    std::vector<Level> levels_; // finest first
};

// Six pictures of `fov_deg` (horizontally) become the picture of a cube file. Sizes may differ; all
// have num_channels channels.
[[nodiscard]] MapImage assemble_cube(std::span<const MapImage, num_cube_faces> faces,
                                     double fov_deg);

} // namespace trace
