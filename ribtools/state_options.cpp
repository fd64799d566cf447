// SPDX-License-Identifier: Apache-2.0
// State: options (ri.md 6.3 to 6.5, 7.1 to 7.3) and texture-making requests (6.11).
#include "ribtools/number.h"
#include "ribtools/state_impl.h"
#include "runtime/base/search_path.h"

#include <algorithm>

namespace rib {

namespace {

// Larger pictures are refused: the product must fit an int and the memory of some machine.
constexpr int max_resolution = 1 << 20;
constexpr int max_samples_per_axis = 1 << 12;
constexpr std::size_t max_color_samples = 64;

} // namespace

// --- camera ---

void State::do_Format(Request& request) {
    const Options& initial = config_.defaults;
    const int x = request.integer(0), y = request.integer(1);
    const float aspect = request.real(2);
    if (x > max_resolution || y > max_resolution) {
        error(base::Code::Range, request,
              "more than " + std::to_string(max_resolution) + " pixels across; ignored");
        return;
    }
    options_.xres = x > 0 ? x : initial.xres;
    options_.yres = y > 0 ? y : initial.yres;
    options_.pixel_aspect = aspect > 0 ? aspect : initial.pixel_aspect;
}

void State::do_FrameAspectRatio(Request& request) {
    if (!(request.real(0) > 0)) {
        error(base::Code::Range, request, "the aspect ratio must be positive; ignored");
        return;
    }
    options_.frame_aspect = request.real(0);
}

void State::do_ScreenWindow(Request& request) {
    if (request.real(0) == request.real(1) || request.real(2) == request.real(3)) {
        error(base::Code::Range, request, "the window is empty; ignored");
        return;
    }
    for (int i = 0; i < 4; ++i) {
        options_.screen_window[static_cast<std::size_t>(i)] = request.real(i);
    }
    options_.has_screen_window = true;
}

void State::do_CropWindow(Request& request) {
    std::array<float, 4> crop{};
    bool clamped = false;
    for (int i = 0; i < 4; ++i) {
        const float value = request.real(i);
        crop[static_cast<std::size_t>(i)] = std::clamp(value, 0.0f, 1.0f);
        clamped |= value < 0 || value > 1;
    }
    if (!(crop[0] < crop[1] && crop[2] < crop[3])) {
        error(base::Code::Range, request, "the window is empty; ignored");
        return;
    }
    if (clamped) {
        warn(base::Code::Range, request, "fractions must lie in 0..1; clamped");
    }
    options_.crop = crop;
}

// Marks camera space: what was there before acts between camera and screen (ri.md 6.3).
void State::do_Projection(Request& request) {
    const std::string name = request.args[0].given ? request.string(0) : "null";
    const float fov_deg = request.params.get_float("fov", 90);
    if (name != "perspective" && name != "orthographic" && name != "null" && !name.empty()) {
        warn_once("projection:" + name, base::Code::Incapable, request,
                  "projection " + quoted(name) + " is not known; orthographic is used");
    }
    if (!(fov_deg > 0 && fov_deg < 180)) {
        error(base::Code::Range, request, "fov must lie between 0 and 180 degrees; 90 is used");
    }
    options_.projection = name.empty() ? "null" : name;
    options_.fov_deg = fov_deg > 0 && fov_deg < 180 ? fov_deg : 90;
    options_.projection_params = std::move(request.params);
    screen_from_camera_extra_ = transform_.value.still();
    transform_ = {Transform(), none};
}

void State::do_Clipping(Request& request) {
    const float n = request.real(0), f = request.real(1);
    if (!(n > 0 && n < f)) {
        error(base::Code::Range, request, "0 < near < far is not true; ignored");
        return;
    }
    options_.near_clip = std::max(n, ri_epsilon);
    options_.far_clip = std::min(f, ri_infinity);
}

void State::do_ClippingPlane(Request& request) {
    const base::Mat4& m = transform_.value.still();
    const std::optional<base::Mat4> inverse_m = base::inverse(m);
    const base::V3d normal{request.number(3), request.number(4), request.number(5)};
    if (!inverse_m || base::length(normal) == 0) {
        error(base::Code::Math, request, "the plane has no normal here; ignored");
        return;
    }
    const base::V3d P = base::point(m, {request.number(0), request.number(1), request.number(2)});
    const base::V3d n = base::normal_by_inverse(*inverse_m, normal);
    const bool in_world = blocks_.inside(BlockKind::World);
    (in_world ? scene_->options : options_)
        .clipping_planes.push_back({{P.x, P.y, P.z}, {n.x, n.y, n.z}});
}

void State::do_DepthOfField(Request& request) {
    if (!request.args[0].given) {
        options_.fstop = ri_infinity;
        return;
    }
    const float fstop = request.real(0);
    const float length = request.real(1), distance = request.real(2);
    if (!(fstop > 0 && (fstop >= ri_infinity || (length > 0 && distance > 0)))) {
        error(base::Code::Range, request, "all three values must be positive; ignored");
        return;
    }
    options_.fstop = std::min(fstop, ri_infinity);
    options_.focal_length = length;
    options_.focal_distance = distance;
}

void State::do_Shutter(Request& request) {
    if (request.real(0) > request.real(1)) {
        error(base::Code::Range, request, "opens after it closes; ignored");
        return;
    }
    options_.shutter_open = request.real(0);
    options_.shutter_close = request.real(1);
}

// --- display ---

void State::do_PixelVariance(Request& request) {
    if (request.real(0) < 0) {
        error(base::Code::Range, request, "must not be negative; ignored");
        return;
    }
    options_.pixel_variance = request.real(0);
}

void State::do_PixelSamples(Request& request) {
    const auto samples = [](float n) {
        return static_cast<int>(std::clamp(n, 1.0f, static_cast<float>(max_samples_per_axis)));
    };
    options_.xsamples = samples(request.real(0));
    options_.ysamples = samples(request.real(1));
    options_.samples_pos = request.pos;
}

void State::do_PixelFilter(Request& request) {
    static constexpr std::string_view known[] = {"box",
                                                 "triangle",
                                                 "catmull-rom",
                                                 "gaussian",
                                                 "sinc",
                                                 "mitchell",
                                                 "disk",
                                                 "bessel",
                                                 "blackman-harris",
                                                 "lanczos",
                                                 "separable-catmull-rom",
                                                 "b-spline"};
    std::string name = request.string(0);
    std::transform(name.begin(), name.end(), name.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
    if (std::find(std::begin(known), std::end(known), name) == std::end(known)) {
        error(base::Code::BadToken, request, "unknown filter " + quoted(name) + "; unchanged");
        return;
    }
    if (!(request.real(1) > 0 && request.real(2) > 0)) {
        error(base::Code::Range, request, "widths must be positive; unchanged");
        return;
    }
    options_.filter = name;
    options_.filter_width[0] = request.real(1);
    options_.filter_width[1] = request.real(2);
    options_.filter_pos = request.pos;
}

void State::do_Exposure(Request& request) {
    if (!(request.real(1) > 0)) {
        error(base::Code::Range, request, "gamma must be positive; ignored");
        return;
    }
    options_.gain = request.real(0);
    options_.gamma = request.real(1);
}

void State::do_Imager(Request& request) {
    const std::string& name = request.string(0);
    options_.imager = none;
    if (!name.empty() && name != "null") {
        options_.imager = add_shader(name, std::move(request.params), freeze_transform(),
                                     request.pos, ShaderRole::Imager);
    }
}

void State::do_Quantize(Request& request) {
    const Quantize q{static_cast<float>(request.integer(1)), static_cast<float>(request.integer(2)),
                     static_cast<float>(request.integer(3)), request.real(4)};
    if (q.min > q.max) {
        error(base::Code::Range, request, "min lies above max; ignored");
        return;
    }
    const std::string& type = request.string(0);
    if (type == "rgba" || type == "rgb") {
        options_.color_quantize = q;
    } else if (type == "z") {
        options_.depth_quantize = q;
    } else {
        options_.other_quantize[type] = q;
    }
}

// "+name" adds, "name" replaces all (ri.md 6.4).
void State::do_Display(Request& request) {
    Display display;
    display.name = request.string(0);
    display.type = request.string(1);
    display.mode = request.string(2);
    display.params = std::move(request.params);
    display.pos = request.pos;
    if (display.name.starts_with('+')) {
        display.name.erase(0, 1);
    } else {
        options_.displays.clear();
    }
    options_.displays.push_back(std::move(display));
}

void State::do_DisplayChannel(Request& request) {
    Param channel;
    const Declaration d = parse_inline_declaration(request.string(0));
    channel.guessed = !d.error.empty();
    channel.name = channel.guessed ? request.string(0) : d.name;
    channel.decl = d.decl;
    channel.pos = request.pos;
    ParamList list = std::move(request.params);
    list.params.insert(list.params.begin(), std::move(channel));
    options_.display_channels.push_back(std::move(list));
}

// The dictionary as it stands when the world begins: Declare may follow the Display that needs it.
void State::declare_outputs(Options& o) const {
    const auto note = [&](std::string_view name) {
        const Dictionary::Entry* entry = dictionary_.find(name);
        if (entry && !entry->illegal) {
            o.declared_outputs.insert_or_assign(std::string(name), entry->decl);
        }
    };
    for (const Display& display : o.displays) {
        std::string_view rest = display.mode;
        while (!rest.empty()) {
            const std::size_t end = std::min(rest.find_first_of(", \t"), rest.size());
            note(rest.substr(0, end));
            rest.remove_prefix(std::min(end + 1, rest.size()));
        }
    }
    for (const ParamList& channel : o.display_channels) {
        note(channel.params.front().name);
        note(channel.get_string("source", ""));
    }
}

// --- other options ---

void State::do_Hider(Request& request) {
    static constexpr std::string_view known[] = {"hidden",     "null",      "paint",
                                                 "stochastic", "zbuffer",   "raytrace",
                                                 "photon",     "depthmask", "bake"};
    const std::string& name = request.string(0);
    if (std::find(std::begin(known), std::end(known), name) == std::end(known)) {
        warn_once("hider:" + name, base::Code::Incapable, request,
                  "hider " + quoted(name) + " is not known; kept");
    }
    options_.hider = name;
    for (const Param& p : request.params.params) {
        check_option_name(OptionCategory::Hider, request, p);
    }
    options_.hider_params = std::move(request.params);
}

// nRGB: one row of three per sample. RGBn is only needed to convert back, which nothing here does;
// files that put both into one array are told by its length.
void State::do_ColorSamples(Request& request) {
    std::vector<float> n_rgb = std::move(request.args[0].floats);
    if (!request.args[1].given && n_rgb.size() % 6 == 0) {
        n_rgb.resize(n_rgb.size() / 2);
    } else if (request.args[1].given && request.args[1].floats.size() != n_rgb.size()) {
        error(base::Code::Consistency, request, "the two matrices differ in size; ignored");
        return;
    }
    if (n_rgb.empty() || n_rgb.size() % 3 != 0 || n_rgb.size() / 3 > max_color_samples) {
        error(base::Code::Consistency, request,
              std::to_string(n_rgb.size()) + " numbers are no matrix of 3 columns; ignored");
        return;
    }
    colors_.rgb_of_sample.assign(n_rgb.size() / 3, {});
    for (std::size_t i = 0; i < n_rgb.size(); ++i) {
        colors_.rgb_of_sample[i / 3][i % 3] = n_rgb[i];
    }
    options_.color_samples = static_cast<int>(colors_.num_samples());
}

void State::do_RelativeDetail(Request& request) {
    if (request.real(0) < 0) {
        error(base::Code::Range, request, "must not be negative; ignored");
        return;
    }
    options_.relative_detail = request.real(0);
}

void State::check_option_name(OptionCategory category, const Request& request, const Param& param) {
    const std::string_view group =
        category == OptionCategory::Hider ? std::string_view() : request.string(0);
    if (find_option(category, group, param.name)) {
        return;
    }
    const std::string hint = similar_option(category, group, param.name);
    warn_once(std::string(row(request.id).name) + ":" + std::string(group) + ":" + param.name,
              base::Code::BadToken, request,
              quoted(std::string(group)) + " " + quoted(param.name) +
                  " is not known; kept for shaders, otherwise ignored" +
                  (hint.empty() ? "" : " (did you mean \"" + hint + "\"?)"));
}

void State::set_search_path(const Param& param) {
    const std::string name = param.name == "include"   ? "archive"
                             : param.name == "shaders" ? "shader"
                                                       : param.name;
    std::vector<std::string>& path = options_.search_paths[name];
    const auto defaults = config_.default_paths.find(name);
    static const std::vector<std::string> no_defaults;
    std::vector<std::string> expanded;
    for (const std::string& value : param.strings) {
        for (std::string& directory : base::expand_search_path(
                 value, path,
                 defaults == config_.default_paths.end() ? no_defaults : defaults->second)) {
            expanded.push_back(std::move(directory));
        }
    }
    path = std::move(expanded);
}

void State::do_Option(Request& request) {
    const std::string& group = request.string(0);
    for (Param& p : request.params.params) {
        check_option_name(OptionCategory::Option, request, p);
        if (group == "searchpath") {
            set_search_path(p);
        }
        options_.user[group + ":" + p.name] = p;
        if (config_.on_option) {
            config_.on_option(group + ":" + p.name, p);
        }
    }
}

// --- textures ---

void State::make_texture(Request& request) {
    if (config_.wants_world && !config_.wants_world(options_)) {
        return; // of a frame nobody asked for: what it is made from was not rendered
    }
    TextureRequest t;
    const RequestRow& r = row(request.id);
    t.kind = r.name;
    std::size_t num_files = 2;
    if (request.id == RequestId::MakeCubeFaceEnvironment) {
        num_files = 7;
    }
    for (std::size_t i = 0; i < Request::max_args; ++i) {
        Arg& arg = request.args[i];
        for (std::string& text : arg.strings) {
            (i < num_files ? t.files : t.strings).push_back(std::move(text));
        }
        for (const double number : arg.numbers) {
            t.floats.push_back(narrow(number));
        }
    }
    t.params = std::move(request.params);
    t.options = options_;
    t.pos = request.pos;
    backend_.make_texture(t);
}

void State::do_MakeTexture(Request& request) {
    make_texture(request);
}
void State::do_MakeBump(Request& request) {
    make_texture(request);
}
void State::do_MakeLatLongEnvironment(Request& request) {
    make_texture(request);
}
void State::do_MakeCubeFaceEnvironment(Request& request) {
    make_texture(request);
}
void State::do_MakeShadow(Request& request) {
    make_texture(request);
}
void State::do_MakeOcclusion(Request& request) {
    make_texture(request);
}
void State::do_MakeBrickMap(Request& request) {
    make_texture(request);
}

} // namespace rib
