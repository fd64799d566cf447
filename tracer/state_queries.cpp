// SPDX-License-Identifier: Apache-2.0
#include "tracer/state_queries.h"

#include "tracer/sl_types.h"
#include "tracer/version.h"

#include <algorithm>

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
};

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
    return user_value(attributes.find(std::string(name)));
}

std::optional<StateValue> query_option(const rib::Options& options, std::string_view name) {
    if (auto value = standard_value(option_rows, options, name)) {
        return value;
    }
    const auto it = options.user.find(std::string(name));
    return it == options.user.end() ? std::nullopt : user_value(&it->second);
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
