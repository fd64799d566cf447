// SPDX-License-Identifier: Apache-2.0
// Patch and PatchMesh case by case against the formulas of ri.md 10.3 and 11.3 to 11.5 as they
// stand: every basis, step and wrap mode; "P", "Pw", "Pz"; every class of primitive variable. The
// reference is written here, in powers and in double, and shares nothing with bezier.cpp.
#include "geometry/patch.h"
#include "geometry/primvar.h"
#include "geometry/test_scene.h"

#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace {

using namespace geo::test;
using geo::LocalPoint;
using rib::StorageClass;

struct NamedBasis {
    const char* name;
    std::array<double, 16> m; // rows: powers; columns: control points
    int natural_step;
};

constexpr NamedBasis bases[] = {
    {"bezier", {-1, 3, -3, 1, 3, -6, 3, 0, -3, 3, 0, 0, 1, 0, 0, 0}, 3},
    {"b-spline",
     {-1 / 6., 3 / 6., -3 / 6., 1 / 6., 3 / 6., -6 / 6., 3 / 6., 0, -3 / 6., 0, 3 / 6., 0, 1 / 6.,
      4 / 6., 1 / 6., 0},
     1},
    {"catmull-rom", {-.5, 1.5, -1.5, .5, 1, -2.5, 2, -.5, -.5, 0, .5, 0, 0, 1, 0, 0}, 1},
    {"hermite", {2, 1, -2, 1, -3, -2, 3, -1, 0, 1, 0, 0, 1, 0, 0, 0}, 2},
    {"power", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, 4},
    {"user", {.2, -1, .5, 1, 1, .3, -2, .7, 0, 2, -.1, 0, .5, .25, .125, .125}, 2},
};

struct Direction {
    const NamedBasis* basis; // null: bilinear
    int step, n;
    bool periodic;

    [[nodiscard]] int width() const { return basis ? 4 : 2; }
    [[nodiscard]] int patches() const {
        return basis ? (periodic ? n / step : (n - 4) / step + 1) : (periodic ? n : n - 1);
    }
    [[nodiscard]] int corners() const { return patches() + (periodic ? 0 : 1); }
    [[nodiscard]] int control(int patch, int i) const {
        return (patch * (basis ? step : 1) + i) % n;
    }
    [[nodiscard]] double weight(int i, double x) const {
        if (!basis) {
            return i == 0 ? 1 - x : x;
        }
        const auto m = [&](int row) { return basis->m[std::size_t(4 * row + i)]; };
        return m(0) * x * x * x + m(1) * x * x + m(2) * x + m(3);
    }
};

// One mesh and its data; values are small random numbers.
class Mesh {
public:
    Mesh(const Direction& u, const Direction& v, unsigned seed) : u_(u), v_(v), rng_(seed) {}

    std::vector<float> numbers(std::size_t count, float lo = -1, float hi = 1) {
        std::uniform_real_distribution<float> d(lo, hi);
        std::vector<float> out(count);
        std::generate(out.begin(), out.end(), [&] { return d(rng_); });
        return out;
    }
    [[nodiscard]] std::size_t points() const { return std::size_t(u_.n) * std::size_t(v_.n); }
    [[nodiscard]] rib::Patches shape() const {
        return {.bicubic = u_.basis != nullptr,
                .is_mesh = true,
                .nu = u_.n,
                .nv = v_.n,
                .uperiodic = u_.periodic,
                .vperiodic = v_.periodic};
    }
    [[nodiscard]] rib::Basis basis() const {
        rib::Basis b;
        if (u_.basis) {
            std::transform(u_.basis->m.begin(), u_.basis->m.end(), b.u.begin(),
                           [](double x) { return float(x); });
            std::transform(v_.basis->m.begin(), v_.basis->m.end(), b.v.begin(),
                           [](double x) { return float(x); });
            b.ustep = u_.step, b.vstep = v_.step;
        }
        return b;
    }
    // Sums one component of control data at a place of patch (a, b).
    [[nodiscard]] double sum(const std::vector<float>& data, int dim, int k, int a, int b, double s,
                             double t) const {
        double total = 0;
        for (int j = 0; j < v_.width(); ++j) {
            for (int i = 0; i < u_.width(); ++i) {
                const int at = v_.control(b, j) * u_.n + u_.control(a, i);
                total +=
                    u_.weight(i, s) * v_.weight(j, t) * double(data[std::size_t(at * dim + k)]);
            }
        }
        return total;
    }

    void check(const char* positions) {
        SCOPED_TRACE(positions);
        const std::string name = positions;
        const int dim = name == "Pw" ? 4 : name == "Pz" ? 1 : 3;
        std::vector<float> P = numbers(points() * std::size_t(dim));
        for (std::size_t i = 3; dim == 4 && i < P.size(); i += 4) {
            P[i] = 1 + 0.3f * P[i];
        }
        rib::ParamList params;
        const auto add = [&](const char* what, StorageClass c, std::size_t count, int width = 1) {
            params.params.push_back(
                param(what, c, width == 3 ? rib::ParamType::Point : rib::ParamType::Float,
                      numbers(count * std::size_t(width))));
            return params.params.size() - 1;
        };
        const auto nup = std::size_t(u_.patches()), nvp = std::size_t(v_.patches());
        params.params.push_back(param(positions, StorageClass::Vertex,
                                      dim == 4   ? rib::ParamType::HPoint
                                      : dim == 3 ? rib::ParamType::Point
                                                 : rib::ParamType::Float,
                                      P));
        const std::size_t uniform = add("a", StorageClass::Uniform, nup * nvp);
        const std::size_t varying =
            add("b", StorageClass::Varying, std::size_t(u_.corners() * v_.corners()), 3);
        const std::size_t vertex = add("c", StorageClass::Vertex, points(), 3);
        const std::size_t face = add("d", StorageClass::FaceVarying, 4 * nup * nvp);
        const std::size_t constant = add("e", StorageClass::Constant, 1);
        std::string why;
        const auto surface = geo::make_patches(shape(), basis(), params, why);
        if (dim == 4 && !surface) { // weights that a basis makes negative are refused with a reason
            EXPECT_FALSE(why.empty());
            return;
        }
        ASSERT_TRUE(surface) << why;
        for (const auto& p : params.params) {
            EXPECT_TRUE(geo::is_usable(p, *surface)) << p.name;
        }
        if (surface->num_parts() != nup * nvp) { // cut for the sake of weights: other parts
            EXPECT_EQ(dim, 4);
            return;
        }
        for (int b = 0; b < int(nvp); ++b) {
            for (int a = 0; a < int(nup); ++a) {
                for (const double s : {0.0, 0.35, 1.0}) {
                    for (const double t : {0.0, 0.8, 1.0}) {
                        check_place(*surface, P, dim, a, b, s, t);
                        const LocalPoint at{std::uint32_t(b * int(nup) + a), s, t};
                        check_variables(*surface, params, at,
                                        {uniform, varying, vertex, face, constant}, P, dim, a, b);
                    }
                }
            }
        }
    }

private:
    Direction u_, v_;
    std::mt19937 rng_;

    void check_place(const geo::Surface& surface, const std::vector<float>& P, int dim, int a,
                     int b, double s, double t) const {
        const LocalPoint at{std::uint32_t(b * u_.patches() + a), s, t};
        const auto got = surface.evaluate(at);
        const double u = (a + s) / u_.patches(), v = (b + t) / v_.patches();
        EXPECT_NEAR(got.u, u, 1e-15);
        EXPECT_NEAR(got.v, v, 1e-15);
        EXPECT_LT(length(got.P - position(P, dim, a, b, s, t)), bound);
        // Central differences of the reference, h^2 P''' / 6.
        const double h = 1e-5;
        const V3d du = (position(P, dim, a, b, s + h, t) - position(P, dim, a, b, s - h, t)) /
                       (2 * h) * u_.patches();
        const V3d dv = (position(P, dim, a, b, s, t + h) - position(P, dim, a, b, s, t - h)) /
                       (2 * h) * v_.patches();
        EXPECT_LT(length(got.dPdu - du), 1e-5 * (1 + length(du)));
        EXPECT_LT(length(got.dPdv - dv), 1e-5 * (1 + length(dv)));
        const V3d n = cross(got.dPdu, got.dPdv);
        if (length(n) > 1e-3 * length(got.dPdu) * length(got.dPdv)) {
            EXPECT_LT(length(got.Ng - normalize(n)), 1e-12);
        }
    }
    // Floats of the bases are exact to 6e-8; values are O(1) with up to 16 weights of up to 4.
    static constexpr double bound = 3e-6;

    [[nodiscard]] V3d position(const std::vector<float>& P, int dim, int a, int b, double s,
                               double t) const {
        if (dim == 1) {
            return {(a + s) / u_.patches(), (b + t) / v_.patches(), sum(P, 1, 0, a, b, s, t)};
        }
        const double w = dim == 4 ? sum(P, 4, 3, a, b, s, t) : 1;
        return V3d{sum(P, dim, 0, a, b, s, t), sum(P, dim, 1, a, b, s, t),
                   sum(P, dim, 2, a, b, s, t)} /
               w;
    }
    void check_variables(const geo::Surface& surface, const rib::ParamList& params,
                         const LocalPoint& at, const std::array<std::size_t, 5>& index,
                         const std::vector<float>& P, int dim, int a, int b) const {
        const double s = at.u, t = at.v;
        double got[3];
        const auto value = [&](std::size_t k) { return double(params.params[index[k]].floats[0]); };
        geo::interpolate(params.params[index[4]], surface, at, got);
        EXPECT_EQ(got[0], value(4));
        geo::interpolate(params.params[index[0]], surface, at, got);
        EXPECT_EQ(got[0], double(params.params[index[0]].floats[at.part]));
        const auto bilinear = [&](auto&& corner) {
            return (1 - t) * ((1 - s) * corner(0, 0) + s * corner(1, 0)) +
                   t * ((1 - s) * corner(0, 1) + s * corner(1, 1));
        };
        const auto& varying = params.params[index[1]].floats;
        geo::interpolate(params.params[index[1]], surface, at, got);
        for (int k = 0; k < 3; ++k) {
            EXPECT_NEAR(got[k], bilinear([&](int i, int j) {
                            const int c =
                                (b + j) % v_.corners() * u_.corners() + (a + i) % u_.corners();
                            return double(varying[std::size_t(3 * c + k)]);
                        }),
                        1e-13);
        }
        const auto& face = params.params[index[3]].floats;
        geo::interpolate(params.params[index[3]], surface, at, got);
        EXPECT_NEAR(got[0], bilinear([&](int i, int j) {
                        return double(face[4 * at.part + std::size_t(2 * j + i)]);
                    }),
                    1e-13);
        // Vertex class: as the position; rational ones by the weights of the position.
        const auto& vertex = params.params[index[2]].floats;
        geo::interpolate(params.params[index[2]], surface, at, got);
        std::vector<float> weighted = vertex;
        double w = 1;
        if (dim == 4) {
            for (std::size_t i = 0; i < weighted.size(); ++i) {
                weighted[i] *= P[i / 3 * 4 + 3];
            }
            w = sum(P, 4, 3, a, b, s, t);
        }
        for (int k = 0; k < 3; ++k) {
            EXPECT_NEAR(got[k], sum(weighted, 3, k, a, b, s, t) / w, bound);
        }
    }
};

TEST(Basis, EveryBasisStepAndWrapOfBicubicMeshes) {
    unsigned seed = 0;
    for (const NamedBasis& bu : bases) {
        for (const NamedBasis& bv : {bases[seed % 6], bu}) {
            for (int step = 1; step <= 4; ++step) {
                for (int wrap = 0; wrap < 4; ++wrap) {
                    const bool pu = wrap & 1, pv = wrap & 2;
                    const int vstep = bv.natural_step;
                    const Direction u{&bu, step,
                                      pu ? std::max(2 * step, 4) / step * step : 4 + step, pu};
                    const Direction v{&bv, vstep, pv ? 2 * std::max(vstep, 2) : 4 + 2 * vstep, pv};
                    SCOPED_TRACE(std::string(bu.name) + " " + bv.name + " step " +
                                 std::to_string(step) + " wrap " + std::to_string(wrap));
                    Mesh(u, v, ++seed).check("P");
                    Mesh(u, v, ++seed).check("Pw");
                    if (!pu && !pv) {
                        Mesh(u, v, ++seed).check("Pz");
                    }
                }
            }
        }
    }
}

TEST(Basis, BilinearMeshesOfEveryWrap) {
    unsigned seed = 1000;
    for (int wrap = 0; wrap < 4; ++wrap) {
        for (int n = 2; n <= 5; ++n) {
            const Direction u{nullptr, 1, n, bool(wrap & 1)}, v{nullptr, 1, 7 - n, bool(wrap & 2)};
            Mesh(u, v, ++seed).check("P");
            Mesh(u, v, ++seed).check("Pw");
            if (wrap == 0) {
                Mesh(u, v, ++seed).check("Pz");
            }
        }
    }
}

// Points that do not fill another step are unused, as in "tolerant: floor" of ri.md 11.5.
TEST(Basis, CountsThatDoNotFitTheStepUseTheFirstPoints) {
    Mesh({&bases[0], 3, 9, false}, {&bases[0], 3, 8, false}, 5).check("P");
    Mesh({&bases[1], 2, 7, true}, {&bases[3], 2, 5, true}, 6).check("P");
}

// Exporters cut a B-spline into separate 4 x 4 Patch requests, with a basis in decimals.
TEST(Basis, WindowsOfOneSplineShareTheirEdgesBitForBit) {
    std::array<float, 16> decimal{-.16667f, .5f, -.5f, .16667f, .5f,     -1,      .5f,     0,
                                  -.5f,     0,   .5f,  0,       .16667f, .66667f, .16667f, 0};
    std::mt19937 rng(3);
    std::uniform_real_distribution<float> d(-10, 10);
    std::vector<float> all(5 * 4 * 3);
    std::generate(all.begin(), all.end(), [&] { return d(rng); });
    const auto window = [&](int first) {
        std::vector<float> P;
        for (int j = 0; j < 4; ++j) {
            for (int i = first; i < first + 4; ++i) {
                P.insert(P.end(), all.begin() + 3 * (j * 5 + i), all.begin() + 3 * (j * 5 + i) + 3);
            }
        }
        rib::ParamList params;
        params.params.push_back(positions(P));
        std::string why;
        return geo::make_patches({.bicubic = true, .nu = 4, .nv = 4}, {decimal, decimal, 1, 1},
                                 params, why);
    };
    const auto left = window(0), right = window(1);
    for (const double t : {0.0, 0.3, 0.5, 1.0}) {
        EXPECT_EQ(left->evaluate({0, 1, t}).P, right->evaluate({0, 0, t}).P);
    }
}

} // namespace
