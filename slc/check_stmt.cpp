// SPDX-License-Identifier: Apache-2.0
// Checking of statements, sl.md 1.7.
#include "slc/check.h"

namespace slc {

using ast::Expr;
using ast::ExprKind;
using ast::StmtKind;

void Checker::statements(const std::vector<ast::Stmt*>& list) {
    for (ast::Stmt* s : list) {
        if (messages_.too_many()) {
            return;
        }
        statement(*s);
    }
}

void Checker::statement(ast::Stmt& s) {
    switch (s.kind) {
    case StmtKind::Empty:
        break;
    case StmtKind::Block:
        scopes_.push(false);
        statements(s.body);
        scopes_.pop();
        break;
    case StmtKind::Declare:
        declaration(s);
        break;
    case StmtKind::Extern:
        for (ast::Variable& v : s.variables) {
            declare_extern(v);
        }
        break;
    case StmtKind::Expression:
        expression_statement(*s.exprs[0]);
        break;
    case StmtKind::If:
        condition(*s.exprs[0]);
        body(s, false);
        break;
    case StmtKind::While:
    case StmtKind::For:
        loop(s);
        break;
    case StmtKind::Break:
    case StmtKind::Continue:
        jump(s);
        break;
    case StmtKind::Return:
        return_statement(s);
        break;
    case StmtKind::Solar:
        if (!s.exprs.empty()) {
            deliver(*s.exprs[0], Type::Vector, "the axis of 'solar'");
            deliver(*s.exprs[1], Type::Float, "the angle of 'solar'");
        }
        body(s, false);
        break;
    case StmtKind::Illuminate:
        deliver(*s.exprs[0], Type::Point, "the position in 'illuminate'");
        if (s.exprs.size() == 3) {
            deliver(*s.exprs[1], Type::Vector, "the axis of 'illuminate'");
            deliver(*s.exprs[2], Type::Float, "the angle of 'illuminate'");
        }
        body(s, false);
        break;
    case StmtKind::Illuminance:
        illuminance(s);
        break;
    case StmtKind::Gather:
        gather(s);
        break;
    case StmtKind::Function:
        check_function(*s.function);
        break;
    }
}

// Each part is a scope of its own, even without braces.
void Checker::body(ast::Stmt& s, bool is_loop) {
    loop_depth_ += is_loop ? 1 : 0;
    for (ast::Stmt* part : s.body) {
        scopes_.push(false);
        statement(*part);
        scopes_.pop();
    }
    loop_depth_ -= is_loop ? 1 : 0;
}

void Checker::declaration(ast::Stmt& s) {
    for (ast::Variable& v : s.variables) {
        check_initialiser(v);
        declare(*v.symbol);
    }
}

void Checker::condition(Expr& e) {
    deliver(e, Type::Float, "a condition");
}

void Checker::expression_statement(Expr& e) {
    if (e.kind == ExprKind::Assign) {
        costs(e);
        return;
    }
    if (e.kind != ExprKind::Call && e.kind != ExprKind::Cast && e.kind != ExprKind::Ternary) {
        messages_.warning(e.loc, "this expression has no effect");
    }
    if (array_of(e) == nullptr) {
        deliver_any(e, false);
    }
}

void Checker::loop(ast::Stmt& s) {
    if (s.kind == StmtKind::For) {
        statement(*s.body[0]);
    }
    for (Expr* e : s.exprs) {
        condition(*e);
    }
    for (Expr* e : s.steps) {
        expression_statement(*e);
    }
    ++loop_depth_;
    scopes_.push(false);
    statement(*s.body.back());
    scopes_.pop();
    --loop_depth_;
}

void Checker::jump(ast::Stmt& s) {
    const std::string word = s.kind == StmtKind::Break ? "'break'" : "'continue'";
    if (loop_depth_ == 0) {
        messages_.error(s.loc, word + " outside a loop");
    } else if (s.levels > loop_depth_) {
        messages_.error(s.loc, word + " names " + std::to_string(s.levels) +
                                   " loops, but there are only " + std::to_string(loop_depth_) +
                                   " here");
    }
    s.levels = std::min(s.levels, std::max(loop_depth_, 1));
}

// A function without a type gets it from its first return (note 8).
void Checker::return_statement(ast::Stmt& s) {
    if (s.exprs.empty()) {
        return;
    }
    if (function_ == nullptr) {
        messages_.warning(s.loc, "a shader returns no value; this one is left out");
        s.exprs.clear();
        return;
    }
    if (!function_->result) {
        function_->result = deliver_any(*s.exprs[0], true);
        return;
    }
    if (*function_->result == Type::Void) {
        messages_.warning(s.loc, "function " + quoted(function_->name) +
                                     " is void and returns no value; this one is left out");
        s.exprs.clear();
        return;
    }
    deliver(*s.exprs[0], *function_->result, "the value returned");
}

// illum-args: the type of the first argument tells (category, P) from (P, axis, angle), note 11.
void Checker::illuminance(ast::Stmt& s) {
    const auto is_text = [&](std::size_t i) {
        return i < s.exprs.size() && array_of(*s.exprs[i]) == nullptr &&
               !costs(*s.exprs[i]).failed && costs(*s.exprs[i])[Type::String] != ast::no_cost;
    };
    std::size_t next = 0;
    s.has_category = is_text(0);
    if (s.has_category) {
        deliver(*s.exprs[next++], Type::String, "the category of 'illuminance'");
    }
    if (next >= s.exprs.size()) {
        messages_.error(s.loc, "'illuminance' needs a position");
        return;
    }
    deliver(*s.exprs[next++], Type::Point, "the position in 'illuminance'");
    if (next < s.exprs.size() && !is_text(next)) {
        if (next + 1 >= s.exprs.size()) {
            messages_.error(s.loc, "'illuminance' has an axis but no angle");
            return;
        }
        deliver(*s.exprs[next++], Type::Vector, "the axis of 'illuminance'");
        deliver(*s.exprs[next++], Type::Float, "the angle of 'illuminance'");
    }
    options(s, next, nullptr);
    body(s, true);
}

void Checker::gather(ast::Stmt& s) {
    if (s.exprs.size() < 5) {
        messages_.error(
            s.loc,
            "'gather' takes a category, a position, a direction, an angle and a number of samples");
        return;
    }
    deliver(*s.exprs[0], Type::String, "the category of 'gather'");
    deliver(*s.exprs[1], Type::Point, "the position in 'gather'");
    deliver(*s.exprs[2], Type::Vector, "the direction of 'gather'");
    deliver(*s.exprs[3], Type::Float, "the angle of 'gather'");
    deliver(*s.exprs[4], Type::Float, "the samples of 'gather'");
    options(s, 5, &builtin_rows()[static_cast<std::size_t>(find_builtin_by_body("gather_ray"))]);
    body(s, true);
}

// Name/value pairs of a light loop, or of the row a gather loop calls.
void Checker::options(ast::Stmt& s, std::size_t first, const BuiltinRow* row) {
    if ((s.exprs.size() - first) % 2 != 0) {
        messages_.error(s.exprs.back()->loc, "options come in pairs of a name and a value");
        s.exprs.pop_back();
    }
    for (std::size_t i = first; i + 1 < s.exprs.size(); i += 2) {
        Expr& name = *s.exprs[i];
        Expr& value = *s.exprs[i + 1];
        deliver(name, Type::String, "the name of an option");
        if (name.kind != ExprKind::Text) {
            messages_.error(name.loc, "the name of an option is a string literal");
            continue;
        }
        const bool is_output =
            row != nullptr ? row->sets_pair(name.text) : name.text.starts_with("light:");
        const bool is_array = array_of(value) != nullptr;
        if (!is_array) {
            deliver_any(value, true);
        }
        if (is_output) {
            if (value.kind != ExprKind::Name || value.symbol == nullptr) {
                messages_.error(value.loc,
                                "option " + quoted(name.text) + " needs a variable to set");
            } else {
                mark_assigned(value);
            }
        }
    }
}

} // namespace slc
