// SPDX-License-Identifier: Apache-2.0
// Test helper: SL source of a random, well-typed surface shader. It grows by types: wherever a
// value of a type is wanted, one of the ways to make one is chosen (literal, variable, array
// element, operator, constructor, any pure row of the built-in table, a user function), so a new
// row takes part without being named here. Inputs and results are parameters; the same seed gives
// the same text but for the class of the inputs.
#pragma once

#include <string>

namespace slc {

struct RandomShader {
    std::string source;
    int num_inputs = 0; // the first parameters; the rest are outputs
};

// is_uniform: inputs are uniform parameters, and so is everything else.
[[nodiscard]] RandomShader random_shader(unsigned seed, bool is_uniform);

} // namespace slc
