// SPDX-License-Identifier: Apache-2.0
// Token handling, recovery and the productions for definitions. The grammar's notes in sl.md 1.3
// are cited where they decide something.
#include "slc/parser.h"

#include <algorithm>
#include <cmath>

namespace slc {

using ast::Expr;
using ast::ExprKind;
using ast::Function;
using ast::Symbol;
using ast::SymbolKind;
using ast::Variable;

namespace {

struct ShaderWord {
    std::string_view text;
    sl_shader_type type;
};
constexpr ShaderWord shader_words[] = {
    {"surface", SL_SHADER_surface}, {"displacement", SL_SHADER_displacement},
    {"light", SL_SHADER_light},     {"volume", SL_SHADER_volume},
    {"imager", SL_SHADER_imager},   {"transformation", SL_SHADER_transformation}};

const ShaderWord* shader_word(const Token& token) {
    const auto* const it =
        std::find_if(std::begin(shader_words), std::end(shader_words), [&](const ShaderWord& w) {
            return token.kind == Tok::Name && w.text == token.text;
        });
    return it == std::end(shader_words) ? nullptr : it;
}

} // namespace

std::optional<Type> type_of_word(Tok kind) {
    switch (kind) {
    case Tok::WordFloat:
        return Type::Float;
    case Tok::WordColor:
        return Type::Color;
    case Tok::WordPoint:
        return Type::Point;
    case Tok::WordVector:
        return Type::Vector;
    case Tok::WordNormal:
        return Type::Normal;
    case Tok::WordMatrix:
        return Type::Matrix;
    case Tok::WordString:
        return Type::String;
    case Tok::WordVoid:
        return Type::Void;
    default:
        return std::nullopt;
    }
}

namespace {

// Nothing that a type can stand before: the word before it is an operand.
bool follows_operand(Tok kind) {
    switch (kind) {
    case Tok::Assign:
    case Tok::PlusAssign:
    case Tok::MinusAssign:
    case Tok::StarAssign:
    case Tok::SlashAssign:
    case Tok::RightParen:
    case Tok::RightBracket:
    case Tok::Comma:
    case Tok::Semicolon:
    case Tok::Dot:
    case Tok::Star:
    case Tok::Slash:
    case Tok::Percent:
    case Tok::Caret:
    case Tok::Equal:
    case Tok::NotEqual:
    case Tok::Less:
    case Tok::LessEqual:
    case Tok::Greater:
    case Tok::GreaterEqual:
    case Tok::And:
    case Tok::Or:
    case Tok::Question:
    case Tok::Colon:
        return true;
    default:
        return false;
    }
}

bool is_word_since_3_2(Tok kind) {
    return kind == Tok::WordVector || kind == Tok::WordNormal || kind == Tok::WordMatrix;
}

} // namespace

bool Parser::is_name(std::size_t ahead) const {
    const Token& token = peek(ahead);
    if (token.kind == Tok::Name || !is_word_since_3_2(token.kind)) {
        return token.kind == Tok::Name;
    }
    const Tok next = peek(ahead + 1).kind;
    const bool unclear = next == Tok::Plus || next == Tok::Minus || next == Tok::LeftBracket;
    return follows_operand(next) || (unclear && type_words_as_names_.contains(token.text));
}

std::optional<Type> Parser::type_at(std::size_t ahead) const {
    return is_name(ahead) ? std::nullopt : type_of_word(peek(ahead).kind);
}

Parser::Nest::Nest(Parser& parser) : parser_(parser) {
    if (++parser_.depth_ > max_nesting) {
        const Token at = parser_.peek();
        --parser_.depth_; // the destructor will not run
        if (!parser_.stopped_) {
            parser_.messages_.error(at.loc,
                                    "nested more than " + std::to_string(max_nesting) +
                                        " deep, the rest is not read",
                                    base::Code::Limit);
        }
        parser_.stop();
        throw SyntaxError{};
    }
}

const Token& Parser::peek(std::size_t ahead) const {
    return tokens_[std::min(pos_ + ahead, tokens_.size() - 1)];
}

const Token& Parser::take() {
    const Token& token = peek();
    pos_ = std::min(pos_ + 1, tokens_.size() - 1);
    return token;
}

bool Parser::accept(Tok kind) {
    if (!is(kind)) {
        return false;
    }
    take();
    return true;
}

const Token& Parser::expect(Tok kind, std::string_view where) {
    if (!is(kind)) {
        fail(peek(), "expected " + token_name(kind) + " " + std::string(where));
    }
    return take();
}

void Parser::fail(const Token& at, std::string_view text) {
    if (!stopped_) {
        std::string found = token_name(at.kind);
        if (at.kind == Tok::Name || at.kind == Tok::Number) {
            found = quoted(at.text);
        }
        messages_.error(at.loc, std::string(text) + ", found " + found);
    }
    throw SyntaxError{};
}

// The rest of the file is not looked at any more.
void Parser::stop() {
    stopped_ = true;
    pos_ = tokens_.size() - 1;
}

std::size_t Parser::matching_paren(std::size_t open) const {
    int depth = 0;
    for (std::size_t i = open; i < tokens_.size(); ++i) {
        const Tok kind = tokens_[i].kind;
        depth += kind == Tok::LeftParen ? 1 : kind == Tok::RightParen ? -1 : 0;
        if (depth == 0 || kind == Tok::LeftBrace) {
            return depth == 0 ? i : tokens_.size() - 1;
        }
    }
    return tokens_.size() - 1;
}

// After an error: past the next ';', or to a brace; always forward.
void Parser::skip_statement(std::size_t start) {
    if (pos_ == start) {
        take();
    }
    while (!is(Tok::End) && !is(Tok::RightBrace) && !is(Tok::LeftBrace)) {
        if (take().kind == Tok::Semicolon) {
            return;
        }
    }
}

// After an error outside a body: to the next shader, or past the next block.
void Parser::skip_definition(std::size_t start) {
    if (pos_ == start) {
        take();
    }
    int depth = 0;
    while (!is(Tok::End)) {
        if (depth == 0 && at_shader()) {
            return;
        }
        const Tok kind = take().kind;
        depth += kind == Tok::LeftBrace ? 1 : kind == Tok::RightBrace ? -1 : 0;
        if (kind == Tok::RightBrace && depth <= 0) {
            return;
        }
    }
}

// file = { definition }
std::unique_ptr<ast::File> Parser::run() {
    while (!is(Tok::End) && !messages_.too_many()) {
        const std::size_t start = pos_;
        try {
            definition();
        } catch (const SyntaxError&) {
            skip_definition(start);
        }
    }
    return std::move(file_);
}

// definition = shader-def | function-def | ";"
void Parser::definition() {
    if (accept(Tok::Semicolon)) {
        return;
    }
    type_words_as_names_.clear();
    if (is(Tok::RightBrace)) {
        messages_.warning(take().loc, "this '}' closes nothing; it is left out");
        return;
    }
    if (at_shader()) {
        shader_def();
        return;
    }
    later_language();
    foreign_type();
    ast::Definition d;
    d.function = function_def();
    if (d.function != nullptr) {
        file_->definitions.push_back(d);
    }
}

// Classes and structures came in 2007; one message for the file, since nothing else would fit.
void Parser::later_language() {
    const bool starts = is(Tok::Name) && is(Tok::Name, 1) &&
                        (peek().text == "class" || peek().text == "struct" ||
                         peek().text == "plugin" || peek().text == "public");
    if (!starts) {
        return;
    }
    messages_.error(peek().loc, quoted(peek().text) +
                                    " belongs to version 2 of the Shading Language; this compiler "
                                    "knows shaders and functions, the rest is not read");
    stop();
    throw SyntaxError{};
}

// Shader types are reserved only here (note 10); any word may name a shader.
bool Parser::at_shader() const {
    return shader_word(peek()) != nullptr && is(Tok::LeftParen, 2) &&
           (is(Tok::Name, 1) || type_of_word(peek(1).kind));
}

// shader-def = shader-type IDENT "(" [ shader-formals ] ")" "{" { statement } "}"
void Parser::shader_def() {
    ast::Shader& shader = file_->shaders.emplace_back();
    shader.type = shader_word(take())->type;
    shader.loc = peek().loc;
    shader.name = take().text;
    take(); // "("
    shader_formals(shader);
    expect(Tok::RightParen, "after the parameters of a shader");
    expect(Tok::LeftBrace, "before the body of a shader");
    statements(shader.body);
    expect(Tok::RightBrace, "at the end of shader " + quoted(shader.name));
    ast::Definition d;
    d.shader = &shader;
    file_->definitions.push_back(d);
}

// function-def = [ [ detail ] type ] IDENT "(" [ fn-formals ] ")" "{" { statement } "}" [ ";" ]
// A prototype says nothing that the definition does not; nullptr is returned for it.
Function* Parser::function_def() {
    const Nest nest(*this);
    const TypeSpec spec = typespec(false);
    Function& function = file_->functions.emplace_back();
    function.result = spec.type;
    function.loc = peek().loc;
    function.name =
        expect(Tok::Name, spec.type ? "of a function" : "or a type, to begin a shader or function")
            .text;
    expect(Tok::LeftParen, "after the name of a function");
    fn_formals(function);
    expect(Tok::RightParen, "after the formal parameters");
    if (accept(Tok::Semicolon)) {
        return nullptr;
    }
    expect(Tok::LeftBrace, "before the body of a function");
    statements(function.body);
    expect(Tok::RightBrace, "at the end of function " + quoted(function.name));
    accept(Tok::Semicolon);
    return &function;
}

// typespec = [ detail ] type; with the optional words on either side of the type, and the length
// of an array after it (type[N] name)
Parser::TypeSpec Parser::typespec(bool output_allowed) {
    TypeSpec spec;
    spec.loc = peek().loc;
    qualifiers(spec, output_allowed);
    spec.type = type_at();
    if (spec.type) {
        take();
        qualifiers(spec, output_allowed);
        if (accept(Tok::LeftBracket)) {
            spec.array_length = array_length(true);
        }
    }
    return spec;
}

void Parser::qualifiers(TypeSpec& spec, bool output_allowed) {
    for (;;) {
        if (output_allowed && accept(Tok::WordOutput)) {
            spec.is_output = true;
        } else if (is(Tok::WordUniform) || is(Tok::WordVarying)) {
            spec.detail = take().kind == Tok::WordUniform ? Detail::Uniform : Detail::Varying;
        } else {
            return;
        }
    }
}

bool Parser::at_formal_group() const {
    return is(Tok::WordOutput) || is(Tok::WordUniform) || is(Tok::WordVarying) || type_at();
}

// shader-formals = { ";" } shader-formal { ";" { ";" } shader-formal } { ";" }
// shader-formal  = [ "output" ] typespec formal-init { "," formal-init }
void Parser::shader_formals(ast::Shader& shader) {
    while (!is(Tok::RightParen)) {
        if (accept(Tok::Semicolon)) {
            continue;
        }
        const TypeSpec spec = typespec(true);
        if (!spec.type) {
            fail(peek(), "expected the type of a parameter or ')'");
        }
        do {
            Variable variable;
            variable.symbol = new_symbol(spec, SymbolKind::Param, true);
            if (is(Tok::Assign)) {
                initialiser(variable);
            } else {
                messages_.warning(variable.symbol->loc,
                                  "parameter " + quoted(variable.symbol->name) +
                                      " has no default value; " +
                                      (spec.type == Type::String ? "it is \"\"" : "it is 0"));
                variable.init = default_value(*variable.symbol);
            }
            if (shader.params.size() == max_params) {
                messages_.error(variable.symbol->loc,
                                "more than " + std::to_string(max_params) + " parameters",
                                base::Code::Limit);
                throw SyntaxError{};
            }
            shader.params.push_back(std::move(variable));
        } while (accept(Tok::Comma) && !at_formal_group() && !is(Tok::RightParen) &&
                 !is(Tok::Semicolon));
        if (!is(Tok::RightParen) && !is(Tok::Semicolon) && !at_formal_group()) {
            fail(peek(), "expected ';' or ')' after a parameter");
        }
    }
}

// fn-formals = { ";" } fn-formal { ( ";" | "," ) fn-formal } { ";" }
// fn-formal  = [ "output" ] typespec fn-name { "," fn-name }
void Parser::fn_formals(Function& function) {
    if (is(Tok::WordVoid) && is(Tok::RightParen, 1)) { // f(void), as in C
        take();
    }
    while (!is(Tok::RightParen)) {
        if (accept(Tok::Semicolon)) {
            continue;
        }
        const TypeSpec spec = typespec(true);
        if (!spec.type) {
            fail(peek(), "expected the type of a formal parameter or ')'");
        }
        do {
            function.formals.push_back(new_symbol(spec, SymbolKind::Formal, true));
        } while (accept(Tok::Comma) && !at_formal_group() && !is(Tok::RightParen) &&
                 !is(Tok::Semicolon));
        if (!is(Tok::RightParen) && !is(Tok::Semicolon) && !at_formal_group()) {
            fail(peek(), "expected ';' or ')' after a formal parameter");
        }
    }
}

Expr* Parser::default_value(const Symbol& symbol) {
    return new_expr(symbol.type == Type::String ? ExprKind::Text : ExprKind::Number, symbol.loc);
}

// fn-name = IDENT [ "[" [ NUMBER ] "]" ]
Symbol* Parser::new_symbol(const TypeSpec& spec, SymbolKind kind, bool unsized_allowed) {
    const bool is_old_name = is_word_since_3_2(peek().kind);
    const Token& name = is_old_name ? take() : expect(Tok::Name, "of a variable");
    if (is_old_name) {
        type_words_as_names_.insert(name.text);
    }
    Symbol& symbol = file_->symbols.emplace_back();
    symbol.name = name.text;
    symbol.kind = kind;
    symbol.type = spec.type.value_or(Type::Void);
    symbol.detail = spec.detail;
    symbol.is_output = spec.is_output;
    symbol.loc = name.loc;
    symbol.array_length = spec.array_length;
    if (spec.type == Type::Void) {
        messages_.error(spec.loc, "a variable cannot be void");
        symbol.type = Type::Float;
    }
    if (accept(Tok::LeftBracket)) {
        symbol.array_length = array_length(unsized_allowed);
    }
    return &symbol;
}

// [ NUMBER ] "]"; macros leave constant expressions here, so these are accepted.
int Parser::array_length(bool unsized_allowed) {
    if (is(Tok::RightBracket)) {
        if (!unsized_allowed) {
            fail(peek(), "expected the length of the array");
        }
        take();
        return ast::unsized_array;
    }
    const Token& at = peek();
    const std::optional<double> value = constant_value(*expr());
    expect(Tok::RightBracket, "after the length of an array");
    if (!value || *value < 1 || *value != std::floor(*value) || *value > max_array_length) {
        messages_.error(at.loc, "the length of an array is a whole number from 1 to " +
                                    std::to_string(max_array_length) + "; 1 is used");
        return 1;
    }
    return static_cast<int>(*value);
}

// formal-init and var-init from the "=": "=" ( expr | array-init )
void Parser::initialiser(Variable& variable) {
    expect(Tok::Assign, "before the value");
    if (is(Tok::LeftBrace)) {
        array_init(variable);
        return;
    }
    variable.init = expr();
    const bool is_list = variable.symbol->array_length != 0 &&
                         variable.init->kind == ExprKind::Tuple &&
                         !is_triple(variable.symbol->type);
    if (is_list) { // float a[3] = (1, 2, 3)
        variable.has_elements = true;
        variable.elements = variable.init->args;
        count_elements(variable, variable.init->loc);
        variable.init = nullptr;
    }
}

// array-init = "{" expr { "," expr } [ "," ] "}"
void Parser::array_init(Variable& variable) {
    const Token open = take();
    Symbol& symbol = *variable.symbol;
    variable.has_elements = true;
    while (!is(Tok::RightBrace)) {
        if (variable.elements.size() >= max_array_length) {
            fail(peek(), "too many array elements");
        }
        variable.elements.push_back(expr());
        if (!accept(Tok::Comma)) {
            break;
        }
    }
    expect(Tok::RightBrace, "after the elements of an array");
    if (symbol.array_length == 0) {
        list_for_value(variable, open.loc);
    } else {
        count_elements(variable, open.loc);
    }
}

void Parser::count_elements(Variable& variable, Loc open) {
    Symbol& symbol = *variable.symbol;
    const int given = static_cast<int>(variable.elements.size());
    const std::string has = "array " + quoted(symbol.name) + " has " +
                            std::to_string(symbol.array_length) + " elements, but ";
    if (given == 0) {
        messages_.error(open, "an array has at least one element");
    } else if (symbol.array_length == ast::unsized_array) {
        symbol.array_length = given;
    } else if (symbol.array_length < given) {
        messages_.warning(open, has + std::to_string(given) + " are given; the last are left out");
        variable.elements.resize(static_cast<std::size_t>(symbol.array_length));
    } else if (symbol.array_length > given) {
        messages_.warning(open, has + "only " + std::to_string(given) + " given; the rest is 0");
    }
}

// color c = {1, 0, 0}: the list stands for a value in parentheses.
void Parser::list_for_value(Variable& variable, Loc open) {
    const Symbol& symbol = *variable.symbol;
    const std::size_t given = variable.elements.size();
    const bool is_tuple =
        (is_triple(symbol.type) && given == 3) || (symbol.type == Type::Matrix && given == 16);
    if (!is_tuple && given != 1) {
        messages_.error(open,
                        quoted(symbol.name) + " is not an array, but is given a list of values");
        return;
    }
    messages_.warning(open, quoted(symbol.name) +
                                " is not an array; the list is taken as the value in parentheses");
    variable.init = variable.elements[0];
    if (is_tuple) {
        variable.init = new_expr(ExprKind::Tuple, open);
        variable.init->args = variable.elements;
    }
    variable.elements.clear();
    variable.has_elements = false;
}

std::unique_ptr<ast::File> parse(const std::vector<Token>& tokens, Messages& messages) {
    return Parser(tokens, messages).run();
}

} // namespace slc
