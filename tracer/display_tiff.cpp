// SPDX-License-Identifier: Apache-2.0
// TIFF 6.0 through libtiff: 8, 16 and 32 bit integers and floats, premultiplied alpha, depth as an
// extra sample. The place of a crop is recorded as Photoshop and others do (XPosition, YPosition),
// and in Pixar's tags with the camera.
#include "tracer/display_tiff.h"

#include "tracer/display_format.h"

#include <algorithm>
#include <cstdarg>
#include <cstdint>
#include <cstdio>

namespace trace {

namespace {

constexpr std::size_t strip_bytes = 1 << 16;

struct TiffCompression {
    const char* name;
    std::uint16_t scheme;
};
constexpr TiffCompression compressions[] = {
    {"lzw", COMPRESSION_LZW}, // first: the default
    {"zip", COMPRESSION_ADOBE_DEFLATE}, {"deflate", COMPRESSION_ADOBE_DEFLATE},
    {"packbits", COMPRESSION_PACKBITS}, {"none", COMPRESSION_NONE},
};

// --- libtiff's callbacks

OutputFile& output(thandle_t handle) {
    return *static_cast<OutputFile*>(handle);
}

tmsize_t on_read(thandle_t handle, void* bytes, tmsize_t count) {
    return static_cast<tmsize_t>(output(handle).read(bytes, static_cast<std::size_t>(count)));
}

tmsize_t on_write(thandle_t handle, void* bytes, tmsize_t count) {
    return output(handle).write(bytes, static_cast<std::size_t>(count)) ? count : -1;
}

toff_t on_seek(thandle_t handle, toff_t offset, int whence) {
    OutputFile& file = output(handle);
    const std::uint64_t base = whence == SEEK_CUR   ? file.position()
                               : whence == SEEK_END ? file.size()
                                                    : 0;
    return file.seek(base + offset) ? file.position() : static_cast<toff_t>(-1);
}

int on_close(thandle_t) {
    return 0;
}
toff_t on_size(thandle_t handle) {
    return output(handle).size();
}

// Keeps the first error; libtiff says the rest in other words.
int on_error(TIFF*, void* user, const char*, const char* format, va_list arguments) {
    auto& text = *static_cast<std::string*>(user);
    if (text.empty()) {
        char line[256];
        std::vsnprintf(line, sizeof line, format, arguments);
        text = line;
    }
    return 1; // handled: nothing goes to standard error
}

int on_warning(TIFF*, void*, const char*, const char*, va_list) {
    return 1;
}

struct OptionsFree {
    void operator()(TIFFOpenOptions* o) const { TIFFOpenOptionsFree(o); }
};

} // namespace

void TiffCloser::operator()(TIFF* t) const {
    TIFFClose(t);
}

TiffHandle open_tiff_output(OutputFile& file, std::string& error) {
    const std::unique_ptr<TIFFOpenOptions, OptionsFree> options(TIFFOpenOptionsAlloc());
    TIFFOpenOptionsSetErrorHandlerExtR(options.get(), on_error, &error);
    TIFFOpenOptionsSetWarningHandlerExtR(options.get(), on_warning, nullptr);
    return TiffHandle(TIFFClientOpenExt(file.path().c_str(), "wl", &file, on_read, on_write,
                                        on_seek, on_close, on_size, nullptr, nullptr,
                                        options.get()));
}

TiffHandle open_tiff_input(const std::string& path, std::string& error) {
    const std::unique_ptr<TIFFOpenOptions, OptionsFree> options(TIFFOpenOptionsAlloc());
    TIFFOpenOptionsSetErrorHandlerExtR(options.get(), on_error, &error);
    TIFFOpenOptionsSetWarningHandlerExtR(options.get(), on_warning, nullptr);
    return TiffHandle(TIFFOpenExt(path.c_str(), "r", options.get()));
}

void set_tiff_size(TIFF* t, const PixelRange& pixels, std::size_t row_bytes) {
    const std::size_t rows =
        std::max<std::size_t>(1, strip_bytes / std::max<std::size_t>(row_bytes, 1));
    TIFFSetField(t, TIFFTAG_IMAGEWIDTH, static_cast<std::uint32_t>(pixels.width()));
    TIFFSetField(t, TIFFTAG_IMAGELENGTH, static_cast<std::uint32_t>(pixels.height()));
    TIFFSetField(t, TIFFTAG_ROWSPERSTRIP, static_cast<std::uint32_t>(rows));
}

void set_tiff_position(TIFF* t, const PixelRange& pixels, const float resolution[2]) {
    TIFFSetField(t, TIFFTAG_XPOSITION, static_cast<float>(pixels.x0) / resolution[0]);
    TIFFSetField(t, TIFFTAG_YPOSITION, static_cast<float>(pixels.y0) / resolution[1]);
}

namespace {

// --- tags

std::uint16_t sample_format(Storage storage) {
    return storage == Storage::Float ? SAMPLEFORMAT_IEEEFP
           : storage_signed(storage) ? SAMPLEFORMAT_INT
                                     : SAMPLEFORMAT_UINT;
}

void set_layout(TIFF* t, const FilePicture& p) {
    const bool rgb = p.count(ChannelRole::Color) == 3;
    TIFFSetField(t, TIFFTAG_SAMPLESPERPIXEL, static_cast<std::uint16_t>(p.channels.size()));
    TIFFSetField(t, TIFFTAG_BITSPERSAMPLE,
                 static_cast<std::uint16_t>(8 * storage_bytes(p.storage)));
    TIFFSetField(t, TIFFTAG_SAMPLEFORMAT, sample_format(p.storage));
    TIFFSetField(t, TIFFTAG_PHOTOMETRIC, rgb ? PHOTOMETRIC_RGB : PHOTOMETRIC_MINISBLACK);
    TIFFSetField(t, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
    TIFFSetField(t, TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
    std::vector<std::uint16_t> extra;
    for (std::size_t c = rgb ? 3 : 1; c < p.channels.size(); ++c) {
        extra.push_back(p.channels[c].role == ChannelRole::Alpha ? EXTRASAMPLE_ASSOCALPHA
                                                                 : EXTRASAMPLE_UNSPECIFIED);
    }
    if (!extra.empty()) {
        TIFFSetField(t, TIFFTAG_EXTRASAMPLES, static_cast<std::uint16_t>(extra.size()),
                     extra.data());
    }
    set_tiff_size(t, p.pixels, p.row_bytes());
}

// Returns a note when the name is not known.
std::string set_compression(TIFF* t, const FilePicture& p) {
    const TiffCompression* row = &compressions[0];
    std::string note;
    if (!p.compression.empty()) {
        const auto* found = std::find_if(std::begin(compressions), std::end(compressions),
                                         [&](const auto& c) { return p.compression == c.name; });
        if (found != std::end(compressions)) {
            row = found;
        } else {
            note = "TIFF knows no compression \"" + p.compression +
                   "\" (lzw, zip, packbits, none); lzw is used";
        }
    }
    TIFFSetField(t, TIFFTAG_COMPRESSION, row->scheme);
    if (row->scheme == COMPRESSION_LZW || row->scheme == COMPRESSION_ADOBE_DEFLATE) {
        TIFFSetField(t, TIFFTAG_PREDICTOR,
                     p.storage == Storage::Float ? PREDICTOR_FLOATINGPOINT : PREDICTOR_HORIZONTAL);
    }
    return note;
}

void set_matrix(TIFF* t, std::uint32_t tag, const base::Mat4& m) {
    float values[16];
    for (int i = 0; i < 16; ++i) {
        values[i] = static_cast<float>(m.m[i / 4][i % 4]);
    }
    TIFFSetField(t, tag, values);
}

void set_place(TIFF* t, const FilePicture& p) {
    const PictureInfo& info = p.info;
    TIFFSetField(t, TIFFTAG_SOFTWARE, "Perigee");
    TIFFSetField(t, TIFFTAG_XRESOLUTION, p.resolution[0]);
    TIFFSetField(t, TIFFTAG_YRESOLUTION, p.resolution[1]);
    TIFFSetField(t, TIFFTAG_RESOLUTIONUNIT, p.resolution_in_cm ? RESUNIT_CENTIMETER : RESUNIT_INCH);
    set_tiff_position(t, p.pixels, p.resolution);
    TIFFSetField(t, TIFFTAG_PIXAR_IMAGEFULLWIDTH, static_cast<std::uint32_t>(info.xres));
    TIFFSetField(t, TIFFTAG_PIXAR_IMAGEFULLLENGTH, static_cast<std::uint32_t>(info.yres));
    set_matrix(t, TIFFTAG_PIXAR_MATRIX_WORLDTOCAMERA, info.camera_from_world);
    set_matrix(t, TIFFTAG_PIXAR_MATRIX_WORLDTOSCREEN, screen_from_world(info));
}

} // namespace

WriteOutcome write_tiff(const FilePicture& picture, OutputFile& file) {
    WriteOutcome outcome;
    TiffHandle tiff = open_tiff_output(file, outcome.error);
    if (!tiff) {
        outcome.ok = false;
        return outcome;
    }
    set_layout(tiff.get(), picture);
    outcome.note = set_compression(tiff.get(), picture);
    set_place(tiff.get(), picture);
    const RowWriter rows(picture, false);
    std::vector<std::byte> row(picture.row_bytes());
    for (int y = 0; y < picture.height() && outcome.ok; ++y) {
        rows.put_row(y, row);
        outcome.ok = TIFFWriteScanline(tiff.get(), row.data(), static_cast<std::uint32_t>(y)) >= 0;
    }
    outcome.ok = outcome.ok && TIFFWriteDirectory(tiff.get()) != 0;
    tiff.reset(); // writes what is left
    outcome.ok = outcome.ok && outcome.error.empty() && file.error() == 0;
    return outcome;
}

} // namespace trace
