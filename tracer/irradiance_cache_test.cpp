// SPDX-License-Identifier: Apache-2.0
// The cache against fields it must reproduce, and its file against damage.
#include "runtime/base/file.h"
#include "runtime/base/temp_dir.h"
#include "tracer/irradiance_cache.h"
#include "tracer/irradiance_file.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace trace {
namespace {

IrradianceRecord record_at(const base::V3f& P, float radius, float mean = 1) {
    IrradianceRecord r;
    r.P = P;
    r.N = {0, 0, 1};
    r.mean = base::Color(mean);
    r.radius = radius;
    r.max_error = 0.25f;
    return r;
}

IrradianceCache::Point point_at(const base::V3f& P, const base::V3f& N = {0, 0, 1}) {
    return {P, base::normalize(N), 0.25f};
}

TEST(IrradianceCache, ReachesAsFarAsItsErrorAllows) {
    IrradianceCache cache;
    EXPECT_FALSE(cache.lookup(point_at({0, 0, 0})));
    ASSERT_TRUE(cache.insert(record_at({1, 2, 3}, 4)));
    EXPECT_TRUE(cache.covers(point_at({1, 2, 3})));
    EXPECT_TRUE(cache.covers(point_at({1.99f, 2, 3})));
    EXPECT_FALSE(cache.covers(point_at({2.01f, 2, 3}))); // 0.25 * 4 away
    EXPECT_TRUE(cache.lookup(point_at({2.3f, 2, 3}), IrradianceCache::slack));
    EXPECT_FALSE(cache.lookup(point_at({2.5f, 2, 3}), IrradianceCache::slack));
    EXPECT_TRUE(cache.lookup(point_at({3.9f, 2, 3}), IrradianceCache::far_slack));
    EXPECT_FALSE(cache.lookup(point_at({4.1f, 2, 3}), IrradianceCache::far_slack));
    // sqrt(1 - cos) reaches 0.25 at 20.36 degrees.
    EXPECT_TRUE(cache.covers(point_at({1, 2, 3}, {std::sin(0.355f), 0, std::cos(0.355f)})));
    EXPECT_FALSE(cache.covers(point_at({1, 2, 3}, {std::sin(0.357f), 0, std::cos(0.357f)})));
    IrradianceCache::Point exacting = point_at({1.5f, 2, 3});
    exacting.max_error = 0.1f;
    EXPECT_FALSE(cache.covers(exacting));
}

TEST(IrradianceCache, PointsBelowARecordDoNotUseIt) {
    IrradianceCache cache;
    ASSERT_TRUE(cache.insert(record_at({0, 0, 0}, 4)));
    EXPECT_TRUE(cache.covers(point_at({0, 0, 0.5f})));
    EXPECT_FALSE(cache.covers(point_at({0, 0, -0.5f})));
}

// Gradients make a linear field exact, wherever the records lie.
TEST(IrradianceCache, GradientsReproduceALinearField) {
    IrradianceCache cache;
    const auto field = [](const base::V3f& P) { return 3 + 0.5f * P.x - 0.25f * P.y; };
    for (int i = 0; i < 40; ++i) {
        IrradianceRecord r = record_at(
            {std::sin(7.0f * static_cast<float>(i)), std::cos(5.0f * static_cast<float>(i)), 0}, 4);
        r.mean = base::Color(field(r.P));
        r.translation.fill({0.5f, -0.25f, 0});
        ASSERT_TRUE(cache.insert(r));
    }
    for (int i = 0; i < 50; ++i) {
        const base::V3f P(0.8f * std::sin(3.0f * static_cast<float>(i)),
                          0.8f * std::cos(2.0f * static_cast<float>(i)), 0);
        const auto found = cache.lookup(point_at(P));
        ASSERT_TRUE(found);
        EXPECT_NEAR(found->g, field(P), 1e-5f);
    }
}

TEST(IrradianceCache, RotationGradientTurnsTheHemisphere) {
    IrradianceCache cache;
    IrradianceRecord r = record_at({0, 0, 0}, 10);
    r.rotation.fill({0, 0.5f, 0}); // brighter towards +x
    ASSERT_TRUE(cache.insert(r));
    const auto found = cache.lookup(point_at({0, 0, 0}, {std::sin(0.1f), 0, std::cos(0.1f)}));
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->r, 1 + 0.5f * std::sin(0.1f), 1e-6f);
}

TEST(IrradianceCache, NeighboursShareWhatIsNear) {
    IrradianceCache cache;
    ASSERT_TRUE(cache.insert(record_at({0, 0, 0}, 10)));
    ASSERT_TRUE(cache.insert(record_at({1, 0, 0}, 0.5f))); // saw something the first one missed
    EXPECT_FLOAT_EQ(cache.records()[0].radius, 1.5f);
    ASSERT_TRUE(cache.insert(record_at({1.05f, 0, 0}, 10)));
    EXPECT_FLOAT_EQ(cache.records()[2].radius, 0.55f);
}

TEST(IrradianceCache, RefusesWhatIsNoRecord) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    IrradianceCache cache;
    EXPECT_FALSE(cache.insert(record_at({nan, 0, 0}, 1)));
    EXPECT_FALSE(cache.insert(record_at({0, 0, 1e30f}, 1)));
    EXPECT_FALSE(cache.insert(record_at({0, 0, 0}, 0)));
    EXPECT_FALSE(cache.insert(record_at({0, 0, 0}, std::numeric_limits<float>::infinity())));
    EXPECT_FALSE(cache.insert(record_at({0, 0, 0}, 1, -1)));
    EXPECT_FALSE(cache.insert(record_at({0, 0, 0}, 1, nan)));
    IrradianceRecord long_normal = record_at({0, 0, 0}, 1);
    long_normal.N = {0, 0, 2};
    EXPECT_FALSE(cache.insert(long_normal));
    EXPECT_TRUE(cache.empty());
}

TEST(RecordRadius, IsBoundedByGradientAndPixels) {
    IrradianceRecord r = record_at({0, 0, 0}, 1, 2);
    EXPECT_FLOAT_EQ(record_radius(r, 5, 0.1f, 100), 5);
    EXPECT_FLOAT_EQ(record_radius(r, 5, 0.1f, 3), 3);
    EXPECT_FLOAT_EQ(record_radius(r, 0.01f, 0.1f, 3), 0.1f);
    r.translation[2] = {0, 4, 0};
    EXPECT_FLOAT_EQ(record_radius(r, 5, 0.1f, 100), 0.5f);
}

TEST(LimitGradients, NoMoreThanAllOfTheLight) {
    IrradianceRecord r = record_at({0, 0, 0}, 4, 2);
    r.translation[0] = {3, 0, 4};
    r.translation[1] = {0, 0.25f, 0};
    r.rotation[2] = {0, 1, 0};
    limit_gradients(r);
    EXPECT_NEAR(base::length(r.translation[0]), 0.5f, 1e-6f); // 2 within 4
    EXPECT_NEAR(r.translation[1].y, 0.025f, 1e-6f);           // all channels alike
    EXPECT_EQ(r.rotation[2].y, 1.0f);
}

// --- files

class IrradianceFiles : public testing::Test {
protected:
    base::TempDir dir_{"irradiance"};
    std::string path_ = dir_.path() + "/records";

    std::string written() {
        std::vector<IrradianceRecord> records;
        for (int i = 0; i < 20; ++i) {
            records.push_back(record_at({static_cast<float>(i), 0.5f, -2}, 1, 0.125f));
            records.back().rotation[1] = {1, 2, 3};
            records.back().translation[2] = {-1, 0, static_cast<float>(i)};
        }
        EXPECT_EQ(write_irradiance(path_, records), "");
        return base::read_file(path_).value_or("");
    }
};

TEST_F(IrradianceFiles, ComeBackAsTheyWere) {
    written();
    const IrradianceFile file = read_irradiance(path_);
    ASSERT_EQ(file.error, "");
    ASSERT_EQ(file.records.size(), 20U);
    EXPECT_EQ(file.records[7].P, base::V3f(7, 0.5f, -2));
    EXPECT_EQ(file.records[7].rotation[1], base::V3f(1, 2, 3));
    EXPECT_EQ(file.records[7].translation[2], base::V3f(-1, 0, 7));
    EXPECT_EQ(file.records[7].max_error, 0.25f);
}

TEST_F(IrradianceFiles, EveryDamageIsFound) {
    const std::string good = written();
    for (std::size_t at = 0; at < good.size(); at += 37) {
        std::string bad = good;
        bad[at] = static_cast<char>(bad[at] ^ 0x10);
        ASSERT_EQ(base::write_file_atomically(path_, bad), "");
        EXPECT_NE(read_irradiance(path_).error, "") << at;
        ASSERT_EQ(base::write_file_atomically(path_, good.substr(0, at)), "");
        EXPECT_NE(read_irradiance(path_).error, "") << at;
    }
    EXPECT_NE(read_irradiance(dir_.path() + "/missing").error, "");
}

TEST_F(IrradianceFiles, UnsoundRecordsAreLeftOut) {
    std::vector<IrradianceRecord> records = {record_at({0, 0, 0}, 1), record_at({0, 0, 0}, -1)};
    ASSERT_EQ(write_irradiance(path_, records), "");
    EXPECT_EQ(read_irradiance(path_).records.size(), 1U);
}

} // namespace
} // namespace trace
