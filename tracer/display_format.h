// SPDX-License-Identifier: Apache-2.0
// Between display.cpp and the format writers: what a file shall hold, chosen and checked
// already. A writer gets an open OutputFile, fills it and returns; it neither commits nor reports.
#pragma once

#include "runtime/base/output_file.h"
#include "tracer/display.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace trace {

using base::OutputFile;

struct FileChannel {
    std::string name, layer; // as in ShownChannel
    ChannelRole role = ChannelRole::Color;
    std::span<const float> values; // PixelRange of the file, row by row
    Quantizer quantizer;
    ExrPixelType exr_type = ExrPixelType::Half;
    int dither_channel = 0;
};

struct FilePicture {
    PixelRange pixels;
    PictureInfo info;
    std::vector<FileChannel> channels;
    Storage storage = Storage::U8;  // of all channels; OpenEXR has its own types
    std::string compression;        // as the request says; "" = the format's default
    bool multipart = false;         // OpenEXR: a part for every layer
    int quality = 90;               // of lossy compression, 0..100
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

// --- formats: display_formats.def

enum class Writer : std::uint8_t { Tiff, Png, Exr, Zfile, Shadow, Oiio };
struct FormatRow {
    enum class Numbers : std::uint8_t { Any, Byte, Word, Float };
    enum class Channels : std::uint8_t { Any, Picture, Rgb, Depth };
    enum class Alpha : std::uint8_t { None, Straight, Over };
    Writer writer;
    std::string_view suffix, types, suffixes;
    Numbers numbers;
    Channels channels;
    Alpha alpha;
    std::string_view name;
};
[[nodiscard]] std::span<const FormatRow> formats();
[[nodiscard]] const FormatRow& default_format();
[[nodiscard]] const FormatRow* format_of_type(std::string_view type);   // nullptr: not known
[[nodiscard]] const FormatRow* format_of_suffix(std::string_view path); // the same

// Leaves the channels the format holds, in numbers it holds. note: what was changed; or, where
// nothing fits, why.
struct FitResult {
    bool fits = true;
    std::string note;
};
[[nodiscard]] FitResult fit_picture(FilePicture& picture, const FormatRow& format);
// The type that holds every channel; float as soon as one is float.
[[nodiscard]] Storage common_storage(std::span<const FileChannel> channels);

[[nodiscard]] WriteOutcome write_tiff(const FilePicture& picture, OutputFile& file);
[[nodiscard]] WriteOutcome write_png(const FilePicture& picture, OutputFile& file);
[[nodiscard]] WriteOutcome write_exr(const FilePicture& picture, OutputFile& file);
[[nodiscard]] WriteOutcome write_zfile(const FilePicture& picture, OutputFile& file);
[[nodiscard]] WriteOutcome write_shadow_map(const FilePicture& picture, OutputFile& file);
[[nodiscard]] WriteOutcome write_oiio(const FilePicture& picture, const FormatRow& format,
                                      OutputFile& file);
// Why there is no OpenImageIO; "" if there is.
[[nodiscard]] std::string oiio_missing();

// A PNG in memory, 8 bits a channel, RGB or RGBA (not premultiplied) by the number of bytes; "" if
// it cannot be made (no pixels, no memory).
[[nodiscard]] std::string encode_png(int width, int height, std::span<const unsigned char> bytes);

} // namespace trace
