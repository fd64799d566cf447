// SPDX-License-Identifier: Apache-2.0
// Syntax tree as indented text, for --dump=ast and tests. Types are shown once the checker has been
// there.
#include "slc/ast.h"
#include "slc/builtins.h"

#include <cstdio>

namespace slc::ast {

namespace {

class Dumper {
public:
    std::string run(const File& file);

private:
    void line(const std::string& text) {
        out_ += std::string(static_cast<std::size_t>(2 * depth_), ' ') + text + "\n";
    }
    void symbol(const std::string& head, const Symbol& s);
    void variable(const std::string& head, const Variable& v);
    void function(const Function& f);
    void shader(const Shader& s);
    void statements(const std::vector<Stmt*>& list);
    void statement(const Stmt& s);
    static std::string expr(const Expr& e);
    static std::string list(const std::vector<Expr*>& exprs);
    std::string out_;
    int depth_ = 0;
};

std::string Dumper::list(const std::vector<Expr*>& exprs) {
    std::string out;
    for (const Expr* e : exprs) {
        out += " " + expr(*e);
    }
    return out;
}

// Prefix form with types: (+:color Cs (noise:float P))
std::string Dumper::expr(const Expr& e) {
    const std::string type = e.type == Type::Void ? "" : ":" + std::string(type_name(e.type));
    const std::string channel = e.channel != nullptr ? "[" + expr(*e.channel) + "]" : "";
    switch (e.kind) {
    case ExprKind::Number: {
        char text[32];
        std::snprintf(text, sizeof text, "%g", e.number);
        return text;
    }
    case ExprKind::Text:
        return "\"" + e.text + "\"" + channel;
    case ExprKind::Name:
        return e.text + channel;
    case ExprKind::Index:
        return e.text + "[" + expr(*e.args[0]) + "]" +
               (e.args.size() > 1 ? "[" + expr(*e.args[1]) + "]" : "") + channel;
    case ExprKind::Call:
        return "(" + e.text + type + list(e.args) + ")";
    case ExprKind::Cast:
        return "(cast" + type + (e.text.empty() ? "" : " \"" + e.text + "\"") + list(e.args) + ")";
    case ExprKind::Ternary:
        return "(?" + type + list(e.args) + ")";
    case ExprKind::Assign:
        return "(" + std::string(op_text(e.op)) + "=" + list(e.args) + ")";
    case ExprKind::Tuple:
        return "(tuple" + type + list(e.args) + ")";
    case ExprKind::Unary:
    case ExprKind::Binary:
        break;
    }
    return "(" + std::string(op_text(e.op)) + type + list(e.args) + ")";
}

void Dumper::symbol(const std::string& head, const Symbol& s) {
    std::string text = head + (s.is_output ? " output" : "");
    text += s.detail ? " " + std::string(detail_name(*s.detail)) : "";
    text += " " + std::string(type_name(s.type)) + " " + s.name;
    if (s.array_length != 0) {
        text += s.array_length == unsized_array ? "[]" : "[" + std::to_string(s.array_length) + "]";
    }
    line(text);
}

void Dumper::variable(const std::string& head, const Variable& v) {
    symbol(head, *v.symbol);
    ++depth_;
    if (v.init != nullptr) {
        line("= " + expr(*v.init));
    }
    if (v.has_elements) {
        line("= {" + list(v.elements) + " }");
    }
    --depth_;
}

void Dumper::function(const Function& f) {
    line("function " + (f.result ? std::string(type_name(*f.result)) : "?") + " " + f.name);
    ++depth_;
    for (const Symbol* s : f.formals) {
        symbol("formal", *s);
    }
    statements(f.body);
    --depth_;
}

void Dumper::shader(const Shader& s) {
    line(std::string(shader_type_name(s.type)) + " " + s.name);
    ++depth_;
    for (const Variable& v : s.params) {
        variable("parameter", v);
    }
    statements(s.body);
    --depth_;
}

void Dumper::statements(const std::vector<Stmt*>& list) {
    for (const Stmt* s : list) {
        statement(*s);
    }
}

void Dumper::statement(const Stmt& s) {
    constexpr const char* names[] = {"empty",      "block",       "declare", "extern",
                                     "expression", "if",          "while",   "for",
                                     "break",      "continue",    "return",  "solar",
                                     "illuminate", "illuminance", "gather",  "function"};
    if (s.kind == StmtKind::Function) {
        function(*s.function);
        return;
    }
    std::string head = names[static_cast<std::size_t>(s.kind)];
    head += s.levels != 1 ? " " + std::to_string(s.levels) : "";
    line(head + list(s.exprs) + (s.steps.empty() ? "" : " ;" + list(s.steps)));
    ++depth_;
    for (const Variable& v : s.variables) {
        variable("variable", v);
    }
    statements(s.body);
    --depth_;
}

std::string Dumper::run(const File& file) {
    for (const Definition& d : file.definitions) {
        if (d.function != nullptr) {
            function(*d.function);
        } else {
            shader(*d.shader);
        }
    }
    return std::move(out_);
}

} // namespace

std::string dump(const File& file) {
    return Dumper().run(file);
}

std::string_view op_text(Op op) {
    switch (op) {
    case Op::Add:
        return "+";
    case Op::Sub:
    case Op::Neg:
        return "-";
    case Op::Mul:
        return "*";
    case Op::Div:
        return "/";
    case Op::Dot:
        return ".";
    case Op::Cross:
        return "^";
    case Op::Eq:
        return "==";
    case Op::Ne:
        return "!=";
    case Op::Lt:
        return "<";
    case Op::Le:
        return "<=";
    case Op::Gt:
        return ">";
    case Op::Ge:
        return ">=";
    case Op::And:
        return "&&";
    case Op::Or:
        return "||";
    case Op::Not:
        return "!";
    default:
        return "";
    }
}

} // namespace slc::ast
