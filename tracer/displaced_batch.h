// SPDX-License-Identifier: Apache-2.0
// The points of a batch as their displacement shader leaves them (sl.md 3.2, 5.1): what it
// assigned, and what follows from it: I from the new P, dPdu and dPdv from the differences of the
// new P, Ng and, where the shader left N alone, N from those.
//
//   begin -> geometry fills points() -> keep_position -> the shader runs -> finish -> apply
//
// In: the batch of the displacement shader, what the shaders after it need. Out: the planes of
// those shaders, which hold the undisplaced values before. What nobody needs is not computed.
// Differences of dPdu, dPdv, Ng, and of an N that follows from P, stay those of the undisplaced
// surface: three points do not tell more.
#pragma once

#include "geometry/world.h"
#include "runtime/batch.h"

#include <array>
#include <cstdint>

namespace trace {

// Variables as bits 1 << sl_variable.
struct NeededVariables {
    std::uint64_t main = 0;
    std::uint64_t aux = 0; // differences at the auxiliary points
};

// The rays that see the points.
struct ShadingView {
    geo::Incident incident;
    bool perspective = true; // of the camera
};

// Variables that are not what geometry says once this displacement shader has run.
[[nodiscard]] std::uint64_t changed_by(const sl_object& displacement);

class DisplacedBatch {
public:
    // batch: begun for the displacement shader; it must live until the last apply().
    void begin(rt::ShadeBatch& batch, NeededVariables needed);

    // What geometry fills, and where to.
    [[nodiscard]] std::uint64_t filled() const { return filled_; }
    [[nodiscard]] const sl_points& points() const { return points_; }
    // Of these also du, dv and the differences depend on the footprint.
    [[nodiscard]] static NeededVariables needed_before(const sl_object& displacement,
                                                       NeededVariables after);

    // Before the shader runs.
    void keep_position();
    // After it has run.
    void finish();
    // The changed ones among the variables that have planes, and among the differences.
    void apply(const sl_points& main, const sl_points* aux_u, const sl_points* aux_v,
               const ShadingView& view) const;

private:
    static constexpr std::size_t size = SL_BATCH_MAX;
    struct alignas(64) Triple {
        std::array<float, 3 * size> values;
    };

    void scratch(sl_variable id, float* planes);
    void finish_point(std::size_t i);
    void move_incident(float* I, const ShadingView& view) const;
    void apply_normal(const sl_points& out) const;
    void apply_differences(const sl_points& out, const sl_points& from,
                           const ShadingView& view) const;

    rt::ShadeBatch* batch_ = nullptr;
    std::uint64_t filled_ = 0;
    sl_points points_{};
    bool keeps_position_ = false, has_derivatives_ = false, has_normal_ = false;
    Triple P_before_;
    // Of the undisplaced surface where the shader has no planes for them, then of the displaced.
    Triple dPdu_, dPdv_, Ng_;
    alignas(64) std::array<float, size> du_, dv_;
    Triple N_; // that follows from P; 0: none does
};

} // namespace trace
