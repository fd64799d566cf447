// SPDX-License-Identifier: Apache-2.0
// A lock between processes (and between threads of one): a file that flock(2) holds. The kernel
// lets go of it when its holder ends, however it ends, so no lock outlives a crash. The file is
// removed when the lock is released; one left by a killed process is simply taken over.
#pragma once

#include "runtime/base/descriptor.h"

#include <functional>
#include <string>

namespace base {

class FileLock {
public:
    FileLock() = default; // holds nothing
    // Waits for it, asking `give_up` every few milliseconds. Where the file cannot be made or
    // locked (no rights, a file system without locks) nothing is held: callers must be safe then
    // too.
    FileLock(std::string path, const std::function<bool()>& give_up);
    ~FileLock();
    FileLock(FileLock&&) noexcept = default;
    FileLock& operator=(FileLock&&) = delete;

    [[nodiscard]] bool is_held() const { return file_.is_open(); }

private:
    bool try_once(bool& is_busy);

    std::string path_;
    Descriptor file_;
};

} // namespace base
