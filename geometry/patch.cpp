// SPDX-License-Identifier: Apache-2.0
#include "geometry/patch.h"

#include "geometry/bezier.h"
#include "geometry/dice.h"

#include <algorithm>
#include <cmath>

namespace geo {

namespace {

// What the constructor needs: the layout, the homogeneous nets of all parts, the control weights
// ("Pw" only).
struct PatchData {
    PatchLayout layout;
    std::vector<double> net;
    std::vector<double> weights;
    ParamRange range;
};

class PatchSurface final : public Surface {
public:
    explicit PatchSurface(PatchData data);

    TraceForm trace_form() const override { return TraceForm::Grids; }
    std::uint64_t plan(const TraceContext& context) override;
    void tessellate(const TraceContext& context, TraceBuffer& out) override;
    Box bound(const Mat4& dst_from_object) const override;
    bool needs_refine() const override { return true; }
    void refine(const ObjectRay& ray, LocalHit& hit) const override;
    TraceError trace_error(const LocalPoint& at, const SurfacePoint& here) const override;
    std::size_t num_parts() const override { return static_cast<std::size_t>(num_parts_); }
    std::size_t heap_bytes() const override;
    SurfacePoint evaluate(const LocalPoint& at) const override;
    LocalPoint step(const LocalPoint& at, double du, double dv) const override;
    PartPlace place(std::uint32_t part, double s, double t) const override {
        const SpanMap::Part &pu = part_u(part), &pv = part_v(part);
        return {on_axes({part, s, t}), pu.t1 - pu.t0, pv.t1 - pv.t0};
    }
    std::array<double, 2> max_step() const override {
        return {data_.range.u1 - data_.range.u0, data_.range.v1 - data_.range.v0};
    }
    ParamRange range() const override { return data_.range; }
    std::size_t num_items(rib::StorageClass storage) const override;
    void stencil(rib::StorageClass storage, const LocalPoint& at, Stencil& out) const override;

private:
    const SpanMap::Part& part_u(std::uint32_t part) const {
        return data_.layout.part_u(static_cast<int>(part));
    }
    const SpanMap::Part& part_v(std::uint32_t part) const {
        return data_.layout.part_v(static_cast<int>(part));
    }
    int degree_u() const { return data_.layout.u.degree(); }
    int degree_v() const { return data_.layout.v.degree(); }
    const double* net(std::uint32_t part) const {
        return data_.net.data() + 4 * part * data_.layout.points_per_part();
    }
    // A place on a part by its own parameters. LocalPoint holds positions on the axes of the dicing
    // instead: equal steps from vertex to vertex, so that floats suffice on parts a million times
    // larger than what is seen of them.
    struct PartPoint {
        std::uint32_t part;
        double s, t;
    };
    PartPoint on_part(const LocalPoint& at) const {
        if (diced_.empty()) {
            return {at.part, at.u, at.v};
        }
        const DicePlan& plan = diced_[at.part].plan;
        return {at.part, plan.u.parameter(at.u), plan.v.parameter(at.v)};
    }
    LocalPoint on_axes(const PartPoint& p) const {
        if (diced_.empty()) {
            return {p.part, p.s, p.t};
        }
        const DicePlan& plan = diced_[p.part].plan;
        return {p.part, plan.u.position(p.s), plan.v.position(p.t)};
    }
    BezierPoint local(const PartPoint& p) const {
        return evaluate_part(degree_u(), degree_v(), net(p.part), p.s, p.t);
    }
    V3d normal(const PartPoint& at, const BezierPoint& here) const;
    ParamRange search_range(const PartPoint& p) const;
    std::vector<double> transformed_net(std::uint32_t part, const Mat4& dst_from_object) const;
    void corner_stencil(const PartPoint& at, Stencil& out) const;
    void vertex_stencil(const PartPoint& at, Stencil& out) const;
    std::size_t face(std::uint32_t part) const {
        return static_cast<std::size_t>(part_v(part).segment) *
                   static_cast<std::size_t>(data_.layout.u.num_segments()) +
               static_cast<std::size_t>(part_u(part).segment);
    }

    struct Diced {
        DicePlan plan;
        DiceError error; // object units
    };
    PatchData data_;
    int num_parts_;
    std::vector<Diced> diced_; // per part; empty until it is diced
};

PatchSurface::PatchSurface(PatchData data)
    : data_(std::move(data)), num_parts_(data_.layout.num_parts()) {}

std::size_t PatchSurface::heap_bytes() const {
    std::size_t sum = sizeof *this + data_.layout.heap_bytes() +
                      (data_.net.capacity() + data_.weights.capacity()) * sizeof(double) +
                      diced_.capacity() * sizeof(Diced);
    for (const Diced& d : diced_) {
        for (const ParamAxis* axis :
             {&d.plan.u, &d.plan.v, &d.plan.at_v0, &d.plan.at_v1, &d.plan.at_u0, &d.plan.at_u1}) {
            sum += axis->heap_bytes();
        }
    }
    return sum;
}

std::vector<double> PatchSurface::transformed_net(std::uint32_t part, const Mat4& m) const {
    std::vector<double> out(net(part), net(part) + 4 * data_.layout.points_per_part());
    for (std::size_t i = 0; i < out.size(); i += 4) {
        const double h[4] = {out[i], out[i + 1], out[i + 2], out[i + 3]};
        for (std::size_t k = 0; k < 4; ++k) {
            out[i + k] = h[0] * m.m[0][k] + h[1] * m.m[1][k] + h[2] * m.m[2][k] + h[3] * m.m[3][k];
        }
    }
    return out;
}

std::uint64_t PatchSurface::plan(const TraceContext& context) {
    diced_.resize(num_parts());
    std::uint64_t vertices = 0;
    for (std::uint32_t part = 0; part < diced_.size(); ++part) {
        const std::vector<double> net_trace = transformed_net(part, context.trace_from_object);
        Diced& d = diced_[part];
        d.plan = plan_part(degree_u(), degree_v(), net_trace.data(), context.dice);
        d.error = dice_error(degree_u(), degree_v(), net(part), d.plan);
        vertices += static_cast<std::uint64_t>(d.plan.vertices());
    }
    return vertices;
}

void PatchSurface::tessellate(const TraceContext& context, TraceBuffer& out) {
    std::vector<V3d> vertices;
    for (std::uint32_t part = 0; part < diced_.size(); ++part) {
        const DicePlan& plan = diced_[part].plan;
        const std::vector<double> net_trace = transformed_net(part, context.trace_from_object);
        vertices.clear();
        dice_part(degree_u(), degree_v(), net_trace.data(), plan, vertices);
        const auto width = static_cast<std::uint16_t>(plan.u.segments() + 1);
        out.grids.push_back(
            {out.num_vertices(), width, width, static_cast<std::uint16_t>(plan.v.segments() + 1)});
        for (const V3d& p : vertices) {
            out.add_vertex(p);
        }
    }
}

// A Bezier part lies in the hull of its control points (all weights are positive).
Box PatchSurface::bound(const Mat4& dst_from_object) const {
    Box box;
    for (std::size_t i = 0; i < data_.net.size(); i += 4) {
        const double* h = data_.net.data() + i;
        box.add(point(dst_from_object, V3d{h[0], h[1], h[2]} / h[3]));
    }
    return box;
}

// Newton's method on the two planes that hold the ray: n1.(P - o) = n2.(P - o) = 0, within two
// cells of where it starts, so that it finds no other sheet of a folded part. Stays at the nearest
// place if the ray passes by the true surface (within the dicing error of a silhouette).
void PatchSurface::refine(const ObjectRay& ray, LocalHit& hit) const {
    const double dd = dot(ray.d, ray.d);
    const V3d axis = std::fabs(ray.d.x) < 0.6 * std::sqrt(dd) ? V3d{1, 0, 0} : V3d{0, 1, 0};
    const V3d n1 = normalize(cross(ray.d, axis)), n2 = normalize(cross(ray.d, n1));
    PartPoint at = on_part(hit.at);
    const ParamRange near = search_range(at);
    PartPoint best = at;
    double best_miss = std::numeric_limits<double>::infinity();
    V3d best_P;
    constexpr int max_iterations = 12;
    for (int i = 0; i < max_iterations; ++i) {
        const BezierPoint p = local(at);
        const double e1 = dot(n1, p.P - ray.o), e2 = dot(n2, p.P - ray.o);
        const double miss = e1 * e1 + e2 * e2;
        if (!(miss < best_miss)) {
            break;
        }
        best_miss = miss;
        best = at;
        best_P = p.P;
        const double a = dot(n1, p.dPdu), b = dot(n1, p.dPdv), c = dot(n2, p.dPdu),
                     d = dot(n2, p.dPdv);
        const double det = a * d - b * c;
        if (!(std::fabs(det) > 1e-14 * (a * a + b * b + c * c + d * d))) {
            break; // seen edge on, or a pole
        }
        at.s = std::clamp(at.s - (e1 * d - e2 * b) / det, near.u0, near.u1);
        at.t = std::clamp(at.t - (e2 * a - e1 * c) / det, near.v0, near.v1);
    }
    if (best_miss < std::numeric_limits<double>::infinity()) {
        hit.at = on_axes(best);
        hit.t = dot(best_P - ray.o, ray.d) / dd;
    }
}

// Two cells to either side; cells at a border are as long as the border's own.
ParamRange PatchSurface::search_range(const PartPoint& p) const {
    double ds = 1, dt = 1;
    if (!diced_.empty()) {
        const DicePlan& plan = diced_[p.part].plan;
        ds = plan.u.spacing(p.s), dt = plan.v.spacing(p.t);
        const double first_s = plan.u.spacing(0), last_s = plan.u.spacing(1);
        const double first_t = plan.v.spacing(0), last_t = plan.v.spacing(1);
        const auto widen = [](bool at_border, double& step, const ParamAxis& border) {
            step = at_border ? std::max(step, border.longest_segment(0, 1)) : step;
        };
        widen(p.t <= first_t, ds, plan.at_v0);
        widen(p.t >= 1 - last_t, ds, plan.at_v1);
        widen(p.s <= first_s, dt, plan.at_u0);
        widen(p.s >= 1 - last_s, dt, plan.at_u1);
    }
    return {std::max(p.s - 2 * ds, 0.0), std::min(p.s + 2 * ds, 1.0), std::max(p.t - 2 * dt, 0.0),
            std::min(p.t + 2 * dt, 1.0)};
}

TraceError PatchSurface::trace_error(const LocalPoint& at, const SurfacePoint& here) const {
    TraceError e{here.Ng, {}, 0};
    const double* h = net(at.part);
    for (std::size_t i = 0; i < data_.layout.points_per_part(); ++i, h += 4) {
        for (int k = 0; k < 3; ++k) {
            e.reach[k] = std::max(e.reach[k], std::fabs(h[k] / h[3]));
        }
    }
    if (!diced_.empty()) {
        const PartPoint p = on_part(at);
        e.deviation = diced_[at.part].error.at(diced_[at.part].plan, p.s, p.t);
    }
    return e;
}

// The cross product vanishes where an edge has collapsed to a point or the parametrisation folds:
// its limit is found by stepping towards the middle of the part.
V3d PatchSurface::normal(const PartPoint& at, const BezierPoint& here) const {
    BezierPoint p = here;
    PartPoint q = at;
    for (double shift = 1e-6; shift < 0.1; shift *= 10) {
        const V3d n = cross(p.dPdu, p.dPdv);
        const double len = length(n);
        if (len > 1e-9 * length(p.dPdu) * length(p.dPdv) && len > 0 &&
            length(p.dPdu) > 1e-9 * length(p.dPdv) && length(p.dPdv) > 1e-9 * length(p.dPdu)) {
            return n / len;
        }
        q.s = at.s + (0.5 - at.s) * shift;
        q.t = at.t + (0.5 - at.t) * shift;
        p = local(q);
    }
    return {0, 0, 1};
}

SurfacePoint PatchSurface::evaluate(const LocalPoint& at) const {
    const PartPoint q = on_part(at);
    const BezierPoint p = local(q);
    const SpanMap::Part &pu = part_u(at.part), &pv = part_v(at.part);
    SurfacePoint r;
    r.u = pu.t0 + q.s * (pu.t1 - pu.t0);
    r.v = pv.t0 + q.t * (pv.t1 - pv.t0);
    r.P = p.P;
    r.dPdu = p.dPdu / (pu.t1 - pu.t0);
    r.dPdv = p.dPdv / (pv.t1 - pv.t0);
    r.Ng = normal(q, p);
    return r;
}

LocalPoint PatchSurface::step(const LocalPoint& at, double du, double dv) const {
    const SpanMap::Part &pu = part_u(at.part), &pv = part_v(at.part);
    const PartPoint p = on_part(at);
    return on_axes({p.part, p.s + du / (pu.t1 - pu.t0), p.t + dv / (pv.t1 - pv.t0)});
}

std::size_t PatchSurface::num_items(rib::StorageClass storage) const {
    const SpanMap &u = data_.layout.u, &v = data_.layout.v;
    const auto count = [](const SpanMap& m, int extra) {
        return static_cast<std::size_t>(m.num_segments() + extra);
    };
    const auto corners = [&](const SpanMap& m) { return count(m, m.periodic() ? 0 : 1); };
    switch (storage) {
    case rib::StorageClass::Constant:
        return 1;
    case rib::StorageClass::Uniform:
        return count(u, 0) * count(v, 0);
    case rib::StorageClass::Varying:
        return corners(u) * corners(v);
    case rib::StorageClass::Vertex:
        return static_cast<std::size_t>(u.num_points()) * static_cast<std::size_t>(v.num_points());
    case rib::StorageClass::FaceVarying:
    case rib::StorageClass::FaceVertex:
        return 4 * count(u, 0) * count(v, 0);
    }
    return 0;
}

// Place within the nominal segment, which may reach beyond the part (clipped NURBS ranges).
static double in_segment(const SpanMap::Part& part, double local) {
    const double t = part.t0 + local * (part.t1 - part.t0);
    return (t - part.s0) / (part.s1 - part.s0);
}

void PatchSurface::corner_stencil(const PartPoint& at, Stencil& out) const {
    const SpanMap &mu = data_.layout.u, &mv = data_.layout.v;
    const auto corner = [](const SpanMap& m, int segment) {
        return static_cast<std::uint32_t>(m.periodic() ? segment % m.num_segments() : segment);
    };
    const auto row = static_cast<std::uint32_t>(mu.num_segments() + (mu.periodic() ? 0 : 1));
    const int a = part_u(at.part).segment, b = part_v(at.part).segment;
    const std::uint32_t u0 = corner(mu, a), u1 = corner(mu, a + 1);
    const std::uint32_t v0 = corner(mv, b) * row, v1 = corner(mv, b + 1) * row;
    out.add_bilinear({v0 + u0, v0 + u1, v1 + u0, v1 + u1}, in_segment(part_u(at.part), at.s),
                     in_segment(part_v(at.part), at.t));
}

void PatchSurface::vertex_stencil(const PartPoint& at, Stencil& out) const {
    double bu[max_degree + 1], bv[max_degree + 1], unused[max_degree + 1];
    bernstein(degree_u(), at.s, bu, unused);
    bernstein(degree_v(), at.t, bv, unused);
    const SpanMap::Part &pu = part_u(at.part), &pv = part_v(at.part);
    // Weight of the c-th input of one direction: Bernstein polynomials times the map's column.
    const auto weight = [](const SpanMap::Part& part, int degree, const double* b, std::size_t c) {
        double sum = 0;
        for (int i = 0; i <= degree; ++i) {
            sum += b[i] * part.weights[static_cast<std::size_t>(i) * part.input.size() + c];
        }
        return sum;
    };
    double total = 0;
    for (std::size_t r = 0; r < pv.input.size(); ++r) {
        const double wv = weight(pv, degree_v(), bv, r);
        for (std::size_t c = 0; c < pu.input.size(); ++c) {
            const auto item =
                static_cast<std::size_t>(pv.input[r] * data_.layout.u.num_points() + pu.input[c]);
            const double w = wv * weight(pu, degree_u(), bu, c) *
                             (data_.weights.empty() ? 1.0 : data_.weights[item]);
            total += w;
            out.add(static_cast<std::uint32_t>(item), w);
        }
    }
    if (!data_.weights.empty() && total != 0) {
        out.scale(1 / total);
    }
}

void PatchSurface::stencil(rib::StorageClass storage, const LocalPoint& at, Stencil& out) const {
    switch (storage) {
    case rib::StorageClass::Constant:
        out.add(0, 1);
        return;
    case rib::StorageClass::Uniform:
        out.add(static_cast<std::uint32_t>(face(at.part)), 1);
        return;
    case rib::StorageClass::Varying:
        corner_stencil(on_part(at), out);
        return;
    case rib::StorageClass::Vertex:
        vertex_stencil(on_part(at), out);
        return;
    case rib::StorageClass::FaceVarying:
    case rib::StorageClass::FaceVertex: {
        const auto first = static_cast<std::uint32_t>(4 * face(at.part));
        const PartPoint p = on_part(at);
        out.add_bilinear({first, first + 1, first + 2, first + 3}, in_segment(part_u(at.part), p.s),
                         in_segment(part_v(at.part), p.t));
        return;
    }
    }
}

// Control values of a position variable as double; empty and the reason if there are too few.
std::vector<double> control_values(const rib::Param& param, std::size_t count, int dim,
                                   std::string& why) {
    if (param.floats.size() < count * static_cast<std::size_t>(dim)) {
        why = "\"" + param.name + "\" needs " + std::to_string(count) + " points";
        return {};
    }
    std::vector<double> values(param.floats.begin(),
                               param.floats.begin() + static_cast<std::ptrdiff_t>(count) * dim);
    if (!std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); })) {
        why = "\"" + param.name + "\" holds a value that is not finite";
        return {};
    }
    return values;
}

// ri.md 11.5: a height field, x = u and y = v exactly.
std::vector<double> height_net(const PatchLayout& layout, const std::vector<double>& z) {
    const std::vector<double> heights = bezier_values(layout, z, 1);
    std::vector<double> net;
    net.reserve(4 * heights.size());
    const int du = layout.u.degree(), dv = layout.v.degree();
    std::size_t at = 0;
    for (int part = 0; part < layout.num_parts(); ++part) {
        const SpanMap::Part &pu = layout.part_u(part), &pv = layout.part_v(part);
        for (int j = 0; j <= dv; ++j) {
            for (int i = 0; i <= du; ++i) {
                const double u = pu.t0 + (pu.t1 - pu.t0) * i / du,
                             v = pv.t0 + (pv.t1 - pv.t0) * j / dv;
                net.insert(net.end(), {u, v, heights[at++], 1});
            }
        }
    }
    return net;
}

// The net of a rational surface whose Bezier weights are all positive, so that its points lie in
// their hull and none is at infinity. Control points without weight are legal (the half circle of
// three points has one); cutting the parts makes them finite, unless the surface itself passes
// through infinity.
std::vector<double> rational_net(PatchLayout& layout, const std::vector<double>& control) {
    constexpr int max_cuts = 5;
    for (int cut = 0; cut <= max_cuts; ++cut) {
        std::vector<double> net = position_net(layout, control, true);
        bool positive = true;
        for (std::size_t i = 3; i < net.size() && positive; i += 4) {
            positive = net[i] > 0;
        }
        if (positive) {
            return net;
        }
        layout = {layout.u.halved(), layout.v.halved()};
    }
    return {};
}

std::unique_ptr<Surface> make_surface_of(PatchLayout layout, const ParamRange& range,
                                         const rib::ParamList& params, bool allow_height,
                                         std::string& why) {
    const rib::Param* position = params.find("Pw");
    const bool rational = position != nullptr;
    if (!position) {
        position = params.find("P");
    }
    const bool is_height = !position && allow_height && params.find("Pz");
    if (is_height) {
        position = params.find("Pz");
    }
    if (!position) {
        why = allow_height ? "needs \"P\", \"Pw\" or \"Pz\"" : "needs \"P\" or \"Pw\"";
        return nullptr;
    }
    const auto count = static_cast<std::size_t>(layout.u.num_points()) *
                       static_cast<std::size_t>(layout.v.num_points());
    const std::vector<double> control = control_values(*position, count,
                                                       rational    ? 4
                                                       : is_height ? 1
                                                                   : 3,
                                                       why);
    if (control.empty()) {
        return nullptr;
    }
    PatchData data{std::move(layout), {}, {}, range};
    if (rational) {
        for (std::size_t i = 3; i < control.size(); i += 4) {
            data.weights.push_back(control[i]);
        }
        data.net = rational_net(data.layout, control);
        if (data.net.empty()) {
            why = "the weights of \"Pw\" send the surface through infinity";
            return nullptr;
        }
    } else {
        data.net = is_height ? height_net(data.layout, control)
                             : position_net(data.layout, control, false);
    }
    return std::make_unique<PatchSurface>(std::move(data));
}

} // namespace

std::unique_ptr<Surface> make_patches(const rib::Patches& patches, const rib::Basis& basis,
                                      const rib::ParamList& params, std::string& why) {
    auto layout = PatchLayout::make(patches, basis, why);
    return layout ? make_surface_of(std::move(*layout), {}, params, true, why) : nullptr;
}

std::unique_ptr<Surface> make_nupatch(const rib::NuPatch& patch, const rib::ParamList& params,
                                      std::string& why) {
    auto layout = PatchLayout::make(patch, why);
    if (!layout) {
        return nullptr;
    }
    const ParamRange range{layout->u.parts().front().t0, layout->u.parts().back().t1,
                           layout->v.parts().front().t0, layout->v.parts().back().t1};
    return make_surface_of(std::move(*layout), range, params, false, why);
}

} // namespace geo
