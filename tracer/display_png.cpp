// SPDX-License-Identifier: Apache-2.0
// PNG through libpng: 8 and 16 bit grey, grey + alpha, RGB, RGBA. PNG's alpha is not premultiplied,
// so colors are divided by alpha here. libpng reports errors by longjmp: it stays inside run(),
// whose frame holds nothing to destroy.
#include "tracer/display_png.h"

#include "tracer/display_format.h"

#include <algorithm>
#include <cmath>
#include <csetjmp>
#include <cstdint>
#include <cstdio>

namespace trace {

namespace {

// Everything that must survive a longjmp lives here, outside run()'s frame.
struct Encoder {
    const PngLayout& layout;
    PngRows& rows;
    OutputFile& file;
    std::vector<std::byte> row;
    char error[128] = {};
    png_structp png = nullptr;
    png_infop info = nullptr;

    Encoder(const PngLayout& l, PngRows& r, OutputFile& f)
        : layout(l), rows(r), file(f),
          row(static_cast<std::size_t>(l.pixels.width()) * png_pixel_bytes(l)) {}
    ~Encoder() { png_destroy_write_struct(&png, &info); }
    Encoder(const Encoder&) = delete;
    Encoder& operator=(const Encoder&) = delete;
};

void on_write(png_structp png, png_bytep bytes, std::size_t count) {
    auto& encoder = *static_cast<Encoder*>(png_get_io_ptr(png));
    if (!encoder.file.write(bytes, count)) {
        png_error(png, "write failed");
    }
}

void on_flush(png_structp) {}

[[noreturn]] void on_error(png_structp png, png_const_charp text) {
    auto& encoder = *static_cast<Encoder*>(png_get_error_ptr(png));
    std::snprintf(encoder.error, sizeof encoder.error, "%s", text);
    png_longjmp(png, 1);
}

void on_warning(png_structp, png_const_charp) {}

void set_place(Encoder& e) {
    const PngLayout& l = e.layout;
    if (l.pixels.x0 != 0 || l.pixels.y0 != 0) {
        png_set_oFFs(e.png, e.info, l.pixels.x0, l.pixels.y0, PNG_OFFSET_PIXEL);
    }
    if (l.pixels == PixelRange{0, 0, l.xres, l.yres}) {
        return;
    }
    char key[sizeof png_tile_key], text[64];
    std::snprintf(key, sizeof key, "%s", png_tile_key);
    std::snprintf(text, sizeof text, "%d %d %d", l.xres, l.yres, l.level);
    png_text tile = {};
    tile.compression = PNG_TEXT_COMPRESSION_NONE;
    tile.key = key;
    tile.text = text;
    png_set_text(e.png, e.info, &tile, 1);
}

void set_header(Encoder& e) {
    const PngLayout& l = e.layout;
    png_set_IHDR(e.png, e.info, static_cast<png_uint_32>(l.pixels.width()),
                 static_cast<png_uint_32>(l.pixels.height()), l.bits, l.color_type,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_pHYs(e.png, e.info, static_cast<png_uint_32>(l.dots_per_metre[0]),
                 static_cast<png_uint_32>(l.dots_per_metre[1]), PNG_RESOLUTION_METER);
    set_place(e);
}

// True on success. No object with a destructor may be created here or in what it calls before
// libpng may jump.
bool run(Encoder& e) {
    if (setjmp(png_jmpbuf(e.png)) != 0) {
        return false;
    }
    png_set_write_fn(e.png, &e, on_write, on_flush);
    // Two filters and a lower level take a third of the time for a few per cent more bytes.
    png_set_compression_level(e.png, e.layout.level);
    png_set_filter(e.png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB | PNG_FILTER_UP);
    set_header(e);
    png_write_info(e.png, e.info);
    if (e.layout.bits == 16) {
        png_set_swap(e.png);
    }
    for (int y = 0; y < e.layout.pixels.height(); ++y) {
        if (!e.rows.row(y, e.row)) {
            return false;
        }
        png_write_row(e.png, reinterpret_cast<png_bytep>(e.row.data()));
    }
    png_write_end(e.png, e.info);
    return true;
}

// The quantised picture.
class PictureRows final : public PngRows {
public:
    explicit PictureRows(const FilePicture& picture) : writer_(picture, true) {}
    bool row(int y, std::span<std::byte> out) override {
        writer_.put_row(y, out);
        return true;
    }

private:
    RowWriter writer_;
};

PngLayout layout_of(const FilePicture& p) {
    const bool alpha = p.find(ChannelRole::Alpha) != nullptr && p.channels.size() > 1;
    const double per_metre = p.resolution_in_cm ? 100 : 100 / 2.54;
    const auto dots = [&](float r) {
        return static_cast<int>(std::lround(static_cast<double>(r) * per_metre));
    };
    return {.pixels = p.pixels,
            .xres = p.info.xres,
            .yres = p.info.yres,
            .bits = 8 * storage_bytes(p.storage),
            .color_type = (p.count(ChannelRole::Color) == 3 ? PNG_COLOR_MASK_COLOR : 0) |
                          (alpha ? PNG_COLOR_MASK_ALPHA : 0),
            .dots_per_metre = {dots(p.resolution[0]), dots(p.resolution[1])},
            .level = p.compression == "none" ? 0 : 4};
}

} // namespace

std::size_t png_pixel_bytes(const PngLayout& layout) {
    const std::size_t channels = (layout.color_type & PNG_COLOR_MASK_COLOR ? 3U : 1U) +
                                 (layout.color_type & PNG_COLOR_MASK_ALPHA ? 1U : 0U);
    return channels * static_cast<std::size_t>(layout.bits) / 8;
}

std::string encode_png(const PngLayout& layout, PngRows& rows, OutputFile& file) {
    Encoder encoder(layout, rows, file);
    encoder.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &encoder, on_error, on_warning);
    encoder.info = encoder.png != nullptr ? png_create_info_struct(encoder.png) : nullptr;
    if (encoder.info != nullptr && run(encoder)) {
        return "";
    }
    return encoder.error[0] != '\0' ? encoder.error : "not enough memory";
}

WriteOutcome write_png(const FilePicture& picture, OutputFile& file) {
    WriteOutcome outcome;
    PictureRows rows(picture);
    outcome.error = encode_png(layout_of(picture), rows, file);
    outcome.ok = outcome.error.empty();
    if (!picture.compression.empty() && picture.compression != "none" &&
        picture.compression != "zip") {
        outcome.note =
            "PNG knows no compression \"" + picture.compression + "\" (zip, none); zip is used";
    }
    return outcome;
}

std::string encode_png(int width, int height, std::span<const unsigned char> bytes) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = static_cast<png_uint_32>(std::max(width, 0));
    image.height = static_cast<png_uint_32>(std::max(height, 0));
    const std::size_t pixels = static_cast<std::size_t>(image.width) * image.height;
    if (pixels == 0 || (bytes.size() != 3 * pixels && bytes.size() != 4 * pixels)) {
        return {};
    }
    image.format = bytes.size() == 3 * pixels ? PNG_FORMAT_RGB : PNG_FORMAT_RGBA;
    image.flags = PNG_IMAGE_FLAG_FAST;
    std::string out(PNG_IMAGE_PNG_SIZE_MAX(image), '\0');
    png_alloc_size_t size = out.size();
    const int done =
        png_image_write_to_memory(&image, out.data(), &size, 0, bytes.data(), 0, nullptr);
    png_image_free(&image);
    out.resize(done != 0 ? size : 0);
    return out;
}

} // namespace trace
