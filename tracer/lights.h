// SPDX-License-Identifier: Apache-2.0
// Lights: what the frame knows of them, and the services by which shaders ask (sl.md 5.3-5.6).
// LightSet is the frame's immutable list; light_run.h runs their shaders, transmission.h casts
// their shadows.
#pragma once

#include "tracer/execution.h"

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace geo {
class AreaSet;
}

namespace trace {

class LightCells;
class ShaderSet;
struct ShaderEntry;

struct LightInfo {
    const ShaderEntry* shader = nullptr; // nullptr: the light is off (missing shader)
    bool is_indirect = false;            // the light "indirect": no shader
    bool directional = false;            // contains illuminate or solar; else ambient
    bool from_infinity = false;          // contains solar
    bool casts_shadows = false;          // Attribute "light" "shadows" "on"
    std::int32_t num_samples = 1;        // Attribute "light" "nsamples"
    base::Color color{1}, opacity{1};    // attribute state at the light: Cs, Os ([R] of sl.md 3.3)
    std::vector<std::string> categories; // of its __category
    int nondiffuse = -1;                 // parameter __nondiffuse, or -1
    int nonspecular = -1;
    bool reusable = true;     // the same point gives the same result: no random(), no messages
    bool is_constant = false; // every point gives the same result

    std::shared_ptr<const geo::AreaSet> area; // area lights: their surfaces; else null
    bool by_angle = false; // places are chosen by solid angle where that can be (light-002)
};

// The lights of one attribute state, in declaration order.
struct LightList {
    bool is_indirect = false; // the light "indirect" shines: ambient() is what surfaces send
    std::vector<rib::LightId> ambient;
    std::vector<rib::LightId> directional;
    bool needs_differences = false; // some light asks how Ps differs at the auxiliary points
    bool asks_all = false;          // Attribute "light" "choose" 0: none is left out
    friend bool operator==(const LightList&, const LightList&) = default;
};

class LightSet {
public:
    LightSet(const rib::Scene& scene, const ShaderSet& shaders);
    ~LightSet();
    // Once the world is there: the surfaces of area lights, and what their shaders are like.
    void take_world(const FrameContext& frame);

    [[nodiscard]] const LightInfo& operator[](rib::LightId id) const { return lights_[id]; }
    [[nodiscard]] std::size_t size() const { return lights_.size(); }
    // Null where lights are never chosen from.
    [[nodiscard]] const LightCells* cells() const { return cells_.get(); }
    [[nodiscard]] LightList list(const rib::Attributes& attributes) const;

private:
    std::vector<LightInfo> lights_;
    std::unique_ptr<LightCells> cells_;
};

// Category selection of sl.md 5.5: "" selects all, "a" those whose list holds a, "-a" those whose
// list does not. Of several, joined by & and |, & binds closer.
[[nodiscard]] bool in_category(const std::vector<std::string>& categories, std::string_view wanted);

// The service `light`: run, negate, test cone and category, shadow. Returns the lanes the light
// reaches; a lane in shadow is reached with Cl 0 (sl.md 5.6: Cl times visibility).
std::uint32_t run_light(Execution& execution, const sl_light_query& query, sl_light_result& result);

// The service `light_message`. The light is run again if it has lit other points since.
std::uint32_t answer_light_message(Execution& execution, const sl_light_query& query,
                                   sl_string name, std::int32_t type, std::int32_t array_length,
                                   float* value);

// The service `solar_direction`, planes of the execution's lanes; axis null: all directions.
struct SolarQuery {
    std::uint32_t first = 0, mask = 0;
    const float *axis = nullptr, *angle = nullptr;
    float* L = nullptr;
};
void choose_solar_direction(const Execution& execution, const SolarQuery& query);

// The service `ambient`: sum of Cl over the ambient lights, 3 planes.
void run_ambient(Execution& execution, std::uint32_t first, std::uint32_t mask, const float* P,
                 float* C);

} // namespace trace
