// SPDX-License-Identifier: Apache-2.0
// A directory of its own below the system's temporary one ($TMPDIR, else /tmp), readable by this
// user only, removed with all it holds at the end of its scope.
#pragma once

#include <string>
#include <string_view>

namespace base {

class TempDir {
public:
    explicit TempDir(std::string_view prefix);
    ~TempDir();
    TempDir(const TempDir&) = delete;
    TempDir& operator=(const TempDir&) = delete;
    // "" when none could be made.
    [[nodiscard]] const std::string& path() const { return path_; }

private:
    std::string path_;
};

} // namespace base
