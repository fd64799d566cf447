// SPDX-License-Identifier: Apache-2.0
// Files of maps that are Perigee's own: depth of shadow maps and faces of cube environments, as
// TIFF with Pixar's tags (texture format, camera matrices, field of view), so that other programs
// read them. Reads zfiles too. In: a path. Out: float pixels, or why not. Nothing here needs
// OpenImageIO. Format: docs/textures.md.
#pragma once

#include "runtime/base/output_file.h"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace trace {

struct MapImage {
    int width = 0, height = 0, num_channels = 1;
    std::vector<float> values; // rows from the top, channels interleaved
    bool has_matrices = false;
    float camera_from_world[16] = {}, screen_from_world[16] = {}; // row vectors
    float cot_half_fov = 1;                                       // of cube faces
};

struct MapFile {
    std::string format; // of the first image: shadow_format, cube_format, another or ""
    std::vector<MapImage> images;
};

inline constexpr std::string_view shadow_format = "Shadow";
inline constexpr std::string_view cube_format = "CubeFace Environment";
// Numbers a file may hold: 256 MB of floats.
inline constexpr std::size_t max_map_values = std::size_t{1} << 26;

// The texture format a TIFF says it has; "" for none, nullopt for a file that is no readable TIFF.
[[nodiscard]] std::optional<std::string> map_file_format(const std::string& path);
// A TIFF (all its images), or a zfile (format "zfile"). On failure `error` says why.
[[nodiscard]] std::optional<MapFile> read_map_file(const std::string& path, std::string& error);
// False: see file.error(), else error.
[[nodiscard]] bool write_map_file(const MapFile& map, base::OutputFile& file, std::string& error);

} // namespace trace
