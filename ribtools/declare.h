// SPDX-License-Identifier: Apache-2.0
// Declarations of parameter names (ri.md 10.1): their grammar, the dictionary that Declare fills,
// and the types of implementation-specific options and attributes from ri_options.def.
#pragma once

#include "ribtools/param.h"

#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>

namespace rib {

struct Declaration {
    ParamDecl decl;
    std::string name;          // inline declarations only
    bool is_reference = false; // RIS: the value is a string whatever the type says
    std::string error;         // not empty: malformed, what is wrong
};

// "[class] type [n]", the second argument of Declare.
[[nodiscard]] Declaration parse_declaration(std::string_view text);
// "[class] type [n] name" or "[class] type name[n]".
[[nodiscard]] Declaration parse_inline_declaration(std::string_view text);
// Whether a parameter's token declares itself (holds a blank) instead of naming a dictionary entry.
[[nodiscard]] bool is_inline_declaration(std::string_view token);

// "uniform float[2]", for messages and dumps.
[[nodiscard]] std::string declaration_text(const ParamDecl& decl);

class Dictionary {
public:
    Dictionary(); // with the names of ri_params.def

    struct Entry {
        ParamDecl decl;
        bool predeclared = false;
        bool illegal = false; // declared with a malformed type: known, but its values are skipped
    };
    [[nodiscard]] const Entry* find(std::string_view name) const;
    void set(std::string_view name, const Entry& entry);
    void remove(std::string_view name);

private:
    struct Hash {
        using is_transparent = void;
        std::size_t operator()(std::string_view s) const {
            return std::hash<std::string_view>{}(s);
        }
    };
    std::unordered_map<std::string, Entry, Hash, std::equal_to<>> entries_;
};

enum class OptionCategory : std::uint8_t { Option, Attribute, Hider, Display, Approximation };

struct OptionRow {
    OptionCategory category;
    std::string_view group, name, type, fallback, note;
};

// The row of a parameter; nullptr if unknown. Wildcard rows match.
[[nodiscard]] const OptionRow* find_option(OptionCategory category, std::string_view group,
                                           std::string_view name);
// Its type; nullopt for "any".
[[nodiscard]] std::optional<ParamDecl> option_type(const OptionRow& row);
// The nearest known "group name", or "": for the warning about an unknown one.
[[nodiscard]] std::string similar_option(OptionCategory category, std::string_view group,
                                         std::string_view name);

} // namespace rib
