// SPDX-License-Identifier: Apache-2.0
#include "runtime/shader_cache.h"

#include "runtime/base/file.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <limits>
#include <sys/stat.h>
#include <vector>

namespace rt {

namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

// Times of use are written again only when they are older than this: one write instead of
// thousands for a shader in daily use.
constexpr std::time_t use_grain_s = 3600;
// Temporary files and locks older than this belong to no living process.
constexpr auto leftover_age = 1h;
// A compiler ends after a minute of processor time; whoever holds a lock longer is stopped.
constexpr auto lock_patience = 120s;

struct CachedFile {
    fs::path path;
    std::uint64_t size = 0;
    fs::file_time_type used;
};

bool is_leftover_kind(const fs::path& path) {
    return path.extension() == ".tmp" || path.extension() == ".lock";
}

// Every file of the two levels; removes leftovers on the way.
std::vector<CachedFile> scan(const std::string& directory) {
    std::vector<CachedFile> files;
    std::error_code error;
    const auto now = fs::file_time_type::clock::now();
    for (const auto& folder : fs::directory_iterator(directory, error)) {
        std::error_code ignored;
        for (const auto& entry : fs::directory_iterator(folder.path(), ignored)) {
            std::error_code gone;
            CachedFile file{entry.path(), entry.file_size(gone), entry.last_write_time(gone)};
            if (gone) {
                continue;
            }
            if (!is_leftover_kind(file.path)) {
                files.push_back(std::move(file));
            } else if (now - file.used > leftover_age) {
                fs::remove(file.path, gone);
            }
        }
    }
    return files;
}

} // namespace

std::string default_cache_dir() {
    const auto variable = [](const char* name) {
        const char* value = std::getenv(name);
        return std::string(value ? value : "");
    };
    if (const std::string own = variable("PERIGEE_CACHE"); !own.empty()) {
        return own;
    }
    if (const std::string xdg = variable("XDG_CACHE_HOME"); !xdg.empty()) {
        return xdg + "/perigee";
    }
    const std::string home = variable("HOME");
    return home.empty() ? "" : home + "/.cache/perigee";
}

std::optional<std::uint64_t> parse_cache_size(std::string_view text) {
    constexpr std::string_view units = "KMGT";
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const std::string_view rest(end, static_cast<std::size_t>(text.data() + text.size() - end));
    if (error != std::errc() || rest.size() > 1) {
        return std::nullopt;
    }
    if (!rest.empty()) {
        const std::size_t unit =
            units.find(static_cast<char>(rest.front() & ~0x20)); // either case of a letter
        if (unit == std::string_view::npos) {
            return std::nullopt;
        }
        const unsigned shift = 10 * (static_cast<unsigned>(unit) + 1);
        if (value > std::numeric_limits<std::uint64_t>::max() >> shift) {
            return std::nullopt;
        }
        value <<= shift;
    }
    return value;
}

ShaderCache::ShaderCache(std::string directory, std::uint64_t max_bytes)
    : directory_(max_bytes > 0 ? std::move(directory) : std::string()), max_bytes_(max_bytes) {}

ShaderCache::~ShaderCache() {
    if (bytes_added_ > 0) {
        trim();
    }
}

// Two letters of the key name a folder, so that none gets too many entries.
std::string ShaderCache::object_path(std::string_view key) const {
    return directory_ + "/" + std::string(key.substr(0, 2)) + "/" + std::string(key.substr(2)) +
           ".slo";
}

void ShaderCache::mark_used(const std::string& object_path) {
    struct stat info {};
    const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
    if (::stat(object_path.c_str(), &info) == 0 && now - info.st_mtim.tv_sec > use_grain_s) {
        ::utimensat(AT_FDCWD, object_path.c_str(), nullptr, 0); // not allowed: no matter
    }
}

base::FileLock ShaderCache::lock(std::string_view key, const std::function<bool()>& give_up) {
    std::error_code error;
    const fs::path path = object_path(key);
    fs::create_directories(path.parent_path(), error);
    const auto end = std::chrono::steady_clock::now() + lock_patience;
    return {path.string() + ".lock",
            [&] { return (give_up && give_up()) || std::chrono::steady_clock::now() > end; }};
}

std::string ShaderCache::store(std::string_view key, std::string_view bytes) {
    std::error_code error;
    const fs::path path = object_path(key);
    fs::create_directories(path.parent_path(), error);
    std::string why = base::write_file_atomically(path.string(), bytes);
    // A run that adds much makes room before its end, too.
    if (why.empty() && (bytes_added_ += bytes.size()) > max_bytes_ / 8) {
        trim();
    }
    return why;
}

void ShaderCache::trim() {
    bytes_added_ = 0;
    // Another process that makes room does it for this one.
    const base::FileLock alone(directory_ + "/trim.lock", [] { return true; });
    if (!alone.is_held()) {
        return;
    }
    std::vector<CachedFile> files = scan(directory_);
    std::uint64_t total = 0;
    for (const CachedFile& file : files) {
        total += file.size;
    }
    if (total <= max_bytes_) {
        return;
    }
    std::sort(files.begin(), files.end(), [](const CachedFile& a, const CachedFile& b) {
        return a.used != b.used ? a.used < b.used : a.path < b.path;
    });
    const std::uint64_t goal = max_bytes_ - max_bytes_ / 10;
    for (const CachedFile& file : files) {
        if (total <= goal) {
            break;
        }
        std::error_code gone;
        fs::remove(file.path, gone);
        total -= file.size;
    }
}

} // namespace rt
