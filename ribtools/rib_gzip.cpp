// SPDX-License-Identifier: Apache-2.0
#include "ribtools/rib_gzip.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <new>
#include <vector>
#include <zlib.h>

namespace rib {

namespace {

constexpr std::size_t block_size = 64 * 1024;
constexpr int gzip_window = 15 + 16; // zlib: the largest window, gzip headers only
constexpr unsigned char magic[] = {0x1f, 0x8b};

// A bomb: so much data, made of so little. Deflate's own limit is a ratio of 1032; RIB with its
// numbers stays below 100.
constexpr std::uint64_t harmless_size = std::uint64_t{1} << 30;
constexpr std::uint64_t greatest_ratio = 500;

uInt limited(std::size_t n) {
    return static_cast<uInt>(std::min<std::size_t>(n, std::numeric_limits<uInt>::max()));
}

class GzipSource final : public ByteSource {
public:
    explicit GzipSource(std::unique_ptr<ByteSource> below) : below_(std::move(below)) {}
    ~GzipSource() override {
        if (form_ == Form::Gzip) {
            inflateEnd(&z_);
        }
    }
    GzipSource(const GzipSource&) = delete;
    GzipSource& operator=(const GzipSource&) = delete;

    std::size_t read(char* buffer, std::size_t size) override {
        if (form_ == Form::Unknown && !begin()) {
            return 0;
        }
        if (form_ == Form::Gzip) {
            return read_inflated(buffer, size);
        }
        if (at_ == in_.size()) {
            return below_->read(buffer, size);
        }
        const std::size_t n = std::min(size, in_.size() - at_);
        std::memcpy(buffer, in_.data() + at_, n);
        at_ += n;
        return n;
    }
    std::size_t size_hint() const override {
        return form_ == Form::Plain ? below_->size_hint() : ByteSource::size_hint();
    }
    const std::string& error() const override { return error_.empty() ? below_->error() : error_; }
    bool is_damaged() const override { return !error_.empty(); }

private:
    enum class Form : std::uint8_t { Unknown, Plain, Gzip };

    // Looks at the first bytes; a pipe may bring them one by one.
    bool begin() {
        char first[sizeof magic];
        bool matches = true;
        while (matches && in_.size() < sizeof magic) {
            const std::size_t n = below_->read(first, sizeof magic - in_.size());
            matches = n > 0 && std::memcmp(first, magic + in_.size(), n) == 0;
            in_.insert(in_.end(), first, first + n);
        }
        form_ = Form::Plain;
        if (!matches) {
            return true;
        }
        if (inflateInit2(&z_, gzip_window) != Z_OK) {
            throw std::bad_alloc();
        }
        form_ = Form::Gzip;
        num_read_ = in_.size();
        offer_input();
        return true;
    }

    void offer_input() {
        z_.next_in = reinterpret_cast<Bytef*>(in_.data());
        z_.avail_in = limited(in_.size());
    }

    bool more_input() {
        in_.resize(block_size);
        in_.resize(below_->read(in_.data(), in_.size()));
        num_read_ += in_.size();
        offer_input();
        return !in_.empty();
    }

    std::size_t read_inflated(char* buffer, std::size_t size) {
        if (at_end_ || !error().empty()) {
            return 0;
        }
        z_.next_out = reinterpret_cast<Bytef*>(buffer);
        z_.avail_out = limited(size);
        const uInt wanted = z_.avail_out;
        while (z_.avail_out == wanted && step()) {
        }
        const std::size_t n = wanted - z_.avail_out;
        num_made_ += n;
        if (num_made_ > harmless_size && num_made_ / greatest_ratio > num_read_) {
            error_ = "the compressed data grows more than " + std::to_string(greatest_ratio) +
                     " times: refused beyond " + std::to_string(harmless_size >> 20) + " MB";
            return 0;
        }
        return n;
    }

    // Inflates once. False: nothing more can come.
    bool step() {
        if (z_.avail_in == 0 && !more_input()) {
            if (error().empty()) {
                error_ = "the compressed data ends in the middle";
            }
            return false;
        }
        const int result = inflate(&z_, Z_NO_FLUSH);
        if (result == Z_STREAM_END) {
            return next_member();
        }
        if (result == Z_MEM_ERROR) {
            throw std::bad_alloc();
        }
        if (result != Z_OK && result != Z_BUF_ERROR) {
            error_ = std::string("the compressed data is damaged (") +
                     (z_.msg ? z_.msg : "needs a dictionary") + ")";
            return false;
        }
        return true;
    }

    // Behind the end of a member: another one, padding of zeros, or the end.
    bool next_member() {
        bool padded = false;
        for (;;) {
            while (z_.avail_in > 0 && *z_.next_in == 0) {
                ++z_.next_in;
                --z_.avail_in;
                padded = true;
            }
            if (z_.avail_in > 0) {
                break;
            }
            if (!more_input()) {
                at_end_ = true;
                return false;
            }
        }
        if (padded || *z_.next_in != magic[0]) {
            error_ = "data that is not gzip follows the compressed data";
            return false;
        }
        return inflateReset(&z_) == Z_OK;
    }

    std::unique_ptr<ByteSource> below_;
    Form form_ = Form::Unknown;
    std::vector<char> in_; // the bytes looked at; then zlib's input
    std::size_t at_ = 0;   // of a plain stream's first bytes
    z_stream z_ = {};
    std::uint64_t num_read_ = 0, num_made_ = 0;
    bool at_end_ = false;
    std::string error_;
};

class GzipSink final : public ByteSink {
public:
    explicit GzipSink(std::unique_ptr<ByteSink> below) : below_(std::move(below)) {
        if (deflateInit2(&z_, Z_DEFAULT_COMPRESSION, Z_DEFLATED, gzip_window, memory_level,
                         Z_DEFAULT_STRATEGY) != Z_OK) {
            throw std::bad_alloc();
        }
    }
    ~GzipSink() override { deflateEnd(&z_); }
    GzipSink(const GzipSink&) = delete;
    GzipSink& operator=(const GzipSink&) = delete;

    bool write(std::string_view bytes) override {
        while (!bytes.empty()) {
            const uInt n = limited(bytes.size());
            // zlib reads only; its interface is older than const.
            z_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
            z_.avail_in = n;
            if (!drain(Z_NO_FLUSH)) {
                return false;
            }
            bytes.remove_prefix(n);
        }
        return true;
    }
    bool finish() override {
        z_.avail_in = 0;
        return drain(Z_FINISH) && below_->finish();
    }
    std::string error() const override { return below_->error(); }

private:
    static constexpr int memory_level = 9;

    bool drain(int flush) {
        char out[block_size];
        do {
            z_.next_out = reinterpret_cast<Bytef*>(out);
            z_.avail_out = sizeof out;
            (void)deflate(&z_, flush);
            if (!below_->write({out, sizeof out - z_.avail_out})) {
                return false;
            }
        } while (z_.avail_out == 0);
        return true;
    }

    std::unique_ptr<ByteSink> below_;
    z_stream z_ = {};
};

} // namespace

std::unique_ptr<ByteSource> open_gzip(std::unique_ptr<ByteSource> source) {
    return std::make_unique<GzipSource>(std::move(source));
}

std::unique_ptr<ByteSink> gzip_sink(std::unique_ptr<ByteSink> below) {
    return std::make_unique<GzipSink>(std::move(below));
}

} // namespace rib
