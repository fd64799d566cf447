// SPDX-License-Identifier: Apache-2.0
// Formats written by the module perigee_oiio: pixels go over as rows in the format's own numbers,
// the file's bytes come back. Nothing here names OpenImageIO.
#include "runtime/base/module.h"
#include "tracer/display_format.h"
#include "tracer/oiio_module.h"

#include <array>

namespace trace {

namespace {

std::array<float, 16> floats(const base::Mat4& m) {
    std::array<float, 16> out{};
    for (std::size_t i = 0; i < 16; ++i) {
        out[i] = static_cast<float>(m.m[i / 4][i % 4]);
    }
    return out;
}

std::vector<std::byte> all_rows(const FilePicture& p, bool alpha_divides) {
    const RowWriter rows(p, alpha_divides);
    std::vector<std::byte> pixels(p.row_bytes() * static_cast<std::size_t>(p.height()));
    for (int y = 0; y < p.height(); ++y) {
        rows.put_row(y, std::span(pixels).subspan(static_cast<std::size_t>(y) * p.row_bytes(),
                                                  p.row_bytes()));
    }
    return pixels;
}

int alpha_channel(const FilePicture& p) {
    for (std::size_t c = 0; c < p.channels.size(); ++c) {
        if (p.channels[c].role == ChannelRole::Alpha && p.channels.size() > 1) {
            return static_cast<int>(c);
        }
    }
    return -1;
}

int take_bytes(void* user, const void* bytes, std::size_t count) {
    return static_cast<base::OutputFile*>(user)->write(bytes, count) ? 1 : 0;
}

} // namespace

std::string oiio_missing() {
    return base::open_module("perigee_oiio", PERIGEE_OIIO_WRITE).error;
}

WriteOutcome write_oiio(const FilePicture& picture, const FormatRow& format, OutputFile& file) {
    const base::ModuleSymbol symbol = base::open_module("perigee_oiio", PERIGEE_OIIO_WRITE);
    if (symbol.address == nullptr) {
        return {false, symbol.error, ""};
    }
    const bool alpha_divides = format.alpha == FormatRow::Alpha::Straight;
    const std::vector<std::byte> pixels = all_rows(picture, alpha_divides);
    const std::array<float, 16> camera = floats(picture.info.camera_from_world),
                                screen = floats(screen_from_world(picture.info));
    const std::string suffix(format.suffix);
    perigee_oiio_picture p{};
    p.suffix = suffix.c_str();
    p.width = picture.width();
    p.height = picture.height();
    p.num_channels = static_cast<int>(picture.channels.size());
    p.x = picture.pixels.x0;
    p.y = picture.pixels.y0;
    p.frame_width = picture.info.xres;
    p.frame_height = picture.info.yres;
    p.bits = 8 * storage_bytes(picture.storage);
    p.alpha = alpha_channel(picture);
    p.alpha_divided = alpha_divides && p.alpha >= 0 ? 1 : 0;
    p.pixel_aspect = static_cast<float>(picture.info.pixel_aspect);
    p.compression = picture.compression.c_str();
    p.quality = picture.quality;
    p.camera_from_world = camera.data();
    p.screen_from_world = screen.data();
    p.pixels = pixels.data();
    char error[256] = {};
    const auto write = reinterpret_cast<perigee_oiio_write_function>(symbol.address);
    const bool good = write(&p, take_bytes, &file, error, sizeof error) != 0;
    return {good, error, ""};
}

} // namespace trace
