// SPDX-License-Identifier: Apache-2.0
// Files in one file: the archive format of ar(1), as GNU ar writes and lists it. Members are stored
// as they are, so a reader takes the few it needs without reading the rest. Untrusted: every size
// and name is checked against the file before it is used. Why ar: docs/design/shader-cache.md.
#pragma once

#include "runtime/base/descriptor.h"

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace base {

class ArFile {
public:
    // nullptr, with the reason in `why`, if it cannot be read or is no archive.
    static std::unique_ptr<ArFile> open(const std::string& path, std::string& why);

    [[nodiscard]] const std::string& path() const { return path_; }
    [[nodiscard]] bool contains(std::string_view name) const {
        return members_.find(name) != members_.end();
    }
    // Names in alphabetical order.
    [[nodiscard]] std::vector<std::string> names() const;
    // nullopt: no such member, or reading failed. Safe from any thread.
    [[nodiscard]] std::optional<std::string> read(std::string_view name) const;

private:
    struct Extent {
        std::uint64_t offset = 0, size = 0;
    };
    ArFile() = default;
    bool read_directory(std::string& why);
    [[nodiscard]] std::optional<std::string> read(const Extent& extent) const;

    std::string path_;
    Descriptor file_;
    std::uint64_t size_ = 0;
    std::map<std::string, Extent, std::less<>> members_;
};

// The bytes of an archive that holds these (name, content) pairs, the same for the same pairs: no
// times, no owners. Names must hold no '/' and no newline.
[[nodiscard]] std::string ar_bytes(std::span<const std::pair<std::string, std::string>> members);

} // namespace base
