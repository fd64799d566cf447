// SPDX-License-Identifier: Apache-2.0
// One call of a built-in function being put together; private to the emitter's files.
#pragma once

#include "slc/builtins.h"
#include "slc/emit_common.h"

#include <string>
#include <utility>
#include <vector>

namespace slc {

// A text that varies: the variable, its lanes, and the one text the call is made with.
struct CallText {
    VarId var;
    std::string lanes, one;
};

// "a, b, c"
[[nodiscard]] std::string joined(const std::vector<std::string>& parts);

struct Emitter::Call {
    const Stmt& s;
    const Block& b;
    const BuiltinRow& row;
    bool lanes;
    std::size_t num_args; // of the row; differences follow
    std::string form;     // of the body: "_d"; "_shared", whose knots all lanes share
    std::vector<std::string> arguments = {};
    // Outputs that go through a temporary: (variable, temporary).
    std::vector<std::pair<VarId, std::string>> through = {};
    std::string mask = {}; // lanes of the call
    std::vector<CallText> texts = {};
};

} // namespace slc
