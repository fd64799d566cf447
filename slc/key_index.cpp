// SPDX-License-Identifier: Apache-2.0
#include "slc/key_index.h"

#include "runtime/base/file.h"
#include "runtime/base/sha256.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <sys/stat.h>

namespace slc {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t max_entry_bytes = 1 << 20;

std::string time_text(const timespec& t) {
    return std::to_string(t.tv_sec) + "." + std::to_string(t.tv_nsec);
}

std::chrono::nanoseconds since_epoch(const timespec& t) {
    return std::chrono::seconds(t.tv_sec) + std::chrono::nanoseconds(t.tv_nsec);
}

// "size inode modified changed", "" if there is no such file.
std::string state_of(const struct stat& info) {
    return std::to_string(info.st_size) + " " + std::to_string(info.st_ino) + " " +
           time_text(info.st_mtim) + " " + time_text(info.st_ctim);
}

std::string state_of(const std::string& path) {
    struct stat info {};
    return ::stat(path.c_str(), &info) == 0 ? state_of(info) : "";
}

std::string_view take_line(std::string_view& text) {
    const std::size_t end = text.find('\n');
    const std::string_view line = text.substr(0, end);
    text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
    return line;
}

// The file a line marker ("# 12 "name" flags") names, as a range of the line; empty if it is none.
struct Marker {
    std::size_t begin = 0, end = 0;
};
Marker marker_in(std::string_view line) {
    if (!line.starts_with("# ")) {
        return {};
    }
    const std::size_t open = line.find_first_not_of("0123456789", 2);
    if (open == 2 || open == std::string_view::npos || !line.substr(open).starts_with(" \"")) {
        return {};
    }
    const std::size_t close = line.rfind('"');
    return close > open + 1 ? Marker{open + 2, close} : Marker{};
}

std::string unescaped(std::string_view text) {
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        i += text[i] == '\\' && i + 1 < text.size() ? 1 : 0;
        out += text[i];
    }
    return out;
}

std::string absolute(const std::string& path) {
    std::error_code error;
    const fs::path result = fs::absolute(path, error);
    return error ? path : result.string();
}

// What makes a text depend on more than the files its markers name.
bool is_self_contained(const std::string& path) {
    const auto text = base::read_file(path);
    if (!text) {
        return false;
    }
    constexpr std::string_view words[] = {"has_include", "include_next", "__DATE__", "__TIME__",
                                          "__TIMESTAMP__"};
    return std::none_of(std::begin(words), std::end(words), [&](std::string_view word) {
        return text->find(word) != std::string::npos;
    });
}

// A file found as DIRECTORY/NAME could have been found as OTHER/NAME: all places where it was not.
void add_missing(const std::string& file, const std::set<std::string>& directories,
                 std::set<std::string>& missing) {
    for (const std::string& directory : directories) {
        if (!file.starts_with(directory + "/")) {
            continue;
        }
        const std::string name = file.substr(directory.size());
        for (const std::string& other : directories) {
            if (std::string path = other + name; state_of(path).empty()) {
                missing.insert(std::move(path));
            }
        }
    }
}

} // namespace

std::string KeyIndex::path_of(std::string_view request) const {
    return directory_ + "/" + std::string(request.substr(0, 2)) + "/" +
           std::string(request.substr(2)) + ".key";
}

// Lines: hash of the rest; key; then "+state path" per file and "-path" per missing one.
std::optional<std::string> KeyIndex::find(std::string_view request) const {
    const auto bytes = base::read_file(path_of(request), max_entry_bytes);
    if (!bytes) {
        return std::nullopt;
    }
    std::string_view rest = *bytes;
    const std::string_view seal = take_line(rest);
    if (base::sha256_hex(rest) != seal) {
        return std::nullopt;
    }
    const std::string key(take_line(rest));
    while (!rest.empty()) {
        const std::string_view line = take_line(rest);
        const std::size_t tab = line.find('\t');
        const std::string path(line.substr(tab + 1));
        if (tab == std::string_view::npos || line.substr(0, tab) != state_of(path)) {
            return std::nullopt;
        }
    }
    return key;
}

void KeyIndex::store(std::string_view request, std::string_view key,
                     const std::vector<std::string>& files,
                     const std::vector<std::string>& missing) const {
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    std::string text = std::string(key) + "\n";
    for (const std::string& file : files) {
        struct stat info {};
        if (::stat(file.c_str(), &info) != 0 || file.find('\n') != std::string::npos ||
            now - std::max(since_epoch(info.st_mtim), since_epoch(info.st_ctim)) < min_age_) {
            return;
        }
        text += state_of(info) + "\t" + file + "\n";
    }
    for (const std::string& file : missing) {
        text += "\t" + file + "\n";
    }
    std::error_code error;
    const std::string path = path_of(request);
    fs::create_directories(fs::path(path).parent_path(), error);
    (void)base::write_file_atomically(path, base::sha256_hex(text) + "\n" + text);
}

Inclusions inclusions(std::string_view preprocessed, const std::string& source,
                      const std::vector<std::string>& include_dirs) {
    std::set<std::string> files = {absolute(source)};
    while (!preprocessed.empty()) {
        const std::string_view line = take_line(preprocessed);
        const Marker marker = marker_in(line);
        const std::string name = unescaped(line.substr(marker.begin, marker.end - marker.begin));
        if (!name.empty() && name.front() != '<') { // "<built-in>" and its like are no files
            files.insert(absolute(name));
        }
    }
    std::set<std::string> directories;
    for (const std::string& directory : include_dirs) {
        directories.insert(absolute(directory));
    }
    for (const std::string& file : files) {
        directories.insert(fs::path(file).parent_path().string());
    }
    Inclusions result;
    std::set<std::string> missing;
    for (const std::string& file : files) {
        result.is_certain = result.is_certain && is_self_contained(file);
        add_missing(file, directories, missing);
    }
    result.files.assign(files.begin(), files.end());
    result.missing.assign(missing.begin(), missing.end());
    return result;
}

std::string without_directories(std::string_view preprocessed) {
    std::string out;
    out.reserve(preprocessed.size());
    while (!preprocessed.empty()) {
        std::string_view line = take_line(preprocessed);
        const Marker marker = marker_in(line);
        const std::size_t slash = line.substr(0, marker.end).rfind('/');
        if (marker.end > 0 && slash != std::string_view::npos && slash > marker.begin) {
            out += line.substr(0, marker.begin);
            line.remove_prefix(slash + 1);
        }
        out += line;
        out += '\n';
    }
    return out;
}

} // namespace slc
