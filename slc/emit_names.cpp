// SPDX-License-Identifier: Apache-2.0
// Names and literals of emitted text.
#include "slc/emit_common.h"

#include <array>
#include <charconv>
#include <cmath>
#include <set>

namespace slc {

namespace {

// Words of C, and the names emitted code uses for itself.
constexpr std::string_view reserved[] = {
    "auto",     "break",  "case",    "char",     "const",    "continue", "default",  "do",
    "double",   "else",   "enum",    "extern",   "float",    "for",      "goto",     "if",
    "inline",   "int",    "long",    "register", "restrict", "return",   "short",    "signed",
    "sizeof",   "static", "struct",  "switch",   "typedef",  "union",    "unsigned", "void",
    "volatile", "while",  "asm",     "typeof",   "bool",     "true",     "false",    "complex",
    "batch",    "first",  "count",   "frame",    "call",     "params",   "strings",  "live",
    "init",     "shade",  "slf",     "sli",      "slw",      "slv",      "slm",      "sls",
    "slu3",     "slum",   "uint32_t"};

// Such a stem followed by a number is a mask, a label or a temporary of the emitter.
constexpr std::string_view own_stems[] = {"mask_",   "loop_", "iteration_", "scope_",
                                          "lights_", "lit_",  "end_",       "next_",
                                          "done_",   "out_",  "value_",     "resume_"};

bool is_reserved(const std::string& name) {
    for (const std::string_view word : reserved) {
        if (name == word) {
            return true;
        }
    }
    for (const std::string_view stem : own_stems) {
        if (name.starts_with(stem) &&
            name.find_first_not_of("0123456789", stem.size()) == std::string::npos) {
            return true;
        }
    }
    return name.starts_with("sl_") || name.starts_with("slu_") || name.starts_with("slv_") ||
           name.starts_with("SL_") || name.starts_with("_");
}

std::string identifier(const std::string& name) {
    std::string out;
    for (const char c : name) {
        const bool word =
            (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
        out += word ? c : '_';
    }
    if (out.empty() || (out[0] >= '0' && out[0] <= '9')) {
        out.insert(out.begin(), 'v');
    }
    return is_reserved(out) ? "x" + out + "_" : out;
}

} // namespace

std::vector<std::string> c_names(const Program& program) {
    std::set<std::string> taken;
    std::vector<std::string> names;
    for (const Var& v : program.vars) {
        const std::string wanted = identifier(v.name);
        std::string name = wanted;
        for (int n = 2; !taken.insert(name).second; ++n) {
            name = wanted + "_" + std::to_string(n);
        }
        names.push_back(name);
    }
    return names;
}

std::string c_string(std::string_view text) {
    static constexpr char digits[] = "01234567";
    std::string out = "\"";
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\') {
            out += '\\';
            out += c;
        } else if (c == '\n') {
            out += "\\n";
        } else if (byte < 32 || byte >= 127 || c == '?') { // '?': no trigraphs
            out += '\\';
            out += digits[byte >> 6];
            out += digits[byte >> 3 & 7];
            out += digits[byte & 7];
        } else {
            out += c;
        }
    }
    return out + "\"";
}

std::string float_literal(float value) {
    if (std::isnan(value)) {
        return "__builtin_nanf(\"\")";
    }
    if (std::isinf(value)) {
        return value > 0 ? "__builtin_inff()" : "-__builtin_inff()";
    }
    std::array<char, 32> buffer{};
    const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
    std::string text(buffer.data(), end);
    if (text.find_first_of(".e") == std::string::npos) {
        text += ".0";
    }
    return text + "f";
}

std::size_t StringPool::add(const std::string& text) {
    const auto [it, is_new] = index_.emplace(text, texts_.size());
    if (is_new) {
        texts_.push_back(text);
    }
    return it->second;
}

void Lines::line(std::string_view text) {
    text_.append(static_cast<std::size_t>(depth_) * 4, ' ');
    raw(text);
}

void Lines::raw(std::string_view text) {
    text_.append(text);
    text_ += '\n';
}

Form form_of(Type type) {
    switch (type) {
    case Type::Void:
    case Type::Float:
        return Form::Float;
    case Type::Color:
    case Type::Point:
    case Type::Vector:
    case Type::Normal:
        return Form::Triple;
    case Type::Matrix:
        return Form::Matrix;
    case Type::String:
        return Form::String;
    }
    return Form::Float;
}

std::string_view form_suffix(Form form) {
    static constexpr std::string_view suffixes[] = {"f", "3", "m", "s"};
    return suffixes[static_cast<std::size_t>(form)];
}

} // namespace slc
