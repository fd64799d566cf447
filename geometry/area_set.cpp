// SPDX-License-Identifier: Apache-2.0
#include "geometry/area_set.h"

#include "geometry/shapes.h"
#include "geometry/spherical.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace geo {

namespace {

constexpr double pi = std::numbers::pi;
// Curved surfaces: nodes per side for one part, and for meshes of many.
constexpr std::size_t most_nodes = 65, fewest_nodes = 3;
constexpr std::size_t nodes_of_all_parts = std::size_t(1) << 18;
// A node is looked at this far inside: poles and tips have limits, not values.
constexpr double inset = 1e-5;
// Below this solid angle, places by area and by angle are the same to the eye, and the arithmetic
// of angles loses digits.
constexpr double least_solid_angle = 1e-3;
// Flat elements that are looked at one by one for their solid angle.
constexpr std::size_t most_seen_elements = 8;
// A sphere is left alone this close to it, relative to its radius.
constexpr double near_sphere = 1.001;

// Where in a cell between two values with linear density a part x of the integral lies.
double invert_linear(double a, double b, double x) {
    const double sum = a + b;
    if (!(sum > 0)) {
        return x;
    }
    // (b - a) p^2 + 2 a p = x (a + b), by the root that does not cancel.
    const double c = x * sum;
    return std::min(c / (a + std::sqrt(a * a + (b - a) * c)), 1.0);
}

V3d any_across(const V3d& n) {
    const V3d axis = std::fabs(n.x) < 0.6 ? V3d(1, 0, 0) : V3d(0, 1, 0);
    return normalize(cross(n, axis));
}

} // namespace

// --- density

GridDensity::GridDensity(std::size_t size, std::vector<double> values)
    : size_(size), nodes_(std::move(values)) {
    const double step = 1 / double(size_ - 1);
    double sum = 0;
    for (double& v : nodes_) {
        v = v > 0 && std::isfinite(v) ? v : 0;
        sum += v;
    }
    const double floor = 1e-4 * sum / double(nodes_.size());
    for (double& v : nodes_) { // nowhere 0: every place can be chosen
        v = std::max(v, floor);
    }
    along_.resize(nodes_.size());
    rows_.resize(size_);
    for (std::size_t iy = 0; iy < size_; ++iy) {
        for (std::size_t ix = 1; ix < size_; ++ix) {
            along_[iy * size_ + ix] =
                along_[iy * size_ + ix - 1] + 0.5 * step * (at(ix - 1, iy) + at(ix, iy));
        }
        const auto whole = [&](std::size_t y) { return along_[y * size_ + size_ - 1]; };
        rows_[iy] = iy == 0 ? 0 : rows_[iy - 1] + 0.5 * step * (whole(iy - 1) + whole(iy));
    }
    total_ = rows_.back();
}

double GridDensity::warp(double& x, double& y) const {
    const double step = 1 / double(size_ - 1);
    const double wanted_y = y * total_;
    const auto row_end = std::upper_bound(rows_.begin() + 1, rows_.end() - 1, wanted_y);
    const auto iy = static_cast<std::size_t>(row_end - rows_.begin()) - 1;
    const double a = along_[iy * size_ + size_ - 1], b = along_[(iy + 1) * size_ + size_ - 1];
    const double in_row = (wanted_y - rows_[iy]) / (rows_[iy + 1] - rows_[iy]);
    const double fy = invert_linear(a, b, in_row);
    // Along x the density is the mean of the two rows, at fy.
    const auto mean = [&](const std::vector<double>& v, std::size_t ix) {
        return (1 - fy) * v[iy * size_ + ix] + fy * v[(iy + 1) * size_ + ix];
    };
    const double wanted_x = x * mean(along_, size_ - 1);
    std::size_t low = 0, high = size_ - 1;
    while (high - low > 1) {
        const std::size_t middle = (low + high) / 2;
        (mean(along_, middle) <= wanted_x ? low : high) = middle;
    }
    const double l = mean(nodes_, low), r = mean(nodes_, low + 1);
    const double cell = mean(along_, low + 1) - mean(along_, low);
    const double fx = invert_linear(l, r, (wanted_x - mean(along_, low)) / cell);
    x = (double(low) + fx) * step;
    y = (double(iy) + fy) * step;
    return ((1 - fx) * l + fx * r) / total_;
}

// --- elements

AreaSet::AreaSet(const ShapeTable& table, std::span<const std::uint32_t> primitives)
    : table_(table) {
    const ShapeGroup& world = table.world;
    for (std::uint32_t i = world.first_shape; i < world.first_shape + world.num_shapes; ++i) {
        if (std::binary_search(primitives.begin(), primitives.end(), table.shapes[i].primitive)) {
            add_shape(i);
        }
    }
}

void AreaSet::add_shape(std::uint32_t shape) {
    if (add_flat(shape) || add_sphere(shape)) {
        return;
    }
    const std::size_t parts = table_.shapes[shape].surface->num_parts();
    std::size_t size = most_nodes;
    while (size > fewest_nodes && size * size * parts > nodes_of_all_parts) {
        size = size / 2 + 1;
    }
    for (std::uint32_t part = 0; part < parts; ++part) {
        add_curved(shape, part, size);
    }
}

void AreaSet::add(Element element) {
    if (element.area > 0 && std::isfinite(element.area)) {
        area_ += element.area;
        up_to_.push_back(area_);
        elements_.push_back(std::move(element));
    }
}

// Two triangles that make a parallelogram are one element.
bool AreaSet::add_flat(std::uint32_t shape) {
    const Surface& surface = *table_.shapes[shape].surface;
    std::array<V3d, 3> a, b;
    if (!surface.corners(0, a)) {
        return false;
    }
    const Hit on_shape{shape};
    const auto parts = static_cast<std::uint32_t>(surface.num_parts());
    for (std::uint32_t part = 0; part < parts; ++part) {
        (void)surface.corners(part, a);
        for (V3d& p : a) {
            p = table_.cam_point(on_shape, p);
        }
        Element e;
        e.shape = shape;
        e.part = part;
        e.kind = Kind::Triangle;
        e.corner = {a[0], a[1] - a[0], a[2] - a[0]};
        e.area = 0.5 * length(cross(e.corner[1], e.corner[2]));
        if (part + 1 < parts && surface.corners(part + 1, b)) {
            for (V3d& p : b) {
                p = table_.cam_point(on_shape, p);
            }
            const V3d e1 = a[1] - a[0], e2 = b[2] - b[0];
            const double size = length(e1) + length(e2);
            if (b[0] == a[0] && b[1] == a[2] && length(a[2] - a[0] - e1 - e2) <= 1e-6 * size) {
                e.kind = Kind::Parallelogram;
                e.corner = {a[0], e1, e2};
                e.area = length(cross(e1, e2));
                e.is_rectangle = std::fabs(dot(e1, e2)) <= 1e-6 * length(e1) * length(e2);
                ++part;
            }
        }
        add(std::move(e));
    }
    return true;
}

// A sphere that its transformation leaves a sphere.
bool AreaSet::add_sphere(std::uint32_t shape) {
    const double radius = table_.shapes[shape].surface->whole_sphere();
    if (!(radius > 0)) {
        return false;
    }
    const Hit on_shape{shape};
    const V3d x = table_.cam_vector(on_shape, {radius, 0, 0});
    const V3d y = table_.cam_vector(on_shape, {0, radius, 0});
    const V3d z = table_.cam_vector(on_shape, {0, 0, radius});
    const double rr = dot(x, x);
    for (const double skew : {dot(x, y), dot(y, z), dot(x, z), dot(y, y) - rr, dot(z, z) - rr}) {
        if (!(std::fabs(skew) <= 1e-6 * rr)) {
            return false;
        }
    }
    Element e;
    e.kind = Kind::Sphere;
    e.shape = shape;
    e.corner = {table_.cam_point(on_shape, {}), V3d(std::sqrt(rr), 0, 0), V3d()};
    e.area = 4 * pi * rr;
    add(std::move(e));
    return true;
}

double AreaSet::curved_area_element(const Element& e, double s, double t) const {
    const Surface& surface = *table_.shapes[e.shape].surface;
    const PartPlace place = surface.place(e.part, s, t);
    const SurfacePoint p = surface.evaluate(place.at);
    const Hit on_shape{e.shape};
    return length(cross(table_.cam_vector(on_shape, p.dPdu), table_.cam_vector(on_shape, p.dPdv))) *
           std::fabs(place.du_ds * place.dv_dt);
}

void AreaSet::add_curved(std::uint32_t shape, std::uint32_t part, std::size_t size) {
    Element e;
    e.shape = shape;
    e.part = part;
    std::vector<double> values;
    values.reserve(size * size);
    for (std::size_t iy = 0; iy < size; ++iy) {
        for (std::size_t ix = 0; ix < size; ++ix) {
            const auto at = [size](std::size_t i) {
                return std::clamp(double(i) / double(size - 1), inset, 1 - inset);
            };
            values.push_back(curved_area_element(e, at(ix), at(iy)));
        }
    }
    e.density = GridDensity(size, std::move(values));
    // Simpson's rule from the nodes would do for smooth ones; the mean over many places between
    // them does for all.
    constexpr int places = 64;
    double sum = 0;
    for (int iy = 0; iy < places; ++iy) {
        for (int ix = 0; ix < places; ++ix) {
            double s = (ix + 0.5) / places, t = (iy + 0.5) / places;
            const double density = e.density.warp(s, t);
            sum += curved_area_element(e, s, t) / density;
        }
    }
    e.area = sum / (places * places);
    add(std::move(e));
}

// --- by area

AreaPoint AreaSet::by_area(double x, double y) const {
    const double wanted = x * area_;
    const auto it = std::upper_bound(up_to_.begin(), up_to_.end() - 1, wanted);
    const Element& e = elements_[static_cast<std::size_t>(it - up_to_.begin())];
    return on_element(e, std::clamp(1 - (*it - wanted) / e.area, 0.0, 1.0), y);
}

AreaPoint AreaSet::on_element(const Element& e, double x, double y) const {
    switch (e.kind) {
    case Kind::Triangle: // [Heitz19]
        return y > x ? on_flat(e, 0.5 * x, y - 0.5 * x) : on_flat(e, x - 0.5 * y, 0.5 * y);
    case Kind::Parallelogram:
        return on_flat(e, x, y);
    case Kind::Sphere: {
        const double z = 2 * y - 1, r = std::sqrt(std::max(0.0, 1 - z * z));
        const V3d n(r * std::cos(2 * pi * x), r * std::sin(2 * pi * x), z);
        AreaPoint p = on_sphere(e, e.corner[0], n);
        p.weight = 1;
        return p;
    }
    case Kind::Curved:
        break;
    }
    double s = x, t = y;
    const double density = e.density.warp(s, t);
    const LocalPoint at = table_.shapes[e.shape].surface->place(e.part, s, t).at;
    AreaPoint p;
    p.hit.shape = e.shape;
    p.hit.part = at.part;
    p.hit.u = static_cast<float>(at.u);
    p.hit.v = static_cast<float>(at.v);
    p.weight = curved_area_element(e, s, t) / (density * e.area);
    return p;
}

// corner + a edge1 + b edge2; the second triangle of a parallelogram lies beyond the diagonal.
AreaPoint AreaSet::on_flat(const Element& e, double a, double b) {
    AreaPoint p;
    p.hit.shape = e.shape;
    p.hit.part = e.part;
    p.weight = 1;
    double u = a, v = b;
    if (e.kind == Kind::Parallelogram) {
        const bool second = b > a;
        p.hit.part += second ? 1 : 0;
        u = second ? a : a - b;
        v = second ? b - a : b;
    }
    p.hit.u = static_cast<float>(u);
    p.hit.v = static_cast<float>(v);
    return p;
}

// Where a ray of camera space meets the sphere first. Weight: not set.
AreaPoint AreaSet::on_sphere(const Element& e, const V3d& from, const V3d& direction) const {
    const Shape& shape = table_.shapes[e.shape];
    const Mat4& object_from_cam = table_.placements[shape.placement].object_from_parent;
    const ObjectRay ray{point(object_from_cam, from), vector(object_from_cam, direction), 0,
                        std::numeric_limits<double>::infinity(), 0};
    LocalHit hit;
    AreaPoint p;
    if (shape.surface->intersect(ray, hit)) {
        p.hit.shape = e.shape;
        p.hit.part = hit.at.part;
        p.hit.u = static_cast<float>(hit.at.u);
        p.hit.v = static_cast<float>(hit.at.v);
        p.hit.t = static_cast<float>(hit.t);
    }
    return p;
}

// --- by solid angle

namespace {

std::array<V3d, 3> seen(const std::array<V3d, 3>& corner_and_edges, const V3d& P) {
    const V3d c = corner_and_edges[0] - P;
    return {c, c + corner_and_edges[1], c + corner_and_edges[2]};
}

std::array<V3d, 3> other_half(const std::array<V3d, 3>& corner_and_edges, const V3d& P) {
    const V3d c = corner_and_edges[0] - P, far = c + corner_and_edges[1] + corner_and_edges[2];
    return {far, c + corner_and_edges[2], c + corner_and_edges[1]};
}

// 1 - cos of the half angle a sphere is seen under, without cancellation; s = sin.
double one_minus_cos(double s) {
    return s * s / (1 + std::sqrt(std::max(0.0, 1 - s * s)));
}

} // namespace

AreaSet::View AreaSet::seen_from(const V3d& P) const {
    View view;
    if (elements_.size() == 1 && elements_[0].kind == Kind::Sphere) {
        const double radius = elements_[0].corner[1].x;
        const double distance = length(elements_[0].corner[0] - P);
        if (distance > near_sphere * radius) {
            view.solid_angle = 2 * pi * one_minus_cos(radius / distance);
            view.hidden = 0.5 * (1 + radius / distance);
        }
        return view;
    }
    if (elements_.size() > most_seen_elements) {
        return view;
    }
    double sum = 0;
    for (const Element& e : elements_) {
        if (e.kind == Kind::Sphere || e.kind == Kind::Curved) {
            return {};
        }
        if (e.is_rectangle) {
            sum += SphericalRectangle(e.corner[0] - P, e.corner[1], e.corner[2]).solid_angle();
            continue;
        }
        sum += SphericalTriangle(seen(e.corner, P)).solid_angle();
        if (e.kind == Kind::Parallelogram) {
            sum += SphericalTriangle(other_half(e.corner, P)).solid_angle();
        }
    }
    view.solid_angle = sum > least_solid_angle ? sum : 0;
    return view;
}

AreaPoint AreaSet::by_angle(const V3d& P, double x, double y) const {
    if (elements_[0].kind == Kind::Sphere) {
        return on_seen_sphere(P, x, y);
    }
    const double total = seen_from(P).solid_angle;
    double rest = x * total;
    // The part of a piece that x falls into, or the last piece.
    const auto falls_into = [&](double solid_angle, bool is_last) {
        const bool here = rest < solid_angle || is_last;
        rest -= here ? 0 : solid_angle;
        return here && solid_angle > 0;
    };
    for (std::size_t i = 0; i < elements_.size(); ++i) {
        const Element& e = elements_[i];
        const bool is_last = i + 1 == elements_.size();
        if (e.is_rectangle) {
            const SphericalRectangle piece(e.corner[0] - P, e.corner[1], e.corner[2]);
            if (falls_into(piece.solid_angle(), is_last)) {
                const double at = std::min(rest / piece.solid_angle(), 1.0);
                return towards(e, piece.direction(at, y), P, total);
            }
            continue;
        }
        const bool has_two = e.kind == Kind::Parallelogram;
        for (int half = 0; half < (has_two ? 2 : 1); ++half) {
            const SphericalTriangle piece(half == 0 ? seen(e.corner, P) : other_half(e.corner, P));
            if (falls_into(piece.solid_angle(), is_last && (half == 1 || !has_two))) {
                const double at = std::min(rest / piece.solid_angle(), 1.0);
                return towards(e, piece.direction(at, y), P, total);
            }
        }
    }
    return {};
}

// Where a direction from P meets a flat element; the rounding of the direction may carry it over
// the border.
AreaPoint AreaSet::towards(const Element& e, const V3d& direction, const V3d& P,
                           double solid_angle) const {
    const V3d n = cross(e.corner[1], e.corner[2]);
    const double nn = dot(n, n), along = dot(direction, n);
    if (along == 0) {
        return {};
    }
    const double t = dot(e.corner[0] - P, n) / along;
    const V3d at = P + direction * t - e.corner[0];
    double a = std::clamp(dot(cross(at, e.corner[2]), n) / nn, 0.0, 1.0);
    double b = std::clamp(dot(cross(e.corner[1], at), n) / nn, 0.0, 1.0);
    if (e.kind == Kind::Triangle && a + b > 1) {
        const double sum = a + b;
        a /= sum;
        b /= sum;
    }
    AreaPoint p = on_flat(e, a, b);
    const double cosine = std::fabs(along) / std::sqrt(nn);
    p.weight = t * t * solid_angle / (area_ * cosine);
    return p;
}

// Directions in the cone the sphere fills.
AreaPoint AreaSet::on_seen_sphere(const V3d& P, double x, double y) const {
    const Element& e = elements_[0];
    const double radius = e.corner[1].x;
    const V3d to_centre = e.corner[0] - P;
    const double distance = length(to_centre);
    const V3d axis = to_centre / distance, side = any_across(axis), up = cross(axis, side);
    const double open = one_minus_cos(radius / distance);
    const double drop = y * open, sine = std::sqrt(drop * (2 - drop)); // drop = 1 - cos
    const V3d d = axis * (1 - drop) + side * (sine * std::cos(2 * pi * x)) +
                  up * (sine * std::sin(2 * pi * x));
    AreaPoint p = on_sphere(e, P, d);
    // The near root of the ray; at the rim rounding may miss it, or the surface itself.
    const double off = std::max(0.0, radius * radius - distance * distance * sine * sine);
    const double t = distance * (1 - drop) - std::sqrt(off);
    const double cosine = std::sqrt(off) / radius;
    if (p.hit.valid() && cosine > 0) {
        p.weight = t * t * 2 * pi * open / (area_ * cosine);
    } else {
        p = {};
    }
    return p;
}

AreaPoint AreaSet::by_hidden(const V3d& P, double x, double y) const {
    const Element& e = elements_[0];
    if (e.kind != Kind::Sphere) {
        return {};
    }
    const V3d to_P = P - e.corner[0];
    const double distance = length(to_P), top = e.corner[1].x / distance;
    const V3d axis = to_P / distance, side = any_across(axis), up = cross(axis, side);
    const double z = -1 + y * (1 + top), r = std::sqrt(std::max(0.0, 1 - z * z));
    AreaPoint p =
        on_sphere(e, e.corner[0],
                  axis * z + side * (r * std::cos(2 * pi * x)) + up * (r * std::sin(2 * pi * x)));
    p.weight = 0.5 * (1 + top);
    return p;
}

std::unique_ptr<const AreaSet> make_area_set(const ShapeTable& table,
                                             std::span<const std::uint32_t> primitives) {
    std::vector<std::uint32_t> sorted(primitives.begin(), primitives.end());
    std::sort(sorted.begin(), sorted.end());
    auto set = std::make_unique<const AreaSet>(table, sorted);
    return set->num_elements() > 0 ? std::move(set) : nullptr;
}

} // namespace geo
