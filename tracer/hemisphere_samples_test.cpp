// SPDX-License-Identifier: Apache-2.0
// Hemispheres against closed forms: means and gradients of fields whose irradiance is known.
#include "tracer/hemisphere_samples.h"

#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <limits>
#include <vector>

namespace trace {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

struct Met {
    float radiance, distance;
};
using Field = std::function<Met(const base::V3f& direction)>;

// Keeps what HemisphereAnswers refers to.
struct Asked {
    std::vector<base::V3f> direction;
    std::vector<base::Color> radiance;
    std::vector<float> distance;
    HemisphereAnswers answers;

    Asked(std::uint32_t wanted, const Field& field) {
        answers.strata = HemisphereStrata::of(wanted);
        const HemisphereCone cone = HemisphereCone::of(10, HemisphereDensity::Cosine);
        for (std::uint32_t i = 0; i < answers.strata.count(); ++i) {
            direction.push_back(direction_in(answers.strata, cone, i, 0.5f, 0.5f));
            const Met met = field(direction.back());
            radiance.emplace_back(met.radiance);
            distance.push_back(met.distance);
        }
        answers.direction = direction;
        answers.radiance = radiance;
        answers.distance = distance;
    }
};

TEST(HemisphereFrame, IsOrthonormalAboutAnyNormal) {
    for (const base::V3f n : {base::V3f(0, 0, 1), base::V3f(0, 0, -1), base::V3f(1, 2, -3),
                              base::V3f(-1e-4f, 1e-5f, -1)}) {
        const HemisphereFrame f = HemisphereFrame::about(n);
        EXPECT_NEAR(base::dot(f.x, f.y), 0, 1e-6);
        EXPECT_NEAR(base::dot(f.x, f.z), 0, 1e-6);
        EXPECT_NEAR(base::length(f.x), 1, 1e-6);
        EXPECT_NEAR(base::length(base::cross(f.x, f.y) - f.z), 0, 1e-6);
    }
}

TEST(HemisphereStrata, HasAboutAsManyCellsAsWanted) {
    for (const std::uint32_t wanted : {1U, 2U, 3U, 4U, 16U, 64U, 256U, 1000U, 4096U}) {
        const HemisphereStrata strata = HemisphereStrata::of(wanted);
        EXPECT_NEAR(strata.count(), wanted, 0.5 * strata.rings + 0.5) << wanted;
    }
}

// Over a cone of 60 degrees the mean of the cosine is 2/3 (1 - cos^3) / sin^2 when weighted by the
// cosine, (1 + cos) / 2 when not.
TEST(Directions, HaveTheDensityAsked) {
    const HemisphereStrata strata = HemisphereStrata::of(4000);
    const float angle = 1.0471975512f;
    for (const auto& [density, expected] :
         {std::pair(HemisphereDensity::Cosine, 2.0 / 3 * (1 - 0.125) / 0.75),
          std::pair(HemisphereDensity::Uniform, 0.75)}) {
        const HemisphereCone cone = HemisphereCone::of(angle, density);
        double sum = 0;
        for (std::uint32_t i = 0; i < strata.count(); ++i) {
            const base::V3f d = direction_in(strata, cone, i, 0.5f, 0.5f);
            EXPECT_NEAR(base::length(d), 1, 1e-6);
            EXPECT_GE(d.z, 0.5f - 1e-6f);
            sum += static_cast<double>(d.z);
        }
        EXPECT_NEAR(sum / strata.count(), expected, 1e-4); // midpoint rule, 36 rings
    }
}

TEST(SampleStream, IsEvenAndKnownByItsSeed) {
    SampleStream a(7), b(7), c(8);
    double sum = 0;
    bool differs = false;
    for (int i = 0; i < 10000; ++i) {
        const float x = a.next();
        EXPECT_EQ(x, b.next());
        differs |= x != c.next();
        EXPECT_GE(x, 0.0f);
        EXPECT_LT(x, 1.0f);
        sum += static_cast<double>(x);
    }
    EXPECT_TRUE(differs);
    EXPECT_NEAR(sum / 10000, 0.5, 0.012); // four standard errors
}

// Half of everything is bright: the mean of a tilted hemisphere is (1 + sin tilt) / 2.
TEST(Gradients, RotationTowardsABrightHalf) {
    const Asked asked(4096, [](const base::V3f& d) {
        return Met{d.x > 0 ? 1.0f : 0.0f, infinity};
    });
    EXPECT_NEAR(mean_radiance(asked.answers).r, 0.5f, 1e-6f);
    const IrradianceGradients g = irradiance_gradients(asked.answers);
    // 114 sectors: the bright edge lies within one of them.
    EXPECT_NEAR(g.rotation[0].y, 0.5f, 1e-3f);
    EXPECT_NEAR(g.rotation[0].x, 0, 0.5f / 114 * 3.2f);
    EXPECT_EQ(g.translation[0], base::V3f(0));
    EXPECT_EQ(harmonic_mean_distance(asked.answers), infinity);
}

// A ceiling at height h that is bright beyond x = c: the mean is (1 - sin atan(c / h)) / 2.
TEST(Gradients, TranslationUnderABrightHalfOfACeiling) {
    const float h = 2, c = 0.7f;
    const Asked asked(40000, [&](const base::V3f& d) {
        const float t = h / d.z;
        return Met{t * d.x > c ? 1.0f : 0.0f, t};
    });
    const float angle = std::atan(c / h);
    EXPECT_NEAR(mean_radiance(asked.answers).r, 0.5f * (1 - std::sin(angle)), 2e-3f);
    const IrradianceGradients g = irradiance_gradients(asked.answers);
    const float expected = 0.5f * std::pow(std::cos(angle), 3.0f) / h;
    EXPECT_NEAR(g.translation[1].x, expected, 0.03f * expected); // edges drawn by 113 rings
    EXPECT_NEAR(g.translation[1].y, 0, 0.02f * expected);
    // The mean of cos / h over cosine-weighted directions is 2/3 / h.
    EXPECT_NEAR(harmonic_mean_distance(asked.answers), 1.5f * h, 1e-2f);
}

} // namespace
} // namespace trace
