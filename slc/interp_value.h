// SPDX-License-Identifier: Apache-2.0
// A value of the interpreter, in double precision, and the pure built-in functions on such values.
// Written from the definitions in the language reference, apart from runtime/lib, so that each
// checks the other.
#pragma once

#include "slc/builtins.h"
#include "slc/ir.h"

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace slc {

struct Value {
    Type type = Type::Float;
    std::vector<double> x;      // components of all elements; empty for strings
    std::vector<std::string> s; // strings
    Value() : x(1, 0.0) {}
    explicit Value(double f) : x(1, f) {}
    Value(Type t, double a, double b, double c) : type(t), x{a, b, c} {}
    explicit Value(std::string text) : type(Type::String), s{std::move(text)} {}
    // Zeros, or empty strings.
    static Value zero(Type type, int array_length = 0);
    [[nodiscard]] double f() const { return x.empty() ? 0.0 : x[0]; }
    [[nodiscard]] const std::string& text() const;
    // Component i; a float stands for all three components of a triple.
    [[nodiscard]] double at(std::size_t i) const {
        return x.size() == 1 ? x[0] : i < x.size() ? x[i] : 0.0;
    }
    [[nodiscard]] std::array<double, 3> triple() const { return {at(0), at(1), at(2)}; }
};

using Triple3 = std::array<double, 3>;
using Matrix16 = std::array<double, 16>;

// Arguments in the row's order; output arguments are changed in place. The result has its type set.
using PureFunction = void (*)(std::vector<Value>& args, Value& result);

// By the row's body; nullptr when the function is not pure. One table per file, joined in
// interp_pure.cpp.
[[nodiscard]] PureFunction pure_function(std::string_view body);

struct PureEntry {
    std::string_view body;
    PureFunction function;
};
[[nodiscard]] std::vector<PureEntry> pure_math();
[[nodiscard]] std::vector<PureEntry> pure_geometry();
[[nodiscard]] std::vector<PureEntry> pure_noise();
[[nodiscard]] std::vector<PureEntry> pure_text();

// Shared by the pure functions and the interpreter.
[[nodiscard]] double dot3(const Triple3& a, const Triple3& b);
[[nodiscard]] Triple3 cross3(const Triple3& a, const Triple3& b);
[[nodiscard]] Triple3 normalize3(const Triple3& a); // zero stays zero
[[nodiscard]] Triple3 sub3(const Triple3& a, const Triple3& b);
[[nodiscard]] Triple3 scale3(const Triple3& a, double f);
[[nodiscard]] Matrix16 matrix_of(const Value& v); // a float stands for the diagonal
[[nodiscard]] Matrix16 multiply(const Matrix16& a, const Matrix16& b);
[[nodiscard]] Matrix16 inverse(const Matrix16& m); // identity if singular
// Row vectors: p M. Points divide by w; normals use the inverse transpose.
[[nodiscard]] Triple3 transform_by(Type kind, const Triple3& p, const Matrix16& m);
// printf's text, sl.md 4.5.
[[nodiscard]] std::string format_text(const std::string& format, const Value* values,
                                      std::size_t n);
[[nodiscard]] Triple3 color_transform(std::string_view from, std::string_view to, const Triple3& c);
[[nodiscard]] double pow_sl(double x, double y);

} // namespace slc
