// SPDX-License-Identifier: Apache-2.0
#include "tracer/state_queries.h"

#include "ribtools/declare.h"
#include "tracer/sl_types.h"
#include "tracer/version.h"

#include <algorithm>
#include <charconv>

namespace trace {

namespace {

StateValue number(float value) {
    return {SL_TYPE_float, {value}, {}};
}
StateValue numbers(std::vector<float> values) {
    return {SL_TYPE_float, std::move(values), {}};
}
StateValue color(const std::array<float, 3>& c) {
    return {SL_TYPE_color, {c.begin(), c.end()}, {}};
}
StateValue text(std::string value) {
    return {SL_TYPE_string, {}, {std::move(value)}};
}

// Attribute and Option "group" "name" under their key "group:name".
std::optional<StateValue> user_value(const rib::Param* param) {
    if (param == nullptr) {
        return std::nullopt;
    }
    StateValue value;
    value.type = sl_type_of(param->decl.type);
    value.floats = param->floats;
    if (param->decl.type == rib::ParamType::Integer) {
        value.floats.assign(param->ints.begin(), param->ints.end());
    }
    value.texts = param->strings;
    return value;
}

std::vector<float> numbers_of(std::string_view text) {
    std::vector<float> values;
    while (true) {
        text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
        float value = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (text.empty() || error != std::errc{}) {
            return values;
        }
        values.push_back(value);
        text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    }
}

// What "group:name" is where nobody has set it: the default of ri_options.def, if it gives one.
std::optional<StateValue> default_value(rib::OptionCategory category, std::string_view key) {
    const std::size_t colon = key.find(':');
    if (colon == std::string_view::npos) {
        return std::nullopt;
    }
    const rib::OptionRow* row =
        rib::find_option(category, key.substr(0, colon), key.substr(colon + 1));
    const auto decl = row != nullptr ? rib::option_type(*row) : std::nullopt;
    if (!decl || row->fallback.empty()) {
        return std::nullopt;
    }
    StateValue value;
    value.type = sl_type_of(decl->type);
    if (value.type == SL_TYPE_string) {
        value.texts.emplace_back(row->fallback);
    } else {
        value.floats = numbers_of(row->fallback);
    }
    return value;
}

using Attributes = rib::Attributes;
using Options = rib::Options;

struct AttributeRow {
    std::string_view name; // without "Ri:"
    StateValue (*value)(const Attributes&);
};

constexpr AttributeRow attribute_rows[] = {
    {"ShadingRate", [](const Attributes& a) { return number(a.shading_rate); }},
    {"Sides", [](const Attributes& a) { return number(static_cast<float>(a.sides)); }},
    {"Matte", [](const Attributes& a) { return number(static_cast<float>(a.matte)); }},
    {"matte", [](const Attributes& a) { return number(static_cast<float>(a.matte)); }},
    {"Color", [](const Attributes& a) { return color(a.color); }},
    {"Opacity", [](const Attributes& a) { return color(a.opacity); }},
    {"DetailRange",
     [](const Attributes& a) {
         return numbers({a.detail_range.begin(), a.detail_range.end()});
     }},
    {"TextureCoordinates",
     [](const Attributes& a) {
         return numbers({a.texture_coordinates.begin(), a.texture_coordinates.end()});
     }},
    {"Orientation",
     [](const Attributes& a) { return text(a.orientation_matches ? "outside" : "inside"); }},
    {"ShadingInterpolation",
     [](const Attributes& a) {
         return text(a.interpolation == rib::Interpolation::Smooth ? "smooth" : "constant");
     }},
    {"Bound",
     [](const Attributes& a) {
         return numbers({a.bound.begin(), a.bound.end()});
     }},
};

std::optional<StateValue> approximation(const Attributes& attributes, std::string_view name) {
    constexpr std::string_view prefix = "GeometricApproximation:";
    if (!name.starts_with(prefix)) {
        return std::nullopt;
    }
    const auto it = attributes.approximation.find(std::string(name.substr(prefix.size())));
    return it == attributes.approximation.end() ? std::nullopt
                                                : std::optional<StateValue>(number(it->second));
}

float frame_aspect(const Options& o) {
    return o.frame_aspect > 0
               ? o.frame_aspect
               : static_cast<float>(o.xres) * o.pixel_aspect / static_cast<float>(o.yres);
}

struct OptionRow {
    std::string_view name; // without "Ri:"
    StateValue (*value)(const Options&);
};

StateValue format(const Options& o) {
    return numbers({static_cast<float>(o.xres), static_cast<float>(o.yres), o.pixel_aspect});
}

constexpr OptionRow option_rows[] = {
    {"Format", format},
    {"DeviceResolution", format},
    {"DeviceFrame", [](const Options& o) { return number(static_cast<float>(o.frame)); }},
    {"Frame", [](const Options& o) { return number(static_cast<float>(o.frame)); }},
    {"FrameAspectRatio", [](const Options& o) { return number(frame_aspect(o)); }},
    {"CropWindow",
     [](const Options& o) {
         return numbers({o.crop.begin(), o.crop.end()});
     }},
    {"ScreenWindow",
     [](const Options& o) {
         return numbers({o.screen_window.begin(), o.screen_window.end()});
     }},
    {"DepthOfField",
     [](const Options& o) {
         return numbers({o.fstop, o.focal_length, o.focal_distance});
     }},
    {"Shutter",
     [](const Options& o) {
         return numbers({o.shutter_open, o.shutter_close});
     }},
    {"Clipping",
     [](const Options& o) {
         return numbers({o.near_clip, o.far_clip});
     }},
    {"Exposure",
     [](const Options& o) {
         return numbers({o.gain, o.gamma});
     }},
    {"Projection", [](const Options& o) { return text(o.projection); }},
    {"Hider", [](const Options& o) { return text(o.hider); }},
    {"RelativeDetail", [](const Options& o) { return number(o.relative_detail); }},
    {"PixelFilter", [](const Options& o) { return text(o.filter); }},
    {"PixelFilterWidth",
     [](const Options& o) {
         return numbers({o.filter_width[0], o.filter_width[1]});
     }},
    {"PixelVariance", [](const Options& o) { return number(o.pixel_variance); }},
    {"PixelSamples",
     [](const Options& o) {
         return numbers({static_cast<float>(o.xsamples), static_cast<float>(o.ysamples)});
     }},
};

template <class Row, std::size_t n, class State>
std::optional<StateValue> standard_value(const Row (&rows)[n], const State& state,
                                         std::string_view name) {
    if (name.starts_with("Ri:")) {
        name.remove_prefix(3);
    }
    const auto row = std::find_if(std::begin(rows), std::end(rows),
                                  [&](const Row& r) { return r.name == name; });
    return row == std::end(rows) ? std::nullopt : std::optional<StateValue>(row->value(state));
}

} // namespace

std::optional<StateValue> query_attribute(const rib::Attributes& attributes,
                                          std::string_view name) {
    if (auto value = standard_value(attribute_rows, attributes, name)) {
        return value;
    }
    if (auto value = approximation(attributes, name)) {
        return value;
    }
    auto value = user_value(attributes.find(std::string(name)));
    return value ? value : default_value(rib::OptionCategory::Attribute, name);
}

std::optional<StateValue> query_option(const rib::Options& options, std::string_view name) {
    if (auto value = standard_value(option_rows, options, name)) {
        return value;
    }
    const auto it = options.user.find(std::string(name));
    return it == options.user.end() ? default_value(rib::OptionCategory::Option, name)
                                    : user_value(&it->second);
}

std::optional<StateValue> query_renderer(std::string_view name) {
    if (name == "renderer") {
        return text(renderer_name);
    }
    if (name == "version") {
        return numbers({renderer_version.begin(), renderer_version.end()});
    }
    if (name == "versionstring") {
        return text(renderer_version_text);
    }
    return std::nullopt;
}

std::optional<StateValue> world_from_object_value(const Spaces& spaces,
                                                  const base::Mat4& camera_from_object) {
    const Space* world = spaces.find("world");
    if (world == nullptr) {
        return std::nullopt;
    }
    const base::Mat4 m = world->space_from_camera * camera_from_object;
    StateValue value{SL_TYPE_matrix, std::vector<float>(16), {}};
    for (std::size_t i = 0; i < 16; ++i) {
        value.floats[i] = static_cast<float>(m.m[i / 4][i % 4]);
    }
    return value;
}

} // namespace trace
