// SPDX-License-Identifier: Apache-2.0
#include "tracer/texture_frame.h"

#include "ribtools/search_path.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace trace {

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr std::uint32_t max_lanes = PERIGEE_TEXTURE_LANES;
static_assert(max_lanes == SL_LANES_MAX);

struct FilterRow {
    std::string_view name;
    int filter;
};
// What the filters of sl.md 4.7 do where a texel is larger than the footprint.
constexpr FilterRow filters[] = {
    {"box", PERIGEE_FILTER_linear},           {"triangle", PERIGEE_FILTER_linear},
    {"disk", PERIGEE_FILTER_linear},          {"lagrangian", PERIGEE_FILTER_linear},
    {"catmull-rom", PERIGEE_FILTER_linear},   {"gaussian", PERIGEE_FILTER_cubic},
    {"radial-bspline", PERIGEE_FILTER_cubic}, {"b-spline", PERIGEE_FILTER_cubic},
    {"sinc", PERIGEE_FILTER_linear},          {"mitchell", PERIGEE_FILTER_linear},
};

int filter_of(sl_string name) {
    const auto* row = name == nullptr
                          ? nullptr
                          : std::ranges::find(filters, std::string_view(name), &FilterRow::name);
    return row == nullptr || row == std::end(filters) ? PERIGEE_FILTER_linear : row->filter;
}

template <class F> void for_lanes(std::uint32_t mask, F&& f) {
    for (std::uint32_t rest = mask; rest != 0; rest &= rest - 1) {
        f(static_cast<std::uint32_t>(std::countr_zero(rest)));
    }
}

double finite(double x) {
    return std::isfinite(x) ? x : 0;
}

base::V3d triple(const float* planes, std::uint32_t lanes, std::uint32_t lane) {
    return {finite(static_cast<double>(planes[lane])),
            finite(static_cast<double>(planes[lanes + lane])),
            finite(static_cast<double>(planes[2 * lanes + lane]))};
}

float number_of(const rib::Param& p, float fallback) {
    return !p.floats.empty() ? p.floats.front()
           : !p.ints.empty() ? static_cast<float>(p.ints.front())
                             : fallback;
}

} // namespace

ShadowBias shadow_bias(const std::map<std::string, rib::Param>& user) {
    ShadowBias out;
    const auto take = [&](const char* name, bool low, bool high) {
        const auto it = user.find(std::string("shadow:") + name);
        if (it == user.end()) {
            return;
        }
        out.given = true;
        out.bias[0] = low ? number_of(it->second, 0) : out.bias[0];
        out.bias[1] = high ? number_of(it->second, 0) : out.bias[1];
    };
    take("bias", true, true);
    take("bias0", true, false);
    take("bias1", false, true);
    return out;
}

// A name and what it turned out to be; what is empty is not there.
struct TextureFrame::Map {
    std::string name, path, problem;
    Picture picture;
    std::shared_ptr<const CubeMap> cube;
    std::shared_ptr<const ShadowMaps> shadows;
    std::vector<ShadowMap::View> views; // of the shadow maps
    mutable std::once_flag projected;
    mutable Irradiance irradiance;

    [[nodiscard]] bool readable() const {
        return picture.file != nullptr || cube != nullptr || shadows != nullptr;
    }
    [[nodiscard]] int num_channels() const {
        return cube != nullptr ? cube->num_channels() : picture.info.num_channels;
    }
};

TextureFrame::TextureFrame(Textures& textures, const rib::Options& options,
                           const base::Mat4& world_from_current)
    : textures_(textures), directories_(rib::search_directories(options, "texture")),
      world_from_current_(world_from_current), default_bias_(shadow_bias(options.user)) {
    textures_.begin_frame(options);
}

TextureFrame::~TextureFrame() = default;

// --- names

TextureFrame::Use TextureFrame::use_of(int kind) {
    switch (kind) {
    case SL_MAP_shadow:
    case SL_MAP_occlusion:
        return Use::Shadow;
    case SL_MAP_environment:
    case SL_MAP_irradiance:
        return Use::Environment;
    default:
        return Use::Picture;
    }
}

const TextureFrame::Map& TextureFrame::find(const Key& key) const {
    {
        const std::shared_lock lock(mutex_);
        if (const auto it = maps_.find(key); it != maps_.end()) {
            return *it->second;
        }
    }
    const std::unique_lock lock(mutex_);
    std::unique_ptr<Map>& map = maps_[key];
    if (map == nullptr) {
        map = load(key.name, key.use);
    }
    return *map;
}

std::unique_ptr<TextureFrame::Map> TextureFrame::load(const std::string& name, Use use) const {
    auto map = std::make_unique<Map>();
    map->name = name;
    const std::optional<std::string> path = find_map(name, directories_);
    if (!path) {
        map->problem = "no such file";
        return map;
    }
    map->path = *path;
    if (use == Use::Shadow) {
        load_shadow(*path, *map);
    } else if (use == Use::Environment) {
        load_environment(*path, *map);
    } else {
        map->picture = textures_.picture(*path, map->problem);
    }
    return map;
}

void TextureFrame::load_shadow(const std::string& path, Map& map) const {
    map.shadows = textures_.shadows(path, map.problem);
    if (map.shadows != nullptr) {
        for (const ShadowMap& shadow : *map.shadows) {
            map.views.push_back(shadow.view(world_from_current_));
        }
    }
}

void TextureFrame::load_environment(const std::string& path, Map& map) const {
    if (map_file_format(path) == cube_format) {
        map.cube = textures_.cube(path, map.problem);
        return;
    }
    map.picture = textures_.picture(path, map.problem);
    map.picture.info.wrap[0] = PERIGEE_WRAP_periodic;
    map.picture.info.wrap[1] = PERIGEE_WRAP_clamp;
}

// --- one packet

void TextureFrame::lookup(const sl_map_query& query, const ShadowBias& bias, const Report& report,
                          float* result) const {
    const Use use = use_of(query.kind);
    for (std::uint32_t rest = query.mask; rest != 0;) {
        const sl_string name = query.name[std::countr_zero(rest)];
        std::uint32_t same = 0;
        for_lanes(rest,
                  [&](std::uint32_t lane) { same |= query.name[lane] == name ? 1U << lane : 0U; });
        rest &= ~same;
        lookup_one(find({name, use}), query, same, bias, report, result);
    }
}

void TextureFrame::lookup_one(const Map& map, const sl_map_query& query, std::uint32_t mask,
                              const ShadowBias& bias, const Report& report, float* result) const {
    if (!map.readable()) {
        report("cannot read the map \"" + map.name + "\": " + map.problem);
        fall_back(query, mask, result);
        return;
    }
    switch (query.kind) {
    case SL_MAP_texture:
        texture(map, query, mask, report, result);
        break;
    case SL_MAP_bump:
        bump(map, query, mask, report, result);
        break;
    case SL_MAP_environment:
        if (map.cube != nullptr) {
            cube(map, query, mask, result);
        } else {
            latlong(map, query, mask, report, result);
        }
        break;
    case SL_MAP_irradiance:
        irradiance(map, query, mask, result);
        break;
    default:
        shadow(map, query, mask, bias, result);
    }
}

namespace {

void put(const sl_map_query& query, std::uint32_t mask, int channel, float* result,
         const float* values) {
    for_lanes(mask, [&](std::uint32_t lane) {
        result[static_cast<std::uint32_t>(channel) * query.lanes + lane] = values[lane];
    });
}

} // namespace

// An unreadable map gives the fill value; shadows and bump maps have none (sl.md 4.7).
void TextureFrame::fall_back(const sl_map_query& query, std::uint32_t mask, float* result) const {
    constexpr float zero[max_lanes] = {};
    const bool fills = query.kind == SL_MAP_texture || query.kind == SL_MAP_environment;
    for (int k = 0; k < query.num_channels; ++k) {
        put(query, mask, k, result, fills ? query.option[SL_MAP_OPTION_fill] : zero);
    }
}

// --- pictures

namespace {

// Where and how wide OpenImageIO is to look, per lane.
struct Places {
    float s[max_lanes] = {}, t[max_lanes] = {};
    float dsdu[max_lanes] = {}, dtdu[max_lanes] = {}, dsdv[max_lanes] = {}, dtdv[max_lanes] = {};
    float sblur[max_lanes] = {}, tblur[max_lanes] = {};
    float values[4 * max_lanes] = {}, by_s[max_lanes] = {}, by_t[max_lanes] = {};

    void attach(perigee_texture_query& q) {
        q.s = s, q.t = t;
        q.dsdu = dsdu, q.dtdu = dtdu, q.dsdv = dsdv, q.dtdv = dtdv;
        q.sblur = sblur, q.tblur = tblur;
        q.result = values;
    }
};

// A seam: where coordinates are periodic a difference of more than half the texture, but no more
// than all of it, goes the short way round (sl.md 6.4). A footprint is at most the texture.
float side(double difference, double width, bool periodic) {
    double d = finite(difference);
    if (periodic && std::abs(d) > 0.5 && std::abs(d) <= 1) {
        d -= std::copysign(1.0, d);
    }
    return static_cast<float>(std::clamp(d * finite(width), -1.0, 1.0));
}

float blur(const sl_map_query& q, int slot, std::uint32_t lane) {
    return static_cast<float>(
        std::clamp(finite(static_cast<double>(q.option[slot][lane])), 0.0, 1.0));
}

void place_texture(const sl_map_query& q, const int* wrap, std::uint32_t mask, Places& out) {
    const bool periodic[2] = {wrap[0] == PERIGEE_WRAP_periodic, wrap[1] == PERIGEE_WRAP_periodic};
    const std::uint32_t n = q.lanes;
    for_lanes(mask, [&](std::uint32_t i) {
        const double sw = static_cast<double>(q.option[SL_MAP_OPTION_swidth][i]);
        const double tw = static_cast<double>(q.option[SL_MAP_OPTION_twidth][i]);
        out.s[i] = static_cast<float>(finite(static_cast<double>(q.at[i])));
        out.t[i] = static_cast<float>(finite(static_cast<double>(q.at[n + i])));
        out.dsdu[i] = side(static_cast<double>(q.du[i]), sw, periodic[0]);
        out.dtdu[i] = side(static_cast<double>(q.du[n + i]), tw, periodic[1]);
        out.dsdv[i] = side(static_cast<double>(q.dv[i]), sw, periodic[0]);
        out.dtdv[i] = side(static_cast<double>(q.dv[n + i]), tw, periodic[1]);
        out.sblur[i] = blur(q, SL_MAP_OPTION_sblur, i);
        out.tblur[i] = blur(q, SL_MAP_OPTION_tblur, i);
    });
}

// Channels the map has of those that are wanted. A grey map read as colour is grey where no fill is
// given.
struct Channels {
    int present = 0;
    bool spread = false;
};
Channels channels_of(const sl_map_query& q, int num_channels, int alpha) {
    Channels c;
    c.present = std::clamp(num_channels - q.channel, 0, q.num_channels);
    const bool is_grey = num_channels == 1 || (num_channels == 2 && alpha == 1);
    const bool has_fill = (q.given >> SL_MAP_OPTION_fill & 1U) != 0;
    c.spread = is_grey && !has_fill && q.channel == 0 && q.num_channels == 3;
    c.present = c.spread ? 1 : c.present;
    return c;
}

void put_channels(const sl_map_query& q, std::uint32_t mask, const Channels& c, const float* values,
                  float* result) {
    for (int k = 0; k < q.num_channels; ++k) {
        const bool is_there = k < c.present || c.spread;
        const std::uint32_t plane = c.spread ? 0 : static_cast<std::uint32_t>(k) * max_lanes;
        put(q, mask, k, result, is_there ? values + plane : q.option[SL_MAP_OPTION_fill]);
    }
}

} // namespace

void TextureFrame::ask(const Map& map, perigee_texture_query& query, const Report& report) const {
    std::string error;
    query.file = map.picture.file;
    if (!textures_.lookup(query, error)) {
        report("the map \"" + map.name +
               "\" cannot be read completely: " + (error.empty() ? "unknown error" : error));
    }
}

// One lookup per lane at the places that `put` finds.
template <class Put>
void TextureFrame::look_up(const Map& map, const sl_map_query& query, std::uint32_t mask,
                           const Report& report, float* result, Put put) const {
    const perigee_texture_info& info = map.picture.info;
    const Channels c = channels_of(query, info.num_channels, info.alpha);
    Places places;
    if (c.present > 0) {
        put(places);
        perigee_texture_query q{};
        q.mask = mask;
        q.channel = query.channel;
        q.num_channels = c.present;
        q.filter = filter_of(query.filter);
        std::copy_n(info.wrap, 2, q.wrap);
        places.attach(q);
        ask(map, q, report);
    }
    put_channels(query, mask, c, places.values, result);
}

void TextureFrame::texture(const Map& map, const sl_map_query& query, std::uint32_t mask,
                           const Report& report, float* result) const {
    look_up(map, query, mask, report, result,
            [&](Places& places) { place_texture(query, map.picture.info.wrap, mask, places); });
}

void TextureFrame::bump(const Map& map, const sl_map_query& query, std::uint32_t mask,
                        const Report& report, float* result) const {
    const perigee_texture_info& info = map.picture.info;
    Places places;
    if (query.channel < info.num_channels) {
        place_texture(query, info.wrap, mask, places);
        perigee_texture_query q{};
        q.mask = mask;
        q.channel = query.channel;
        q.num_channels = 1;
        std::copy_n(info.wrap, 2, q.wrap);
        places.attach(q);
        q.by_s = places.by_s;
        q.by_t = places.by_t;
        ask(map, q, report);
    }
    put(query, mask, 0, result, places.by_s);
    put(query, mask, 1, result, places.by_t);
}

// --- environments

namespace {

struct LatLong {
    double s = 0.5, t = 0.5, sin_theta = 1;
};
LatLong lat_long(const base::V3d& R) { // sl.md 4.7: z is up
    const double r = std::hypot(R.x, R.y);
    if (r == 0 && R.z == 0) {
        return {};
    }
    return {0.5 + std::atan2(R.y, R.x) / (2 * pi), std::atan2(r, R.z) / pi, r / std::hypot(r, R.z)};
}

// Blur is a part of the sphere of directions: near the poles it takes more of the map's width.
void place_latlong(const sl_map_query& q, std::uint32_t mask, Places& out) {
    for_lanes(mask, [&](std::uint32_t i) {
        const base::V3d R = triple(q.at, q.lanes, i);
        const LatLong at = lat_long(R);
        const LatLong u = lat_long(R + triple(q.du, q.lanes, i));
        const LatLong v = lat_long(R + triple(q.dv, q.lanes, i));
        const double sw = static_cast<double>(q.option[SL_MAP_OPTION_swidth][i]);
        const double tw = static_cast<double>(q.option[SL_MAP_OPTION_twidth][i]);
        out.s[i] = static_cast<float>(at.s);
        out.t[i] = static_cast<float>(at.t);
        out.dsdu[i] = side(u.s - at.s, sw, true);
        out.dtdu[i] = side(u.t - at.t, tw, false);
        out.dsdv[i] = side(v.s - at.s, sw, true);
        out.dtdv[i] = side(v.t - at.t, tw, false);
        const float wide = blur(q, SL_MAP_OPTION_sblur, i);
        out.sblur[i] = wide / std::max(static_cast<float>(at.sin_theta), std::max(wide, 1e-3f));
        out.tblur[i] = blur(q, SL_MAP_OPTION_tblur, i);
    });
}

} // namespace

void TextureFrame::latlong(const Map& map, const sl_map_query& query, std::uint32_t mask,
                           const Report& report, float* result) const {
    look_up(map, query, mask, report, result,
            [&](Places& places) { place_latlong(query, mask, places); });
}

void TextureFrame::cube(const Map& map, const sl_map_query& query, std::uint32_t mask,
                        float* result) const {
    const Channels c = channels_of(query, map.num_channels(), -1);
    float values[4 * max_lanes] = {};
    for_lanes(mask, [&](std::uint32_t i) {
        const double width = 0.5 * static_cast<double>(query.option[SL_MAP_OPTION_swidth][i] +
                                                       query.option[SL_MAP_OPTION_twidth][i]);
        const float wide =
            std::max(blur(query, SL_MAP_OPTION_sblur, i), blur(query, SL_MAP_OPTION_tblur, i));
        const CubeFootprint footprint{finite(width) * triple(query.du, query.lanes, i),
                                      finite(width) * triple(query.dv, query.lanes, i),
                                      pi * static_cast<double>(wide)};
        float out[3] = {};
        map.cube->lookup(triple(query.at, query.lanes, i), footprint, query.channel,
                         {out, static_cast<std::size_t>(c.present)});
        for (std::uint32_t k = 0; k < 3; ++k) {
            values[k * max_lanes + i] = out[k];
        }
    });
    put_channels(query, mask, c, values, result);
}

Irradiance TextureFrame::project(const Map& map) const {
    constexpr double step = pi / 64; // between the directions that are asked
    return Irradiance([&](const base::V3d& d) {
        sl_map_query q{};
        q.kind = SL_MAP_environment;
        q.num_channels = 3;
        q.lanes = 1;
        q.mask = 1;
        const base::V3d side = base::normalize(std::abs(d.z) < 0.9 ? base::V3d{-d.y, d.x, 0}
                                                                   : base::V3d{0, -d.z, d.y});
        const base::V3d u = step * side, v = step * base::cross(d, side);
        for (int k = 0; k < 3; ++k) {
            q.at[k] = static_cast<float>(d[k]);
            q.du[k] = static_cast<float>(u[k]);
            q.dv[k] = static_cast<float>(v[k]);
        }
        q.option[SL_MAP_OPTION_swidth][0] = q.option[SL_MAP_OPTION_twidth][0] = 1;
        std::array<float, 3> out{};
        lookup_one(
            map, q, 1, {}, [](const std::string&) {}, out.data());
        return out;
    });
}

void TextureFrame::irradiance(const Map& map, const sl_map_query& query, std::uint32_t mask,
                              float* result) const {
    std::call_once(map.projected, [&] { map.irradiance = project(map); });
    for_lanes(mask, [&](std::uint32_t i) {
        const std::array<float, 3> light = map.irradiance.around(triple(query.at, query.lanes, i));
        for (std::uint32_t k = 0; k < 3 && k < static_cast<std::uint32_t>(query.num_channels);
             ++k) {
            result[k * query.lanes + i] = light[k];
        }
    });
}

// --- shadows

namespace {

ShadowOptions shadow_options(const sl_map_query& q, const ShadowBias& bias, std::uint32_t i) {
    const auto option = [&](int slot) { return finite(static_cast<double>(q.option[slot][i])); };
    const auto given = [&](int slot) { return (q.given >> slot & 1U) != 0; };
    ShadowOptions o;
    o.width[0] = option(SL_MAP_OPTION_swidth);
    o.width[1] = option(SL_MAP_OPTION_twidth);
    o.blur[0] = option(SL_MAP_OPTION_sblur);
    o.blur[1] = option(SL_MAP_OPTION_tblur);
    o.samples = static_cast<int>(std::clamp(option(SL_MAP_OPTION_samples), 1.0, 1024.0));
    const bool has_low = given(SL_MAP_OPTION_bias0), has_high = given(SL_MAP_OPTION_bias1);
    o.has_bias = has_low || has_high || bias.given;
    o.bias[0] = has_low ? option(SL_MAP_OPTION_bias0) : static_cast<double>(bias.bias[0]);
    o.bias[1] = has_high ? option(SL_MAP_OPTION_bias1) : static_cast<double>(bias.bias[1]);
    return o;
}

} // namespace

// A set of maps: for shadow() the darkest counts, for occlusion() each by the cosine of its
// direction.
void TextureFrame::shadow(const Map& map, const sl_map_query& query, std::uint32_t mask,
                          const ShadowBias& bias, float* result) const {
    const bool is_occlusion = query.kind == SL_MAP_occlusion;
    for_lanes(mask, [&](std::uint32_t i) {
        const base::V3d P = triple(query.at, query.lanes, i), u = triple(query.du, query.lanes, i),
                        v = triple(query.dv, query.lanes, i), none{0, 0, 0};
        const ShadowOptions options = shadow_options(query, bias, i);
        double dark = 0, sum = 0, weights = 0;
        for (std::size_t k = 0; k < map.shadows->size(); ++k) {
            const ShadowMap& shadow = (*map.shadows)[k];
            const ShadowMap::View& view = map.views[k];
            const double weight =
                is_occlusion ? std::max(0.0, base::dot(shadow.to_light(view, P), u)) : 1;
            if (weight > 0) {
                const double here = shadow.shadow(view, P, is_occlusion ? none : u,
                                                  is_occlusion ? none : v, options);
                dark = std::max(dark, here);
                sum += weight * here;
                weights += weight;
            }
        }
        result[i] = static_cast<float>(!is_occlusion ? dark : weights > 0 ? sum / weights : 0);
    });
}

// --- textureinfo

namespace {

std::vector<float> floats(const base::Mat4& m) {
    std::vector<float> out;
    for (const auto& row : m.m) {
        for (const double x : row) {
            out.push_back(static_cast<float>(x));
        }
    }
    return out;
}

std::string type_of(const std::string& format) {
    return format == shadow_format || format == "zfile"             ? "shadow"
           : format == cube_format || format.starts_with("LatLong") ? "environment"
                                                                    : "texture";
}

} // namespace

const TextureFrame::Info& TextureFrame::info(sl_string name, sl_string key) const {
    const std::lock_guard lock(info_mutex_);
    const auto [it, is_new] = infos_.try_emplace({name, key});
    if (is_new) {
        it->second = find_info(name, key);
    }
    return it->second;
}

TextureFrame::Info TextureFrame::find_info(const std::string& name, std::string_view key) const {
    const std::optional<std::string> path = find_map(name, directories_);
    if (!path) {
        return {};
    }
    // Perigee's own maps are not opened by OpenImageIO; anything else is a picture.
    const std::string own = map_file_format(*path).value_or("zfile");
    const bool is_own = own == shadow_format || own == cube_format || own == "zfile";
    std::string error;
    std::shared_ptr<const ShadowMaps> shadows =
        is_own && own != cube_format ? textures_.shadows(*path, error) : nullptr;
    std::shared_ptr<const CubeMap> cube =
        own == cube_format ? textures_.cube(*path, error) : nullptr;
    Picture picture;
    if (shadows == nullptr && cube == nullptr) {
        picture = textures_.picture(*path, error);
        if (picture.file == nullptr) {
            return {};
        }
    }
    if (key == "exists") {
        return {{1}, ""};
    }
    const perigee_texture_info& i = picture.info;
    if (key == "resolution") {
        const int width = shadows != nullptr ? shadows->front().width()
                          : cube != nullptr  ? 3 * cube->size()
                                             : i.width;
        const int height = shadows != nullptr ? shadows->front().height()
                           : cube != nullptr  ? 2 * cube->size()
                                              : i.height;
        return {{static_cast<float>(width), static_cast<float>(height)}, ""};
    }
    if (key == "channels") {
        const int n = shadows != nullptr ? 1
                      : cube != nullptr  ? cube->num_channels()
                                         : i.num_channels;
        return {{static_cast<float>(n)}, ""};
    }
    if (key == "type") {
        return {{},
                shadows != nullptr ? "shadow"
                : cube != nullptr  ? "environment"
                                   : type_of(i.format)};
    }
    const bool viewing = key == "viewingmatrix";
    if (!viewing && key != "projectionmatrix") {
        return {};
    }
    if (shadows != nullptr) {
        const ShadowMap::View view = shadows->front().view(world_from_current_);
        return {floats(viewing ? view.camera_from_current : view.screen_from_current), ""};
    }
    if (cube == nullptr && i.has_matrices != 0) {
        const base::Mat4 m =
            base::Mat4::from_rows(viewing ? i.camera_from_world : i.screen_from_world);
        return {floats(m * world_from_current_), ""};
    }
    return {};
}

} // namespace trace
