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

// A shared library that the user allowed; closed with the object.
class Dso {
public:
    // With the reason in error() if it cannot be opened.
    explicit Dso(const std::string& path);
    ~Dso();
    Dso(Dso&& other) noexcept;
    Dso& operator=(Dso&&) = delete;

    [[nodiscard]] const std::string& path() const { return path_; }
    [[nodiscard]] const std::string& error() const { return error_; }
    // nullptr: it has no such symbol.
    [[nodiscard]] void* symbol(const std::string& name) const;

private:
    std::string path_, error_;
    void* handle_ = nullptr;
};

} // namespace base
