// SPDX-License-Identifier: Apache-2.0
#include "tracer/ray_directions.h"

#include "tracer/sampler.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace trace {

namespace {

constexpr double unit_of_bits = 1.0 / 4294967296.0;

double reversed_bits(std::uint32_t x) { // van der Corput's sequence
    double value = 0, digit = 0.5;
    for (; x != 0; x >>= 1U, digit /= 2) {
        value += (x & 1U) != 0 ? digit : 0;
    }
    return value;
}

double rotated(double x, std::uint32_t bits, double shift) {
    const double moved = x + shift * bits * unit_of_bits;
    return moved - std::floor(moved);
}

} // namespace

double cone_solid_angle(double half_angle) {
    return 2 * std::numbers::pi * (1 - std::cos(std::min(half_angle, std::numbers::pi)));
}

base::V3d cone_direction(const base::V3d& axis, double half_angle, const ConeSample& which) {
    const auto shift = static_cast<double>(which.shift);
    const std::uint32_t first = PixelHash::mix(which.seed + 0x636f6e65U);
    const double a = rotated((which.sample + 0.5) / which.samples, first, shift);
    const double b = rotated(reversed_bits(static_cast<std::uint32_t>(which.sample)),
                             PixelHash::mix(first), shift);
    double cosine = 1, sine = 0;
    if (which.distribution == ConeDistribution::Cosine) {
        const double most = std::sin(std::min(half_angle, std::numbers::pi / 2));
        sine = std::sqrt(a) * most;
        cosine = std::sqrt(std::max(0.0, 1 - sine * sine));
    } else {
        cosine = 1 - a * (1 - std::cos(std::min(half_angle, std::numbers::pi)));
        sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    }
    const double phi = 2 * std::numbers::pi * b;
    // [Duff17]'s frame, without branches on the axis.
    const double sign = std::copysign(1.0, axis.z);
    const double p = -1 / (sign + axis.z), q = axis.x * axis.y * p;
    const base::V3d x(1 + sign * axis.x * axis.x * p, sign * q, -sign * axis.x);
    const base::V3d y(q, sign + axis.y * axis.y * p, -axis.y);
    return axis * cosine + x * (sine * std::cos(phi)) + y * (sine * std::sin(phi));
}

} // namespace trace
