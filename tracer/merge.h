// SPDX-License-Identifier: Apache-2.0
// render --merge: tiles rendered with -crop become the picture that a render without it would have
// written, byte for byte. Tiles must cover it exactly once and belong together: the same frame,
// camera, channels and format.
#pragma once

#include "runtime/base/diag.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace trace {

enum class MergeResult : std::uint8_t {
    Written,
    BadTiles, // missing, damaged, overlapping or foreign ones: exit code 1
    Failed    // the environment: exit code 3
};

// crop: the part of the frame that the tiles make up (fractions, as -crop has them); all of it if
// not given. Reads a row at a time; nothing appears as `output` unless complete.
[[nodiscard]] MergeResult merge_tiles(const std::string& output, std::span<const std::string> tiles,
                                      const std::optional<std::array<float, 4>>& crop,
                                      base::Diag& diag);

} // namespace trace
