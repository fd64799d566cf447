// SPDX-License-Identifier: Apache-2.0
#include "runtime/base/parallel.h"

#include <atomic>
#include <gtest/gtest.h>
#include <vector>

TEST(Parallel, EveryItemOnceWhateverTheThreads) {
    for (const int threads : {1, 2, 5}) {
        std::vector<std::atomic<int>> seen(1000);
        base::parallel_for(seen.size(), threads, [&](std::size_t item, int slot) {
            EXPECT_GE(slot, 0);
            EXPECT_LT(slot, threads);
            ++seen[item];
            return true;
        });
        for (const auto& count : seen) {
            EXPECT_EQ(count.load(), 1);
        }
    }
}

TEST(Parallel, SlotsAreNeverShared) {
    std::vector<std::atomic<int>> inside(4);
    base::parallel_for(2000, 4, [&](std::size_t, int slot) {
        EXPECT_EQ(inside[static_cast<std::size_t>(slot)].fetch_add(1), 0);
        --inside[static_cast<std::size_t>(slot)];
        return true;
    });
}

TEST(Parallel, FalseStopsTheRest) {
    std::atomic<int> calls{0};
    base::parallel_for(100000, 2, [&](std::size_t item, int) {
        ++calls;
        return item != 10;
    });
    EXPECT_LT(calls.load(), 100000);
    base::parallel_for(0, 2, [&](std::size_t, int) { return false; });
}
