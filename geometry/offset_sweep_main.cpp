// SPDX-License-Identifier: Apache-2.0
// offset_sweep [RAYS [SEED]]: counts false occlusions over that many rays (offset_sweep.h) and
// prints one JSON line. Exit 1 if there are any.
#include "geometry/offset_sweep.h"

#include <cstdio>
#include <cstdlib>

int main(int argc, char** argv) {
    const std::uint64_t rays = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 10'000'000;
    const auto seed = static_cast<std::uint32_t>(argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 1);
    const geo::SweepCount count = geo::sweep_offsets(rays, seed);
    std::printf("{\"benchmark\": \"offset_sweep\", \"rays\": %llu, \"false_occlusions\": %llu, "
                "\"largest_relative_offset\": %g, \"first\": \"%s\"}\n",
                static_cast<unsigned long long>(count.rays),
                static_cast<unsigned long long>(count.false_hits), count.largest_offset,
                count.first_false.c_str());
    return count.false_hits == 0 ? 0 : 1;
}
