// SPDX-License-Identifier: Apache-2.0
// The parser's second half: parameter lists (ri.md 2.3 and section 10). A faulty parameter is
// reported and left out; the request goes on without it.
#include "ribtools/number.h"
#include "ribtools/rib_parse.h"
#include "ribtools/spelling.h"

#include <algorithm>

namespace rib {

namespace {

std::string quote(std::string_view text) {
    return "'" + printable(text) + "'";
}

OptionCategory category_of(const Request& request) {
    return request.id == RequestId::Option      ? OptionCategory::Option
           : request.id == RequestId::Attribute ? OptionCategory::Attribute
           : request.id == RequestId::Display || request.id == RequestId::DisplayChannel
               ? OptionCategory::Display
               : OptionCategory::Hider;
}

bool is_numeric(ParamType type) {
    return type != ParamType::String && type != ParamType::Pointer;
}

} // namespace

// What a parameter's token stands for.
struct Parser::Resolved {
    enum class Status : std::uint8_t { Known, Guess, Skip } status = Status::Skip;
    ParamDecl decl;
    std::string name;
};

void Parser::parse_params(Request& request, const RequestRow& table_row) {
    while (token().kind == TokenKind::String) {
        const std::string name = std::move(lexer_.token().text);
        Param param;
        param.pos = token().pos;
        lexer_.advance();
        Resolved resolved = resolve(name, param.pos, request, table_row);
        if (resolved.status == Resolved::Status::Skip) {
            skip_value();
            continue;
        }
        param.decl = resolved.decl;
        param.guessed = resolved.status == Resolved::Status::Guess;
        if (mode_ == ParseMode::Keep) {
            param.name = name;
            if (keep_value(param)) {
                request.params.params.push_back(std::move(param));
            }
            continue;
        }
        param.name = std::move(resolved.name);
        if (!read_value(param, param.guessed) || !check_value(param, table_row)) {
            continue;
        }
        auto& params = request.params.params;
        const auto same = std::find_if(params.begin(), params.end(),
                                       [&](const Param& p) { return p.name == param.name; });
        if (same != params.end()) {
            *same = std::move(param); // the last one wins
        } else {
            params.push_back(std::move(param));
        }
    }
}

// Inline declaration, else Declare, else ri_options.def, else the predeclared names (ri.md 10.1).
Parser::Resolved Parser::resolve(std::string_view name, base::SourcePos pos, const Request& request,
                                 const RequestRow& table_row) {
    using enum Resolved::Status;
    if (is_inline_declaration(name) &&
        !(table_row.params == ParamUse::Option && name.starts_with("enable "))) {
        return resolve_inline(name, pos);
    }
    const Dictionary::Entry* entry = dictionary_.find(name);
    const bool keep = mode_ == ParseMode::Keep;
    if (entry && entry->illegal) {
        return {keep ? Guess : Skip, {}, {}};
    }
    const bool has_options = table_row.params == ParamUse::Option ||
                             table_row.params == ParamUse::Attribute ||
                             request.id == RequestId::Hider;
    if (has_options && (!entry || entry->predeclared)) {
        if (const OptionRow* option = find_option(category_of(request), request.string(0), name)) {
            const std::optional<ParamDecl> decl = option_type(*option);
            return {decl ? Known : Guess, decl.value_or(ParamDecl{}), std::string(name)};
        }
    }
    if (entry) {
        return {Known, entry->decl, std::string(name)};
    }
    if (keep || table_row.params != ParamUse::Primvars) {
        return {Guess, {}, std::string(name)};
    }
    if (!name.starts_with("__")) { // those are notes of later systems to themselves
        error(base::Severity::Error, base::Code::BadToken, pos,
              std::string(table_row.name) + ": parameter " + quote(name) +
                  " is not declared; its value is skipped");
    }
    return {Skip, {}, {}};
}

Parser::Resolved Parser::resolve_inline(std::string_view text, base::SourcePos pos) {
    Declaration d = parse_inline_declaration(text);
    const bool keep = mode_ == ParseMode::Keep;
    if (!d.error.empty()) {
        diag_.report_once("declaration:" + std::string(text), base::Severity::Error,
                          base::Code::Syntax, pos,
                          std::string(request_name_) + ": declaration " + quote(text) + ": " +
                              d.error + (keep ? "" : "; its values are skipped"));
        return {keep ? Resolved::Status::Guess : Resolved::Status::Skip, {}, {}};
    }
    if (d.is_reference) {
        d.decl.type = ParamType::String;
    }
    return {Resolved::Status::Known, d.decl, std::move(d.name)};
}

// The value of a parameter whose type is known, or guessed from it. False: reported or empty, the
// parameter is dropped.
bool Parser::read_value(Param& param, bool guess) {
    arg_name_ = param.name;
    switch (token().kind) {
    case TokenKind::ArrayBegin:
        return read_array_value(param, guess);
    case TokenKind::Number:
    case TokenKind::String:
        return read_bare_value(param, guess);
    default:
        missing_value(param);
        return false;
    }
}

void Parser::missing_value(const Param& param) {
    error(base::Severity::Error, base::Code::MissingData, token().pos,
          std::string(request_name_) + ": parameter " + quote(param.name) + " has no value: got " +
              describe(token()) + "; parameter dropped");
}

bool Parser::read_array_value(Param& param, bool guess) {
    const bool holds_strings = lexer_.array_holds_strings();
    if (guess) {
        param.decl.type = holds_strings ? ParamType::String : ParamType::Float;
    }
    const base::SourcePos pos = token().pos;
    bool good = false;
    Lexer::IntTrouble trouble;
    if (param.decl.type == ParamType::String) {
        good = lexer_.read_strings(param.strings);
    } else if (param.decl.type == ParamType::Integer) {
        good = lexer_.read_ints(param.ints, trouble);
    } else {
        good = lexer_.read_floats(param.floats);
    }
    if (good) {
        lexer_.advance();
        note_int_trouble(trouble, param.name);
        return trouble.overflow.line == 0;
    }
    const bool mismatch = token().kind == TokenKind::String || token().kind == TokenKind::Number;
    error(base::Severity::Error, mismatch ? base::Code::BadToken : base::Code::Syntax,
          mismatch ? pos : token().pos,
          std::string(request_name_) + ": parameter " + quote(param.name) + ": expected " +
              (param.decl.type == ParamType::String ? "strings" : "numbers") + " (" +
              declaration_text(param.decl) + "), got " + describe(token()) + "; parameter dropped");
    skip_array();
    return false;
}

bool Parser::read_bare_value(Param& param, bool guess) {
    const bool is_string = token().kind == TokenKind::String;
    if (guess) {
        param.decl.type = is_string ? ParamType::String : ParamType::Float;
    }
    if (is_string != !is_numeric(param.decl.type)) {
        // A string where a number is due is the next token if a value follows it.
        const TokenKind behind = is_string ? lexer_.ahead(0).kind : TokenKind::End;
        const bool missing = behind == TokenKind::Number || behind == TokenKind::ArrayBegin;
        error(base::Severity::Error, base::Code::BadToken, token().pos,
              std::string(request_name_) + ": parameter " + quote(param.name) + ": expected " +
                  (is_numeric(param.decl.type) ? "a number" : "a string") + " (" +
                  declaration_text(param.decl) + "), got " + describe(token()) +
                  "; parameter dropped");
        if (!missing) {
            skip_value();
        }
        return false;
    }
    if (is_string) {
        param.strings.push_back(std::move(lexer_.token().text));
        lexer_.advance();
        return true;
    }
    bool inexact = false, overflow = false;
    Lexer::IntTrouble trouble;
    for (; token().kind == TokenKind::Number; lexer_.advance()) {
        if (param.decl.type == ParamType::Integer) {
            param.ints.push_back(to_int(token().number, inexact, overflow));
            (overflow ? trouble.overflow : trouble.inexact) =
                inexact || overflow ? token().pos : base::SourcePos{};
        } else {
            param.floats.push_back(narrow(token().number));
        }
    }
    note_int_trouble(trouble, param.name);
    return !overflow;
}

// Whole items only. Colors become RGB. Outside primitives a parameter has one item.
bool Parser::check_value(Param& param, const RequestRow& table_row) {
    const bool is_color = param.decl.type == ParamType::Color;
    const std::size_t numbers =
        is_color ? colors_.num_samples() : static_cast<std::size_t>(components(param.decl.type));
    const std::size_t per_item = numbers * static_cast<std::size_t>(param.decl.array_length);
    const std::size_t given = param.strings.size() + param.ints.size() + param.floats.size();
    const bool is_list = table_row.params != ParamUse::Primvars;
    if (is_list && !param.decl.is_array && given > 1 &&
        (param.guessed || param.decl.type == ParamType::String)) {
        param.decl.is_array = true;
        param.decl.array_length = static_cast<int>(std::min<std::size_t>(given, 1u << 30));
        return true;
    }
    if (given % per_item != 0 || (is_list && given == 0)) {
        error(base::Severity::Error, is_color ? base::Code::Consistency : base::Code::BadToken,
              param.pos,
              std::string(request_name_) + ": parameter " + quote(param.name) + " (" +
                  declaration_text(param.decl) + "): " + std::to_string(given) +
                  " values are not a multiple of " + std::to_string(per_item) +
                  "; parameter dropped");
        return false;
    }
    if (is_color && !colors_.is_rgb()) {
        param.floats = colors_.to_rgb(param.floats);
    }
    if (is_list && given > per_item) {
        error(base::Severity::Warning, base::Code::Consistency, param.pos,
              std::string(request_name_) + ": parameter " + quote(param.name) + " (" +
                  declaration_text(param.decl) + "): " + std::to_string(given) + " values where " +
                  std::to_string(per_item) + " were expected; the surplus is ignored");
        const std::size_t keep =
            static_cast<std::size_t>(components(param.decl.type) * param.decl.array_length);
        param.floats.resize(std::min(param.floats.size(), keep));
        param.ints.resize(std::min(param.ints.size(), keep));
        param.strings.resize(std::min(param.strings.size(), keep));
    }
    return true;
}

void Parser::skip_value() {
    if (token().kind == TokenKind::ArrayBegin) {
        lexer_.advance();
        skip_array();
    } else if (token().kind == TokenKind::String) {
        lexer_.advance();
    } else {
        while (token().kind == TokenKind::Number) {
            lexer_.advance();
        }
    }
}

// To behind the bracket that closes the array the current token lies in, or to a name, whichever
// comes first.
void Parser::skip_array() {
    while (token().kind != TokenKind::ArrayEnd && token().kind != TokenKind::Name &&
           token().kind != TokenKind::End) {
        lexer_.advance();
    }
    if (token().kind == TokenKind::ArrayEnd) {
        lexer_.advance();
    }
}

} // namespace rib
