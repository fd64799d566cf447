// SPDX-License-Identifier: Apache-2.0
// Functions of DSOs as rows like those of sl_builtins.def, by name. In: whoever knows the DSOs
// (CompileOptions::find_functions). Rows live as long as this does; calls of them become calls of
// the hidden rows `shadeop` (runtime/abi/sl_shadeop.h).
#pragma once

#include "slc/builtins.h"

#include <functional>
#include <list>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace slc {

struct ExternalFunction {
    std::string name, signature; // "f(p,F)"
};
using FindFunctions = std::function<std::vector<ExternalFunction>(std::string_view name)>;

class Externals {
public:
    explicit Externals(FindFunctions find) : find_(std::move(find)) {}
    // Overloads in their order; none for a name nobody knows.
    const std::vector<const BuiltinRow*>& find(const std::string& name);

private:
    struct Entry {
        ExternalFunction function; // the texts the row refers to
        BuiltinRow row;
    };
    FindFunctions find_;
    std::list<Entry> entries_; // addresses stay
    std::map<std::string, std::vector<const BuiltinRow*>, std::less<>> rows_;
};

} // namespace slc
