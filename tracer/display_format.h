// SPDX-License-Identifier: Apache-2.0
// Between display.cpp and the three format writers: what a file shall hold, chosen and checked
// already. A writer gets an open OutputFile, fills it and returns; it neither commits nor reports.
#pragma once

#include "runtime/base/output_file.h"
#include "tracer/display.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace trace {

using base::OutputFile;

enum class ChannelRole : std::uint8_t { Color, Alpha, Depth, Other };

struct FileChannel {
    std::string name; // R G B A Z, or of an output variable
    ChannelRole role = ChannelRole::Color;
    std::span<const float> values; // PixelRange of the file, row by row
    Quantizer quantizer;
    int dither_channel = 0;
};

enum class ExrPixelType : std::uint8_t { Half, Float };

struct FilePicture {
    PixelRange pixels;
    PictureInfo info;
    std::vector<FileChannel> channels;
    Storage storage = Storage::U8; // of all channels; OpenEXR has its own types
    std::string compression;       // as the request says; "" = the format's default
    ExrPixelType exr_type = ExrPixelType::Half;
    float resolution[2] = {72, 72}; // pixels per unit
    bool resolution_in_cm = false;

    [[nodiscard]] int width() const { return pixels.width(); }
    [[nodiscard]] int height() const { return pixels.height(); }
    [[nodiscard]] const FileChannel* find(ChannelRole role) const;
    [[nodiscard]] int count(ChannelRole role) const;
    [[nodiscard]] std::size_t row_bytes() const {
        return static_cast<std::size_t>(width()) * channels.size() *
               static_cast<std::size_t>(storage_bytes(storage));
    }
};

// What a writer says. `note`: something the user should know although the file is written.
struct WriteOutcome {
    bool ok = true;
    std::string error; // of the library; the file's own errno comes first
    std::string note;
};

// Rows of pixels in the storage type, channels interleaved, native byte order.
class RowWriter {
public:
    // alpha_divides: colors are divided by alpha first, for formats whose alpha is not
    // premultiplied.
    RowWriter(const FilePicture& picture, bool alpha_divides);
    // Row y, from 0; out holds row_bytes().
    void put_row(int y, std::span<std::byte> out) const;

private:
    [[nodiscard]] float value(const FileChannel& channel, std::size_t pixel) const;
    template <class T> void put_levels(int y, std::span<std::byte> out) const;
    void put_floats(int y, std::span<std::byte> out) const;

    const FilePicture& picture_;
    const FileChannel* alpha_;
    std::vector<Levels> levels_; // per channel
};

[[nodiscard]] WriteOutcome write_tiff(const FilePicture& picture, OutputFile& file);
[[nodiscard]] WriteOutcome write_png(const FilePicture& picture, OutputFile& file);
[[nodiscard]] WriteOutcome write_exr(const FilePicture& picture, OutputFile& file);

// A PNG in memory, 8 bits a channel; "" if it cannot be made (no pixels, no memory).
[[nodiscard]] std::string encode_png_rgb(int width, int height, std::span<const unsigned char> rgb);

} // namespace trace
