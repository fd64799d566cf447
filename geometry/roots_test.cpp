// SPDX-License-Identifier: Apache-2.0
#include "geometry/roots.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>

namespace {

using geo::Roots;
using geo::solve_quadratic;
using geo::solve_quartic;

// Coefficients of (t - r0)(t - r1)(t - r2)(t - r3).
std::array<double, 5> from_roots(const std::array<double, 4>& r) {
    std::array<double, 5> c{1, 0, 0, 0, 0};
    int degree = 0;
    for (const double root : r) {
        ++degree;
        for (int i = degree; i > 0; --i) {
            c[std::size_t(i)] = c[std::size_t(i) - 1] - root * c[std::size_t(i)];
        }
        c[0] *= -root;
    }
    return c;
}

TEST(Roots, QuadraticKeepsTheSmallRoot) {
    // t^2 - 2e8 t + 1: the textbook formula loses the small root 5e-9 altogether.
    const Roots r = solve_quadratic(1, -1e8, 1);
    ASSERT_EQ(r.count, 2);
    EXPECT_NEAR(r.t[0], 5e-9, 1e-24);
    EXPECT_NEAR(r.t[1], 2e8, 1e-7);
}

TEST(Roots, QuadraticDegenerates) {
    const Roots linear = solve_quadratic(0, 1, -4);
    ASSERT_EQ(linear.count, 1);
    EXPECT_DOUBLE_EQ(linear.t[0], 2);
    EXPECT_EQ(solve_quadratic(0, 0, 1).count, 0);
    EXPECT_EQ(solve_quadratic(1, 0, 1).count, 0);
    EXPECT_EQ(solve_quadratic(NAN, 1, 1).count, 0);
    EXPECT_EQ(solve_quadratic(1, INFINITY, 1).count, 0);
    EXPECT_GE(solve_quadratic(1, 0, 0).count, 1);
}

TEST(Roots, QuarticFindsAllSeparatedRoots) {
    std::mt19937 rng(1);
    std::uniform_real_distribution<double> in(-2, 2);
    double worst = 0;
    for (int n = 0; n < 20000; ++n) {
        std::array<double, 4> expected{in(rng), in(rng), in(rng), in(rng)};
        std::sort(expected.begin(), expected.end());
        if (expected[1] - expected[0] < 0.02 || expected[2] - expected[1] < 0.02 ||
            expected[3] - expected[2] < 0.02) {
            continue;
        }
        const Roots r = solve_quartic(from_roots(expected), -3, 3);
        ASSERT_EQ(r.count, 4);
        for (std::size_t i = 0; i < 4; ++i) {
            worst = std::max(worst, std::fabs(r.t[i] - expected[i]));
        }
    }
    // Rounded coefficients move roots by about eps * |c| / |f'|; |f'| is at least 0.02^3 here.
    EXPECT_LT(worst, 1e-8);
}

TEST(Roots, QuarticLimitsAndTouching) {
    const auto c = from_roots({-1, 0.5, 0.5, 1.5});
    const Roots r = solve_quartic(c, 0, 1);
    ASSERT_GE(r.count, 1); // the double root is exact in these coefficients
    for (const double t : r) {
        EXPECT_NEAR(t, 0.5, 1e-7); // sqrt(eps): a double root has no more digits
    }
    EXPECT_EQ(solve_quartic({1, 0, 0, 0, 1}, -5, 5).count, 0); // t^4 + 1
    EXPECT_EQ(solve_quartic({NAN, 0, 0, 0, 1}, -5, 5).count, 0);
    EXPECT_EQ(solve_quartic({0, 0, 0, 0, 0}, 0, 1).count <= 4, true);
}

} // namespace
