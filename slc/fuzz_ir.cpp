// SPDX-License-Identifier: Apache-2.0
// Fuzz target: IR text, as it stands in objects. What verifies is interpreted and emitted as it is,
// goes through the passes and must verify again.
#include "runtime/base/fuzz.h"
#include "slc/compiler.h"
#include "slc/fuzz_program.h"
#include "slc/ir_text.h"

#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::string error;
    auto program =
        slc::parse_ir(std::string_view(reinterpret_cast<const char*>(data), size), error);
    if (!program || !slc::verify_ir(*program).empty()) {
        return 0;
    }
    if (slc_fuzz::interpret(*program)) {
        slc_fuzz::check_program(*program);
        slc::run_passes(*program, {});
        slc_fuzz::check_verified(*program, "the passes made a program that does not verify");
        slc_fuzz::check_program(*program);
    }
    return 0;
}
