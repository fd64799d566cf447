// SPDX-License-Identifier: Apache-2.0
// A shader made again for parameters that keep one value at every point (design.md, section 4).
// In: the IR text of an object, values of parameters. Out: the program with the values as
// constants, simplified: branches they decide are gone, and with them the variables, operators and
// calls only those needed. Its parameter block and its results are those of the general shader, bit
// for bit, so that either may run at any time (docs/design/slc-speed.md).
#pragma once

#include "slc/ir.h"

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace slc {

struct ConstantParam {
    std::string name;
    std::vector<float> floats; // all components of all elements; empty for strings
    std::string text;
};

struct Specialised {
    Program program;
    std::size_t num_statements = 0; // bodies included: what the C compiler's time goes by
};

// nullopt with the reason in `error`: broken text. Values that fit no parameter, output parameters
// and arrays of strings are passed over: they stay parameters.
[[nodiscard]] std::optional<Specialised>
specialise(std::string_view ir, std::span<const ConstantParam> constants, std::string& error);

} // namespace slc
