// SPDX-License-Identifier: Apache-2.0
#include "tracer/progressive.h"

namespace trace {

namespace {

constexpr int index_bits = 12;

std::uint32_t mix(std::uint32_t x) { // [Mueller] lowbias32
    x = (x ^ (x >> 16)) * 0x7feb352dU;
    x = (x ^ (x >> 15)) * 0x846ca68bU;
    return x ^ (x >> 16);
}

std::uint32_t reversed(std::uint32_t x) {
    std::uint32_t out = 0;
    for (int bit = 0; bit < 32; ++bit, x >>= 1) {
        out = out << 1 | (x & 1U);
    }
    return out;
}

// Each bit is turned or not by a coin that belongs to the bits above it: intervals stay together.
std::uint32_t scrambled(std::uint32_t x, std::uint32_t seed) {
    std::uint32_t out = x;
    for (std::uint32_t bit = 0; bit < 32; ++bit) {
        const std::uint32_t above = bit == 0 ? 0 : x >> (32 - bit);
        out ^= (mix(above ^ mix(seed + bit * 0x9e3779b9U)) & 1U) << (31 - bit);
    }
    return out;
}

// The second dimension of Sobol's sequence; the first is the index, reversed.
std::uint32_t second_dimension(std::uint32_t index) {
    std::uint32_t out = 0;
    for (std::uint32_t v = 1U << 31; index != 0; index >>= 1, v ^= v >> 1) {
        out ^= (index & 1U) != 0 ? v : 0;
    }
    return out;
}

float unit(std::uint32_t x) {
    return static_cast<float>(x >> 8) * 0x1p-24f;
}

} // namespace

UnitPoint progressive_point(std::uint32_t index, std::uint32_t seed) {
    return {unit(scrambled(reversed(index), mix(seed + 1))),
            unit(scrambled(second_dimension(index), mix(seed ^ 0x68bc21ebU)))};
}

UnitPoint shuffled_point(std::uint32_t index, std::uint32_t seed) {
    const std::uint32_t top_bits = ~0U << (32 - index_bits);
    return progressive_point(
        reversed(scrambled(reversed(index), mix(seed ^ 0x02e5be93U)) & top_bits), seed);
}

} // namespace trace
