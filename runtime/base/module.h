// SPDX-License-Identifier: Apache-2.0
// Parts of the program that bring heavy libraries: shared objects of our own, opened on first use,
// so that runs that do not need them start without them. They lie where the installation put them,
// never on a path that a user's file names, and stay loaded to the end.
#pragma once

#include <string>

namespace base {

// The directory the running program lies in; "" if the system does not tell.
[[nodiscard]] std::string program_directory();

struct ModuleSymbol {
    void* address = nullptr;
    std::string error; // why there is none
};
// The function `symbol` of module `name`: NAME.so in the installation's module directory, or beside
// the program (build tree). Thread-safe.
[[nodiscard]] ModuleSymbol open_module(const std::string& name, const char* symbol);

} // namespace base
