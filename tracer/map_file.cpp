// SPDX-License-Identifier: Apache-2.0
#include "tracer/map_file.h"

#include "tracer/display_tiff.h"
#include "tracer/zfile.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <fstream>

namespace trace {

namespace {

constexpr std::uint32_t tile_px = 64;
constexpr std::size_t max_images = 1024;

// --- reading TIFF

template <class T> T field(TIFF* t, std::uint32_t tag, T fallback) {
    T value = fallback;
    return TIFFGetFieldDefaulted(t, tag, &value) != 0 ? value : fallback;
}

std::string format_of(TIFF* t) {
    const char* text = nullptr;
    return TIFFGetField(t, TIFFTAG_PIXAR_TEXTUREFORMAT, &text) != 0 && text != nullptr ? text : "";
}

bool get_matrix(TIFF* t, std::uint32_t tag, float* out) {
    const float* values = nullptr;
    if (TIFFGetField(t, tag, &values) == 0 || values == nullptr) {
        return false;
    }
    std::copy_n(values, 16, out);
    return true;
}

struct Layout {
    std::uint32_t width = 0, height = 0, tile_width = 0, tile_height = 0;
    std::uint16_t channels = 1, bits = 8, format = SAMPLEFORMAT_UINT;
    bool tiled = false;
};

std::optional<Layout> layout_of(TIFF* t, std::string& error) {
    Layout l;
    TIFFGetField(t, TIFFTAG_IMAGEWIDTH, &l.width);
    TIFFGetField(t, TIFFTAG_IMAGELENGTH, &l.height);
    l.channels = field<std::uint16_t>(t, TIFFTAG_SAMPLESPERPIXEL, 1);
    l.bits = field<std::uint16_t>(t, TIFFTAG_BITSPERSAMPLE, 8);
    l.format = field<std::uint16_t>(t, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
    l.tiled = TIFFIsTiled(t) != 0;
    l.tile_width = l.width;
    l.tile_height = 1;
    if (l.tiled) {
        TIFFGetField(t, TIFFTAG_TILEWIDTH, &l.tile_width);
        TIFFGetField(t, TIFFTAG_TILELENGTH, &l.tile_height);
    }
    const std::uint64_t values = std::uint64_t{l.width} * l.height * l.channels;
    const bool fits = l.width > 0 && l.height > 0 && l.width < (1U << 16) &&
                      l.height < (1U << 16) && l.channels > 0 && l.channels <= 16 &&
                      values <= max_map_values && l.tile_width > 0 && l.tile_height > 0 &&
                      std::uint64_t{l.tile_width} * l.tile_height * l.channels <= max_map_values;
    const bool known = (l.format == SAMPLEFORMAT_IEEEFP && l.bits == 32) ||
                       (l.format == SAMPLEFORMAT_UINT && (l.bits == 8 || l.bits == 16));
    const bool together =
        field<std::uint16_t>(t, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG) == PLANARCONFIG_CONTIG;
    if (!fits || !known || !together) {
        error = !fits ? "its size cannot be right"
                      : "its numbers are of a kind that is not read (8, 16 bits or float)";
        return std::nullopt;
    }
    return l;
}

float number_at(const Layout& l, const unsigned char* bytes, std::size_t i) {
    if (l.format == SAMPLEFORMAT_IEEEFP) {
        float value;
        std::memcpy(&value, bytes + 4 * i, sizeof value);
        return value;
    }
    if (l.bits == 16) {
        std::uint16_t value;
        std::memcpy(&value, bytes + 2 * i, sizeof value);
        return static_cast<float>(value) / 65535.0f;
    }
    return static_cast<float>(bytes[i]) / 255.0f;
}

// The block whose upper left pixel is (x0, y0).
void put_block(const Layout& l, const std::vector<unsigned char>& bytes, std::uint32_t x0,
               std::uint32_t y0, MapImage& image) {
    const std::uint32_t columns = std::min(l.tile_width, l.width - x0);
    const std::uint32_t rows = std::min(l.tile_height, l.height - y0);
    for (std::uint32_t y = 0; y < rows; ++y) {
        const std::size_t from = std::size_t{y} * l.tile_width * l.channels;
        const std::size_t to = (std::size_t{y0 + y} * l.width + x0) * l.channels;
        for (std::size_t i = 0; i < std::size_t{columns} * l.channels; ++i) {
            image.values[to + i] = number_at(l, bytes.data(), from + i);
        }
    }
}

bool read_blocks(TIFF* t, const Layout& l, MapImage& image) {
    const tmsize_t size = l.tiled ? TIFFTileSize(t) : TIFFScanlineSize(t);
    const std::size_t least = std::size_t{l.tile_width} * l.tile_height * l.channels * l.bits / 8;
    if (size <= 0 || static_cast<std::size_t>(size) < least) {
        return false;
    }
    std::vector<unsigned char> bytes(static_cast<std::size_t>(size));
    for (std::uint32_t y = 0; y < l.height; y += l.tile_height) {
        for (std::uint32_t x = 0; x < l.width; x += l.tile_width) {
            const auto got = l.tiled ? TIFFReadTile(t, bytes.data(), x, y, 0, 0)
                                     : tmsize_t{TIFFReadScanline(t, bytes.data(), y, 0)};
            if (got < 0) {
                return false;
            }
            put_block(l, bytes, x, y, image);
        }
    }
    return true;
}

bool read_image(TIFF* t, MapImage& image, std::string& error) {
    const std::optional<Layout> l = layout_of(t, error);
    if (!l) {
        return false;
    }
    image.width = static_cast<int>(l->width);
    image.height = static_cast<int>(l->height);
    image.num_channels = l->channels;
    image.values.resize(std::size_t{l->width} * l->height * l->channels);
    image.has_matrices =
        get_matrix(t, TIFFTAG_PIXAR_MATRIX_WORLDTOCAMERA, image.camera_from_world) &&
        get_matrix(t, TIFFTAG_PIXAR_MATRIX_WORLDTOSCREEN, image.screen_from_world);
    float cot = 1;
    image.cot_half_fov = TIFFGetField(t, TIFFTAG_PIXAR_FOVCOT, &cot) != 0 && cot > 0 ? cot : 1.0f;
    if (!read_blocks(t, *l, image)) {
        error = error.empty() ? "it is damaged" : error;
        return false;
    }
    return true;
}

std::optional<MapFile> read_tiff(const std::string& path, std::string& error) {
    const TiffHandle t = open_tiff_input(path, error);
    if (!t) {
        error = error.empty() ? "it is no TIFF" : error;
        return std::nullopt;
    }
    MapFile map;
    map.format = format_of(t.get());
    std::size_t values = 0;
    do {
        // Smaller levels of a mip map are made again from the first one.
        std::uint32_t kind = 0;
        TIFFGetField(t.get(), TIFFTAG_SUBFILETYPE, &kind);
        if ((kind & FILETYPE_REDUCEDIMAGE) != 0) {
            continue;
        }
        MapImage image;
        if (!read_image(t.get(), image, error)) {
            return std::nullopt;
        }
        values += image.values.size();
        map.images.push_back(std::move(image));
    } while (values <= max_map_values && map.images.size() < max_images &&
             TIFFReadDirectory(t.get()) != 0);
    return map;
}

// --- reading zfiles

std::optional<MapFile> read_zfile(const std::string& path, std::string& error) {
    std::ifstream file(path, std::ios::binary);
    ZfileHeader header;
    if (!file.read(reinterpret_cast<char*>(&header), sizeof header)) {
        return std::nullopt;
    }
    const bool swapped = header.magic == swapped_zfile_magic;
    if (!swapped && header.magic != zfile_magic) {
        return std::nullopt;
    }
    swap_zfile_header(header, swapped);
    if (header.width <= 0 || header.height <= 0) {
        error = "its size cannot be right";
        return std::nullopt;
    }
    MapFile map{"zfile", {}};
    MapImage image;
    image.width = header.width;
    image.height = header.height;
    image.has_matrices = true;
    std::copy_n(header.camera_from_world, 16, image.camera_from_world);
    std::copy_n(header.screen_from_world, 16, image.screen_from_world);
    std::vector<float> row(static_cast<std::size_t>(image.width));
    for (int y = 0; y < image.height; ++y) { // row by row: the header may lie about the height
        if (!file.read(reinterpret_cast<char*>(row.data()),
                       static_cast<std::streamsize>(row.size() * sizeof(float)))) {
            error = "it ends too early";
            return std::nullopt;
        }
        swap_zfile_values(row, swapped);
        image.values.insert(image.values.end(), row.begin(), row.end());
    }
    map.images.push_back(std::move(image));
    return map;
}

// --- writing

void set_image_fields(TIFF* t, const MapFile& map, const MapImage& image) {
    TIFFSetField(t, TIFFTAG_IMAGEWIDTH, static_cast<std::uint32_t>(image.width));
    TIFFSetField(t, TIFFTAG_IMAGELENGTH, static_cast<std::uint32_t>(image.height));
    TIFFSetField(t, TIFFTAG_TILEWIDTH, tile_px);
    TIFFSetField(t, TIFFTAG_TILELENGTH, tile_px);
    TIFFSetField(t, TIFFTAG_SAMPLESPERPIXEL, image.num_channels);
    TIFFSetField(t, TIFFTAG_BITSPERSAMPLE, 32);
    TIFFSetField(t, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_IEEEFP);
    TIFFSetField(t, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
    TIFFSetField(t, TIFFTAG_PHOTOMETRIC,
                 image.num_channels >= 3 ? PHOTOMETRIC_RGB : PHOTOMETRIC_MINISBLACK);
    if (const int more = image.num_channels - (image.num_channels >= 3 ? 3 : 1); more > 0) {
        const std::vector<std::uint16_t> kinds(static_cast<std::size_t>(more),
                                               EXTRASAMPLE_UNSPECIFIED);
        TIFFSetField(t, TIFFTAG_EXTRASAMPLES, static_cast<std::uint16_t>(more), kinds.data());
    }
    TIFFSetField(t, TIFFTAG_COMPRESSION, COMPRESSION_ADOBE_DEFLATE);
    TIFFSetField(t, TIFFTAG_PREDICTOR, PREDICTOR_FLOATINGPOINT);
    TIFFSetField(t, TIFFTAG_SOFTWARE, "Perigee");
    TIFFSetField(t, TIFFTAG_PIXAR_TEXTUREFORMAT, map.format.c_str());
    if (image.has_matrices) {
        TIFFSetField(t, TIFFTAG_PIXAR_MATRIX_WORLDTOCAMERA, image.camera_from_world);
        TIFFSetField(t, TIFFTAG_PIXAR_MATRIX_WORLDTOSCREEN, image.screen_from_world);
    }
    if (map.format == cube_format) {
        TIFFSetField(t, TIFFTAG_PIXAR_FOVCOT, static_cast<double>(image.cot_half_fov));
    }
}

// Pixels beyond the picture repeat its last ones: a tile is full.
void fill_tile(const MapImage& image, std::uint32_t x0, std::uint32_t y0,
               std::vector<float>& tile) {
    const auto n = static_cast<std::size_t>(image.num_channels);
    for (std::uint32_t y = 0; y < tile_px; ++y) {
        const std::size_t row = std::min(y0 + y, static_cast<std::uint32_t>(image.height) - 1) *
                                static_cast<std::size_t>(image.width);
        for (std::uint32_t x = 0; x < tile_px; ++x) {
            const std::size_t column =
                std::min(x0 + x, static_cast<std::uint32_t>(image.width) - 1);
            std::copy_n(image.values.begin() + static_cast<std::ptrdiff_t>((row + column) * n), n,
                        tile.begin() + static_cast<std::ptrdiff_t>((y * tile_px + x) * n));
        }
    }
}

bool write_image(TIFF* t, const MapFile& map, const MapImage& image) {
    set_image_fields(t, map, image);
    std::vector<float> tile(std::size_t{tile_px} * tile_px *
                            static_cast<std::size_t>(image.num_channels));
    for (std::uint32_t y = 0; y < static_cast<std::uint32_t>(image.height); y += tile_px) {
        for (std::uint32_t x = 0; x < static_cast<std::uint32_t>(image.width); x += tile_px) {
            fill_tile(image, x, y, tile);
            if (TIFFWriteTile(t, tile.data(), x, y, 0, 0) < 0) {
                return false;
            }
        }
    }
    return TIFFWriteDirectory(t) != 0;
}

} // namespace

std::optional<std::string> map_file_format(const std::string& path) {
    std::string error;
    const TiffHandle t = open_tiff_input(path, error);
    return t ? std::optional<std::string>(format_of(t.get())) : std::nullopt;
}

std::optional<MapFile> read_map_file(const std::string& path, std::string& error) {
    error.clear();
    if (std::optional<MapFile> map = read_zfile(path, error); map || !error.empty()) {
        return map;
    }
    return read_tiff(path, error);
}

bool write_map_file(const MapFile& map, base::OutputFile& file, std::string& error) {
    const TiffHandle t = open_tiff_output(file, error);
    bool good = t != nullptr;
    for (const MapImage& image : map.images) {
        good = good && write_image(t.get(), map, image);
    }
    return good;
}

} // namespace trace
