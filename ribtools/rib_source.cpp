// SPDX-License-Identifier: Apache-2.0
#include "ribtools/rib_source.h"

#include "ribtools/rib_gzip.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

namespace rib {

namespace {

class FileSource final : public ByteSource {
public:
    FileSource(int fd, bool owned, Interrupted interrupted)
        : fd_(fd), owned_(owned), interrupted_(interrupted) {}
    ~FileSource() override {
        if (owned_) {
            ::close(fd_);
        }
    }
    FileSource(const FileSource&) = delete;
    FileSource& operator=(const FileSource&) = delete;

    // Hands on what a pipe has: a program that writes RIB piece by piece is not kept waiting.
    std::size_t read(char* buffer, std::size_t size) override {
        for (;;) {
            if (!wait()) {
                error_ = "interrupted";
                return 0;
            }
            const ssize_t n = ::read(fd_, buffer, size);
            if (n >= 0) {
                return static_cast<std::size_t>(n);
            }
            if (errno != EINTR) {
                error_ = std::strerror(errno);
                return 0;
            }
        }
    }
    const std::string& error() const override { return error_; }

private:
    // Until there is something to read, or false when the user wants to stop. A signal may have
    // come before the wait or in another thread: only asking again and again misses none.
    bool wait() {
        constexpr int interval_ms = 200;
        if (interrupted_ == nullptr) {
            return true;
        }
        pollfd input{fd_, POLLIN, 0};
        while (!interrupted_()) {
            if (::poll(&input, 1, interval_ms) > 0) {
                return true; // end and errors included: read() tells
            }
        }
        return false;
    }

    int fd_;
    bool owned_;
    Interrupted interrupted_;
    std::string error_;
};

class MemorySource final : public ByteSource {
public:
    explicit MemorySource(std::shared_ptr<const std::string> text) : text_(std::move(text)) {}

    std::size_t read(char* buffer, std::size_t size) override {
        const std::size_t n = std::min(size, text_->size() - at_);
        std::memcpy(buffer, text_->data() + at_, n);
        at_ += n;
        return n;
    }
    std::size_t size_hint() const override { return text_->size(); }
    const std::string& error() const override { return error_; }

private:
    std::shared_ptr<const std::string> text_;
    std::size_t at_ = 0;
    std::string error_;
};

template <class Accept>
OpenResult open_path(const std::string& path, int flags, Interrupted interrupted, Accept accept) {
    const int fd = ::open(path.c_str(), flags);
    if (fd < 0) {
        return {nullptr, std::strerror(errno)};
    }
    auto source = std::make_unique<FileSource>(fd, true, interrupted);
    struct stat info {};
    if (::fstat(fd, &info) == 0 && !accept(info.st_mode)) {
        return {nullptr, S_ISDIR(info.st_mode) ? std::strerror(EISDIR) : "not a regular file"};
    }
    return {open_gzip(std::move(source)), {}};
}

} // namespace

OpenResult open_file(const std::string& path, Interrupted interrupted) {
    return open_path(path, O_RDONLY | O_CLOEXEC, interrupted,
                     [](mode_t mode) { return !S_ISDIR(mode); });
}

OpenResult open_archive(const std::string& path) {
    return open_path(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK, nullptr,
                     [](mode_t mode) { return S_ISREG(mode); });
}

std::unique_ptr<ByteSource> open_stdin(Interrupted interrupted) {
    return open_gzip(std::make_unique<FileSource>(STDIN_FILENO, false, interrupted));
}

std::unique_ptr<ByteSource> open_memory(std::shared_ptr<const std::string> text) {
    return std::make_unique<MemorySource>(std::move(text));
}

} // namespace rib
