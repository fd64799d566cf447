// SPDX-License-Identifier: Apache-2.0
// Reads the mode of a Display: "rgba", "z", "N", "varying color Cdiffuse", "Ci,a,Cdiffuse" (ri.md
// 6.4). In: the text, the DisplayChannels, declarations. Out: its elements in order. Pure but for
// messages.
#pragma once

#include "ribtools/scene.h"
#include "runtime/base/diag.h"
#include "tracer/outputs.h"

#include <string>
#include <vector>

namespace trace {

struct ModeElement {
    std::string name;     // in the file
    std::string variable; // what it shows
    SampleValue value = SampleValue::Shaded;
    rib::ParamDecl decl;
    const rib::ParamList* channel = nullptr; // its DisplayChannel
};

// Elements that name nothing known are reported and left out.
[[nodiscard]] std::vector<ModeElement> read_mode(const rib::Display& display,
                                                 const rib::Options& options,
                                                 const ShaderOutputs& shader_outputs,
                                                 base::Diag& diag);

} // namespace trace
