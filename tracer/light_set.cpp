// SPDX-License-Identifier: Apache-2.0
// The frame's lights as facts: which are ambient, directional, shadowed, and their categories.
#include "tracer/area_light.h"
#include "tracer/indirect_light.h"
#include "tracer/light_choice.h"
#include "tracer/lights.h"
#include "tracer/shader_set.h"

#include <algorithm>

namespace trace {

namespace {

// Comma-separated; blanks around the names do not count.
std::vector<std::string> split_categories(std::string_view text) {
    std::vector<std::string> names;
    constexpr std::string_view separators = ", \t";
    for (std::size_t begin = text.find_first_not_of(separators); begin != std::string_view::npos;) {
        const std::size_t end = std::min(text.find_first_of(separators, begin), text.size());
        names.emplace_back(text.substr(begin, end - begin));
        begin = text.find_first_not_of(separators, end);
    }
    return names;
}

int find_param(const ShaderEntry& shader, std::string_view name, sl_type type) {
    const int index = shader.instance->shader().find_param(name);
    const bool matches = index >= 0 && shader.object().params[index].type == type &&
                         shader.object().params[index].array_length == 0;
    return matches ? index : -1;
}

bool attribute_is(const rib::Attributes& attributes, const char* name, std::string_view wanted) {
    const rib::Param* param = attributes.find(name);
    return param != nullptr && !param->strings.empty() && param->strings.front() == wanted;
}

bool attribute_is_0(const rib::Attributes& attributes, const char* name) {
    const rib::Param* param = attributes.find(name);
    return param != nullptr && ((!param->ints.empty() && param->ints.front() == 0) ||
                                (!param->floats.empty() && param->floats.front() == 0));
}

// Nothing such a light reads differs between points or executions.
bool is_constant(const sl_object& object) {
    constexpr std::uint64_t same_everywhere =
        1ULL << SL_VAR_E | 1ULL << SL_VAR_ncomps | 1ULL << SL_VAR_Cl | 1ULL << SL_VAR_Ol;
    constexpr std::uint32_t unlike_facts = SL_FACT_random | SL_FACT_traces | SL_FACT_textures |
                                           SL_FACT_attributes | SL_FACT_lights |
                                           SL_FACT_directional;
    return (object.needed & ~same_everywhere) == 0 && (object.facts & unlike_facts) == 0;
}

void read_facts(LightInfo& info) {
    const ShaderEntry& shader = *info.shader;
    const sl_object& object = shader.object();
    info.directional = (object.facts & SL_FACT_directional) != 0;
    info.from_infinity = (object.facts & SL_FACT_solar) != 0;
    // Messages may have another answer a moment later.
    info.reusable = (object.facts & (SL_FACT_random | SL_FACT_traces | SL_FACT_attributes)) == 0;
    info.is_constant = is_constant(object);
    info.nondiffuse = find_param(shader, "__nondiffuse", SL_TYPE_float);
    info.nonspecular = find_param(shader, "__nonspecular", SL_TYPE_float);
    const int category = find_param(shader, "__category", SL_TYPE_string);
    if (category >= 0 && object.params[category].detail == SL_DETAIL_uniform) {
        info.categories = split_categories(shader.instance->uniform_string(category));
    }
}

std::int32_t num_samples(const rib::Attributes& attributes) {
    constexpr int most = 4096; // more for each point is a typing mistake
    const rib::Param* param = attributes.find("light:nsamples");
    const double given = param == nullptr         ? 1
                         : !param->ints.empty()   ? param->ints.front()
                         : !param->floats.empty() ? static_cast<double>(param->floats.front())
                                                  : 1;
    return static_cast<std::int32_t>(std::clamp(given, 1.0, double(most)));
}

// Text without the blanks at its ends.
std::string_view trimmed(std::string_view text) {
    const auto is_blank = [](char c) { return c == ' ' || c == '\t'; };
    while (!text.empty() && is_blank(text.front())) {
        text.remove_prefix(1);
    }
    while (!text.empty() && is_blank(text.back())) {
        text.remove_suffix(1);
    }
    return text;
}

// The first part of a text up to a separator, which is taken off too.
std::string_view next_part(std::string_view& text, char separator) {
    const std::size_t end = std::min(text.find(separator), text.size());
    const std::string_view part = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    return trimmed(part);
}

bool has_category(const std::vector<std::string>& categories, std::string_view wanted) {
    const bool excludes = wanted.starts_with('-');
    if (excludes) {
        wanted = trimmed(wanted.substr(1));
    }
    const bool found = std::find(categories.begin(), categories.end(), wanted) != categories.end();
    return found != excludes;
}

} // namespace

bool in_category(const std::vector<std::string>& categories, std::string_view wanted) {
    if (wanted.empty()) {
        return true;
    }
    bool any = false;
    while (!any && !wanted.empty()) {
        std::string_view term = next_part(wanted, '|');
        bool all = true;
        while (all && !term.empty()) {
            all = has_category(categories, next_part(term, '&'));
        }
        any = all;
    }
    return any;
}

LightSet::~LightSet() = default;

LightSet::LightSet(const rib::Scene& scene, const ShaderSet& shaders) {
    lights_.reserve(scene.lights.size());
    for (const rib::Light& light : scene.lights) {
        LightInfo& info = lights_.emplace_back();
        info.is_indirect = is_indirect_light(scene, light);
        info.shader = shaders.get(light.shader);
        if (info.shader == nullptr) {
            continue;
        }
        read_facts(info);
        if (light.attributes < scene.attributes.size()) {
            const rib::Attributes& state = scene.attributes[light.attributes];
            info.color = {state.color[0], state.color[1], state.color[2]};
            info.opacity = {state.opacity[0], state.opacity[1], state.opacity[2]};
            info.num_samples = num_samples(state);
            info.casts_shadows = info.directional && attribute_is(state, "light:shadows", "on");
        }
    }
}

void LightSet::take_world(const FrameContext& frame) {
    for (rib::LightId id = 0; id < lights_.size(); ++id) {
        const rib::Light& light = frame.scene.lights[id];
        if (lights_[id].shader != nullptr && light.is_area && lights_[id].directional) {
            lights_[id].area = frame.world->area_set(light.area_primitives);
            learn_area(frame, id, lights_[id]);
        }
    }
    const LightChoiceOptions options = light_choice_options(frame.scene.options);
    if (options.samples > 0 && lights_.size() > options.all_up_to) {
        cells_ = std::make_unique<LightCells>(frame, options);
    }
}

LightList LightSet::list(const rib::Attributes& attributes) const {
    LightList list;
    list.asks_all = attribute_is_0(attributes, "light:choose");
    for (const rib::LightId id : attributes.lights) {
        list.is_indirect |= id < lights_.size() && lights_[id].is_indirect;
        if (id < lights_.size() && lights_[id].shader != nullptr) {
            (lights_[id].directional ? list.directional : list.ambient).push_back(id);
            list.needs_differences |=
                (lights_[id].shader->object().needed_aux >> SL_VAR_Ps & 1U) != 0;
        }
    }
    return list;
}

} // namespace trace
