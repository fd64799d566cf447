// SPDX-License-Identifier: Apache-2.0
#include "ribtools/search_path.h"

#include <algorithm>
#include <cstdlib>

namespace rib {

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
        const std::size_t n = std::min(value.find_first_of(":;"), value.size());
        const std::string_view item = value.substr(0, n);
        value.remove_prefix(std::min(n + 1, value.size()));
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

bool bypasses_search_path(std::string_view name) {
    return name.starts_with("/") || name.starts_with("./") || name.starts_with("../");
}

std::vector<std::string> archive_candidates(const std::string& name,
                                            const std::vector<std::string>& directories,
                                            const std::vector<std::string>& readers) {
    std::vector<std::string> result;
    const auto add = [&](std::string path) {
        if (path.starts_with("./")) {
            path.erase(0, 2);
        }
        if (std::find(result.begin(), result.end(), path) == result.end()) {
            result.push_back(std::move(path));
        }
    };
    if (!bypasses_search_path(name)) {
        for (const std::string& directory : directories) {
            add(directory + "/" + name);
        }
    }
    add(name);
    for (const std::string& path : readers) {
        const std::size_t slash = path.rfind('/');
        if (slash != std::string::npos && !name.starts_with("/")) {
            add(path.substr(0, slash + 1) + name);
        }
    }
    return result;
}

} // namespace rib
