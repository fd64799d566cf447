// SPDX-License-Identifier: Apache-2.0
// Exposure and quantisation by hand (ri.md 9.4, 9.5), and the statistics of dither.
#include "tracer/quantize.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <vector>

namespace {

using trace::Quantizer;
using trace::Storage;

std::int64_t levels(const Quantizer& q, float value, float noise) {
    return trace::Levels(q)(value, noise);
}

TEST(Quantizer, RoundsAndClamps) {
    const Quantizer q{0, 255, 0, 255, 0};
    EXPECT_EQ(levels(q, 0.5f, 0.9f), 128); // 127.5 rounds up; no dither, no noise
    EXPECT_EQ(levels(q, 0.498f, 0), 127);  // 126.99
    EXPECT_EQ(levels(q, -1, 0), 0);
    EXPECT_EQ(levels(q, 7, 0), 255);
    EXPECT_EQ(levels(q, std::numeric_limits<float>::infinity(), 0), 255);
    EXPECT_EQ(levels(q, std::numeric_limits<float>::quiet_NaN(), 0), 0);
    EXPECT_EQ(levels({7, 7, 0, 255, 0}, std::numeric_limits<float>::infinity(), 0), 0); // inf * 0
}

TEST(Quantizer, DitherLeavesWholeLevelsAlone) {
    const Quantizer q{0, 255, 0, 255, 0.5};
    for (int level = 0; level <= 255; ++level) {
        for (const float noise : {-1.0f, -0.3f, 0.0f, 0.99999f}) {
            EXPECT_EQ(levels(q, static_cast<float>(level) / 255.0f, 0.99f * noise), level);
        }
    }
    EXPECT_EQ(levels(q, 0, -1), 0); // -0.5 + 0.5 rounds to 0
}

TEST(Quantizer, ZeroLevel) {
    const Quantizer q{16, 235, 0, 255, 0}; // "quantize" [16 235 0 255]
    EXPECT_EQ(levels(q, 0, 0), 16);
    EXPECT_EQ(levels(q, 1, 0), 235);
    EXPECT_EQ(levels(q, 0.5f, 0), 126); // 125.5
}

TEST(Quantizer, StorageFollowsTheRange) {
    const auto storage = [](double min, double max) {
        return Quantizer{0, 255, min, max, 0}.storage();
    };
    EXPECT_EQ(storage(0, 255), Storage::U8);
    EXPECT_EQ(storage(0, 256), Storage::U16);
    EXPECT_EQ(storage(0, 65535), Storage::U16);
    EXPECT_EQ(storage(0, 65536), Storage::U32);
    EXPECT_EQ(storage(-1, 127), Storage::S8);
    EXPECT_EQ(storage(-1, 255), Storage::S16);
    EXPECT_EQ(storage(-40000, 5), Storage::S32);
    EXPECT_EQ((Quantizer{0, 0, 0, 0, 0}.storage()), Storage::Float);
}

TEST(Quantizer, ThirtyTwoBits) {
    const Quantizer q{0, 4294967295.0, 0, 4294967295.0, 0.5};
    EXPECT_EQ(q.storage(), Storage::U32);
    EXPECT_EQ(levels(q, 1, 0.9f), 4294967295LL);
    EXPECT_EQ(levels(q, 2, 0), 4294967295LL);
    const Quantizer beyond{0, 1e12, 0, 1e12, 0}; // clamped to what the type holds
    EXPECT_EQ(levels(beyond, 1, 0), 4294967295LL);
}

TEST(Dither, MeanKeepsTheValueAndErrorsAreWhite) {
    const Quantizer q{0, 255, 0, 255, 0.5};
    constexpr int n = 256;
    for (const double level : {10.1, 10.5, 77.77, 200.9}) {
        double sum = 0, neighbours = 0;
        std::vector<double> error(n * n);
        for (int y = 0; y < n; ++y) {
            for (int x = 0; x < n; ++x) {
                const double got = static_cast<double>(
                    levels(q, static_cast<float>(level / 255), trace::dither_noise(x, y, 0)));
                error[static_cast<std::size_t>(y * n + x)] = got - level;
                sum += got;
            }
        }
        const double fraction = level - std::floor(level), variance = fraction * (1 - fraction);
        // 65536 independent draws: 5 standard errors, one false alarm in a million.
        EXPECT_NEAR(sum / (n * n), level, 5 * std::sqrt(variance) / n + 1e-5);
        for (std::size_t i = 0; i + 1 < error.size(); ++i) {
            neighbours += error[i] * error[i + 1];
        }
        EXPECT_NEAR(neighbours / (n * n), 0, 5 * variance / n);
    }
}

TEST(Dither, ChannelsAndPixelsDiffer) {
    double same = 0, total = 0, sum = 0, squares = 0;
    for (int x = -50; x < 50; ++x) {
        for (int y = 0; y < 100; ++y) {
            const double a = trace::dither_noise(x, y, 0), b = trace::dither_noise(x, y, 1);
            ASSERT_GE(a, -1);
            ASSERT_LT(a, 1);
            same += a * b;
            sum += a;
            squares += a * a;
            ++total;
        }
    }
    // Uniform in [-1, 1]: mean 0, variance 1/3; 5 standard errors.
    EXPECT_NEAR(sum / total, 0, 5 * std::sqrt(1.0 / 3 / total));
    EXPECT_NEAR(squares / total, 1.0 / 3, 5 * std::sqrt(4.0 / 45 / total));
    EXPECT_NEAR(same / total, 0, 5.0 / 3 / std::sqrt(total));
    EXPECT_EQ(trace::dither_noise(3, 4, 2), trace::dither_noise(3, 4, 2));
}

trace::Image image_of(float value) {
    trace::Image image;
    image.pixels = {0, 0, 1, 1};
    for (auto& plane : image.planes) {
        plane.assign(1, value);
    }
    return image;
}

TEST(Exposure, GainThenGamma) {
    trace::Image image = image_of(0.18f);
    apply_exposure(image, {2, 2.2f});
    EXPECT_NEAR(image.plane(trace::Plane::R)[0], std::pow(0.36, 1 / 2.2), 1e-6); // float pow
    EXPECT_EQ(image.plane(trace::Plane::A)[0], 0.18f);
    EXPECT_EQ(image.plane(trace::Plane::Z)[0], 0.18f);
    image = image_of(-0.25f);
    apply_exposure(image, {1, 2});
    EXPECT_FLOAT_EQ(image.plane(trace::Plane::G)[0], -0.5f);
    image = image_of(0.3f);
    apply_exposure(image, {});
    EXPECT_EQ(image.plane(trace::Plane::B)[0], 0.3f);
}

TEST(Exposure, DisplaysOverride) {
    rib::Options o;
    o.gain = 3;
    o.gamma = 2;
    rib::Display d;
    EXPECT_EQ(trace::exposure_of(o, d), (trace::Exposure{3, 2}));
    rib::Param p;
    p.name = "exposure";
    p.decl.array_length = 2;
    p.floats = {1, 1.8f};
    d.params.params.push_back(p);
    EXPECT_EQ(trace::exposure_of(o, d), (trace::Exposure{1, 1.8f}));
    p.name = "gamma";
    p.floats = {-1};
    d.params.params.push_back(p);
    EXPECT_EQ(trace::exposure_of(o, d), (trace::Exposure{1, 1}));
}

} // namespace
