// SPDX-License-Identifier: Apache-2.0
// RIB in any form to requests to a Writer, without carrying them out: what catrib does.
//
// In: streams. Out: every request as it is written, and the comments. A comment inside a request
// moves behind it. Malformed requests are reported and left out, as the reader leaves them out.
#pragma once

#include "ribtools/reader.h"
#include "ribtools/rib_write.h"

#include <memory>
#include <string>
#include <string_view>

namespace rib {

struct ConvertOptions {
    // ReadArchive of a file is replaced by what the file holds. Inline archives stay as they are.
    bool expand = false;
};

class Converter {
public:
    Converter(Writer& writer, base::Diag& diag, ConvertOptions options);
    ~Converter();
    Converter(const Converter&) = delete;
    Converter& operator=(const Converter&) = delete;

    // "-" is standard input. Declarations persist from one stream to the next.
    ReadStatus convert_file(const std::string& path);
    ReadStatus convert_text(std::string_view text, std::string_view name);
    ReadStatus convert(std::unique_ptr<ByteSource> source, std::string_view name);

private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace rib
