// SPDX-License-Identifier: Apache-2.0
// The text form, and what both forms share.
#include "ribtools/rib_encode.h"

#include "ribtools/rib_chars.h"

#include <algorithm>
#include <cfloat>
#include <charconv>
#include <cmath>
#include <cstring>

namespace rib {

void OutBuffer::put(std::string_view text) {
    while (!text.empty()) {
        if (used_ == capacity) {
            flush();
        }
        const std::size_t n = std::min(text.size(), capacity - used_);
        std::memcpy(bytes_.data() + used_, text.data(), n);
        used_ += n;
        text.remove_prefix(n);
    }
}

void OutBuffer::flush() {
    sink_.write({bytes_.data(), used_});
    used_ = 0;
}

double Encoder::finite(double value) {
    if (std::isfinite(value)) {
        return value;
    }
    ++num_not_finite_;
    return std::isnan(value) ? 0 : value < 0 ? -double{FLT_MAX} : double{FLT_MAX};
}

namespace {

class TextEncoder final : public Encoder {
public:
    TextEncoder(ByteSink& sink, int indent) : Encoder(sink), indent_(indent) {}

    void begin(std::string_view name, int depth) override {
        new_line(depth);
        put(name);
    }
    void end() override { line_open_ = true; }

    void number(double value) override {
        out_.put(' ');
        ++column_;
        put_number(finite(value));
    }
    void string(std::string_view text) override {
        out_.put(' ');
        put_string(text);
    }
    void bare(std::string_view text) override {
        out_.put(' ');
        put(text);
    }
    void floats(std::span<const float> values) override {
        array(values, [this](float x) { put_number(finite(x)); });
    }
    void doubles(std::span<const double> values) override {
        array(values, [this](double x) { put_number(finite(x)); });
    }
    void ints(std::span<const std::int32_t> values) override {
        array(values, [this](std::int32_t x) { put_number(x); });
    }
    void strings(std::span<const std::string> values) override {
        array(values, [this](const std::string& x) { put_string(x); });
    }

    void comment(std::string_view text, int depth, bool trailing) override {
        if (trailing && line_open_) {
            out_.put(' ');
        } else {
            new_line(depth);
        }
        put(text);
        line_open_ = true;
    }
    void verbatim(std::string_view bytes) override {
        finish_line();
        out_.put(bytes);
        line_open_ = !bytes.ends_with('\n');
    }
    void flush() override {
        finish_line();
        Encoder::flush();
    }

private:
    static constexpr std::size_t wide = 96; // arrays go on in the next line

    void put(std::string_view text) {
        out_.put(text);
        column_ += text.size();
    }
    void finish_line() {
        if (line_open_) {
            out_.put('\n');
            line_open_ = false;
        }
        column_ = 0;
    }
    void new_line(int depth) {
        finish_line();
        depth_ = depth;
        column_ = static_cast<std::size_t>(indent_) * static_cast<std::size_t>(depth);
        for (std::size_t i = 0; i < column_; ++i) {
            out_.put(' ');
        }
    }

    template <class T, class Put> void array(std::span<const T> values, Put put_value) {
        out_.put(" [");
        column_ += 2;
        bool first = true;
        for (const T& x : values) {
            if (!first && column_ < wide) {
                out_.put(' ');
                ++column_;
            } else if (!first) {
                line_open_ = true;
                new_line(depth_);
            }
            first = false;
            put_value(x);
        }
        out_.put(']');
        ++column_;
    }

    // The shortest digits that are read as the same bits; whole numbers without an exponent.
    template <class T> void put_number(T value) {
        constexpr double plain_limit = 1e7;
        char* const begin = out_.room();
        char* end = begin;
        const auto wide_value = static_cast<double>(value);
        if (std::fabs(wide_value) < plain_limit && wide_value == std::trunc(wide_value) &&
            !(wide_value == 0 && std::signbit(wide_value))) {
            end = std::to_chars(begin, begin + OutBuffer::max_piece,
                                static_cast<std::int32_t>(wide_value))
                      .ptr;
        } else {
            end = std::to_chars(begin, begin + OutBuffer::max_piece, value).ptr;
        }
        out_.taken(end);
        column_ += static_cast<std::size_t>(end - begin);
    }

    // Bytes beyond ASCII stay: inside a string they mean themselves.
    void put_string(std::string_view text) {
        constexpr std::string_view values = "\n\r\t\b\f", letters = "nrtbf";
        out_.put('"');
        for (const char c : text) {
            const std::size_t known = values.find(c);
            if (c == '"' || c == '\\') {
                out_.put('\\');
                out_.put(c);
            } else if (known != std::string_view::npos) {
                out_.put('\\');
                out_.put(letters[known]);
            } else if (static_cast<unsigned char>(c) < ' ' || c == '\x7f') {
                const auto byte = static_cast<unsigned char>(c);
                out_.put('\\');
                out_.put(static_cast<char>('0' + (byte >> 6)));
                out_.put(static_cast<char>('0' + (byte >> 3 & 7)));
                out_.put(static_cast<char>('0' + (byte & 7)));
            } else {
                out_.put(c);
            }
        }
        out_.put('"');
        column_ += text.size() + 2;
    }

    int indent_;
    int depth_ = 0;
    std::size_t column_ = 0;
    bool line_open_ = false; // something stands on the line, its end is due
};

} // namespace

std::unique_ptr<Encoder> text_encoder(ByteSink& sink, int indent) {
    return std::make_unique<TextEncoder>(sink, indent);
}

} // namespace rib
