// SPDX-License-Identifier: Apache-2.0
// Which points may share a batch. Attribute states that shade alike (displacement, surface,
// atmosphere, lights) form one class; a class says by what else its points must be told apart. Made
// once per frame: at a hit it is one table lookup.
#pragma once

#include "ribtools/scene.h"
#include "tracer/lights.h"
#include "tracer/shader_set.h"

#include <compare>
#include <cstdint>
#include <string>
#include <vector>

namespace trace {

// The shaders that run on a point, in this order.
enum class Stage : std::uint8_t { Displacement, Surface, Atmosphere };

// A parameter that some primitive of the class supplies as a primitive variable (sl.md 5.8, 3).
struct ParamOverride {
    Stage stage = Stage::Surface;
    int param = -1;
    std::string name;
    friend auto operator<=>(const ParamOverride&, const ParamOverride&) = default;
};

struct ShadingClass {
    const ShaderEntry* displacement = nullptr; // or none
    const ShaderEntry* surface = nullptr;
    const ShaderEntry* atmosphere = nullptr; // or none
    LightList lights;
    bool by_transform = false;  // the shaders name object space
    bool by_attributes = false; // they or their lights ask for attributes or messages: one
                                // attribute state per class
    std::vector<ParamOverride> overrides;
    [[nodiscard]] const ShaderEntry* shader(Stage stage) const {
        return stage == Stage::Displacement ? displacement
               : stage == Stage::Surface    ? surface
                                            : atmosphere;
    }
    // Points of such a class are told apart beyond the class.
    [[nodiscard]] bool needs_key() const { return by_transform || !overrides.empty(); }
};

// What the tracer asks of an attribute state per hit.
struct AttributeFacts {
    std::uint32_t shading_class = 0;
    bool is_matte = false; // hides, but shows nothing (Matte 2 shows)
    float spacing_px = 1;  // between shading samples: root of the shading rate
};

class ShadingClasses {
public:
    ShadingClasses(const rib::Scene& scene, const ShaderSet& shaders, const LightSet& lights);

    [[nodiscard]] const AttributeFacts& facts(std::uint32_t attributes) const {
        return facts_[attributes];
    }
    [[nodiscard]] const ShadingClass& operator[](std::uint32_t index) const {
        return classes_[index];
    }
    [[nodiscard]] std::size_t size() const { return classes_.size(); }
    [[nodiscard]] bool has_matte() const { return has_matte_; }

private:
    std::vector<AttributeFacts> facts_; // by attribute state
    std::vector<ShadingClass> classes_;
    bool has_matte_ = false;
};

// By attribute state: its surface or displacement shader may change the opacity of a point.
[[nodiscard]] std::vector<bool> shaded_opacity(const rib::Scene& scene, const ShaderSet& shaders);

} // namespace trace
