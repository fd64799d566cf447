// SPDX-License-Identifier: Apache-2.0
// Where the bytes of a written RIB stream go: a file that appears when it is complete, standard
// output, memory. Errors stay until asked for, so that writers need not look after every byte.
#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace rib {

class ByteSink {
public:
    virtual ~ByteSink() = default;
    // False after a failure.
    virtual bool write(std::string_view bytes) = 0;
    // The stream is complete: what is buffered goes out, a file gets its name. False: see error().
    [[nodiscard]] virtual bool finish() = 0;
    // Why writing failed; empty if it did not.
    [[nodiscard]] virtual std::string error() const = 0;
};

// Without finish() no file appears.
[[nodiscard]] std::unique_ptr<ByteSink> file_sink(const std::string& path);
[[nodiscard]] std::unique_ptr<ByteSink> stdout_sink();
// Appends to the string, which must outlive the sink.
[[nodiscard]] std::unique_ptr<ByteSink> memory_sink(std::string& out);

} // namespace rib
