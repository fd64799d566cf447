// SPDX-License-Identifier: Apache-2.0
#include "tracer/hemisphere_samples.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace trace {

namespace {

constexpr float pi = 3.14159265358979324f;

// The cosine-weighted grid: ring j begins at the angle whose squared sine is j / rings.
float sin2_of_ring(const HemisphereStrata& strata, std::uint32_t ring) {
    return static_cast<float>(ring) / static_cast<float>(strata.rings);
}

float angle_of_sector(const HemisphereStrata& strata, float sector) {
    return 2 * pi * sector / static_cast<float>(strata.sectors);
}

void add_scaled(std::array<base::V3f, 3>& sum, const base::V3f& along, float scale,
                const base::Color& color) {
    sum[0] += scale * color.r * along;
    sum[1] += scale * color.g * along;
    sum[2] += scale * color.b * along;
}

} // namespace

HemisphereFrame HemisphereFrame::about(const base::V3f& normal) {
    const base::V3f n = base::normalize(normal);
    const float sign = std::copysign(1.0f, n.z);
    const float a = -1 / (sign + n.z);
    const float b = n.x * n.y * a;
    return {{1 + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
}

// [Steele14]: a Weyl sequence, scrambled by the mixer that all seeds here go through.
std::uint32_t SampleStream::next_bits() {
    state_ += 0x9e3779b9U;
    std::uint32_t x = state_;
    x = (x ^ (x >> 16)) * 0x7feb352dU;
    x = (x ^ (x >> 15)) * 0x846ca68bU;
    return x ^ (x >> 16);
}

float SampleStream::next() {
    return static_cast<float>(next_bits() >> 8) * 0x1p-24f;
}

HemisphereStrata HemisphereStrata::of(std::uint32_t wanted) {
    const auto n = static_cast<float>(std::max(wanted, 1U));
    HemisphereStrata strata;
    strata.rings = static_cast<std::uint32_t>(std::max(1.0f, std::round(std::sqrt(n / pi))));
    strata.sectors = static_cast<std::uint32_t>(
        std::max(1.0f, std::round(n / static_cast<float>(strata.rings))));
    return strata;
}

HemisphereCone HemisphereCone::of(float half_angle_rad, HemisphereDensity density) {
    const float angle = std::clamp(half_angle_rad, 0.0f, pi / 2);
    const float sine = std::sin(angle);
    return {density, sine * sine, angle < pi / 2 ? std::cos(angle) : 0.0f};
}

base::V3f direction_in(const HemisphereStrata& strata, const HemisphereCone& cone,
                       std::uint32_t cell, float x, float y) {
    const std::uint32_t ring = cell / strata.sectors, sector = cell % strata.sectors;
    const float share = (static_cast<float>(ring) + x) / static_cast<float>(strata.rings);
    const float phi = angle_of_sector(strata, static_cast<float>(sector) + y);
    float sine = 0, cosine = 1;
    if (cone.density == HemisphereDensity::Cosine) {
        const float sin2 = share * cone.sin2_angle;
        sine = std::sqrt(sin2);
        cosine = std::sqrt(std::max(1 - sin2, 0.0f));
    } else {
        cosine = 1 - share * (1 - cone.cos_angle);
        sine = std::sqrt(std::max(1 - cosine * cosine, 0.0f));
    }
    return {sine * std::cos(phi), sine * std::sin(phi), cosine};
}

base::Color mean_radiance(const HemisphereAnswers& answers) {
    double sum[3] = {};
    for (const base::Color& c : answers.radiance) {
        sum[0] += static_cast<double>(c.r);
        sum[1] += static_cast<double>(c.g);
        sum[2] += static_cast<double>(c.b);
    }
    const double n = answers.strata.count();
    return {static_cast<float>(sum[0] / n), static_cast<float>(sum[1] / n),
            static_cast<float>(sum[2] / n)};
}

namespace {

// d mean / d rotation = 1/pi integral of L (n x w) dw, over each cell as if it were all of its
// colour: bounded at the horizon, where [Ward92] eq. 3 divides by a cosine, and 0 where the light
// is even, wherever in their cells the rays went.
void add_rotation(const HemisphereAnswers& a, std::array<base::V3f, 3>& rotation) {
    const HemisphereStrata& s = a.strata;
    const auto integral = [&s](std::uint32_t ring) { // of sin^2 from the normal to the ring
        const float sine = std::sqrt(sin2_of_ring(s, ring));
        const float cosine = std::sqrt(1 - sin2_of_ring(s, ring));
        return 0.5f * (std::atan2(sine, cosine) - sine * cosine);
    };
    const float sector = angle_of_sector(s, 1);
    for (std::uint32_t ring = 0; ring < s.rings; ++ring) {
        const float weight =
            2 / pi * std::sin(0.5f * sector) * (integral(ring + 1) - integral(ring));
        for (std::uint32_t k = 0; k < s.sectors; ++k) {
            const float phi = angle_of_sector(s, static_cast<float>(k) + 0.5f);
            add_scaled(rotation, {-std::sin(phi), std::cos(phi), 0}, weight,
                       a.radiance[ring * s.sectors + k]);
        }
    }
}

float closer(const HemisphereAnswers& a, std::uint32_t i, std::uint32_t j) {
    return 1 / std::min(a.distance[i], a.distance[j]); // 0 where both met nothing
}

// Edges between rings and between sectors move against the point as it moves, the nearer the
// faster. [Ward92] eq. 5, divided by pi.
void add_translation(const HemisphereAnswers& a, std::array<base::V3f, 3>& translation) {
    const HemisphereStrata& s = a.strata;
    for (std::uint32_t k = 0; k < s.sectors; ++k) {
        const float phi_mid = angle_of_sector(s, static_cast<float>(k) + 0.5f);
        const float phi_edge = angle_of_sector(s, static_cast<float>(k));
        const base::V3f outwards(std::cos(phi_mid), std::sin(phi_mid), 0);
        const base::V3f around(-std::sin(phi_edge), std::cos(phi_edge), 0);
        const std::uint32_t before = (k + s.sectors - 1) % s.sectors;
        for (std::uint32_t j = 0; j < s.rings; ++j) {
            const std::uint32_t here = j * s.sectors + k;
            if (j > 0) {
                const std::uint32_t inner = here - s.sectors;
                const float sin2 = sin2_of_ring(s, j);
                const float weight = 2 / static_cast<float>(s.sectors) * std::sqrt(sin2) *
                                     (1 - sin2) * closer(a, here, inner);
                add_scaled(translation, outwards, weight, a.radiance[here] - a.radiance[inner]);
            }
            const std::uint32_t beside = j * s.sectors + before;
            const float width = std::sqrt(sin2_of_ring(s, j + 1)) - std::sqrt(sin2_of_ring(s, j));
            add_scaled(translation, around, width / pi * closer(a, here, beside),
                       a.radiance[here] - a.radiance[beside]);
        }
    }
}

} // namespace

IrradianceGradients irradiance_gradients(const HemisphereAnswers& answers) {
    IrradianceGradients gradients;
    add_rotation(answers, gradients.rotation);
    add_translation(answers, gradients.translation);
    return gradients;
}

float harmonic_mean_distance(const HemisphereAnswers& answers) {
    double sum = 0;
    for (const float r : answers.distance) {
        sum += r > 0 ? 1 / static_cast<double>(r) : 0;
    }
    return sum > 0 ? static_cast<float>(answers.strata.count() / sum)
                   : std::numeric_limits<float>::infinity();
}

} // namespace trace
