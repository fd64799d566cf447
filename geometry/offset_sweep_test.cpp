// SPDX-License-Identifier: Apache-2.0
// Rays from surfaces and between them meet nothing but what is there. The long version:
// offset_sweep RAYS, whose figure docs/lights.md states.
#include "geometry/offset_sweep.h"

#include <gtest/gtest.h>

namespace geo {
namespace {

TEST(OffsetSweep, NoFalseOcclusions) {
    const SweepCount count = sweep_offsets(1'000'000, 1);
    EXPECT_GE(count.rays, 1'000'000U);
    EXPECT_EQ(count.false_hits, 0U) << count.first_false;
}

} // namespace
} // namespace geo
