// SPDX-License-Identifier: Apache-2.0
// Where the bytes of a RIB stream come from: a file, standard input, memory. Read block by block,
// so that no stream is ever held whole. Files and standard input may be gzip-compressed, see
// rib_gzip.h.
#pragma once

#include <cstddef>
#include <memory>
#include <string>

namespace rib {

class ByteSource {
public:
    virtual ~ByteSource() = default;
    // Up to size bytes; 0 at the end or after a read error.
    virtual std::size_t read(char* buffer, std::size_t size) = 0;
    // How many bytes there are, if that is known and small: the reader's buffer need not be larger.
    [[nodiscard]] virtual std::size_t size_hint() const { return ~std::size_t{0}; }
    // Empty unless a read failed.
    [[nodiscard]] virtual const std::string& error() const = 0;
    // After a failure: the data is at fault, not the environment.
    [[nodiscard]] virtual bool is_damaged() const { return false; }
};

struct OpenResult {
    std::unique_ptr<ByteSource> source; // null: not opened
    std::string error;                  // why
};

// Asked while a read waits: true ends it as failed. Null: it waits as long as it takes.
using Interrupted = bool (*)();

// Directories and unreadable files are errors.
[[nodiscard]] OpenResult open_file(const std::string& path, Interrupted interrupted = nullptr);
// The same, for names that come from a RIB: regular files only, since a pipe or device could keep
// the reader waiting, or reading, for ever.
[[nodiscard]] OpenResult open_archive(const std::string& path);
[[nodiscard]] std::unique_ptr<ByteSource> open_stdin(Interrupted interrupted = nullptr);
// Keeps the text.
[[nodiscard]] std::unique_ptr<ByteSource> open_memory(std::shared_ptr<const std::string> text);

} // namespace rib
