// SPDX-License-Identifier: Apache-2.0
#include "tracer/shading_classes.h"

#include <algorithm>
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
    for (const rib::Param& param : primitive.params.params) {
        if (is_standard_variable(param.name)) {
            continue;
        }
        const ShaderEntry& surface = *shaders.surface(scene.attributes[attributes].surface);
        const int index = surface.instance->shader().find_param(param.name);
        auto& list = out[attributes];
        const bool known = std::any_of(list.begin(), list.end(),
                                       [&](const ParamOverride& o) { return o.param == index; });
        if (index >= 0 && !known) {
            list.push_back({index, param.name});
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
        std::sort(list.begin(), list.end(),
                  [](const ParamOverride& a, const ParamOverride& b) { return a.param < b.param; });
    }
    return overrides;
}

bool has_fact(const ShadingClass& c, std::uint32_t fact) {
    const bool surface = c.surface != nullptr && (c.surface->object().facts & fact) != 0;
    return surface || (c.atmosphere != nullptr && (c.atmosphere->object().facts & fact) != 0);
}

ShadingClass class_of(const rib::Attributes& attributes, const ShaderSet& shaders,
                      const LightSet& lights, const std::vector<ParamOverride>& overrides) {
    ShadingClass c;
    c.surface = shaders.surface(attributes.surface);
    c.atmosphere = shaders.get(attributes.atmosphere);
    c.lights = lights.list(attributes);
    c.by_transform = has_fact(c, SL_FACT_object_space);
    c.by_attributes = has_fact(c, SL_FACT_attributes) || !attributes.scoped_systems.empty();
    c.overrides = overrides;
    return c;
}

} // namespace

ShadingClasses::ShadingClasses(const rib::Scene& scene, const ShaderSet& shaders,
                               const LightSet& lights) {
    using Key = std::tuple<const ShaderEntry*, const ShaderEntry*, std::vector<rib::LightId>,
                           std::vector<rib::LightId>, std::uint32_t, std::vector<int>>;
    std::map<Key, std::uint32_t> index_of;
    const Overrides overrides = find_overrides(scene, shaders);
    facts_.reserve(scene.attributes.size());
    for (std::uint32_t i = 0; i < scene.attributes.size(); ++i) {
        const rib::Attributes& attributes = scene.attributes[i];
        ShadingClass c = class_of(attributes, shaders, lights, overrides[i]);
        std::vector<int> params;
        for (const ParamOverride& o : c.overrides) {
            params.push_back(o.param);
        }
        const Key key{c.surface,
                      c.atmosphere,
                      c.lights.ambient,
                      c.lights.directional,
                      c.by_attributes ? i : rib::none,
                      std::move(params)};
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

} // namespace trace
