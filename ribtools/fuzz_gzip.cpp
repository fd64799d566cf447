// SPDX-License-Identifier: Apache-2.0
// Fuzz target: streams that may be gzip. The first byte says in what pieces they are asked for.
#include "ribtools/fuzz.h"
#include "ribtools/rib_gzip.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) {
        return 0;
    }
    const auto source = rib::open_gzip(
        rib::open_memory(std::make_shared<const std::string>(data + 1, data + size)));
    std::string block(1u + data[0] * 16u, '\0');
    constexpr std::size_t enough = 1 << 22;
    std::size_t total = 0;
    while (const std::size_t n = source->read(block.data(), block.size())) {
        total += n;
        if (total > enough) {
            break;
        }
    }
    return 0;
}
