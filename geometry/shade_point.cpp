// SPDX-License-Identifier: Apache-2.0
#include "geometry/shade_point.h"

#include <algorithm>
#include <cmath>

namespace geo {

namespace {

// 1/k^2 at the steepest: at grazing angles an auxiliary point is at most this factor further away.
constexpr double least_sin2 = 1.0 / 256;
// Steps are never 0, so that shaders may divide by du and dv; relative to the parameter range.
constexpr double least_step = 1e-7;

constexpr std::uint64_t bit(sl_variable v) {
    return std::uint64_t(1) << v;
}

// Variables that need no surface point, unless a primitive variable supplies them.
constexpr std::uint64_t attribute_vars = bit(SL_VAR_Cs) | bit(SL_VAR_Os);
constexpr std::uint64_t position_vars = bit(SL_VAR_P) | bit(SL_VAR_I) | bit(SL_VAR_N) |
                                        bit(SL_VAR_Ng) | bit(SL_VAR_dPdu) | bit(SL_VAR_dPdv);
constexpr std::uint64_t free_vars = bit(SL_VAR_E) | bit(SL_VAR_time) | bit(SL_VAR_dPdtime);

// Where the variables of one record go; unasked ones have no base.
struct Planes {
    const sl_points* points = nullptr;
    std::uint64_t wanted = 0;
    std::uint32_t stride = 0;

    [[nodiscard]] bool has(sl_variable v) const { return (wanted & bit(v)) != 0; }
    void set(sl_variable v, std::size_t i, double x) const {
        if (has(v)) {
            points->var[v][i] = static_cast<float>(x);
        }
    }
    void set(sl_variable v, std::size_t i, const V3d& x) const {
        if (has(v)) {
            float* base = points->var[v] + i;
            base[0] = static_cast<float>(x.x);
            base[stride] = static_cast<float>(x.y);
            base[2 * std::size_t(stride)] = static_cast<float>(x.z);
        }
    }
};

Planes planes_of(const sl_points* points, std::uint64_t needed, std::uint32_t stride) {
    Planes planes{points, 0, stride};
    for (int v = 0; points && v < SL_VAR_COUNT; ++v) {
        const auto id = static_cast<sl_variable>(v);
        planes.wanted |= points->var[v] && (needed & bit(id)) ? bit(id) : 0;
    }
    return planes;
}

// One hit with everything about its shape at hand.
struct Place {
    const ShapeTable& table;
    const Hit& hit;
    const Shape& shape;
    const rib::Attributes& attributes;
    LocalPoint at;
    SurfacePoint here; // object space
    double orientation;

    Place(const ShapeTable& t, const Hit& h)
        : table(t), hit(h), shape(t.shapes[h.shape]),
          attributes(t.attributes(h)), at{h.part, h.u, h.v},
          orientation(attributes.orientation_matches ? 1 : -1) {}

    [[nodiscard]] const Surface& surface() const { return *shape.surface; }
    [[nodiscard]] V3d geometric_normal(const V3d& Ng_object) const {
        return normalize(table.cam_normal(hit, Ng_object)) * orientation;
    }
};

V3d vec(const double* x) {
    return {x[0], x[1], x[2]};
}

class Filler {
public:
    Filler(const ShapeTable& table, const FillRequest& request)
        : table_(table), r_(request),
          main_(planes_of(&request.out, request.needed, request.stride)),
          aux_u_(planes_of(request.aux_u, ~std::uint64_t(0), request.stride)),
          aux_v_(planes_of(request.aux_v, ~std::uint64_t(0), request.stride)) {}

    void run() const {
        const std::uint64_t all = main_.wanted | aux_u_.wanted | aux_v_.wanted;
        const bool by_surface = (all & ~(attribute_vars | free_vars)) != 0;
        for (std::size_t i = 0; i < r_.hits.size();) {
            const std::size_t end = by_surface ? i + 1 : end_of_run(i);
            if (r_.hits[i].valid()) {
                by_surface ? fill_one(i) : fill_attributes(i, end);
            }
            i = end;
        }
        for (const Planes* planes : {&main_, &aux_u_, &aux_v_}) {
            if (planes->has(SL_VAR_E)) { // camera space has its origin at the eye
                std::fill_n(planes->points->var[SL_VAR_E], 3, 0.0f);
            }
        }
    }

private:
    const ShapeTable& table_;
    const FillRequest& r_;
    Planes main_, aux_u_, aux_v_;

    // Neighbouring hits mostly lie on one shape.
    [[nodiscard]] std::size_t end_of_run(std::size_t i) const {
        const Hit& first = r_.hits[i];
        do {
            ++i;
        } while (i < r_.hits.size() && r_.hits[i].shape == first.shape &&
                 r_.hits[i].instance == first.instance);
        return i;
    }

    // Hits of one shape where nobody asks for the place: no surface is evaluated.
    void fill_attributes(std::size_t begin, std::size_t end) const {
        const Place place(table_, r_.hits[begin]);
        fill_time(begin, end);
        fill_colors(place, place.shape.vars.Cs, place.attributes.color, SL_VAR_Cs, begin, end);
        fill_colors(place, place.shape.vars.Os, place.attributes.opacity, SL_VAR_Os, begin, end);
    }

    void fill_time(std::size_t begin, std::size_t end) const {
        for (std::size_t i = begin; i < end && main_.has(SL_VAR_time); ++i) {
            main_.set(SL_VAR_time, i, r_.hits[i].time);
        }
        for (std::size_t i = begin; i < end && main_.has(SL_VAR_dPdtime); ++i) {
            main_.set(SL_VAR_dPdtime, i, V3d());
        }
    }

    void fill_colors(const Place& place, const rib::Param* param,
                     const std::array<float, 3>& attribute, sl_variable id, std::size_t begin,
                     std::size_t end) const {
        if (!main_.has(id)) {
            return;
        }
        for (std::size_t i = begin; i < end && param; ++i) {
            const Hit& hit = r_.hits[i];
            double value[3];
            interpolate(*param, place.surface(), {hit.part, hit.u, hit.v}, value);
            main_.set(id, i, vec(value));
        }
        for (std::size_t k = 0; k < 3 && !param; ++k) {
            std::fill_n(main_.points->var[id] + k * r_.stride + begin, end - begin, attribute[k]);
        }
    }

    void fill_one(std::size_t i) const {
        Place place(table_, r_.hits[i]);
        fill_time(i, i + 1);
        fill_colors(place, place.shape.vars.Cs, place.attributes.color, SL_VAR_Cs, i, i + 1);
        fill_colors(place, place.shape.vars.Os, place.attributes.opacity, SL_VAR_Os, i, i + 1);
        place.here = place.surface().evaluate(place.at);
        fill_geometry(place, i);
        fill_texture_coordinates(place, i);
        const auto [du, dv] = steps(place, i);
        main_.set(SL_VAR_du, i, du);
        main_.set(SL_VAR_dv, i, dv);
        if (aux_u_.wanted) {
            fill_auxiliary(place, i, du, 0, aux_u_);
        }
        if (aux_v_.wanted) {
            fill_auxiliary(place, i, 0, dv, aux_v_);
        }
    }

    void fill_geometry(const Place& p, std::size_t i) const {
        if (main_.has(SL_VAR_P) || main_.has(SL_VAR_I)) {
            const V3d P = table_.cam_point(p.hit, p.here.P);
            main_.set(SL_VAR_P, i, P);
            main_.set(SL_VAR_I, i, P - origin(i));
        }
        main_.set(SL_VAR_u, i, p.here.u);
        main_.set(SL_VAR_v, i, p.here.v);
        if (main_.has(SL_VAR_dPdu)) {
            main_.set(SL_VAR_dPdu, i, table_.cam_vector(p.hit, p.here.dPdu));
        }
        if (main_.has(SL_VAR_dPdv)) {
            main_.set(SL_VAR_dPdv, i, table_.cam_vector(p.hit, p.here.dPdv));
        }
        const bool own_normal = p.shape.vars.N != nullptr;
        if (main_.has(SL_VAR_Ng) || (main_.has(SL_VAR_N) && !own_normal)) {
            const V3d Ng = p.geometric_normal(p.here.Ng);
            main_.set(SL_VAR_Ng, i, Ng);
            if (!own_normal) {
                main_.set(SL_VAR_N, i, Ng);
            }
        }
        if (main_.has(SL_VAR_N) &&
            own_normal) { // as given: neither flipped nor normalised (ri.md 8.6)
            double n[3];
            interpolate(*p.shape.vars.N, p.surface(), p.at, n);
            main_.set(SL_VAR_N, i, table_.cam_normal(p.hit, vec(n)));
        }
    }

    [[nodiscard]] V3d origin(std::size_t i) const {
        return {r_.incident.ox[i], r_.incident.oy[i], r_.incident.oz[i]};
    }
    [[nodiscard]] V3d direction(std::size_t i) const {
        return {r_.incident.dx[i], r_.incident.dy[i], r_.incident.dz[i]};
    }

    // "s", "t" beat "st", which beats the defaults of ri.md 11.1.
    void fill_texture_coordinates(const Place& p, std::size_t i) const {
        if (!main_.has(SL_VAR_s) && !main_.has(SL_VAR_t)) {
            return;
        }
        const StandardVars& vars = p.shape.vars;
        std::array<double, 2> st{};
        if (vars.st) {
            interpolate(*vars.st, p.surface(), p.at, st.data());
        } else if (p.surface().inherits_texture_coordinates()) {
            st = mapped(p, p.here.u, p.here.v);
        } else {
            st = {p.here.P.x, p.here.P.y};
        }
        if (vars.s) {
            interpolate(*vars.s, p.surface(), p.at, &st[0]);
        }
        if (vars.t) {
            interpolate(*vars.t, p.surface(), p.at, &st[1]);
        }
        main_.set(SL_VAR_s, i, st[0]);
        main_.set(SL_VAR_t, i, st[1]);
    }

    // TextureCoordinates over the surface parameters.
    static std::array<double, 2> mapped(const Place& p, double u, double v) {
        const ParamRange range = p.surface().range();
        const double uh = (u - range.u0) / (range.u1 - range.u0);
        const double vh = (v - range.v0) / (range.v1 - range.v0);
        const auto& c = p.attributes.texture_coordinates;
        std::array<double, 2> st{};
        for (std::size_t k = 0; k < 2; ++k) {
            st[k] = (1 - vh) * ((1 - uh) * c[k] + uh * c[2 + k]) +
                    vh * ((1 - uh) * c[4 + k] + uh * c[6 + k]);
        }
        return st;
    }

    // The change of the bilinear map when one parameter moves: exact, without subtracting values.
    static std::array<double, 2> mapped_difference(const Place& p, double du, double dv) {
        const ParamRange range = p.surface().range();
        const double uh = (p.here.u - range.u0) / (range.u1 - range.u0),
                     duh = du / (range.u1 - range.u0);
        const double vh = (p.here.v - range.v0) / (range.v1 - range.v0),
                     dvh = dv / (range.v1 - range.v0);
        const auto& c = p.attributes.texture_coordinates;
        std::array<double, 2> st{};
        for (std::size_t k = 0; k < 2; ++k) {
            const double by_u =
                (1 - vh) * (double(c[2 + k]) - c[k]) + vh * (double(c[6 + k]) - c[4 + k]);
            const double by_v =
                (1 - uh) * (double(c[4 + k]) - c[k]) + uh * (double(c[6 + k]) - c[2 + k]);
            const double twist = double(c[k]) - c[2 + k] - c[4 + k] + c[6 + k];
            st[k] = by_u * duh + by_v * dvh + twist * duh * dvh;
        }
        return st;
    }

    // du = footprint / |dPdu| * 1/sin(angle to the ray), rounded to the float that shaders see.
    [[nodiscard]] std::array<double, 2> steps(const Place& p, std::size_t i) const {
        if (!(aux_u_.wanted || aux_v_.wanted || main_.has(SL_VAR_du) || main_.has(SL_VAR_dv))) {
            return {0, 0};
        }
        const std::array<double, 2> most = p.surface().max_step();
        const ParamRange range = p.surface().range();
        return {step(table_.cam_vector(p.hit, p.here.dPdu), range.u1 - range.u0, most[0], i),
                step(table_.cam_vector(p.hit, p.here.dPdv), range.v1 - range.v0, most[1], i)};
    }

    [[nodiscard]] double step(const V3d& derivative, double range, double most,
                              std::size_t i) const {
        const double given = i < r_.incident.footprint.size() ? r_.incident.footprint[i] : 0.0;
        const double footprint = given > 0 ? given : 0;
        const V3d d = direction(i);
        const double speed = base::length(derivative), along = dot(d, derivative);
        const double scale = base::length(d) * speed;
        const double cosine = scale > 0 ? along / scale : 0;
        const double wanted =
            footprint / std::sqrt(std::max(1 - cosine * cosine, least_sin2)) / speed;
        const double limited = wanted < most ? wanted : most; // also where the speed is 0
        const double least = std::max(std::fabs(range) * least_step, 1e-20);
        return static_cast<double>(static_cast<float>(std::max(limited, least)));
    }

    void fill_auxiliary(const Place& p, std::size_t i, double du, double dv,
                        const Planes& out) const {
        SurfacePoint d;
        const bool by_plane = !p.surface().inherits_texture_coordinates(); // s, t follow P
        if (out.wanted & (position_vars | (by_plane ? bit(SL_VAR_s) | bit(SL_VAR_t) : 0))) {
            d = p.surface().difference(p.at, p.here, du, dv);
            fill_position_differences(p, i, d, out);
            fill_normal_difference(p, i, d, du, dv, out);
        }
        out.set(SL_VAR_u, i, du);
        out.set(SL_VAR_v, i, dv);
        for (const sl_variable same : {SL_VAR_du, SL_VAR_dv, SL_VAR_time}) {
            out.set(same, i, 0.0);
        }
        out.set(SL_VAR_dPdtime, i, V3d());
        fill_variable_differences(p, i, d, du, dv, out);
    }

    void fill_position_differences(const Place& p, std::size_t i, const SurfacePoint& d,
                                   const Planes& out) const {
        if (out.has(SL_VAR_P) || out.has(SL_VAR_I)) {
            const V3d dP = table_.cam_vector(p.hit, d.P);
            out.set(SL_VAR_P, i, dP);
            out.set(SL_VAR_I, i, incident_difference(dP, i));
        }
        if (out.has(SL_VAR_dPdu)) {
            out.set(SL_VAR_dPdu, i, table_.cam_vector(p.hit, d.dPdu));
        }
        if (out.has(SL_VAR_dPdv)) {
            out.set(SL_VAR_dPdv, i, table_.cam_vector(p.hit, d.dPdv));
        }
    }

    // The same eye sees both points; rays of an orthographic camera are parallel instead, and those
    // of mirrors in between: their origins differ across the ray by what did not open on the way.
    [[nodiscard]] V3d incident_difference(const V3d& dP, std::size_t i) const {
        const V3d d = direction(i);
        if (i < r_.incident.widening.size()) {
            const double dd = dot(d, d);
            const V3d along = dd > 0 ? d * (dot(d, dP) / dd) : V3d();
            return along + (dP - along) * double(r_.incident.widening[i]);
        }
        return !r_.perspective && d.x == 0 && d.y == 0 ? V3d(0, 0, dP.z) : dP;
    }

    void fill_normal_difference(const Place& p, std::size_t i, const SurfacePoint& d, double du,
                                double dv, const Planes& out) const {
        const rib::Param* N = p.shape.vars.N;
        if (out.has(SL_VAR_Ng) || (out.has(SL_VAR_N) && !N)) {
            const V3d change = d.Ng == V3d() ? V3d()
                                             : p.geometric_normal(p.here.Ng + d.Ng) -
                                                   p.geometric_normal(p.here.Ng);
            out.set(SL_VAR_Ng, i, change);
            if (!N) {
                out.set(SL_VAR_N, i, change);
            }
        }
        if (out.has(SL_VAR_N) && N) {
            double n[3];
            interpolate_difference(*N, p.surface(), p.at, p.surface().step(p.at, du, dv), n);
            out.set(SL_VAR_N, i, table_.cam_normal(p.hit, vec(n)));
        }
    }

    void fill_variable_differences(const Place& p, std::size_t i, const SurfacePoint& d, double du,
                                   double dv, const Planes& out) const {
        const StandardVars& vars = p.shape.vars;
        const LocalPoint to = vars.any() ? p.surface().step(p.at, du, dv) : p.at;
        const auto change = [&](const rib::Param* param, double* value) {
            if (param) {
                interpolate_difference(*param, p.surface(), p.at, to, value);
            }
        };
        for (const auto& [id, param] :
             {std::pair{SL_VAR_Cs, vars.Cs}, std::pair{SL_VAR_Os, vars.Os}}) {
            double color[3] = {};
            if (out.has(id)) {
                change(param, color);
                out.set(id, i, vec(color));
            }
        }
        if (!out.has(SL_VAR_s) && !out.has(SL_VAR_t)) {
            return;
        }
        std::array<double, 2> st{d.P.x, d.P.y};
        if (vars.st) {
            change(vars.st, st.data());
        } else if (p.surface().inherits_texture_coordinates()) {
            st = mapped_difference(p, du, dv);
        }
        change(vars.s, &st[0]);
        change(vars.t, &st[1]);
        out.set(SL_VAR_s, i, st[0]);
        out.set(SL_VAR_t, i, st[1]);
    }
};

// Object-space value of a declared type to camera space, in place; returns the components a shader
// gets.
std::size_t to_camera(const ShapeTable& table, const Hit& hit, rib::ParamType type, double* x) {
    const auto store = [x](const V3d& v) {
        x[0] = v.x;
        x[1] = v.y;
        x[2] = v.z;
        return std::size_t(3);
    };
    switch (type) {
    case rib::ParamType::Point:
        return store(table.cam_point(hit, vec(x)));
    case rib::ParamType::Vector:
        return store(table.cam_vector(hit, vec(x)));
    case rib::ParamType::Normal:
        return store(table.cam_normal(hit, vec(x)));
    case rib::ParamType::HPoint:
        return store(table.cam_point(hit, x[3] != 0 ? vec(x) / x[3] : vec(x)));
    case rib::ParamType::Matrix:
    case rib::ParamType::MPoint: {
        Mat4 m;
        std::copy_n(x, 16, &m.m[0][0]);
        const Mat4 in_camera = table.cam_from_object(hit) * m;
        std::copy_n(&in_camera.m[0][0], 16, x);
        return 16;
    }
    case rib::ParamType::Color:
        return 3;
    case rib::ParamType::Float:
    case rib::ParamType::Integer:
    case rib::ParamType::String:
    case rib::ParamType::Pointer:
        return 1;
    }
    return 1;
}

// The same for a difference of two values; value is the one it starts from.
std::size_t difference_to_camera(const ShapeTable& table, const Hit& hit, rib::ParamType type,
                                 const double* value, double* d) {
    if (type == rib::ParamType::HPoint && value[3] != 0 && value[3] + d[3] != 0) {
        const V3d at = vec(value) / value[3]; // (x + dx)/(w + dw) - x/w
        const V3d change = table.cam_vector(hit, (vec(d) - at * d[3]) / (value[3] + d[3]));
        std::copy_n(&change.x, 3, d);
        return 3;
    }
    const bool moves = type == rib::ParamType::Point || type == rib::ParamType::HPoint;
    return to_camera(table, hit, moves ? rib::ParamType::Vector : type, d);
}

constexpr double float_eps = 1.0 / (1 << 24); // half an ulp of 1: the relative rounding error

// |v| through |M|: how far an error in the source can reach in the destination.
V3d spread(const Mat4& m, const V3d& v, bool with_translation) {
    V3d r;
    for (int k = 0; k < 3; ++k) {
        r[k] = std::fabs(m.m[0][k]) * v.x + std::fabs(m.m[1][k]) * v.y +
               std::fabs(m.m[2][k]) * v.z + (with_translation ? std::fabs(m.m[3][k]) : 0);
    }
    return r;
}

V3d absolute(const V3d& v) {
    return {std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)};
}

// P + n offset, rounded away from P.
V3f moved(const V3d& P, const V3d& n, double offset) {
    V3f result(P + n * offset);
    for (int k = 0; k < 3; ++k) {
        if (n[k] != 0) {
            result[k] = std::nextafter(result[k], n[k] * offset > 0 ? INFINITY : -INFINITY);
        }
    }
    return result;
}

} // namespace

void fill_points(const ShapeTable& table, const FillRequest& request) {
    Filler(table, request).run();
}

void fill_variable(const ShapeTable& table, std::span<const Hit> hits, const rib::Param& param,
                   std::uint32_t stride, float* out) {
    const std::size_t width = floats_per_item(param.decl);
    const auto each = static_cast<std::size_t>(rib::components(param.decl.type));
    std::vector<double> value(width);
    for (std::size_t i = 0; i < hits.size(); ++i) {
        interpolate(param, *table.shapes[hits[i].shape].surface,
                    {hits[i].part, hits[i].u, hits[i].v}, value.data());
        std::size_t plane = 0;
        for (std::size_t element = 0; element < width; element += each) {
            const std::size_t n = to_camera(table, hits[i], param.decl.type, &value[element]);
            for (std::size_t k = 0; k < n; ++k, ++plane) {
                out[plane * stride + i] = static_cast<float>(value[element + k]);
            }
        }
    }
}

void fill_variable_differences(const ShapeTable& table, std::span<const Hit> hits,
                               const rib::Param& param, const AuxiliaryPlanes& planes) {
    const std::size_t width = floats_per_item(param.decl);
    const auto each = static_cast<std::size_t>(rib::components(param.decl.type));
    std::vector<double> value(width), change(width);
    const auto fill = [&](std::size_t i, double du, double dv, float* out) {
        const Hit& hit = hits[i];
        const Surface& surface = *table.shapes[hit.shape].surface;
        const LocalPoint at{hit.part, hit.u, hit.v};
        interpolate(param, surface, at, value.data());
        interpolate_difference(param, surface, at, surface.step(at, du, dv), change.data());
        std::size_t plane = 0;
        for (std::size_t element = 0; element < width; element += each) {
            const std::size_t n = difference_to_camera(table, hit, param.decl.type, &value[element],
                                                       &change[element]);
            for (std::size_t k = 0; k < n; ++k, ++plane) {
                out[plane * planes.stride + i] = static_cast<float>(change[element + k]);
            }
        }
    };
    for (std::size_t i = 0; i < hits.size(); ++i) {
        if (planes.out_u) {
            fill(i, static_cast<double>(planes.du[i]), 0, planes.out_u);
        }
        if (planes.out_v) {
            fill(i, 0, static_cast<double>(planes.dv[i]), planes.out_v);
        }
    }
}

// Error bounds in units of float_eps: rounding P (1), Embree's subtraction of the origin from the
// vertices and the rounding of these (4 and 1 of their reach, by the measurements in the tests),
// the ray's way into an instance (16: float matrix, its float inverse, origin). Then along the
// normal, and away by one ulp. [pbrt4] 6.8.6
SpawnPoint spawn_points(const ShapeTable& table, const Hit& hit) {
    const Shape& shape = table.shapes[hit.shape];
    const LocalPoint at{hit.part, hit.u, hit.v};
    const SurfacePoint here = shape.surface->evaluate(at);
    const TraceError error = shape.surface->trace_error(at, here);
    const V3d P = table.cam_point(hit, here.P);
    const Mat4 cam_from_object = table.cam_from_object(hit);

    V3d bound = absolute(P) * 2;
    if (error.reach != V3d()) {
        bound += spread(cam_from_object, error.reach, true) * 5;
    }
    if (hit.instance != no_id) {
        const Placement& placement = table.instances[hit.instance].cam_from_definition;
        // Embree's way into the trace space: linear part, then one translation (to the prototype's
        // centre).
        const auto& m = placement.object_from_parent.m;
        const V3d shift = V3d(m[3][0], m[3][1], m[3][2]) - table.objects[shape.object].centre;
        const V3d in_trace =
            spread(placement.object_from_parent, absolute(P), false) + absolute(shift);
        bound += spread(placement.parent_from_object, in_trace, false) * 16;
    }
    bound = bound * float_eps;

    const V3d n = normalize(table.cam_normal(hit, error.facet_normal));
    const double stretch = base::length(table.cam_vector(hit, normalize(error.facet_normal)));
    const double offset = dot(bound, absolute(n)) + error.deviation * stretch;
    return {V3f(n), moved(P, n, offset), moved(P, n, -offset)};
}

} // namespace geo
