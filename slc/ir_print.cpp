// SPDX-License-Identifier: Apache-2.0
// IR to text. One line per variable and statement; blocks in braces; every line ends with its
// place.
//   surface "matte"
//   file "matte.sl"
//   var Kd param uniform float index 1 @0:3:20
//   var k1 const uniform float = 1 @0:0:0
//   default Kd {
//     Kd = copy k1 @0:3:25
//   }
//   body {
//     t1 = call "diffuse" "c(n)" N @0:5:9
//   }
#include "slc/ir_text.h"
#include "slc/ir_util.h"

#include <cstdio>

namespace slc {

namespace {

std::string_view kind_name(VarKind kind) {
    constexpr std::string_view names[] = {"const", "param", "global", "local", "temp"};
    return names[static_cast<std::size_t>(kind)];
}

class Printer {
public:
    explicit Printer(const Program& program) : program_(program) {}
    std::string run();

private:
    void variable(const Var& v);
    void block(const Block& block);
    void statement(const Stmt& s);
    void name(VarId id) { out_ += " " + program_.vars[static_cast<std::size_t>(id)].name; }
    void place(Loc loc) {
        out_ += " @" + std::to_string(loc.file) + ":" + std::to_string(loc.line) + ":" +
                std::to_string(loc.col);
    }
    void indent() { out_.append(static_cast<std::size_t>(2 * depth_), ' '); }
    void quote(std::string_view text);
    void number(float x);

    const Program& program_;
    std::string out_;
    int depth_ = 0;
};

void Printer::quote(std::string_view text) {
    out_ += '"';
    for (const char c : text) {
        const auto u = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\') {
            out_ += '\\';
            out_ += c;
        } else if (u < 32 || u == 127) {
            char code[8];
            std::snprintf(code, sizeof code, "\\%03o", u);
            out_ += code;
        } else {
            out_ += c;
        }
    }
    out_ += '"';
}

// Nine digits bring every float back.
void Printer::number(float x) {
    char text[32];
    std::snprintf(text, sizeof text, " %.9g", static_cast<double>(x));
    out_ += text;
}

std::string Printer::run() {
    out_ += shader_type_name(program_.shader_type);
    out_ += ' ';
    quote(program_.name);
    out_ += '\n';
    for (const std::string& file : program_.files) {
        out_ += "file ";
        quote(file);
        out_ += '\n';
    }
    for (const Var& v : program_.vars) {
        variable(v);
    }
    for (const Param& p : program_.params) {
        out_ += "default";
        name(p.var);
        block(p.init);
        out_ += '\n';
    }
    out_ += "body";
    block(program_.body);
    out_ += '\n';
    return std::move(out_);
}

void Printer::variable(const Var& v) {
    out_ += "var " + v.name + " ";
    out_ += kind_name(v.kind);
    out_ += ' ';
    out_ += detail_name(v.detail);
    out_ += ' ';
    out_ += type_name(v.type);
    if (v.array_length != 0) {
        out_ += "[" + std::to_string(v.array_length) + "]";
    }
    out_ += v.index >= 0 ? " index " + std::to_string(v.index) : std::string();
    out_ += v.aux != 0 ? " aux " + std::to_string(v.aux) : std::string();
    out_ += v.is_output ? " output" : "";
    out_ += v.declared_uniform ? " declared_uniform" : "";
    if (v.kind == VarKind::Const) {
        out_ += " =";
        if (v.type == Type::String) {
            out_ += ' ';
            quote(v.text);
        }
        for (const float x : v.values) {
            number(x);
        }
    }
    place(v.loc);
    out_ += '\n';
}

void Printer::block(const Block& statements) {
    out_ += " {\n";
    ++depth_;
    for (const Stmt& s : statements) {
        statement(s);
    }
    --depth_;
    indent();
    out_ += '}';
}

void Printer::statement(const Stmt& s) {
    indent();
    if (s.dst != no_var) {
        out_ += program_.vars[static_cast<std::size_t>(s.dst)].name + " = ";
    }
    out_ += op_info(s.op).text;
    if (s.op == Op::Call || s.op == Op::Difference) {
        const BuiltinRow& row = builtin_of(s);
        out_ += ' ';
        quote(row.name);
        out_ += ' ';
        quote(row.signature);
    }
    for (const VarId id : s.args) {
        name(id);
    }
    if (s.levels != 1) {
        out_ += " levels " + std::to_string(s.levels);
    }
    if (s.category != no_var) {
        out_ += " category";
        name(s.category);
    }
    for (const auto& [option, id] : s.options) {
        out_ += " option ";
        quote(option);
        name(id);
    }
    place(s.loc);
    for (const Block& b : s.bodies) {
        block(b);
    }
    out_ += '\n';
}

} // namespace

std::string print_ir(const Program& program) {
    return Printer(program).run();
}

} // namespace slc
