// SPDX-License-Identifier: Apache-2.0
// The library face of the shader compiler up to optimised IR: SL file or text -> programs -> facts.
// What comes out of compile() with ok() is verified IR: uniform variables are assigned only uniform
// values under uniform control, operands have the types ir.h states. Messages go to the Diag, with
// source line and caret.
#pragma once

#include "runtime/base/diag.h"
#include "slc/externals.h"
#include "slc/ir.h"

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace slc {

class Messages;

// A message as data, for editors. Columns count bytes from 1; 0: no place.
struct Message {
    base::Severity severity = base::Severity::Error;
    base::Code code = base::Code::None;
    std::string file;
    std::uint32_t line = 0, column = 0;
    std::uint32_t end_column = 0; // of the word at the place, exclusive
    std::string text;
    std::string note; // advice after the text: what to write, what was done instead
};

struct CompileOptions {
    std::vector<std::string> include_dirs; // -I, in order
    std::string standard_headers;          // looked in after all others; "" = nowhere
    std::vector<std::string> defines;      // -D, "NAME" or "NAME=value"
    std::string preprocessor;        // C compiler to run as preprocessor; "" = cc, gcc or clang
    bool is_preprocessed = false;    // the text has been through a preprocessor; none is run
    bool optimise = true;            // false: only the passes the emitter cannot do without
    bool exact = false;              // folds only what has the bits it would have at run time
    std::function<bool()> cancelled; // true: ends the programs that run, without a message
    // If set, messages about the source go here instead of to the Diag.
    std::function<void(const Message&)> on_message;
    FindFunctions find_functions; // of DSOs; empty: none
};

// All shaders of one source file.
struct Unit {
    std::vector<Program> programs; // in the order of the file; only those without errors
    std::size_t num_errors = 0;
    [[nodiscard]] bool ok() const { return num_errors == 0; }
};

// Parse, check, lower and run the passes. `name` is what messages and IR call the text; its
// directory is where quoted includes are looked for.
[[nodiscard]] Unit compile_file(const std::string& path, const CompileOptions& options,
                                base::Diag& diag);
[[nodiscard]] Unit compile_text(std::string_view text, const std::string& name,
                                const CompileOptions& options, base::Diag& diag);

// The same without the passes: IR as lowering leaves it, every local and temporary still varying.
[[nodiscard]] Unit front_end_file(const std::string& path, const CompileOptions& options,
                                  base::Diag& diag);
[[nodiscard]] Unit front_end_text(std::string_view text, const std::string& name,
                                  const CompileOptions& options, base::Diag& diag);

// The pass list (pipeline.cpp). With `messages`, warns about uniform variables that get varying
// values.
void run_passes(Program& program, const CompileOptions& options, Messages* messages = nullptr);

// Makes what happens at the auxiliary points explicit (pass_area.cpp), so that no area operator is
// left: what is emitted and interpreted. The IR text kept in objects is the one before, from which
// specialisation starts.
void resolve_area_operators(Program& program, const CompileOptions& options);

// Of a program whose area operators are resolved. Never changes it. Exact after run_passes.
[[nodiscard]] Facts analyse(const Program& program);

// Text after the preprocessor (for cache keys); nullopt after messages.
[[nodiscard]] std::optional<std::string>
preprocess_file(const std::string& path, const CompileOptions& options, base::Diag& diag);

enum class DumpKind { Tokens, Ast, Ir, Points, Facts }; // Points: area operators resolved
// nullopt: no such dump name, or the file has errors (already reported).
[[nodiscard]] std::optional<DumpKind> dump_kind(std::string_view name);
[[nodiscard]] std::optional<std::string> dump_file(const std::string& path, DumpKind kind,
                                                   const CompileOptions& options, base::Diag& diag);

// Parts of dumps for callers that already hold a program.
[[nodiscard]] std::string facts_text(const Program& program, const Facts& facts);

} // namespace slc
