// SPDX-License-Identifier: Apache-2.0
#include "ribtools/rib_parse.h"

#include "ribtools/rib_chars.h"
#include "ribtools/spelling.h"

#include <charconv>
#include <cmath>
#include <limits>

namespace rib {

namespace {

// Garbage must not flood the terminal: so many complaints about syntax per stream are shown.
constexpr std::uint64_t max_shown_errors = 200;

std::string quote(std::string_view text) {
    return "'" + printable(text) + "'";
}

std::string handle_text(double number) {
    char text[64];
    const bool integral = number == std::trunc(number) && std::fabs(number) < 1e15;
    const auto result = integral
                            ? std::to_chars(text, std::end(text), static_cast<long long>(number))
                            : std::to_chars(text, std::end(text), number);
    return {text, result.ptr};
}

// The i-th blank-separated word.
std::string_view word(std::string_view words, std::size_t i) {
    for (; i > 0; --i) {
        words.remove_prefix(words.find(' ') + 1);
    }
    return words.substr(0, words.find(' '));
}

bool is_scalar(char code) {
    return code == 'i' || code == 'f' || code == 'c' || code == 'b';
}

} // namespace

bool ColorModel::is_rgb() const {
    return rgb_of_sample == ColorModel().rgb_of_sample;
}

template <class T> std::vector<T> ColorModel::to_rgb(const std::vector<T>& samples) const {
    const std::size_t n = num_samples();
    std::vector<T> rgb(samples.size() / n * 3);
    for (std::size_t item = 0; item < samples.size() / n; ++item) {
        for (std::size_t i = 0; i < n; ++i) {
            for (std::size_t k = 0; k < 3; ++k) {
                rgb[item * 3 + k] += samples[item * n + i] * static_cast<T>(rgb_of_sample[i][k]);
            }
        }
    }
    return rgb;
}
template std::vector<float> ColorModel::to_rgb(const std::vector<float>&) const;
template std::vector<double> ColorModel::to_rgb(const std::vector<double>&) const;

std::string describe(const Token& token) {
    switch (token.kind) {
    case TokenKind::End:
        return "the end of the file";
    case TokenKind::Name:
        return "the request name " + quote(token.text);
    case TokenKind::Number:
        return "a number";
    case TokenKind::String:
        return "the string \"" + printable(token.text) + "\"";
    case TokenKind::ArrayBegin:
        return "'['";
    case TokenKind::ArrayEnd:
        return "']'";
    case TokenKind::Bad:
        return std::string(token.reason) + " " + quote(token.text);
    }
    return "";
}

Parser::Parser(Lexer& lexer, base::Diag& diag, const Dictionary& dictionary,
               const ColorModel& colors, ParseMode mode)
    : lexer_(lexer), diag_(diag), dictionary_(dictionary), colors_(colors), mode_(mode) {}

void Parser::error(base::Severity severity, base::Code code, base::SourcePos pos,
                   const std::string& text) {
    if (token().kind != TokenKind::Name && !lexer_.read_error().empty()) {
        return; // the stream broke off: that is one message, not several
    }
    if (num_errors_ < max_shown_errors) {
        num_errors_ +=
            diag_.report_few(base::kind_of(text), base::max_alike, severity, code, pos, text);
    } else if (num_errors_++ == max_shown_errors) {
        diag_.report(base::Severity::Error, base::Code::Limit, pos,
                     "too many errors in this stream: further ones of its syntax are not shown");
    }
}

// "expected ..., got ...; request skipped".
Parser::Outcome Parser::expected(std::string_view what) {
    std::string text = std::string(request_name_) + ": expected " + std::string(what);
    if (!arg_name_.empty()) {
        text += " for '" + std::string(arg_name_) + "'";
    }
    error(base::Severity::Error, syntax_code(), token().pos,
          text + ", got " + describe(token()) + "; request skipped");
    return Outcome::Skip;
}

void Parser::skip_to_name() {
    while (token().kind != TokenKind::Name && token().kind != TokenKind::End) {
        lexer_.advance();
    }
}

// Makes the next request name the current token; false at the end.
bool Parser::next_name() {
    if (token_used_) {
        lexer_.advance();
        token_used_ = false;
    }
    if (token().kind != TokenKind::Name && token().kind != TokenKind::End) {
        error(base::Severity::Error, syntax_code(), token().pos,
              "expected a request name, got " + describe(token()) +
                  "; skipped to the next request");
        skip_to_name();
    }
    return token().kind == TokenKind::Name;
}

bool Parser::next(Request& request) {
    while (next_name()) {
        const RequestId* id = find_request(token().text);
        request.clear();
        request.id = id ? *id : RequestId::Unknown;
        request.pos = token().pos;
        const bool is_known = id && row(*id).kind != RequestKind::Skipped;
        Outcome outcome = is_known                   ? parse(request, row(*id))
                          : mode_ == ParseMode::Keep ? keep_loose(request)
                                                     : skip_request(id);
        const bool may_skip =
            mode_ == ParseMode::Resolve && is_known && row(request.id).effect == BlockEffect::None;
        if (note_not_finite(may_skip) && may_skip) {
            outcome = Outcome::Skip;
        }
        if (outcome == Outcome::Ok) {
            return true;
        }
        skip_to_name();
    }
    return false;
}

// The current token names a request that the table lacks or lists as outside RI 3.2.
Parser::Outcome Parser::skip_request(const RequestId* id) {
    if (id) {
        const RequestRow& table_row = row(*id);
        diag_.report_once("skipped:" + std::string(table_row.name), base::Severity::Warning,
                          base::Code::Unimplement, token().pos,
                          std::string(table_row.name) + ": outside RI 3.2 (" +
                              std::string(table_row.note) + "); ignored");
    } else {
        error(base::Severity::Error, base::Code::BadToken, token().pos,
              "unknown request " + quote(token().text) + "; skipped" + hint_for(token().text));
    }
    lexer_.advance();
    return Outcome::Skip;
}

// " (did you mean Sphere?)", or nothing. Looking is dear, and one name is often wrong everywhere.
std::string Parser::hint_for(const std::string& name) {
    if (name != unknown_name_) {
        unknown_name_ = name;
        unknown_hint_ = similar_request(name);
    }
    return unknown_hint_.empty() ? "" : " (did you mean " + std::string(unknown_hint_) + "?)";
}

// Tells of NaN and infinities in the request just read; true if there were any.
bool Parser::note_not_finite(bool skip) {
    const Lexer::NotFinite found = lexer_.take_not_finite();
    if (found.count > 0) {
        error(base::Severity::Error, base::Code::Range, found.pos,
              std::string(request_name_) + ": " + std::to_string(found.count) +
                  (found.count > 1 ? " numbers that are" : " number that is") + " not finite; " +
                  (skip ? "request skipped" : "NaN is read as 0, infinity as the largest number"));
    }
    return found.count > 0;
}

Parser::Outcome Parser::parse(Request& request, const RequestRow& table_row) {
    if (table_row.args.empty() && table_row.params == ParamUse::None) {
        token_used_ = true;
        return Outcome::Ok;
    }
    request_name_ = table_row.name;
    lexer_.advance();
    if (parse_args(request, table_row) == Outcome::Skip) {
        return Outcome::Skip;
    }
    arg_name_ = {};
    if (table_row.params != ParamUse::None) {
        parse_params(request, table_row);
    }
    return finish(table_row, table_row.effect != BlockEffect::None);
}

// What follows a complete request must be a name. Blocks are opened and closed all the same: losing
// one would change everything after it.
Parser::Outcome Parser::finish(const RequestRow& table_row, bool taken_anyway) {
    if (token().kind == TokenKind::Name || token().kind == TokenKind::End) {
        return Outcome::Ok;
    }
    const base::SourcePos pos = token().pos;
    const base::Code code = syntax_code();
    std::string what = describe(token());
    std::size_t numbers = 0;
    for (; token().kind == TokenKind::Number; lexer_.advance()) {
        ++numbers;
    }
    if (numbers > 0) {
        what = std::to_string(numbers) + " surplus number" + (numbers > 1 ? "s" : "");
    } else if (token().kind != TokenKind::Bad) {
        what = "surplus " + what;
    }
    const std::string behind = table_row.params != ParamUse::None ? "its parameter list"
                               : table_row.arg_names.empty()
                                   ? "a request without arguments"
                                   : "its arguments (" + std::string(table_row.arg_names) + ")";
    error(base::Severity::Error, code, pos,
          std::string(table_row.name) + ": " + what + " after " + behind +
              (taken_anyway ? "; ignored" : "; request skipped"));
    skip_to_name();
    return taken_anyway ? Outcome::Ok : Outcome::Skip;
}

// Walks the argument codes; see the head of ri_requests.def.
Parser::Outcome Parser::parse_args(Request& request, const RequestRow& table_row) {
    const std::string_view codes = table_row.args;
    std::size_t index = 0;
    for (std::size_t k = 0; k < codes.size(); ++k) {
        if (codes[k] == '(') {
            if (token().kind == TokenKind::Bad && token().text == "-") {
                lexer_.advance(); // "DepthOfField -", as the specification prints it
            }
            if (!starts(codes[k + 1])) {
                k = codes.find(')', k);
            }
            continue;
        }
        if (codes[k] == ')' || codes[k] == '?') {
            continue;
        }
        arg_name_ = word(table_row.arg_names, index);
        std::size_t used = 1;
        const std::span<Arg> rest = std::span(request.args).subspan(index);
        const bool optional = k + 1 < codes.size() && codes[k + 1] == '?';
        const Outcome outcome = is_scalar(codes[k]) && !(optional && !starts(codes[k]))
                                    ? scalars(codes.substr(k), rest, used)
                                    : parse_arg(codes[k], optional, rest[0]);
        if (outcome == Outcome::Skip) {
            return Outcome::Skip;
        }
        index += used;
        k += used - 1;
    }
    return Outcome::Ok;
}

// Whether the current token can begin an argument of this code: decides about optional ones.
bool Parser::starts(char code) const {
    const TokenKind kind = token().kind;
    switch (code) {
    case 's':
    case 'B':
        return kind == TokenKind::String || kind == TokenKind::ArrayBegin;
    case 'h':
        return kind == TokenKind::String || kind == TokenKind::Number;
    case 'S':
        return kind == TokenKind::ArrayBegin;
    default:
        return kind == TokenKind::Number || kind == TokenKind::ArrayBegin;
    }
}

Parser::Outcome Parser::parse_arg(char code, bool optional, Arg& arg) {
    if (optional && !starts(code)) {
        return Outcome::Ok;
    }
    switch (code) {
    case 'h':
        return handle(optional, arg);
    case 's':
        return string(arg);
    case 'S':
        return strings(arg);
    case 'I':
        return ints(arg);
    case 'F':
        return floats(arg);
    case 'm':
        return matrix(arg);
    case 'B':
        return basis(arg);
    case 'v':
        return version(arg);
    default:
        return Outcome::Ok;
    }
}

std::size_t Parser::scalar_size(char code) const {
    return code == 'c' ? colors_.num_samples() : code == 'b' ? 6 : 1;
}

// One scalar argument, or, from one bracket, as many of a run of them as it holds numbers for.
Parser::Outcome Parser::scalars(std::string_view codes, std::span<Arg> run, std::size_t& used) {
    if (mode_ == ParseMode::Keep && codes[0] == 'c') {
        return color_samples(run[0]);
    }
    if (token().kind == TokenKind::ArrayBegin) {
        return bracketed_scalars(codes, run, used);
    }
    std::vector<double> values;
    if (bare_numbers(scalar_size(codes[0]), values) == Outcome::Skip) {
        return Outcome::Skip;
    }
    return store_scalar(codes[0], values.data(), run[0]);
}

Parser::Outcome Parser::bracketed_scalars(std::string_view codes, std::span<Arg> run,
                                          std::size_t& used) {
    std::vector<double> values;
    const base::SourcePos pos = token().pos;
    if (!lexer_.read_doubles(values)) {
        return expected("numbers");
    }
    std::size_t at = 0, wanted = 0;
    used = 0;
    for (; used < codes.size() && is_scalar(codes[used]); ++used) {
        wanted += scalar_size(codes[used]);
        if (wanted <= values.size()) {
            if (store_scalar(codes[used], &values[at], run[used]) == Outcome::Skip) {
                return Outcome::Skip;
            }
            at = wanted;
        }
        if (wanted >= values.size()) {
            used += wanted == values.size();
            break;
        }
    }
    if (at != values.size() || values.empty()) {
        error(base::Severity::Error, base::Code::Syntax, pos,
              std::string(request_name_) + ": " + std::to_string(values.size()) +
                  " numbers in brackets where " + std::to_string(wanted) +
                  " were expected (from '" + std::string(arg_name_) + "' on); request skipped");
        return Outcome::Skip;
    }
    lexer_.advance();
    return Outcome::Ok;
}

Parser::Outcome Parser::bare_numbers(std::size_t count, std::vector<double>& out) {
    while (out.size() < count) {
        if (token().kind != TokenKind::Number) {
            return expected(count == 1 ? std::string("a number")
                                       : std::to_string(count) + " numbers");
        }
        out.push_back(token().number);
        lexer_.advance();
    }
    return Outcome::Ok;
}

Parser::Outcome Parser::store_scalar(char code, const double* values, Arg& arg) {
    arg.given = true;
    if (code == 'i') {
        Lexer::IntTrouble trouble;
        bool inexact = false, overflow = false;
        arg.ints = {to_int(*values, inexact, overflow)};
        if (inexact || overflow) {
            (overflow ? trouble.overflow : trouble.inexact) = token().pos;
            note_int_trouble(trouble, arg_name_);
        }
        return overflow ? Outcome::Skip : Outcome::Ok;
    }
    arg.numbers.assign(values, values + scalar_size(code));
    if (code == 'c' && !colors_.is_rgb()) {
        arg.numbers = colors_.to_rgb(arg.numbers);
    }
    return Outcome::Ok;
}

void Parser::note_int_trouble(const Lexer::IntTrouble& trouble, std::string_view what) {
    const std::string head = std::string(request_name_) + ": '" + std::string(what) + "'";
    if (trouble.overflow.line > 0) {
        error(base::Severity::Error, base::Code::Range, trouble.overflow,
              head + ": the number does not fit an integer; skipped");
    } else if (trouble.inexact.line > 0) {
        error(base::Severity::Warning, base::Code::Range, trouble.inexact,
              head + ": expected an integer; the fraction is cut off");
    }
}

// Tells LightSource "shader" "handle" ... from LightSource "shader" "parameter" value ...: strings
// up to the first other value are the handle, if their number says so, and token-value pairs
// (ri.md 6.6).
bool Parser::string_is_handle() {
    std::size_t num_strings = 1;
    while (lexer_.ahead(num_strings - 1).kind == TokenKind::String) {
        ++num_strings;
    }
    const TokenKind end = lexer_.ahead(num_strings - 1).kind;
    const bool value_follows = end == TokenKind::Number || end == TokenKind::ArrayBegin;
    return num_strings % 2 == (value_follows ? 0u : 1u);
}

Parser::Outcome Parser::handle(bool optional, Arg& arg) {
    const bool bracketed = token().kind == TokenKind::ArrayBegin;
    if (bracketed) {
        lexer_.advance();
    }
    if (token().kind == TokenKind::Number) {
        arg.strings = {handle_text(token().number)};
    } else if (token().kind == TokenKind::String) {
        if (optional && !string_is_handle()) {
            return Outcome::Ok;
        }
        arg.strings = {std::move(lexer_.token().text)};
    } else {
        return expected("a handle (integer or string)");
    }
    arg.given = true;
    lexer_.advance();
    if (bracketed) {
        if (token().kind != TokenKind::ArrayEnd) {
            return expected("']'");
        }
        lexer_.advance();
    }
    return Outcome::Ok;
}

Parser::Outcome Parser::string(Arg& arg) {
    if (token().kind == TokenKind::ArrayBegin) {
        if (strings(arg) == Outcome::Skip) {
            return Outcome::Skip;
        }
        return arg.strings.size() == 1 ? Outcome::Ok : expected("one string");
    }
    if (token().kind != TokenKind::String) {
        return expected("a string");
    }
    arg.given = true;
    arg.strings.clear();
    arg.strings.push_back(std::move(lexer_.token().text));
    lexer_.advance();
    return Outcome::Ok;
}

Parser::Outcome Parser::strings(Arg& arg) {
    if (token().kind == TokenKind::String) {
        return string(arg);
    }
    if (token().kind != TokenKind::ArrayBegin || !lexer_.read_strings(arg.strings)) {
        return expected("an array of strings");
    }
    arg.given = true;
    lexer_.advance();
    return Outcome::Ok;
}

Parser::Outcome Parser::ints(Arg& arg) {
    Lexer::IntTrouble trouble;
    if (token().kind == TokenKind::ArrayBegin) {
        if (!lexer_.read_ints(arg.ints, trouble)) {
            return expected("integers");
        }
        lexer_.advance();
    } else if (token().kind == TokenKind::Number) {
        for (; token().kind == TokenKind::Number; lexer_.advance()) {
            bool inexact = false, overflow = false;
            arg.ints.push_back(to_int(token().number, inexact, overflow));
            if (inexact || overflow) {
                (overflow ? trouble.overflow : trouble.inexact) = token().pos;
            }
        }
    } else {
        return expected("an array of integers");
    }
    arg.given = true;
    note_int_trouble(trouble, arg_name_);
    return trouble.overflow.line > 0 ? Outcome::Skip : Outcome::Ok;
}

Parser::Outcome Parser::floats(Arg& arg) {
    if (token().kind == TokenKind::ArrayBegin) {
        if (!lexer_.read_floats(arg.floats)) {
            return expected("numbers");
        }
        lexer_.advance();
    } else if (token().kind == TokenKind::Number) {
        for (; token().kind == TokenKind::Number; lexer_.advance()) {
            arg.floats.push_back(narrow(token().number));
        }
    } else {
        return expected("an array of numbers");
    }
    arg.given = true;
    return Outcome::Ok;
}

Parser::Outcome Parser::matrix(Arg& arg) {
    arg.given = true;
    if (token().kind == TokenKind::Number) {
        return bare_numbers(16, arg.numbers);
    }
    if (token().kind != TokenKind::ArrayBegin || !lexer_.read_doubles(arg.numbers)) {
        return expected("an array of 16 numbers");
    }
    if (arg.numbers.size() != 16) {
        error(base::Severity::Error, base::Code::Syntax, token().pos,
              std::string(request_name_) + ": " + std::to_string(arg.numbers.size()) +
                  " numbers for '" + std::string(arg_name_) +
                  "' where 16 were expected; request skipped");
        return Outcome::Skip;
    }
    lexer_.advance();
    return Outcome::Ok;
}

Parser::Outcome Parser::basis(Arg& arg) {
    const bool name = token().kind == TokenKind::String ||
                      (token().kind == TokenKind::ArrayBegin && lexer_.array_holds_strings());
    return name ? string(arg) : matrix(arg);
}

// A number, "3.03.1" (no number by the grammar), or a string holding either.
Parser::Outcome Parser::version(Arg& arg) {
    const TokenKind kind = token().kind;
    const std::string& text = token().text;
    const bool is_malformed = kind == TokenKind::Bad && syntax_code() == base::Code::Syntax;
    if (kind == TokenKind::Number) {
        arg.numbers = {token().number};
    } else if (kind == TokenKind::String || is_malformed) {
        const Decimal d = scan_decimal(text.c_str());
        if (!d.end || !is_run(text)) {
            return expected("a version number");
        }
        arg.numbers = {to_double(d)};
        if (d.end != text.data() + text.size()) {
            arg.strings = {text};
        }
    } else {
        return expected("a version number");
    }
    arg.given = true;
    lexer_.advance();
    return Outcome::Ok;
}

bool Parser::record_archive(base::SourcePos opened, Recording& recording) {
    if (token_used_) {
        lexer_.advance();
        token_used_ = false;
    }
    lexer_.start_recording();
    for (int depth = 1;;) {
        if (token().kind == TokenKind::End) {
            break;
        }
        if (token().kind == TokenKind::Name) {
            depth += token().text == "ArchiveBegin" ? 1 : token().text == "ArchiveEnd" ? -1 : 0;
        }
        if (depth == 0) {
            break;
        }
        lexer_.advance();
    }
    recording = lexer_.stop_recording();
    if (token().kind == TokenKind::End) {
        error(base::Severity::Error, base::Code::Nesting, opened,
              "ArchiveBegin without ArchiveEnd before the end of the file; archive dropped");
        return false;
    }
    token_used_ = true;
    return true;
}

} // namespace rib
