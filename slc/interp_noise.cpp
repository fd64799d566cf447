// SPDX-License-Identifier: Apache-2.0
// Gradient noise, periodic noise and cell noise in double precision, one general loop over the
// corners of a cell of any dimension, after the definition in the head of
// runtime/lib/noise_lattice.h.
#include "slc/interp_value.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace slc {

namespace {

using Args = std::vector<Value>&;

constexpr std::uint32_t primes[] = {0x8da6b343u, 0xb5297a4du, 0xcb1ab31fu, 0xa7d69b35u};
constexpr std::uint32_t channel_factors[] = {0xe3779b97u, 0x9d2c5681u, 0x2c1b3c6du};
constexpr double scales[] = {0.094, 0.2535, 0.468, 0.435}; // by dimension - 1

// Coordinates and, for pnoise, periods (0: none), as the arguments give them.
struct Place {
    std::vector<double> at, period;
    [[nodiscard]] std::size_t dimensions() const { return at.size(); }
};

std::uint32_t bits_of(double whole) {
    const bool fits = whole >= -0x1p31 && whole < 0x1p31;
    return static_cast<std::uint32_t>(static_cast<std::int64_t>(fits ? whole : -0x1p31));
}

// The offset rounds to float as in the compiled code; large coordinates have no more.
double fraction(double a) {
    return static_cast<double>(static_cast<float>(a) - std::floor(static_cast<float>(a)));
}

double signed_by(std::uint32_t h, int bit, double x) {
    return (h >> bit & 1) != 0 ? -x : x;
}

double gradient(std::uint32_t h, const std::vector<double>& d) {
    const bool b31 = (h >> 31 & 1) != 0;
    const bool b30 = (h >> 30 & 1) != 0;
    const bool b29 = (h >> 29 & 1) != 0;
    switch (d.size()) {
    case 1:
        return signed_by(h, 31, (1 + (h >> 28 & 7)) * d[0]);
    case 2:
        return signed_by(h, 30, b31 ? d[1] : d[0]) + 2 * signed_by(h, 29, b31 ? d[0] : d[1]);
    case 3: {
        const double inclined = signed_by(h, 28, 0.822598 * d[b29 ? 1 : 0]) + 1.150362 * d[2];
        const double diagonal =
            0.997497 * (signed_by(h, 29, d[0]) + signed_by(h, 28, d[1])) + 0.1 * d[2];
        return signed_by(h, 31, b30 ? diagonal : inclined);
    }
    default: {
        const double u = b31 && b30 ? d[1] : d[0];
        const double v = b31 ? d[2] : d[1];
        const double w = b31 || b30 ? d[3] : d[2];
        return signed_by(h, 29, u) + signed_by(h, 28, v) + signed_by(h, 27, w);
    }
    }
}

// Lattice index of the lower or upper corner along one axis.
double corner_index(const Place& p, std::size_t axis, bool upper) {
    const double whole = std::floor(p.at[axis]);
    if (p.period[axis] == 0) {
        return whole;
    }
    const double period = std::clamp(std::floor(p.period[axis] + 0.5), 1.0, 0x1p23);
    const double index = whole + (upper ? 1 : 0);
    return index - period * std::floor(index / period);
}

double noise_at(const Place& p, std::size_t channel) {
    const std::size_t n = p.dimensions();
    double sum = 0;
    for (std::uint32_t corner = 0; corner < (1u << n); ++corner) {
        std::uint32_t h = 0;
        double weight = 1;
        std::vector<double> offset(n);
        for (std::size_t axis = 0; axis < n; ++axis) {
            const bool upper = (corner >> axis & 1) != 0;
            std::uint32_t index = bits_of(corner_index(p, axis, upper));
            index += upper && p.period[axis] == 0 ? 1 : 0;
            const std::uint32_t seed = axis == 0 ? 0x9e3779b9u * static_cast<std::uint32_t>(n) : 0;
            h ^= index * primes[axis] + seed;
            const double f = fraction(p.at[axis]);
            const double w = f * f * f * (f * (6 * f - 15) + 10);
            weight *= upper ? w : 1 - w;
            offset[axis] = upper ? f - 1 : f;
        }
        sum += weight * gradient(h * channel_factors[channel], offset);
    }
    const double value = 0.5 + scales[n - 1] * sum;
    if (!std::isfinite(sum)) {
        return 0.5;
    }
    return n == 4 ? std::clamp(value, 0.0, 1.0) : value;
}

double cell_at(const Place& p, std::size_t channel) {
    std::uint32_t h = 0;
    for (std::size_t axis = 0; axis < p.dimensions(); ++axis) {
        if (!std::isfinite(p.at[axis])) {
            return 0.5;
        }
        const std::uint32_t seed =
            axis == 0 ? 0x7f4a7c15u * static_cast<std::uint32_t>(p.dimensions()) : 0;
        h ^= bits_of(std::floor(p.at[axis])) * primes[axis] + seed;
    }
    constexpr std::uint32_t offsets[] = {0, 0x9e3779b9u, 0x3c6ef372u};
    h += offsets[channel];
    h ^= h >> 16;
    h *= 0x85ebca6bu;
    h ^= h >> 13;
    h *= 0xc2b2ae35u;
    h ^= h >> 16;
    return static_cast<double>(h >> 8) * 0x1p-24;
}

// All components of the arguments in order; pnoise has as many periods as coordinates.
Place place_of(Args a, bool periodic) {
    Place p;
    const std::size_t coordinates = periodic ? a.size() / 2 : a.size();
    for (std::size_t i = 0; i < a.size(); ++i) {
        auto& into = i < coordinates ? p.at : p.period;
        into.insert(into.end(), a[i].x.begin(), a[i].x.end());
    }
    p.period.resize(p.at.size(), 0.0);
    for (double& period : p.period) {
        period = periodic && period == 0 ? 1 : period;
    }
    return p;
}

template <double (*At)(const Place&, std::size_t), bool Periodic> void evaluate(Args a, Value& r) {
    const Place p = place_of(a, Periodic);
    for (std::size_t channel = 0; channel < r.x.size(); ++channel) {
        r.x[channel] = At(p, channel);
    }
}

} // namespace

std::vector<PureEntry> pure_noise() {
    std::vector<PureEntry> entries;
    for (const std::string_view body : {"noise_f_1", "noise_f_2", "noise_f_3", "noise_f_4",
                                        "noise_3_1", "noise_3_2", "noise_3_3", "noise_3_4"}) {
        entries.push_back({body, evaluate<noise_at, false>});
    }
    for (const std::string_view body : {"pnoise_f_1", "pnoise_f_2", "pnoise_f_3", "pnoise_f_4",
                                        "pnoise_3_1", "pnoise_3_2", "pnoise_3_3", "pnoise_3_4"}) {
        entries.push_back({body, evaluate<noise_at, true>});
    }
    for (const std::string_view body :
         {"cellnoise_f_1", "cellnoise_f_2", "cellnoise_f_3", "cellnoise_f_4", "cellnoise_3_1",
          "cellnoise_3_2", "cellnoise_3_3", "cellnoise_3_4"}) {
        entries.push_back({body, evaluate<cell_at, false>});
    }
    return entries;
}

} // namespace slc
