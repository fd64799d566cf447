// SPDX-License-Identifier: Apache-2.0
// What every family of shapes answers, so that accel, primvar and shade_point need not know kinds.
// Everything here is in the object space of the primitive and in double; transforms are applied by
// the callers.
//
// A surface has one or more *parts* (triangles, sub-patches). A place on it is a LocalPoint: part
// and local parameters: barycentric (b1, b2) on triangles, the true surface parameters elsewhere.
// Shaders see surface parameters (u, v). Immutable after it is made; all const members may be
// called from any thread. To add a family: one file that derives from Surface, one line in
// make_surface() (shapes.cpp).
#pragma once

#include "geometry/dice.h"
#include "geometry/world.h"
#include "ribtools/param.h"
#include "runtime/base/mat.h"

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace geo {

using base::Mat4;
using base::V3d;
using base::V3f;

// Axis-aligned; empty until a point is added.
struct Box {
    V3d lo{std::numeric_limits<double>::infinity()}, hi{-std::numeric_limits<double>::infinity()};

    void add(const V3d& p);
    void add(const Box& b);
    [[nodiscard]] bool empty() const { return !(lo.x <= hi.x && lo.y <= hi.y && lo.z <= hi.z); }
    [[nodiscard]] V3d center() const { return (lo + hi) * 0.5; }
};
// The box of a transformed box.
[[nodiscard]] Box transformed(const Mat4& dst_from_src, const Box& box);

struct LocalPoint {
    std::uint32_t part = 0;
    double u = 0, v = 0;
};

// A point of the surface; also the difference of two points, see Surface::difference.
struct SurfacePoint {
    double u = 0, v = 0; // surface parameters
    V3d P;
    V3d dPdu, dPdv; // true derivatives by the surface parameters; zero at poles, never NaN
    V3d Ng; // unit length, along dPdu x dPdv (component formula, ri.md 8.6), its limit at singular
            // points; polygons: Newell's normal. Orientation is applied by the caller.
};

// Items of a primitive variable and their weights: value = sum weight * item.
class Stencil {
public:
    struct Entry {
        std::uint32_t item;
        double weight;
    };
    void clear() { count_ = 0, overflow_.clear(); }
    void add(std::uint32_t item, double weight);
    [[nodiscard]] std::size_t size() const { return count_ + overflow_.size(); }
    [[nodiscard]] const Entry& operator[](std::size_t i) const {
        return i < count_ ? inline_[i] : overflow_[i - inline_.size()];
    }
    void scale(double factor);
    // The four corners of the unit square in the order of ri.md 10.3: (0,0), (1,0), (0,1), (1,1).
    void add_bilinear(const std::array<std::uint32_t, 4>& corners, double u, double v);

private:
    std::array<Entry, 32> inline_; // the first count_ are set
    std::size_t count_ = 0;
    std::vector<Entry> overflow_; // rational surfaces of high order only
};

// A ray in object space; distances t are those of the camera-space ray (transforms keep them).
struct ObjectRay {
    V3d o, d;
    double tnear = 0, tfar = 0;
    int cull = 0; // 0: both sides; +1 or -1: only places where cull * dot(Ng, d) < 0 (Sides 1)

    [[nodiscard]] bool sees(const V3d& Ng) const { return cull == 0 || cull * dot(Ng, d) < 0; }
};

struct LocalHit {
    LocalPoint at;
    double t = 0;
};

// How a surface is put before Embree.
enum class TraceForm : std::uint8_t {
    Triangles, // one Embree triangle per part
    Grids,     // one Embree grid (RTC_GEOMETRY_TYPE_GRID) per part
    Analytic,  // one user primitive per surface: bound() and intersect()
};

// Where tessellations go. Vertices are in trace space: camera space, or a prototype's own centred
// space.
struct TraceBuffer {
    struct Grid {
        std::uint32_t first_vertex, stride;
        std::uint16_t width, height; // vertices
    };
    std::vector<float> xyz;               // 3 per vertex
    std::vector<std::uint32_t> triangles; // 3 per triangle
    // Instead of triangles, where may_borrow: indices that outlive the World. Only a buffer of its
    // own lets them be.
    std::span<const std::uint32_t> borrowed;
    bool may_borrow = false;
    std::vector<Grid> grids;

    [[nodiscard]] std::uint32_t num_vertices() const {
        return static_cast<std::uint32_t>(xyz.size() / 3);
    }
    // Rounds once to float.
    void add_vertex(const V3d& p_trace);
};

struct TraceContext {
    Mat4 trace_from_object;
    // Trace space as the camera sees it; dicing looks at this.
    DiceContext dice;
};

// How far a traced primitive may lie from the true surface at a hit: the raw material of
// spawn_origin.
struct TraceError {
    V3d facet_normal; // normal of what is traced there (not unit); equals Ng for analytic surfaces
    V3d reach; // per axis, largest |coordinate| of the traced primitive's vertices; 0 when analytic
    double deviation = 0; // distance between what is traced and the true surface, object units
};

// A place on a part by numbers of [0,1]^2, and how fast the surface parameters go with them.
struct PartPlace {
    LocalPoint at;
    double du_ds = 1, dv_dt = 1;
};

struct ParamRange {
    double u0 = 0, u1 = 1, v0 = 0, v1 = 1;
};

class Surface {
public:
    virtual ~Surface() = default;

    // --- tracing
    [[nodiscard]] virtual TraceForm trace_form() const = 0;
    // Grids: chooses how finely to dice, and says how many vertices that makes. May be called again
    // with a larger flatness.
    virtual std::uint64_t plan(const TraceContext& context);
    // Triangles, Grids: appends one per part, in the order of parts; called once, after plan(),
    // before any hit.
    virtual void tessellate(const TraceContext& context, TraceBuffer& out);
    // A box in the destination space that holds the whole surface.
    [[nodiscard]] virtual Box bound(const Mat4& dst_from_object) const = 0;
    // Analytic: the closest hit with tnear <= t <= tfar that ray.sees().
    [[nodiscard]] virtual bool intersect(const ObjectRay& ray, LocalHit& hit) const;
    // Diced surfaces whose hits are moved onto the true surface: refine() is called once per hit;
    // hit holds the place in the tessellation (grid: u, v in [0,1] over the grid) and receives
    // local parameters.
    [[nodiscard]] virtual bool needs_refine() const { return false; }
    virtual void refine(const ObjectRay& ray, LocalHit& hit) const;
    [[nodiscard]] virtual TraceError trace_error(const LocalPoint& at,
                                                 const SurfacePoint& here) const;
    [[nodiscard]] virtual std::size_t num_parts() const { return 1; }
    // Bytes, itself included, for statistics.
    [[nodiscard]] virtual std::size_t heap_bytes() const { return 0; }

    // --- shading
    [[nodiscard]] virtual SurfacePoint evaluate(const LocalPoint& at) const = 0;
    // The local parameters du, dv of the surface parameters further on. Beyond the end of a part or
    // of the surface, the part is continued by its own formula. Default: local parameters are the
    // surface parameters.
    [[nodiscard]] virtual LocalPoint step(const LocalPoint& at, double du, double dv) const;
    // X(step(at)) - X(at) for every member, free of cancellation against the position. Default:
    // evaluates both in double and subtracts, which leaves an error of 1e-16 * |P_object|.
    [[nodiscard]] virtual SurfacePoint difference(const LocalPoint& at, const SurfacePoint& here,
                                                  double du, double dv) const;
    // Largest du and dv that auxiliary points may be away (the parameter range; a quarter of a
    // turn).
    [[nodiscard]] virtual std::array<double, 2> max_step() const = 0;
    [[nodiscard]] virtual ParamRange range() const { return {}; }
    // Whether TextureCoordinates give s, t (ri.md 11.1); otherwise s = object x, t = object y.
    [[nodiscard]] virtual bool inherits_texture_coordinates() const { return true; }

    // --- choosing points (area_set.h)
    // The corners of a part that is a flat triangle, in the order of its barycentric coordinates.
    [[nodiscard]] virtual bool corners(std::uint32_t part, std::array<V3d, 3>& out) const;
    // Radius, if the surface is a whole sphere about the origin; else 0.
    [[nodiscard]] virtual double whole_sphere() const { return 0; }
    // Other parts. Default: local parameters are surface parameters of the range 0..1.
    [[nodiscard]] virtual PartPlace place(std::uint32_t part, double s, double t) const {
        return {{part, s, t}, 1, 1};
    }

    // --- primitive variables
    // Items the class must have for this surface (ri.md 10.3).
    [[nodiscard]] virtual std::size_t num_items(rib::StorageClass storage) const = 0;
    // Appends the items that determine a variable of the class at a place. Not called for Constant.
    virtual void stencil(rib::StorageClass storage, const LocalPoint& at, Stencil& out) const = 0;
};

} // namespace geo
