// SPDX-License-Identifier: Apache-2.0
#include "ribtools/rib_lex.h"

#include "ribtools/rib_binary.h"
#include "ribtools/rib_chars.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

namespace rib {

namespace {

constexpr std::size_t block_size = 256 * 1024;
constexpr std::size_t least_block = 64;

} // namespace

std::int32_t to_int(double value, bool& inexact, bool& overflow) {
    constexpr double lowest = std::numeric_limits<std::int32_t>::min();
    constexpr double highest = std::numeric_limits<std::int32_t>::max();
    if (const auto exact = static_cast<std::int64_t>(std::fabs(value) < highest ? value : 0.5);
        static_cast<double>(exact) == value) {
        return static_cast<std::int32_t>(exact); // without a call of trunc()
    }
    const double whole = std::trunc(value);
    inexact |= whole != value;
    overflow |= !(whole >= lowest && whole <= highest);
    return static_cast<std::int32_t>(std::fmin(std::fmax(whole, lowest), highest));
}

Lexer::Lexer(std::unique_ptr<ByteSource> source, base::SourcePos start,
             const CommentHandler* on_comment)
    : source_(std::move(source)), on_comment_(on_comment),
      capacity_(std::clamp(source_->size_hint(), least_block, block_size)),
      buffer_(1 + capacity_ + number_padding), p_(buffer_.data() + 1), end_(p_),
      file_id_(start.file_id), line_(start.line),
      line_start_(1 - static_cast<std::int64_t>(start.col)) {}

Lexer::Lexer(std::shared_ptr<const Recording> recording, const CommentHandler* on_comment)
    : Lexer(open_memory({recording, &recording->text}), recording->start, on_comment) {
    block_at_ = recording->start_byte;
    is_binary_ = recording->start.is_byte();
    codes_ = recording->codes;
}

// Moves what is still needed, from keep on, to the front of the buffer and reads more behind it.
// False at the end of the source or when a token fills the whole buffer.
bool Lexer::refill(const char*& keep) {
    if (at_end_) {
        return false;
    }
    if (recording_) {
        recorded_.text.append(record_from_, keep);
    }
    char* front = buffer_.data() + 1;
    const std::size_t kept = static_cast<std::size_t>(end_ - keep);
    if (kept >= capacity_) {
        record_from_ = keep;
        return false;
    }
    line_start_ -= keep - front;
    block_at_ += static_cast<std::uint64_t>(keep - front);
    if (keep > front) {
        buffer_[0] = keep[-1];
    }
    std::memmove(front, keep, kept);
    p_ = front + (p_ - keep);
    keep = record_from_ = front;
    const std::size_t n = source_->read(front + kept, capacity_ - kept);
    front[kept + n] = '\0';
    end_ = front + kept + n;
    at_end_ = n == 0;
    return n > 0;
}

base::SourcePos Lexer::place(const char* p) const {
    if (is_binary_) {
        return base::SourcePos::at_byte(file_id_, offset(p));
    }
    const std::int64_t col = p - (buffer_.data() + 1) - line_start_ + 1;
    return {file_id_, line_, static_cast<std::uint32_t>(col)};
}

// *p_ is LF or CR: a line ends there, but CR LF is one end.
void Lexer::newline() {
    if (!(*p_ == '\n' && p_[-1] == '\r')) {
        ++line_;
    }
    ++p_;
    line_start_ = p_ - (buffer_.data() + 1);
}

void Lexer::skip_comment() {
    std::string text;
    Comment comment;
    comment.pos = place(p_);
    const char* front = buffer_.data() + 1;
    for (const char* p = front + std::max<std::int64_t>(line_start_, 0); p < p_; ++p) {
        comment.trailing |= class_of(*p) != White;
    }
    for (;;) {
        const char* begin = p_;
        while (p_ < end_ && class_of(*p_) != LineEnd) {
            ++p_;
        }
        if (on_comment_ && *on_comment_) {
            text.append(begin, p_);
        }
        if (p_ < end_ || !refill()) {
            break;
        }
    }
    if (on_comment_ && *on_comment_) {
        const bool structure = text.starts_with("##");
        comment.kind = structure ? "structure" : "comment";
        comment.text = std::string_view(text).substr(structure ? 2 : 1);
        (*on_comment_)(comment);
    }
}

// To the next significant byte; false at the end of the stream.
bool Lexer::skip_white() {
    for (;;) {
        if (p_ == end_) {
            if (!refill()) {
                return false;
            }
            continue;
        }
        const CharClass c = class_of(*p_);
        if (c == White) {
            ++p_;
        } else if (c == LineEnd) {
            newline();
        } else if (*p_ == '#') {
            skip_comment();
        } else {
            return true;
        }
    }
}

// The same, past definitions of codes too.
bool Lexer::skip_to_token() {
    while (definition_.kind != TokenKind::Bad) {
        if (!skip_white()) {
            return false;
        }
        if (class_of(*p_) != High || !define()) {
            break;
        }
    }
    return true;
}

void Lexer::lex(Token& t) {
    t.text.clear();
    t.reason = nullptr;
    if (floats_left_ >= 0) {
        lex_float_of_array(t);
        return;
    }
    const bool more = skip_to_token();
    if (definition_.kind == TokenKind::Bad) {
        std::swap(t, definition_);
        definition_.kind = TokenKind::End;
        return;
    }
    t.pos = place(p_);
    token_begin_ = p_;
    if (!more) {
        t.kind = TokenKind::End;
        return;
    }
    switch (*p_) {
    case '[':
        ++p_;
        t.kind = TokenKind::ArrayBegin;
        return;
    case ']':
        ++p_;
        t.kind = TokenKind::ArrayEnd;
        return;
    case '"':
        lex_string(t);
        return;
    default:
        break;
    }
    if (class_of(*p_) == High) {
        lex_binary(t);
    } else {
        lex_run(t);
    }
}

// A name or a number: a run of regular characters.
void Lexer::lex_run(Token& t) {
    constexpr auto longest = static_cast<std::ptrdiff_t>(max_run);
    const char* begin = p_;
    do {
        while (class_of(*p_) == Regular && p_ < end_ && p_ - begin < longest) {
            ++p_;
        }
    } while (p_ == end_ && p_ - begin < longest && refill(begin));
    token_begin_ = begin;
    t.text.assign(begin, p_);
    if (p_ - begin == longest) {
        skip_run();
        bad(t, "too long a name or number", base::Code::Syntax);
        return;
    }
    if (!starts_number(*begin)) {
        t.kind = TokenKind::Name;
        return;
    }
    const Decimal d = scan_decimal(begin);
    if (d.end != p_) {
        bad(t, "malformed number", base::Code::Syntax);
        return;
    }
    t.kind = TokenKind::Number;
    t.number = to_double(d);
    t.is_integer = d.is_integer;
}

void Lexer::skip_run() {
    do {
        while (class_of(*p_) == Regular && p_ < end_) {
            ++p_;
        }
    } while (p_ == end_ && refill());
}

void Lexer::lex_string(Token& t) {
    ++p_;
    for (;;) {
        const char* begin = p_;
        while (p_ < end_ && *p_ != '"' && *p_ != '\\' && class_of(*p_) != LineEnd) {
            ++p_;
        }
        t.text.append(begin, p_);
        if (p_ == end_) {
            if (!refill()) {
                bad(t, "string without closing quote", base::Code::Syntax);
                return;
            }
        } else if (*p_ == '"') {
            ++p_;
            t.kind = TokenKind::String;
            return;
        } else if (*p_ == '\\') {
            lex_escape(t);
        } else {
            t.text += *p_;
            newline();
        }
    }
}

// Backslash sequences, ri.md 2.2.
void Lexer::lex_escape(Token& t) {
    const char* begin = p_;
    while (end_ - p_ < 4 && refill(begin)) {
        // up to three octal digits follow the backslash
    }
    ++p_;
    if (p_ == end_) {
        return; // the string ends unclosed: lex_string says so
    }
    int value = 0, digits = 0;
    while (digits < 3 && p_ < end_ && *p_ >= '0' && *p_ <= '7') {
        value = value * 8 + (*p_++ - '0');
        ++digits;
    }
    if (digits > 0) {
        t.text += static_cast<char>(value);
        return;
    }
    if (class_of(*p_) == LineEnd) { // the line continues
        const bool cr = *p_ == '\r';
        newline();
        if (cr && p_ < end_ && *p_ == '\n') {
            newline();
        }
        return;
    }
    static constexpr std::string_view letters = "nrtbf", values = "\n\r\t\b\f";
    const std::size_t at = letters.find(*p_);
    t.text += at == std::string_view::npos ? *p_ : values[at];
    ++p_;
}

void Lexer::advance() {
    if (ahead_.empty()) {
        lex(token_);
    } else {
        token_ = std::move(ahead_.front());
        ahead_.pop_front();
    }
}

const Token& Lexer::ahead(std::size_t i) {
    while (ahead_.size() <= i) {
        lex(ahead_.emplace_back());
    }
    return ahead_[i];
}

bool Lexer::array_holds_strings() {
    if (floats_left_ >= 0 || !skip_to_token() || definition_.kind == TokenKind::Bad) {
        return false;
    }
    return *p_ == '"' || is_binary_string(*p_);
}

// The tight loop: plain numbers, blanks, line ends and short binary numbers straight from the
// block. Everything else, and what a block boundary may cut, goes through lex(). store(value, text,
// at): text is the number as written, with a delimiter behind it, null if binary; at is its place
// in the block, null if it is the current token's.
template <class Store> bool Lexer::read_numbers(Store store) {
    for (;;) {
        const char* p = p_;
        while (p < end_ && floats_left_ < 0) {
            const CharClass c = class_of(*p);
            if (c == White) {
                ++p;
            } else if (c == LineEnd) {
                p_ = p;
                newline();
                p = p_;
            } else if (c == High) {
                const BinaryNumber n = binary_number(p, end_);
                if (!n.end) {
                    break;
                }
                is_binary_ = true;
                store(n.value, nullptr, p);
                p = n.end;
            } else {
                const PlainNumber n = scan_plain(p);
                // At the end of the block the number may go on in the next one.
                if (!n.end || n.end >= end_ || class_of(*n.end) == Regular) {
                    break;
                }
                store(n.value, p, p);
                p = n.end;
            }
        }
        p_ = p;
        lex(token_);
        if (token_.kind != TokenKind::Number) {
            return token_.kind == TokenKind::ArrayEnd;
        }
        store(token_.number, token_.text.empty() ? nullptr : token_.text.c_str(), nullptr);
    }
}

namespace {

float nearest_float(double value, const char* text) {
    return rounds_once(value) ? static_cast<float>(value)
           : text             ? to_float(scan_decimal(text))
                              : narrow(value);
}

} // namespace

bool Lexer::read_floats(std::vector<float>& out) {
    if (floats_left_ >= 0) {
        return read_floats_of_array(out);
    }
    return read_numbers([&](double value, const char* text, const char*) {
        out.push_back(nearest_float(value, text));
    });
}

bool Lexer::read_both(std::vector<float>& floats, std::vector<double>& doubles) {
    return read_numbers([&](double value, const char* text, const char*) {
        floats.push_back(nearest_float(value, text));
        doubles.push_back(value);
    });
}

bool Lexer::read_doubles(std::vector<double>& out) {
    return read_numbers([&](double value, const char*, const char*) { out.push_back(value); });
}

bool Lexer::read_ints(std::vector<std::int32_t>& out, IntTrouble& trouble) {
    return read_numbers([&](double value, const char*, const char* at) {
        bool inexact = false, overflow = false;
        out.push_back(to_int(value, inexact, overflow));
        if (!inexact && !overflow) {
            return;
        }
        const base::SourcePos pos = at ? place(at) : token_.pos;
        if (inexact && trouble.inexact.line == 0) {
            trouble.inexact = pos;
        }
        if (overflow && trouble.overflow.line == 0) {
            trouble.overflow = pos;
        }
    });
}

bool Lexer::read_strings(std::vector<std::string>& out) {
    for (;;) {
        lex(token_);
        if (token_.kind != TokenKind::String) {
            return token_.kind == TokenKind::ArrayEnd;
        }
        out.push_back(std::move(token_.text));
    }
}

void Lexer::start_recording() {
    recorded_ = {};
    recorded_.start = token_.pos;
    recorded_.start_byte = offset(token_begin_);
    recording_ = true;
    record_from_ = token_begin_;
    if (token_.kind == TokenKind::Name && class_of(*token_begin_) == High) {
        const std::uint32_t code = static_cast<unsigned char>(token_begin_[1]);
        recorded_.codes.requests[code] = {token_.text, 0}; // it was read before this began
    }
}

Recording Lexer::stop_recording() {
    recording_ = false;
    recorded_.text.append(record_from_, token_begin_);
    return std::move(recorded_);
}

const std::string& Lexer::read_error() const {
    static const std::string none;
    return at_end_ ? source_->error() : none;
}

Lexer::NotFinite Lexer::take_not_finite() {
    return std::exchange(not_finite_, {});
}

} // namespace rib
