// SPDX-License-Identifier: Apache-2.0
// How names, numbers and strings are spelt in a RIB stream (ri.md, sections 2 and 3): as text or as
// binary tokens. In: values in their order. Out: bytes to a sink.
//
// What is written is read back to the same bits. RIB knows finite numbers only: NaN is written as
// 0, infinity as the largest float, as the reader takes them; num_not_finite() counts.
#pragma once

#include "ribtools/rib_output.h"

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace rib {

// Collects small pieces for a sink.
class OutBuffer {
public:
    explicit OutBuffer(ByteSink& sink) : sink_(sink), bytes_(capacity) {}

    // Room for n bytes, at most max_piece; taken(end) says how much of it was used.
    static constexpr std::size_t max_piece = 64;
    [[nodiscard]] char* room() {
        if (capacity - used_ < max_piece) {
            flush();
        }
        return bytes_.data() + used_;
    }
    void taken(const char* end) { used_ = static_cast<std::size_t>(end - bytes_.data()); }
    void put(char c) {
        char* p = room();
        *p = c;
        taken(p + 1);
    }
    void put(std::string_view text);
    void flush();

private:
    static constexpr std::size_t capacity = 64 * 1024;
    ByteSink& sink_;
    std::vector<char> bytes_;
    std::size_t used_ = 0;
};

class Encoder {
public:
    explicit Encoder(ByteSink& sink) : out_(sink) {}
    virtual ~Encoder() = default;
    Encoder(const Encoder&) = delete;
    Encoder& operator=(const Encoder&) = delete;

    // A request: its name, its values, its end. depth: open blocks, for indentation.
    virtual void begin(std::string_view name, int depth) = 0;
    virtual void end() = 0;

    virtual void number(double value) = 0;
    virtual void string(std::string_view text) = 0;
    // Text that is a token as it stands, without blanks.
    virtual void bare(std::string_view text) = 0;
    // Arrays.
    virtual void floats(std::span<const float> values) = 0;
    virtual void doubles(std::span<const double> values) = 0;
    virtual void ints(std::span<const std::int32_t> values) = 0;
    virtual void strings(std::span<const std::string> values) = 0;

    // A comment with its marks. trailing: on the line of the request before it.
    virtual void comment(std::string_view text, int depth, bool trailing) = 0;
    // Bytes as they are, between requests.
    virtual void verbatim(std::string_view bytes) = 0;
    // All that was written goes to the sink.
    virtual void flush() { out_.flush(); }

    [[nodiscard]] std::uint64_t num_not_finite() const { return num_not_finite_; }

protected:
    [[nodiscard]] double finite(double value);
    [[nodiscard]] float finite(float value) {
        return static_cast<float>(finite(static_cast<double>(value)));
    }

    OutBuffer out_;

private:
    std::uint64_t num_not_finite_ = 0;
};

// indent: blanks per open block.
[[nodiscard]] std::unique_ptr<Encoder> text_encoder(ByteSink& sink, int indent);
[[nodiscard]] std::unique_ptr<Encoder> binary_encoder(ByteSink& sink);

} // namespace rib
