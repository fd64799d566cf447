// SPDX-License-Identifier: Apache-2.0
// Helpers of slc's unit tests: compile a text, collect messages, run it on the interpreter.
#pragma once

#include "slc/compiler.h"
#include "slc/interp.h"
#include "slc/ir_text.h"

#include <cstdio>
#include <gtest/gtest.h>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace slc::testing {

// A Diag that prints nowhere.
class QuietDiag {
public:
    QuietDiag() : file_(std::fopen("/dev/null", "w")), diag_(file_) {}
    ~QuietDiag() {
        if (file_ != nullptr) {
            std::fclose(file_);
        }
    }
    QuietDiag(const QuietDiag&) = delete;
    QuietDiag& operator=(const QuietDiag&) = delete;
    base::Diag& get() { return diag_; }
    // All messages, one below the other.
    [[nodiscard]] std::string text() const {
        std::string all;
        for (const std::string& m : diag_.messages()) {
            all += m + "\n";
        }
        return all;
    }

private:
    std::FILE* file_;
    base::Diag diag_;
};

struct Compiled {
    Unit unit;
    std::string messages;
};

// Without running the system's preprocessor, which most tests do not need.
inline Compiled compile(std::string_view text, bool with_passes = true) {
    QuietDiag diag;
    CompileOptions options;
    options.is_preprocessed = true;
    Compiled c;
    options.optimise = with_passes;
    c.unit = compile_text(text, "test.sl", options, diag.get());
    c.messages = diag.text();
    for (const Program& program : c.unit.programs) {
        const auto complaints = verify_ir(program);
        EXPECT_TRUE(complaints.empty()) << complaints.front() << "\n" << print_ir(program);
    }
    return c;
}

// A surface shader around statements.
inline std::string surface(std::string_view body) {
    return "surface t() { " + std::string(body) + " }";
}

// Value of an expression of type `type` after `before`, on one point with s = 0.25, t = 0.75, P =
// (1, 2, 3).
inline Value evaluate(std::string_view type, std::string_view expression,
                      std::string_view before = "", bool with_passes = true) {
    const std::string text = "surface t(output varying " + std::string(type) +
                             " result = " + (type == "string" ? "\"\"" : "0") + ") { " +
                             std::string(before) + " result = " + std::string(expression) + "; }";
    const Compiled c = compile(text, with_passes);
    EXPECT_EQ(c.unit.num_errors, 0U) << c.messages << text;
    if (c.unit.programs.empty()) {
        return Value(-12345.0);
    }
    InterpHost host;
    Interpreter interpreter(c.unit.programs[0], host, 1);
    interpreter.set_global(SL_VAR_s, 0, Value(0.25));
    interpreter.set_global(SL_VAR_t, 0, Value(0.75));
    interpreter.set_global(SL_VAR_P, 0, Value(Type::Point, 1, 2, 3));
    EXPECT_TRUE(interpreter.run());
    return interpreter.param("result", 0);
}

inline double evaluate_float(std::string_view expression, std::string_view before = "") {
    return evaluate("float", expression, before).f();
}

} // namespace slc::testing
