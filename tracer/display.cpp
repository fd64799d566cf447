// SPDX-License-Identifier: Apache-2.0
#include "tracer/display.h"

#include "tracer/display_format.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <deque>
#include <exception>
#include <string_view>

namespace trace {

namespace {

// Display types that are no file formats (ri.md 6.4).
enum class Special : std::uint8_t {
    File,  // by the suffix of the name, TIFF without a known one
    Null,  // asked to write nothing
    Window // a picture on a screen
};

struct SpecialRow {
    std::string_view name;
    Special what;
};
constexpr SpecialRow specials[] = {
    {"file", Special::File},    {"null", Special::Null},           {"framebuffer", Special::Window},
    {"fb", Special::Window},    {"it", Special::Window},           {"x11", Special::Window},
    {"piqsl", Special::Window}, {"zframebuffer", Special::Window}, {"rgl", Special::Window},
};

const SpecialRow* find_special(std::string_view name) {
    const auto* row = std::ranges::find(specials, name, &SpecialRow::name);
    return row == std::end(specials) ? nullptr : row;
}

// Where a request leads: types that are not known become files.
struct Target {
    const FormatRow* format; // null: no file is written
    std::string path;
    bool known_type;
};

Target target_of(const rib::Display& display) {
    const SpecialRow* special = find_special(display.type);
    Target target{nullptr, display.name.empty() ? "ri.tif" : display.name, true};
    if (special != nullptr && special->what != Special::File) {
        return target;
    }
    target.format = special == nullptr ? format_of_type(display.type) : nullptr;
    target.known_type = special != nullptr || target.format != nullptr;
    if (target.format == nullptr) {
        target.format = format_of_suffix(target.path);
        if (target.format == nullptr) {
            target.format = &default_format();
            target.path += target.known_type ? "" : ".tif";
        }
    }
    return target;
}

// --- one request

class DisplayWriter {
public:
    DisplayWriter(const DisplayPlan& plan, const Image& image, const PictureInfo& info,
                  base::Diag& diag)
        : plan_(plan), display_(plan.display), image_(image), diag_(diag) {
        picture_.pixels = image.pixels;
        picture_.info = info;
    }

    DisplayResult run();

private:
    bool choose_format();
    bool choose_channels();
    void choose_parameters();
    void fit();
    void use_tiff(const std::string& why);
    DisplayResult write();
    WriteOutcome write_format(OutputFile& file) const;
    void warn(base::Code code, const std::string& text) {
        diag_.report(base::Severity::Warning, code, display_.pos,
                     "Display \"" + display_.name + "\": " + text);
    }

    const DisplayPlan& plan_;
    const rib::Display& display_;
    const Image& image_;
    base::Diag& diag_;
    const FormatRow* format_ = &default_format();
    std::string path_;
    FilePicture picture_;
    std::deque<std::vector<float>> exposed_; // outputs with an exposure of their own
};

// False: nothing is written. What that means was said.
bool DisplayWriter::choose_format() {
    const Target target = target_of(display_);
    path_ = target.path;
    format_ = target.format;
    if (!target.known_type) {
        const bool is_default = format_ == &default_format();
        warn(base::Code::Unimplement, "type \"" + display_.type + "\" is not known; writing " +
                                          path_ + (is_default ? " as TIFF" : ""));
    } else if (format_ != nullptr && format_->writer == Writer::Shadow &&
               display_.type != "shadow" && display_.type != "file") {
        warn(base::Code::Incapable,
             "type \"" + display_.type + "\" holds the depth of what is opaque only");
    }
    return format_ != nullptr;
}

bool DisplayWriter::choose_channels() {
    if (plan_.channels.empty()) {
        warn(base::Code::BadToken,
             "mode \"" + display_.mode + "\" names no channel that can be written; not written");
        return false;
    }
    for (const ShownChannel& shown : plan_.channels) {
        std::span<const float> values =
            shown.extra < 0
                ? image_.plane(shown.plane)
                : std::span<const float>(image_.extra[static_cast<std::size_t>(shown.extra)]);
        if (shown.output >= 0 && !(shown.exposure == Exposure{})) {
            values = exposed_.emplace_back(values.begin(), values.end());
            const Exposer exposed(shown.exposure);
            for (float& v : exposed_.back()) {
                v = exposed(v);
            }
        }
        picture_.channels.push_back({shown.name, shown.layer, shown.role, values, shown.quantizer,
                                     shown.exr_type, shown.dither_channel});
    }
    picture_.storage = common_storage(picture_.channels);
    return true;
}

void DisplayWriter::choose_parameters() {
    const rib::ParamList& p = display_.params;
    const bool is_exr = format_->writer == Writer::Exr;
    picture_.compression = p.get_string("compression", "");
    picture_.compression =
        is_exr ? p.get_string("exrcompression", picture_.compression) : picture_.compression;
    picture_.multipart = p.get_int("multipart", 0) != 0;
    picture_.quality = std::clamp(p.get_int("quality", 90), 0, 100);
    const std::vector<float> resolution = p.get_numbers("resolution");
    for (std::size_t i = 0; i < std::min<std::size_t>(2, resolution.size()); ++i) {
        const float value = resolution[i];
        picture_.resolution[i] = value > 0 && std::isfinite(value) ? value : picture_.resolution[i];
    }
    const std::string unit = p.get_string("resolutionunit", "inch");
    picture_.resolution_in_cm = unit.starts_with("c");
}

void DisplayWriter::use_tiff(const std::string& why) {
    path_ += ".tif";
    format_ = &default_format();
    warn(base::Code::Incapable, why + "; writing " + path_ + " as TIFF");
}

void DisplayWriter::fit() {
    if (const std::string missing = format_->writer == Writer::Oiio ? oiio_missing() : "";
        !missing.empty()) {
        use_tiff(std::string(format_->name) + " is written by OpenImageIO, which cannot be had (" +
                 missing + ")");
        return;
    }
    const FitResult result = fit_picture(picture_, *format_);
    if (!result.fits) {
        use_tiff(result.note);
    } else if (!result.note.empty()) {
        warn(base::Code::Incapable, result.note);
    }
}

WriteOutcome DisplayWriter::write_format(OutputFile& file) const {
    switch (format_->writer) {
    case Writer::Tiff:
        return write_tiff(picture_, file);
    case Writer::Png:
        return write_png(picture_, file);
    case Writer::Exr:
        return write_exr(picture_, file);
    case Writer::Zfile:
        return write_zfile(picture_, file);
    case Writer::Shadow:
        return write_shadow_map(picture_, file);
    case Writer::Oiio:
        return write_oiio(picture_, *format_, file);
    }
    return {false, "", ""};
}

DisplayResult DisplayWriter::write() {
    OutputFile file(path_);
    WriteOutcome outcome;
    if (file.error() == 0) {
        outcome = write_format(file);
    }
    if (!outcome.note.empty()) {
        warn(base::Code::BadToken, outcome.note);
    }
    if (file.error() == 0 && outcome.ok && file.commit()) {
        return DisplayResult::Written;
    }
    if (file.error() == 0 && format_->writer == Writer::Oiio) {
        use_tiff(std::string(format_->name) + ": OpenImageIO says: " + outcome.error);
        return write();
    }
    const bool full = file.error() == ENOSPC || file.error() == EDQUOT;
    const std::string why = file.error() != 0 ? std::strerror(file.error()) : outcome.error;
    diag_.report(base::Severity::Severe, full ? base::Code::DiskFull : base::Code::System,
                 display_.pos,
                 "Display: cannot write " + path_ + ": " + why + "; the picture is lost");
    return DisplayResult::Failed;
}

DisplayResult DisplayWriter::run() {
    if (!choose_format() || !choose_channels()) {
        return DisplayResult::Skipped;
    }
    if (picture_.pixels.empty()) {
        warn(base::Code::Range, "the crop window holds no pixel; not written");
        return DisplayResult::Skipped;
    }
    choose_parameters();
    fit();
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
    return target.format != nullptr ? std::optional(std::move(target.path)) : std::nullopt;
}

// Pixar's screen matrix ends in a square from -1 to 1, y up.
base::Mat4 screen_from_world(const PictureInfo& info) {
    return base::Mat4::translate({-1, 1, 0}) * base::Mat4::scale({2, -2, 1}) * info.ndc_from_world;
}

bool shows_window(const rib::Display& display) {
    const SpecialRow* special = find_special(display.type);
    return special != nullptr && special->what == Special::Window;
}

bool leaves_file(const rib::Display& display) {
    const SpecialRow* special = find_special(display.type);
    return special == nullptr ||
           (special->what != Special::Window && special->what != Special::Null);
}

bool keeps_floats(const rib::Display& display) {
    const FormatRow* format = target_of(display).format;
    return format != nullptr &&
           (format->writer == Writer::Exr || format->numbers == FormatRow::Numbers::Float);
}

rib::Display file_of_window(const rib::Display& window, const std::string& default_file) {
    rib::Display file = window;
    file.type = "file";
    if (file.name.empty()) {
        file.name = default_file.empty() ? "ri.tif" : default_file;
    } else if (format_of_suffix(file.name) == nullptr) {
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
    const FormatRow* format = target_of(display).format;
    return format != nullptr && format->channels == FormatRow::Channels::Depth;
}

DisplayResult write_display(const DisplayPlan& plan, const Image& image, const PictureInfo& info,
                            base::Diag& diag) {
    try {
        return DisplayWriter(plan, image, info, diag).run();
    } catch (const std::exception& e) {
        diag.report(base::Severity::Severe, base::Code::NoMem, plan.display.pos,
                    "Display: cannot write " + plan.display.name + ": " + e.what());
        return DisplayResult::Failed;
    }
}

} // namespace trace
