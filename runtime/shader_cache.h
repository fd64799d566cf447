// SPDX-License-Identifier: Apache-2.0
// Compiled shaders kept between runs, by the hash of everything that made them. Several processes
// may use one directory at a time: objects appear by a rename, complete and sealed; a lock per
// object lets one process compile while the others wait. Least recently used objects go when the
// directory grows over its limit. A directory that cannot be written is still read. Layout and
// reasons: docs/shader_cache.md.
#pragma once

#include "runtime/base/file_lock.h"

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace rt {

// Where it is: $PERIGEE_CACHE, else $XDG_CACHE_HOME/perigee, else ~/.cache/perigee; "" when there
// is no place for it.
[[nodiscard]] std::string default_cache_dir();

constexpr std::uint64_t default_cache_bytes = std::uint64_t{512} << 20;
// "200M", "2G", "1000000": bytes; nullopt if it is no such thing.
[[nodiscard]] std::optional<std::uint64_t> parse_cache_size(std::string_view text);

class ShaderCache {
public:
    // directory "" or max_bytes 0: nothing is found and nothing kept.
    ShaderCache(std::string directory, std::uint64_t max_bytes);
    // Makes room if this run added something.
    ~ShaderCache();
    ShaderCache(const ShaderCache&) = delete;
    ShaderCache& operator=(const ShaderCache&) = delete;

    [[nodiscard]] bool is_on() const { return !directory_.empty(); }
    [[nodiscard]] const std::string& directory() const { return directory_; }

    // Where the object of a key is or would be.
    [[nodiscard]] std::string object_path(std::string_view key) const;
    // Keeps the object from being among the first to go.
    static void mark_used(const std::string& object_path);
    // For whoever makes this object; see FileLock. Nothing is held where nothing can be written.
    [[nodiscard]] base::FileLock lock(std::string_view key, const std::function<bool()>& give_up);
    // "" or why it is not kept.
    [[nodiscard]] std::string store(std::string_view key, std::string_view bytes);

    // Removes what was used least recently until the rest fits well into the limit, and what killed
    // processes left.
    void trim();

private:
    std::string directory_;
    std::uint64_t max_bytes_;
    std::atomic<std::uint64_t> bytes_added_{0};
};

} // namespace rt
