// SPDX-License-Identifier: Apache-2.0
// One shader as C: the text a C compiler turns into a shader object.
// In: a verified program and its facts. Out: C11 with vector extensions that includes sl_shader.h;
// the same text for both widths except its head, so it can be read and compiled by hand (cc -O2
// -mavx2 -I... -c).
#pragma once

#include "slc/ir.h"

#include <string>
#include <vector>

namespace slc {

struct EmitOptions {
    int lanes = 8; // 8: AVX2; 4: any x86-64
    // Widths of the object's variants, best first: the unit of the first one holds the descriptor.
    std::vector<int> variants = {8, 4};
    std::string source;   // name of the source file, as the descriptor gives it
    std::string ir_text;  // "" = leave it out
    bool profile = false; // count time and lanes by source line (sl_profile.h)
    bool checked = false; // the code tells where values stop being numbers
};

[[nodiscard]] std::string emit_c(const Program& program, const Facts& facts,
                                 const EmitOptions& options);

// Where each parameter lies in the block; sl_abi.h, sl_param.
struct ParamLayout {
    std::vector<std::uint32_t> offsets;
    std::uint32_t size = 0;
};
[[nodiscard]] ParamLayout layout_params(const Program& program);

} // namespace slc
