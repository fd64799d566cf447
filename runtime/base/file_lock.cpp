// SPDX-License-Identifier: Apache-2.0
#include "runtime/base/file_lock.h"

#include <cerrno>
#include <chrono>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <thread>

namespace base {

FileLock::FileLock(std::string path, const std::function<bool()>& give_up)
    : path_(std::move(path)) {
    using namespace std::chrono_literals;
    bool is_busy = true;
    while (!try_once(is_busy) && is_busy && !give_up()) {
        std::this_thread::sleep_for(5ms);
    }
}

// The holder before us may have removed the file between our open and our lock: then we hold the
// lock of a file that nobody else will open, and it is done again.
bool FileLock::try_once(bool& is_busy) {
    Descriptor file(::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666));
    if (!file.is_open() || ::flock(file.get(), LOCK_EX | LOCK_NB) != 0) {
        is_busy = file.is_open() && errno == EWOULDBLOCK;
        return false;
    }
    struct stat ours {
    }, named{};
    is_busy = true;
    if (::fstat(file.get(), &ours) != 0 || ::stat(path_.c_str(), &named) != 0 ||
        ours.st_ino != named.st_ino || ours.st_dev != named.st_dev) {
        return false;
    }
    file_ = std::move(file);
    return true;
}

FileLock::~FileLock() {
    if (is_held()) {
        ::unlink(path_.c_str()); // while it is held: see try_once
    }
}

} // namespace base
