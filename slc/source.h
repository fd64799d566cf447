// SPDX-License-Identifier: Apache-2.0
// Where source text comes from: the files of one compilation, by index, with their lines for
// messages and column mapping. Index 0 is the main file. Included files are read from disk when one
// of their lines is first wanted.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace slc {

class Sources {
public:
    // Registers a file name; the same name gets the same index.
    std::uint32_t add(std::string_view name);
    void set_text(std::uint32_t file, std::string text);
    [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
    // One line without its end; "" when the file or line does not exist.
    [[nodiscard]] std::string_view line(std::uint32_t file, std::uint32_t line);

private:
    struct File {
        bool loaded = false;
        std::string text;
        std::vector<std::string_view> lines;
    };
    void load(File& file, const std::string& name);
    static void split(File& file);
    std::vector<std::string> names_;
    std::deque<File> files_;
};

// Reads a file of at most max_source_bytes; nullopt when it cannot be read or is larger.
[[nodiscard]] std::optional<std::string> read_source(const std::string& path);
constexpr std::size_t max_source_bytes = 16u << 20;

// LF line ends, without byte order mark and DOS end-of-file mark.
[[nodiscard]] std::string normalise_text(std::string_view text);

// Directory part of a path, "." if it has none.
[[nodiscard]] std::string directory_of(std::string_view path);

} // namespace slc
