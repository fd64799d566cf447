// SPDX-License-Identifier: Apache-2.0
#include "tracer/ray_channels.h"

#include "tracer/ray_packets.h"
#include "tracer/shader_set.h"
#include "tracer/sl_types.h"
#include "tracer/state_queries.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <string_view>

namespace trace {

namespace {

constexpr std::size_t lanes = SL_LANES_MAX;

struct Name {
    std::string_view from, what; // "surface", "Kd"
};

Name split(const sl_ray_channel& channel) {
    std::string_view name = channel.name != nullptr ? channel.name : "";
    constexpr std::string_view send = "send:";
    if (name.starts_with(send)) {
        name.remove_prefix(send.size());
    }
    const std::size_t colon = name.find(':');
    return colon == std::string_view::npos ? Name{{}, name}
                                           : Name{name.substr(0, colon), name.substr(colon + 1)};
}

bool is_triple(int type) {
    return type == SL_TYPE_color || type == SL_TYPE_point || type == SL_TYPE_vector ||
           type == SL_TYPE_normal;
}

std::size_t components(const sl_ray_channel& channel) {
    return is_triple(channel.type) ? 3 : 1;
}

bool is_color_of_ray(const Name& name) {
    return name.from == "surface" && (name.what == "Ci" || name.what == "Oi");
}

void set(sl_ray_channel& channel, std::uint32_t lane, std::uint32_t num_lanes,
         std::span<const float> value) {
    if (value.size() != components(channel)) {
        return;
    }
    for (std::size_t k = 0; k < value.size(); ++k) {
        channel.values[k * num_lanes + lane] = value[k];
    }
    channel.set |= 1U << lane;
}

struct Value {
    std::array<float, 3> floats{};
    std::size_t count = 0; // 0: none
    [[nodiscard]] std::span<const float> span() const { return {floats.data(), count}; }
};

Value param_value(rt::ShadeBatch& batch, const sl_ray_channel& channel, std::string_view what,
                  std::uint32_t point) {
    const int index = batch.instance().shader().find_param(what);
    if (index < 0) {
        return {};
    }
    const sl_param& param = batch.instance().object().params[index];
    if (!types_agree(param.type, channel.type) || param.array_length != 0) {
        return {};
    }
    Value value;
    value.count = components(channel);
    for (std::size_t k = 0; k < value.count; ++k) {
        const float* plane = batch.param_plane(index, static_cast<int>(k));
        const float* uniform = batch.param_uniform(index);
        value.floats[k] = plane != nullptr ? plane[point] : uniform != nullptr ? uniform[k] : 0;
    }
    return value;
}

// Variables of the predefined ones that geometry fills.
constexpr std::pair<std::string_view, sl_variable> geometry_names[] = {
    {"P", SL_VAR_P},       {"N", SL_VAR_N},   {"Ng", SL_VAR_Ng}, {"dPdu", SL_VAR_dPdu},
    {"dPdv", SL_VAR_dPdv}, {"u", SL_VAR_u},   {"v", SL_VAR_v},   {"s", SL_VAR_s},
    {"t", SL_VAR_t},       {"Cs", SL_VAR_Cs}, {"Os", SL_VAR_Os},
};

std::optional<sl_variable> geometry_variable(std::string_view name) {
    const auto row =
        std::ranges::find_if(geometry_names, [&](const auto& r) { return r.first == name; });
    return row == std::end(geometry_names) ? std::nullopt : std::optional(row->second);
}

std::size_t components_of_variable(sl_variable id) {
    return id == SL_VAR_u || id == SL_VAR_v || id == SL_VAR_s || id == SL_VAR_t ? 1 : 3;
}

Value primitive_value(const FrameContext& frame, const geo::Hit& hit, const sl_ray_channel& channel,
                      std::string_view what) {
    Value value;
    alignas(64) float planes[3 * lanes] = {};
    if (const auto id = geometry_variable(what)) {
        sl_points points = {};
        points.var[*id] = planes;
        fill_one(*frame.world, hit, points);
        value.count = components_of_variable(*id);
    } else if (const rib::Param* variable = frame.world->primitive_variable(hit, what)) {
        const int type = sl_type_of(variable->decl.type);
        if (variable->decl.is_array || !types_agree(type, channel.type)) {
            return {};
        }
        value.count = components(channel);
        frame.world->fill_primitive_variable({&hit, 1}, what, lanes, planes);
    }
    for (std::size_t k = 0; k < value.count; ++k) {
        value.floats[k] = planes[k * lanes];
    }
    return value;
}

} // namespace

std::span<sl_ray_channel> channels_of(sl_ray_query& query) {
    const auto count = static_cast<std::size_t>(
        std::clamp<std::int32_t>(query.num_channels, 0, SL_RAY_CHANNELS_MAX));
    return {query.channel, count};
}

namespace {

std::span<const sl_ray_channel> channels_of(const sl_ray_query& query) {
    return trace::channels_of(const_cast<sl_ray_query&>(query));
}

} // namespace

bool asks_for_shading(const sl_ray_query& query) {
    return std::ranges::any_of(channels_of(query), [](const sl_ray_channel& channel) {
        const std::string_view from = split(channel).from;
        return channel.is_sent == 0 &&
               (from == "surface" || from == "displacement" || from == "volume");
    });
}

bool sends(const sl_ray_query& query) {
    return std::ranges::any_of(channels_of(query),
                               [](const sl_ray_channel& c) { return c.is_sent != 0; });
}

bool sends_alike(const sl_ray_query& a, std::uint32_t lane_a, const sl_ray_query& b,
                 std::uint32_t lane_b) {
    const auto all_a = channels_of(a), all_b = channels_of(b);
    const auto next = [](std::span<const sl_ray_channel> all, std::size_t i) {
        while (i < all.size() && all[i].is_sent == 0) {
            ++i;
        }
        return i;
    };
    std::size_t i = next(all_a, 0), j = next(all_b, 0);
    for (; i < all_a.size() && j < all_b.size(); i = next(all_a, i + 1), j = next(all_b, j + 1)) {
        if (all_a[i].name != all_b[j].name || all_a[i].type != all_b[j].type) {
            return false;
        }
        for (std::size_t k = 0; k < components(all_a[i]); ++k) {
            if (all_a[i].values[k * a.lanes + lane_a] != all_b[j].values[k * b.lanes + lane_b]) {
                return false;
            }
        }
    }
    return i >= all_a.size() && j >= all_b.size();
}

void read_shaded(sl_ray_query& query, std::uint32_t lane, ShadeJob& job, std::uint32_t point) {
    for (sl_ray_channel& channel : channels_of(query)) {
        const Name name = split(channel);
        if (channel.is_sent != 0 || is_color_of_ray(name)) {
            continue;
        }
        rt::ShadeBatch* batch = name.from == "surface"        ? job.subject.surface.batch
                                : name.from == "displacement" ? job.subject.displacement.batch
                                : name.from == "volume"       ? job.subject.atmosphere.batch
                                                              : nullptr;
        if (batch != nullptr) {
            set(channel, lane, query.lanes, param_value(*batch, channel, name.what, point).span());
        }
        const auto id = geometry_variable(name.what);
        if (name.from == "surface" && id && (channel.set >> lane & 1U) == 0 &&
            job.planes.var[*id] != nullptr) {
            Value value;
            value.count = components_of_variable(*id);
            for (std::size_t k = 0; k < value.count; ++k) {
                value.floats[k] = job.planes.var[*id][k * job.stride + point];
            }
            set(channel, lane, query.lanes, value.span());
        }
    }
}

void read_hit(sl_ray_query& query, std::uint32_t lane, const FrameContext& frame,
              const geo::Hit& hit) {
    for (sl_ray_channel& channel : channels_of(query)) {
        const Name name = split(channel);
        if (channel.is_sent != 0) {
            continue;
        }
        const bool is_variable = name.from == "surface" && (channel.set >> lane & 1U) == 0 &&
                                 geometry_variable(name.what).has_value();
        if (name.from == "primitive" || is_variable) {
            set(channel, lane, query.lanes, primitive_value(frame, hit, channel, name.what).span());
        } else if (name.from == "attribute") {
            const std::uint32_t state = frame.world->binding(hit).attributes;
            const auto value = query_attribute(frame.scene.attributes[state], name.what);
            if (value && types_agree(value->type, channel.type)) {
                set(channel, lane, query.lanes, value->floats);
            }
        }
    }
}

void read_ray(sl_ray_query& query, std::uint32_t lane, const ChannelRay& ray) {
    for (sl_ray_channel& channel : channels_of(query)) {
        const Name name = split(channel);
        if (channel.is_sent != 0 || name.from != "ray") {
            continue;
        }
        const auto triple = [](const base::V3f& v) { return std::array<float, 3>{v.x, v.y, v.z}; };
        if (name.what == "origin") {
            set(channel, lane, query.lanes, triple(ray.origin));
        } else if (name.what == "direction") {
            set(channel, lane, query.lanes, triple(ray.direction));
        } else if (name.what == "length") {
            set(channel, lane, query.lanes, {&ray.length, 1});
        }
    }
}

void read_color(sl_ray_query& query, std::uint32_t lane, const Sample& color) {
    for (sl_ray_channel& channel : channels_of(query)) {
        const Name name = split(channel);
        if (channel.is_sent == 0 && is_color_of_ray(name)) {
            set(channel, lane, query.lanes, name.what == "Ci" ? color.color : color.opacity);
        }
    }
}

void bind_sent(const sl_ray_query& query, std::uint32_t lane, ShadeJob& job) {
    rt::ShadeBatch& batch = job.surface;
    for (const sl_ray_channel& channel : channels_of(query)) {
        const Name name = split(channel);
        const int index = channel.is_sent != 0 && name.from == "surface"
                              ? batch.instance().shader().find_param(name.what)
                              : -1;
        if (index < 0) {
            continue;
        }
        const sl_param& param = batch.instance().object().params[index];
        if (!types_agree(param.type, channel.type) || param.array_length != 0) {
            continue;
        }
        for (std::size_t k = 0; k < components(channel); ++k) {
            const float value = channel.values[k * query.lanes + lane];
            if (float* plane = batch.param_plane(index, static_cast<int>(k))) {
                std::fill_n(plane, batch.count(), value);
            } else if (float* uniform = batch.param_uniform(index)) {
                uniform[k] = value;
            }
        }
    }
}

} // namespace trace
