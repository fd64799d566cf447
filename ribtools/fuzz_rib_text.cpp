// SPDX-License-Identifier: Apache-2.0
// Fuzz target: RIB text.
#include "ribtools/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::string text(data, data + size);
    for (char& c : text) {
        c = static_cast<char>(c & 0x7f); // bytes beyond are the other target's
    }
    rib_fuzz::read_and_convert(text);
    return 0;
}
