// SPDX-License-Identifier: Apache-2.0
// The format (ar(5)): a magic line, then per member a header of 60 bytes of text and the content,
// padded to an even length. GNU ar ends names with '/'; names too long for the header stand in a
// member called "//" and are referred to as "/offset".
#include "runtime/base/ar_file.h"

#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fcntl.h>
#include <sys/stat.h>

namespace base {

namespace {

constexpr std::string_view magic = "!<arch>\n";
constexpr std::string_view header_end = "`\n";
constexpr std::size_t header_size = 60;
constexpr std::size_t name_width = 16, size_at = 48, size_width = 10;
constexpr std::size_t max_members = 1 << 20;
constexpr std::uint64_t max_name_table = 64U << 20;

bool read_at(int fd, std::uint64_t offset, char* to, std::size_t n) {
    while (n > 0) {
        const ssize_t got = ::pread(fd, to, n, static_cast<off_t>(offset));
        if (got < 0 && errno == EINTR) {
            continue;
        }
        if (got <= 0) {
            return false;
        }
        to += got;
        offset += static_cast<std::uint64_t>(got);
        n -= static_cast<std::size_t>(got);
    }
    return true;
}

std::string_view trimmed(std::string_view text) {
    const std::size_t last = text.find_last_not_of(' ');
    return text.substr(0, last == std::string_view::npos ? 0 : last + 1);
}

std::optional<std::uint64_t> number(std::string_view text) {
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size() ? std::optional(value)
                                                                    : std::nullopt;
}

// "name/" as it is, "/offset" from the table of long names; nullopt: neither.
std::optional<std::string> member_name(std::string_view field, std::string_view long_names) {
    if (!field.starts_with('/')) {
        return std::string(field.substr(0, field.find('/')));
    }
    const auto offset = number(field.substr(1));
    if (!offset || *offset >= long_names.size()) {
        return std::nullopt;
    }
    const std::string_view rest = long_names.substr(*offset);
    return std::string(rest.substr(0, rest.find_first_of("/\n")));
}

void append_header(std::string& out, std::string_view name, std::size_t size) {
    const auto field = [&out](std::string_view text, std::size_t width) {
        out += text;
        out.append(width - text.size(), ' ');
    };
    field(name, name_width);
    field("0", 12);     // time
    field("0", 6);      // owner
    field("0", 6);      // group
    field("100644", 8); // mode
    field(std::to_string(size), size_width);
    out += header_end;
}

void append_content(std::string& out, std::string_view content) {
    out += content;
    if (content.size() % 2 != 0) {
        out += '\n';
    }
}

} // namespace

std::unique_ptr<ArFile> ArFile::open(const std::string& path, std::string& why) {
    std::unique_ptr<ArFile> file(new ArFile);
    file->path_ = path;
    file->file_.reset(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
    struct stat info {};
    if (!file->file_.is_open() || ::fstat(file->file_.get(), &info) != 0) {
        why = std::string("cannot be read: ") + std::strerror(errno);
        return nullptr;
    }
    file->size_ = static_cast<std::uint64_t>(info.st_size);
    std::array<char, magic.size()> start{};
    if (!S_ISREG(info.st_mode) || !read_at(file->file_.get(), 0, start.data(), start.size()) ||
        std::string_view(start.data(), start.size()) != magic) {
        why = "is no archive of ar(1)";
        return nullptr;
    }
    return file->read_directory(why) ? std::move(file) : nullptr;
}

bool ArFile::read_directory(std::string& why) {
    std::string long_names;
    std::array<char, header_size> header{};
    const std::string_view text(header.data(), header.size());
    for (std::uint64_t at = magic.size(); at < size_;) {
        const bool whole = at + header_size <= size_ &&
                           read_at(file_.get(), at, header.data(), header.size()) &&
                           text.ends_with(header_end);
        const auto size = whole ? number(trimmed(text.substr(size_at, size_width))) : std::nullopt;
        at += header_size;
        if (!size || *size > size_ - at || members_.size() >= max_members) {
            why = "is truncated or damaged";
            return false;
        }
        const std::string_view field = trimmed(text.substr(0, name_width));
        const Extent extent{at, *size};
        at += *size + *size % 2;
        if (field == "/" || field == "/SYM64/") { // an index of symbols
            continue;
        }
        if (field == "//") {
            auto names = *size <= max_name_table ? read(extent) : std::nullopt;
            long_names = names ? std::move(*names) : std::string();
            continue;
        }
        const auto name = member_name(field, long_names);
        if (!name || name->empty()) {
            why = "has a member without a name";
            return false;
        }
        members_.emplace(*name, extent);
    }
    return true;
}

std::vector<std::string> ArFile::names() const {
    std::vector<std::string> all;
    for (const auto& [name, extent] : members_) {
        all.push_back(name);
    }
    return all;
}

std::optional<std::string> ArFile::read(const Extent& extent) const {
    std::string bytes(extent.size, '\0');
    return read_at(file_.get(), extent.offset, bytes.data(), bytes.size())
               ? std::optional(std::move(bytes))
               : std::nullopt;
}

std::optional<std::string> ArFile::read(std::string_view name) const {
    const auto it = members_.find(name);
    return it == members_.end() ? std::nullopt : read(it->second);
}

std::string ar_bytes(std::span<const std::pair<std::string, std::string>> members) {
    std::string long_names;
    std::vector<std::string> fields;
    for (const auto& [name, content] : members) {
        if (name.size() < name_width) {
            fields.push_back(name + "/");
        } else {
            fields.push_back("/" + std::to_string(long_names.size()));
            long_names += name + "/\n";
        }
    }
    std::string out(magic);
    if (!long_names.empty()) {
        append_header(out, "//", long_names.size());
        append_content(out, long_names);
    }
    for (std::size_t i = 0; i < members.size(); ++i) {
        append_header(out, fields[i], members[i].second.size());
        append_content(out, members[i].second);
    }
    return out;
}

} // namespace base
