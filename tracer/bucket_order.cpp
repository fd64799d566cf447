// SPDX-License-Identifier: Apache-2.0
#include "tracer/bucket_order.h"

#include <algorithm>

namespace trace {

namespace {

// Rows 0 .. count-1: multiples of every, then those of half of it, and so on.
std::vector<int> row_order(int count, int every) {
    std::vector<int> rows;
    std::vector<bool> taken(static_cast<std::size_t>(count));
    for (int step = std::max(every, 1);; step /= 2) {
        for (int row = 0; row < count; row += step) {
            if (!taken[static_cast<std::size_t>(row)]) {
                taken[static_cast<std::size_t>(row)] = true;
                rows.push_back(row);
            }
        }
        if (step == 1) {
            return rows;
        }
    }
}

} // namespace

std::vector<std::size_t> coarse_first(std::size_t num_buckets, int columns, int every,
                                      int band_rows) {
    std::vector<std::size_t> order;
    order.reserve(num_buckets);
    const auto width = static_cast<std::size_t>(std::max(columns, 1));
    const auto rows = static_cast<int>(num_buckets / width);
    for (int band = 0; band < rows; band += std::max(band_rows, 1)) {
        for (const int row : row_order(std::min(std::max(band_rows, 1), rows - band), every)) {
            for (std::size_t column = 0; column < width; ++column) {
                order.push_back(static_cast<std::size_t>(band + row) * width + column);
            }
        }
    }
    return order;
}

} // namespace trace
