// SPDX-License-Identifier: Apache-2.0
#include "slc/source.h"

#include <algorithm>
#include <cstdio>
#include <memory>

namespace slc {

std::uint32_t Sources::add(std::string_view name) {
    const auto it = std::find(names_.begin(), names_.end(), name);
    if (it != names_.end()) {
        return static_cast<std::uint32_t>(it - names_.begin());
    }
    names_.emplace_back(name);
    files_.emplace_back();
    return static_cast<std::uint32_t>(names_.size() - 1);
}

void Sources::split(File& file) {
    file.loaded = true;
    std::string_view rest = file.text;
    while (!rest.empty()) {
        const std::size_t end = rest.find('\n');
        file.lines.push_back(rest.substr(0, end));
        rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
    }
}

void Sources::set_text(std::uint32_t file, std::string text) {
    files_[file].text = std::move(text);
    files_[file].lines.clear();
    split(files_[file]);
}

void Sources::load(File& file, const std::string& name) {
    if (auto text = read_source(name)) {
        file.text = normalise_text(*text);
    }
    split(file);
}

std::string_view Sources::line(std::uint32_t file, std::uint32_t line) {
    if (file >= files_.size() || line == 0) {
        return {};
    }
    if (!files_[file].loaded) {
        load(files_[file], names_[file]);
    }
    const auto& lines = files_[file].lines;
    return line <= lines.size() ? lines[line - 1] : std::string_view();
}

std::optional<std::string> read_source(const std::string& path) {
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> in(std::fopen(path.c_str(), "rb"),
                                                             std::fclose);
    if (!in) {
        return std::nullopt;
    }
    std::string text;
    char block[16384];
    std::size_t got = 0;
    while ((got = std::fread(block, 1, sizeof block, in.get())) > 0) {
        text.append(block, got);
        if (text.size() > max_source_bytes) {
            return std::nullopt;
        }
    }
    if (std::ferror(in.get()) != 0) { // a directory opens but does not read
        return std::nullopt;
    }
    return text;
}

std::string normalise_text(std::string_view text) {
    if (text.starts_with("\xef\xbb\xbf")) {
        text.remove_prefix(3);
    }
    while (!text.empty() && (text.back() == '\x1a' || text.back() == '\0')) {
        text.remove_suffix(1);
    }
    std::string out;
    out.reserve(text.size() + 1);
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '\r') {
            out += text[i];
        } else if (i + 1 == text.size() || text[i + 1] != '\n') {
            out += '\n';
        }
    }
    if (out.empty() || out.back() != '\n') {
        out += '\n';
    }
    return out;
}

std::string directory_of(std::string_view path) {
    const std::size_t slash = path.rfind('/');
    if (slash == std::string_view::npos) {
        return ".";
    }
    return std::string(path.substr(0, slash == 0 ? 1 : slash));
}

} // namespace slc
