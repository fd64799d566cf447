// SPDX-License-Identifier: Apache-2.0
// Accuracy of the differences geometry hands to shaders: P, N, s, t and a varying colour at the
// auxiliary points, for every kind of surface, at positions 1 ... 1e6 from the eye and steps 1e-6
// ... 1e-1, inside, near poles, at seams and grazing, against the same difference of the defining
// formula in 80-bit floats. Out: JSON lines; without arguments one summary a surface, with --all
// one line per place, position and step.
#include "geometry/quadric_formula.h"
#include "geometry/test_scene.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <functional>
#include <random>

namespace {

using namespace geo::test;
using rib::QuadricKind;
using rib::StorageClass;

using Formula = std::function<V3l(Real u, Real v)>;

struct Subject {
    std::string name;
    rib::Primitive primitive;
    Formula formula;
    rib::Basis basis{};
    bool is_polygon = false;
    Real h = 1e-7L; // of the central differences that give normals
};

// --- the surfaces

rib::Basis bezier_basis() {
    const std::array<float, 16> m{-1, 3, -3, 1, 3, -6, 3, 0, -3, 3, 0, 0, 1, 0, 0, 0};
    return {.u = m, .v = m, .ustep = 3, .vstep = 3};
}

// Weights of the Bernstein polynomials of degree n - 1.
std::array<Real, 4> bernstein(int n, Real t) {
    const Real s = 1 - t;
    if (n == 2) {
        return {s, t, 0, 0};
    }
    return {s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t};
}

Formula patch_formula(int n, const std::vector<float>& P, int components) {
    return [n, P, components](Real u, Real v) {
        const auto bu = bernstein(n, u), bv = bernstein(n, v);
        Real sum[4] = {};
        for (int j = 0; j < n; ++j) {
            for (int i = 0; i < n; ++i) {
                for (int k = 0; k < components; ++k) {
                    sum[k] += bu[std::size_t(i)] * bv[std::size_t(j)] *
                              P[std::size_t((j * n + i) * components + k)];
                }
            }
        }
        const Real w = components == 4 ? sum[3] : 1;
        return V3l(sum[0] / w, sum[1] / w, sum[2] / w);
    };
}

// A wavy net of n * n control points about `centre`; with weights if rational.
std::vector<float> net(int n, float centre, bool rational) {
    std::mt19937 rng(5);
    std::uniform_real_distribution<float> jitter(-0.3f, 0.3f);
    std::vector<float> P;
    for (int j = 0; j < n; ++j) {
        for (int i = 0; i < n; ++i) {
            const float w = rational ? 1 + jitter(rng) : 1;
            const float x = 2 * float(i) / float(n - 1) - 1, y = 2 * float(j) / float(n - 1) - 1;
            P.insert(P.end(), {(centre + x) * w, y * w, jitter(rng) * w});
            if (rational) {
                P.push_back(w);
            }
        }
    }
    return P;
}

Subject patch(const char* name, int n, float centre) {
    Subject s;
    s.name = name;
    const std::vector<float> P = net(n, centre, false);
    s.primitive.shape = rib::Patches{.bicubic = n == 4, .nu = n, .nv = n};
    s.primitive.params.params.push_back(positions(P));
    s.formula = patch_formula(n, P, 3);
    s.h = 1e-5L; // positions of 1e4 are rounded at 1e-15
    s.basis = bezier_basis();
    return s;
}

Subject nurbs() {
    Subject s;
    s.name = "rational patch";
    const std::vector<float> P = net(4, 0, true), knots{0, 0, 0, 0, 1, 1, 1, 1};
    s.primitive.shape =
        rib::NuPatch{.nu = 4, .uorder = 4, .nv = 4, .vorder = 4, .uknot = knots, .vknot = knots};
    s.primitive.params.params.push_back(
        param("Pw", StorageClass::Vertex, rib::ParamType::HPoint, P));
    s.formula = patch_formula(4, P, 4);
    return s;
}

// u and v are object x and y: the formula is the plane's equation.
Subject polygon() {
    Subject s;
    s.name = "polygon";
    s.is_polygon = true;
    s.primitive = SceneBuilder::polygons({1}, {4}, {0, 1, 2, 3},
                                         {-1, -1, -1.5f, 1, -1, 0.5f, 1, 1, 1.5f, -1, 1, -0.5f});
    s.formula = [](Real u, Real v) { return V3l(u, v, u + v / 2); };
    return s;
}

std::vector<Subject> subjects() {
    using K = QuadricKind;
    const std::pair<const char*, rib::Quadric> quadrics[] = {
        {"sphere", {K::Sphere, {1, -1, 1, 360}}},
        {"cone", {K::Cone, {2, 1, 360}}},
        {"cylinder", {K::Cylinder, {1, -1, 1, 360}}},
        {"hyperboloid", {K::Hyperboloid, {1, 0, -1, 0.3, 1, 1, 360}}},
        {"paraboloid", {K::Paraboloid, {1, 0, 1.5, 360}}},
        {"disk", {K::Disk, {0, 1, 360}}},
        {"torus", {K::Torus, {1, 0.4, 0, 360, 360}}}};
    std::vector<Subject> all;
    for (const auto& [name, q] : quadrics) {
        Subject s;
        s.name = name;
        s.primitive = SceneBuilder::quadric(q.kind, q.args);
        s.formula = [quadric = q](Real u, Real v) { return formula(quadric, u, v); };
        all.push_back(std::move(s));
    }
    all.push_back(polygon());
    all.push_back(patch("bilinear patch", 2, 0));
    all.push_back(patch("bicubic patch", 4, 0));
    all.push_back(nurbs());
    all.push_back(patch("bicubic patch, object at 1e4", 4, 1e4f));
    return all;
}

// --- places on them

struct Place {
    const char* name;
    double u0, u1, v0, v1; // where samples lie
    bool grazing = false;
};
constexpr Place places[] = {{"inside", 0.05, 0.9, 0.1, 0.9},
                            {"near v = 0", 0.05, 0.9, 1e-6, 1e-4},
                            {"near v = 1", 0.05, 0.9, 1 - 1e-4, 1 - 1e-6},
                            {"seam", 0.99999, 1, 0.1, 0.9},
                            {"grazing", 0.05, 0.9, 0.1, 0.9, true}};

const std::vector<float> corner_colors{0.1f, 0.9f, 0.5f, 0.8f, 0.2f, 0.4f,
                                       0.3f, 0.6f, 0.7f, 0.9f, 0.1f, 0.2f};
constexpr std::array<float, 8> texture_coordinates{0.1f, 0.2f, 3, 0.5f, -1, 2, 7, 9};

// The bilinear value of four corners of `width` numbers.
Real bilinear(const float* c, std::size_t width, std::size_t k, Real u, Real v) {
    return (1 - u) * (1 - v) * c[k] + u * (1 - v) * c[width + k] + (1 - u) * v * c[2 * width + k] +
           u * v * c[3 * width + k];
}

V3l through(const Mat4& m, const V3l& v) {
    V3l r;
    for (int k = 0; k < 3; ++k) {
        r[k] = v.x * m.m[0][k] + v.y * m.m[1][k] + v.z * m.m[2][k];
    }
    return r;
}

V3l unit_normal(const Formula& f, Real h, Real u, Real v) {
    const V3l n = cross(f(u + h, v) - f(u - h, v), f(u, v + h) - f(u, v - h));
    return n / length(n);
}

// --- measuring

struct Errors {
    double P = 0, N = 0, st = 0, Cs = 0;
    bool finite = true;
    void worst_of(const Errors& e) {
        P = std::max(P, e.P), N = std::max(N, e.N), st = std::max(st, e.st),
        Cs = std::max(Cs, e.Cs);
        finite = finite && e.finite;
    }
};

class Study {
public:
    Study(const Subject& subject, double position)
        : subject_(subject),
          place_(Mat4::translate(V3d(0.3, -0.2, 1) * position) * Mat4::rotate(37, {1, 2, -1}) *
                 Mat4::scale(V3d(1.5, 1.5, 1.5))) {
        SceneBuilder b;
        b.attributes().texture_coordinates = texture_coordinates;
        b.attributes().basis = subject.basis;
        rib::Primitive p = subject.primitive;
        p.params.params.push_back(
            param("Cs", StorageClass::Varying, rib::ParamType::Color, corner_colors));
        b.add(std::move(p), place_);
        scene_ = std::move(b);
        world_ = scene_.world(quiet_.diag);
    }

    // Largest errors over samples of a place at about one step: rays against the normal, or 0.01
    // radians off dPdu; footprints that make du about that long.
    Errors measure(const Place& place, double step) {
        std::mt19937 rng(11);
        std::uniform_real_distribution<double> in(0, 1);
        std::vector<geo::Hit> hits(40);
        for (geo::Hit& hit : hits) {
            hit.shape = 0;
            hit.u = float(place.u0 + (place.u1 - place.u0) * in(rng));
            hit.v = float(place.v0 + (place.v1 - place.v0) * in(rng));
            if (subject_.is_polygon) { // barycentric
                hit.u *= 0.5f, hit.v *= 0.5f;
            }
        }
        const Filled first(*world_, hits, std::vector<Ray>(hits.size(), Ray{{0, 0, 0}, {0, 0, 1}}));
        std::vector<Ray> rays;
        double speed = 0;
        for (std::size_t i = 0; i < hits.size(); ++i) {
            const V3d dPdu = first.vec(SL_VAR_dPdu, i), N = first.vec(SL_VAR_N, i);
            const V3d d = place.grazing ? normalize(dPdu) + N * -0.01 : N * -1.0;
            rays.push_back({{0, 0, 0}, V3f(d)});
            speed = std::max(speed, base::length(dPdu));
        }
        const Filled f(*world_, hits, rays, float(step * std::max(speed, 0.1)));
        Errors worst;
        for (std::size_t i = 0; i < hits.size(); ++i) {
            for (const int which : {1, 2}) {
                worst.worst_of(compare(f, i, which));
            }
        }
        return worst;
    }

private:
    const Subject& subject_;
    Mat4 place_;
    SceneBuilder scene_;
    QuietDiag quiet_;
    std::unique_ptr<geo::World> world_;

    Errors compare(const Filled& f, std::size_t i, int which) const {
        const Real u = f.at(SL_VAR_u, i), v = f.at(SL_VAR_v, i);
        const Real du = which == 1 ? f.at(SL_VAR_du, i) : 0,
                   dv = which == 2 ? f.at(SL_VAR_dv, i) : 0;
        Errors e;
        const V3l dP = through(place_, subject_.formula(u + du, v + dv) - subject_.formula(u, v));
        e.P = relative(f.vec(SL_VAR_P, i, which), dP);
        if (!subject_.is_polygon) {
            // Beyond a pole the formula's normal turns over; the surface's goes on.
            const bool ends = v + dv < 2e-7L || v + dv > 1 - 2e-7L;
            const V3l n0 = unit_normal(subject_.formula, subject_.h, u, v),
                      n1 = unit_normal(subject_.formula, subject_.h, u + du, v + dv);
            e.N = ends ? 0
                       : normal_error(f, i, which, through(place_, n1 - n0) / 1.5L,
                                      through(place_, n0));
            e.st =
                flat_error(f, i, which, SL_VAR_s, texture_coordinates.data(), 2, 0, u, v, du, dv) +
                flat_error(f, i, which, SL_VAR_t, texture_coordinates.data(), 2, 1, u, v, du, dv);
            for (int k = 0; k < 3; ++k) {
                const Real want = change(corner_colors.data(), 3, std::size_t(k), u, v, du, dv);
                e.Cs = std::max(e.Cs, error(f.at(SL_VAR_Cs, i, k, which), want));
            }
        }
        for (const sl_variable id : {SL_VAR_P, SL_VAR_N, SL_VAR_dPdu, SL_VAR_dPdv, SL_VAR_I}) {
            const V3d d = f.vec(id, i, which);
            e.finite = e.finite && std::isfinite(d.x) && std::isfinite(d.y) && std::isfinite(d.z);
        }
        return e;
    }

    static Real change(const float* c, std::size_t width, std::size_t k, Real u, Real v, Real du,
                       Real dv) {
        return bilinear(c, width, k, u + du, v + dv) - bilinear(c, width, k, u, v);
    }
    static double error(float got, Real want) {
        return want == 0 ? 0 : double(std::abs(Real(got) - want) / std::abs(want));
    }
    static double flat_error(const Filled& f, std::size_t i, int which, sl_variable id,
                             const float* c, std::size_t width, std::size_t k, Real u, Real v,
                             Real du, Real dv) {
        return error(f.at(id, i, 0, which), change(c, width, k, u, v, du, dv));
    }
    // Where nothing should move (P along a pole's u) the distance counts.
    static double relative(const V3d& got, const V3l& want) {
        const Real size = length(want);
        const double off = double(length(V3l(got) - want));
        return size > 1e-12L ? off / double(size) : off;
    }
    // Flat places do not turn: differences below 1e-9 are compared as they are.
    static double normal_error(const Filled& f, std::size_t i, int which, const V3l& change,
                               const V3l& normal) {
        const V3d main = f.vec(SL_VAR_N, i);
        const Real side = dot(normal, V3l(main)) < 0 ? -1 : 1;
        const Real size = length(change);
        const double off = double(length(V3l(f.vec(SL_VAR_N, i, which)) - change * side));
        return size > 1e-9L ? off / double(size) : off;
    }
};

constexpr double positions_cam[] = {1, 10, 100, 1e3, 1e4, 1e5, 1e6};
constexpr double steps[] = {1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1};

void print_all(const Subject& s) {
    for (const double position : positions_cam) {
        Study study(s, position);
        for (const Place& place : places) {
            for (const double step : steps) {
                const Errors e = study.measure(place, step);
                std::printf(
                    "{\"surface\": \"%s\", \"place\": \"%s\", \"position\": %g, \"step\": %g, "
                    "\"P\": %.3g, \"N\": %.3g, \"st\": %.3g, \"Cs\": %.3g, \"finite\": %s}\n",
                    s.name.c_str(), place.name, position, step, e.P, e.N, e.st, e.Cs,
                    e.finite ? "true" : "false");
            }
        }
    }
}

void print_summary(const Subject& s) {
    Errors worst;
    for (const double position : positions_cam) {
        Study study(s, position);
        for (const Place& place : places) {
            for (const double step : steps) {
                worst.worst_of(study.measure(place, step));
            }
        }
    }
    std::printf(
        "{\"name\": \"difference of P, %s\", \"value\": %.3g, \"unit\": \"relative error\", "
        "\"limit\": 0.001, \"better\": \"lower\", \"error\": \"worst point\", \"note\": \"N "
        "%.2g, s and t %.2g, varying colour %.2g; 5 places, 7 positions, 6 steps%s\"}\n",
        s.name.c_str(), worst.P, worst.N, worst.st, worst.Cs, worst.finite ? "" : "; NOT FINITE");
}

} // namespace

int main(int argc, char** argv) {
    const bool all = argc > 1 && std::strcmp(argv[1], "--all") == 0;
    for (const Subject& s : subjects()) {
        all ? print_all(s) : print_summary(s);
    }
    return 0;
}
