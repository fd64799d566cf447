// SPDX-License-Identifier: Apache-2.0
// The seven quadrics of ri.md 11.9 as surfaces of revolution: generator curve, roots along a ray,
// inverse map. Normals are the limits of dPdu x dPdv as written there, so signs of radii and ranges
// follow the formulas.
#include "geometry/revolution.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace geo {

namespace {

constexpr double radians = std::numbers::pi / 180;

double sign(double x) {
    return std::copysign(1.0, x);
}

// asin that clamps: limits beyond the radius mean the pole.
double latitude(double z, double radius) {
    return std::asin(std::clamp(z / radius, -1.0, 1.0));
}

// Circle of radius r in the (rho, z) half plane, about (centre, 0): the profile of sphere and
// torus.
struct Arc {
    double r, phi0, dphi;

    [[nodiscard]] double phi(double v) const { return phi0 + v * dphi; }
    [[nodiscard]] V3d offset(double v) const {
        return {r * std::cos(phi(v)), 0, r * std::sin(phi(v))};
    }
    [[nodiscard]] V3d derivative(double v) const {
        return {-r * dphi * std::sin(phi(v)), 0, r * dphi * std::cos(phi(v))};
    }
    // (d/dtheta x d/dv) divided by its factors that cannot change sign along the arc.
    [[nodiscard]] V3d normal(double v) const {
        return V3d(std::cos(phi(v)), 0, std::sin(phi(v))) * sign(dphi);
    }
    [[nodiscard]] V3d difference(double v, double dv) const {
        const double mid = phi(v) + 0.5 * dv * dphi;
        return V3d(-std::sin(mid), 0, std::cos(mid)) * (2 * r * std::sin(0.5 * dv * dphi));
    }
};

class Sphere final : public Revolution {
public:
    // A negative radius mirrors the sphere through its centre, which reverses the normal; z limits
    // keep their meaning.
    Sphere(double radius, double zmin, double zmax, double thetamax_deg)
        : Revolution(thetamax_deg), radius_(radius) {
        double phi0 = latitude(zmin, radius), phi1 = latitude(zmax, radius);
        if (radius < 0) {
            std::swap(phi0, phi1);
        }
        arc_ = {radius, phi0, phi1 - phi0};
    }
    [[nodiscard]] bool is_empty() const { return arc_.dphi == 0; }
    [[nodiscard]] double whole_sphere() const override {
        return is_whole_turn() && std::fabs(arc_.dphi) >= std::numbers::pi ? std::fabs(radius_) : 0;
    }

    // The box of the whole ellipsoid is tighter than its rings' when rotated; both hold the
    // surface.
    [[nodiscard]] Box bound(const Mat4& dst_from_object) const override {
        const auto& m = dst_from_object.m;
        Box box = Revolution::bound(dst_from_object);
        for (int k = 0; k < 3; ++k) {
            const double extent =
                std::fabs(radius_) * std::hypot(std::hypot(m[0][k], m[1][k]), m[2][k]);
            box.lo[k] = std::max(box.lo[k], m[3][k] - extent);
            box.hi[k] = std::min(box.hi[k], m[3][k] + extent);
        }
        return box;
    }

private:
    double radius_;
    Arc arc_{};

    [[nodiscard]] Generator generator(double v) const override {
        return {arc_.offset(v), arc_.derivative(v), arc_.normal(v)};
    }
    [[nodiscard]] V3d generator_difference(double v, double dv) const override {
        return arc_.difference(v, dv);
    }
    [[nodiscard]] Roots roots(const V3d& o, const V3d& d) const override {
        return solve_quadratic(dot(d, d), dot(o, d), dot(o, o) - radius_ * radius_);
    }
    [[nodiscard]] bool locate(const V3d& P, double& u, double& v) const override {
        const double s = sign(radius_);
        v = (std::atan2(P.z * s, std::hypot(P.x, P.y)) - arc_.phi0) / arc_.dphi;
        return limit_v(v) && sweep_u(std::atan2(P.y * s, P.x * s), u);
    }
    [[nodiscard]] std::array<Ring, 2> hull() const override {
        const double z0 = arc_.offset(0).z, z1 = arc_.offset(1).z;
        const bool equator = (z0 <= 0) != (z1 <= 0);
        const double r =
            equator ? radius_ : std::max(std::fabs(arc_.offset(0).x), std::fabs(arc_.offset(1).x));
        return {Ring{r, z0}, Ring{r, z1}};
    }
};

class Cone final : public Revolution {
public:
    Cone(double height, double radius, double thetamax_deg)
        : Revolution(thetamax_deg), height_(height), radius_(radius) {}

private:
    double height_, radius_;

    [[nodiscard]] Generator generator(double v) const override {
        return {{radius_ * (1 - v), 0, height_ * v},
                {-radius_, 0, height_},
                V3d(height_, 0, radius_) * sign(radius_)};
    }
    [[nodiscard]] V3d generator_difference(double, double dv) const override {
        return {-radius_ * dv, 0, height_ * dv};
    }
    // x^2 + y^2 = (radius w)^2, w = 1 - z/height.
    [[nodiscard]] Roots roots(const V3d& o, const V3d& d) const override {
        const double w = radius_ * (1 - o.z / height_), dw = -radius_ * d.z / height_;
        return solve_quadratic(d.x * d.x + d.y * d.y - dw * dw, o.x * d.x + o.y * d.y - w * dw,
                               o.x * o.x + o.y * o.y - w * w);
    }
    [[nodiscard]] bool locate(const V3d& P, double& u, double& v) const override {
        const double s = sign(radius_);
        v = P.z / height_;
        return limit_v(v) && sweep_u(std::atan2(P.y * s, P.x * s), u);
    }
    [[nodiscard]] std::array<Ring, 2> hull() const override {
        return {Ring{radius_, 0}, Ring{0, height_}};
    }
};

class Cylinder final : public Revolution {
public:
    Cylinder(double radius, double zmin, double zmax, double thetamax_deg)
        : Revolution(thetamax_deg), radius_(radius), zmin_(zmin), dz_(zmax - zmin) {}

private:
    double radius_, zmin_, dz_;

    [[nodiscard]] Generator generator(double v) const override {
        return {{radius_, 0, zmin_ + v * dz_}, {0, 0, dz_}, {sign(radius_ * dz_), 0, 0}};
    }
    [[nodiscard]] V3d generator_difference(double, double dv) const override {
        return {0, 0, dz_ * dv};
    }
    [[nodiscard]] Roots roots(const V3d& o, const V3d& d) const override {
        return solve_quadratic(d.x * d.x + d.y * d.y, o.x * d.x + o.y * d.y,
                               o.x * o.x + o.y * o.y - radius_ * radius_);
    }
    [[nodiscard]] bool locate(const V3d& P, double& u, double& v) const override {
        const double s = sign(radius_);
        v = (P.z - zmin_) / dz_;
        return limit_v(v) && sweep_u(std::atan2(P.y * s, P.x * s), u);
    }
    [[nodiscard]] std::array<Ring, 2> hull() const override {
        return {Ring{radius_, zmin_}, Ring{radius_, zmin_ + dz_}};
    }
};

// A segment turned about the axis: hyperboloid of one sheet, or a cone, cylinder or flat ring.
class Hyperboloid final : public Revolution {
public:
    Hyperboloid(const V3d& p1, const V3d& p2, double thetamax_deg)
        : Revolution(thetamax_deg), p1_(p1), d_(p2 - p1),
          flat_(std::fabs(d_.z) <= 1e-9 * base::length(d_)) {}

private:
    V3d p1_, d_;
    bool flat_; // in a plane z = const, as far as double can tell

    // n = (xr dz, yr dz, -(xr dx + yr dy)) turned back by its own angle. Where the segment meets
    // the axis its limit towards the middle of the segment is taken.
    [[nodiscard]] Generator generator(double v) const override {
        const V3d p = p1_ + d_ * v;
        if (flat_) {
            return {p, d_, {0, 0, -sign(p.x * d_.x + p.y * d_.y)}};
        }
        V3d q = p;
        if (std::hypot(p.x, p.y) <= 1e-12 * base::length(d_)) {
            q = V3d(d_.x, d_.y, 0) * (v < 0.5 ? 1.0 : -1.0);
        }
        return {p, d_, {q.x * d_.z, q.y * d_.z, -(q.x * d_.x + q.y * d_.y)}};
    }
    [[nodiscard]] V3d generator_difference(double, double dv) const override { return d_ * dv; }
    // dz^2 (x^2 + y^2) = (x1 dz + (z - z1) dx)^2 + (y1 dz + (z - z1) dy)^2
    [[nodiscard]] Roots roots(const V3d& o, const V3d& d) const override {
        if (flat_) {
            return solve_quadratic(0, 0.5 * d.z, o.z - p1_.z);
        }
        const double ax = p1_.x * d_.z + (o.z - p1_.z) * d_.x, bx = d.z * d_.x;
        const double ay = p1_.y * d_.z + (o.z - p1_.z) * d_.y, by = d.z * d_.y;
        const double k = d_.z * d_.z;
        return solve_quadratic(k * (d.x * d.x + d.y * d.y) - bx * bx - by * by,
                               k * (o.x * d.x + o.y * d.y) - ax * bx - ay * by,
                               k * (o.x * o.x + o.y * o.y) - ax * ax - ay * ay);
    }
    [[nodiscard]] bool locate(const V3d& P, double& u, double& v) const override {
        if (!flat_) {
            v = (P.z - p1_.z) / d_.z;
            return accept(P, u, v);
        }
        // |p1 + v d|^2 = x^2 + y^2: two places of the segment may pass the same radius.
        const double a = d_.x * d_.x + d_.y * d_.y, b = p1_.x * d_.x + p1_.y * d_.y;
        const double c = p1_.x * p1_.x + p1_.y * p1_.y;
        for (const double root : solve_quadratic(a, b, c - P.x * P.x - P.y * P.y)) {
            v = root;
            if (accept(P, u, v)) {
                return true;
            }
        }
        return false;
    }
    [[nodiscard]] bool accept(const V3d& P, double& u, double& v) const {
        if (!limit_v(v)) {
            return false;
        }
        const V3d g = p1_ + d_ * v;
        return sweep_u(std::atan2(P.y, P.x) - std::atan2(g.y, g.x), u);
    }
    // The radius is a convex function along the segment.
    [[nodiscard]] std::array<Ring, 2> hull() const override {
        const V3d p2 = p1_ + d_;
        return {Ring{std::hypot(p1_.x, p1_.y), p1_.z}, Ring{std::hypot(p2.x, p2.y), p2.z}};
    }
};

class Paraboloid final : public Revolution {
public:
    Paraboloid(double rmax, double zmin, double zmax, double thetamax_deg)
        : Revolution(thetamax_deg), rmax_(rmax), zlimit_(zmax), zmin_(zmin), dz_(zmax - zmin) {}

private:
    double rmax_, zlimit_; // r = rmax sqrt(z / zlimit)
    double zmin_, dz_;

    // Beyond the tip the curve goes on as its mirror image, so that r stays real.
    [[nodiscard]] double radius(double z) const {
        const double q = z / zlimit_;
        return rmax_ * sign(q) * std::sqrt(std::fabs(q));
    }
    // n = (r, 0, -rmax^2 / (2 zlimit)); dr/dz is infinite at the tip and kept finite.
    [[nodiscard]] Generator generator(double v) const override {
        const double z = zmin_ + v * dz_;
        const double q = std::max(std::fabs(z / zlimit_), 1e-12);
        const double slope = rmax_ / (2 * zlimit_ * std::sqrt(q));
        return {{radius(z), 0, z},
                V3d(slope, 0, 1) * dz_,
                V3d(radius(z), 0, -rmax_ * rmax_ / (2 * zlimit_)) * sign(dz_)};
    }
    [[nodiscard]] V3d generator_difference(double v, double dv) const override {
        const double z0 = zmin_ + v * dz_, z1 = z0 + dv * dz_;
        const double sum = radius(z0) + radius(z1);
        const double dr = z0 * z1 > 0
                              ? rmax_ * rmax_ / zlimit_ * dv * dz_ / sum * sign(z0 / zlimit_)
                              : radius(z1) - radius(z0);
        return {dr, 0, dv * dz_};
    }
    [[nodiscard]] Roots roots(const V3d& o, const V3d& d) const override {
        const double k = rmax_ * rmax_ / zlimit_;
        return solve_quadratic(d.x * d.x + d.y * d.y, o.x * d.x + o.y * d.y - 0.5 * k * d.z,
                               o.x * o.x + o.y * o.y - k * o.z);
    }
    [[nodiscard]] bool locate(const V3d& P, double& u, double& v) const override {
        const double s = sign(rmax_);
        v = (P.z - zmin_) / dz_;
        return limit_v(v) && sweep_u(std::atan2(P.y * s, P.x * s), u);
    }
    [[nodiscard]] std::array<Ring, 2> hull() const override {
        const double r = std::max(std::fabs(radius(zmin_)), std::fabs(radius(zmin_ + dz_)));
        return {Ring{r, zmin_}, Ring{r, zmin_ + dz_}};
    }
};

class Disk final : public Revolution {
public:
    Disk(double height, double radius, double thetamax_deg)
        : Revolution(thetamax_deg), height_(height), radius_(radius) {}

private:
    double height_, radius_;

    [[nodiscard]] Generator generator(double v) const override {
        return {{radius_ * (1 - v), 0, height_}, {-radius_, 0, 0}, {0, 0, 1}};
    }
    [[nodiscard]] V3d generator_difference(double, double dv) const override {
        return {-radius_ * dv, 0, 0};
    }
    [[nodiscard]] Roots roots(const V3d& o, const V3d& d) const override {
        return solve_quadratic(0, 0.5 * d.z, o.z - height_);
    }
    [[nodiscard]] bool locate(const V3d& P, double& u, double& v) const override {
        const double s = sign(radius_);
        v = 1 - std::hypot(P.x, P.y) / std::fabs(radius_);
        return limit_v(v) && sweep_u(std::atan2(P.y * s, P.x * s), u);
    }
    [[nodiscard]] std::array<Ring, 2> hull() const override {
        return {Ring{radius_, height_}, Ring{radius_, height_}};
    }
};

class Torus final : public Revolution {
public:
    Torus(double major, double minor, double phimin_deg, double phimax_deg, double thetamax_deg)
        : Revolution(thetamax_deg),
          major_(major), arc_{minor, phimin_deg * radians,
                              std::clamp(phimax_deg - phimin_deg, -360.0, 360.0) * radians} {}

private:
    double major_;
    Arc arc_;

    // A point's signed distance from the axis along the generator's half plane; negative across the
    // axis (spindles).
    [[nodiscard]] double across(double rho, double z) const {
        const double near = std::hypot(rho - major_, z) - std::fabs(arc_.r);
        const double far = std::hypot(rho + major_, z) - std::fabs(arc_.r);
        return std::fabs(near) <= std::fabs(far) ? rho : -rho;
    }
    // The sign of the sweep's radius turns the normal over beyond the axis, as dPdu x dPdv does.
    [[nodiscard]] Generator generator(double v) const override {
        V3d p = arc_.offset(v);
        p.x += major_;
        return {p, arc_.derivative(v), arc_.normal(v) * sign(arc_.r) * (p.x < 0 ? -1.0 : 1.0)};
    }
    [[nodiscard]] V3d generator_difference(double v, double dv) const override {
        return arc_.difference(v, dv);
    }
    // (|p|^2 + R^2 - r^2)^2 = 4 R^2 (x^2 + y^2), with a unit direction; then polished on the
    // distance to the tube.
    [[nodiscard]] Roots roots(const V3d& o, const V3d& d_any) const override {
        const double len = base::length(d_any), R = major_, r = arc_.r;
        const V3d d = d_any / len;
        const double reach = std::fabs(R) + std::fabs(r);
        const double b = dot(o, d), g = dot(o, o) + R * R - r * r;
        const double span2 = reach * reach * (1 + 1e-9) - dot(o, o) + b * b;
        if (!(span2 > 0)) {
            return {};
        }
        const double k = 4 * R * R;
        const std::array<double, 5> c{g * g - k * (o.x * o.x + o.y * o.y),
                                      4 * b * g - 2 * k * (o.x * d.x + o.y * d.y),
                                      4 * b * b + 2 * g - k * (d.x * d.x + d.y * d.y), 4 * b, 1};
        Roots found;
        for (const double t : solve_quartic(c, -b - std::sqrt(span2), -b + std::sqrt(span2))) {
            found.add(polished(o, d, t) / len);
        }
        return found;
    }
    [[nodiscard]] double polished(const V3d& o, const V3d& d, double t) const {
        for (int i = 0; i < 2; ++i) {
            const V3d p = o + d * t;
            const double rho = std::hypot(p.x, p.y);
            const double ring = across(rho, p.z) < 0 ? rho + major_ : rho - major_;
            const double tube = std::hypot(ring, p.z);
            const double slope = (ring * (p.x * d.x + p.y * d.y) / rho + p.z * d.z) / tube;
            const double step = (tube - std::fabs(arc_.r)) / slope;
            if (!(std::fabs(step) <= 1e-6 * (std::fabs(major_) + std::fabs(arc_.r)))) {
                break; // grazing: Newton would leave
            }
            t -= step;
        }
        return t;
    }
    [[nodiscard]] bool locate(const V3d& P, double& u, double& v) const override {
        constexpr double turn = 2 * std::numbers::pi;
        const double rho = across(std::hypot(P.x, P.y), P.z), s = sign(rho), q = sign(arc_.r);
        const double ahead =
            (std::atan2(P.z * q, (rho - major_) * q) - arc_.phi0) * sign(arc_.dphi);
        const double angle = ahead - turn * std::floor(ahead / turn);
        v = angle / std::fabs(arc_.dphi);
        if (angle > turn * (1 - edge_slack) && v > 1) {
            v = 0;
        }
        return limit_v(v) && sweep_u(std::atan2(P.y * s, P.x * s), u);
    }
    [[nodiscard]] std::array<Ring, 2> hull() const override {
        const double reach = std::fabs(major_) + std::fabs(arc_.r);
        return {Ring{reach, -std::fabs(arc_.r)}, Ring{reach, std::fabs(arc_.r)}};
    }
};

// A paraboloid lies on one side of its tip: limits on the other side are cut off.
std::unique_ptr<Surface> make_paraboloid(double rmax, double zmin, double zmax, double thetamax_deg,
                                         std::string& why) {
    if (rmax == 0 || zmax == 0) {
        why = rmax == 0 ? "its radius is 0" : "zmax is 0";
        return nullptr;
    }
    const double low = zmin * zmax < 0 ? 0 : zmin;
    if (low == zmax) {
        why = "zmin and zmax are equal";
        return nullptr;
    }
    return std::make_unique<Paraboloid>(rmax, low, zmax, thetamax_deg);
}

std::unique_ptr<Surface> make_sphere(const std::array<double, 7>& a, std::string& why) {
    if (a[0] == 0) {
        why = "its radius is 0";
        return nullptr;
    }
    auto sphere = std::make_unique<Sphere>(a[0], a[1], a[2], a[3]);
    if (sphere->is_empty()) {
        why = "zmin and zmax leave nothing of it";
        return nullptr;
    }
    return sphere;
}

std::unique_ptr<Surface> make_hyperboloid(const std::array<double, 7>& a, std::string& why) {
    const V3d p1(a[0], a[1], a[2]), p2(a[3], a[4], a[5]);
    if (p1 == p2) {
        why = "its two points are equal";
    } else if (std::hypot(a[0], a[1]) == 0 && std::hypot(a[3], a[4]) == 0) {
        why = "it lies on its axis";
    } else {
        return std::make_unique<Hyperboloid>(p1, p2, a[6]);
    }
    return nullptr;
}

// The angle swept, for the one check all kinds share.
double thetamax_deg(const rib::Quadric& q) {
    switch (q.kind) {
    case rib::QuadricKind::Sphere:
    case rib::QuadricKind::Cylinder:
    case rib::QuadricKind::Paraboloid:
        return q.args[3];
    case rib::QuadricKind::Cone:
    case rib::QuadricKind::Disk:
        return q.args[2];
    case rib::QuadricKind::Torus:
        return q.args[4];
    case rib::QuadricKind::Hyperboloid:
        return q.args[6];
    }
    return 0;
}

const char* cone_fault(double height, double radius) {
    return radius == 0 ? "its radius is 0" : height == 0 ? "its height is 0" : nullptr;
}

const char* cylinder_fault(double radius, double zmin, double zmax) {
    return radius == 0 ? "its radius is 0" : zmin == zmax ? "zmin and zmax are equal" : nullptr;
}

const char* torus_fault(double minor, double phimin, double phimax) {
    return minor == 0         ? "its minor radius is 0"
           : phimin == phimax ? "phimin and phimax are equal"
                              : nullptr;
}

} // namespace

std::unique_ptr<Surface> make_quadric(const rib::Quadric& quadric, std::string& why) {
    const auto& a = quadric.args;
    constexpr double largest = 1e18; // squares and Embree's bounds stay finite
    if (!std::all_of(a.begin(), a.end(), [](double x) { return std::fabs(x) <= largest; })) {
        why = "an argument is not finite or above 1e18";
        return nullptr;
    }
    if (thetamax_deg(quadric) == 0) {
        why = "thetamax is 0";
        return nullptr;
    }
    const char* fault = nullptr;
    switch (quadric.kind) {
    case rib::QuadricKind::Sphere:
        return make_sphere(a, why);
    case rib::QuadricKind::Hyperboloid:
        return make_hyperboloid(a, why);
    case rib::QuadricKind::Paraboloid:
        return make_paraboloid(a[0], a[1], a[2], a[3], why);
    case rib::QuadricKind::Cone:
        if (!(fault = cone_fault(a[0], a[1]))) {
            return std::make_unique<Cone>(a[0], a[1], a[2]);
        }
        break;
    case rib::QuadricKind::Cylinder:
        if (!(fault = cylinder_fault(a[0], a[1], a[2]))) {
            return std::make_unique<Cylinder>(a[0], a[1], a[2], a[3]);
        }
        break;
    case rib::QuadricKind::Disk:
        if (a[1] != 0) {
            return std::make_unique<Disk>(a[0], a[1], a[2]);
        }
        fault = "its radius is 0";
        break;
    case rib::QuadricKind::Torus:
        if (!(fault = torus_fault(a[1], a[2], a[3]))) {
            return std::make_unique<Torus>(a[0], a[1], a[2], a[3], a[4]);
        }
        break;
    }
    why = fault;
    return nullptr;
}

const char* quadric_name(rib::QuadricKind kind) {
    switch (kind) {
    case rib::QuadricKind::Sphere:
        return "Sphere";
    case rib::QuadricKind::Cone:
        return "Cone";
    case rib::QuadricKind::Cylinder:
        return "Cylinder";
    case rib::QuadricKind::Hyperboloid:
        return "Hyperboloid";
    case rib::QuadricKind::Paraboloid:
        return "Paraboloid";
    case rib::QuadricKind::Disk:
        return "Disk";
    case rib::QuadricKind::Torus:
        return "Torus";
    }
    return "quadric";
}

} // namespace geo
