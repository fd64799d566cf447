// SPDX-License-Identifier: Apache-2.0
// The file that finished buckets are kept in: a header that says which frame they belong to, then
// one record per bucket, each with a checksum. Records are appended, never changed, so a process
// that dies leaves at most one torn record at the end, which the next one cuts off. The file is
// locked while it is open: two renders of one picture do not mix. Not thread-safe.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace trace {

// What makes buckets of two runs interchangeable.
struct CheckpointKey {
    std::array<std::uint8_t, 32> frame{}; // hash of all that decides the pixels
    std::uint32_t num_buckets = 0, num_planes = 0;
    friend bool operator==(const CheckpointKey&, const CheckpointKey&) = default;
};

class CheckpointFile {
public:
    CheckpointFile() = default;
    ~CheckpointFile();
    CheckpointFile(const CheckpointFile&) = delete;
    CheckpointFile& operator=(const CheckpointFile&) = delete;

    enum class Resumed {
        Yes,     // open; append() goes on behind the last good record
        Missing, // no such file
        Busy,    // another process has it open
        Foreign, // no checkpoint, or that of another frame
        Failed   // see error()
    };
    // Hands every good record to `take`; values are valid during the call.
    using Take = std::function<void(std::size_t bucket, std::span<const float> values)>;
    Resumed resume(const std::string& path, const CheckpointKey& key, const Take& take);

    // Begins a new file, whatever stood there. False: see error(); EWOULDBLOCK: another process has
    // it open.
    bool create(const std::string& path, const CheckpointKey& key);

    // Records gather in memory until there are many or flush() is called. False: see error().
    bool append(std::size_t bucket, std::span<const float> values);
    bool flush();
    // The same, to the disk itself: survives the machine, not only the process.
    bool sync();

    [[nodiscard]] bool is_open() const { return fd_ >= 0; }
    [[nodiscard]] int error() const { return error_; } // errno of the first failure
    // Takes the file from the disk and closes it.
    void remove();

private:
    bool open_locked(const std::string& path, int flags);
    bool read_header(CheckpointKey& key) const;
    std::uint64_t read_records(const Take& take);
    void close();
    bool fail(int error);

    std::string path_;
    int fd_ = -1, error_ = 0;
    std::vector<std::byte> pending_;
};

// Removes a checkpoint that nobody uses any more; other files, and those in use, stay.
void remove_stale_checkpoint(const std::string& path);
[[nodiscard]] bool is_checkpoint(const std::string& path);

} // namespace trace
