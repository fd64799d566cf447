// SPDX-License-Identifier: Apache-2.0
// RIB bytes to tokens (ri.md, section 2). Reads block-wise; holds one token and one block.
//
// Numbers inside brackets, the bulk of every large file, are not made tokens: read_floats() and its
// relatives go from bytes to vectors. Binary tokens (section 3) will enter in lex_binary(); until
// then a byte >= 0200 is a Bad token.
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
#include <vector>

namespace rib {

enum class TokenKind : std::uint8_t { End, Name, Number, String, ArrayBegin, ArrayEnd, Bad };

struct Token {
    TokenKind kind = TokenKind::End;
    bool is_integer = false; // Number: written without point and exponent
    base::SourcePos pos;
    double number = 0;
    std::string text;             // Name, String (escapes resolved); Bad: as written
    const char* reason = nullptr; // Bad: what is wrong with it
};

class Lexer {
public:
    using CommentHandler = std::function<void(std::string_view kind, std::string_view text)>;

    // start: the place of the first byte, file id included. on_comment may be null; it must outlive
    // the lexer.
    Lexer(std::unique_ptr<ByteSource> source, base::SourcePos start,
          const CommentHandler* on_comment);

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
    [[nodiscard]] std::string stop_recording();

    [[nodiscard]] const std::string& read_error() const { return source_->error(); }

private:
    void lex(Token& t);
    void lex_run(Token& t);
    void skip_run();
    void lex_string(Token& t);
    void lex_escape(Token& t);
    void lex_binary(Token& t);
    void skip_comment();
    bool skip_white();
    bool refill(const char*& keep);
    bool refill() {
        const char* keep = p_;
        return refill(keep);
    }
    void newline();
    [[nodiscard]] base::SourcePos place(const char* p) const;
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
    Token token_;
    const char* token_begin_ = nullptr; // of the last token lexed; in the buffer if it is a run
    std::deque<Token> ahead_;
    bool recording_ = false;
    const char* record_from_ = nullptr;
    std::string recorded_;
};

// Value of a number where an integer is wanted (ri.md 2.2): truncated towards zero, saturated.
[[nodiscard]] std::int32_t to_int(double value, bool& inexact, bool& overflow);

} // namespace rib
