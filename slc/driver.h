// SPDX-License-Identifier: Apache-2.0
// From SL files to shader objects: front end, facts, emitter, C compiler. The library face of
// `slc`, also used by `render` for shaders it finds only as source.
#pragma once

#include "runtime/base/diag.h"
#include "slc/compiler.h"
#include "slc/toolchain.h"

#include <optional>
#include <string>

namespace slc {

struct ObjectOptions {
    CompileOptions front;
    CompileFlags flags;
    bool native_only = false; // only the variant this processor runs best
};

enum class Outcome { Done, BadInput, BadEnvironment }; // slc exits with 0, 1, 3

// The C text of one variant of a program, as it would be compiled.
[[nodiscard]] std::string c_text(const Program& program, int lanes, const ObjectOptions& options);

// One program into one object.
[[nodiscard]] Outcome build_object(const Program& program, const ObjectOptions& options,
                                   const std::string& slo_path, base::Diag& diag);

// The shader of a source file into an object at slo_path: the one named like the file, or the only
// one.
[[nodiscard]] bool compile_to_object(const std::string& sl_path, const std::string& slo_path,
                                     const ObjectOptions& options, base::Diag& diag);

// Identifies what compile_to_object would make: preprocessed text, tables, this compiler, the C
// compiler, flags. nullopt after messages. Sources that include nothing are not preprocessed for
// it.
[[nodiscard]] std::optional<std::string> object_key(const std::string& sl_path,
                                                    const ObjectOptions& options, base::Diag& diag);

} // namespace slc
