// SPDX-License-Identifier: Apache-2.0
// Points that are well spread however many of them are taken: the first n of a sequence, any n.
//
// In: index, seed. Out: points of the unit square from the first two dimensions of Sobol's sequence
// with nested uniform (Owen's) scrambling, every one uniform by itself; values along a line
// likewise. Sequences of different seeds are independent. Source: [Burley20], with an exact
// scramble instead of a hash that approximates it, since tables are made once.
#pragma once

#include <cstdint>

namespace trace {

struct UnitPoint {
    float x, y; // [0, 1)
};

// index < 2^12.
[[nodiscard]] UnitPoint progressive_point(std::uint32_t index, std::uint32_t seed);
// The same with the indices in another order: for dimensions that must not follow those of the
// sequence they are paired with. Blocks of 2^k points stay blocks.
[[nodiscard]] UnitPoint shuffled_point(std::uint32_t index, std::uint32_t seed);

} // namespace trace
