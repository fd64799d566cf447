// SPDX-License-Identifier: Apache-2.0
// The parser's third part: what only ParseMode::Keep does. Requests are kept as they are written,
// so values go by what they look like, not by what a declaration or the table says of them.
#include "ribtools/number.h"
#include "ribtools/rib_parse.h"
#include "ribtools/spelling.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rib {

namespace {

bool is_int(double x) {
    return x >= std::numeric_limits<std::int32_t>::min() &&
           x <= std::numeric_limits<std::int32_t>::max() && x == std::trunc(x) &&
           !(x == 0 && std::signbit(x));
}

// Integers where all numbers are: then nothing is lost, whatever a declaration elsewhere says.
void store_numbers(Param& param, std::vector<float> floats, const std::vector<double>& doubles) {
    if (!std::all_of(doubles.begin(), doubles.end(), is_int)) {
        param.decl.type = ParamType::Float;
        param.floats = std::move(floats);
        return;
    }
    param.decl.type = ParamType::Integer;
    param.ints.reserve(doubles.size());
    for (const double x : doubles) {
        param.ints.push_back(static_cast<std::int32_t>(x));
    }
}

} // namespace

// A request that the table does not know, or knows as one to be skipped: its values by their looks.
Parser::Outcome Parser::keep_loose(Request& request) {
    request.name = token().text;
    request_name_ = request.name;
    arg_name_ = {};
    if (request.id == RequestId::Unknown) {
        diag_.report_once("kept:" + request.name, base::Severity::Warning, base::Code::BadToken,
                          request.pos,
                          "unknown request '" + printable(request.name) + "': kept as it stands" +
                              hint_for(request.name));
    }
    lexer_.advance();
    while (token().kind != TokenKind::Name && token().kind != TokenKind::End) {
        if (loose_value(request.values.emplace_back()) == Outcome::Skip) {
            return Outcome::Skip;
        }
    }
    return Outcome::Ok;
}

Parser::Outcome Parser::loose_value(LooseValue& value) {
    switch (token().kind) {
    case TokenKind::Number:
        value.numbers = {token().number};
        break;
    case TokenKind::String:
        value.strings.push_back(std::move(lexer_.token().text));
        break;
    case TokenKind::ArrayBegin:
        value.is_array = true;
        if (!(lexer_.array_holds_strings() ? lexer_.read_strings(value.strings)
                                           : lexer_.read_doubles(value.numbers))) {
            return expected("an array of numbers or of strings");
        }
        break;
    default:
        return expected("a value");
    }
    lexer_.advance();
    return Outcome::Ok;
}

// All numbers there are: how many a color has may be said in an archive nobody opens now.
Parser::Outcome Parser::color_samples(Arg& arg) {
    arg.given = true;
    if (token().kind == TokenKind::ArrayBegin) {
        if (!lexer_.read_doubles(arg.numbers)) {
            return expected("numbers");
        }
        lexer_.advance();
        return Outcome::Ok;
    }
    for (; token().kind == TokenKind::Number; lexer_.advance()) {
        arg.numbers.push_back(token().number);
    }
    return arg.numbers.empty() ? expected("a color") : Outcome::Ok;
}

// False: reported, there is none.
bool Parser::keep_value(Param& param) {
    const bool is_float = !param.guessed && param.decl.type != ParamType::Integer &&
                          param.decl.type != ParamType::String;
    std::vector<float> floats;
    std::vector<double> doubles;
    if (token().kind == TokenKind::String) {
        param.strings.push_back(std::move(lexer_.token().text));
        lexer_.advance();
    } else if (token().kind == TokenKind::Number) {
        for (; token().kind == TokenKind::Number; lexer_.advance()) {
            floats.push_back(narrow(token().number));
            doubles.push_back(token().number);
        }
    } else if (token().kind != TokenKind::ArrayBegin) {
        missing_value(param);
        return false;
    } else {
        const bool strings = lexer_.array_holds_strings();
        const bool good = strings    ? lexer_.read_strings(param.strings)
                          : is_float ? lexer_.read_floats(floats)
                                     : lexer_.read_both(floats, doubles);
        if (!good) {
            arg_name_ = param.name;
            (void)expected(strings ? "strings" : "numbers");
            skip_array();
            return false;
        }
        lexer_.advance();
    }
    if (!param.strings.empty()) {
        param.decl.type = ParamType::String;
    } else if (is_float) {
        param.floats = std::move(floats);
    } else {
        store_numbers(param, std::move(floats), doubles);
    }
    return true;
}

} // namespace rib
