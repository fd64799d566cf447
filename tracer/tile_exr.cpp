// SPDX-License-Identifier: Apache-2.0
// OpenEXR tiles: the header is copied with another data window, channels stay what they are.
#include "tracer/display_exr.h"
#include "tracer/tile.h"

#include <exception>

namespace trace {

namespace {

std::size_t pixel_bytes(Imf::PixelType type) {
    return type == Imf::HALF ? 2 : 4;
}

bool has_loss(Imf::Compression compression) {
    return compression == Imf::B44_COMPRESSION || compression == Imf::B44A_COMPRESSION ||
           compression == Imf::DWAA_COMPRESSION || compression == Imf::DWAB_COMPRESSION;
}

// The value of an attribute as it stands in a file.
class TextStream final : public Imf::OStream {
public:
    TextStream() : Imf::OStream("attribute") {}
    void write(const char bytes[], int count) override {
        text.append(bytes, static_cast<std::size_t>(count));
    }
    std::uint64_t tellp() override { return text.size(); }
    void seekp(std::uint64_t) override {}
    std::string text;
};

PixelRange range_of(const Imath::Box2i& box) {
    return {box.min.x, box.min.y, box.max.x + 1, box.max.y + 1};
}

// One row of `pixels`, plane after plane, as the library addresses it.
Imf::FrameBuffer frame_buffer(const Imf::ChannelList& channels, const PixelRange& pixels, int y,
                              std::span<std::byte> row) {
    Imf::FrameBuffer frame;
    const auto width = static_cast<std::size_t>(pixels.width());
    for (auto c = channels.begin(); c != channels.end(); ++c) {
        const Imf::PixelType type = c.channel().type;
        const std::size_t size = pixel_bytes(type);
        frame.insert(c.name(),
                     Imf::Slice::Make(type, row.data(), Imath::V2i(pixels.x0, y),
                                      static_cast<std::int64_t>(width), 1, size, size * width));
        row = row.subspan(size * width);
    }
    return frame;
}

class ExrTile final : public Tile {
public:
    std::string open(const std::string& path);
    std::string row(std::size_t part, int y, std::span<std::byte> out) override;
    std::string write(const PixelRange& pixels, RowSource& rows, base::OutputFile& file) override;

private:
    std::string take_header(int part);
    template <class Out>
    std::string write_part(std::size_t part, const PixelRange& pixels, RowSource& rows, Out& out);

    bool is_multipart_ = false; // such a file may have one part only
    std::unique_ptr<Imf::MultiPartInputFile> file_;
};

std::string ExrTile::open(const std::string& path) {
    info_.format = "OpenEXR";
    try {
        is_multipart_ = Imf::isMultiPartOpenExrFile(path.c_str());
        file_ = std::make_unique<Imf::MultiPartInputFile>(path.c_str(), 0);
        for (int part = 0; part < file_->parts(); ++part) {
            if (std::string why = take_header(part); !why.empty()) {
                return why;
            }
        }
    } catch (const std::exception& e) {
        return e.what();
    }
    return info_.pixels.empty() ? "is empty" : "";
}

std::string ExrTile::take_header(int part) {
    const Imf::Header& header = file_->header(part);
    const PixelRange frame = range_of(header.displayWindow()), data = range_of(header.dataWindow());
    if (header.hasTileDescription() || (part > 0 && data != info_.pixels)) {
        return "is no OpenEXR file of this renderer: it has tiles of its own, or parts that differ";
    }
    info_.xres = frame.width();
    info_.yres = frame.height();
    info_.pixels = data;
    TileInfo::Planes& planes = info_.parts.emplace_back();
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
        planes.push_back(pixel_bytes(c.channel().type));
    }
    const std::string of = part > 0 ? " of part " + std::to_string(part + 1) : "";
    for (auto a = header.begin(); a != header.end(); ++a) {
        const std::string name = a.name();
        if (name != "dataWindow" && name != "chunkCount") {
            TextStream value;
            a.attribute().writeValueTo(value, 2); // 2: the file format's version
            info_.facts[name + of] = value.text;
        }
    }
    if (has_loss(header.compression())) {
        info_.note = "the compression of these files loses information: pixels near the edges of "
                     "tiles may differ a little from those of a picture rendered as a whole";
    }
    return "";
}

std::string ExrTile::row(std::size_t part, int y, std::span<std::byte> out) {
    const int y_frame = info_.pixels.y0 + y;
    try {
        Imf::InputPart in(*file_, static_cast<int>(part));
        in.setFrameBuffer(frame_buffer(in.header().channels(), info_.pixels, y_frame, out));
        in.readPixels(y_frame);
    } catch (const std::exception& e) {
        return e.what();
    }
    return "";
}

// Out: an OutputFile, or an OutputPart of one with many.
template <class Out>
std::string ExrTile::write_part(std::size_t part, const PixelRange& pixels, RowSource& rows,
                                Out& out) {
    std::vector<std::byte> row(info_.row_bytes(part, pixels.width()));
    for (int y = 0; y < pixels.height(); ++y) {
        if (std::string why = rows.row(part, y, row); !why.empty()) {
            return why;
        }
        out.setFrameBuffer(frame_buffer(out.header().channels(), pixels, pixels.y0 + y, row));
        out.writePixels(1);
    }
    return "";
}

std::string ExrTile::write(const PixelRange& pixels, RowSource& rows, base::OutputFile& file) {
    std::string why;
    try {
        std::vector<Imf::Header> headers;
        for (int part = 0; part < file_->parts(); ++part) {
            headers.push_back(file_->header(part));
            headers.back().dataWindow() = {{pixels.x0, pixels.y0}, {pixels.x1 - 1, pixels.y1 - 1}};
            headers.back().erase("chunkCount");
        }
        ExrStream stream(file);
        if (!is_multipart_) {
            headers.front().erase("type"); // added when it was read: plain files say none
            Imf::OutputFile out(stream, headers.front(), 0);
            return write_part(0, pixels, rows, out);
        }
        Imf::MultiPartOutputFile out(stream, headers.data(), static_cast<int>(headers.size()),
                                     false, 0);
        for (std::size_t part = 0; part < headers.size() && why.empty(); ++part) {
            Imf::OutputPart out_part(out, static_cast<int>(part));
            why = write_part(part, pixels, rows, out_part);
        }
    } catch (const std::exception& e) {
        return e.what();
    }
    return why; // what the destructor could not write is an error of the file
}

} // namespace

OpenedTile open_exr_tile(const std::string& path) {
    auto tile = std::make_unique<ExrTile>();
    std::string error = tile->open(path);
    return error.empty() ? OpenedTile{std::move(tile), ""} : OpenedTile{nullptr, std::move(error)};
}

} // namespace trace
