// SPDX-License-Identifier: Apache-2.0
// Surfaces swept by a generator curve about the z axis: all seven quadrics of ri.md 11.9 are one.
// P(u, v) = Rotate(u * thetamax) * generator(v). A kind supplies the curve, its roots along a ray
// and the inverse map; sweeps, culling, derivatives and differences are done here, once.
#pragma once

#include "geometry/roots.h"
#include "geometry/surface.h"
#include "ribtools/scene.h"

#include <memory>
#include <string>

namespace geo {

class Revolution : public Surface {
public:
    [[nodiscard]] TraceForm trace_form() const final { return TraceForm::Analytic; }
    [[nodiscard]] Box bound(const Mat4& dst_from_object) const override;
    [[nodiscard]] bool intersect(const ObjectRay& ray, LocalHit& hit) const final;
    [[nodiscard]] std::size_t heap_bytes() const final {
        return 128;
    } // about; kinds differ by a few numbers
    [[nodiscard]] SurfacePoint evaluate(const LocalPoint& at) const final;
    [[nodiscard]] SurfacePoint difference(const LocalPoint& at, const SurfacePoint& here, double du,
                                          double dv) const final;
    [[nodiscard]] std::array<double, 2> max_step() const final;
    [[nodiscard]] std::size_t num_items(rib::StorageClass storage) const final;
    void stencil(rib::StorageClass storage, const LocalPoint& at, Stencil& out) const final;

protected:
    // The generator at theta = 0.
    struct Generator {
        V3d p;
        V3d dp; // by v; finite everywhere
        V3d n;  // along (d/dtheta x d/dv), any length but zero: its limit where that vanishes
    };
    // A circle that the surface lies within the hull of.
    struct Ring {
        double radius, z;
    };
    static constexpr double edge_slack =
        1e-12; // closed limits in spite of rounding, relative to u and v in 0..1

    // Clamped to a whole turn.
    explicit Revolution(double thetamax_deg);
    [[nodiscard]] bool is_whole_turn() const;

    [[nodiscard]] virtual Generator generator(double v) const = 0;
    // generator(v + dv).p - generator(v).p, without cancellation.
    [[nodiscard]] virtual V3d generator_difference(double v, double dv) const = 0;
    // All t where o + t d meets the unlimited surface. |o + t d| is about the size of the surface
    // there.
    [[nodiscard]] virtual Roots roots(const V3d& o, const V3d& d) const = 0;
    // The parameters of a point of the unlimited surface; false outside the limits.
    [[nodiscard]] virtual bool locate(const V3d& P, double& u, double& v) const = 0;
    // Rings whose hull holds the surface.
    [[nodiscard]] virtual std::array<Ring, 2> hull() const = 0;

    // u of an angle from the generator; false outside the sweep.
    [[nodiscard]] bool sweep_u(double theta, double& u) const;
    // Clamps v to 0..1; false if it is outside by more than rounding.
    [[nodiscard]] static bool limit_v(double& v);

private:
    double thetamax_;
};

// nullptr and the reason when the arguments describe no surface.
[[nodiscard]] std::unique_ptr<Surface> make_quadric(const rib::Quadric& quadric, std::string& why);
[[nodiscard]] const char* quadric_name(rib::QuadricKind kind);

} // namespace geo
