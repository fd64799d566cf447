// SPDX-License-Identifier: Apache-2.0
// render --check-energy: which surface shaders return more light than they get. In: a frame. Out: a
// table of every surface shader's reflectance, and an error for each that gives light away. Each
// instance is looked at where the camera's picture shows it, lit by one light at a time over a
// range of angles, then by even surroundings (ambient(), trace()). Radiometry: a matte surface of
// color 1 returns exactly 1 (design.md, section 7). The paper asked for it ([Gritz96] section 5).
#pragma once

#include "runtime/base/vec.h"
#include "tracer/execution.h"

#include <cstdint>
#include <string>
#include <vector>

namespace trace {

class Camera;
class ShadingClasses;

// Share of the light that comes back, in the channel where that is most.
struct EnergyShare {
    double value = 0, standard_error = 0;
    int channel = 0;
    float angle_deg = 0; // between the normal and the light, or the eye

    // Beyond doubt, and beyond what rounding explains.
    [[nodiscard]] bool is_too_much() const { return value > 1.005 + 3 * standard_error; }
};

struct EnergyRow {
    const ShaderEntry* shader = nullptr;
    std::size_t num_places = 0; // where it was looked at; 0: nowhere in the picture
    std::vector<EnergyShare> by_light, by_surroundings; // the worst place, by angle
};

class EnergyCheck {
public:
    EnergyCheck(const FrameContext& frame, const Camera& camera, const ShadingClasses& classes,
                ThreadState& thread);

    // By shader, in the order the picture shows them.
    [[nodiscard]] std::vector<EnergyRow> run();

private:
    struct Place {
        geo::Hit hit;
        float footprint;
    };
    struct Subject {
        const ShaderEntry* shader;
        std::vector<Place> places;
    };
    [[nodiscard]] std::vector<Subject> find_places() const;
    [[nodiscard]] EnergyRow check(const Subject& subject);

    const FrameContext& frame_;
    const Camera& camera_;
    const ShadingClasses& classes_;
    ThreadState& thread_;
};

// The table, for people.
[[nodiscard]] std::string energy_text(const std::vector<EnergyRow>& rows);
// Errors about those that return too much, at the place of their calls.
void report_energy(const std::vector<EnergyRow>& rows, base::Diag& diag);

} // namespace trace
