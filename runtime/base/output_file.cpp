// SPDX-License-Identifier: Apache-2.0
#include "runtime/base/output_file.h"

#include "runtime/base/file.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <memory>
#include <sys/stat.h>
#include <unistd.h>

namespace base {

namespace {

constexpr std::size_t buffer_bytes = 1 << 18;
constexpr mode_t file_mode = 0666; // less the umask

std::string directory_of(const std::string& path) {
    const auto slash = path.rfind('/');
    return slash == std::string::npos ? "." : slash == 0 ? "/" : path.substr(0, slash);
}

// The file behind symbolic links, so that a link keeps pointing at the picture.
std::string resolved(const std::string& path) {
    const std::unique_ptr<char, decltype(&std::free)> real(::realpath(path.c_str(), nullptr),
                                                           &std::free);
    return real ? std::string(real.get()) : path;
}

} // namespace

OutputFile::OutputFile(const std::string& path) : path_(path) {
    buffer_.reserve(buffer_bytes);
    open_target();
    if (fd_ < 0 && error_ == 0) {
        error_ = errno != 0 ? errno : EIO;
    }
}

OutputFile::~OutputFile() {
    if (fd_ >= 0) {
        ::close(fd_);
    }
    remove_temporary();
}

void OutputFile::open_target() {
    struct stat info {};
    if (::stat(path_.c_str(), &info) == 0) {
        if (S_ISDIR(info.st_mode)) {
            fail(EISDIR);
            return;
        }
        if (!S_ISREG(info.st_mode)) {
            direct_ = true;
            // Not blocking: a pipe that nobody reads must not hang the renderer.
            fd_ = ::open(path_.c_str(), O_WRONLY | O_CLOEXEC | O_NONBLOCK);
            if (fd_ >= 0) {
                ::fcntl(fd_, F_SETFL, ::fcntl(fd_, F_GETFL) & ~O_NONBLOCK);
            }
            return;
        }
        // Renaming would replace a file that may not be written.
        if (::access(path_.c_str(), W_OK) != 0) {
            fail(errno);
            return;
        }
        path_ = resolved(path_);
    }
    open_unnamed(directory_of(path_));
    if (fd_ < 0 && (errno == EOPNOTSUPP || errno == EISDIR || errno == ENOENT || errno == EINVAL)) {
        open_named();
    }
}

void OutputFile::open_unnamed(const std::string& directory) {
    fd_ = ::open(directory.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, file_mode);
}

void OutputFile::open_named() {
    temporary_ = base::temporary_beside(path_);
    fd_ = ::open(temporary_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, file_mode);
    if (fd_ < 0) {
        temporary_.clear();
    }
}

void OutputFile::remove_temporary() {
    if (!temporary_.empty()) {
        ::unlink(temporary_.c_str());
        temporary_.clear();
    }
}

bool OutputFile::fail(int error) {
    if (error_ == 0) {
        error_ = error != 0 ? error : EIO;
    }
    return false;
}

bool OutputFile::flush() {
    std::size_t done = 0;
    while (done < buffer_.size() && error_ == 0) {
        const auto at = static_cast<off_t>(buffer_at_ + done);
        const ssize_t n = direct_ ? ::write(fd_, buffer_.data() + done, buffer_.size() - done)
                                  : ::pwrite(fd_, buffer_.data() + done, buffer_.size() - done, at);
        if (n > 0) {
            done += static_cast<std::size_t>(n);
        } else if (n == 0 || errno != EINTR) {
            fail(n == 0 ? ENOSPC : errno);
        }
    }
    buffer_.clear();
    return error_ == 0;
}

bool OutputFile::write(const void* bytes, std::size_t count) {
    if (error_ != 0) {
        return false;
    }
    if (position_ != buffer_at_ + buffer_.size() || buffer_.size() + count > buffer_bytes) {
        // A pipe cannot go back. What was buffered is out, the rest starts here.
        const std::uint64_t end = buffer_at_ + buffer_.size();
        if (!flush() || (direct_ && position_ != end)) {
            return fail(ESPIPE);
        }
        buffer_at_ = position_;
    }
    const char* from = static_cast<const char*>(bytes);
    buffer_.insert(buffer_.end(), from, from + count);
    position_ += count;
    size_ = std::max(size_, position_);
    return true;
}

std::size_t OutputFile::read(void* bytes, std::size_t count) {
    if (direct_ || !flush()) {
        return 0;
    }
    buffer_at_ = position_;
    std::size_t done = 0;
    while (done < count) {
        const ssize_t n = ::pread(fd_, static_cast<char*>(bytes) + done, count - done,
                                  static_cast<off_t>(position_ + done));
        if (n < 0 && errno == EINTR) {
            continue;
        }
        if (n <= 0) {
            break;
        }
        done += static_cast<std::size_t>(n);
    }
    position_ += done;
    buffer_at_ = position_;
    return done;
}

bool OutputFile::seek(std::uint64_t position) {
    position_ = position;
    return error_ == 0;
}

bool OutputFile::commit() {
    if (error_ != 0 || fd_ < 0 || !flush()) {
        return false;
    }
    if (direct_) {
        const int fd = fd_;
        fd_ = -1;
        return ::close(fd) == 0 || fail(errno);
    }
    if (::fsync(fd_) != 0) {
        return fail(errno);
    }
    return give_name();
}

// An unnamed file can be linked to a free name only; rename() then replaces the old file in one
// step.
bool OutputFile::give_name() {
    if (temporary_.empty()) {
        const std::string self = "/proc/self/fd/" + std::to_string(fd_);
        const std::string name = base::temporary_beside(path_);
        if (::linkat(AT_FDCWD, self.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) != 0) {
            return fail(errno);
        }
        temporary_ = name;
    }
    if (std::rename(temporary_.c_str(), path_.c_str()) != 0) {
        return fail(errno);
    }
    temporary_.clear();
    return true;
}

std::string why_not_writable(const std::string& path) {
    struct stat info {};
    const bool is_special =
        ::stat(path.c_str(), &info) == 0 && !S_ISREG(info.st_mode) && !S_ISDIR(info.st_mode);
    if (is_special) { // opening a pipe to try it would tell its reader
        return ::access(path.c_str(), W_OK) == 0 ? "" : std::strerror(errno);
    }
    const OutputFile trial(path);
    return trial.error() == 0 ? "" : std::strerror(trial.error());
}

} // namespace base
