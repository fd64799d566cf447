// SPDX-License-Identifier: Apache-2.0
// Private to the TIFF files of this module: what rendered and merged pictures share, so that equal
// pixels become equal bytes.
#pragma once

#include "runtime/base/output_file.h"
#include "tracer/pixel_range.h"

#include <cstddef>
#include <memory>
#include <string>
#include <tiffio.h>

namespace trace {

struct TiffCloser {
    void operator()(TIFF* t) const;
};
using TiffHandle = std::unique_ptr<TIFF, TiffCloser>;

// `error` gets the library's first complaint; it and the file must outlive the handle.
[[nodiscard]] TiffHandle open_tiff_output(base::OutputFile& file, std::string& error);
[[nodiscard]] TiffHandle open_tiff_input(const std::string& path, std::string& error);

// The fields that differ between a picture and its tiles.
void set_tiff_size(TIFF* t, const PixelRange& pixels, std::size_t row_bytes);
void set_tiff_position(TIFF* t, const PixelRange& pixels, const float resolution[2]);

} // namespace trace
