// SPDX-License-Identifier: Apache-2.0
#include "tracer/messages.h"

#include "tracer/execution.h"
#include "tracer/ray_levels.h"
#include "tracer/shader_set.h"
#include "tracer/sl_types.h"
#include "tracer/state_queries.h"

#include <algorithm>
#include <bit>

namespace trace {

namespace {

std::uint32_t num_elements(const MessageQuery& query) {
    return static_cast<std::uint32_t>(std::max(query.array_length, 1));
}

std::uint32_t num_planes(const MessageQuery& query) {
    return static_cast<std::uint32_t>(rt::components_of(query.type)) * num_elements(query);
}

// Plane k of the answer from planes of `stride`, lane 0 at `at`; stride 0: one value per plane for
// all lanes.
template <class T>
void copy_planes(const MessageQuery& query, T* out, const T* from, std::uint32_t stride,
                 std::uint32_t at) {
    for (std::uint32_t k = 0; k < num_planes(query); ++k) {
        for (std::uint32_t rest = query.mask; rest != 0; rest &= rest - 1) {
            const auto lane = static_cast<std::uint32_t>(std::countr_zero(rest));
            out[k * query.lanes + lane] = stride == 0 ? from[k] : from[k * stride + at + lane];
        }
    }
}

void copy_floats(const MessageQuery& query, const float* from, std::uint32_t stride,
                 std::uint32_t at) {
    copy_planes(query, query.value, from, stride, at);
}

void copy_strings(const MessageQuery& query, const sl_string* from, std::uint32_t stride,
                  std::uint32_t at) {
    copy_planes(query, reinterpret_cast<sl_string*>(query.value), from, stride, at);
}

int matching_param(const ShaderEntry& shader, const MessageQuery& query) {
    const int index = shader.instance->shader().find_param(query.name);
    if (index < 0) {
        return -1;
    }
    const sl_param& param = shader.object().params[index];
    const bool fits =
        types_agree(param.type, query.type) && param.array_length == query.array_length;
    return fits ? index : -1;
}

// A parameter as it was bound: the shader has not run, or runs elsewhere.
std::uint32_t param_of_instance(const MessageQuery& query, const ShaderEntry* shader) {
    const int index = shader != nullptr ? matching_param(*shader, query) : -1;
    if (index < 0 || query.mask == 0) {
        return 0;
    }
    if (query.type == SL_TYPE_string) {
        copy_strings(query, shader->instance->uniform_strings(index), 0, 0);
    } else {
        copy_floats(query, shader->instance->uniform_floats(index), 0, 0);
    }
    return query.mask;
}

const rib::Attributes* attributes_of(const Execution& execution) {
    const BatchSubject* subject = execution.subject;
    const auto& all = execution.frame.scene.attributes;
    return subject != nullptr && subject->attributes < all.size() ? &all[subject->attributes]
                                                                  : nullptr;
}

const ShaderEntry* bound_shader(const Execution& execution, rib::ShaderId rib::Attributes::*which) {
    const rib::Attributes* attributes = attributes_of(execution);
    const ShaderSet* shaders = execution.frame.shaders;
    return attributes != nullptr && shaders != nullptr ? shaders->get(attributes->*which) : nullptr;
}

// Index of lane 0 in the batches of the subject: a light's lanes are those of the packet it lights.
std::uint32_t subject_index(const Execution& execution, const MessageQuery& query) {
    return query.first + (execution.asked_by != nullptr ? execution.asked_first : 0);
}

// A shader that shares the point: with the values it has now if it runs or has run.
std::uint32_t from_stage(const Execution& execution, const MessageQuery& query,
                         StageRun BatchSubject::*stage, rib::ShaderId rib::Attributes::*which) {
    const StageRun run = execution.subject != nullptr ? execution.subject->*stage : StageRun{};
    return run.batch != nullptr
               ? param_of_batch(query, *run.shader, *run.batch, subject_index(execution, query))
               : param_of_instance(query, bound_shader(execution, which));
}

// I and Ng of the undisplaced surface at the lanes of a query, whatever the shaders need.
struct Facing {
    alignas(64) float I[3 * SL_LANES_MAX] = {};
    alignas(64) float Ng[3 * SL_LANES_MAX] = {};
    std::uint32_t outside = 0; // lanes whose ray comes from outside
    bool known = false;        // false where there is no ray
};

Facing facing_of(const Execution& execution, const MessageQuery& query) {
    Facing facing;
    facing.outside = query.mask;
    const BatchSubject& subject = *execution.subject;
    const std::size_t at = subject_index(execution, query);
    if (subject.incident.ox.empty() || at >= subject.hits.size()) {
        return facing;
    }
    const std::size_t n = std::min<std::size_t>(query.lanes, subject.hits.size() - at);
    const auto part = [&](std::span<const float> values) {
        return values.empty() ? values : values.subspan(at, n);
    };
    const geo::Incident& all = subject.incident;
    const geo::Incident incident{part(all.ox), part(all.oy), part(all.oz),       part(all.dx),
                                 part(all.dy), part(all.dz), part(all.footprint)};
    sl_points points = {};
    points.var[SL_VAR_I] = facing.I;
    points.var[SL_VAR_Ng] = facing.Ng;
    execution.frame.world->fill(subject.hits.subspan(at, n), incident,
                                1ULL << SL_VAR_I | 1ULL << SL_VAR_Ng, SL_LANES_MAX, points, nullptr,
                                nullptr);
    facing.known = true;
    for (std::uint32_t lane = 0; lane < n; ++lane) {
        float along = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            along += facing.I[k * SL_LANES_MAX + lane] * facing.Ng[k * SL_LANES_MAX + lane];
        }
        facing.outside &= along <= 0 ? ~0U : ~(1U << lane);
    }
    return facing;
}

// "geometry:backfacing" and "geometry:geometricnormal": attributes of the point.
std::uint32_t from_geometry(const Execution& execution, const MessageQuery& query) {
    const std::string_view name = query.name;
    const bool backfacing = name == "geometry:backfacing" && query.type == SL_TYPE_float;
    const bool normal =
        name == "geometry:geometricnormal" && types_agree(query.type, SL_TYPE_normal);
    if ((!backfacing && !normal) || query.array_length > 0) {
        return 0;
    }
    const Facing facing = facing_of(execution, query);
    if (!facing.known) {
        return 0;
    }
    if (normal) {
        copy_floats(query, facing.Ng, SL_LANES_MAX, 0);
        return query.mask;
    }
    float back[SL_LANES_MAX];
    for (std::uint32_t lane = 0; lane < SL_LANES_MAX; ++lane) {
        back[lane] = (facing.outside >> lane & 1U) != 0 ? 0 : 1;
    }
    copy_floats(query, back, SL_LANES_MAX, 0);
    return query.mask;
}

// The volumes of the two sides of a surface that a ray met.
struct Sides {
    const ShaderEntry* incident = nullptr; // where the ray came through
    const ShaderEntry* opposite = nullptr;
};

// What the ray came through says more than the surface: it may be inside of other solids.
Sides sides_in_medium(const Execution& execution, std::size_t point, bool from_outside) {
    const BatchSubject& subject = *execution.subject;
    Media& media = execution.thread->levels->media();
    const MediumId here = subject.rays.media[point];
    const std::uint32_t attributes = execution.frame.world->binding(subject.hits[point]).attributes;
    const ShaderSet& shaders = *execution.frame.shaders;
    return {shaders.get(media.volume(here)),
            shaders.get(media.volume(media.behind(here, attributes, from_outside)))};
}

// Outside is the Exterior, or the Atmosphere where there is none; inside is the Interior.
Sides sides_of_surface(const Execution& execution, bool from_outside) {
    const ShaderEntry* exterior = bound_shader(execution, &rib::Attributes::exterior);
    if (exterior == nullptr) {
        exterior = bound_shader(execution, &rib::Attributes::atmosphere);
    }
    const ShaderEntry* interior = bound_shader(execution, &rib::Attributes::interior);
    return from_outside ? Sides{exterior, interior} : Sides{interior, exterior};
}

std::uint32_t from_volume(const Execution& execution, const MessageQuery& query) {
    if (execution.subject == nullptr) {
        return 0;
    }
    const BatchSubject& subject = *execution.subject;
    const std::uint32_t outside = facing_of(execution, query).outside;
    std::uint32_t set = 0;
    for (std::uint32_t rest = query.mask; rest != 0; rest &= rest - 1) {
        const auto lane = static_cast<std::uint32_t>(std::countr_zero(rest));
        const std::size_t point = subject_index(execution, query) + lane;
        const bool from_outside = (outside >> lane & 1U) != 0;
        const bool is_in_medium = point < subject.rays.media.size() &&
                                  point < subject.hits.size() && subject.rays.media[point] != 0;
        const Sides sides = is_in_medium ? sides_in_medium(execution, point, from_outside)
                                         : sides_of_surface(execution, from_outside);
        MessageQuery of_lane = query;
        of_lane.mask = 1U << lane;
        set |= param_of_instance(of_lane, query.kind == SL_MESSAGE_incident ? sides.incident
                                                                            : sides.opposite);
    }
    return set;
}

// --- rayinfo()

const char* ray_type(int kind) {
    switch (kind) {
    case SL_RAY_reflection:
        return "specular";
    case SL_RAY_shadow:
        return "transmission";
    case SL_RAY_diffuse:
        return "diffuse";
    default:
        return "camera";
    }
}

std::uint32_t ray_text(const Execution& execution, const MessageQuery& query,
                       std::string_view name) {
    const RaySubject& rays = execution.subject->rays;
    const std::size_t at = subject_index(execution, query);
    sl_string texts[SL_LANES_MAX];
    for (std::uint32_t lane = 0; lane < SL_LANES_MAX; ++lane) {
        const bool has_label = at + lane < rays.labels.size() && rays.labels[at + lane] != nullptr;
        texts[lane] =
            name == "label" && has_label
                ? rays.labels[at + lane]
                : execution.frame.strings.intern(name == "label" ? "" : ray_type(rays.kind));
    }
    copy_strings(query, texts, SL_LANES_MAX, 0);
    return query.mask;
}

// Levels by kind of ray; negative: not such a name.
int ray_depth(const RaySubject& rays, std::string_view name) {
    const int shadow = rays.kind == SL_RAY_shadow ? 1 : 0;
    return name == "depth"           ? rays.level
           : name == "diffusedepth"  ? rays.diffuse_level
           : name == "shadowdepth"   ? shadow
           : name == "speculardepth" ? rays.level - rays.diffuse_level - shadow
                                     : -1;
}

std::uint32_t ray_geometry(const Execution& execution, const MessageQuery& query,
                           std::string_view name) {
    const BatchSubject& subject = *execution.subject;
    const geo::Incident& ray = subject.incident;
    const std::size_t at = subject_index(execution, query);
    if (ray.ox.size() <= at) {
        return 0;
    }
    float planes[3 * SL_LANES_MAX] = {};
    for (std::size_t lane = 0; lane < SL_LANES_MAX && at + lane < ray.ox.size(); ++lane) {
        const std::size_t i = at + lane;
        const base::V3f origin(ray.ox[i], ray.oy[i], ray.oz[i]);
        const base::V3f direction(ray.dx[i], ray.dy[i], ray.dz[i]);
        const float length = i < subject.rays.lengths.size() ? subject.rays.lengths[i] : 0;
        const base::V3f value = name == "origin"      ? origin
                                : name == "direction" ? base::normalize(direction)
                                                      : base::V3f(length, 0, 0);
        for (int k = 0; k < 3; ++k) {
            planes[static_cast<std::size_t>(k) * SL_LANES_MAX + lane] = value[k];
        }
    }
    copy_floats(query, planes, SL_LANES_MAX, 0);
    return query.mask;
}

// Of the ray that found the point.
std::uint32_t from_ray(const Execution& execution, const MessageQuery& query) {
    if (execution.subject == nullptr || query.array_length > 0) {
        return 0;
    }
    const std::string_view name = query.name;
    if (query.type == SL_TYPE_string) {
        return name == "type" || name == "label" ? ray_text(execution, query, name) : 0;
    }
    const bool is_point = name == "origin" || name == "direction";
    if ((is_point && types_agree(query.type, SL_TYPE_point)) ||
        (name == "length" && query.type == SL_TYPE_float)) {
        return ray_geometry(execution, query, name);
    }
    const int depth = ray_depth(execution.subject->rays, name);
    if (depth < 0 || query.type != SL_TYPE_float) {
        return 0;
    }
    const auto value = static_cast<float>(depth);
    copy_floats(query, &value, 0, 0);
    return query.mask;
}

std::uint32_t from_state(const Execution& execution, const MessageQuery& query,
                         const std::optional<StateValue>& state) {
    if (!state || !types_agree(state->type, query.type)) {
        return 0;
    }
    const std::size_t given =
        query.type == SL_TYPE_string ? state->texts.size() : state->floats.size();
    if (given != num_planes(query)) {
        return 0;
    }
    if (query.type == SL_TYPE_string) {
        std::vector<sl_string> texts;
        for (const std::string& text : state->texts) {
            texts.push_back(execution.frame.strings.intern(text));
        }
        copy_strings(query, texts.data(), 0, 0);
    } else {
        copy_floats(query, state->floats.data(), 0, 0);
    }
    return query.mask;
}

std::uint32_t from_attributes(const Execution& execution, const MessageQuery& query) {
    const rib::Attributes* attributes = attributes_of(execution);
    if (attributes == nullptr) {
        return 0;
    }
    if (const std::uint32_t set = from_geometry(execution, query)) {
        return set;
    }
    std::optional<StateValue> state = query_attribute(*attributes, query.name);
    if (!state && std::string_view(query.name) == "Ri:Transformation" &&
        execution.frame.world != nullptr && !execution.subject->hits.empty()) {
        const geo::Hit& hit = execution.subject->hits.front();
        const base::Mat4 camera_from_object =
            execution.frame.world->camera_from_object(hit, hit.time);
        state = world_from_object_value(execution.frame.spaces, camera_from_object);
    }
    return from_state(execution, query, state);
}

} // namespace

std::uint32_t param_of_batch(const MessageQuery& query, const ShaderEntry& shader,
                             rt::ShadeBatch& batch, std::uint32_t at) {
    const int index = matching_param(shader, query);
    if (index < 0) {
        return 0;
    }
    if (query.type == SL_TYPE_string) {
        const sl_string* varying = batch.param_strings(index);
        copy_strings(query, varying != nullptr ? varying : batch.param_uniform_string(index),
                     varying != nullptr ? batch.stride() : 0, at);
    } else if (const float* planes = batch.param_plane(index)) {
        copy_floats(query, planes, batch.stride(), at);
    } else {
        copy_floats(query, batch.param_uniform(index), 0, 0);
    }
    return query.mask;
}

std::uint32_t answer_message(const Execution& execution, const MessageQuery& query) {
    switch (query.kind) {
    case SL_MESSAGE_surface:
        return from_stage(execution, query, &BatchSubject::surface, &rib::Attributes::surface);
    case SL_MESSAGE_displacement:
        return from_stage(execution, query, &BatchSubject::displacement,
                          &rib::Attributes::displacement);
    case SL_MESSAGE_atmosphere:
        return from_stage(execution, query, &BatchSubject::atmosphere,
                          &rib::Attributes::atmosphere);
    case SL_MESSAGE_incident:
    case SL_MESSAGE_opposite:
        return from_volume(execution, query);
    case SL_MESSAGE_ray:
        return from_ray(execution, query);
    case SL_MESSAGE_attribute:
        return from_attributes(execution, query);
    case SL_MESSAGE_option:
        return from_state(execution, query,
                          query_option(execution.frame.scene.options, query.name));
    case SL_MESSAGE_rendererinfo:
        return from_state(execution, query, query_renderer(query.name));
    default:
        return 0; // lightsource() has a service of its own
    }
}

std::string bound_shader_name(const Execution& execution, std::string_view type) {
    struct Row {
        std::string_view type;
        rib::ShaderId rib::Attributes::*which;
    };
    static constexpr Row rows[] = {
        {"surface", &rib::Attributes::surface},
        {"displacement", &rib::Attributes::displacement},
        {"atmosphere", &rib::Attributes::atmosphere},
        {"interior", &rib::Attributes::interior},
        {"exterior", &rib::Attributes::exterior},
    };
    const rib::Attributes* attributes = attributes_of(execution);
    const auto row = std::find_if(std::begin(rows), std::end(rows),
                                  [&](const Row& r) { return r.type == type; });
    if (attributes == nullptr || row == std::end(rows)) {
        return "";
    }
    const rib::ShaderId id = attributes->*(row->which);
    return id < execution.frame.scene.shaders.size() ? execution.frame.scene.shaders[id].name : "";
}

} // namespace trace
