// SPDX-License-Identifier: Apache-2.0
// The lexer's second half: binary tokens (ri.md, section 3). Nothing is allocated by a count or
// length in the stream, only for bytes that came; what codes stand for is limited too, since two
// bytes can call up a long string again and again.
#include "ribtools/rib_binary.h"

#include "ribtools/rib_chars.h"
#include "ribtools/rib_lex.h"

#include <algorithm>
#include <cfloat>

namespace rib {

namespace {

// Strings given for codes may make a stream so many times larger, besides what is always allowed.
constexpr std::uint64_t greatest_expansion = 64;
constexpr std::uint64_t harmless_expansion = 16 << 20;

constexpr const char* cut_short = "binary data cut short by the end of the stream";

} // namespace

void Lexer::bad(Token& t, const char* reason, base::Code code) {
    t.kind = TokenKind::Bad;
    t.reason = reason;
    t.code = code;
}

// Makes n bytes from p_ on lie in the buffer; false if the stream has fewer.
bool Lexer::needs(std::size_t n) {
    while (static_cast<std::size_t>(end_ - p_) < n) {
        if (!refill()) {
            return false;
        }
    }
    return true;
}

std::uint64_t Lexer::take_big_endian(std::size_t n) {
    std::uint64_t x = 0;
    for (; n > 0; --n) {
        x = x << 8 | static_cast<unsigned char>(*p_++);
    }
    return x;
}

// RIB text cannot spell NaN and infinity, and nothing behind the reader wants them.
double Lexer::finite(double value, const char* at) {
    if (std::isfinite(value)) {
        return value;
    }
    if (not_finite_.count++ == 0) {
        not_finite_.pos = place(at);
    }
    return std::isnan(value) ? 0 : value < 0 ? -double{FLT_MAX} : double{FLT_MAX};
}

// 0377 ends the stream wherever it stands (ri.md 2.6).
void Lexer::lex_binary(Token& t) {
    const auto first = static_cast<unsigned char>(*p_);
    if (first == bin::EndOfReply) {
        t.kind = TokenKind::End;
        return;
    }
    is_binary_ = true;
    t.pos = place(p_);
    if (first <= bin::LastFixed || first == bin::Float || first == bin::Double) {
        lex_number(t);
    } else if (is_binary_string(*p_)) {
        if (lex_string_form(t)) {
            t.kind = TokenKind::String;
        }
    } else if (first == bin::Request) {
        if (!needs(2)) {
            bad(t, cut_short);
            p_ = end_;
            return;
        }
        token_begin_ = p_;
        p_ += 2;
        refer(t, static_cast<unsigned char>(p_[-1]), true);
    } else if (first >= bin::FloatArray && first <= bin::LastFloatArray) {
        begin_float_array(t);
    } else {
        t.text = *p_++;
        bad(t, "reserved binary code");
    }
}

void Lexer::lex_number(Token& t) {
    const auto first = static_cast<unsigned char>(*p_);
    const std::size_t size = first == bin::Float ? 4 : first == bin::Double ? 8 : (first & 3u) + 1;
    if (!needs(1 + size)) {
        bad(t, cut_short);
        p_ = end_;
        return;
    }
    const char* at = p_++;
    const std::uint64_t bytes = take_big_endian(size);
    t.kind = TokenKind::Number;
    t.is_integer = first < bin::Fixed + 4;
    if (first == bin::Float) {
        const auto bits = static_cast<std::uint32_t>(bytes);
        t.number = finite(static_cast<double>(std::bit_cast<float>(bits)), at);
    } else if (first == bin::Double) {
        t.number = finite(std::bit_cast<double>(bytes), at);
    } else {
        const unsigned d = static_cast<unsigned>(first - bin::Fixed) >> 2;
        t.number = fixed_value(bytes, d, static_cast<unsigned>(size) - 1);
    }
}

// --- arrays of floats ---

void Lexer::begin_float_array(Token& t) {
    const std::size_t size = (static_cast<unsigned char>(*p_) & 3u) + 1;
    if (!needs(1 + size)) {
        bad(t, cut_short);
        p_ = end_;
        return;
    }
    ++p_;
    floats_left_ = static_cast<std::int64_t>(take_big_endian(size));
    t.kind = TokenKind::ArrayBegin;
}

void Lexer::lex_float_of_array(Token& t) {
    t.pos = place(p_);
    token_begin_ = p_;
    if (floats_left_-- == 0) {
        t.kind = TokenKind::ArrayEnd;
        return;
    }
    if (!needs(4)) {
        bad(t, cut_short);
        p_ = end_;
        floats_left_ = -1;
        return;
    }
    t.pos = place(p_);
    const char* at = p_;
    const auto bits = static_cast<std::uint32_t>(take_big_endian(4));
    t.kind = TokenKind::Number;
    t.is_integer = false;
    t.number = finite(static_cast<double>(std::bit_cast<float>(bits)), at);
}

// All that is left, block by block.
bool Lexer::read_floats_of_array(std::vector<float>& out) {
    constexpr std::uint32_t exponent = 0x7f800000;
    while (floats_left_ > 0 && needs(4)) {
        const std::int64_t n = std::min<std::int64_t>(floats_left_, (end_ - p_) / 4);
        const std::size_t begin = out.size();
        out.resize(begin + static_cast<std::size_t>(n));
        float* to = out.data() + begin;
        std::uint32_t not_finite = 0;
        for (std::int64_t i = 0; i < n; ++i) {
            const auto bits = big_endian<std::uint32_t>(p_ + 4 * i);
            not_finite |= (bits & exponent) == exponent ? 1u : 0u;
            to[i] = std::bit_cast<float>(bits);
        }
        for (std::int64_t i = 0; not_finite != 0 && i < n; ++i) {
            to[i] = static_cast<float>(finite(static_cast<double>(to[i]), p_ + 4 * i));
        }
        p_ += 4 * n;
        floats_left_ -= n;
    }
    lex(token_);
    return token_.kind == TokenKind::ArrayEnd;
}

// --- strings and codes ---

// Appends length bytes of the stream.
bool Lexer::take_string(std::uint64_t length, std::string& out) {
    while (length > 0) {
        if (p_ == end_ && !refill()) {
            return false;
        }
        const auto here = static_cast<std::uint64_t>(end_ - p_);
        const auto n = static_cast<std::size_t>(std::min(length, here));
        out.append(p_, n);
        p_ += n;
        length -= n;
    }
    return true;
}

// A string in one of the binary forms; false: t is Bad.
bool Lexer::lex_string_form(Token& t) {
    const auto first = static_cast<unsigned char>(*p_);
    const bool is_short = first <= bin::LastShortString;
    const bool is_reference = first >= bin::StringRef;
    const std::size_t size = is_short       ? 0
                             : is_reference ? first - bin::StringRef + 1u
                                            : first - bin::LongString + 1u;
    if (!needs(1 + size)) {
        bad(t, cut_short);
        p_ = end_;
        return false;
    }
    ++p_;
    const std::uint64_t number = is_short ? first - bin::ShortString + 0u : take_big_endian(size);
    if (is_reference) {
        refer(t, static_cast<std::uint32_t>(number), false);
    } else if (!take_string(number, t.text)) {
        t.text.clear();
        bad(t, cut_short);
    } else {
        t.kind = TokenKind::String;
    }
    return t.kind == TokenKind::String;
}

// The token a code stands for. A recording gets the codes it needs from before its beginning.
void Lexer::refer(Token& t, std::uint32_t code, bool is_request) {
    const auto& table = is_request ? codes_.requests : codes_.strings;
    const auto it = table.find(code);
    if (it == table.end()) {
        t.text = std::to_string(code);
        bad(t, is_request ? "undefined binary request code" : "undefined binary string code");
        return;
    }
    const CodeTable::Entry& entry = it->second;
    num_expanded_ += entry.text.size();
    if (num_expanded_ > harmless_expansion + greatest_expansion * offset(p_)) {
        bad(t, "too much text called up by binary string codes", base::Code::Limit);
        return;
    }
    if (recording_ && entry.defined_at < recorded_.start_byte) {
        auto& copies = is_request ? recorded_.codes.requests : recorded_.codes.strings;
        copies.try_emplace(code, CodeTable::Entry{entry.text, 0});
    }
    t.kind = is_request ? TokenKind::Name : TokenKind::String;
    t.text = entry.text;
}

// If a definition begins at p_, takes it in: it is no token. A malformed one leaves definition_
// Bad.
bool Lexer::define() {
    const auto first = static_cast<unsigned char>(*p_);
    if (first < bin::DefineRequest || first > bin::LastDefineString) {
        return false;
    }
    is_binary_ = true;
    Token& t = definition_;
    t = {};
    t.pos = place(p_);
    const std::uint64_t at = offset(p_);
    const std::size_t size = first == bin::LastDefineString ? 2 : 1;
    if (!needs(1 + size)) {
        bad(t, cut_short);
        p_ = end_;
        return true;
    }
    ++p_;
    const auto code = static_cast<std::uint32_t>(take_big_endian(size));
    const bool more = skip_white();
    if (more && *p_ == '"') {
        lex_string(t);
    } else if (more && is_binary_string(*p_)) {
        (void)lex_string_form(t);
    } else {
        bad(t, "no string in a binary definition");
    }
    if (t.kind != TokenKind::String) {
        return true;
    }
    t.kind = TokenKind::End;
    if (first != bin::DefineRequest) {
        codes_.strings[code] = {std::move(t.text), at};
    } else if (is_request_name(t.text)) {
        codes_.requests[code] = {std::move(t.text), at};
    } else {
        bad(t, "the string of a binary definition is no request name");
    }
    return true;
}

} // namespace rib
