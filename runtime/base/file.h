// SPDX-License-Identifier: Apache-2.0
// Whole files in and out. A file written here appears under its final name only when it is
// complete; failures are returned as text for the caller to report with its own place.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace base {

// nullopt: cannot be read, is no regular file, or is longer than max_bytes.
[[nodiscard]] std::optional<std::string> read_file(const std::string& path,
                                                   std::size_t max_bytes = std::size_t{1} << 30);

// All of it, whatever signals come; false with errno set if that fails.
[[nodiscard]] bool write_all(int fd, std::string_view bytes);

// A name in the same directory as `path`, unique among processes and threads.
[[nodiscard]] std::string temporary_beside(const std::string& path);

// Writes beside `path` and renames over it. Empty on success, otherwise why not.
[[nodiscard]] std::string write_file_atomically(const std::string& path, std::string_view bytes);

} // namespace base
