// SPDX-License-Identifier: Apache-2.0
// gzip in front of RIB streams (ri.md 3.1), by zlib; the only place that knows it.
//
// In: bytes of a source or for a sink. Out: the same, inflated or deflated, piece by piece: neither
// direction holds more than a block. Damaged data ends a stream with one error; so does data that
// inflates beyond all reason.
#pragma once

#include "ribtools/rib_output.h"
#include "ribtools/rib_source.h"

#include <memory>

namespace rib {

// Hands the source on as it is, or inflated if it begins as gzip does; one or several members.
[[nodiscard]] std::unique_ptr<ByteSource> open_gzip(std::unique_ptr<ByteSource> source);

// Deflates into the sink below.
[[nodiscard]] std::unique_ptr<ByteSink> gzip_sink(std::unique_ptr<ByteSink> below);

} // namespace rib
