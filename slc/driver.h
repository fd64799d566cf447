// SPDX-License-Identifier: Apache-2.0
// From SL files to shader objects: front end, facts, emitter, C compiler. The library face of
// `slc`, also used by `render` for shaders it finds only as source.
#pragma once

#include "runtime/base/diag.h"
#include "runtime/base/shadeops.h"
#include "slc/compiler.h"
#include "slc/specialise.h"
#include "slc/toolchain.h"

#include <optional>
#include <span>
#include <string>

namespace slc {

struct ObjectOptions {
    CompileOptions front;
    CompileFlags flags;
    bool profile = false;     // the object counts time by source line (sl_profile.h)
    bool checked = false;     // the object tells where values stop being numbers
    bool native_only = false; // only the variant this processor runs best
    std::string index_dir;    // where object_key remembers (key_index.h); "" = nowhere
    base::ShadeopLibrary* shadeops = nullptr; // functions of DSOs; front.find_functions asks it
};

// Shaders may call the functions of this library, which must live as long as the options.
void use_shadeops(ObjectOptions& options, base::ShadeopLibrary& library);
// What is wrong with its DSOs, as warnings.
void report_shadeops(base::ShadeopLibrary& library, base::Diag& diag);

enum class Outcome { Done, BadInput, BadEnvironment }; // slc exits with 0, 1, 3

// The C text of one variant of a program, as it would be compiled.
[[nodiscard]] std::string c_text(const Program& program, int lanes, const ObjectOptions& options);

// One program into one sealed object; the bytes are empty unless it is Done.
struct BuiltObject {
    Outcome outcome = Outcome::BadEnvironment;
    std::string bytes;
};
[[nodiscard]] BuiltObject build_object(const Program& program, const ObjectOptions& options,
                                       base::Diag& diag);

// An object for parameters that keep their values (specialise.h), not made yet.
struct SpecialOrder {
    Specialised special;
    std::uint64_t kept_needed = 0; // variables lights look for in the batch of who asks them
    double gain = 0;               // share of the general shader's time it saves, expected
    std::string key;               // identifies what build_special would make
};
// nullopt with the reason in `error`: broken IR, or no compiler.
[[nodiscard]] std::optional<SpecialOrder> special_order(const sl_object& general,
                                                        std::span<const ConstantParam> constants,
                                                        const ObjectOptions& options,
                                                        std::string& error);
[[nodiscard]] BuiltObject build_special(const SpecialOrder& order, const ObjectOptions& options,
                                        base::Diag& diag);

// The shader of a source file: the one named like the file, or the only one. nullopt after
// messages, or without any if it was cancelled.
[[nodiscard]] std::optional<std::string>
compile_to_bytes(const std::string& sl_path, const ObjectOptions& options, base::Diag& diag);
// The same into a file that appears complete or not at all.
[[nodiscard]] bool compile_to_object(const std::string& sl_path, const std::string& slo_path,
                                     const ObjectOptions& options, base::Diag& diag);

// Identifies what compile_to_bytes would make: preprocessed text, tables, this compiler, the C
// compiler, flags. nullopt after messages. Sources that include nothing are not preprocessed for
// it; for others the answer is remembered below index_dir.
[[nodiscard]] std::optional<std::string> object_key(const std::string& sl_path,
                                                    const ObjectOptions& options, base::Diag& diag);

} // namespace slc
