// SPDX-License-Identifier: Apache-2.0
// Patches, patch meshes and NURBS as one thing: a rectangle of (rational) Bezier sub-patches.
// Enters: the control points of a request and, for each parametric direction, how its basis turns
// them into Bezier points. Leaves: positions and derivatives at any (u,v), in the space of the
// control points, in double. Any vertex-class variable goes through the same maps, so it is
// interpolated exactly as the position is. Sources: reference equations of RI 3.2 for bases and
// NURBS; Bezier points of a B-spline span by blossoming, [Ramshaw89].
#pragma once

#include "ribtools/scene.h"
#include "runtime/base/vec.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace geo {

// One parametric direction: num_parts() spans, each a linear map from a few control points to
// degree+1 Bezier points.
class SpanMap {
public:
    struct Part {
        std::vector<int> input;      // control point indices, already wrapped
        std::vector<double> weights; // (degree+1) rows of input.size() columns
        double t0 = 0, t1 = 1;       // the span in the parameter of the whole surface
        int segment = 0;             // nominal segment that carries varying and uniform data ...
        double s0 = 0, s1 = 1;       // ... and the ends of that segment in the same parameter
    };

    // Bicubic direction with a 16-number basis (rows = powers) and step; nullopt + reason on bad
    // counts.
    static std::optional<SpanMap> bicubic(int num_points, bool periodic,
                                          const std::array<float, 16>& basis, int step,
                                          std::string& reason);
    static std::optional<SpanMap> bilinear(int num_points, bool periodic, std::string& reason);
    // B-spline of the given order over [min,max]; empty knot spans make no part.
    static std::optional<SpanMap> nurbs(int num_points, int order, std::span<const float> knots,
                                        double min, double max, std::string& reason);

    // Every part cut in two at its middle: the same surface from twice as many parts.
    [[nodiscard]] SpanMap halved() const;

    [[nodiscard]] int degree() const { return degree_; }
    [[nodiscard]] int num_points() const { return num_points_; }
    [[nodiscard]] int num_segments() const {
        return num_segments_;
    } // nominal, empty spans included
    [[nodiscard]] bool periodic() const { return periodic_; }
    [[nodiscard]] const std::vector<Part>& parts() const { return parts_; }

private:
    int degree_ = 0, num_points_ = 0, num_segments_ = 0;
    bool periodic_ = false;
    std::vector<Part> parts_;
};

// The maps of a request in both directions.
struct PatchLayout {
    SpanMap u, v;

    static std::optional<PatchLayout> make(const rib::Patches& patches, const rib::Basis& basis,
                                           std::string& reason);
    static std::optional<PatchLayout> make(const rib::NuPatch& patch, std::string& reason);

    [[nodiscard]] int num_parts() const {
        return static_cast<int>(u.parts().size() * v.parts().size());
    }
    [[nodiscard]] const SpanMap::Part& part_u(int part) const {
        return u.parts()[static_cast<std::size_t>(part) % u.parts().size()];
    }
    [[nodiscard]] const SpanMap::Part& part_v(int part) const {
        return v.parts()[static_cast<std::size_t>(part) / u.parts().size()];
    }
    [[nodiscard]] std::size_t heap_bytes() const;
    [[nodiscard]] std::size_t points_per_part() const {
        return static_cast<std::size_t>(u.degree() + 1) * static_cast<std::size_t>(v.degree() + 1);
    }
};

// Bezier control values of every part for `dim` numbers per control point. Part p, point (i,j),
// component k: values[((p * points_per_part) + j * (degree_u + 1) + i) * dim + k]. Values shared by
// neighbouring parts are made bit-identical, so that edges evaluated from them are.
[[nodiscard]] std::vector<double> bezier_values(const PatchLayout& layout,
                                                std::span<const double> control, int dim);

// Homogeneous nets (dim 4) of all parts from "Pw" (4 numbers per point) or "P" (3; the weight of
// every Bezier point is then 1, whatever the basis: power and Hermite geometry vectors do not sum
// to one).
[[nodiscard]] std::vector<double> position_net(const PatchLayout& layout,
                                               std::span<const double> control, bool rational);

struct BezierPoint {
    base::V3d P, dPdu, dPdv; // derivatives by the local (s,t) in [0,1] of the part
};

// Evaluates one part at local (s,t). net: its control values, dim 4 = homogeneous (x, y, z
// premultiplied by w).
[[nodiscard]] BezierPoint evaluate_part(int degree_u, int degree_v, const double* net, double s,
                                        double t);

// The same net for `dim` plain numbers: out[k].
void evaluate_values(int degree_u, int degree_v, const double* net, int dim, double s, double t,
                     double* out);

// Bernstein polynomials of a degree (<= max_degree) and their derivatives at t.
constexpr int max_degree = 31;
void bernstein(int degree, double t, double* value, double* derivative);

} // namespace geo
