// SPDX-License-Identifier: Apache-2.0
#include "tracer/environment_light.h"

#include <algorithm>
#include <cmath>

namespace trace {

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr int rows = 64, columns = 128;

std::array<double, 9> harmonics(const base::V3d& d) { // [Ramamoorthi01] eq. 3
    return {0.282095,
            0.488603 * d.y,
            0.488603 * d.z,
            0.488603 * d.x,
            1.092548 * d.x * d.y,
            1.092548 * d.y * d.z,
            0.315392 * (3 * d.z * d.z - 1),
            1.092548 * d.x * d.z,
            0.546274 * (d.x * d.x - d.y * d.y)};
}

// Of the cosine lobe, divided by pi: by band.
constexpr double lobe[9] = {1, 2.0 / 3, 2.0 / 3, 2.0 / 3, 0.25, 0.25, 0.25, 0.25, 0.25};

} // namespace

// Rows of equal height in z: all samples stand for the same solid angle.
Irradiance::Irradiance(const Radiance& radiance) {
    constexpr double solid_angle = 4 * pi / (rows * columns);
    for (int j = 0; j < rows; ++j) {
        const double z = 1 - 2 * (j + 0.5) / rows;
        const double r = std::sqrt(1 - z * z);
        for (int i = 0; i < columns; ++i) {
            const double angle = 2 * pi * (i + 0.5) / columns;
            const base::V3d d{r * std::cos(angle), r * std::sin(angle), z};
            const std::array<float, 3> value = radiance(d);
            const std::array<double, 9> y = harmonics(d);
            for (std::size_t l = 0; l < y.size(); ++l) {
                for (std::size_t k = 0; k < 3; ++k) {
                    coefficients_[l][k] += solid_angle * y[l] * static_cast<double>(value[k]);
                }
            }
        }
    }
}

std::array<float, 3> Irradiance::around(const base::V3d& normal) const {
    const std::array<double, 9> y = harmonics(normal);
    std::array<float, 3> out{};
    for (std::size_t k = 0; k < 3; ++k) {
        double sum = 0;
        for (std::size_t l = 0; l < y.size(); ++l) {
            sum += lobe[l] * y[l] * coefficients_[l][k];
        }
        out[k] = static_cast<float>(std::max(sum, 0.0));
    }
    return out;
}

} // namespace trace
