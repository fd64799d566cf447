// SPDX-License-Identifier: Apache-2.0
// Test helper: a program through emitter, C compiler, linker and loader, then run on batches with
// stub services.
#pragma once

#include "runtime/base/temp_dir.h"
#include "runtime/batch.h"
#include "slc/compiler.h"
#include "slc/emit_c.h"
#include "slc/toolchain.h"

#include <memory>
#include <string>

namespace slc {

// Services that answer as an empty scene would.
[[nodiscard]] sl_services empty_services(rt::StringTable& strings);

struct BuildWay {
    int lanes = 8;
    int optimisation = 2;
};

// Which widths this machine runs.
[[nodiscard]] std::vector<BuildWay> all_ways();

class EmitRunner {
public:
    EmitRunner() : library({}, strings, diag), services(empty_services(strings)) {}

    // Null after a failure, which has been reported to standard error.
    const rt::ShaderObject* build(const Program& program, const Facts& facts, BuildWay way);

    base::Diag diag;
    rt::StringTable strings;
    rt::ShaderLibrary library;
    sl_services services;
    std::string last_c; // text of the last build

private:
    base::TempDir dir_{"slc-test"};
    int num_objects_ = 0;
};

} // namespace slc
