// SPDX-License-Identifier: Apache-2.0
// False occlusions, counted: rays that leave convex surfaces of every kind outwards, and segments
// between two of them that nothing lies on. Sizes 1e-3 ... 1e5, offsets up to 1e5, every other
// direction grazing. Any hit is false. Used by offset_sweep_test.cpp and by the program
// offset_sweep, which runs as many rays as it is asked to.
#pragma once

#include <cstdint>
#include <string>

namespace geo {

struct SweepCount {
    std::uint64_t rays = 0, false_hits = 0;
    std::string first_false;   // what was met, and where
    double largest_offset = 0; // of an origin from its point, relative to the size of coordinates
};

// About this many rays; the same for the same numbers.
[[nodiscard]] SweepCount sweep_offsets(std::uint64_t rays, std::uint32_t seed);

} // namespace geo
