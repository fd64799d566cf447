// SPDX-License-Identifier: Apache-2.0
// Filter values against ri.md 9.3 worked out by hand, and the weight tables against the filters.
#include "tracer/filter.h"

#include <cmath>
#include <gtest/gtest.h>

namespace {

using trace::Filter;

constexpr const char* all_filters[] = {"box",
                                       "triangle",
                                       "catmull-rom",
                                       "gaussian",
                                       "sinc",
                                       "mitchell",
                                       "disk",
                                       "blackman-harris",
                                       "bessel",
                                       "lanczos",
                                       "separable-catmull-rom"};

class FilterTest : public testing::Test {
protected:
    Filter filter(const char* name, float wx, float wy) { return Filter(name, wx, wy, diag_); }
    std::FILE* null_ = std::fopen("/dev/null", "w");
    base::Diag diag_{null_};
    ~FilterTest() override { std::fclose(null_); }
};

TEST_F(FilterTest, ValuesByHand) {
    constexpr double eps = 1e-9; // double evaluation of the same closed forms
    EXPECT_EQ(filter("box", 2, 3).value(1, -1.5), 1);
    EXPECT_NEAR(filter("triangle", 4, 2).value(1, 0.25), 0.5 * 0.75, eps);
    EXPECT_NEAR(filter("gaussian", 2, 2).value(0.5, 1), std::exp(-2 * 1.25), eps);
    EXPECT_NEAR(filter("gaussian", 4, 1).value(1, 0.25), std::exp(-1.0), eps);
    // r = 0.5: 3/8 - 5/4 + 2; r = 1.5: -27/8 + 45/4 - 12 + 4.
    EXPECT_NEAR(filter("catmull-rom", 4, 4).value(0.3, 0.4), 1.125, eps);
    EXPECT_NEAR(filter("catmull-rom", 4, 4).value(0.9, 1.2), -0.125, eps);
    EXPECT_EQ(filter("catmull-rom", 4, 4).value(1.6, 1.6), 0); // beyond r = 2
    EXPECT_NEAR(filter("separable-catmull-rom", 4, 4).value(0.5, 1.5), 1.125 * -0.125, eps);
    // cos(pi/8 ... ) sin(pi a)/(pi a) at a = 0.5, w = 4.
    EXPECT_NEAR(filter("sinc", 4, 4).value(0.5, 0), std::cos(M_PI / 16) * 2 / M_PI, eps);
    EXPECT_NEAR(filter("lanczos", 4, 4).value(0.5, 0), 2 / M_PI * std::sin(M_PI / 4) * 4 / M_PI,
                eps);
    // B = C = 1/3 at 0: (6 - 2/3) / 6; at a = 1: 1/18, from either piece.
    EXPECT_NEAR(filter("mitchell", 4, 4).value(0, 0), 64.0 / 81, eps);
    EXPECT_NEAR(filter("mitchell", 4, 4).value(1, 0), 1.0 / 18 * 8 / 9, eps);
    EXPECT_EQ(filter("disk", 2, 4).value(0.6, 1.5), 1);
    EXPECT_EQ(filter("disk", 2, 4).value(0.7, 1.5), 0);
    EXPECT_NEAR(filter("blackman-harris", 2, 2).value(0, 0), 1,
                eps); // the four coefficients add up to 1
    EXPECT_NEAR(filter("blackman-harris", 2, 2).value(1, 0), 6e-5, eps);
    EXPECT_NEAR(filter("bessel", 4, 4).value(1, 0),
                std::cos(M_PI / 4) * 2 * 0.2846153431797527 / M_PI, eps);
}

TEST_F(FilterTest, SymmetricAndZeroOutside) {
    for (const char* name : all_filters) {
        const Filter f = filter(name, 4, 4);
        EXPECT_EQ(f.name(), name);
        for (const double x : {0.1, 0.7, 1.3, 1.9}) {
            EXPECT_EQ(f.value(x, 0.4), f.value(-x, 0.4)) << name;
            EXPECT_EQ(f.value(x, 0.4), f.value(x, -0.4)) << name;
            EXPECT_NEAR(f.value(x, 0.4), f.value(0.4, x), 1e-15)
                << name; // products commute up to rounding
        }
        EXPECT_EQ(f.value(2.001, 0), 0) << name;
        EXPECT_EQ(f.value(0, -2.001), 0) << name;
    }
    EXPECT_EQ(diag_.count(base::Severity::Error), 0U);
}

TEST_F(FilterTest, Reach) {
    EXPECT_EQ(filter("box", 1, 2).reach_x(), 0);
    EXPECT_EQ(filter("box", 1, 2).reach_y(), 1);
    EXPECT_EQ(filter("box", 3, 3.1f).reach_x(), 1);
    EXPECT_EQ(filter("box", 3, 3.1f).reach_y(), 2);
    EXPECT_EQ(filter("box", 0.3f, 4).reach_x(), 0);
    EXPECT_EQ(filter("box", 0.3f, 4).reach_y(), 2);
}

TEST_F(FilterTest, UnknownNamesAndWidths) {
    EXPECT_EQ(filter("gausian", 2, 2).name(), "gaussian");
    EXPECT_EQ(filter("box", -1, NAN).width_x(), 2);
    EXPECT_EQ(filter("box", 1e9f, 1).width_x(), 32);
    EXPECT_EQ(diag_.count(base::Severity::Error), 3U);
    EXPECT_EQ(diag_.count(base::Severity::Warning), 1U);
}

TEST_F(FilterTest, TablesHoldTheFilter) {
    const trace::Sampler sampler({.nx = 3, .ny = 2});
    for (const char* name : all_filters) {
        const Filter f = filter(name, 3, 4.5f);
        const trace::FilterWeights weights(f, sampler);
        for (std::size_t p = 0; p < 5; ++p) {
            std::size_t k = 0;
            for (int dy = -f.reach_y(); dy <= f.reach_y(); ++dy) {
                for (int dx = -f.reach_x(); dx <= f.reach_x(); ++dx, ++k) {
                    for (int s = 0; s < 6; ++s) {
                        const auto i = static_cast<std::size_t>(s);
                        const double expected = f.value(dx + double(sampler.pattern_x(p)[i]) - 0.5,
                                                        dy + double(sampler.pattern_y(p)[i]) - 0.5);
                        EXPECT_EQ(weights.weights(p * weights.neighbours() + k)[i],
                                  static_cast<float>(expected))
                            << name;
                        const auto span = weights.span(p * weights.neighbours() + k);
                        EXPECT_TRUE(expected == 0 || (s >= span.first && s < span.last)) << name;
                    }
                }
            }
            EXPECT_EQ(k, weights.neighbours());
        }
    }
}

} // namespace
