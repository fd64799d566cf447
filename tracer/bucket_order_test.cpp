// SPDX-License-Identifier: Apache-2.0
// The coarse-to-fine order of buckets: each once, every Nth row first, bands one after the other.
#include "tracer/bucket_order.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <numeric>

namespace {

using trace::coarse_first;

std::vector<std::size_t> rows_of(const std::vector<std::size_t>& order, std::size_t columns) {
    std::vector<std::size_t> rows;
    for (std::size_t i = 0; i < order.size(); i += columns) {
        rows.push_back(order[i] / columns);
    }
    return rows;
}

TEST(BucketOrder, RowAfterRowWithoutN) {
    std::vector<std::size_t> expected(35);
    std::iota(expected.begin(), expected.end(), 0U);
    EXPECT_EQ(coarse_first(35, 5, 1, 100), expected);
    EXPECT_EQ(coarse_first(35, 5, 0, 3), expected);
    EXPECT_EQ(coarse_first(35, 5, -8, 100), expected);
}

TEST(BucketOrder, EveryNthRowThenTheRowsMidway) {
    EXPECT_EQ(rows_of(coarse_first(9 * 4, 4, 4, 100), 4),
              (std::vector<std::size_t>{0, 4, 8, 2, 6, 1, 3, 5, 7}));
    // 6 halves to 3, 3 to 1.
    EXPECT_EQ(rows_of(coarse_first(8 * 2, 2, 6, 100), 2),
              (std::vector<std::size_t>{0, 6, 3, 1, 2, 4, 5, 7}));
}

TEST(BucketOrder, BandsBoundWhatWaits) {
    EXPECT_EQ(rows_of(coarse_first(7 * 3, 3, 4, 5), 3),
              (std::vector<std::size_t>{0, 4, 2, 1, 3, 5, 6}));
}

TEST(BucketOrder, EachOnceForAnyNumbers) {
    for (const int every : {1, 2, 3, 7, 16, 1 << 30}) {
        for (const int band : {0, 1, 2, 13, 1 << 30}) {
            std::vector<std::size_t> order = coarse_first(13 * 11, 11, every, band);
            std::ranges::sort(order);
            for (std::size_t i = 0; i < 13 * 11; ++i) {
                ASSERT_EQ(order.at(i), i) << every << " " << band;
            }
        }
    }
    EXPECT_TRUE(coarse_first(0, 0, 8, 1).empty());
}

} // namespace
