// SPDX-License-Identifier: Apache-2.0
// Patches and NURBS against closed forms and direct evaluation of their bases in double.
#include "geometry/bezier.h"

#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace {

using base::V3d;
using geo::PatchLayout;
using geo::SpanMap;

constexpr std::array<float, 16> bezier{-1, 3, -3, 1, 3, -6, 3, 0, -3, 3, 0, 0, 1, 0, 0, 0};
constexpr std::array<float, 16> catmull_rom{-0.5f, 1.5f, -1.5f, 0.5f, 1, -2.5f, 2, -0.5f,
                                            -0.5f, 0,    0.5f,  0,    0, 1,     0, 0};
constexpr std::array<float, 16> power{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

std::vector<double> random_net(int count, unsigned seed) {
    std::mt19937 rng(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    std::vector<double> net;
    for (int i = 0; i < count; ++i) {
        net.insert(net.end(), {uniform(rng), uniform(rng), uniform(rng), 1});
    }
    return net;
}

std::vector<double> without_weights(const std::vector<double>& net) {
    std::vector<double> points;
    for (std::size_t i = 0; i < net.size(); i += 4) {
        points.insert(points.end(), net.begin() + long(i), net.begin() + long(i) + 3);
    }
    return points;
}

// ri.md 11.4 as it stands: powers times basis times control points.
V3d direct_bicubic(const std::array<float, 16>& m, const std::vector<double>& net, int nu, int a,
                   int b, int step, double u, double v) {
    V3d p;
    const double pu[4] = {u * u * u, u * u, u, 1}, pv[4] = {v * v * v, v * v, v, 1};
    for (int j = 0; j < 4; ++j) {
        for (int i = 0; i < 4; ++i) {
            double bu = 0, bv = 0;
            for (int k = 0; k < 4; ++k) {
                bu += pu[k] * double(m[std::size_t(4 * k + i)]);
                bv += pv[k] * double(m[std::size_t(4 * k + j)]);
            }
            const double* c = net.data() + 4 * ((b * step + j) * nu + a * step + i);
            p += V3d{c[0], c[1], c[2]} * (bu * bv);
        }
    }
    return p;
}

// Cox-de Boor, ri.md 11.6.
double basis_function(const std::vector<float>& knot, int i, int order, double t) {
    const auto k = [&](int at) { return double(knot[std::size_t(at)]); };
    if (order == 1) {
        return k(i) <= t && t < k(i + 1) ? 1 : 0;
    }
    const double a = k(i + order - 1) - k(i), b = k(i + order) - k(i + 1);
    return (a > 0 ? (t - k(i)) / a * basis_function(knot, i, order - 1, t) : 0) +
           (b > 0 ? (k(i + order) - t) / b * basis_function(knot, i + 1, order - 1, t) : 0);
}

TEST(Bezier, BicubicBasesAgreeWithTheirDefinition) {
    for (const auto& basis : {bezier, catmull_rom, power}) {
        std::string reason;
        rib::Patches patches{.bicubic = true, .nu = 6, .nv = 5};
        const rib::Basis b{.u = basis, .v = basis, .ustep = 1, .vstep = 1};
        const auto layout = PatchLayout::make(patches, b, reason);
        ASSERT_TRUE(layout) << reason;
        const auto net = random_net(30, 1);
        const auto values = geo::position_net(*layout, without_weights(net), false);
        for (int part = 0; part < layout->num_parts(); ++part) {
            for (double u : {0.0, 0.3, 1.0}) {
                for (double v : {0.0, 0.7, 1.0}) {
                    const auto got = geo::evaluate_part(3, 3, values.data() + part * 64, u, v);
                    const V3d want = direct_bicubic(basis, net, 6, part % 3, part / 3, 1, u, v);
                    EXPECT_LT(length(got.P - want), 1e-13); // rounding of some 50 products of O(1)
                }
            }
        }
    }
}

TEST(Bezier, DerivativesMatchCentralDifferences) {
    const auto net = random_net(16, 2);
    const double h = 1e-5;
    const auto p = geo::evaluate_part(3, 3, net.data(), 0.4, 0.6);
    const auto at = [&](double s, double t) {
        return geo::evaluate_part(3, 3, net.data(), s, t).P;
    };
    EXPECT_LT(length((at(0.4 + h, 0.6) - at(0.4 - h, 0.6)) / (2 * h) - p.dPdu), 1e-8); // h^2 P'''
    EXPECT_LT(length((at(0.4, 0.6 + h) - at(0.4, 0.6 - h)) / (2 * h) - p.dPdv), 1e-8);
}

TEST(Bezier, NurbsAgreesWithCoxDeBoor) {
    std::mt19937 rng(3);
    for (int order = 2; order <= 6; ++order) {
        const int n = order + 5;
        std::vector<float> knots;
        for (int i = 0; i < n + order; ++i) {
            knots.push_back(float(i / 2)); // double knots: empty spans in between
        }
        std::string reason;
        rib::NuPatch patch{.nu = n,
                           .uorder = order,
                           .nv = 2,
                           .vorder = 2,
                           .uknot = knots,
                           .vknot = {0, 0, 1, 1},
                           .umin = knots[std::size_t(order - 1)],
                           .umax = knots[std::size_t(n)]};
        const auto layout = PatchLayout::make(patch, reason);
        ASSERT_TRUE(layout) << reason;
        auto net = random_net(2 * n, unsigned(order));
        for (int i = 0; i < 2 * n; ++i) { // rational, positive weights
            const double w = 0.5 + (i % 3);
            for (int k = 0; k < 4; ++k) {
                net[std::size_t(4 * i + k)] *= w;
            }
        }
        const auto values = geo::bezier_values(*layout, net, 4);
        for (int part = 0; part < layout->num_parts(); ++part) {
            const auto& span = layout->part_u(part);
            for (double s : {0.01, 0.5, 0.99}) {
                const double u = span.t0 + s * (span.t1 - span.t0);
                double h[4] = {};
                for (int i = 0; i < n; ++i) {
                    for (int k = 0; k < 4; ++k) {
                        h[k] += basis_function(knots, i, order, u) * net[std::size_t(4 * i + k)];
                    }
                }
                const auto got = geo::evaluate_part(
                    order - 1, 1, values.data() + std::size_t(part) * 4 * layout->points_per_part(),
                    s, 0);
                EXPECT_LT(length(got.P - V3d{h[0], h[1], h[2]} / h[3]), 1e-12);
            }
        }
    }
}

TEST(Bezier, RationalQuarterCircleIsRound) {
    const double w = std::sqrt(0.5);
    const double net[] = {1, 0, 0, 1, w, w, 0, w, 0, 1, 0, 1};
    for (int i = 0; i <= 100; ++i) {
        const auto p = geo::evaluate_part(2, 0, net, i / 100.0, 0);
        EXPECT_NEAR(length(p.P), 1, 1e-14);
        EXPECT_NEAR(dot(p.P, p.dPdu), 0, 1e-13);
    }
}

TEST(Bezier, NeighboursShareEdgeValuesBitForBit) {
    std::string reason;
    rib::Patches patches{.bicubic = true, .nu = 8, .nv = 8, .uperiodic = true, .vperiodic = true};
    std::array<float, 16> spline;
    const float s[] = {-1, 3, -3, 1, 3, -6, 3, 0, -3, 0, 3, 0, 1, 4, 1, 0};
    for (std::size_t i = 0; i < 16; ++i) {
        spline[i] = s[i] / 6;
    }
    const rib::Basis b{.u = spline, .v = spline, .ustep = 1, .vstep = 1};
    const auto layout = PatchLayout::make(patches, b, reason);
    ASSERT_TRUE(layout);
    const auto values = geo::position_net(*layout, without_weights(random_net(64, 7)), false);
    for (int j = 0; j < 8; ++j) {
        for (int i = 0; i < 8; ++i) {
            const double* here = values.data() + 64 * (8 * j + i);
            const double* right = values.data() + 64 * (8 * j + (i + 1) % 8);
            const double* above = values.data() + 64 * (8 * ((j + 1) % 8) + i);
            for (int k = 0; k < 4; ++k) {
                for (int c = 0; c < 4; ++c) {
                    EXPECT_EQ(here[4 * (4 * k + 3) + c], right[4 * (4 * k) + c]);
                    EXPECT_EQ(here[4 * (12 + k) + c], above[4 * k + c]);
                }
            }
        }
    }
}

TEST(Bezier, BadCountsAreRefusedWithAReason) {
    std::string reason;
    EXPECT_FALSE(SpanMap::bicubic(3, false, bezier, 3, reason));
    EXPECT_FALSE(reason.empty());
    EXPECT_FALSE(SpanMap::bicubic(16, false, bezier, 0, reason));
    const std::vector<float> knots{0, 1, 0, 1};
    EXPECT_FALSE(SpanMap::nurbs(2, 2, knots, 0, 1, reason));
    EXPECT_FALSE(SpanMap::nurbs(2, 40, knots, 0, 1, reason));
    EXPECT_FALSE(SpanMap::nurbs(4, 2, knots, 0, 1, reason));
}

} // namespace
