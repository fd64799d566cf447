// SPDX-License-Identifier: Apache-2.0
// Productions for expressions, sl.md 1.3 and 1.4. Binary operators go by a table of ranks instead
// of one function per rank: parentheses then cost five calls per level, not fifteen.
#include "slc/parser.h"

#include <numbers>

namespace slc {

using ast::Expr;
using ast::ExprKind;

namespace {

struct BinaryRank {
    Tok token;
    Op op;
    int rank; // higher binds tighter
};

// Cross is below * and /, dot above (sl.md 1.4).
constexpr BinaryRank ranks[] = {
    {Tok::Or, Op::Or, 1},       {Tok::And, Op::And, 2},         {Tok::Equal, Op::Eq, 3},
    {Tok::NotEqual, Op::Ne, 3}, {Tok::Less, Op::Lt, 4},         {Tok::LessEqual, Op::Le, 4},
    {Tok::Greater, Op::Gt, 4},  {Tok::GreaterEqual, Op::Ge, 4}, {Tok::Plus, Op::Add, 5},
    {Tok::Minus, Op::Sub, 5},   {Tok::Caret, Op::Cross, 6},     {Tok::Star, Op::Mul, 7},
    {Tok::Slash, Op::Div, 7},   {Tok::Percent, Op::Div, 7},     {Tok::Dot, Op::Dot, 8}};

const BinaryRank* binary_rank(Tok kind) {
    for (const BinaryRank& r : ranks) {
        if (r.token == kind) {
            return &r;
        }
    }
    return nullptr;
}

std::optional<Op> assignment_op(Tok kind) {
    switch (kind) {
    case Tok::Assign:
        return Op::Copy;
    case Tok::PlusAssign:
        return Op::Add;
    case Tok::MinusAssign:
        return Op::Sub;
    case Tok::StarAssign:
        return Op::Mul;
    case Tok::SlashAssign:
        return Op::Div;
    default:
        return std::nullopt;
    }
}

} // namespace

Expr* Parser::new_expr(ExprKind kind, Loc loc) {
    Expr& e = file_->exprs.emplace_back();
    e.kind = kind;
    e.loc = loc;
    return &e;
}

// expr   = assign | ternary
// assign = lvalue ( "=" | "+=" | "-=" | "*=" | "/=" ) expr     (right associative)
Expr* Parser::expr() {
    const Nest nest(*this);
    Expr* left = ternary();
    const std::optional<Op> op = assignment_op(peek().kind);
    if (!op) {
        return left;
    }
    if (left->kind != ExprKind::Name && left->kind != ExprKind::Index) {
        messages_.error(peek().loc, "only a variable or an array element can be assigned");
        throw SyntaxError{};
    }
    Expr* e = new_expr(ExprKind::Assign, take().loc);
    e->op = *op;
    e->args = {left, expr()};
    return e;
}

// ternary = or-expr [ "?" expr ":" ternary ]
Expr* Parser::ternary() {
    const Nest nest(*this);
    Expr* condition = binary(1);
    if (!is(Tok::Question)) {
        return condition;
    }
    Expr* e = new_expr(ExprKind::Ternary, take().loc);
    e->args.push_back(condition);
    e->args.push_back(expr());
    expect(Tok::Colon, "after the first value of '?'");
    e->args.push_back(ternary());
    return e;
}

// or-expr = and-expr { "||" and-expr } ... dot-expr = unary { "." unary }: all ranks from `lowest`
// up
Expr* Parser::binary(int lowest) {
    Expr* left = unary();
    int chain = 0;
    for (const BinaryRank* r = binary_rank(peek().kind); r != nullptr && r->rank >= lowest;
         r = binary_rank(peek().kind)) {
        if (++chain > max_chain) {
            messages_.error(peek().loc,
                            "more than " + std::to_string(max_chain) +
                                " operators in one expression",
                            base::Code::Limit);
            throw SyntaxError{};
        }
        const bool is_mod = r->token == Tok::Percent;
        Expr* e = new_expr(is_mod ? ExprKind::Call : ExprKind::Binary, take().loc);
        if (is_mod) {
            messages_.warning(e->loc, "there is no '%' in the Shading Language; mod() is taken");
            e->text = "mod";
        }
        e->op = r->op;
        Expr* right = binary(r->rank + 1);
        e->args = {left, right};
        left = e;
    }
    return left;
}

// unary = ( "-" | "!" | "+" ) unary | cast | primary
Expr* Parser::unary() {
    const Nest nest(*this);
    if (type_at()) {
        return cast();
    }
    if (is(Tok::Minus) || is(Tok::Not)) {
        const Token& sign = take();
        Expr* e = new_expr(ExprKind::Unary, sign.loc);
        e->op = sign.kind == Tok::Minus ? Op::Neg : Op::Not;
        e->args = {unary()};
        return e;
    }
    if (accept(Tok::Plus)) {
        return unary();
    }
    return primary();
}

// cast = type [ STRING ] unary; the string after `string` is the operand, not a space
Expr* Parser::cast() {
    const Token& word = take();
    Expr* e = new_expr(ExprKind::Cast, word.loc);
    e->type = *type_of_word(word.kind);
    if (e->type == Type::Void) {
        fail(word, "a value cannot be void");
    }
    if (is(Tok::Text) && e->type != Type::String) {
        if (e->type == Type::Float) {
            fail(peek(), "a float has no coordinate system");
        }
        e->text = take().text;
    }
    e->args = {unary()};
    return e;
}

// "(" type ")" before an operand, as C writes a cast
bool Parser::at_c_cast() const {
    const bool is_type = is(Tok::LeftParen) && type_of_word(peek(1).kind) &&
                         !type_words_as_names_.contains(peek(1).text);
    return is_type && is(Tok::RightParen, 2) &&
           (is(Tok::Name, 3) || is(Tok::Number, 3) || is(Tok::LeftParen, 3));
}

Expr* Parser::c_cast() {
    const Nest nest(*this);
    const Token& open = take();
    const Token& word = take();
    take(); // ")"
    messages_.warning(open.loc, "a cast is written without parentheses: " + std::string(word.text) +
                                    " value");
    Expr* e = new_expr(ExprKind::Cast, word.loc);
    e->type = *type_of_word(word.kind);
    if (e->type == Type::Void) {
        fail(word, "a value cannot be void");
    }
    e->args = {unary()};
    return e;
}

// primary = NUMBER | STRING { STRING } | IDENT [ "[" expr "]" ] | call | "(" expr ")" | triple |
// sixteen
Expr* Parser::primary() {
    switch (peek().kind) {
    case Tok::Number: {
        const Token& token = take();
        Expr* e = new_expr(ExprKind::Number, token.loc);
        e->number = token.number;
        return e;
    }
    case Tok::Text:
        return string_literal();
    case Tok::LeftParen:
        return at_c_cast() ? c_cast() : parenthesised();
    default:
        if (is_name()) {
            return name_or_call();
        }
        fail(peek(), "expected an expression");
    }
}

// STRING { STRING }: adjacent literals are one
Expr* Parser::string_literal() {
    Expr* e = new_expr(ExprKind::Text, peek().loc);
    while (is(Tok::Text)) {
        e->text += take().text;
    }
    return e;
}

// "(" expr ")" | triple = "(" expr "," expr "," expr ")" | sixteen = "(" expr ( "," expr ){15} ")"
Expr* Parser::parenthesised() {
    const Token& open = take();
    Expr* first = expr();
    if (accept(Tok::RightParen)) {
        return first;
    }
    Expr* e = new_expr(ExprKind::Tuple, open.loc);
    e->args.push_back(first);
    while (accept(Tok::Comma)) {
        e->args.push_back(expr());
    }
    expect(Tok::RightParen, "after the values in parentheses");
    if (e->args.size() != 3 && e->args.size() != 16) {
        messages_.error(open.loc, "values in parentheses are 1, 3 or 16, not " +
                                      std::to_string(e->args.size()));
        throw SyntaxError{};
    }
    return e;
}

// IDENT [ "[" expr "]" ] | call; a second bracket picks a component, or a texture's channel
Expr* Parser::name_or_call() {
    const Token& name = take();
    if (is(Tok::LeftParen)) {
        return call(name);
    }
    Expr* e = new_expr(ExprKind::Name, name.loc);
    e->text = name.text;
    if (accept(Tok::LeftBracket)) {
        e->kind = ExprKind::Index;
        e->args.push_back(expr());
        expect(Tok::RightBracket, "after an index");
        if (accept(Tok::LeftBracket)) {
            e->args.push_back(expr());
            expect(Tok::RightBracket, "after an index");
        }
    }
    return e;
}

// call = IDENT "(" [ arg { "," arg } ] ")"
// arg  = expr [ "[" expr "]" ]
Expr* Parser::call(const Token& name) {
    Expr* e = new_expr(ExprKind::Call, name.loc);
    e->text = name.text;
    take(); // "("
    while (!is(Tok::RightParen)) {
        Expr* arg = expr();
        if (accept(Tok::LeftBracket)) {
            arg->channel = expr();
            expect(Tok::RightBracket, "after a texture channel");
        }
        e->args.push_back(arg);
        if (!accept(Tok::Comma)) {
            break;
        }
    }
    expect(Tok::RightParen, "after the arguments of " + quoted(name.text));
    if (e->args.size() > max_arguments) {
        messages_.error(name.loc,
                        "more than " + std::to_string(max_arguments) + " arguments of " +
                            quoted(name.text),
                        base::Code::Limit);
        throw SyntaxError{};
    }
    return e;
}

// Value of an expression of numbers and PI, for array lengths and loop counts.
std::optional<double> Parser::constant_value(const Expr& e) const {
    if (e.kind == ExprKind::Number) {
        return e.number;
    }
    if (e.kind == ExprKind::Name && e.text == "PI") {
        return std::numbers::pi;
    }
    if (e.kind == ExprKind::Unary && e.op == Op::Neg) {
        const auto a = constant_value(*e.args[0]);
        return a ? std::optional(-*a) : std::nullopt;
    }
    if (e.kind != ExprKind::Binary) {
        return std::nullopt;
    }
    const auto a = constant_value(*e.args[0]);
    const auto b = constant_value(*e.args[1]);
    if (!a || !b) {
        return std::nullopt;
    }
    switch (e.op) {
    case Op::Add:
        return *a + *b;
    case Op::Sub:
        return *a - *b;
    case Op::Mul:
        return *a * *b;
    case Op::Div:
        return *b != 0 ? std::optional(*a / *b) : std::nullopt;
    default:
        return std::nullopt;
    }
}

} // namespace slc
