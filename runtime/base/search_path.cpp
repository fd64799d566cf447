// SPDX-License-Identifier: Apache-2.0
#include "runtime/base/search_path.h"

#include <algorithm>
#include <cstdlib>

namespace base {

namespace {

std::string environment(const std::string& name) {
    const char* value = std::getenv(name.c_str());
    return value ? value : "";
}

bool is_name_char(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

// Replaces the variable that begins at text[at] ('$' or '%'); at moves behind it.
std::string expand_variable(std::string_view text, std::size_t& at) {
    const char mark = text[at];
    std::size_t begin = at + 1, end = begin, behind = 0;
    if (mark == '%') {
        end = behind = text.find('%', begin);
        behind += 1;
    } else if (begin < text.size() && text[begin] == '{') {
        end = text.find('}', ++begin);
        behind = end + 1;
    } else {
        while (end < text.size() && is_name_char(text[end])) {
            ++end;
        }
        behind = end;
    }
    if (end == std::string_view::npos || end == begin) {
        ++at; // no variable after all
        return std::string(1, mark);
    }
    at = behind;
    return environment(std::string(text.substr(begin, end - begin)));
}

constexpr std::string_view special_signs = ":;&@~$%\\";

bool is_escape(std::string_view text, std::size_t at) {
    return text[at] == '\\' && at + 1 < text.size() &&
           special_signs.find(text[at + 1]) != std::string_view::npos;
}

// The element at the front of a path, which moves on to the next.
std::string_view take_element(std::string_view& path) {
    std::size_t n = 0;
    while (n < path.size() && path[n] != ':' && path[n] != ';') {
        n += is_escape(path, n) ? 2 : 1;
    }
    const std::string_view element = path.substr(0, n);
    path.remove_prefix(std::min(n + 1, path.size()));
    return element;
}

std::string expand(std::string_view text) {
    std::string out;
    std::size_t at = 0;
    if (text.starts_with("~") && (text.size() == 1 || text[1] == '/')) {
        out = environment("HOME");
        at = 1;
    }
    while (at < text.size()) {
        if (text[at] == '$' || text[at] == '%') {
            out += expand_variable(text, at);
        } else {
            at += is_escape(text, at) ? 1 : 0;
            out += text[at++];
        }
    }
    return out;
}

} // namespace

std::vector<std::string> expand_search_path(std::string_view value,
                                            const std::vector<std::string>& previous,
                                            const std::vector<std::string>& defaults) {
    std::vector<std::string> result;
    while (!value.empty()) {
        const std::string_view item = take_element(value);
        if (item == "&") {
            result.insert(result.end(), previous.begin(), previous.end());
        } else if (item == "@") {
            result.insert(result.end(), defaults.begin(), defaults.end());
        } else if (std::string directory = expand(item); !directory.empty()) {
            result.push_back(std::move(directory));
        }
    }
    return result;
}

} // namespace base
