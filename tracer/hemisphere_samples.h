// SPDX-License-Identifier: Apache-2.0
// Stratified directions about a normal, and what their answers say about the irradiance nearby.
// In: a normal, a count, a seed. Out: unit directions, one in each cell of a polar grid; from the
// radiance and distance met in each cell, the mean over the hemisphere and its gradients [Ward92].
// Pure functions: every direction depends on the seed and its cell only.
#pragma once

#include "runtime/base/vec.h"

#include <array>
#include <cstdint>
#include <span>

namespace trace {

// Right-handed, z along the normal [Duff17].
struct HemisphereFrame {
    base::V3f x, y, z;

    static HemisphereFrame about(const base::V3f& normal); // any length but 0
    [[nodiscard]] base::V3f from_local(float a, float b, float c) const {
        return a * x + b * y + c * z;
    }
};

// A stream of numbers in [0, 1) that is known by its seed alone.
class SampleStream {
public:
    explicit SampleStream(std::uint32_t seed) : state_(seed) {}
    float next();
    std::uint32_t next_bits();

private:
    std::uint32_t state_;
};

// Cells of equal weight: rings in the angle from the normal, sectors around it. Cells are about as
// wide as long: sectors = pi rings.
struct HemisphereStrata {
    std::uint32_t rings = 1, sectors = 1;

    // The number of cells next to `wanted`, at least 1.
    static HemisphereStrata of(std::uint32_t wanted);
    [[nodiscard]] std::uint32_t count() const { return rings * sectors; }
};

enum class HemisphereDensity : std::uint8_t { Cosine, Uniform };

// What part of the sphere is asked: the cone about the normal.
struct HemisphereCone {
    HemisphereDensity density = HemisphereDensity::Cosine;
    float sin2_angle = 1; // of the half angle ...
    float cos_angle = 0;  // ... which is at most a right one

    static HemisphereCone of(float half_angle_rad, HemisphereDensity density);
};

// A direction in a cell, about +z. x, y in [0, 1): where in the cell.
[[nodiscard]] base::V3f direction_in(const HemisphereStrata& strata, const HemisphereCone& cone,
                                     std::uint32_t cell, float x, float y);

// What the rays of all cells of a cosine-weighted hemisphere met.
struct HemisphereAnswers {
    HemisphereStrata strata;
    std::span<const base::V3f> direction; // local, by cell
    std::span<const base::Color> radiance;
    std::span<const float> distance; // infinity: nothing
};

struct IrradianceGradients {
    // By channel. Of the mean to the hemisphere of a normal n + a x n: rotation . a; at a point
    // moved by d: translation . d. Local.
    std::array<base::V3f, 3> rotation{}, translation{};
};

// All of these are of the cosine-weighted mean (1/pi of the irradiance): what ambient() returns.
[[nodiscard]] base::Color mean_radiance(const HemisphereAnswers& answers);
[[nodiscard]] IrradianceGradients irradiance_gradients(const HemisphereAnswers& answers);
// Infinity where no ray met anything.
[[nodiscard]] float harmonic_mean_distance(const HemisphereAnswers& answers);

} // namespace trace
