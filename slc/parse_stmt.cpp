// SPDX-License-Identifier: Apache-2.0
// Productions for statements, sl.md 1.3.
#include "slc/parser.h"

#include <cmath>

namespace slc {

using ast::Expr;
using ast::ExprKind;
using ast::StmtKind;

ast::Stmt* Parser::new_stmt(StmtKind kind, Loc loc) {
    ast::Stmt& s = file_->stmts.emplace_back();
    s.kind = kind;
    s.loc = loc;
    return &s;
}

// { statement }, up to the closing brace or the end of the file
void Parser::statements(std::vector<ast::Stmt*>& into) {
    while (!is(Tok::RightBrace) && !is(Tok::End) && !messages_.too_many()) {
        const std::size_t start = pos_;
        try {
            into.push_back(statement());
        } catch (const SyntaxError&) {
            skip_statement(start);
        }
    }
}

ast::Stmt* Parser::statement() {
    const Nest nest(*this);
    return statement_at();
}

// statement = ";" | "{" { statement } "}" | var-decl ";" | function-def | expr ";" | "if" ... (one
// branch each)
ast::Stmt* Parser::statement_at() {
    const Loc loc = peek().loc;
    switch (peek().kind) {
    case Tok::Semicolon:
        take();
        return new_stmt(StmtKind::Empty, loc);
    case Tok::LeftBrace: {
        take();
        ast::Stmt* block = new_stmt(StmtKind::Block, loc);
        statements(block->body);
        expect(Tok::RightBrace, "at the end of a block");
        return block;
    }
    case Tok::WordIf:
        return if_statement();
    case Tok::WordWhile:
        return while_statement();
    case Tok::WordFor:
        return for_statement();
    case Tok::WordBreak:
    case Tok::WordContinue:
        return jump();
    case Tok::WordReturn:
        return return_statement();
    case Tok::WordSolar:
        return light_statement(StmtKind::Solar, 0, 2);
    case Tok::WordIlluminate:
        return light_statement(StmtKind::Illuminate, 1, 3);
    case Tok::WordIlluminance:
        return light_statement(StmtKind::Illuminance, 1, 64);
    case Tok::WordExtern:
        return declaration();
    case Tok::WordUniform:
    case Tok::WordVarying:
        return typed_statement();
    case Tok::WordElse:
        fail(peek(), "'else' without 'if'");
    default:
        break;
    }
    if (type_at()) {
        return typed_statement();
    }
    if (is(Tok::Name) && peek().text == "gather" && is(Tok::LeftParen, 1)) {
        return gather_statement();
    }
    if (is(Tok::Name) && peek().text == "do" && is(Tok::LeftBrace, 1)) {
        return do_statement();
    }
    foreign_type();
    return at_function_def() ? nested_function() : expression_statement();
}

// After a type: IDENT "(" ... ")" "{" is a function, STRING or "(" a cast, IDENT a declaration
// (note 10).
ast::Stmt* Parser::typed_statement() {
    if (at_function_def()) {
        return nested_function();
    }
    const bool has_detail = is(Tok::WordUniform) || is(Tok::WordVarying);
    const std::size_t after_type = has_detail ? 2 : 1;
    const bool is_cast =
        !has_detail && (is(Tok::Text, after_type) || is(Tok::LeftParen, after_type) ||
                        (is(Tok::Name, after_type) && is(Tok::LeftParen, after_type + 1)));
    return is_cast ? expression_statement() : declaration();
}

// [ [ detail ] type ] IDENT "(" ... ")" "{"; a function without type looks like a call until the
// brace
bool Parser::at_function_def() const {
    std::size_t i = 0;
    i += is(Tok::WordUniform, i) || is(Tok::WordVarying, i) ? 1 : 0;
    i += type_at(i) ? 1 : 0;
    if (!is(Tok::Name, i) || !is(Tok::LeftParen, i + 1)) {
        return false;
    }
    const std::size_t close = matching_paren(pos_ + i + 1);
    return close + 1 < tokens_.size() && tokens_[close + 1].kind == Tok::LeftBrace;
}

ast::Stmt* Parser::nested_function() {
    ast::Stmt* s = new_stmt(StmtKind::Function, peek().loc);
    s->function = function_def();
    return s;
}

// var-decl = [ "extern" ] typespec var-init { "," var-init }
// var-init = IDENT [ "[" [ NUMBER ] "]" ] [ "=" ( expr | array-init ) ]
ast::Stmt* Parser::declaration() {
    const Loc loc = peek().loc;
    const bool is_extern = accept(Tok::WordExtern);
    ast::Stmt* s = new_stmt(is_extern ? StmtKind::Extern : StmtKind::Declare, loc);
    const TypeSpec spec = typespec(false);
    if (!spec.type && !is_extern) {
        fail(peek(), "expected a type");
    }
    do {
        ast::Variable variable;
        variable.symbol = new_symbol(spec, ast::SymbolKind::Local, true);
        if (is(Tok::Assign)) {
            initialiser(variable);
        }
        if (variable.symbol->array_length == ast::unsized_array && !is_extern) {
            messages_.error(variable.symbol->loc, "array " + quoted(variable.symbol->name) +
                                                      " needs a length or a list of values");
            variable.symbol->array_length = 1;
        }
        s->variables.push_back(std::move(variable));
    } while (accept(Tok::Comma));
    expect(Tok::Semicolon, "after a declaration");
    return s;
}

// Two words in a row, or a word before a type: a declaration in another language.
void Parser::foreign_type() {
    if (!is(Tok::Name) || !(is(Tok::Name, 1) || type_at(1))) {
        return;
    }
    fail(peek(1), quoted(peek().text) + " is no type of the Shading Language, which has float, " +
                      "color, point, vector, normal, matrix and string");
}

// expr ";"; several, separated by commas, as C would take them
ast::Stmt* Parser::expression_statement() {
    ast::Stmt* s = new_stmt(StmtKind::Expression, peek().loc);
    s->exprs.push_back(statement_expr());
    if (!is(Tok::Comma)) {
        expect(Tok::Semicolon, "after an expression");
        return s;
    }
    ast::Stmt* block = new_stmt(StmtKind::Block, s->loc);
    block->body.push_back(s);
    while (accept(Tok::Comma)) {
        block->body.push_back(new_stmt(StmtKind::Expression, peek().loc));
        block->body.back()->exprs.push_back(statement_expr());
    }
    expect(Tok::Semicolon, "after an expression");
    return block;
}

// expr where its value is not used: there x++ can only mean x += 1.
Expr* Parser::statement_expr() {
    const auto twice = [&](std::size_t i) {
        return (is(Tok::Plus, i) && is(Tok::Plus, i + 1)) ||
               (is(Tok::Minus, i) && is(Tok::Minus, i + 1));
    };
    const auto ends = [&](std::size_t i) {
        return is(Tok::Semicolon, i) || is(Tok::RightParen, i) || is(Tok::Comma, i);
    };
    const bool before = twice(0) && is_name(2) && ends(3);
    if (!before && !(is_name() && twice(1) && ends(3))) {
        return expr();
    }
    const Token& first = take();
    const Token& second = take();
    const Token& third = take();
    Expr* e = new_expr(ExprKind::Assign, first.loc);
    e->op = second.kind == Tok::Plus ? Op::Add : Op::Sub;
    Expr* name = new_expr(ExprKind::Name, before ? third.loc : first.loc);
    name->text = before ? third.text : first.text;
    Expr* one = new_expr(ExprKind::Number, second.loc);
    one->number = 1;
    e->args = {name, one};
    messages_.warning(second.loc, "the Shading Language writes " + name->text +
                                      (e->op == Op::Add ? " += 1" : " -= 1"));
    return e;
}

// cond = "(" expr ")"; a string before it ("any", "all") told other renderers how points go
// together
Expr* Parser::condition() {
    if (is(Tok::Text) && is(Tok::LeftParen, 1)) {
        messages_.warning(peek().loc, "every point decides for itself; this word is left out");
        take();
    }
    expect(Tok::LeftParen, "before a condition");
    Expr* e = expr();
    expect(Tok::RightParen, "after a condition");
    return e;
}

// "if" cond statement [ "else" statement ]
ast::Stmt* Parser::if_statement() {
    ast::Stmt* s = new_stmt(StmtKind::If, take().loc);
    s->exprs.push_back(condition());
    s->body.push_back(statement());
    if (accept(Tok::WordElse)) {
        s->body.push_back(statement());
    }
    return s;
}

// "while" cond statement
ast::Stmt* Parser::while_statement() {
    ast::Stmt* s = new_stmt(StmtKind::While, take().loc);
    s->exprs.push_back(condition());
    s->body.push_back(statement());
    return s;
}

// "do" block "while" cond ";": a while loop whose condition is first asked after the body
ast::Stmt* Parser::do_statement() {
    const Loc loc = take().loc;
    const auto name = [&] {
        Expr* e = new_expr(ExprKind::Name, loc);
        e->text = "do first"; // no name that a shader could have
        return e;
    };
    const auto number = [&](double value) {
        Expr* e = new_expr(ExprKind::Number, loc);
        e->number = value;
        return e;
    };
    ast::Stmt* first = new_stmt(StmtKind::Declare, loc);
    ast::Symbol& symbol = file_->symbols.emplace_back();
    symbol.name = "do first";
    symbol.loc = loc;
    ast::Variable variable;
    variable.symbol = &symbol;
    variable.init = number(1);
    first->variables.push_back(variable);
    ast::Stmt* done = new_stmt(StmtKind::Expression, loc);
    done->exprs.push_back(new_expr(ExprKind::Assign, loc));
    done->exprs[0]->args = {name(), number(0)};
    ast::Stmt* repeated = new_stmt(StmtKind::Block, loc);
    repeated->body = {done, statement()};
    expect(Tok::WordWhile, "after the body of 'do'");
    ast::Stmt* loop = new_stmt(StmtKind::While, loc);
    loop->exprs.push_back(new_expr(ExprKind::Binary, loc));
    loop->exprs[0]->op = Op::Or;
    loop->exprs[0]->args = {name(), condition()};
    loop->body.push_back(repeated);
    expect(Tok::Semicolon, "after the condition of 'do'");
    ast::Stmt* block = new_stmt(StmtKind::Block, loc);
    block->body = {first, loop};
    return block;
}

// "for" "(" [ expr-list ] ";" [ expr ] ";" [ expr-list ] ")" statement
// A declaration in the first part is accepted; it is put, with the loop, into a block of its own.
ast::Stmt* Parser::for_statement() {
    ast::Stmt* s = new_stmt(StmtKind::For, take().loc);
    expect(Tok::LeftParen, "after 'for'");
    ast::Stmt* declared = nullptr;
    if (at_formal_group()) {
        declared = declaration(); // takes the ';'
    } else {
        s->body.push_back(new_stmt(StmtKind::Block, s->loc));
        for (Expr* e : expr_list(Tok::Semicolon)) {
            s->body[0]->body.push_back(new_stmt(StmtKind::Expression, e->loc));
            s->body[0]->body.back()->exprs.push_back(e);
        }
        expect(Tok::Semicolon, "after the first part of 'for'");
    }
    if (declared != nullptr) {
        s->body.push_back(new_stmt(StmtKind::Empty, s->loc));
    }
    if (!is(Tok::Semicolon)) {
        s->exprs.push_back(expr());
    }
    expect(Tok::Semicolon, "after the condition of 'for'");
    s->steps = expr_list(Tok::RightParen);
    expect(Tok::RightParen, "after the parts of 'for'");
    s->body.push_back(statement());
    if (declared == nullptr) {
        return s;
    }
    ast::Stmt* block = new_stmt(StmtKind::Block, s->loc);
    block->body = {declared, s};
    return block;
}

// "break" [ NUMBER ] ";" | "continue" [ NUMBER ] ";"
ast::Stmt* Parser::jump() {
    const Token& word = take();
    ast::Stmt* s =
        new_stmt(word.kind == Tok::WordBreak ? StmtKind::Break : StmtKind::Continue, word.loc);
    if (!is(Tok::Semicolon)) {
        const Token& at = peek();
        const std::optional<double> levels = constant_value(*expr());
        if (!levels || *levels < 1 || *levels != std::floor(*levels) || *levels > max_nesting) {
            messages_.error(at.loc, "the number of loops is a whole number, at least 1");
        } else {
            s->levels = static_cast<int>(*levels);
        }
    }
    expect(Tok::Semicolon, "after " + quoted(word.text));
    return s;
}

// "return" [ expr ] ";"
ast::Stmt* Parser::return_statement() {
    ast::Stmt* s = new_stmt(StmtKind::Return, take().loc);
    if (!is(Tok::Semicolon)) {
        s->exprs.push_back(expr());
    }
    expect(Tok::Semicolon, "after 'return'");
    return s;
}

// "solar"       "(" [ expr "," expr ] ")" statement
// "illuminate"  "(" expr [ "," expr "," expr ] ")" statement
// "illuminance" "(" illum-args ")" statement      (the checker sorts out illum-args, note 11)
ast::Stmt* Parser::light_statement(StmtKind kind, std::size_t min_args, std::size_t max_args) {
    const Token& word = take();
    ast::Stmt* s = new_stmt(kind, word.loc);
    expect(Tok::LeftParen, "after " + quoted(word.text));
    s->exprs = expr_list(Tok::RightParen);
    expect(Tok::RightParen, "after the arguments of " + quoted(word.text));
    if (kind == StmtKind::Solar && s->exprs.size() == 1) {
        messages_.warning(word.loc, "'solar' takes an axis and an angle; the angle is taken as 0");
        s->exprs.push_back(new_expr(ExprKind::Number, word.loc));
    }
    const std::size_t n = s->exprs.size();
    const bool fits = kind == StmtKind::Illuminance ? n >= min_args && n <= max_args
                                                    : n == min_args || n == max_args;
    if (!fits) {
        messages_.error(word.loc, quoted(word.text) + " takes " + std::to_string(min_args) +
                                      " or " + std::to_string(max_args) + " arguments, not " +
                                      std::to_string(n));
        throw SyntaxError{};
    }
    s->body.push_back(statement());
    return s;
}

// "gather" "(" expr-list ")" statement [ "else" statement ]
ast::Stmt* Parser::gather_statement() {
    ast::Stmt* s = new_stmt(StmtKind::Gather, take().loc);
    expect(Tok::LeftParen, "after 'gather'");
    s->exprs = expr_list(Tok::RightParen);
    expect(Tok::RightParen, "after the arguments of 'gather'");
    s->body.push_back(statement());
    if (accept(Tok::WordElse)) {
        s->body.push_back(statement());
    }
    return s;
}

// expr-list = expr { "," expr }, or nothing
std::vector<Expr*> Parser::expr_list(Tok end) {
    std::vector<Expr*> list;
    if (is(end)) {
        return list;
    }
    do {
        list.push_back(statement_expr());
    } while (accept(Tok::Comma));
    return list;
}

} // namespace slc
