// SPDX-License-Identifier: Apache-2.0
// The diffuse light of an environment: its projection on the first nine spherical harmonics
// [Ramamoorthi01], which holds the cosine-weighted mean over a hemisphere to about one per cent.
// In: radiance by direction, once. Out: the mean around a normal.
#pragma once

#include "runtime/base/vec.h"

#include <array>
#include <functional>

namespace trace {

class Irradiance {
public:
    using Radiance = std::function<std::array<float, 3>(const base::V3d& direction)>;
    Irradiance() = default;
    explicit Irradiance(const Radiance& radiance);

    // Cosine-weighted mean of the radiance over the hemisphere around a unit normal.
    [[nodiscard]] std::array<float, 3> around(const base::V3d& normal) const;

private:
    std::array<std::array<double, 3>, 9> coefficients_{};
};

} // namespace trace
