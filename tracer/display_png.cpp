// SPDX-License-Identifier: Apache-2.0
// PNG through libpng: 8 and 16 bit grey, grey + alpha, RGB, RGBA. PNG's alpha is not premultiplied,
// so colors are divided by alpha here. libpng reports errors by longjmp: it stays inside run(),
// whose frame holds nothing to destroy.
#include "tracer/display_format.h"

#include <algorithm>
#include <cmath>
#include <csetjmp>
#include <cstdint>
#include <png.h>

namespace trace {

namespace {

// Everything that must survive a longjmp lives here, outside run()'s frame.
struct Encoder {
    const FilePicture& picture;
    OutputFile& file;
    RowWriter rows;
    std::vector<std::byte> row;
    char error[128] = {};
    png_structp png = nullptr;
    png_infop info = nullptr;

    Encoder(const FilePicture& p, OutputFile& f)
        : picture(p), file(f), rows(p, true), row(p.row_bytes()) {}
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

int color_type(const FilePicture& p) {
    const bool alpha = p.find(ChannelRole::Alpha) != nullptr && p.channels.size() > 1;
    return (p.count(ChannelRole::Color) == 3 ? PNG_COLOR_MASK_COLOR : 0) |
           (alpha ? PNG_COLOR_MASK_ALPHA : 0);
}

void set_header(Encoder& e) {
    const FilePicture& p = e.picture;
    png_set_IHDR(e.png, e.info, static_cast<png_uint_32>(p.width()),
                 static_cast<png_uint_32>(p.height()), 8 * storage_bytes(p.storage), color_type(p),
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    const double per_metre = p.resolution_in_cm ? 100 : 100 / 2.54;
    const auto dots = [&](float r) {
        return static_cast<png_uint_32>(std::lround(static_cast<double>(r) * per_metre));
    };
    png_set_pHYs(e.png, e.info, dots(p.resolution[0]), dots(p.resolution[1]), PNG_RESOLUTION_METER);
    if (p.pixels.x0 != 0 || p.pixels.y0 != 0) {
        png_set_oFFs(e.png, e.info, p.pixels.x0, p.pixels.y0, PNG_OFFSET_PIXEL);
    }
}

// True on success. No object with a destructor may be created here or in what it calls before
// libpng may jump.
bool run(Encoder& e) {
    if (setjmp(png_jmpbuf(e.png)) != 0) {
        return false;
    }
    png_set_write_fn(e.png, &e, on_write, on_flush);
    // Two filters and a lower level take a third of the time for a few per cent more bytes.
    png_set_compression_level(e.png, e.picture.compression == "none" ? 0 : 4);
    png_set_filter(e.png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB | PNG_FILTER_UP);
    set_header(e);
    png_write_info(e.png, e.info);
    if (storage_bytes(e.picture.storage) == 2) {
        png_set_swap(e.png);
    }
    for (int y = 0; y < e.picture.height(); ++y) {
        e.rows.put_row(y, e.row);
        png_write_row(e.png, reinterpret_cast<png_bytep>(e.row.data()));
    }
    png_write_end(e.png, e.info);
    return true;
}

} // namespace

WriteOutcome write_png(const FilePicture& picture, OutputFile& file) {
    WriteOutcome outcome;
    Encoder encoder(picture, file);
    encoder.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &encoder, on_error, on_warning);
    encoder.info = encoder.png != nullptr ? png_create_info_struct(encoder.png) : nullptr;
    outcome.ok = encoder.info != nullptr && run(encoder);
    if (!outcome.ok) {
        outcome.error = encoder.error[0] != '\0' ? encoder.error : "not enough memory";
    }
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
