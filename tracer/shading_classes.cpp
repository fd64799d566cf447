// SPDX-License-Identifier: Apache-2.0
#include "tracer/shading_classes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>

namespace trace {

namespace {

// Primitive variables that are geometry or attributes, never parameters (ri.md 10.4).
bool is_standard_variable(const std::string& name) {
    static constexpr std::string_view names[] = {"P",  "Pz", "Pw", "N",  "Np",    "Cs",
                                                 "Os", "s",  "t",  "st", "width", "constantwidth"};
    return std::find(std::begin(names), std::end(names), name) != std::end(names);
}

using Overrides = std::vector<std::vector<ParamOverride>>; // by attribute state

void note_overrides(const rib::Primitive& primitive, std::uint32_t attributes,
                    const rib::Scene& scene, const ShaderSet& shaders, Overrides& out) {
    if (attributes >= scene.attributes.size()) {
        return;
    }
    const rib::Attributes& state = scene.attributes[attributes];
    const std::pair<Stage, const ShaderEntry*> stages[] = {
        {Stage::Displacement, shaders.get(state.displacement)},
        {Stage::Surface, shaders.surface(state.surface)},
        {Stage::Atmosphere, shaders.get(state.atmosphere)}};
    for (const rib::Param& param : primitive.params.params) {
        for (const auto& [stage, shader] : stages) {
            if (shader == nullptr || is_standard_variable(param.name)) {
                continue;
            }
            const ParamOverride found{stage, shader->instance->shader().find_param(param.name),
                                      param.name};
            auto& list = out[attributes];
            if (found.param >= 0 && std::find(list.begin(), list.end(), found) == list.end()) {
                list.push_back(found);
            }
        }
    }
}

Overrides find_overrides(const rib::Scene& scene, const ShaderSet& shaders) {
    Overrides overrides(scene.attributes.size());
    for (const rib::Primitive& primitive : scene.primitives) {
        note_overrides(primitive, primitive.attributes, scene, shaders, overrides);
    }
    for (const rib::Instance& instance : scene.instances) {
        if (instance.object >= scene.objects.size()) {
            continue;
        }
        const auto& members = scene.objects[instance.object].primitives;
        for (std::size_t i = 0; i < std::min(members.size(), instance.attributes.size()); ++i) {
            note_overrides(members[i], instance.attributes[i], scene, shaders, overrides);
        }
    }
    for (auto& list : overrides) { // equal sets, equal lists
        std::sort(list.begin(), list.end());
    }
    return overrides;
}

bool has_fact(const ShadingClass& c, std::uint32_t fact) {
    return std::ranges::any_of(std::array{Stage::Displacement, Stage::Surface, Stage::Atmosphere},
                               [&](Stage stage) {
                                   const ShaderEntry* shader = c.shader(stage);
                                   return shader != nullptr && (shader->object().facts & fact) != 0;
                               });
}

// Lights see the attributes and shaders of what they light.
bool lights_ask(const LightList& list, const LightSet& lights) {
    const auto asks = [&](rib::LightId id) {
        return (lights[id].shader->object().facts & SL_FACT_attributes) != 0;
    };
    return std::ranges::any_of(list.ambient, asks) || std::ranges::any_of(list.directional, asks);
}

ShadingClass class_of(const rib::Attributes& attributes, const ShaderSet& shaders,
                      const LightSet& lights, const std::vector<ParamOverride>& overrides) {
    ShadingClass c;
    c.displacement = shaders.get(attributes.displacement);
    c.surface = shaders.surface(attributes.surface);
    c.atmosphere = shaders.get(attributes.atmosphere);
    c.lights = lights.list(attributes);
    c.by_transform = has_fact(c, SL_FACT_object_space);
    c.by_attributes = has_fact(c, SL_FACT_attributes) || lights_ask(c.lights, lights) ||
                      !attributes.scoped_systems.empty();
    c.overrides = overrides;
    return c;
}

} // namespace

ShadingClasses::ShadingClasses(const rib::Scene& scene, const ShaderSet& shaders,
                               const LightSet& lights) {
    using Key = std::tuple<const ShaderEntry*, const ShaderEntry*, const ShaderEntry*,
                           std::vector<rib::LightId>, std::vector<rib::LightId>, std::uint32_t,
                           std::vector<ParamOverride>>;
    std::map<Key, std::uint32_t> index_of;
    const Overrides overrides = find_overrides(scene, shaders);
    facts_.reserve(scene.attributes.size());
    for (std::uint32_t i = 0; i < scene.attributes.size(); ++i) {
        const rib::Attributes& attributes = scene.attributes[i];
        ShadingClass c = class_of(attributes, shaders, lights, overrides[i]);
        const Key key{c.displacement,       c.surface,
                      c.atmosphere,         c.lights.ambient,
                      c.lights.directional, c.by_attributes ? i : rib::none,
                      c.overrides};
        const auto [it, is_new] =
            index_of.emplace(key, static_cast<std::uint32_t>(classes_.size()));
        if (is_new) {
            classes_.push_back(std::move(c));
        }
        has_matte_ |= attributes.matte == 1;
        const float rate = std::isfinite(attributes.shading_rate) ? attributes.shading_rate : 1;
        facts_.push_back(
            {it->second, attributes.matte == 1, std::sqrt(std::clamp(rate, 1e-4f, 1e6f))});
    }
}

std::vector<bool> shaded_opacity(const rib::Scene& scene, const ShaderSet& shaders) {
    std::vector<bool> shaded;
    shaded.reserve(scene.attributes.size());
    for (const rib::Attributes& attributes : scene.attributes) {
        const sl_object& surface = shaders.surface(attributes.surface)->object();
        shaded.push_back((surface.facts & SL_FACT_writes_opacity) != 0);
    }
    return shaded;
}

} // namespace trace
