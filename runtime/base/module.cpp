// SPDX-License-Identifier: Apache-2.0
#include "runtime/base/module.h"

#include <dlfcn.h>
#include <filesystem>
#include <utility>

namespace base {

namespace fs = std::filesystem;

std::string program_directory() {
    std::error_code error;
    const fs::path program = fs::read_symlink("/proc/self/exe", error);
    return error ? std::string() : program.parent_path().string();
}

namespace {

std::string last_error() {
    const char* text = ::dlerror(); // of this thread
    return text != nullptr ? text : "unknown error";
}

} // namespace

ModuleSymbol open_module(const std::string& name, const char* symbol) {
    const fs::path here = program_directory();
    if (here.empty()) {
        return {nullptr, "the program's own directory is not known"};
    }
    const std::string file = name + ".so";
    for (const fs::path& path :
         {here / PERIGEE_MODULES_FROM_PROGRAM / file, here / file, here / ".." / "tracer" / file}) {
        std::error_code error;
        if (!fs::exists(path, error)) {
            continue;
        }
        void* handle = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
        if (handle == nullptr) {
            return {nullptr, last_error()};
        }
        void* address = ::dlsym(handle, symbol);
        return {address, address != nullptr ? std::string() : last_error()};
    }
    return {nullptr, "the part " + file + " of the installation is missing"};
}

// A path with a slash is opened as it is, never looked for elsewhere.
Dso::Dso(const std::string& path)
    : path_(path), handle_(::dlopen(fs::absolute(path).c_str(), RTLD_NOW | RTLD_LOCAL)) {
    if (handle_ == nullptr) {
        error_ = last_error();
    }
}

Dso::~Dso() {
    if (handle_ != nullptr) {
        ::dlclose(handle_);
    }
}

Dso::Dso(Dso&& other) noexcept
    : path_(std::move(other.path_)), error_(std::move(other.error_)),
      handle_(std::exchange(other.handle_, nullptr)) {}

void* Dso::symbol(const std::string& name) const {
    return handle_ != nullptr ? ::dlsym(handle_, name.c_str()) : nullptr;
}

} // namespace base
