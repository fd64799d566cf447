// SPDX-License-Identifier: Apache-2.0
#include "ribtools/search_path.h"

#include <algorithm>

namespace rib {

std::vector<std::string> search_directories(const Options& options, const std::string& kind) {
    std::vector<std::string> result;
    for (const std::string& key : {kind, std::string("resource")}) {
        if (const auto it = options.search_paths.find(key); it != options.search_paths.end()) {
            result.insert(result.end(), it->second.begin(), it->second.end());
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
