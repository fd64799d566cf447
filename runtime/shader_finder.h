// SPDX-License-Identifier: Apache-2.0
// From the name of a shader to the file it is loaded from. In: a name and a search path, whose
// elements are directories or package files (several objects in one file). Out: an object, its
// source, or both. Compiled objects are machine code: those outside the places the user named are
// reported and passed over (sources are compiled from anywhere). Remembers what the elements of
// paths are; not safe from several threads.
#pragma once

#include "runtime/base/ar_file.h"
#include "runtime/base/diag.h"

#include <map>
#include <memory>
#include <set>
#include <span>
#include <string>

namespace rt {

// Name of a shader without the suffix of its file: .sl, .slo, .slc or .slx.
[[nodiscard]] std::string shader_stem(std::string_view name);

struct ShaderPlace {
    std::string object;                    // path of an object, "" = none
    const base::ArFile* package = nullptr; // or the package that holds it ...
    std::string member;                    // ... under this name
    std::string source;                    // .sl in the same directory, "" = none

    [[nodiscard]] bool is_empty() const { return object.empty() && !package && source.empty(); }
};

class ShaderFinder {
public:
    // `trusted`: directories and packages that objects may come from.
    ShaderFinder(std::span<const std::string> trusted, bool trust_all);

    // A stem with a slash is looked for there and not on the path. Empty after one message when
    // there is nothing.
    [[nodiscard]] ShaderPlace find(const std::string& stem, std::span<const std::string> path,
                                   base::SourcePos pos, base::Diag& diag);

private:
    struct Element {
        std::unique_ptr<base::ArFile> package; // null: a directory
        bool is_trusted = false;
    };
    const Element& element(const std::string& directory, base::SourcePos pos, base::Diag& diag);
    [[nodiscard]] ShaderPlace look(const std::string& directory, const std::string& leaf,
                                   base::SourcePos pos, base::Diag& diag);

    std::set<std::string> trusted_; // canonical
    bool trust_all_;
    std::map<std::string, Element, std::less<>> elements_;
};

} // namespace rt
