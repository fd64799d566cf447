// SPDX-License-Identifier: Apache-2.0
#include "tracer/merge.h"

#include "runtime/base/output_file.h"
#include "tracer/camera.h"
#include "tracer/tile.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <new>
#include <vector>

namespace trace {

std::size_t TileInfo::row_bytes(std::size_t part, int width) const {
    std::size_t bytes = 0;
    for (const std::size_t plane : parts[part]) {
        bytes += plane * static_cast<std::size_t>(width);
    }
    return bytes;
}

namespace {

struct Magic {
    std::string_view bytes;
    OpenedTile (*open)(const std::string& path);
};
constexpr Magic formats[] = {
    {{"II*\0", 4}, open_tiff_tile},           {{"MM\0*", 4}, open_tiff_tile},
    {{"II+\0", 4}, open_tiff_tile},           {"\x89PNG", open_png_tile},
    {{"\x76\x2f\x31\x01", 4}, open_exr_tile},
};

std::string text_of(const PixelRange& r) {
    return "x " + std::to_string(r.x0) + " to " + std::to_string(r.x1 - 1) + ", y " +
           std::to_string(r.y0) + " to " + std::to_string(r.y1 - 1);
}

} // namespace

OpenedTile open_tile(const std::string& path) {
    std::array<char, 4> start{};
    std::FILE* file = std::fopen(path.c_str(), "rbe");
    if (file == nullptr) {
        return {nullptr, std::strerror(errno)};
    }
    const std::size_t count = std::fread(start.data(), 1, start.size(), file);
    std::fclose(file);
    for (const Magic& format : formats) {
        if (count == start.size() && format.bytes == std::string_view(start.data(), start.size())) {
            return format.open(path);
        }
    }
    return {nullptr, "is no TIFF, PNG or OpenEXR file"};
}

namespace {

struct Input {
    std::string path;
    PixelRange pixels;
    std::unique_ptr<Tile> tile; // open while its rows are read
};

class Merge {
public:
    Merge(std::span<const std::string> paths, base::Diag& diag) : diag_(diag) {
        for (const std::string& path : paths) {
            inputs_.push_back({path, {}, nullptr});
        }
    }

    // Reads what the tiles say; false after messages about those that do not fit.
    bool read_headers();
    bool covers(const PixelRange& whole);
    MergeResult write(const std::string& output, const PixelRange& whole);
    [[nodiscard]] const TileInfo& info() const { return model_->info(); }

private:
    class Rows;
    bool belongs(const Input& input, const TileInfo& info);
    bool covers_band(const PixelRange& band);
    bool error(const std::string& text) {
        diag_.report(base::Severity::Error, base::Code::BadFile, {}, "--merge: " + text);
        return false;
    }

    base::Diag& diag_;
    std::vector<Input> inputs_;
    std::unique_ptr<Tile> model_; // the first tile: the others are like it
};

bool Merge::read_headers() {
    bool good = true;
    for (Input& input : inputs_) {
        OpenedTile opened = open_tile(input.path);
        if (!opened.tile) {
            good = error(input.path + ": " + opened.error);
            continue;
        }
        input.pixels = opened.tile->info().pixels;
        if (!model_) {
            model_ = std::move(opened.tile);
        } else {
            good = belongs(input, opened.tile->info()) && good;
        }
    }
    if (model_ && !model_->info().note.empty()) {
        diag_.report(base::Severity::Warning, base::Code::Incapable, {},
                     "--merge: " + model_->info().note);
    }
    return good && model_;
}

bool Merge::belongs(const Input& input, const TileInfo& info) {
    const TileInfo& first = model_->info();
    const auto foreign = [&](const std::string& what) {
        return error(input.path + " does not belong to " + inputs_.front().path + ": " + what);
    };
    if (std::string(info.format) != first.format) {
        return foreign("it is a file of " + std::string(info.format) + ", not " + first.format);
    }
    if (info.xres != first.xres || info.yres != first.yres) {
        return foreign("it is part of a picture of " + std::to_string(info.xres) + " by " +
                       std::to_string(info.yres) + " pixels, not " + std::to_string(first.xres) +
                       " by " + std::to_string(first.yres));
    }
    for (const auto& [name, value] : first.facts) {
        const auto other = info.facts.find(name);
        if (other == info.facts.end() || other->second != value) {
            return foreign("its " + name + " differs");
        }
    }
    return info.parts == first.parts && info.facts.size() == first.facts.size()
               ? true
               : foreign("other channels");
}

// Between two neighbouring edges of tiles every row looks the same.
bool Merge::covers(const PixelRange& whole) {
    std::vector<int> edges = {whole.y0, whole.y1};
    bool good = true;
    for (const Input& input : inputs_) {
        if (input.pixels.intersected(whole) != input.pixels) {
            good = error(input.path + " (" + text_of(input.pixels) +
                         ") lies outside the picture (" + text_of(whole) + ")");
        }
        edges.push_back(input.pixels.y0);
        edges.push_back(input.pixels.y1);
    }
    std::ranges::sort(edges);
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    for (std::size_t i = 0; good && i + 1 < edges.size(); ++i) {
        good = covers_band({whole.x0, edges[i], whole.x1, edges[i + 1]});
    }
    return good;
}

bool Merge::covers_band(const PixelRange& band) {
    std::vector<const Input*> row;
    for (const Input& input : inputs_) {
        if (input.pixels.y0 <= band.y0 && input.pixels.y1 >= band.y1) {
            row.push_back(&input);
        }
    }
    std::ranges::sort(row, {}, [](const Input* input) { return input->pixels.x0; });
    const auto missing = [&](int x0, int x1) {
        return error("no tile has " + text_of({x0, band.y0, x1, band.y1}));
    };
    int at = band.x0;
    const Input* last = nullptr;
    for (const Input* input : row) {
        if (input->pixels.x0 < at && last != nullptr) {
            return error(last->path + " and " + input->path +
                         " overlap: " + text_of(last->pixels.intersected(input->pixels)));
        }
        if (input->pixels.x0 > at) {
            return missing(at, input->pixels.x0);
        }
        at = input->pixels.x1;
        last = input;
    }
    return at == band.x1 || missing(at, band.x1);
}

// Rows of the whole picture: those of the tiles beside each other. Files are open only while the
// row runs through them.
class Merge::Rows final : public RowSource {
public:
    Rows(std::vector<Input>& inputs, const TileInfo& info, const PixelRange& whole)
        : inputs_(inputs), info_(info), whole_(whole) {}

    std::string row(std::size_t part, int y, std::span<std::byte> out) override {
        const int y_frame = whole_.y0 + y;
        for (Input& input : inputs_) {
            if (y_frame < input.pixels.y0 || y_frame >= input.pixels.y1) {
                continue;
            }
            if (std::string why = add(input, part, y_frame - input.pixels.y0, out); !why.empty()) {
                tiles_are_bad = true;
                return input.path + ": " + why;
            }
        }
        return "";
    }

    bool tiles_are_bad = false;

private:
    std::string add(Input& input, std::size_t part, int y, std::span<std::byte> out) {
        if (!input.tile) {
            OpenedTile opened = open_tile(input.path);
            if (!opened.tile || opened.tile->info().pixels != input.pixels) {
                return opened.tile ? "was changed while it was read" : opened.error;
            }
            input.tile = std::move(opened.tile);
        }
        const auto width = static_cast<std::size_t>(input.pixels.width());
        piece_.resize(info_.row_bytes(part, input.pixels.width()));
        std::string why = input.tile->row(part, y, piece_);
        const auto left = static_cast<std::size_t>(input.pixels.x0 - whole_.x0);
        std::size_t from = 0, to = 0;
        for (const std::size_t bytes : info_.parts[part]) {
            std::memcpy(out.data() + to + left * bytes, piece_.data() + from, width * bytes);
            from += width * bytes;
            to += static_cast<std::size_t>(whole_.width()) * bytes;
        }
        if (y + 1 == input.pixels.height()) {
            input.tile.reset();
        }
        return why;
    }

    std::vector<Input>& inputs_;
    const TileInfo& info_;
    PixelRange whole_;
    std::vector<std::byte> piece_;
};

MergeResult Merge::write(const std::string& output, const PixelRange& whole) {
    base::OutputFile file(output);
    Rows rows(inputs_, info(), whole);
    std::string why = file.error() == 0 ? model_->write(whole, rows, file) : "";
    if (rows.tiles_are_bad) {
        error(why);
        return MergeResult::BadTiles;
    }
    if (why.empty() && file.error() == 0 && file.commit()) {
        return MergeResult::Written;
    }
    if (file.error() != 0) {
        why = std::strerror(file.error());
    }
    const bool full = file.error() == ENOSPC || file.error() == EDQUOT;
    diag_.report(base::Severity::Severe, full ? base::Code::DiskFull : base::Code::System, {},
                 "--merge: cannot write " + output + ": " + why);
    return MergeResult::Failed;
}

} // namespace

MergeResult merge_tiles(const std::string& output, std::span<const std::string> tiles,
                        const std::optional<std::array<float, 4>>& crop, base::Diag& diag) {
    try {
        Merge merge(tiles, diag);
        if (!merge.read_headers()) {
            return MergeResult::BadTiles;
        }
        PixelRange whole{0, 0, merge.info().xres, merge.info().yres};
        if (crop) {
            const CropSpan x = crop_span(whole.x1, (*crop)[0], (*crop)[1]);
            const CropSpan y = crop_span(whole.y1, (*crop)[2], (*crop)[3]);
            whole = {x.begin, y.begin, x.end, y.end};
        }
        return merge.covers(whole) ? merge.write(output, whole) : MergeResult::BadTiles;
    } catch (const std::bad_alloc&) {
        diag.report(base::Severity::Severe, base::Code::NoMem, {}, "--merge: out of memory");
        return MergeResult::Failed;
    }
}

} // namespace trace
