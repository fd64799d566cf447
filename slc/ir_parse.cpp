// SPDX-License-Identifier: Apache-2.0
// IR text back to a Program; the format is shown in ir_print.cpp. Line and word oriented; stops at
// the first error.
#include "slc/ir_text.h"
#include "slc/ir_util.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <unordered_map>

namespace slc {

namespace {

constexpr int max_depth = 2000;
constexpr int max_length = 1 << 20;

struct Word {
    std::string text;
    bool is_string = false;
    [[nodiscard]] bool is(std::string_view plain) const { return !is_string && text == plain; }
};

class IrParser {
public:
    IrParser(std::string_view text, std::string& error) : text_(text), error_(error) {}
    std::optional<Program> run();

private:
    struct Broken {};
    [[noreturn]] void fail(const std::string& what);
    void skip_space();
    Word word();
    [[nodiscard]] bool at(char c);
    std::string string();
    std::string plain();
    int number();
    Loc place();
    VarId name();
    void header();
    void variable();
    void values(Var& v);
    Block block();
    Stmt statement();
    void operands(Stmt& s, const Word& op);
    Type type(std::string text, int& array_length);

    std::string_view text_;
    std::string& error_;
    std::size_t pos_ = 0;
    int line_ = 1;
    int depth_ = 0;
    Program program_;
    std::unordered_map<std::string, VarId> names_;
};

void IrParser::fail(const std::string& what) {
    error_ = "line " + std::to_string(line_) + ": " + what;
    throw Broken{};
}

void IrParser::skip_space() {
    while (pos_ < text_.size() && (text_[pos_] == ' ' || text_[pos_] == '\n' ||
                                   text_[pos_] == '\r' || text_[pos_] == '\t')) {
        line_ += text_[pos_] == '\n' ? 1 : 0;
        ++pos_;
    }
}

bool IrParser::at(char c) {
    skip_space();
    return pos_ < text_.size() && text_[pos_] == c;
}

Word IrParser::word() {
    skip_space();
    if (pos_ >= text_.size()) {
        fail("unexpected end");
    }
    if (text_[pos_] == '"') {
        return {string(), true};
    }
    if (text_[pos_] == '{' || text_[pos_] == '}') {
        return {std::string(1, text_[pos_++]), false};
    }
    const std::size_t start = pos_;
    while (pos_ < text_.size() &&
           std::string_view(" \t\r\n\"{}").find(text_[pos_]) == std::string_view::npos) {
        ++pos_;
    }
    return {std::string(text_.substr(start, pos_ - start)), false};
}

std::string IrParser::string() {
    std::string out;
    ++pos_;
    while (pos_ < text_.size() && text_[pos_] != '"') {
        char c = text_[pos_++];
        if (c == '\\' && pos_ < text_.size()) {
            c = text_[pos_++];
            if (c >= '0' && c <= '7' && pos_ + 2 <= text_.size()) {
                c = static_cast<char>((c - '0') * 64 + (text_[pos_] - '0') * 8 +
                                      (text_[pos_ + 1] - '0'));
                pos_ += 2;
            }
        }
        out += c;
    }
    if (pos_ >= text_.size()) {
        fail("string without end");
    }
    ++pos_;
    return out;
}

std::string IrParser::plain() {
    Word w = word();
    if (w.is_string || w.text.empty()) {
        fail("expected a word");
    }
    return std::move(w.text);
}

int IrParser::number() {
    const std::string w = plain();
    int value = 0;
    const auto [end, ec] = std::from_chars(w.data(), w.data() + w.size(), value);
    if (ec != std::errc() || end != w.data() + w.size() || value < 0 || value > max_length) {
        fail("expected a number, found " + w);
    }
    return value;
}

// @file:line:col
Loc IrParser::place() {
    const std::string w = plain();
    Loc loc;
    std::uint32_t* const parts[] = {&loc.file, &loc.line, &loc.col};
    const char* p = w.data();
    const char* const end = p + w.size();
    for (std::uint32_t* part : parts) {
        if (p == end) {
            fail("expected a place");
        }
        const auto [next, ec] = std::from_chars(p + 1, end, *part);
        if (ec != std::errc()) {
            fail("expected a place");
        }
        p = next;
    }
    return loc;
}

VarId IrParser::name() {
    const std::string w = plain();
    const auto it = names_.find(w);
    if (it == names_.end()) {
        fail("unknown variable " + w);
    }
    return it->second;
}

std::optional<Program> IrParser::run() {
    try {
        header();
        for (;;) {
            const std::string w = plain();
            if (w == "file") {
                program_.files.push_back(word().text);
            } else if (w == "var") {
                variable();
            } else if (w == "default") {
                Param p;
                p.var = name();
                p.init = block();
                program_.params.push_back(std::move(p));
            } else if (w == "body") {
                program_.body = block();
                return std::move(program_);
            } else {
                fail("expected file, var, default or body, found " + w);
            }
        }
    } catch (const Broken&) {
        return std::nullopt;
    }
}

void IrParser::header() {
    const std::string w = plain();
    int type = SL_SHADER_surface;
    while (type <= SL_SHADER_transformation &&
           shader_type_name(static_cast<sl_shader_type>(type)) != w) {
        ++type;
    }
    if (type > SL_SHADER_transformation) {
        fail("expected a shader type, found " + w);
    }
    program_.shader_type = static_cast<sl_shader_type>(type);
    program_.name = word().text;
}

Type IrParser::type(std::string text, int& array_length) {
    const std::size_t bracket = text.find('[');
    if (bracket != std::string::npos) {
        array_length = std::atoi(text.c_str() + bracket + 1);
        text.resize(bracket);
        if (array_length < 1 || array_length > max_length) {
            fail("bad array length");
        }
    }
    for (int t = 0; t <= static_cast<int>(Type::String); ++t) {
        if (type_name(static_cast<Type>(t)) == text) {
            return static_cast<Type>(t);
        }
    }
    fail("unknown type " + text);
}

void IrParser::variable() {
    Var v;
    v.name = plain();
    const std::string kind = plain();
    constexpr std::string_view kinds[] = {"const", "param", "global", "local", "temp"};
    const auto* const k = std::find(std::begin(kinds), std::end(kinds), kind);
    if (k == std::end(kinds)) {
        fail("unknown kind " + kind);
    }
    v.kind = static_cast<VarKind>(k - std::begin(kinds));
    v.detail = plain() == "uniform" ? Detail::Uniform : Detail::Varying;
    v.type = type(plain(), v.array_length);
    while (!at('@')) {
        const std::string w = plain();
        if (w == "index") {
            v.index = number();
        } else if (w == "aux") {
            v.aux = number();
        } else if (w == "output") {
            v.is_output = true;
        } else if (w == "declared_uniform") {
            v.declared_uniform = true;
        } else if (w == "=") {
            values(v);
        } else {
            fail("unexpected " + w);
        }
    }
    v.loc = place();
    if (!names_.emplace(v.name, static_cast<VarId>(program_.vars.size())).second) {
        fail("variable " + v.name + " twice");
    }
    program_.vars.push_back(std::move(v));
}

void IrParser::values(Var& v) {
    if (v.type == Type::String) {
        v.text = word().text;
        return;
    }
    while (!at('@')) {
        const std::string w = plain();
        char* end = nullptr;
        v.values.push_back(std::strtof(w.c_str(), &end));
        if (end != w.c_str() + w.size()) {
            fail("expected a value, found " + w);
        }
    }
}

Block IrParser::block() {
    if (!at('{')) {
        fail("expected {");
    }
    word();
    if (++depth_ > max_depth) {
        fail("nested too deeply");
    }
    Block statements;
    while (!at('}')) {
        statements.push_back(statement());
    }
    word();
    --depth_;
    return statements;
}

Stmt IrParser::statement() {
    Stmt s;
    Word w = word();
    if (at('=')) {
        const auto it = names_.find(w.text);
        if (it == names_.end()) {
            fail("unknown variable " + w.text);
        }
        s.dst = it->second;
        word();
        w = word();
    }
    int op = 0;
    while (op <= static_cast<int>(Op::Solar) && !w.is(op_info(static_cast<Op>(op)).text)) {
        ++op;
    }
    if (op > static_cast<int>(Op::Solar)) {
        fail("unknown operation " + w.text);
    }
    s.op = static_cast<Op>(op);
    if (s.op == Op::Call || s.op == Op::Difference) {
        const std::string called = word().text;
        const std::string signature = word().text;
        const auto rows = builtin_rows();
        for (std::size_t i = 0; i < rows.size() && s.builtin < 0; ++i) {
            s.builtin =
                rows[i].name == called && rows[i].signature == signature ? static_cast<int>(i) : -1;
        }
        if (s.builtin < 0) {
            fail("unknown built-in " + called + " " + signature);
        }
    }
    while (!at('@')) {
        operands(s, word());
    }
    s.loc = place();
    for (int i = 0; i < op_info(s.op).bodies; ++i) {
        s.bodies.push_back(block());
    }
    return s;
}

// A variable name; "levels n"; "category name"; "option "x" name". Variables may be called like
// these words, so the meaning goes by the operation.
void IrParser::operands(Stmt& s, const Word& w) {
    const bool has_options = s.op == Op::Illuminance || s.op == Op::Call;
    if (w.is("levels") && (s.op == Op::Break || s.op == Op::Continue || s.op == Op::Leave)) {
        s.levels = number();
    } else if (w.is("category") && s.op == Op::Illuminance && s.category == no_var &&
               !s.args.empty() && !at('@')) {
        s.category = name();
    } else if (w.is("option") && has_options && at('"')) {
        std::string option = word().text;
        s.options.emplace_back(std::move(option), name());
    } else {
        const auto it = w.is_string ? names_.end() : names_.find(w.text);
        if (it == names_.end()) {
            fail("unknown variable " + w.text);
        }
        s.args.push_back(it->second);
    }
}

} // namespace

std::optional<Program> parse_ir(std::string_view text, std::string& error) {
    return IrParser(text, error).run();
}

} // namespace slc
