// SPDX-License-Identifier: Apache-2.0
// OpenEXR: scan lines, channels half or float as planned, one part or one for each layer; the crop
// as data window in the frame's display window; worldToCamera, worldToNDC; alpha premultiplied.
// Values are not quantised. Single-threaded: the bytes repeat.
#include "tracer/display_exr.h"

#include "tracer/display_format.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <stdexcept>

namespace trace {

namespace {

constexpr int band_rows = 64; // converted and written at once

struct ExrCompression {
    const char* name;
    Imf::Compression scheme;
};
constexpr ExrCompression compressions[] = {
    {"zip", Imf::ZIP_COMPRESSION}, // first: the default
    {"zips", Imf::ZIPS_COMPRESSION}, {"piz", Imf::PIZ_COMPRESSION},
    {"rle", Imf::RLE_COMPRESSION},   {"pxr24", Imf::PXR24_COMPRESSION},
    {"b44", Imf::B44_COMPRESSION},   {"b44a", Imf::B44A_COMPRESSION},
    {"dwaa", Imf::DWAA_COMPRESSION}, {"dwab", Imf::DWAB_COMPRESSION},
    {"none", Imf::NO_COMPRESSION},
};

Imf::Compression compression_of(const FilePicture& p, std::string& note) {
    for (const ExrCompression& row : compressions) {
        if (p.compression == row.name) {
            return row.scheme;
        }
    }
    if (!p.compression.empty()) {
        note = "OpenEXR knows no compression \"" + p.compression +
               "\" (zip, zips, piz, rle, none ...); zip is used";
    }
    return compressions[0].scheme;
}

Imath::M44f matrix(const base::Mat4& m) {
    Imath::M44f out; // row vectors, as ours
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j) {
            out[i][j] = static_cast<float>(m.m[i][j]);
        }
    }
    return out;
}

Imf::PixelType pixel_type(const FileChannel& c) {
    return c.exr_type == ExrPixelType::Float ? Imf::FLOAT : Imf::HALF;
}

using ChannelList = std::vector<const FileChannel*>;

Imf::Header make_header(const FilePicture& p, const ChannelList& channels, std::string& note) {
    const Imath::Box2i frame({0, 0}, {p.info.xres - 1, p.info.yres - 1});
    const Imath::Box2i data({p.pixels.x0, p.pixels.y0}, {p.pixels.x1 - 1, p.pixels.y1 - 1});
    const auto number = [](double x) {
        return std::isfinite(x) ? static_cast<float>(x) : 0.0f; // odd projections
    };
    Imf::Header header(frame, data, number(p.info.pixel_aspect),
                       {number(p.info.window_center[0]), number(p.info.window_center[1])},
                       number(p.info.window_width));
    header.compression() = compression_of(p, note);
    Imf::addWorldToCamera(header, matrix(p.info.camera_from_world));
    Imf::addWorldToNDC(header, matrix(p.info.ndc_from_world));
    header.insert("software", Imf::StringAttribute("Perigee"));
    for (const FileChannel* c : channels) {
        header.channels().insert(c->name, Imf::Channel(pixel_type(*c)));
    }
    return header;
}

// Half has no room above 65504; infinity there would spread in every later filter.
half to_half(float value) {
    constexpr float largest = 65504;
    return half(std::clamp(value, -largest, largest));
}

// The rows of one channel as bytes of its pixel type.
struct Band {
    Imf::PixelType type;
    std::vector<half> halves;
    std::vector<float> floats;

    void fill(std::span<const float> values) {
        if (type == Imf::FLOAT) {
            floats.assign(values.begin(), values.end());
        } else {
            halves.resize(values.size());
            std::transform(values.begin(), values.end(), halves.begin(), to_half);
        }
    }
    // Imf addresses pixels by their place in the frame: base is where (0, 0) would be.
    Imf::Slice slice(const PixelRange& pixels, int first_row) {
        char* bytes = type == Imf::FLOAT ? reinterpret_cast<char*>(floats.data())
                                         : reinterpret_cast<char*>(halves.data());
        const std::size_t size = type == Imf::FLOAT ? sizeof(float) : sizeof(half);
        return Imf::Slice::Make(type, bytes, Imath::V2i(pixels.x0, first_row), pixels.width(),
                                band_rows, size, size * static_cast<std::size_t>(pixels.width()));
    }
};

// Out: an OutputFile, or an OutputPart of one with many.
template <class Out> void write_bands(const FilePicture& p, const ChannelList& channels, Out& out) {
    std::vector<Band> bands;
    for (const FileChannel* c : channels) {
        bands.push_back({pixel_type(*c), {}, {}});
    }
    const auto width = static_cast<std::size_t>(p.width());
    for (int row = 0; row < p.height(); row += band_rows) {
        const int rows = std::min(band_rows, p.height() - row);
        Imf::FrameBuffer frame;
        for (std::size_t c = 0; c < bands.size(); ++c) {
            bands[c].fill(channels[c]->values.subspan(static_cast<std::size_t>(row) * width,
                                                      static_cast<std::size_t>(rows) * width));
            frame.insert(channels[c]->name, bands[c].slice(p.pixels, p.pixels.y0 + row));
        }
        out.setFrameBuffer(frame);
        out.writePixels(rows);
    }
}

void write_one_part(const FilePicture& p, ExrStream& stream, std::string& note) {
    ChannelList channels;
    for (const FileChannel& c : p.channels) {
        channels.push_back(&c);
    }
    Imf::OutputFile out(stream, make_header(p, channels, note), 0);
    write_bands(p, channels, out);
}

// A part for the picture itself and one for every layer, in the order of the channels.
void write_parts(const FilePicture& p, ExrStream& stream, std::string& note) {
    std::vector<std::pair<std::string, ChannelList>> parts;
    for (const FileChannel& c : p.channels) {
        const std::string name = c.layer.empty() ? "rgba" : c.layer;
        auto part = std::ranges::find(parts, name, &std::pair<std::string, ChannelList>::first);
        if (part == parts.end()) {
            part = parts.insert(part, {name, {}});
        }
        part->second.push_back(&c);
    }
    std::vector<Imf::Header> headers;
    for (const auto& [name, channels] : parts) {
        headers.push_back(make_header(p, channels, note));
        headers.back().setName(name);
        headers.back().setType(Imf::SCANLINEIMAGE);
    }
    Imf::MultiPartOutputFile file(stream, headers.data(), static_cast<int>(headers.size()), false,
                                  0);
    for (std::size_t i = 0; i < parts.size(); ++i) {
        Imf::OutputPart out(file, static_cast<int>(i));
        write_bands(p, parts[i].second, out);
    }
}

} // namespace

WriteOutcome write_exr(const FilePicture& picture, OutputFile& file) {
    WriteOutcome outcome;
    try {
        ExrStream stream(file);
        if (picture.multipart) {
            write_parts(picture, stream, outcome.note);
        } else {
            write_one_part(picture, stream, outcome.note);
        }
    } catch (const std::exception& e) {
        outcome.ok = false;
        outcome.error = e.what();
    }
    // The destructor above writes the line table and swallows what it throws.
    outcome.ok = outcome.ok && file.error() == 0;
    return outcome;
}

} // namespace trace
