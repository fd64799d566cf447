// SPDX-License-Identifier: Apache-2.0
#include "ribtools/rib_output.h"

#include "runtime/base/output_file.h"

#include <cerrno>
#include <cstring>
#include <unistd.h>

namespace rib {

namespace {

class FileSink final : public ByteSink {
public:
    explicit FileSink(const std::string& path) : file_(path) {}

    bool write(std::string_view bytes) override { return file_.write(bytes.data(), bytes.size()); }
    bool finish() override { return file_.commit(); }
    std::string error() const override {
        return file_.error() == 0 ? std::string() : std::strerror(file_.error());
    }

private:
    base::OutputFile file_;
};

class StdoutSink final : public ByteSink {
public:
    bool write(std::string_view bytes) override {
        while (!bytes.empty() && error_ == 0) {
            const ssize_t n = ::write(STDOUT_FILENO, bytes.data(), bytes.size());
            if (n >= 0) {
                bytes.remove_prefix(static_cast<std::size_t>(n));
            } else if (errno != EINTR) {
                error_ = errno;
            }
        }
        return error_ == 0;
    }
    bool finish() override { return error_ == 0; }
    std::string error() const override {
        return error_ == 0 ? std::string() : std::strerror(error_);
    }

private:
    int error_ = 0;
};

class MemorySink final : public ByteSink {
public:
    explicit MemorySink(std::string& out) : out_(out) {}

    bool write(std::string_view bytes) override {
        out_.append(bytes);
        return true;
    }
    bool finish() override { return true; }
    std::string error() const override { return {}; }

private:
    std::string& out_;
};

} // namespace

std::unique_ptr<ByteSink> file_sink(const std::string& path) {
    return std::make_unique<FileSink>(path);
}

std::unique_ptr<ByteSink> stdout_sink() {
    return std::make_unique<StdoutSink>();
}

std::unique_ptr<ByteSink> memory_sink(std::string& out) {
    return std::make_unique<MemorySink>(out);
}

} // namespace rib
