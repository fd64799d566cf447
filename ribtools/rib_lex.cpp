// SPDX-License-Identifier: Apache-2.0
#include "ribtools/rib_lex.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

namespace rib {

namespace {

constexpr std::size_t block_size = 256 * 1024;
constexpr std::size_t least_block = 64;
// The longest name or number; a longer run of regular characters is garbage.
constexpr std::ptrdiff_t max_run = 64 * 1024;

enum CharClass : std::uint8_t { Regular, White, LineEnd, Delimiter, High };

constexpr std::array<CharClass, 256> make_classes() {
    std::array<CharClass, 256> c{};
    for (std::size_t i = 128; i < 256; ++i) {
        c[i] = High;
    }
    c[' '] = c['\t'] = c['\f'] = c['\v'] = White;
    c['\n'] = c['\r'] = LineEnd;
    c['"'] = c['['] = c[']'] = c['#'] = Delimiter;
    return c;
}
constexpr std::array<CharClass, 256> classes = make_classes();

CharClass class_of(char c) {
    return classes[static_cast<unsigned char>(c)];
}

bool starts_number(char c) {
    return (c >= '0' && c <= '9') || c == '-' || c == '+' || c == '.';
}

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

// Moves what is still needed, from keep on, to the front of the buffer and reads more behind it.
// False at the end of the source or when a token fills the whole buffer.
bool Lexer::refill(const char*& keep) {
    if (at_end_) {
        return false;
    }
    if (recording_) {
        recorded_.append(record_from_, keep);
    }
    char* front = buffer_.data() + 1;
    const std::size_t kept = static_cast<std::size_t>(end_ - keep);
    if (kept >= capacity_) {
        record_from_ = keep;
        return false;
    }
    line_start_ -= keep - front;
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
        (*on_comment_)(structure ? "structure" : "comment",
                       std::string_view(text).substr(structure ? 2 : 1));
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

void Lexer::lex(Token& t) {
    t.text.clear();
    t.reason = nullptr;
    const bool more = skip_white();
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
    const char* begin = p_;
    do {
        while (class_of(*p_) == Regular && p_ < end_ && p_ - begin < max_run) {
            ++p_;
        }
    } while (p_ == end_ && p_ - begin < max_run && refill(begin));
    token_begin_ = begin;
    t.text.assign(begin, p_);
    if (p_ - begin == max_run) {
        skip_run();
        t.kind = TokenKind::Bad;
        t.reason = "too long a name or number";
        return;
    }
    if (!starts_number(*begin)) {
        t.kind = TokenKind::Name;
        return;
    }
    const Decimal d = scan_decimal(begin);
    if (d.end != p_) {
        t.kind = TokenKind::Bad;
        t.reason = "malformed number";
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
                t.kind = TokenKind::Bad;
                t.reason = "string without closing quote";
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

// 0377 ends the stream wherever it stands (ri.md 2.6).
void Lexer::lex_binary(Token& t) {
    if (static_cast<unsigned char>(*p_) == 0xff) {
        t.kind = TokenKind::End;
        return;
    }
    t.kind = TokenKind::Bad;
    t.reason = "binary token, which this reader does not know";
    t.text = *p_++;
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
    return skip_white() && *p_ == '"';
}

// The tight loop: plain numbers, blanks and line ends straight from the block. Everything else, and
// what a block boundary may cut, goes through lex(). store(value, text): text is the number as
// written, with a delimiter behind it.
template <class Store> bool Lexer::read_numbers(Store store) {
    for (;;) {
        const char* p = p_;
        while (p < end_) {
            const CharClass c = class_of(*p);
            if (c == White) {
                ++p;
            } else if (c == LineEnd) {
                p_ = p;
                newline();
                p = p_;
            } else {
                const PlainNumber n = scan_plain(p);
                // At the end of the block the number may go on in the next one.
                if (!n.end || n.end >= end_ || class_of(*n.end) == Regular) {
                    break;
                }
                store(n.value, p);
                p = n.end;
            }
        }
        p_ = p;
        lex(token_);
        if (token_.kind != TokenKind::Number) {
            return token_.kind == TokenKind::ArrayEnd;
        }
        store(token_.number, token_.text.c_str());
    }
}

bool Lexer::read_floats(std::vector<float>& out) {
    return read_numbers([&](double value, const char* text) {
        out.push_back(rounds_once(value) ? static_cast<float>(value)
                                         : to_float(scan_decimal(text)));
    });
}

bool Lexer::read_doubles(std::vector<double>& out) {
    return read_numbers([&](double value, const char*) { out.push_back(value); });
}

bool Lexer::read_ints(std::vector<std::int32_t>& out, IntTrouble& trouble) {
    return read_numbers([&](double value, const char* text) {
        bool inexact = false, overflow = false;
        out.push_back(to_int(value, inexact, overflow));
        if (!inexact && !overflow) {
            return;
        }
        const bool in_block = text >= buffer_.data() && text < end_;
        const base::SourcePos pos = in_block ? place(text) : token_.pos;
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
    recorded_.clear();
    recording_ = true;
    record_from_ = token_begin_;
}

std::string Lexer::stop_recording() {
    recording_ = false;
    recorded_.append(record_from_, token_begin_);
    return std::move(recorded_);
}

} // namespace rib
