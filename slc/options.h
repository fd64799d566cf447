// SPDX-License-Identifier: Apache-2.0
// The command line of slc: argv in, what is to be done or a usage message out. Driven by the rows
// of options.def.
#pragma once

#include "slc/driver.h"

#include <algorithm>
#include <span>
#include <string>
#include <thread>
#include <vector>

namespace slc {

// Shader packages end in this (docs/shader_cache.md).
constexpr std::string_view package_suffix = ".slpkg";

struct Options {
    ObjectOptions object;
    std::string output;
    std::string dir = ".";
    std::string dump;
    bool quiet = false;
    bool check = false;
    bool json_messages = false;
    bool explain = false;
    bool help = false, version = false;
    unsigned jobs = std::max(1U, std::thread::hardware_concurrency());
    std::vector<std::string> shadeop_dirs;
    std::vector<std::string> files;

    [[nodiscard]] bool makes_package() const { return output.ends_with(package_suffix); }
};

struct ParsedOptions {
    Options options;
    std::string error; // not empty: wrong usage
};
[[nodiscard]] ParsedOptions parse_options(std::span<const char* const> arguments);

[[nodiscard]] std::string usage_text();

} // namespace slc
