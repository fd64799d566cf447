// SPDX-License-Identifier: Apache-2.0
// Remembers the cache keys of sources that include other files, so that finding them again costs a
// few stat calls instead of a preprocessor. An entry holds for a request (a hash of path, options
// and tools) as long as every file read then is unchanged by size, inode and times, and every file
// that would have been read instead, had it existed, is still missing. Entries are sealed by their
// own hash; a damaged one is no entry.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace slc {

class KeyIndex {
public:
    // Files changed less than min_age before they are looked at are not trusted: they could change
    // again without their times showing it.
    explicit KeyIndex(std::string directory,
                      std::chrono::milliseconds min_age = std::chrono::seconds(2))
        : directory_(std::move(directory)), min_age_(min_age) {}

    [[nodiscard]] std::optional<std::string> find(std::string_view request) const;
    // Does nothing if the state of the files cannot be told from their times, or if it cannot be
    // written.
    void store(std::string_view request, std::string_view key,
               const std::vector<std::string>& files,
               const std::vector<std::string>& missing) const;

private:
    [[nodiscard]] std::string path_of(std::string_view request) const;

    std::string directory_;
    std::chrono::milliseconds min_age_;
};

// What a preprocessed text was made from.
struct Inclusions {
    std::vector<std::string> files;   // absolute paths, from its line markers
    std::vector<std::string> missing; // would have come before one of them
    bool is_certain = true; // false: the text may depend on more (dates, tests for existence)
};
[[nodiscard]] Inclusions inclusions(std::string_view preprocessed, const std::string& source,
                                    const std::vector<std::string>& include_dirs);

// The text with the directories of its line markers taken out: the same wherever it was made.
[[nodiscard]] std::string without_directories(std::string_view preprocessed);

} // namespace slc
