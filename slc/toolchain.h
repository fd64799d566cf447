// SPDX-License-Identifier: Apache-2.0
// The system's C compiler and what emitted code is compiled and linked with: sl_shader.h and the
// archives of built-in bodies. C text goes in, a sealed shader object comes out. No shell is
// involved.
#pragma once

#include "runtime/base/diag.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace slc {

struct Toolchain {
    std::string compiler;    // absolute path
    std::string include_dir; // -I, may list several separated by ':'
    std::string archive_dir; // libsl_lanes8.a, libsl_lanes4.a
};

// Looks for `compiler` ("" = cc, gcc, clang) on PATH and for our files beside the running program:
// ../include/perigee and
// ../lib/perigee where it is installed, the build tree otherwise. Reports what is missing and what
// to install.
[[nodiscard]] std::optional<Toolchain> find_toolchain(const std::string& compiler,
                                                      base::Diag& diag);

// The folder of the headers that published shaders include (docs/shading-language.md), found beside
// the running program like the rest; "" if there is none.
[[nodiscard]] std::string standard_headers();

// The C text of one variant.
struct VariantText {
    int lanes = 8;
    std::string c;
};

struct CompileFlags {
    int optimisation = 2;
    std::vector<std::string> extra; // for tests and sanitizers
};

// Everything about the toolchain that changes objects, for cache keys: paths, sizes and times
// instead of versions, because asking the compiler costs milliseconds.
[[nodiscard]] std::string toolchain_identity(const Toolchain& tools, const CompileFlags& flags);

// Compiles the variants and links them with the archives: the bytes of the sealed object. nullopt
// after the compiler's messages have been reported, or without any when `cancelled` (may be empty)
// said so. `name` stands in messages.
[[nodiscard]] std::optional<std::string>
build_shared_object(const Toolchain& tools, const std::vector<VariantText>& variants,
                    const CompileFlags& flags, const std::string& name,
                    const std::function<bool()>& cancelled, base::Diag& diag);

// The best variant width this processor runs.
[[nodiscard]] int native_lanes();

} // namespace slc
