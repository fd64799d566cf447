// SPDX-License-Identifier: Apache-2.0
// A file that appears under its name only when it is complete.
//
// Bytes go to an unnamed file in the target's directory (a named temporary where the file system
// knows no unnamed ones); commit() flushes it to disk and gives it its name. Without commit()
// nothing remains, not even after a crash. Devices and pipes are written directly. The image
// libraries write through this class. Not thread-safe.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace base {

class OutputFile {
public:
    explicit OutputFile(const std::string& path);
    ~OutputFile();
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    // errno of the first failure, 0 if none. After one, everything else fails too.
    [[nodiscard]] int error() const { return error_; }
    [[nodiscard]] const std::string& path() const { return path_; }

    bool write(const void* bytes, std::size_t count);
    // Bytes read; less than count at the end of the file or after an error.
    std::size_t read(void* bytes, std::size_t count);
    bool seek(std::uint64_t position);
    [[nodiscard]] std::uint64_t position() const { return position_; }
    [[nodiscard]] std::uint64_t size() const { return size_; }

    // False after a failure, see error().
    [[nodiscard]] bool commit();

private:
    void open_target();
    void open_unnamed(const std::string& directory);
    void open_named();
    bool flush();
    bool fail(int error);
    bool give_name();
    void remove_temporary();

    std::string path_, temporary_;
    int fd_ = -1;
    int error_ = 0;
    bool direct_ = false; // a device or pipe
    std::uint64_t position_ = 0, size_ = 0;
    std::uint64_t buffer_at_ = 0; // file position of the buffer
    std::vector<char> buffer_;    // not written yet
};

// Whether a file could appear under this name now: "" or why not. Leaves nothing behind.
[[nodiscard]] std::string why_not_writable(const std::string& path);

} // namespace base
