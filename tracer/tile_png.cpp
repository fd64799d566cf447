// SPDX-License-Identifier: Apache-2.0
// PNG tiles. libpng reports errors by longjmp: every call that may jump stands in a function that
// has nothing to destroy and sets the place to return to itself.
#include "tracer/display_png.h"
#include "tracer/tile.h"

#include <csetjmp>
#include <cstdio>
#include <cstring>

namespace trace {

namespace {

constexpr int largest_side = 1 << 30;

struct FileCloser {
    void operator()(std::FILE* f) const { std::fclose(f); }
};

class PngTile final : public Tile {
public:
    PngTile() = default;
    ~PngTile() override { png_destroy_read_struct(&png_, &header_, nullptr); }
    PngTile(const PngTile&) = delete;
    PngTile& operator=(const PngTile&) = delete;

    std::string open(const std::string& path);
    std::string row(std::size_t part, int y, std::span<std::byte> out) override;
    std::string write(const PixelRange& pixels, RowSource& rows, base::OutputFile& file) override;

private:
    bool read_header();
    bool read_row(png_bytep out);
    [[nodiscard]] std::string take_header();
    void take_place();
    [[nodiscard]] std::string problem(const char* fallback) const {
        return error_[0] != '\0' ? error_ : fallback;
    }
    [[noreturn]] static void on_error(png_structp png, png_const_charp text) {
        auto& tile = *static_cast<PngTile*>(png_get_error_ptr(png));
        std::snprintf(tile.error_, sizeof tile.error_, "%s", text);
        png_longjmp(png, 1);
    }
    static void on_warning(png_structp, png_const_charp) {}

    std::unique_ptr<std::FILE, FileCloser> file_;
    png_structp png_ = nullptr;
    png_infop header_ = nullptr;
    char error_[128] = {};
    PngLayout layout_;
};

std::string PngTile::open(const std::string& path) {
    info_.format = "PNG";
    file_.reset(std::fopen(path.c_str(), "rbe"));
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, on_error, on_warning);
    header_ = png_ != nullptr ? png_create_info_struct(png_) : nullptr;
    if (!file_ || header_ == nullptr || !read_header()) {
        return problem("cannot be read");
    }
    return take_header();
}

bool PngTile::read_header() {
    if (setjmp(png_jmpbuf(png_)) != 0) {
        return false;
    }
    png_init_io(png_, file_.get());
    png_read_info(png_, header_);
    if (png_get_bit_depth(png_, header_) == 16) {
        png_set_swap(png_);
    }
    return true;
}

// Nothing below jumps: the header is read.
std::string PngTile::take_header() {
    layout_.bits = png_get_bit_depth(png_, header_);
    layout_.color_type = png_get_color_type(png_, header_);
    const bool ours = (layout_.bits == 8 || layout_.bits == 16) &&
                      (layout_.color_type & PNG_COLOR_MASK_PALETTE) == 0 &&
                      png_get_interlace_type(png_, header_) == PNG_INTERLACE_NONE;
    const png_uint_32 width = png_get_image_width(png_, header_),
                      height = png_get_image_height(png_, header_);
    if (!ours || width > largest_side || height > largest_side) {
        return "is no PNG of this renderer";
    }
    layout_.dots_per_metre[0] = static_cast<int>(png_get_x_pixels_per_meter(png_, header_));
    layout_.dots_per_metre[1] = static_cast<int>(png_get_y_pixels_per_meter(png_, header_));
    layout_.pixels = {0, 0, static_cast<int>(width), static_cast<int>(height)};
    layout_.xres = layout_.pixels.x1;
    layout_.yres = layout_.pixels.y1;
    take_place();
    info_.pixels = layout_.pixels;
    info_.xres = layout_.xres;
    info_.yres = layout_.yres;
    info_.parts = {{png_pixel_bytes(layout_)}};
    info_.facts = {{"bits per channel", std::to_string(layout_.bits)},
                   {"channels", std::to_string(layout_.color_type)},
                   {"resolution", std::to_string(layout_.dots_per_metre[0]) + " " +
                                      std::to_string(layout_.dots_per_metre[1])},
                   {"compression", std::to_string(layout_.level)}};
    return "";
}

void PngTile::take_place() {
    png_textp texts = nullptr;
    int num_texts = 0, xres = 0, yres = 0, level = 0;
    png_get_text(png_, header_, &texts, &num_texts);
    for (int i = 0; i < num_texts; ++i) {
        if (std::strcmp(texts[i].key, png_tile_key) == 0 && texts[i].text != nullptr &&
            std::sscanf(texts[i].text, "%9d %9d %1d", &xres, &yres, &level) == 3) {
            layout_.xres = xres;
            layout_.yres = yres;
            layout_.level = level;
        }
    }
    png_int_32 x = 0, y = 0;
    int unit = 0;
    if (png_get_oFFs(png_, header_, &x, &y, &unit) != 0 && unit == PNG_OFFSET_PIXEL &&
        std::abs(x) < largest_side && std::abs(y) < largest_side) {
        layout_.pixels = {x, y, x + layout_.pixels.x1, y + layout_.pixels.y1};
    }
}

bool PngTile::read_row(png_bytep out) {
    if (setjmp(png_jmpbuf(png_)) != 0) {
        return false;
    }
    png_read_row(png_, out, nullptr);
    return true;
}

std::string PngTile::row(std::size_t, int, std::span<std::byte> out) {
    return read_row(reinterpret_cast<png_bytep>(out.data())) ? "" : problem("row cannot be read");
}

// Rows for the encoder; keeps the reason of a failure.
class Rows final : public PngRows {
public:
    explicit Rows(RowSource& source) : source_(source) {}
    bool row(int y, std::span<std::byte> out) override {
        error_ = source_.row(0, y, out);
        return error_.empty();
    }
    [[nodiscard]] const std::string& error() const { return error_; }

private:
    RowSource& source_;
    std::string error_;
};

std::string PngTile::write(const PixelRange& pixels, RowSource& rows, base::OutputFile& file) {
    PngLayout layout = layout_;
    layout.pixels = pixels;
    Rows source(rows);
    const std::string error = encode_png(layout, source, file);
    return source.error().empty() ? error : source.error();
}

} // namespace

OpenedTile open_png_tile(const std::string& path) {
    auto tile = std::make_unique<PngTile>();
    std::string error = tile->open(path);
    return error.empty() ? OpenedTile{std::move(tile), ""} : OpenedTile{nullptr, std::move(error)};
}

} // namespace trace
