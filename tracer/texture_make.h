// SPDX-License-Identifier: Apache-2.0
// Makes maps from pictures, depth files and point clouds, for the requests of ri.md 6.11 and for
// txmake. In: paths that exist. Out: one file under its name when it is complete, or why not.
// Pictures become tiled, mip-mapped TIFF through OpenImageIO; depth and cube files are Perigee's
// own (map_file.h).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace trace {

enum class MapKind : std::uint8_t { Texture, LatLong, Cube, Shadow, Occlusion, Points };

struct MakeRequest {
    MapKind kind = MapKind::Texture;
    std::vector<std::string> sources;
    std::string target;
    std::string smode = "black", tmode = "black"; // black, periodic, clamp, mirror
    std::string filter = "box";                   // of the mip levels
    std::string format; // of numbers: uint8, uint16, half, float; "" = the picture's
    std::string compression = "zip";
    double fov_deg = 90; // of cube faces
    bool resize = false; // to powers of two
    bool mipmap = true;
};

struct MakeOutcome {
    bool made = false;
    bool environment = false; // disk, memory, a missing library: exit code 3
    std::string error;
    std::vector<std::string> notes; // what was done another way than asked for
};

[[nodiscard]] MakeOutcome make_map(const MakeRequest& request);

} // namespace trace
