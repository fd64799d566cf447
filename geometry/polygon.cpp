// SPDX-License-Identifier: Apache-2.0
#include "geometry/polygon.h"

#include "geometry/triangulate.h"

#include <algorithm>
#include <cmath>

namespace geo {

namespace {

constexpr double largest_coordinate = 1e18; // Embree drops what lies further out

// Below this |cos| between the plane's normal and object z, x and y no longer serve as parameters
// of the plane.
constexpr double least_tilt = 1e-4;

// Positions from "P", or from "Pw" divided.
class Positions {
public:
    explicit Positions(const rib::ParamList& params) {
        const rib::Param* p = params.find("P");
        stride_ = 3;
        if (!p) {
            p = params.find("Pw");
            stride_ = 4;
        }
        if (p && p->decl.array_length == 1) {
            data_ = p->floats.data();
            count_ = p->floats.size() / stride_;
        }
    }
    [[nodiscard]] std::size_t count() const { return count_; }
    [[nodiscard]] V3d operator[](std::size_t i) const {
        const float* f = data_ + i * stride_;
        const V3d p(f[0], f[1], f[2]);
        return stride_ == 4 ? p / static_cast<double>(f[3]) : p;
    }

private:
    const float* data_ = nullptr;
    std::size_t count_ = 0;
    std::size_t stride_ = 3;
};

bool usable(const V3d& p) {
    return std::fabs(p.x) <= largest_coordinate && std::fabs(p.y) <= largest_coordinate &&
           std::fabs(p.z) <= largest_coordinate;
}

int largest_axis(const V3d& n) {
    const V3d a(std::fabs(n.x), std::fabs(n.y), std::fabs(n.z));
    return a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
}

// dPdu and dPdv of a plane whose parameters are object x and y. Where the plane is (nearly)
// perpendicular to the xy plane, the coordinate that still varies keeps its meaning and the other
// direction is z (geo-004).
void plane_derivatives(const V3d& n, V3d& dPdu, V3d& dPdv) {
    if (std::fabs(n.z) >= least_tilt) {
        dPdu = {1, 0, -n.x / n.z};
        dPdv = {0, 1, -n.y / n.z};
    } else if (std::fabs(n.y) >= std::fabs(n.x)) {
        dPdu = {1, -n.x / n.y, 0};
        dPdv = {0, 0, n.y > 0 ? -1.0 : 1.0}; // dPdu x dPdv along n
    } else {
        dPdu = {0, 0, n.x > 0 ? -1.0 : 1.0};
        dPdv = {-n.y / n.x, 1, 0};
    }
}

// All corners turn the same way, once around: the x direction changes sign twice only.
bool strictly_convex(std::span<const Point2> points) {
    const std::size_t n = points.size();
    int turn = 0, flips = 0;
    double last_dx = 0;
    for (std::size_t i = 0; i < 2 * n; ++i) {
        const Point2 &a = points[i % n], &b = points[(i + 1) % n], &c = points[(i + 2) % n];
        const double o = orient(a, b, c);
        const int side = o > 0 ? 1 : -1;
        if (o == 0 || (turn != 0 && side != turn)) {
            return false;
        }
        turn = side;
        const double dx = b.x - a.x;
        if (dx != 0) {
            flips += i >= n && (dx > 0) != (last_dx > 0);
            last_dx = dx;
        }
    }
    return flips <= 2;
}

class PolygonMesh final : public Surface {
public:
    PolygonMesh(const rib::Polygons& polygons, const rib::ParamList& params)
        : polygons_(polygons), P_(params) {}

    // False if nothing is left.
    bool build(PolygonFaults& faults);

    [[nodiscard]] TraceForm trace_form() const override { return TraceForm::Triangles; }
    void tessellate(const TraceContext& context, TraceBuffer& out) override;
    [[nodiscard]] Box bound(const Mat4& dst_from_object) const override {
        return transformed(dst_from_object, box_);
    }
    [[nodiscard]] TraceError trace_error(const LocalPoint& at, const SurfacePoint&) const override;
    [[nodiscard]] std::size_t num_parts() const override {
        return fan_ > 0 ? num_corners_ / fan_ * (fan_ - 2) : triangles_.size();
    }
    [[nodiscard]] std::size_t heap_bytes() const override {
        return sizeof *this + triangles_.capacity() * sizeof(Triangle) +
               normals_.capacity() * sizeof(V3f);
    }
    [[nodiscard]] SurfacePoint evaluate(const LocalPoint& at) const override;
    [[nodiscard]] bool corners(std::uint32_t part, std::array<V3d, 3>& out) const override {
        out = corners(triangle(part)).p;
        return true;
    }
    [[nodiscard]] LocalPoint step(const LocalPoint& at, double du, double dv) const override;
    [[nodiscard]] SurfacePoint difference(const LocalPoint& at, const SurfacePoint& here, double du,
                                          double dv) const override;
    // A plane goes on: polygons smaller than a pixel still have the pixel's step. The limit only
    // keeps numbers sane.
    [[nodiscard]] std::array<double, 2> max_step() const override {
        return {1e6 * extent_, 1e6 * extent_};
    }
    [[nodiscard]] ParamRange range() const override {
        return {box_.lo.x, box_.hi.x, box_.lo.y, box_.hi.y};
    }
    [[nodiscard]] bool inherits_texture_coordinates() const override { return false; }
    [[nodiscard]] std::size_t num_items(rib::StorageClass storage) const override;
    void stencil(rib::StorageClass storage, const LocalPoint& at, Stencil& out) const override;

private:
    struct Triangle {
        std::array<std::uint32_t, 3> corner; // indices into polygons_.vertices
        std::uint32_t polygon;
    };
    struct Corners {
        std::array<V3d, 3> p;
        V3d e1, e2;
    };

    const rib::Polygons& polygons_;
    Positions P_;
    // Corners of every polygon, where all are fans of as many: triangles_ and normals_ stay empty.
    // 0: they hold the triangulation.
    std::uint32_t fan_ = 0;
    std::vector<Triangle> triangles_;
    std::vector<V3f> normals_;       // per polygon, unit, by Newell
    std::uint32_t num_vertices_ = 0; // largest index + 1
    std::size_t num_corners_ = 0;
    Box box_;
    double extent_ = 0;

    // One polygon while it is cut.
    struct Outline {
        std::vector<V3d> points;
        std::vector<Point2> flat; // the points without one coordinate
        std::vector<std::uint32_t> loop_sizes;
    };

    [[nodiscard]] std::uint32_t common_size() const;
    bool scan_fans(std::uint32_t size, PolygonFaults& faults);
    bool gather(std::size_t first_corner, std::size_t count, Outline& outline,
                PolygonFaults& faults);
    static void flatten(const V3d& normal, Outline& outline);
    void add_polygon(std::uint32_t polygon, std::size_t first_corner, Outline& outline,
                     PolygonFaults& faults);
    void finish();

    [[nodiscard]] Triangle triangle(std::uint32_t part) const {
        if (fan_ == 0) {
            return triangles_[part];
        }
        const std::uint32_t polygon = part / (fan_ - 2), first = polygon * fan_;
        const std::uint32_t k = first + 1 + part % (fan_ - 2);
        return {{first, k, k + 1}, polygon};
    }
    [[nodiscard]] std::uint32_t vertex(std::uint32_t corner) const {
        return static_cast<std::uint32_t>(polygons_.vertices[corner]);
    }
    [[nodiscard]] Corners corners(const Triangle& t) const {
        const V3d a = P_[vertex(t.corner[0])], b = P_[vertex(t.corner[1])],
                  c = P_[vertex(t.corner[2])];
        return {{a, b, c}, b - a, c - a};
    }
    [[nodiscard]] V3d normal(const Triangle& t, const Corners& c) const {
        return fan_ == 3  ? normalize(cross(c.e1, c.e2))
               : fan_ > 3 ? fan_normal(t.polygon)
                          : V3d(normals_[t.polygon]);
    }
    [[nodiscard]] V3d fan_normal(std::uint32_t polygon) const;
};

// Newell's sum over the outer loop, relative to its first point.
V3d newell(std::span<const V3d> loop) {
    V3d n;
    for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
        n += cross(loop[i] - loop[0], loop[i + 1] - loop[0]);
    }
    return n;
}

bool PolygonMesh::build(PolygonFaults& faults) {
    if (P_.count() == 0) {
        faults.no_positions = true;
        return false;
    }
    num_corners_ = polygons_.vertices.size();
    for (const std::int32_t v : polygons_.vertices) {
        if (v >= 0 && static_cast<std::size_t>(v) < P_.count()) {
            num_vertices_ = std::max(num_vertices_, static_cast<std::uint32_t>(v) + 1);
        }
    }
    if (const std::uint32_t size = common_size(); size > 0 && scan_fans(size, faults)) {
        fan_ = size;
        finish();
        return true;
    }
    faults = {};
    normals_.resize(polygons_.num_loops.size());
    std::size_t loop = 0, corner = 0;
    Outline outline;
    for (std::size_t i = 0; i < polygons_.num_loops.size(); ++i) {
        outline.loop_sizes.clear();
        std::size_t count = 0;
        for (std::int32_t k = 0; k < polygons_.num_loops[i] && loop < polygons_.num_vertices.size();
             ++k, ++loop) {
            const auto size = static_cast<std::uint32_t>(std::max(polygons_.num_vertices[loop], 0));
            outline.loop_sizes.push_back(size);
            count += size;
        }
        if (count > num_corners_ - corner) {
            ++faults.bad_index;
            break;
        }
        if (gather(corner, count, outline, faults)) {
            add_polygon(static_cast<std::uint32_t>(i), corner, outline, faults);
        }
        corner += count;
    }
    finish();
    return !triangles_.empty();
}

V3d PolygonMesh::fan_normal(std::uint32_t polygon) const {
    const std::uint32_t first = polygon * fan_;
    const V3d origin = P_[vertex(first)];
    V3d n, e = P_[vertex(first + 1)] - origin;
    for (std::uint32_t k = first + 2; k < first + fan_; ++k) {
        const V3d next = P_[vertex(k)] - origin;
        n += cross(e, next);
        e = next;
    }
    return normalize(n);
}

// How many corners all polygons have; 0 if that differs or there are holes.
std::uint32_t PolygonMesh::common_size() const {
    const std::size_t n = polygons_.num_loops.size();
    const auto all = [](const std::vector<std::int32_t>& v, std::int32_t x) {
        return std::all_of(v.begin(), v.end(), [x](std::int32_t y) { return y == x; });
    };
    if (n == 0 || n != polygons_.num_vertices.size() || !all(polygons_.num_loops, 1)) {
        return 0;
    }
    const std::int32_t size = polygons_.num_vertices.front();
    const bool fits = size >= 3 && all(polygons_.num_vertices, size) &&
                      num_corners_ == n * static_cast<std::size_t>(size) &&
                      num_corners_ <= std::numeric_limits<std::uint32_t>::max() - 3;
    return fits ? static_cast<std::uint32_t>(size) : 0;
}

// The common cases, kept without tables: only triangles, only convex quads, one convex polygon; all
// of them usable.
bool PolygonMesh::scan_fans(std::uint32_t size, PolygonFaults& faults) {
    const auto n = static_cast<std::uint32_t>(num_corners_ / size);
    Outline outline;
    for (std::uint32_t i = 0; i < n; ++i) {
        if (!gather(std::size_t(i) * size, size, outline, faults)) {
            return false;
        }
        const V3d normal = newell(outline.points);
        if (size > 3) {
            flatten(normal, outline);
            if (!(length(normal) > 0) || !strictly_convex(outline.flat)) {
                return false;
            }
        }
        faults.degenerate += normal == V3d(); // a triangle, never hit, so it may stay
    }
    return faults.degenerate < n;
}

// Fetches the points of one polygon; false (counted) if it cannot be drawn.
bool PolygonMesh::gather(std::size_t first_corner, std::size_t count, Outline& outline,
                         PolygonFaults& faults) {
    outline.points.clear();
    for (std::size_t k = first_corner; k < first_corner + count; ++k) {
        const std::int32_t v = polygons_.vertices[k];
        if (v < 0 || static_cast<std::size_t>(v) >= P_.count()) {
            ++faults.bad_index;
            return false;
        }
        outline.points.push_back(P_[static_cast<std::size_t>(v)]);
        if (!usable(outline.points.back())) {
            ++faults.not_finite;
            return false;
        }
    }
    return true;
}

// Dropping the coordinate of the largest component keeps the others as the floats they are: exact
// predicates.
void PolygonMesh::flatten(const V3d& normal, Outline& outline) {
    const int axis = largest_axis(normal);
    outline.flat.clear();
    for (const V3d& p : outline.points) {
        outline.flat.push_back({p[(axis + 1) % 3], p[(axis + 2) % 3]});
    }
}

void PolygonMesh::add_polygon(std::uint32_t polygon, std::size_t first_corner, Outline& outline,
                              PolygonFaults& faults) {
    const std::size_t outer = outline.loop_sizes.empty() ? 0 : outline.loop_sizes.front();
    const V3d n = outer < 3 ? V3d() : newell(std::span(outline.points).first(outer));
    const V3d unit = normalize(n);
    if (!(base::length(unit) > 0.5)) {
        ++faults.degenerate;
        return;
    }
    normals_[polygon] = V3f(unit);
    flatten(unit, outline);
    const auto base = static_cast<std::uint32_t>(first_corner);
    if (outline.loop_sizes.size() == 1 && strictly_convex(outline.flat)) {
        for (std::uint32_t k = 1; k + 1 < outline.flat.size(); ++k) {
            triangles_.push_back({{base, base + k, base + k + 1}, polygon});
        }
        return;
    }
    const Triangulation cut = triangulate(outline.flat, outline.loop_sizes);
    for (const auto& t : cut.triangles) {
        triangles_.push_back({{base + t[0], base + t[1], base + t[2]}, polygon});
    }
    faults.degenerate += cut.triangles.empty();
    faults.tangled += !cut.clean && !cut.triangles.empty();
}

void PolygonMesh::finish() {
    triangles_.shrink_to_fit();
    const auto count = static_cast<std::uint32_t>(num_parts());
    for (std::uint32_t i = 0; i < count; ++i) {
        for (const std::uint32_t k : triangle(i).corner) {
            box_.add(P_[vertex(k)]);
        }
    }
    const V3d size = box_.hi - box_.lo;
    extent_ = box_.empty() ? 0 : std::max({size.x, size.y, size.z});
}

void PolygonMesh::tessellate(const TraceContext& context, TraceBuffer& out) {
    const std::uint32_t base = out.num_vertices();
    if (base == 0) { // a shared buffer must grow by doubling, not by each mesh
        out.xyz.reserve(3 * std::size_t(num_vertices_));
        out.triangles.reserve(fan_ == 3 && out.may_borrow ? 0 : 3 * num_parts());
    }
    for (std::uint32_t i = 0; i < num_vertices_; ++i) {
        const V3d p = P_[i];
        out.add_vertex(usable(p) ? point(context.trace_from_object, p) : V3d());
    }
    if (fan_ == 3 && out.may_borrow) {
        // int32 and uint32 may alias; all indices were checked.
        out.borrowed = {reinterpret_cast<const std::uint32_t*>(polygons_.vertices.data()),
                        num_corners_};
        return;
    }
    const auto count = static_cast<std::uint32_t>(num_parts());
    for (std::uint32_t i = 0; i < count; ++i) {
        for (const std::uint32_t k : triangle(i).corner) {
            out.triangles.push_back(base + vertex(k));
        }
    }
}

TraceError PolygonMesh::trace_error(const LocalPoint& at, const SurfacePoint&) const {
    const Corners c = corners(triangle(at.part));
    TraceError e;
    e.facet_normal = cross(c.e1, c.e2);
    for (const V3d& p : c.p) {
        for (int k = 0; k < 3; ++k) {
            e.reach[k] = std::max(e.reach[k], std::fabs(p[k]));
        }
    }
    return e;
}

SurfacePoint PolygonMesh::evaluate(const LocalPoint& at) const {
    const Triangle t = triangle(at.part);
    const Corners c = corners(t);
    SurfacePoint s;
    s.P = c.p[0] + c.e1 * at.u + c.e2 * at.v;
    s.u = s.P.x;
    s.v = s.P.y;
    s.Ng = normal(t, c);
    plane_derivatives(s.Ng, s.dPdu, s.dPdv);
    return s;
}

// The barycentric change that belongs to a change of position in the plane, by the triangle's dual
// basis.
LocalPoint PolygonMesh::step(const LocalPoint& at, double du, double dv) const {
    const Triangle t = triangle(at.part);
    const Corners c = corners(t);
    V3d dPdu, dPdv;
    plane_derivatives(normal(t, c), dPdu, dPdv);
    const V3d dP = dPdu * du + dPdv * dv, n = cross(c.e1, c.e2);
    const double nn = dot(n, n);
    if (!(nn > 0)) {
        return at;
    }
    return {at.part, at.u + dot(cross(dP, c.e2), n) / nn, at.v + dot(cross(c.e1, dP), n) / nn};
}

// The plane is linear: nothing to subtract.
SurfacePoint PolygonMesh::difference(const LocalPoint&, const SurfacePoint& here, double du,
                                     double dv) const {
    SurfacePoint d;
    d.u = du;
    d.v = dv;
    d.P = here.dPdu * du + here.dPdv * dv;
    return d;
}

std::size_t PolygonMesh::num_items(rib::StorageClass storage) const {
    switch (storage) {
    case rib::StorageClass::Constant:
        return 1;
    case rib::StorageClass::Uniform:
        return polygons_.num_loops.size();
    case rib::StorageClass::Varying:
    case rib::StorageClass::Vertex:
        return num_vertices_;
    case rib::StorageClass::FaceVarying:
    case rib::StorageClass::FaceVertex:
        return num_corners_;
    }
    return 1;
}

void PolygonMesh::stencil(rib::StorageClass storage, const LocalPoint& at, Stencil& out) const {
    const Triangle t = triangle(at.part);
    if (storage == rib::StorageClass::Uniform) {
        out.add(t.polygon, 1);
        return;
    }
    const bool by_corner =
        storage == rib::StorageClass::FaceVarying || storage == rib::StorageClass::FaceVertex;
    const std::array<double, 3> weight{1 - at.u - at.v, at.u, at.v};
    for (std::size_t k = 0; k < 3; ++k) {
        out.add(by_corner ? t.corner[k] : vertex(t.corner[k]), weight[k]);
    }
}

} // namespace

std::unique_ptr<Surface> make_polygons(const rib::Polygons& polygons, const rib::ParamList& params,
                                       PolygonFaults& faults) {
    auto mesh = std::make_unique<PolygonMesh>(polygons, params);
    if (!mesh->build(faults)) {
        return nullptr;
    }
    return mesh;
}

} // namespace geo
