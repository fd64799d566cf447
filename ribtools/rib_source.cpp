// SPDX-License-Identifier: Apache-2.0
#include "ribtools/rib_source.h"

#include "ribtools/rib_gzip.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace rib {

namespace {

class FileSource final : public ByteSource {
public:
    FileSource(int fd, bool owned) : fd_(fd), owned_(owned) {}
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
    int fd_;
    bool owned_;
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

template <class Accept> OpenResult open_path(const std::string& path, int flags, Accept accept) {
    const int fd = ::open(path.c_str(), flags);
    if (fd < 0) {
        return {nullptr, std::strerror(errno)};
    }
    auto source = std::make_unique<FileSource>(fd, true);
    struct stat info {};
    if (::fstat(fd, &info) == 0 && !accept(info.st_mode)) {
        return {nullptr, S_ISDIR(info.st_mode) ? std::strerror(EISDIR) : "not a regular file"};
    }
    return {open_gzip(std::move(source)), {}};
}

} // namespace

OpenResult open_file(const std::string& path) {
    return open_path(path, O_RDONLY | O_CLOEXEC, [](mode_t mode) { return !S_ISDIR(mode); });
}

OpenResult open_archive(const std::string& path) {
    return open_path(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK,
                     [](mode_t mode) { return S_ISREG(mode); });
}

std::unique_ptr<ByteSource> open_stdin() {
    return open_gzip(std::make_unique<FileSource>(STDIN_FILENO, false));
}

std::unique_ptr<ByteSource> open_memory(std::shared_ptr<const std::string> text) {
    return std::make_unique<MemorySource>(std::move(text));
}

} // namespace rib
