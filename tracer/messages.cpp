// SPDX-License-Identifier: Apache-2.0
#include "tracer/messages.h"

#include "tracer/execution.h"
#include "tracer/lights.h"
#include "tracer/shader_set.h"
#include "tracer/sl_types.h"
#include "tracer/state_queries.h"

#include <algorithm>
#include <bit>

namespace trace {

namespace {

std::uint32_t num_planes(const MessageQuery& query) {
    return static_cast<std::uint32_t>(rt::components_of(query.type) *
                                      std::max(query.array_length, 1));
}

template <class Body> void for_lanes(std::uint32_t mask, const Body& body) {
    for (std::uint32_t rest = mask; rest != 0; rest &= rest - 1) {
        body(static_cast<std::uint32_t>(std::countr_zero(rest)));
    }
}

// Copies from planes of `stride`, lane 0 at `at`; stride 0: one value per component for all lanes.
void copy_planes(const Execution& execution, const MessageQuery& query, const float* from,
                 std::uint32_t stride, std::uint32_t at) {
    const std::uint32_t lanes = execution.lanes();
    for (std::uint32_t k = 0; k < num_planes(query); ++k) {
        for_lanes(query.mask, [&](std::uint32_t lane) {
            query.value[k * lanes + lane] = stride == 0 ? from[k] : from[k * stride + at + lane];
        });
    }
}

void copy_strings(const MessageQuery& query, const sl_string* from, bool varying,
                  std::uint32_t at) {
    auto* out = reinterpret_cast<sl_string*>(query.value);
    for_lanes(query.mask,
              [&](std::uint32_t lane) { out[lane] = varying ? from[at + lane] : from[0]; });
}

int matching_param(const ShaderEntry& shader, const MessageQuery& query) {
    const int index = shader.instance->shader().find_param(query.name);
    if (index < 0) {
        return -1;
    }
    const sl_param& param = shader.object().params[index];
    // Arrays of strings have no form in the service.
    const bool fits = types_agree(param.type, query.type) &&
                      param.array_length == query.array_length &&
                      !(param.type == SL_TYPE_string && param.array_length > 0);
    return fits ? index : -1;
}

// A parameter as a batch holds it now: output parameters have their last value.
std::uint32_t param_of_batch(const Execution& execution, const MessageQuery& query,
                             const ShaderEntry& shader, rt::ShadeBatch& batch, std::uint32_t at) {
    const int index = matching_param(shader, query);
    if (index < 0) {
        return 0;
    }
    if (query.type == SL_TYPE_string) {
        const sl_string* varying = batch.param_strings(index);
        copy_strings(query, varying != nullptr ? varying : batch.param_uniform_string(index),
                     varying != nullptr, at);
    } else if (const float* planes = batch.param_plane(index)) {
        copy_planes(execution, query, planes, batch.stride(), at);
    } else {
        copy_planes(execution, query, batch.param_uniform(index), 0, 0);
    }
    return query.mask;
}

// A parameter as it was bound: the shader has not run, or runs elsewhere.
std::uint32_t param_of_instance(const Execution& execution, const MessageQuery& query,
                                const ShaderEntry* shader) {
    const int index = shader != nullptr ? matching_param(*shader, query) : -1;
    if (index < 0) {
        return 0;
    }
    if (query.type == SL_TYPE_string) {
        const sl_string text = shader->instance->uniform_string(index);
        copy_strings(query, &text, false, 0);
    } else {
        copy_planes(execution, query, shader->instance->uniform_floats(index), 0, 0);
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

std::uint32_t from_light(const Execution& execution, const MessageQuery& query) {
    LightRun* light = execution.current_light;
    return light == nullptr
               ? 0
               : param_of_batch(execution, query, *light->info().shader, light->batch(), 0);
}

// Lights see the surface they light, volumes the surface at their far end.
std::uint32_t from_surface(const Execution& execution, const MessageQuery& query) {
    const Execution* surface =
        execution.asked_by != nullptr ? execution.asked_by : execution.surface;
    if (surface != nullptr && surface->batch != nullptr &&
        surface->running.object().type == SL_SHADER_surface) {
        // A light's lanes are those of the packet it lights; a volume's batch is the surface's.
        const std::uint32_t at =
            query.first + (execution.asked_by != nullptr ? execution.asked_first : 0);
        return param_of_batch(execution, query, surface->running, *surface->batch, at);
    }
    return param_of_instance(execution, query, bound_shader(execution, &rib::Attributes::surface));
}

std::uint32_t from_state(const Execution& execution, const MessageQuery& query,
                         const std::optional<StateValue>& state) {
    if (!state || !types_agree(state->type, query.type)) {
        return 0;
    }
    if (query.type == SL_TYPE_string) {
        const sl_string text = execution.frame.strings.intern(state->text);
        copy_strings(query, &text, false, 0);
        return query.mask;
    }
    if (state->floats.size() != num_planes(query)) {
        return 0;
    }
    copy_planes(execution, query, state->floats.data(), 0, 0);
    return query.mask;
}

std::uint32_t from_attributes(const Execution& execution, const MessageQuery& query) {
    const rib::Attributes* attributes = attributes_of(execution);
    if (attributes == nullptr) {
        return 0;
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

std::uint32_t answer_message(const Execution& execution, const MessageQuery& query) {
    switch (query.kind) {
    case SL_MESSAGE_lightsource:
        return from_light(execution, query);
    case SL_MESSAGE_surface:
        return from_surface(execution, query);
    case SL_MESSAGE_atmosphere:
        return param_of_instance(execution, query,
                                 bound_shader(execution, &rib::Attributes::atmosphere));
    case SL_MESSAGE_attribute:
        return from_attributes(execution, query);
    case SL_MESSAGE_option:
        return from_state(execution, query,
                          query_option(execution.frame.scene.options, query.name));
    case SL_MESSAGE_rendererinfo:
        return from_state(execution, query, query_renderer(query.name));
    default:
        return 0; // displacement, incident, opposite: such shaders do not run yet
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
    if (type == "lightsource") {
        return execution.current_light != nullptr ? execution.current_light->info().shader->name
                                                  : "";
    }
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
