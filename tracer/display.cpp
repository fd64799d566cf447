// SPDX-License-Identifier: Apache-2.0
#include "tracer/display.h"

#include "tracer/display_format.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <exception>
#include <optional>
#include <string_view>

namespace trace {

namespace {

enum class Driver : std::uint8_t {
    File, // by the extension of the name, TIFF without a known one
    Tiff,
    Png,
    Exr,
    Null,   // asked to write nothing
    Window, // a picture on a screen
    DepthMap
};

struct DriverRow {
    std::string_view name;
    Driver driver;
};

// Display types (ri.md 6.4).
constexpr DriverRow drivers[] = {
    {"file", Driver::File},
    {"tiff", Driver::Tiff},
    {"tif", Driver::Tiff},
    {"png", Driver::Png},
    {"exr", Driver::Exr},
    {"openexr", Driver::Exr},
    {"null", Driver::Null},
    {"framebuffer", Driver::Window},
    {"fb", Driver::Window},
    {"it", Driver::Window},
    {"x11", Driver::Window},
    {"piqsl", Driver::Window},
    {"zframebuffer", Driver::Window},
    {"rgl", Driver::Window},
    {"zfile", Driver::DepthMap},
    {"shadow", Driver::DepthMap},
    {"deepshad", Driver::DepthMap},
    {"dsm", Driver::DepthMap},
    {"tsm", Driver::DepthMap},
};

// Extensions that decide the format of a "file".
constexpr DriverRow extensions[] = {
    {".tif", Driver::Tiff},
    {".tiff", Driver::Tiff},
    {".png", Driver::Png},
    {".exr", Driver::Exr},
};

const DriverRow* find_driver(std::string_view name) {
    const auto* row = std::ranges::find(drivers, name, &DriverRow::name);
    return row == std::end(drivers) ? nullptr : row;
}

std::optional<Driver> format_of_extension(std::string_view path) {
    std::string lower(path);
    std::ranges::transform(lower, lower.begin(), [](unsigned char c) { return std::tolower(c); });
    for (const DriverRow& row : extensions) {
        if (lower.ends_with(row.name)) {
            return row.driver;
        }
    }
    return std::nullopt;
}

// Where a request leads: types that are not known become files.
struct Target {
    Driver driver;
    std::string path;
    bool known_type;
};

bool makes_file(Driver driver) {
    return driver == Driver::Tiff || driver == Driver::Png || driver == Driver::Exr;
}

Target target_of(const rib::Display& display) {
    const DriverRow* row = find_driver(display.type);
    Target target{Driver::File, display.name.empty() ? "ri.tif" : display.name, row != nullptr};
    target.driver = row != nullptr ? row->driver : Driver::File;
    if (target.driver == Driver::File) {
        const auto by_extension = format_of_extension(target.path);
        target.driver = by_extension.value_or(Driver::Tiff);
        target.path += by_extension || row != nullptr ? "" : ".tif";
    }
    return target;
}

// --- mode: which channels

struct ChannelRow {
    std::string_view name;
    ChannelRole role;
    Plane plane;
    std::string_view quantizer; // the name of its own Quantize type, if one was given
};
constexpr ChannelRow rgb_channels[] = {{"R", ChannelRole::Color, Plane::R, "rgb"},
                                       {"G", ChannelRole::Color, Plane::G, "rgb"},
                                       {"B", ChannelRole::Color, Plane::B, "rgb"}};
constexpr ChannelRow opacity_channels[] = {{"Oi.R", ChannelRole::Other, Plane::OR, "Oi"},
                                           {"Oi.G", ChannelRole::Other, Plane::OG, "Oi"},
                                           {"Oi.B", ChannelRole::Other, Plane::OB, "Oi"}};
constexpr ChannelRow alpha_channel[] = {{"A", ChannelRole::Alpha, Plane::A, "a"}};
constexpr ChannelRow depth_channel[] = {{"Z", ChannelRole::Depth, Plane::Z, "z"}};

struct ModeRow {
    std::string_view name;
    std::span<const ChannelRow> channels;
};
constexpr ModeRow modes[] = {
    {"rgb", rgb_channels}, {"Ci", rgb_channels}, {"Oi", opacity_channels},
    {"a", alpha_channel},  {"z", depth_channel},
};

// One element of a mode: its last word, so that "varying color Ci" is Ci; several run together,
// like rgbaz.
bool add_mode(std::string_view element, std::vector<ChannelRow>& out) {
    element = element.substr(0, element.find_last_not_of(" \t") + 1);
    if (const auto blank = element.find_last_of(" \t"); blank != std::string_view::npos) {
        element.remove_prefix(blank + 1);
    }
    if (element.empty()) {
        return false;
    }
    while (!element.empty()) {
        const auto* row = std::ranges::find_if(
            modes, [&](const ModeRow& m) { return element.starts_with(m.name); });
        if (row == std::end(modes)) {
            return false;
        }
        element.remove_prefix(row->name.size());
        for (const ChannelRow& c : row->channels) {
            if (std::ranges::find(out, c.name, &ChannelRow::name) == out.end()) {
                out.push_back(c);
            }
        }
    }
    return true;
}

// nullopt: the mode names something else than color, alpha and depth.
std::optional<std::vector<ChannelRow>> channels_of_mode(std::string_view mode) {
    std::vector<ChannelRow> out;
    while (true) {
        const auto comma = mode.find(',');
        if (!add_mode(mode.substr(0, comma), out)) {
            return std::nullopt;
        }
        if (comma == std::string_view::npos) {
            break;
        }
        mode.remove_prefix(comma + 1);
    }
    // Colors first, as files want them ("az" and "zrgb" are seen).
    std::ranges::stable_sort(out, {}, &ChannelRow::role);
    return out;
}

// --- quantisation

Quantizer quantizer_for(const ChannelRow& channel, bool only_depth, const rib::Display& display,
                        const rib::Options& options) {
    const auto own = options.other_quantize.find(std::string(channel.quantizer));
    Quantizer q = quantizer(own != options.other_quantize.end()  ? own->second
                            : channel.role == ChannelRole::Depth ? options.depth_quantize
                                                                 : options.color_quantize);
    // The display's own values are meant for what it mainly holds: not for the depth beside a
    // color.
    if (channel.role == ChannelRole::Depth && !only_depth) {
        return q;
    }
    const float dither = display.params.get_float("dither", static_cast<float>(q.dither));
    if (const rib::Param* p = display.params.find("quantize");
        p != nullptr && p->floats.size() >= 4) {
        q = quantizer({p->floats[1], p->floats[2], p->floats[3], dither});
        q.zero = std::isfinite(p->floats[0]) ? static_cast<double>(p->floats[0]) : 0;
    }
    q.dither = std::isfinite(dither) ? static_cast<double>(dither) : 0;
    return q;
}

// The type that holds every channel; float as soon as one is float.
Storage common_storage(const std::vector<FileChannel>& channels) {
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

// --- one request

class DisplayWriter {
public:
    DisplayWriter(const rib::Display& display, const rib::Options& options, const Image& image,
                  const PictureInfo& info, base::Diag& diag)
        : display_(display), options_(options), image_(image), diag_(diag) {
        picture_.pixels = image.pixels;
        picture_.info = info;
    }

    DisplayResult run();

private:
    bool choose_driver();
    bool choose_channels();
    void choose_parameters();
    void fit_png();
    void use_tiff(const std::string& why);
    DisplayResult write();
    void warn(base::Code code, const std::string& text) {
        diag_.report(base::Severity::Warning, code, display_.pos,
                     "Display \"" + display_.name + "\": " + text);
    }

    const rib::Display& display_;
    const rib::Options& options_;
    const Image& image_;
    base::Diag& diag_;
    Driver driver_ = Driver::Tiff;
    std::string path_;
    FilePicture picture_;
};

// False: nothing is written. What that means was said.
bool DisplayWriter::choose_driver() {
    const Target target = target_of(display_);
    driver_ = target.driver;
    path_ = target.path;
    if (!target.known_type) {
        warn(base::Code::Unimplement, "type \"" + display_.type + "\" is not known; writing " +
                                          path_ + (driver_ == Driver::Tiff ? " as TIFF" : ""));
    } else if (driver_ == Driver::DepthMap) {
        warn(base::Code::Unimplement, "type \"" + display_.type + "\" is not written yet");
    }
    return makes_file(driver_);
}

bool DisplayWriter::choose_channels() {
    const auto rows = channels_of_mode(display_.mode.empty() ? "rgba" : display_.mode);
    if (!rows) {
        warn(base::Code::Unimplement,
             "mode \"" + display_.mode + "\" is not written yet (rgb, a, z, Ci, Oi are)");
        return false;
    }
    const bool only_depth = rows->size() == 1 && rows->front().role == ChannelRole::Depth;
    for (const ChannelRow& row : *rows) {
        picture_.channels.push_back({std::string(row.name), row.role, image_.plane(row.plane),
                                     quantizer_for(row, only_depth, display_, options_),
                                     static_cast<int>(row.plane)});
    }
    picture_.storage = common_storage(picture_.channels);
    return true;
}

void DisplayWriter::choose_parameters() {
    const rib::ParamList& p = display_.params;
    picture_.compression = p.get_string("compression", p.get_string("exrcompression", ""));
    const std::string type = p.get_string("exrpixeltype", p.get_string("type", "half"));
    picture_.exr_type = type == "float" ? ExrPixelType::Float : ExrPixelType::Half;
    if (const rib::Param* r = p.find("resolution"); r != nullptr) {
        for (std::size_t i = 0; i < 2; ++i) {
            const float value = r->ints.size() > i     ? static_cast<float>(r->ints[i])
                                : r->floats.size() > i ? r->floats[i]
                                                       : 0;
            picture_.resolution[i] =
                value > 0 && std::isfinite(value) ? value : picture_.resolution[i];
        }
    }
    const std::string unit = p.get_string("resolutionunit", "inch");
    picture_.resolution_in_cm = unit.starts_with("c");
}

void DisplayWriter::use_tiff(const std::string& why) {
    path_ += ".tif";
    driver_ = Driver::Tiff;
    warn(base::Code::Incapable, why + "; writing " + path_ + " as TIFF");
}

// PNG holds 8 and 16 unsigned bits of grey or RGB, with or without alpha.
void DisplayWriter::fit_png() {
    auto& channels = picture_.channels;
    const bool only_depth = channels.size() == 1 && channels[0].role == ChannelRole::Depth;
    if (only_depth && picture_.storage != Storage::U8 && picture_.storage != Storage::U16) {
        use_tiff("PNG holds no floating-point depth");
        return;
    }
    const auto misfit = [](const FileChannel& c) {
        return c.role == ChannelRole::Depth || c.role == ChannelRole::Other;
    };
    if (!only_depth && std::ranges::any_of(channels, misfit)) {
        if (std::ranges::all_of(channels, misfit)) {
            use_tiff("PNG holds color and alpha only");
            return;
        }
        std::erase_if(channels, misfit);
        warn(base::Code::Incapable, "PNG holds color and alpha only; depth is left out");
        picture_.storage = common_storage(channels);
    }
    if (picture_.storage == Storage::U8 || picture_.storage == Storage::U16) {
        return;
    }
    warn(base::Code::Incapable, "PNG holds 8 or 16 bits; writing 16 (one = 65535)");
    for (FileChannel& c : channels) {
        c.quantizer = {0, 65535, 0, 65535, 0.5};
    }
    picture_.storage = Storage::U16;
}

DisplayResult DisplayWriter::write() {
    OutputFile file(path_);
    WriteOutcome outcome;
    if (file.error() == 0) {
        outcome = driver_ == Driver::Png   ? write_png(picture_, file)
                  : driver_ == Driver::Exr ? write_exr(picture_, file)
                                           : write_tiff(picture_, file);
    }
    if (!outcome.note.empty()) {
        warn(base::Code::BadToken, outcome.note);
    }
    if (file.error() == 0 && outcome.ok && file.commit()) {
        return DisplayResult::Written;
    }
    const bool full = file.error() == ENOSPC || file.error() == EDQUOT;
    const std::string why = file.error() != 0 ? std::strerror(file.error()) : outcome.error;
    diag_.report(base::Severity::Severe, full ? base::Code::DiskFull : base::Code::System,
                 display_.pos,
                 "Display: cannot write " + path_ + ": " + why + "; the picture is lost");
    return DisplayResult::Failed;
}

DisplayResult DisplayWriter::run() {
    if (!choose_driver() || !choose_channels()) {
        return DisplayResult::Skipped;
    }
    if (picture_.pixels.empty()) {
        warn(base::Code::Range, "the crop window holds no pixel; not written");
        return DisplayResult::Skipped;
    }
    choose_parameters();
    if (driver_ == Driver::Png) {
        fit_png();
    }
    return write();
}

} // namespace

const FileChannel* FilePicture::find(ChannelRole role) const {
    const auto it = std::ranges::find(channels, role, &FileChannel::role);
    return it == channels.end() ? nullptr : &*it;
}

int FilePicture::count(ChannelRole role) const {
    return static_cast<int>(std::ranges::count(channels, role, &FileChannel::role));
}

PictureInfo picture_info(const Camera& camera) {
    const Raster& r = camera.raster();
    PictureInfo info;
    info.xres = r.xres;
    info.yres = r.yres;
    info.pixel_aspect = r.pixel_aspect;
    info.camera_from_world = camera.camera_from_world();
    // Camera's NDC spans the picture, which FrameAspectRatio may make smaller than the frame.
    const base::Mat4 frame_from_picture =
        base::Mat4::scale({static_cast<double>(r.picture.width()) / r.xres,
                           static_cast<double>(r.picture.height()) / r.yres, 1});
    info.ndc_from_world = frame_from_picture * camera.ndc_from_world();
    const auto in_plane = [&](double x, double y) {
        const Camera::Ray ray = camera.pinhole_ray(x, y);
        return camera.perspective() ? ray.direction / ray.direction.z : ray.origin;
    };
    const base::V3d left = in_plane(0, r.yres / 2.0), right = in_plane(r.xres, r.yres / 2.0);
    info.window_center[0] = (left.x + right.x) / 2;
    info.window_center[1] = (left.y + right.y) / 2;
    info.window_width = std::fabs(right.x - left.x);
    return info;
}

std::optional<std::string> display_file(const rib::Display& display) {
    Target target = target_of(display);
    return makes_file(target.driver) ? std::optional(std::move(target.path)) : std::nullopt;
}

bool shows_window(const rib::Display& display) {
    return target_of(display).driver == Driver::Window;
}

bool leaves_file(const rib::Display& display) {
    const Driver driver = target_of(display).driver;
    return driver != Driver::Window && driver != Driver::Null;
}

rib::Display file_of_window(const rib::Display& window, const std::string& default_file) {
    rib::Display file = window;
    file.type = "file";
    if (file.name.empty()) {
        file.name = default_file.empty() ? "ri.tif" : default_file;
    } else if (!format_of_extension(file.name)) {
        file.name += ".tif"; // never the bytes of a picture under the name of a scene
    }
    return file;
}

rib::Display default_display(std::string file, std::string mode) {
    rib::Display d;
    d.name = std::move(file);
    d.type = "file";
    d.mode = std::move(mode);
    return d;
}

bool writes_depth_map(const rib::Display& display) {
    const DriverRow* row = find_driver(display.type);
    return row != nullptr && row->driver == Driver::DepthMap;
}

DisplayResult write_display(const rib::Display& display, const rib::Options& options,
                            const Image& image, const PictureInfo& info, base::Diag& diag) {
    try {
        return DisplayWriter(display, options, image, info, diag).run();
    } catch (const std::exception& e) {
        diag.report(base::Severity::Severe, base::Code::NoMem, display.pos,
                    "Display: cannot write " + display.name + ": " + e.what());
        return DisplayResult::Failed;
    }
}

} // namespace trace
