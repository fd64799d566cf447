// SPDX-License-Identifier: Apache-2.0
// noise, pnoise, cellnoise, random: against a second implementation written from the definition in
// noise_lattice.h (in double, corner by corner), and against the statistics reference/sl.md 4.1.3
// asks for.
#include "runtime/lib/test/fixture.h"
#include "runtime/lib/test_services.h"

#include <bit>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace lanes_test {
namespace {

const Covers covers{"noise_f_1",     "noise_f_2",     "noise_f_3",     "noise_f_4",
                    "noise_3_1",     "noise_3_2",     "noise_3_3",     "noise_3_4",
                    "pnoise_f_1",    "pnoise_f_2",    "pnoise_f_3",    "pnoise_f_4",
                    "pnoise_3_1",    "pnoise_3_2",    "pnoise_3_3",    "pnoise_3_4",
                    "cellnoise_f_1", "cellnoise_f_2", "cellnoise_f_3", "cellnoise_f_4",
                    "cellnoise_3_1", "cellnoise_3_2", "cellnoise_3_3", "cellnoise_3_4",
                    "random_f",      "random_3"};

// --- the definition once more, in double

using u32 = std::uint32_t;
constexpr u32 primes[4] = {0x8da6b343, 0xb5297a4d, 0xcb1ab31f, 0xa7d69b35};
constexpr u32 multipliers[3] = {0xe3779b97, 0x9d2c5681, 0x2c1b3c6d};

bool bit(u32 h, int n) {
    return h >> n & 1;
}

double gradient(u32 h, int dims, const double* d) {
    const auto sign = [h](int n, double v) { return bit(h, n) ? -v : v; };
    switch (dims) {
    case 1:
        return sign(31, (1 + static_cast<double>(h >> 28 & 7)) * d[0]);
    case 2: {
        const double u = bit(h, 31) ? d[1] : d[0], v = bit(h, 31) ? d[0] : d[1];
        return sign(30, u) + 2 * sign(29, v);
    }
    case 3: {
        const double a = sign(28, 0.822598);
        const double along =
            bit(h, 30)   ? sign(29, 0.997497) * d[0] + sign(28, 0.997497) * d[1] + 0.1 * d[2]
            : bit(h, 29) ? a * d[1] + 1.150362 * d[2]
                         : a * d[0] + 1.150362 * d[2];
        return sign(31, along);
    }
    default: {
        const double u = bit(h, 31) && bit(h, 30) ? d[1] : d[0], v = bit(h, 31) ? d[2] : d[1];
        const double w = bit(h, 31) || bit(h, 30) ? d[3] : d[2];
        return sign(29, u) + sign(28, v) + sign(27, w);
    }
    }
}

// period 0: not periodic
double reference_noise(int dims, int channel, const double* a, const double* period) {
    const double scale[5] = {0, 0.094, 0.2535, 0.468, 0.435};
    double sum = 0;
    for (int corner = 0; corner < 1 << dims; corner++) {
        u32 h = 0;
        double d[4], weight = 1;
        for (int k = 0; k < dims; k++) {
            const int up = corner >> k & 1;
            const double whole = std::floor(a[k]);
            // the offset is rounded to float in the definition
            const double f = static_cast<double>(static_cast<float>(a[k] - whole));
            double index = whole + up;
            if (period[k] > 0)
                index -= period[k] * std::floor(index / period[k]);
            const u32 term = static_cast<u32>(static_cast<std::int64_t>(index)) * primes[k];
            h ^= k == 0 ? term + 0x9e3779b9u * static_cast<u32>(dims) : term;
            d[k] = f - up;
            const double w = f * f * f * (f * (6 * f - 15) + 10);
            weight *= up ? w : 1 - w;
        }
        sum += weight * gradient(h * multipliers[channel], dims, d);
    }
    return 0.5 + scale[dims] * sum;
}

Planes random_points(std::size_t dims, double range, std::size_t n) {
    Planes in;
    for (std::size_t k = 0; k < dims; k++)
        in.push_back(scatter(-range, range, n, static_cast<int>(k)));
    return in;
}

std::string shape(const std::string& family, int channels, int dims) {
    return family + "_" + (channels == 3 ? "3" : "f") + "_" + std::to_string(dims);
}

TEST(Noise, MatchesItsDefinition) {
    const std::size_t n = 600;
    for (int dims = 1; dims <= 4; dims++)
        for (const int channels : {1, 3}) {
            const Planes in = random_points(static_cast<std::size_t>(dims), 50, n);
            const Planes got = run_all(shape("noise", channels, dims), in, n);
            for (std::size_t i = 0; i < n; i++) {
                double a[4], period[4] = {};
                for (int k = 0; k < dims; k++)
                    a[k] = in[static_cast<std::size_t>(k)][i];
                for (int c = 0; c < channels;
                     c++) // 1e-6: some 30 float operations on values below 8
                    ASSERT_NEAR(got[static_cast<std::size_t>(c)][i],
                                reference_noise(dims, c, a, period), 1e-6);
            }
        }
}

TEST(Noise, PeriodicMatchesItsDefinition) {
    const std::size_t n = 600;
    const double periods[4] = {5, 3, 7.4, 0.2}; // rounded to 5 3 7 1
    for (int dims = 1; dims <= 4; dims++)
        for (const int channels : {1, 3}) {
            const auto d = static_cast<std::size_t>(dims);
            Planes in = random_points(d, 40, n);
            for (std::size_t k = 0; k < d; k++)
                in.push_back(std::vector<float>(n, static_cast<float>(periods[k])));
            const Planes got = run_all(shape("pnoise", channels, dims), in, n);
            for (std::size_t i = 0; i < n; i++) {
                double a[4], rounded[4] = {5, 3, 7, 1};
                for (std::size_t k = 0; k < d; k++)
                    a[k] = in[k][i];
                for (int c = 0; c < channels; c++)
                    ASSERT_NEAR(got[static_cast<std::size_t>(c)][i],
                                reference_noise(dims, c, a, rounded), 1e-6);
            }
        }
}

TEST(Noise, RepeatsWithThePeriod) {
    const std::size_t n = 400;
    Planes in(6);
    for (std::size_t k = 0; k < 3; k++) { // multiples of 1/64: adding the period is exact
        in[k] = scatter(-20, 20, n, static_cast<int>(k));
        for (float& v : in[k])
            v = std::floor(v * 64) / 64;
        in[k + 3].assign(n, 4.0f);
    }
    const Planes here = run_all("pnoise_f_3", in, n);
    for (float& v : in[1])
        v += 4 * 3;
    const Planes there = run_all("pnoise_f_3", in, n);
    EXPECT_EQ(here, there);
}

struct Moments {
    double mean = 0, sigma = 0, low = 1, high = 0;
};

Moments moments(const std::vector<float>& v) {
    Moments m;
    double squares = 0;
    for (const float x : v) {
        m.mean += x;
        squares += static_cast<double>(x) * x;
        m.low = std::min<double>(m.low, x);
        m.high = std::max<double>(m.high, x);
    }
    m.mean /= static_cast<double>(v.size());
    m.sigma = std::sqrt(squares / static_cast<double>(v.size()) - m.mean * m.mean);
    return m;
}

TEST(Noise, StatisticsMeetTheSpecification) {
    const std::size_t n = 200000;
    for (int dims = 1; dims <= 4; dims++) {
        const Planes got = run(widths().back(), shape("noise", 3, dims),
                               random_points(static_cast<std::size_t>(dims), 500, n), n);
        for (const auto& channel : got) {
            const Moments m = moments(channel);
            EXPECT_NEAR(m.mean, 0.5, 0.01) << dims;
            EXPECT_GE(m.low, 0) << dims;
            EXPECT_LE(m.high, 1) << dims;
            if (dims == 3) {
                EXPECT_GE(m.sigma, 0.12);
                EXPECT_LE(m.sigma, 0.16);
            }
            RecordProperty("sigma_" + std::to_string(dims), std::to_string(m.sigma));
        }
    }
}

double correlation(const std::vector<float>& a, const std::vector<float>& b) {
    const Moments ma = moments(a), mb = moments(b);
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); i++)
        sum += (a[i] - ma.mean) * (b[i] - mb.mean);
    return sum / (static_cast<double>(a.size()) * ma.sigma * mb.sigma);
}

TEST(Noise, ChannelsAreIndependent) {
    const std::size_t n = 100000;
    for (const char* name : {"noise_3_3", "cellnoise_3_3"}) {
        const Planes got = run(widths().back(), name, random_points(3, 500, n), n);
        // samples in some 1e6 cells are independent: 4 / sqrt(n) is four standard deviations
        EXPECT_NEAR(correlation(got[0], got[1]), 0, 4 / std::sqrt(n)) << name;
        EXPECT_NEAR(correlation(got[0], got[2]), 0, 4 / std::sqrt(n)) << name;
        EXPECT_NEAR(correlation(got[1], got[2]), 0, 4 / std::sqrt(n)) << name;
    }
}

// No direction and no lag stands out: values at equal places of cells that lie a lattice step
// apart.
TEST(Noise, CellsAreDecorrelatedInAllDirections) {
    const std::size_t n = 40000;
    for (const char* name : {"noise_f_3", "cellnoise_f_3"}) {
        const Planes here = random_points(3, 300, n);
        const Planes value = run(widths().back(), name, here, n);
        for (const auto& step : {std::array<int, 3>{2, 0, 0},
                                 {0, 2, 0},
                                 {0, 0, 2},
                                 {2, 2, 0},
                                 {0, 2, -2},
                                 {3, 0, 0},
                                 {16, 0, 0},
                                 {0, 64, 0},
                                 {0, 0, 256},
                                 {128, 128, 128},
                                 {5, -5, 5}}) {
            Planes there = here;
            for (std::size_t k = 0; k < 3; k++)
                for (float& v : there[k])
                    v += static_cast<float>(step[k]);
            const Planes moved = run(widths().back(), name, there, n);
            EXPECT_NEAR(correlation(value[0], moved[0]), 0, 4.5 / std::sqrt(n))
                << name << " " << step[0] << " " << step[1] << " " << step[2];
        }
    }
}

TEST(Noise, HalfAtLatticePointsAndOutsideTheNumbers) {
    const float inf = std::numeric_limits<float>::infinity(), nan = std::nanf("");
    const std::vector<float> lattice = {0,         1,    -1,     7,   -300, 65536, 8388608,
                                        -16777216, 3e9f, -1e20f, inf, -inf, nan};
    const std::size_t n = lattice.size();
    for (int dims = 1; dims <= 4; dims++)
        for (const int channels : {1, 3})
            for (const auto& plane : run_all(shape("noise", channels, dims),
                                             Planes(static_cast<std::size_t>(dims), lattice), n))
                for (const float v : plane)
                    EXPECT_EQ(v, 0.5f);
    Planes mixed = {scatter(-5, 5, 8, 0), std::vector<float>(8, nan), scatter(-5, 5, 8, 1)};
    for (const float v : run_plane(0, "noise_f_3", mixed, 8))
        EXPECT_EQ(v, 0.5f);
    for (const float v : run_plane(0, "cellnoise_f_3", mixed, 8))
        EXPECT_EQ(v, 0.5f);
    mixed[1].assign(8, inf);
    for (const float v : run_plane(0, "pnoise_f_3",
                                   {mixed[0], mixed[1], mixed[2], mixed[0], mixed[0], mixed[0]}, 8))
        EXPECT_EQ(v, 0.5f);
}

TEST(Noise, HugeCoordinatesAreDefined) {
    Planes in = {{1e10f, -1e10f, 3e38f, 2147483648.0f, -4294967296.0f},
                 {0.5f, 0.5f, 0.5f, 0.5f, 0.5f}};
    for (const char* name : {"noise_f_2", "cellnoise_f_2"})
        for (const float v : run_plane(0, name, in, 5)) {
            EXPECT_GE(v, 0);
            EXPECT_LE(v, 1);
        }
    const std::vector<float> bad = {0, -3, std::nanf(""), std::numeric_limits<float>::infinity(),
                                    1e30f};
    for (const float v :
         run_plane(0, "pnoise_f_1", {{1.25f, 1.25f, 1.25f, 1.25f, 1.25f}, bad}, 5)) {
        EXPECT_GE(v, 0);
        EXPECT_LE(v, 1);
    }
}

TEST(Noise, IsSmoothAcrossCells) {
    const double h = 1e-3; // one-sided slopes at a lattice plane agree to O(h)
    for (const double y : {0.3, 0.77, -4.2}) {
        const std::vector<float> ys(3, static_cast<float>(y));
        const Planes v = run_all(
            "noise_f_2", {{static_cast<float>(5 - h), 5.0f, static_cast<float>(5 + h)}, ys}, 3);
        const double left = (v[0][1] - v[0][0]) / h, right = (v[0][2] - v[0][1]) / h;
        EXPECT_NEAR(left, right, 0.02);
    }
}

TEST(CellNoise, IsConstantPerCellAndUniform) {
    const std::size_t n = 64000;
    for (int dims = 1; dims <= 4; dims++) {
        Planes low(static_cast<std::size_t>(dims)), high;
        for (std::size_t k = 0; k < low.size(); k++) {
            low[k] = scatter(-2000, 2000, n, static_cast<int>(k));
            for (float& v : low[k])
                v = std::floor(v);
        }
        high = low;
        for (auto& plane : high)
            for (float& v : plane)
                v += 0.9375f; // the same cell, on the negative side too
        const std::string name = shape("cellnoise", 1, dims);
        const Planes a = run(widths().back(), name, low, n),
                     b = run(widths().back(), name, high, n);
        EXPECT_EQ(a, b) << dims;
        // 3.9k distinct cells in 1-D repeat; beyond that chi-square of 32 bins: 31 +- 7.9, 5 sigma
        // is 71
        double bins[32] = {}, chi = 0;
        for (const float v : a[0]) {
            ASSERT_GE(v, 0);
            ASSERT_LT(v, 1);
            bins[static_cast<int>(v * 32)]++;
        }
        for (const double count : bins)
            chi += (count - n / 32.0) * (count - n / 32.0) / (n / 32.0);
        if (dims > 1) {
            EXPECT_LT(chi, 71) << dims;
        }
        run_all(name, low, 64); // widths agree
        run_all(shape("cellnoise", 3, dims), low, 64);
    }
}

TEST(CellNoise, FirstChannelIsTheFloatForm) {
    const Planes in = random_points(3, 100, 200);
    EXPECT_EQ(run_all("cellnoise_3_3", in, 200)[0], run_all("cellnoise_f_3", in, 200)[0]);
    EXPECT_EQ(run_all("noise_3_3", in, 200)[0], run_all("noise_f_3", in, 200)[0]);
}

// random(): [0,1), new at each call and point, the same for the same seed, independent of the
// packet.
TEST(Random, FollowsTheSeedOnly) {
    const std::size_t n = 4096;
    rt::TestEngine engine(8);
    rt::TestBatch batch(n, engine);
    Planes varying;
    for (const Width& width : widths()) {
        if (width.uniform)
            continue;
        const Planes v = run(width, "random_f", {}, n, &batch.batch());
        if (varying.empty())
            varying = v;
        EXPECT_EQ(v, varying) << width.name;
    }
    const Moments first = moments(varying[0]);
    EXPECT_NEAR(first.mean, 0.5, 4 * 0.2887 / std::sqrt(n)); // four standard deviations of the mean
    EXPECT_NEAR(first.sigma, 0.2887, 0.01);
    EXPECT_LT(first.high, 1);
    EXPECT_NEAR(correlation(varying[0], varying[1]), 0, 4 / std::sqrt(n)); // first and second call
    const Planes triple = run(widths().back(), "random_3", {}, n, &batch.batch());
    EXPECT_NEAR(correlation(triple[0], triple[1]), 0, 4 / std::sqrt(n));
    EXPECT_NEAR(correlation(triple[1], triple[2]), 0, 4 / std::sqrt(n));
}

TEST(Random, OneValueForUniformTargets) {
    rt::TestEngine engine(4);
    rt::TestBatch batch(8, engine);
    const Planes v = run(widths()[0], "random_f", {}, 8, &batch.batch());
    EXPECT_NE(v[0][0], v[1][0]); // two calls
    const Planes again = run(widths()[0], "random_f", {}, 8, &batch.batch());
    EXPECT_EQ(v, again);
}

} // namespace
} // namespace lanes_test
