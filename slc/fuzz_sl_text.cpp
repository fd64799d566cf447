// SPDX-License-Identifier: Apache-2.0
// Fuzz target: preprocessed SL text through tokens, tree, IR, passes and facts to emitted C. No
// compiler is run. Programs that come out must verify.
#include "runtime/base/fuzz.h"
#include "slc/compiler.h"
#include "slc/fuzz_program.h"

#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    base::Diag diag;
    diag.set_handler(base::ErrorHandler::Ignore);
    slc::CompileOptions options;
    options.is_preprocessed = true;
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    slc::Unit unit = slc::front_end_text(text, "fuzz.sl", options, diag);
    for (slc::Program& program : unit.programs) {
        slc::run_passes(program, options);
        slc_fuzz::check_verified(program, "the passes made a program that does not verify");
        slc_fuzz::check_program(program);
    }
    return 0;
}
