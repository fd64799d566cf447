// SPDX-License-Identifier: Apache-2.0
// Where the time of shaders goes, line by line: --profile-shaders. In: the rows that objects
// compiled for it fill (sl_abi.h, sl_profile_row), one set per thread. Out: their sum by source
// line, as a listing or as JSON. docs/shader_profile.md says how to read it.
#pragma once

#include "runtime/abi/sl_abi.h"

#include <cstdint>
#include <map>
#include <string>
#include <unordered_map>
#include <vector>

namespace trace {

class ShaderProfile {
public:
    // The rows of an object, made on first use; null for one that was not compiled for it.
    // Pointers stay valid.
    [[nodiscard]] sl_profile_row* rows(const sl_object& object);
    void add(const ShaderProfile& other);

private:
    friend class ShaderListing;
    std::unordered_map<const sl_object*, std::vector<sl_profile_row>> rows_;
};

// The sum of all threads and frames.
class ShaderListing {
public:
    struct Line {
        int number = 0;
        std::uint64_t packets = 0, lanes = 0;
        double seconds = 0;
    };
    struct File {
        std::string name;
        std::map<int, Line> lines;     // 0: loads and stores around the shader's own statements
        std::vector<std::string> text; // empty: the file was not found
    };
    struct Shader {
        std::string name, type;
        double seconds = 0;
        std::uint64_t executions = 0; // packets the shader ran for
        std::vector<File> files;      // the shader's own first
    };

    // Objects may go afterwards.
    void add(const ShaderProfile& profile, double seconds_per_tick);
    // Reads the sources, as far as these directories have them.
    void find_sources(const std::vector<std::string>& directories);
    // Most expensive first.
    [[nodiscard]] std::vector<Shader> shaders() const;
    [[nodiscard]] double seconds() const;

private:
    using Key = std::pair<std::string, std::string>; // type, name
    std::map<Key, Shader> shaders_;
};

[[nodiscard]] std::string listing_text(const ShaderListing& listing);
[[nodiscard]] std::string listing_json(const ShaderListing& listing); // stats_json.cpp

// Ticks one stamp takes, which every stamped line has too much.
[[nodiscard]] double ticks_of_stamp();

} // namespace trace
