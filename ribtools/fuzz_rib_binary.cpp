// SPDX-License-Identifier: Apache-2.0
// Fuzz target: RIB with binary tokens among the text.
#include "ribtools/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    rib_fuzz::read_and_convert(std::string(data, data + size));
    return 0;
}
