// SPDX-License-Identifier: Apache-2.0
// RIB bytes to tokens (ri.md, sections 2 and 3). Reads block-wise; holds one token and one block.
//
// Numbers inside brackets, the bulk of every large file, are not made tokens: read_floats() and its
// relatives go from bytes to vectors. Text and binary tokens may follow each other in any order;
// from the first binary one on, places are byte offsets.
#pragma once

#include "ribtools/number.h"
#include "ribtools/rib_source.h"
#include "runtime/base/diag.h"

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace rib {

enum class TokenKind : std::uint8_t { End, Name, Number, String, ArrayBegin, ArrayEnd, Bad };

struct Token {
    TokenKind kind = TokenKind::End;
    bool is_integer = false; // Number: written without point and exponent
    base::SourcePos pos;
    double number = 0;
    std::string text; // Name, String (escapes resolved), Number in text form; Bad: as written
    const char* reason = nullptr;         // Bad: what is wrong with it
    base::Code code = base::Code::Syntax; // Bad: its kind of error
};

struct Comment {
    std::string_view kind, text; // "structure" (##) or "comment" (#), without the marks
    base::SourcePos pos;
    bool trailing = false; // something precedes it on its line
};

// What the codes of a binary stream stand for: request names, strings.
struct CodeTable {
    struct Entry {
        std::string text;
        std::uint64_t defined_at = 0; // byte offset
    };
    std::unordered_map<std::uint32_t, Entry> requests, strings;
};

// A piece of a stream, kept to be read again: its text, and what it owes to its place.
struct Recording {
    std::string text;
    base::SourcePos start;
    std::uint64_t start_byte = 0;
    CodeTable codes; // those it uses without defining them
};

class Lexer {
public:
    using CommentHandler = std::function<void(const Comment&)>;

    // start: the place of the first byte, file id included. on_comment may be null; it must outlive
    // the lexer.
    Lexer(std::unique_ptr<ByteSource> source, base::SourcePos start,
          const CommentHandler* on_comment);
    Lexer(std::shared_ptr<const Recording> recording, const CommentHandler* on_comment);

    // The current token; the first after construction is read by advance().
    [[nodiscard]] const Token& token() const { return token_; }
    [[nodiscard]] Token& token() { return token_; }
    void advance();
    // The token i places behind the current one (0 = next).
    const Token& ahead(std::size_t i);

    // Only while the current token is ArrayBegin: whether the array holds strings (false for an
    // empty one).
    [[nodiscard]] bool array_holds_strings();

    // Only while the current token is ArrayBegin: append all elements and stop with ArrayEnd as the
    // current token. False: an element is no number (no string); it is the current token then.
    bool read_floats(std::vector<float>& out);
    bool read_doubles(std::vector<double>& out);
    // Both roundings of each number.
    bool read_both(std::vector<float>& floats, std::vector<double>& doubles);
    // Reals are truncated: *inexact is set to the first not integral one's place; *overflow to the
    // first one's that does not fit (stored as the nearest int).
    struct IntTrouble {
        base::SourcePos inexact, overflow;
    };
    bool read_ints(std::vector<std::int32_t>& out, IntTrouble& trouble);
    bool read_strings(std::vector<std::string>& out);

    // Keeps the text from the current token (a Name) on, for inline archives; stop_recording()
    // returns it up to, without, the then current Name token.
    void start_recording();
    [[nodiscard]] Recording stop_recording();

    // Why the stream ended before its end; empty if it did not.
    [[nodiscard]] const std::string& read_error() const;
    [[nodiscard]] bool is_damaged() const { return source_->is_damaged(); }

    // NaN and infinite numbers since the last call, and the place of the first. They were read as 0
    // and the largest number: RIB has no others (only its binary form can spell them).
    struct NotFinite {
        std::size_t count = 0;
        base::SourcePos pos;
    };
    [[nodiscard]] NotFinite take_not_finite();

private:
    void lex(Token& t);
    void lex_run(Token& t);
    void skip_run();
    void lex_string(Token& t);
    void lex_escape(Token& t);
    void skip_comment();
    bool skip_white();
    bool skip_to_token();

    // Binary tokens, rib_binary.cpp.
    void lex_binary(Token& t);
    void lex_number(Token& t);
    void lex_float_of_array(Token& t);
    void begin_float_array(Token& t);
    void refer(Token& t, std::uint32_t code, bool is_request);
    bool read_floats_of_array(std::vector<float>& out);
    bool define();
    bool lex_string_form(Token& t);
    bool take_string(std::uint64_t length, std::string& out);
    [[nodiscard]] bool needs(std::size_t n);
    [[nodiscard]] std::uint64_t take_big_endian(std::size_t n);
    [[nodiscard]] double finite(double value, const char* at);
    void bad(Token& t, const char* reason, base::Code code = base::Code::BadFile);

    bool refill(const char*& keep);
    bool refill() {
        const char* keep = p_;
        return refill(keep);
    }
    void newline();
    [[nodiscard]] base::SourcePos place(const char* p) const;
    [[nodiscard]] std::uint64_t offset(const char* p) const {
        return block_at_ + static_cast<std::uint64_t>(p - (buffer_.data() + 1));
    }
    template <class Store> bool read_numbers(Store store);

    std::unique_ptr<ByteSource> source_;
    const CommentHandler* on_comment_;
    std::size_t capacity_; // bytes of input the buffer holds
    std::vector<char> buffer_;
    // [p_, end_) is unread; *end_ is a sentinel (NUL). buffer_[0] keeps the byte before the block,
    // for CR LF.
    const char* p_;
    const char* end_;
    bool at_end_ = false; // the source has no more
    std::uint32_t file_id_;
    std::uint32_t line_;
    std::int64_t line_start_ = 0; // offset of column 1 from p_'s block start
    std::uint64_t block_at_ = 0;  // bytes of the stream before the block
    bool is_binary_ = false;      // a binary token was seen: places are byte offsets
    // Elements to come of an array of binary floats, -1 outside one; at 0 its end is due.
    std::int64_t floats_left_ = -1;
    CodeTable codes_;
    std::uint64_t num_expanded_ = 0; // bytes of strings given for codes
    Token definition_;               // Bad: a malformed definition that no token has told of yet
    NotFinite not_finite_;
    Token token_;
    const char* token_begin_ = nullptr; // of the last token lexed; in the buffer if it is a run
    std::deque<Token> ahead_;
    bool recording_ = false;
    const char* record_from_ = nullptr;
    Recording recorded_;
};

// Value of a number where an integer is wanted (ri.md 2.2): truncated towards zero, saturated.
[[nodiscard]] std::int32_t to_int(double value, bool& inexact, bool& overflow);

} // namespace rib
