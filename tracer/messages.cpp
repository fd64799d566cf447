// SPDX-License-Identifier: Apache-2.0
#include "tracer/messages.h"

#include "tracer/execution.h"
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

// The volumes of the two sides: Exterior outside, or the Atmosphere where there is none; Interior
// inside.
std::uint32_t from_volume(const Execution& execution, const MessageQuery& query) {
    if (execution.subject == nullptr) {
        return 0;
    }
    const ShaderEntry* exterior = bound_shader(execution, &rib::Attributes::exterior);
    if (exterior == nullptr) {
        exterior = bound_shader(execution, &rib::Attributes::atmosphere);
    }
    const ShaderEntry* interior = bound_shader(execution, &rib::Attributes::interior);
    const std::uint32_t outside = facing_of(execution, query).outside;
    const bool is_incident = query.kind == SL_MESSAGE_incident;
    MessageQuery of_exterior = query, of_interior = query;
    of_exterior.mask = is_incident ? outside : query.mask & ~outside;
    of_interior.mask = query.mask & ~of_exterior.mask;
    return param_of_instance(of_exterior, exterior) | param_of_instance(of_interior, interior);
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
