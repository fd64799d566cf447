// SPDX-License-Identifier: Apache-2.0
// TIFF tiles: fields are copied as they are, save those that depend on the size and the place.
#include "tracer/display_tiff.h"
#include "tracer/tile.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace trace {

namespace {

enum class Kind : std::uint8_t { Short, Long, Float, Text, Matrix, ShortList };

struct Field {
    std::uint32_t tag;
    Kind kind;
    const char* name;
};
// In the order in which they are set: the predictor belongs to the compression.
constexpr Field fields[] = {
    {TIFFTAG_SAMPLESPERPIXEL, Kind::Short, "number of channels"},
    {TIFFTAG_BITSPERSAMPLE, Kind::Short, "bits per channel"},
    {TIFFTAG_SAMPLEFORMAT, Kind::Short, "type of channels"},
    {TIFFTAG_PHOTOMETRIC, Kind::Short, "meaning of channels"},
    {TIFFTAG_PLANARCONFIG, Kind::Short, "layout of channels"},
    {TIFFTAG_ORIENTATION, Kind::Short, "orientation"},
    {TIFFTAG_EXTRASAMPLES, Kind::ShortList, "extra channels"},
    {TIFFTAG_COMPRESSION, Kind::Short, "compression"},
    {TIFFTAG_PREDICTOR, Kind::Short, "predictor"},
    {TIFFTAG_SOFTWARE, Kind::Text, "software"},
    {TIFFTAG_IMAGEDESCRIPTION, Kind::Text, "description"},
    {TIFFTAG_XRESOLUTION, Kind::Float, "horizontal resolution"},
    {TIFFTAG_YRESOLUTION, Kind::Float, "vertical resolution"},
    {TIFFTAG_RESOLUTIONUNIT, Kind::Short, "unit of the resolution"},
    {TIFFTAG_PIXAR_IMAGEFULLWIDTH, Kind::Long, "width of the frame"},
    {TIFFTAG_PIXAR_IMAGEFULLLENGTH, Kind::Long, "height of the frame"},
    {TIFFTAG_PIXAR_MATRIX_WORLDTOCAMERA, Kind::Matrix, "matrix from world to camera"},
    {TIFFTAG_PIXAR_MATRIX_WORLDTOSCREEN, Kind::Matrix, "matrix from world to screen"},
};

template <class T> std::string bytes_of(const T* values, std::size_t count) {
    return {reinterpret_cast<const char*>(values), count * sizeof(T)};
}

template <class T> T value_of(const std::string& bytes) {
    T value{};
    std::memcpy(&value, bytes.data(), std::min(sizeof value, bytes.size()));
    return value;
}

template <class T> std::string get_one(TIFF* t, std::uint32_t tag) {
    T value{};
    return TIFFGetField(t, tag, &value) != 0 ? bytes_of(&value, 1) : "";
}

// "" if the file has no such field.
std::string get(TIFF* t, const Field& field) {
    switch (field.kind) {
    case Kind::Short:
        return get_one<std::uint16_t>(t, field.tag);
    case Kind::Long:
        return get_one<std::uint32_t>(t, field.tag);
    case Kind::Float:
        return get_one<float>(t, field.tag);
    case Kind::Text: {
        const char* text = nullptr;
        return TIFFGetField(t, field.tag, &text) != 0 && text != nullptr ? text : "";
    }
    case Kind::Matrix: {
        const float* values = nullptr;
        return TIFFGetField(t, field.tag, &values) != 0 ? bytes_of(values, 16) : "";
    }
    case Kind::ShortList: {
        std::uint16_t count = 0;
        const std::uint16_t* values = nullptr;
        return TIFFGetField(t, field.tag, &count, &values) != 0 ? bytes_of(values, count) : "";
    }
    }
    return "";
}

void set(TIFF* t, const Field& field, const std::string& bytes) {
    if (bytes.empty()) {
        return;
    }
    switch (field.kind) {
    case Kind::Short:
        TIFFSetField(t, field.tag, value_of<std::uint16_t>(bytes));
        return;
    case Kind::Long:
        TIFFSetField(t, field.tag, value_of<std::uint32_t>(bytes));
        return;
    case Kind::Float:
        TIFFSetField(t, field.tag, static_cast<double>(value_of<float>(bytes)));
        return;
    case Kind::Text:
        TIFFSetField(t, field.tag, bytes.c_str());
        return;
    case Kind::Matrix:
        TIFFSetField(t, field.tag, value_of<std::array<float, 16>>(bytes).data());
        return;
    case Kind::ShortList: {
        std::vector<std::uint16_t> values(bytes.size() / sizeof(std::uint16_t));
        std::memcpy(values.data(), bytes.data(), values.size() * sizeof values[0]);
        TIFFSetField(t, field.tag, static_cast<std::uint16_t>(values.size()), values.data());
        return;
    }
    }
}

class TiffTile final : public Tile {
public:
    std::string open(const std::string& path);
    std::string row(std::size_t part, int y, std::span<std::byte> out) override;
    std::string write(const PixelRange& pixels, RowSource& rows, base::OutputFile& file) override;

private:
    std::string read_place();

    std::string error_; // of the library; outlives the handle
    TiffHandle tiff_;
    float resolution_[2] = {72, 72};
};

std::string TiffTile::open(const std::string& path) {
    info_.format = "TIFF";
    tiff_ = open_tiff_input(path, error_);
    if (!tiff_) {
        return error_.empty() ? "cannot be read" : error_;
    }
    for (const Field& field : fields) {
        info_.facts[field.name] = get(tiff_.get(), field);
    }
    if (TIFFIsTiled(tiff_.get()) != 0 ||
        value_of<std::uint16_t>(info_.facts["layout of channels"]) != PLANARCONFIG_CONTIG) {
        return "is no TIFF of this renderer: it is tiled or has separate planes";
    }
    return read_place();
}

std::string TiffTile::read_place() {
    TIFF* t = tiff_.get();
    std::uint32_t width = 0, height = 0, xres = 0, yres = 0;
    float x = 0, y = 0;
    const bool complete = TIFFGetField(t, TIFFTAG_IMAGEWIDTH, &width) != 0 &&
                          TIFFGetField(t, TIFFTAG_IMAGELENGTH, &height) != 0 &&
                          TIFFGetField(t, TIFFTAG_PIXAR_IMAGEFULLWIDTH, &xres) != 0 &&
                          TIFFGetField(t, TIFFTAG_PIXAR_IMAGEFULLLENGTH, &yres) != 0 &&
                          TIFFGetField(t, TIFFTAG_XPOSITION, &x) != 0 &&
                          TIFFGetField(t, TIFFTAG_YPOSITION, &y) != 0 &&
                          TIFFGetField(t, TIFFTAG_XRESOLUTION, &resolution_[0]) != 0 &&
                          TIFFGetField(t, TIFFTAG_YRESOLUTION, &resolution_[1]) != 0;
    constexpr std::uint32_t limit = 1U << 30;
    const double x0 = std::round(static_cast<double>(x) * static_cast<double>(resolution_[0]));
    const double y0 = std::round(static_cast<double>(y) * static_cast<double>(resolution_[1]));
    const bool sane = width < limit && height < limit && xres < limit && yres < limit &&
                      std::fabs(x0) < limit && std::fabs(y0) < limit;
    if (!complete || !sane) {
        return "does not say which part of a picture it is";
    }
    info_.xres = static_cast<int>(xres);
    info_.yres = static_cast<int>(yres);
    info_.pixels = {static_cast<int>(x0), static_cast<int>(y0),
                    static_cast<int>(x0) + static_cast<int>(width),
                    static_cast<int>(y0) + static_cast<int>(height)};
    const auto row_bytes = static_cast<std::size_t>(TIFFScanlineSize64(t));
    info_.parts = {{width > 0 ? row_bytes / width : 0}};
    return row_bytes == info_.row_bytes(0, info_.pixels.width()) ? "" : "has rows of odd length";
}

std::string TiffTile::row(std::size_t, int y, std::span<std::byte> out) {
    const int read = TIFFReadScanline(tiff_.get(), out.data(), static_cast<std::uint32_t>(y), 0);
    return read >= 0 ? "" : error_.empty() ? "row cannot be read" : error_;
}

std::string TiffTile::write(const PixelRange& pixels, RowSource& rows, base::OutputFile& file) {
    std::string error;
    TiffHandle out = open_tiff_output(file, error);
    if (!out) {
        return error;
    }
    for (const Field& field : fields) {
        set(out.get(), field, info_.facts[field.name]);
    }
    std::vector<std::byte> row(info_.row_bytes(0, pixels.width()));
    set_tiff_size(out.get(), pixels, row.size());
    set_tiff_position(out.get(), pixels, resolution_);
    for (int y = 0; y < pixels.height(); ++y) {
        if (std::string why = rows.row(0, y, row); !why.empty()) {
            return why;
        }
        if (TIFFWriteScanline(out.get(), row.data(), static_cast<std::uint32_t>(y), 0) < 0) {
            return error;
        }
    }
    const bool ok = TIFFWriteDirectory(out.get()) != 0;
    out.reset(); // writes what is left
    return ok || !error.empty() ? error : "the directory cannot be written";
}

} // namespace

OpenedTile open_tiff_tile(const std::string& path) {
    auto tile = std::make_unique<TiffTile>();
    std::string error = tile->open(path);
    return error.empty() ? OpenedTile{std::move(tile), ""} : OpenedTile{nullptr, std::move(error)};
}

} // namespace trace
