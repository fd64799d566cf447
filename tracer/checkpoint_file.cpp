// SPDX-License-Identifier: Apache-2.0
#include "tracer/checkpoint_file.h"

#include "runtime/base/sha256.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <optional>
#include <string_view>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace trace {

namespace {

constexpr std::size_t batch_bytes = 1 << 20;
constexpr std::uint32_t record_mark = 0x74636b62; // "bkct" backwards: tells the byte order as well

using Checksum = std::array<std::uint8_t, 16>;

// Both are written as they lie in memory: machines of another byte order find other marks.
struct Header {
    char name[16] = "perigee-ckpt 1\n";
    std::uint32_t mark = record_mark;
    CheckpointKey key;
    Checksum checksum{};
};
static_assert(sizeof(Header) == 16 + 4 + 40 + 16);

struct RecordHead {
    std::uint32_t mark = record_mark, bucket = 0, num_values = 0;
};
static_assert(sizeof(RecordHead) == 12);

template <class T> std::string_view bytes_of(const T& value) {
    return {reinterpret_cast<const char*>(&value), sizeof value};
}

std::string_view bytes_of(std::span<const float> values) {
    return {reinterpret_cast<const char*>(values.data()), values.size_bytes()};
}

Checksum checksum(std::initializer_list<std::string_view> parts) {
    base::Sha256 sha;
    for (const std::string_view part : parts) {
        sha.add(part);
    }
    const base::Sha256::Digest digest = sha.digest();
    Checksum out{};
    std::copy_n(digest.begin(), out.size(), out.begin());
    return out;
}

Checksum checksum(const Header& header) {
    return checksum({bytes_of(header.name), bytes_of(header.mark), bytes_of(header.key)});
}

void put(std::vector<std::byte>& out, std::string_view bytes) {
    const auto* data = reinterpret_cast<const std::byte*>(bytes.data());
    out.insert(out.end(), data, data + bytes.size());
}

bool write_all(int fd, std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t n = ::write(fd, bytes.data(), bytes.size());
        if (n > 0) {
            bytes = bytes.subspan(static_cast<std::size_t>(n));
        } else if (n == 0 || errno != EINTR) {
            errno = n == 0 ? ENOSPC : errno;
            return false;
        }
    }
    return true;
}

bool read_exactly(int fd, void* out, std::size_t size, std::uint64_t at) {
    auto* to = static_cast<char*>(out);
    while (size > 0) {
        const ssize_t n = ::pread(fd, to, size, static_cast<off_t>(at));
        if (n > 0) {
            to += n;
            at += static_cast<std::uint64_t>(n);
            size -= static_cast<std::size_t>(n);
        } else if (n == 0 || errno != EINTR) {
            return false;
        }
    }
    return true;
}

std::uint64_t size_of(int fd) {
    struct stat info {};
    return ::fstat(fd, &info) == 0 ? static_cast<std::uint64_t>(info.st_size) : 0;
}

} // namespace

CheckpointFile::~CheckpointFile() {
    close();
}

void CheckpointFile::close() {
    if (fd_ >= 0) {
        ::close(fd_);
        fd_ = -1;
    }
    pending_.clear();
}

bool CheckpointFile::fail(int error) {
    if (error_ == 0) {
        error_ = error != 0 ? error : EIO;
    }
    return false;
}

bool CheckpointFile::open_locked(const std::string& path, int flags) {
    close();
    path_ = path;
    error_ = 0;
    fd_ = ::open(path.c_str(), O_RDWR | O_CLOEXEC | O_NONBLOCK | flags, 0666);
    struct stat info {};
    if (fd_ < 0 || ::fstat(fd_, &info) != 0) {
        return fail(errno);
    }
    if (!S_ISREG(info.st_mode)) {
        fail(EINVAL);
    } else if (::flock(fd_, LOCK_EX | LOCK_NB) != 0) {
        fail(errno);
    }
    if (error_ != 0) {
        close();
    }
    return error_ == 0;
}

bool CheckpointFile::read_header(CheckpointKey& key) const {
    Header header;
    const Header expected;
    if (!read_exactly(fd_, &header, sizeof header, 0) ||
        bytes_of(header.name) != bytes_of(expected.name) || header.mark != expected.mark ||
        header.checksum != checksum(header)) {
        return false;
    }
    key = header.key;
    return true;
}

// Returns the end of the last good record. What lies behind a bad one cannot be trusted: its length
// is part of what may be damaged.
std::uint64_t CheckpointFile::read_records(const Take& take) {
    const std::uint64_t size = size_of(fd_);
    std::uint64_t at = sizeof(Header);
    std::vector<float> values;
    while (true) {
        RecordHead head;
        if (!read_exactly(fd_, &head, sizeof head, at) || head.mark != record_mark) {
            return at;
        }
        const std::uint64_t values_at = at + sizeof head;
        const std::uint64_t sum_at = values_at + std::uint64_t{head.num_values} * sizeof(float);
        Checksum sum{};
        if (sum_at + sizeof sum > size) { // torn; also bounds what is allocated
            return at;
        }
        values.resize(head.num_values);
        if (!read_exactly(fd_, values.data(), values.size() * sizeof(float), values_at) ||
            !read_exactly(fd_, sum.data(), sum.size(), sum_at) ||
            sum != checksum({bytes_of(head), bytes_of(std::span<const float>(values))})) {
            return at;
        }
        take(head.bucket, values);
        at = sum_at + sizeof sum;
    }
}

CheckpointFile::Resumed CheckpointFile::resume(const std::string& path, const CheckpointKey& key,
                                               const Take& take) {
    if (!open_locked(path, 0)) {
        return error_ == ENOENT        ? Resumed::Missing
               : error_ == EWOULDBLOCK ? Resumed::Busy
               : error_ == EINVAL      ? Resumed::Foreign
                                       : Resumed::Failed;
    }
    CheckpointKey found;
    if (!read_header(found) || !(found == key)) {
        close();
        return Resumed::Foreign;
    }
    const std::uint64_t end = read_records(take);
    if (::ftruncate(fd_, static_cast<off_t>(end)) != 0 ||
        ::lseek(fd_, static_cast<off_t>(end), SEEK_SET) < 0) {
        fail(errno);
        close();
        return Resumed::Failed;
    }
    return Resumed::Yes;
}

bool CheckpointFile::create(const std::string& path, const CheckpointKey& key) {
    if (!open_locked(path, O_CREAT)) {
        return false;
    }
    if (::ftruncate(fd_, 0) != 0) {
        return fail(errno);
    }
    Header header;
    header.key = key;
    header.checksum = checksum(header);
    put(pending_, bytes_of(header));
    return flush();
}

bool CheckpointFile::append(std::size_t bucket, std::span<const float> values) {
    RecordHead head;
    head.bucket = static_cast<std::uint32_t>(bucket);
    head.num_values = static_cast<std::uint32_t>(values.size());
    put(pending_, bytes_of(head));
    put(pending_, bytes_of(values));
    put(pending_, bytes_of(checksum({bytes_of(head), bytes_of(values)})));
    return error_ == 0 && (pending_.size() < batch_bytes || flush());
}

bool CheckpointFile::flush() {
    if (error_ != 0 || fd_ < 0) {
        return false;
    }
    const bool ok = write_all(fd_, pending_);
    pending_.clear();
    return ok || fail(errno);
}

bool CheckpointFile::sync() {
    return flush() && (::fdatasync(fd_) == 0 || fail(errno));
}

void CheckpointFile::remove() {
    if (fd_ >= 0) {
        ::unlink(path_.c_str()); // while the lock is held: nobody else has begun to use it
        close();
    }
}

bool is_checkpoint(const std::string& path) {
    const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (fd < 0) {
        return false;
    }
    Header header;
    const Header expected;
    const bool good = read_exactly(fd, &header, sizeof header, 0) &&
                      bytes_of(header.name) == bytes_of(expected.name);
    ::close(fd);
    return good;
}

void remove_stale_checkpoint(const std::string& path) {
    if (!is_checkpoint(path)) {
        return;
    }
    const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (fd >= 0 && ::flock(fd, LOCK_EX | LOCK_NB) == 0) {
        ::unlink(path.c_str());
    }
    if (fd >= 0) {
        ::close(fd);
    }
}

} // namespace trace
