// SPDX-License-Identifier: Apache-2.0
// Lights: light shaders run for packets of points, shadows included (sl.md 5.3-5.6).
// LightSet is the frame's immutable list; a LightRun is one light's working memory on one thread.
// The light vector is negated on the way out: shaders being lit see L from the point towards the
// light, its length kept.
#pragma once

#include "runtime/batch.h"
#include "tracer/execution.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace trace {

class ShaderSet;
struct ShaderEntry;

struct LightInfo {
    const ShaderEntry* shader = nullptr; // nullptr: the light is off (missing shader)
    bool directional = false;            // contains illuminate or solar; else ambient
    bool from_infinity = false;          // contains solar
    bool casts_shadows = false;          // Attribute "light" "shadows" "on"
    base::Color color{1}, opacity{1};    // attribute state at the light: Cs, Os ([R] of sl.md 3.3)
    std::vector<std::string> categories; // of its __category
    int nondiffuse = -1;                 // parameter __nondiffuse, or -1
    int nonspecular = -1;
    bool reusable = true;     // the same point gives the same result: no random(), no messages
    bool is_constant = false; // every point gives the same result
};

// The lights of one attribute state, in declaration order.
struct LightList {
    std::vector<rib::LightId> ambient;
    std::vector<rib::LightId> directional;
    bool needs_differences = false; // some light asks how Ps differs at the auxiliary points
    friend bool operator==(const LightList&, const LightList&) = default;
};

class LightSet {
public:
    LightSet(const rib::Scene& scene, const ShaderSet& shaders, base::Diag& diag);

    [[nodiscard]] const LightInfo& operator[](rib::LightId id) const { return lights_[id]; }
    [[nodiscard]] std::size_t size() const { return lights_.size(); }
    [[nodiscard]] LightList list(const rib::Attributes& attributes) const;

private:
    std::vector<LightInfo> lights_;
};

// Category selection of sl.md 5.5: "" selects all, "a" those whose list holds a, "-a" those whose
// list does not.
[[nodiscard]] bool in_category(const std::vector<std::string>& categories, std::string_view wanted);

class LightRun {
public:
    // Prepares for a batch of `asker`; what was found for other batches is forgotten.
    void attach(Execution& asker, const LightInfo& info);
    // Runs the light for the points of a packet (query.N may be null) unless the last run was for
    // them. Returns the lanes of query.mask whose illuminate or solar was executed; ambient lights:
    // all of them.
    std::uint32_t illuminate(const sl_light_query& query);
    // Lanes of `mask` from which nothing opaque hides the light.
    std::uint32_t unshadowed(std::uint32_t mask);
    [[nodiscard]] bool wants(sl_string category);

    [[nodiscard]] const LightInfo& info() const { return *info_; }
    [[nodiscard]] rt::ShadeBatch& batch() { return batch_; }
    // A parameter's value in a lane; 0 for no parameter (index -1).
    [[nodiscard]] float param(int index, std::uint32_t lane);

private:
    void begin();
    void run(std::uint32_t num_points);
    void drop_bad();
    void fill_frame(const Space& space);
    void fill_points(std::uint32_t mask, const float* P, const float* N);
    void send(const sl_light_query& query);
    void send_value(const sl_light_query& query, int index, const sl_value& value);
    void fill_differences(std::uint32_t mask);
    void fill_seeds_and_time();
    void reset_results();
    [[nodiscard]] bool is_known(const sl_light_query& query) const;
    [[nodiscard]] std::uint32_t executed() const;
    [[nodiscard]] base::V3f shadow_origin(std::uint32_t lane, const base::V3f& to_light) const;

    Execution* asker_ = nullptr;
    const LightInfo* info_ = nullptr;
    const rt::ShaderInstance* instance_ = nullptr; // of its shader, as it runs now
    std::optional<Execution> execution_;
    rt::ShadeBatch batch_;
    std::uint64_t serial_ = 0;
    std::uint32_t first_ = 0, lanes_ = 0;
    std::uint32_t known_ = 0; // lanes the batch holds results for
    bool sent_ = false;       // the batch's parameters hold what an illuminance sent
    std::uint32_t traced_ = 0,
                  clear_ = 0; // lanes whose shadow ray is known, and those it left open
    float Ps_[3][SL_LANES_MAX] = {};
    sl_string category_ = nullptr; // of the last wants(), and its answer
    bool wanted_ = true;
};

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
