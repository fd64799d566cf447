// SPDX-License-Identifier: Apache-2.0
// Tokens to requests, driven by the args and params columns of ri_requests.def.
//
// In: a Lexer. Out: one complete, well-formed Request per call of next(). A malformed one is
// reported with its place, what was expected and what was done, and reading resumes at the next
// request name (ri.md 2.4). The dictionary and the color model are read when a value is met, so a
// Declare takes effect on the next request, as the standard demands.
//
// ParseMode::Keep is for programs that hand requests on instead of carrying them out: nothing is
// interpreted beyond what finding the ends of values needs (see the enum).
#pragma once

#include "ribtools/declare.h"
#include "ribtools/request.h"
#include "ribtools/rib_lex.h"
#include "runtime/base/diag.h"

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace rib {

// ColorSamples: how many numbers a color has in the stream, and RGB = sum of samples[i] *
// rgb_of_sample[i].
struct ColorModel {
    std::vector<std::array<float, 3>> rgb_of_sample = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

    [[nodiscard]] std::size_t num_samples() const { return rgb_of_sample.size(); }
    [[nodiscard]] bool is_rgb() const;
    // n colors of num_samples() to n of three.
    template <class T> [[nodiscard]] std::vector<T> to_rgb(const std::vector<T>& samples) const;
};

enum class ParseMode : std::uint8_t {
    // Parameters are resolved and judged, colors become RGB, requests outside RI 3.2 are left out.
    Resolve,
    // Requests as they are written: a parameter's name is its token with the declaration in it, and
    // all parameters are kept; colors have as many samples as are there; requests outside the table
    // are kept (Request::values). Numbers of undeclared parameters are integers if all of them are.
    Keep
};

class Parser {
public:
    Parser(Lexer& lexer, base::Diag& diag, const Dictionary& dictionary, const ColorModel& colors,
           ParseMode mode = ParseMode::Resolve);

    // The next request; false at the end of the stream. Requests without arguments and parameters
    // are handed on before the token behind them is read, so that WorldEnd on a pipe renders at
    // once.
    bool next(Request& request);

    // An inline archive: from here to the matching ArchiveEnd, which is consumed. False (reported
    // at `opened`): the stream ended first.
    bool record_archive(base::SourcePos opened, Recording& recording);

private:
    enum class Outcome : std::uint8_t { Ok, Skip };

    bool next_name();
    Outcome skip_request(const RequestId* id);
    [[nodiscard]] std::string hint_for(const std::string& name);
    Outcome parse(Request& request, const RequestRow& row);
    Outcome parse_args(Request& request, const RequestRow& row);
    Outcome parse_arg(char code, bool optional, Arg& arg);
    Outcome scalars(std::string_view codes, std::span<Arg> run, std::size_t& used);
    Outcome bracketed_scalars(std::string_view codes, std::span<Arg> run, std::size_t& used);
    Outcome bare_numbers(std::size_t count, std::vector<double>& out);
    Outcome store_scalar(char code, const double* values, Arg& arg);
    Outcome handle(bool optional, Arg& arg);
    Outcome string(Arg& arg);
    Outcome strings(Arg& arg);
    Outcome ints(Arg& arg);
    Outcome floats(Arg& arg);
    Outcome matrix(Arg& arg);
    Outcome basis(Arg& arg);
    Outcome version(Arg& arg);
    Outcome finish(const RequestRow& row, bool taken_anyway);
    [[nodiscard]] bool string_is_handle();
    [[nodiscard]] bool starts(char code) const;
    [[nodiscard]] std::size_t scalar_size(char code) const;

    // What only ParseMode::Keep does, rib_keep.cpp.
    Outcome keep_loose(Request& request);
    Outcome loose_value(LooseValue& value);
    Outcome color_samples(Arg& arg);
    bool keep_value(Param& param);
    void missing_value(const Param& param);

    // Parameter lists, rib_params.cpp.
    struct Resolved;
    void parse_params(Request& request, const RequestRow& row);
    [[nodiscard]] Resolved resolve(std::string_view token, base::SourcePos pos,
                                   const Request& request, const RequestRow& row);
    [[nodiscard]] Resolved resolve_inline(std::string_view token, base::SourcePos pos);
    bool read_value(Param& param, bool guess);
    bool read_array_value(Param& param, bool guess);
    bool read_bare_value(Param& param, bool guess);
    bool note_not_finite(bool skip);
    void note_int_trouble(const Lexer::IntTrouble& trouble, std::string_view what);
    bool check_value(Param& param, const RequestRow& row);
    void skip_value();
    void skip_array();

    void skip_to_name();
    Outcome expected(std::string_view what);
    void error(base::Severity severity, base::Code code, base::SourcePos pos,
               const std::string& text);
    [[nodiscard]] const Token& token() const { return lexer_.token(); }
    [[nodiscard]] base::Code syntax_code() const {
        return token().kind == TokenKind::Bad ? token().code : base::Code::Syntax;
    }

    Lexer& lexer_;
    base::Diag& diag_;
    const Dictionary& dictionary_;
    const ColorModel& colors_;
    const ParseMode mode_;
    bool token_used_ = true; // the current token belongs to the request handed out last
    std::string_view request_name_, arg_name_;
    std::uint64_t num_errors_ = 0;
    std::string unknown_name_; // the last one, and what it may have meant
    std::string_view unknown_hint_;
};

// "a number", "the string \"x\"", "the end of the file": for messages.
[[nodiscard]] std::string describe(const Token& token);

} // namespace rib
