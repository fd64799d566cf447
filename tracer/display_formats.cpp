// SPDX-License-Identifier: Apache-2.0
// The table of file formats, and what of a picture fits into one.
#include "tracer/display_format.h"

#include <algorithm>
#include <cctype>

namespace trace {

namespace {

using Numbers = FormatRow::Numbers;
using Channels = FormatRow::Channels;
using Alpha = FormatRow::Alpha;

constexpr FormatRow rows[] = {
#define DISPLAY_FORMAT(writer, suffix, types, suffixes, numbers, channels, alpha, note)            \
    {Writer::writer,     #suffix,      types, suffixes, Numbers::numbers,                          \
     Channels::channels, Alpha::alpha, note},
#include "tracer/display_formats.def"
};

bool holds_word(std::string_view words, std::string_view wanted) {
    while (!words.empty()) {
        const std::size_t end = std::min(words.find(' '), words.size());
        if (words.substr(0, end) == wanted) {
            return true;
        }
        words.remove_prefix(std::min(end + 1, words.size()));
    }
    return false;
}

bool fits_numbers(Storage storage, Numbers numbers) {
    switch (numbers) {
    case Numbers::Any:
        return true;
    case Numbers::Byte:
        return storage == Storage::U8;
    case Numbers::Word:
        return storage == Storage::U8 || storage == Storage::U16;
    case Numbers::Float:
        return storage == Storage::Float;
    }
    return false;
}

// What the picture mainly shows: its color, else its first output, else alpha, else depth.
ChannelRole main_role(const FilePicture& p) {
    for (const ChannelRole role :
         {ChannelRole::Color, ChannelRole::Other, ChannelRole::Alpha, ChannelRole::Depth}) {
        if (p.find(role) != nullptr) {
            return role;
        }
    }
    return ChannelRole::Color;
}

// Names of what is taken out, with commas between.
std::string keep_only(FilePicture& p, ChannelRole main, bool keeps_alpha) {
    std::string left_out;
    bool has_main = false;
    std::erase_if(p.channels, [&](const FileChannel& c) {
        const bool is_more = c.role == main && (main == ChannelRole::Color || !has_main);
        has_main |= c.role == main;
        const bool keep = is_more || (keeps_alpha && c.role == ChannelRole::Alpha);
        if (!keep) {
            left_out += (left_out.empty() ? "" : ", ") + c.name;
        }
        return !keep;
    });
    return left_out;
}

void write_grey_three_times(FilePicture& p) {
    if (p.count(ChannelRole::Color) == 1) {
        const auto grey = std::ranges::find(p.channels, ChannelRole::Color, &FileChannel::role);
        p.channels.insert(grey, 2, FileChannel(*grey));
    }
}

FitResult fit_numbers(FilePicture& p, const FormatRow& format, bool is_depth, std::string note) {
    p.storage = common_storage(p.channels);
    if (fits_numbers(p.storage, format.numbers)) {
        return {true, std::move(note)};
    }
    const std::string name(format.name);
    if (format.numbers == Numbers::Float) {
        p.storage = Storage::Float; // levels are for files of levels
        return {true, std::move(note)};
    }
    if (is_depth) {
        return {false, name + " holds no floating-point depth"};
    }
    const bool bytes = format.numbers == Numbers::Byte;
    note += (note.empty() ? "" : "; ") + name +
            (bytes ? " holds 8 bits; writing 8 (one = 255)"
                   : " holds 8 or 16 bits; writing 16 (one = 65535)");
    for (FileChannel& c : p.channels) {
        const double one = bytes ? 255 : 65535;
        c.quantizer = {0, one, 0, one, 0.5};
    }
    p.storage = bytes ? Storage::U8 : Storage::U16;
    return {true, std::move(note)};
}

} // namespace

std::span<const FormatRow> formats() {
    return rows;
}

const FormatRow& default_format() {
    return rows[0];
}

const FormatRow* format_of_type(std::string_view type) {
    const auto* row =
        std::ranges::find_if(rows, [&](const FormatRow& f) { return holds_word(f.types, type); });
    return row == std::end(rows) ? nullptr : row;
}

const FormatRow* format_of_suffix(std::string_view path) {
    const auto dot = path.find_last_of("./");
    if (dot == std::string_view::npos || path[dot] != '.') {
        return nullptr;
    }
    std::string suffix(path.substr(dot + 1));
    std::ranges::transform(suffix, suffix.begin(), [](unsigned char c) { return std::tolower(c); });
    const auto* row = std::ranges::find_if(
        rows, [&](const FormatRow& f) { return holds_word(f.suffixes, suffix); });
    return row == std::end(rows) ? nullptr : row;
}

Storage common_storage(std::span<const FileChannel> channels) {
    double min = 0, max = 0;
    for (const FileChannel& c : channels) {
        if (c.quantizer.storage() == Storage::Float) {
            return Storage::Float;
        }
        min = std::min({min, c.quantizer.min, c.quantizer.max});
        max = std::max({max, c.quantizer.min, c.quantizer.max});
    }
    return storage_for(min, max);
}

FitResult fit_picture(FilePicture& p, const FormatRow& format) {
    if (format.channels == Channels::Any) {
        return {};
    }
    const std::string name(format.name);
    const bool wants_depth = format.channels == Channels::Depth;
    if (wants_depth && p.find(ChannelRole::Depth) == nullptr) {
        return {false, name + " holds depth only"};
    }
    const ChannelRole main = wants_depth ? ChannelRole::Depth : main_role(p);
    const bool is_depth = main == ChannelRole::Depth;
    const bool keeps_alpha = format.alpha != Alpha::None && !is_depth;
    const std::string left_out = keep_only(p, main, keeps_alpha);
    std::string note;
    if (!left_out.empty()) {
        note = name + " holds " +
               (wants_depth                   ? "depth"
                : format.alpha == Alpha::None ? "color"
                                              : "color and alpha") +
               " only; " + left_out + (left_out.find(',') == std::string::npos ? " is" : " are") +
               " left out";
    }
    if (!wants_depth) {
        for (FileChannel& c : p.channels) {
            c.role = c.role == main ? ChannelRole::Color : c.role;
        }
    }
    const bool two = p.channels.size() == 2 && format.writer != Writer::Png;
    if (format.channels == Channels::Rgb || (two && !wants_depth)) {
        write_grey_three_times(p);
    }
    return fit_numbers(p, format, is_depth, std::move(note));
}

} // namespace trace
