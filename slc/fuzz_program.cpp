// SPDX-License-Identifier: Apache-2.0
#include "slc/fuzz_program.h"

#include "slc/compiler.h"
#include "slc/emit_c.h"
#include "slc/interp.h"
#include "slc/ir_text.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>

namespace slc_fuzz {

namespace {

constexpr int num_points = 3;
constexpr std::size_t max_steps = 20'000;
constexpr std::size_t max_floats = 20'000; // of all variables

[[noreturn]] void fail(const char* what, const std::string& text) {
    std::fprintf(stderr, "%s\n%s\n", what, text.c_str());
    std::abort();
}

} // namespace

void check_verified(const slc::Program& program, const char* stage) {
    const std::vector<std::string> complaints = slc::verify_ir(program);
    if (!complaints.empty()) {
        fail(stage, complaints.front() + "\n" + slc::print_ir(program));
    }
}

void check_program(const slc::Program& program) {
    const std::string text = slc::print_ir(program);
    std::string error;
    const auto again = slc::parse_ir(text, error);
    if (!again) {
        fail("printed IR does not parse", error + "\n" + text);
    }
    if (slc::print_ir(*again) != text) {
        fail("printed IR is not what was parsed", text);
    }
    slc::EmitOptions options;
    options.source = "fuzz.sl";
    options.ir_text = text;
    if (slc::emit_c(program, slc::analyse(program), options).empty()) {
        fail("nothing was emitted", text);
    }
}

bool interpret(const slc::Program& program) {
    std::size_t floats = 0;
    for (const slc::Var& v : program.vars) {
        floats += static_cast<std::size_t>(std::max(v.array_length, 1)) *
                  static_cast<std::size_t>(slc::num_components(v.type));
    }
    if (floats > max_floats) {
        return false;
    }
    slc::InterpHost host;
    slc::Interpreter interpreter(program, host, num_points);
    interpreter.limit_steps(max_steps);
    static_cast<void>(interpreter.run());
    return true;
}

} // namespace slc_fuzz
