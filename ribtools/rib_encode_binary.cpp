// SPDX-License-Identifier: Apache-2.0
// The binary form: every number in the shortest token that holds it exactly, request names and
// repeated strings as codes.
#include "ribtools/rib_binary.h"
#include "ribtools/rib_encode.h"

#include <algorithm>
#include <array>
#include <cfloat>
#include <limits>
#include <unordered_map>

namespace rib {

namespace {

// Longer strings are seldom said twice, shorter ones are no longer than their code.
constexpr std::size_t least_coded = 3, most_coded = 255;
constexpr std::uint32_t max_request_codes = 256, max_string_codes = 65536;

char* put_big_endian(char* p, std::uint64_t value, unsigned bytes) {
    for (unsigned i = bytes; i-- > 0;) {
        *p++ = static_cast<char>(value >> (8 * i));
    }
    return p;
}

// Bytes that an unsigned number needs.
unsigned width_of(std::uint64_t n) {
    return n < 1u << 8 ? 1 : n < 1u << 16 ? 2 : n < 1u << 24 ? 3 : 4;
}

char first_byte(bin::Code base, unsigned offset) {
    return static_cast<char>(base + offset);
}

// Two's complement.
unsigned signed_width(std::int32_t n) {
    unsigned w = 1;
    while (w < 4 && (n < -(1 << (8 * w - 1)) || n >= 1 << (8 * w - 1))) {
        ++w;
    }
    return w;
}

// The integer or fixed-point token for the value, if there is one of at most max_width + 1 bytes.
char* put_fixed(char* p, double value, unsigned max_width) {
    if (value == 0 && std::signbit(value)) {
        return nullptr;
    }
    for (unsigned d = 0; d <= 3; ++d, value *= 256) {
        if (!(std::fabs(value) <= std::numeric_limits<std::int32_t>::max())) {
            return nullptr;
        }
        if (value == std::trunc(value)) {
            const auto n = static_cast<std::int32_t>(value);
            const unsigned w = signed_width(n);
            if (w > (d == 0 ? 4 : max_width)) {
                return nullptr;
            }
            *p++ = first_byte(bin::Fixed, 4 * d + w - 1);
            return put_big_endian(p, static_cast<std::uint32_t>(n), w);
        }
    }
    return nullptr;
}

// At most 9 bytes; the value is finite.
char* put_number(char* p, double value) {
    constexpr unsigned shorter_than_float = 3;
    if (char* end = put_fixed(p, value, shorter_than_float)) {
        return end;
    }
    // The comparison first: converting what no float holds is undefined.
    if (std::fabs(value) <= double{FLT_MAX}) {
        const auto f = static_cast<float>(value);
        if (static_cast<double>(f) == value) {
            *p++ = first_byte(bin::Float, 0);
            return put_big_endian(p, std::bit_cast<std::uint32_t>(f), 4);
        }
    }
    *p++ = first_byte(bin::Double, 0);
    return put_big_endian(p, std::bit_cast<std::uint64_t>(value), 8);
}

class BinaryEncoder final : public Encoder {
public:
    explicit BinaryEncoder(ByteSink& sink) : Encoder(sink) {}

    void begin(std::string_view name, int) override {
        line_begins_ = false;
        auto it = requests_.find(std::string(name));
        if (it == requests_.end() && requests_.size() < max_request_codes) {
            const auto code = static_cast<std::uint32_t>(requests_.size());
            it = requests_.emplace(name, code).first;
            put(bin::DefineRequest, 0, code, 1);
            put_plain_string(name);
        }
        if (it != requests_.end()) {
            put(bin::Request, 0, it->second, 1);
        } else {
            bare(name);
        }
    }
    void end() override {}

    void number(double value) override { out_.taken(put_number(out_.room(), finite(value))); }
    // The second use of a string gives it a code.
    void string(std::string_view text) override {
        if (text.size() < least_coded || text.size() > most_coded) {
            put_plain_string(text);
            return;
        }
        const auto [it, is_new] = strings_.try_emplace(std::string(text), no_code);
        if (is_new || (it->second == no_code && num_string_codes_ == max_string_codes)) {
            if (strings_.size() > most_remembered) {
                strings_.erase(it);
            }
            put_plain_string(text);
            return;
        }
        if (it->second == no_code) {
            it->second = num_string_codes_++;
            const unsigned bytes = width_of(it->second);
            put(bin::DefineString, bytes - 1, it->second, bytes);
            put_plain_string(text);
        }
        const unsigned bytes = width_of(it->second);
        put(bin::StringRef, bytes - 1, it->second, bytes);
    }
    void bare(std::string_view text) override {
        out_.put(text);
        out_.put(' ');
    }

    void floats(std::span<const float> values) override {
        const unsigned bytes = width_of(values.size());
        put(bin::FloatArray, bytes - 1, values.size(), bytes);
        for (const float x : values) {
            out_.taken(put_big_endian(out_.room(), std::bit_cast<std::uint32_t>(finite(x)), 4));
        }
    }
    void doubles(std::span<const double> values) override {
        out_.put('[');
        for (const double x : values) {
            number(x);
        }
        out_.put(']');
    }
    void ints(std::span<const std::int32_t> values) override {
        out_.put('[');
        for (const std::int32_t x : values) {
            char* p = out_.room();
            const unsigned w = signed_width(x);
            *p++ = first_byte(bin::Fixed, w - 1);
            out_.taken(put_big_endian(p, static_cast<std::uint32_t>(x), w));
        }
        out_.put(']');
    }
    void strings(std::span<const std::string> values) override {
        out_.put('[');
        for (const std::string& x : values) {
            string(x);
        }
        out_.put(']');
    }

    void comment(std::string_view text, int, bool trailing) override {
        if (!trailing && !line_begins_) {
            out_.put('\n'); // tells it from a trailing one
        }
        out_.put(text);
        out_.put('\n');
        line_begins_ = true;
    }
    void verbatim(std::string_view bytes) override {
        out_.put(bytes);
        if (!bytes.ends_with('\n')) {
            out_.put('\n'); // what follows must not continue its last token
        }
        line_begins_ = true;
    }

private:
    static constexpr std::uint32_t no_code = ~std::uint32_t{0};
    static constexpr std::size_t most_remembered = 2 * max_string_codes;

    void put(bin::Code base, unsigned offset, std::uint64_t value, unsigned bytes) {
        char* p = out_.room();
        *p++ = first_byte(base, offset);
        out_.taken(put_big_endian(p, value, bytes));
    }
    void put_plain_string(std::string_view text) {
        constexpr std::size_t most_short = bin::LastShortString - bin::ShortString;
        if (text.size() <= most_short) {
            out_.put(first_byte(bin::ShortString, static_cast<unsigned>(text.size())));
        } else {
            const unsigned bytes = width_of(text.size());
            put(bin::LongString, bytes - 1, text.size(), bytes);
        }
        out_.put(text);
    }

    std::unordered_map<std::string, std::uint32_t> requests_, strings_;
    std::uint32_t num_string_codes_ = 0;
    bool line_begins_ = true;
};

} // namespace

std::unique_ptr<Encoder> binary_encoder(ByteSink& sink) {
    return std::make_unique<BinaryEncoder>(sink);
}

} // namespace rib
