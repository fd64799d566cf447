// SPDX-License-Identifier: Apache-2.0
#include "runtime/base/temp_dir.h"

#include <cstdlib>
#include <filesystem>

namespace base {

TempDir::TempDir(std::string_view prefix) {
    std::error_code error;
    std::string pattern = std::filesystem::temp_directory_path(error).string();
    pattern += "/" + std::string(prefix) + "-XXXXXX";
    if (!error && ::mkdtemp(pattern.data()) != nullptr) {
        path_ = pattern;
    }
}

TempDir::~TempDir() {
    std::error_code ignored;
    if (!path_.empty()) {
        std::filesystem::remove_all(path_, ignored);
    }
}

} // namespace base
