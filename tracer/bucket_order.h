// SPDX-License-Identifier: Apache-2.0
// The order of buckets that shows the whole picture early: every Nth row first, then the rows
// midway, and so on (BMRT's -d N, live-003). In: the grid of buckets. Out: each bucket once. Pixels
// do not depend on the order (film-003).
#pragma once

#include <cstddef>
#include <vector>

namespace trace {

// Rows are taken in bands of at most band_rows, one after the other: samples wait for those of
// neighbours, so a band bounds the memory. every <= 1 is row after row.
[[nodiscard]] std::vector<std::size_t> coarse_first(std::size_t num_buckets, int columns, int every,
                                                    int band_rows);

} // namespace trace
