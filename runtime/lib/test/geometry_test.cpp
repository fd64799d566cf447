// SPDX-License-Identifier: Apache-2.0
// Geometric functions, matrices, transforms and colour spaces against double precision, and their
// rules for special directions (facing, total reflection, zero vectors). reference/sl.md 4.3, 4.4.
#include "runtime/base/mat.h"
#include "runtime/lib/test/fixture.h"
#include "runtime/lib/test_services.h"

#include <array>
#include <cmath>
#include <gtest/gtest.h>

namespace lanes_test {
namespace {

const Covers covers{"xcomp",         "ycomp",
                    "zcomp",         "setxcomp",
                    "setycomp",      "setzcomp",
                    "length",        "distance",
                    "normalize",     "ptlined",
                    "rotate_3",      "rotate_m",
                    "reflect",       "refract",
                    "fresnel",       "fresnel_rt",
                    "faceforward",   "faceforward_ref",
                    "transform_to",  "transform_from_to",
                    "transform_m",   "transform_from_m",
                    "vtransform_to", "vtransform_from_to",
                    "vtransform_m",  "vtransform_from_m",
                    "ntransform_to", "ntransform_from_to",
                    "ntransform_m",  "ntransform_from_m",
                    "mtransform_to", "mtransform_from_to",
                    "depth",         "determinant",
                    "translate_m",   "scale_m",
                    "comp_m",        "setcomp_m",
                    "comp_3",        "setcomp_3",
                    "ctransform_to", "ctransform_from_to"};

using base::V3d;
constexpr double pi = 3.14159265358979323846;
constexpr std::size_t n = 500;

V3d triple(const Planes& p, std::size_t k, std::size_t i) {
    return {p[k][i], p[k + 1][i], p[k + 2][i]};
}

void expect_near(const V3d& got, const V3d& want, double tolerance, const std::string& what) {
    EXPECT_NEAR(got.x, want.x, tolerance) << what;
    EXPECT_NEAR(got.y, want.y, tolerance) << what;
    EXPECT_NEAR(got.z, want.z, tolerance) << what;
}

Planes scattered(std::size_t planes, double low, double high, std::size_t count = n, int seed = 0) {
    Planes p;
    for (std::size_t k = 0; k < planes; k++)
        p.push_back(scatter(low, high, count, seed + static_cast<int>(k)));
    return p;
}

// Planes with unit vectors in planes first .. first+2.
void normalise(Planes& p, std::size_t first) {
    for (std::size_t i = 0; i < p[0].size(); i++) {
        const V3d v = base::normalize(triple(p, first, i));
        for (int k = 0; k < 3; k++)
            p[first + static_cast<std::size_t>(k)][i] = static_cast<float>(v[k]);
    }
}

TEST(Geometry, LengthsAndComponents) {
    const Planes in = scattered(6, -3, 3);
    const Planes a(in.begin(), in.begin() + 3);
    const auto length = run_all("length", a, n), distance = run_all("distance", in, n),
               unit = run_all("normalize", a, n);
    for (std::size_t i = 0; i < n; i++) {
        const V3d p = triple(in, 0, i), q = triple(in, 3, i);
        EXPECT_LE(ulps(length[0][i], base::length(p)), 2);
        EXPECT_NEAR(distance[0][i], base::length(p - q),
                    1e-6); // the difference of values up to 3 is rounded
        expect_near(triple(unit, 0, i), base::normalize(p), 2.5e-7, "normalize");
    }
    EXPECT_EQ(run_all("xcomp", a, n)[0], a[0]);
    EXPECT_EQ(run_all("ycomp", a, n)[0], a[1]);
    EXPECT_EQ(run_all("zcomp", a, n)[0], a[2]);
    const Planes four(in.begin(), in.begin() + 4);
    EXPECT_EQ(run_all("setxcomp", four, n), (Planes{in[3], in[1], in[2]}));
    EXPECT_EQ(run_all("setycomp", four, n), (Planes{in[0], in[3], in[2]}));
    EXPECT_EQ(run_all("setzcomp", four, n), (Planes{in[0], in[1], in[3]}));
}

TEST(Geometry, NormalizeKeepsZeroAndReachesTheEndsOfTheRange) {
    const Planes in = {{0, 1e-30f, 3e30f, 0, -2e-38f}, {0, 0, 4e30f, -5, 0}, {0, 0, 0, 0, 0}};
    const Planes got = run_all("normalize", in, 5);
    EXPECT_EQ(triple(got, 0, 0), V3d(0, 0, 0));
    EXPECT_EQ(triple(got, 0, 1), V3d(1, 0, 0));
    expect_near(triple(got, 0, 2), {0.6, 0.8, 0}, 1e-7, "huge");
    EXPECT_EQ(triple(got, 0, 3), V3d(0, -1, 0));
    expect_near(triple(got, 0, 4), {-1, 0, 0}, 1e-7, "tiny");
}

TEST(Geometry, PointToSegment) {
    Planes in = scattered(9, -2, 2);
    for (int k = 0; k < 3; k++) // some segments are points
        in[static_cast<std::size_t>(k) + 3][7] = in[static_cast<std::size_t>(k)][7];
    const Planes got = run_all("ptlined", in, n);
    for (std::size_t i = 0; i < n; i++) {
        const V3d a = triple(in, 0, i), d = triple(in, 3, i) - a, e = triple(in, 6, i) - a;
        const double dd = base::dot(d, d);
        const double t = dd > 0 ? std::fmin(1, std::fmax(0, base::dot(e, d) / dd)) : 0;
        EXPECT_NEAR(got[0][i], base::length(e - d * t), 2e-6);
    }
}

TEST(Geometry, Rotation) {
    const Planes in = scattered(10, -2, 2);
    const Planes got = run_all("rotate_3", in, n);
    for (std::size_t i = 0; i < n; i++) {
        const V3d p0 = triple(in, 4, i), a = base::normalize(triple(in, 7, i) - p0),
                  d = triple(in, 0, i) - p0;
        const double c = std::cos(static_cast<double>(in[3][i])),
                     s = std::sin(static_cast<double>(in[3][i]));
        expect_near(triple(got, 0, i),
                    p0 + d * c + base::cross(a, d) * s + a * (base::dot(a, d) * (1 - c)), 3e-6,
                    "rotate");
    }
    // a quarter turn about z takes x to y
    const Planes quarter = run_all(
        "rotate_3", {{1}, {0}, {0}, {static_cast<float>(pi / 2)}, {0}, {0}, {0}, {0}, {0}, {1}}, 1);
    expect_near(triple(quarter, 0, 0), {0, 1, 0}, 1e-7, "quarter turn");
}

TEST(Geometry, ReflectAndRefract) {
    Planes in = scattered(7, -1, 1);
    normalise(in, 0);
    normalise(in, 3);
    for (std::size_t i = 0; i < n; i++) { // N against I
        const bool behind = base::dot(triple(in, 0, i), triple(in, 3, i)) > 0;
        for (std::size_t k = 3; k < 6 && behind; k++)
            in[k][i] = -in[k][i];
        in[6][i] = i % 2 ? 1 / 1.5f : 1.5f;
    }
    const Planes six(in.begin(), in.begin() + 6);
    const Planes reflected = run_all("reflect", six, n), refracted = run_all("refract", in, n);
    const Planes both = run_all("fresnel_rt", in, n), pair = run_all("fresnel", in, n);
    int total = 0;
    for (std::size_t i = 0; i < n; i++) {
        const V3d d = triple(in, 0, i), normal = triple(in, 3, i);
        const double eta = in[6][i], cosine = base::dot(d, normal);
        expect_near(triple(reflected, 0, i), d - normal * (2 * cosine), 1e-6, "reflect");
        expect_near(triple(both, 2, i), d - normal * (2 * cosine), 1e-6, "fresnel R");
        const double k = 1 - eta * eta * (1 - cosine * cosine);
        const double c = std::abs(cosine), g2 = 1 / (eta * eta) - 1 + c * c;
        if (std::abs(k) < 1e-5)
            continue; // at the critical angle rounding decides
        const V3d t = k < 0 ? V3d(0, 0, 0) : d * eta - normal * (eta * cosine + std::sqrt(k));
        expect_near(triple(refracted, 0, i), t, 3e-4 / std::sqrt(std::abs(k)) * 0.01 + 1e-6,
                    "refract");
        total += k < 0;
        const double g = g2 < 0 ? 0 : std::sqrt(g2);
        const double b = (c * (g + c) - 1) / (c * (g - c) + 1);
        const double kr = g2 < 0 ? 1 : 0.5 * (g - c) * (g - c) / ((g + c) * (g + c)) * (1 + b * b);
        EXPECT_NEAR(pair[0][i], kr,
                    3e-6 / std::fmax(0.05, g)); // dKr/dg grows towards the critical angle
        EXPECT_EQ(pair[1][i], 1.0f - pair[0][i]);
        EXPECT_EQ(both[0][i], pair[0][i]);
        EXPECT_EQ(both[1][i], pair[1][i]);
        if (k < 0) {
            EXPECT_EQ(pair[0][i], 1);
            EXPECT_EQ(triple(both, 5, i), V3d(0, 0, 0));
        }
    }
    EXPECT_GT(total, 10);
}

TEST(Geometry, FresnelAtItsLimits) {
    // normal incidence 1 -> 1.5: 0.04; grazing: 1; equal media: 0; total reflection: 1
    const Planes in = {{0, 1, 0, 0.8f}, {0, 0, 0, 0}, {-1, 0, -1, -0.6f},           {0, 0, 0, 0},
                       {0, 0, 0, 0},    {1, 1, 1, 1}, {1 / 1.5f, 1 / 1.5f, 1, 1.5f}};
    const Planes got = run_all("fresnel", in, 4);
    EXPECT_NEAR(got[0][0], 0.04, 1e-7);
    EXPECT_EQ(got[0][1], 1);
    EXPECT_EQ(got[0][2], 0);
    EXPECT_EQ(got[0][3], 1);
    for (int k = 0; k < 4; k++)
        EXPECT_EQ(got[1][static_cast<std::size_t>(k)], 1 - got[0][static_cast<std::size_t>(k)]);
    const Planes near = run_all("fresnel", {{1}, {0}, {-0.001f}, {0}, {0}, {1}, {1 / 1.5f}}, 1);
    EXPECT_GT(near[0][0], 0.99);
}

V3d facing(const V3d& normal, const V3d& i, const V3d& ref) {
    const double s = (base::dot(i, ref) <= 0 ? 1 : -1) * (base::dot(normal, ref) >= 0 ? 1 : -1);
    return normal * s;
}

TEST(Geometry, FaceForward) {
    Planes in = scattered(9, -1, 1);
    for (std::size_t k = 0; k < 9; k++) // exact zeros among them: never a zero result
        in[k][3] = k == 1 ? 1.0f : 0.0f;
    const Planes got = run_all("faceforward_ref", in, n);
    for (std::size_t i = 0; i < n; i++)
        EXPECT_EQ(triple(got, 0, i), facing(triple(in, 0, i), triple(in, 3, i), triple(in, 6, i)))
            << i;

    rt::TestEngine engine(8);
    rt::TestBatch batch(n, engine), without(n, engine);
    for (std::uint32_t i = 0; i < n; i++)
        batch.set_triple(SL_VAR_Ng, i, {in[6][i], in[7][i], in[8][i]});
    const Planes six(in.begin(), in.begin() + 6);
    EXPECT_EQ(run_all("faceforward", six, n, &batch.batch()), got); // reads Ng
    const Planes alone = run_all("faceforward", six, n, &without.batch());
    for (std::size_t i = 0; i < n; i++) // no Ng: N is its own reference
        EXPECT_EQ(triple(alone, 0, i),
                  facing(triple(in, 0, i), triple(in, 3, i), triple(in, 0, i)));
}

// --- matrices

base::Mat4 matrix(const Planes& p, std::size_t first, std::size_t i) {
    base::Mat4 m;
    for (std::size_t k = 0; k < 16; k++)
        m.m[k / 4][k % 4] = p[first + k][i];
    return m;
}

void expect_near(const base::Mat4& got, const base::Mat4& want, double tolerance,
                 const std::string& what) {
    for (int r = 0; r < 4; r++)
        for (int c = 0; c < 4; c++)
            EXPECT_NEAR(got.m[r][c], want.m[r][c], tolerance) << what << " " << r << " " << c;
}

// Well-conditioned matrices: random in [-1,1] plus 3 on the diagonal.
Planes matrices(std::size_t count, std::size_t extra, int seed) {
    Planes p = scattered(16 * count + extra, -1, 1, n, seed);
    for (std::size_t k = 0; k < 16 * count; k++)
        if (k % 16 % 5 == 0)
            for (float& v : p[k])
                v += 3;
    return p;
}

TEST(Matrices, ProductInverseDeterminant) {
    const Planes two = matrices(2, 0, 3);
    const Planes one(two.begin(), two.begin() + 16);
    const Planes product = run_all("mul_m", two, n), quotient = run_all("div_m", two, n);
    const Planes inverse = run_all("inverse_m", one, n), det = run_all("determinant", one, n);
    for (std::size_t i = 0; i < n; i++) {
        const base::Mat4 a = matrix(two, 0, i), b = matrix(two, 16, i);
        // row vectors: p (A B) = (p A) B, so A B is base's b * a
        expect_near(matrix(product, 0, i), b * a, 5e-6, "product");
        expect_near(matrix(quotient, 0, i), *base::inverse(b) * a, 2e-5, "quotient");
        expect_near(matrix(inverse, 0, i), *base::inverse(a), 5e-6, "inverse");
        EXPECT_NEAR(det[0][i], base::determinant(a), 2e-6 * std::abs(base::determinant(a)) + 1e-5);
    }
    Planes singular(16, std::vector<float>(1, 1.0f));
    expect_near(matrix(run_all("inverse_m", singular, 1), 0, 0), base::Mat4{}, 0,
                "singular: identity");
}

TEST(Matrices, SimpleTransformsApplyFirst) {
    const Planes in = matrices(1, 3, 5), turn = matrices(1, 4, 9);
    const Planes moved = run_all("translate_m", in, n), scaled = run_all("scale_m", in, n),
                 turned = run_all("rotate_m", turn, n);
    for (std::size_t i = 0; i < n; i++) {
        const V3d d = triple(in, 16, i);
        expect_near(matrix(moved, 0, i), matrix(in, 0, i) * base::Mat4::translate(d), 3e-6,
                    "translate");
        expect_near(matrix(scaled, 0, i), matrix(in, 0, i) * base::Mat4::scale(d), 3e-6, "scale");
        const base::Mat4 r = base::Mat4::rotate(turn[16][i] * 180 / pi, triple(turn, 17, i));
        expect_near(matrix(turned, 0, i), matrix(turn, 0, i) * r, 5e-6, "rotate");
    }
}

TEST(Matrices, Components) {
    Planes in = matrices(1, 3, 2);
    in[16] = scatter(-1, 5, n, 1); // rows and columns outside are clamped, fractions cut
    in[17] = scatter(-1, 5, n, 2);
    in[16][0] = std::nanf("");
    const Planes read = run_all("comp_m", Planes(in.begin(), in.begin() + 18), n),
                 written = run_all("setcomp_m", in, n);
    for (std::size_t i = 0; i < n; i++) {
        const auto index = [](float x) {
            return std::isnan(x) || x < 0 ? 0 : x > 3 ? 3 : static_cast<int>(x);
        };
        const auto at = static_cast<std::size_t>(4 * index(in[16][i]) + index(in[17][i]));
        EXPECT_EQ(read[0][i], in[at][i]);
        for (std::size_t k = 0; k < 16; k++)
            EXPECT_EQ(written[k][i], k == at ? in[18][i] : in[k][i]);
    }
    const Planes color = {{5, 5, 5, 5}, {6, 6, 6, 6}, {7, 7, 7, 7}, {-1, 1.9f, 2, 9}};
    EXPECT_EQ(run_all("comp_3", color, 4)[0], (std::vector<float>{5, 6, 7, 7}));
    Planes set = color;
    set.push_back({1, 1, 1, 1});
    EXPECT_EQ(run_all("setcomp_3", set, 4), (Planes{{1, 5, 5, 5}, {6, 1, 6, 6}, {7, 7, 1, 1}}));
}

// --- transforms

const rt::TestEngine::Matrix to_shader = {2, 0.5f, 0,    0, -0.25f, 1,  0.75f, 0,
                                          0, 0.3f, 1.5f, 0, 1,      -2, 3,     1};
// perspective: w = z + 4
const rt::TestEngine::Matrix projection = {1, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1, 1, 0, 0, 0.5f, 4};

base::Mat4 of(const rt::TestEngine::Matrix& m) {
    return base::Mat4::from_rows(m.data());
}

rt::TestEngine::Matrix moving(std::uint32_t i) {
    rt::TestEngine::Matrix m = to_shader;
    m[12] += 0.25f * static_cast<float>(i % 16);
    m[0] += 0.125f * static_cast<float>(i % 3);
    return m;
}

class Transforms : public testing::Test {
protected:
    Transforms() : engine(8), batch(n, engine) {
        engine.spaces[{"current", "shader"}] = to_shader;
        engine.spaces[{"shader", "current"}] = projection;
        engine.moving_spaces[{"current", "moving"}] = moving;
    }
    Planes run_spaces(const char* name, const Planes& in) {
        return run_all(name, in, n, &batch.batch(),
                       [this](const Width& w) { engine.set_lanes(w.api->lanes); });
    }
    rt::TestEngine engine;
    rt::TestBatch batch;
};

// Inverse transpose of the upper 3x3 part, which alone decides about vectors and normals.
V3d normal(base::Mat4 m, const V3d& v) {
    for (int k = 0; k < 4; k++)
        m.m[k][3] = m.m[3][k] = k == 3;
    return base::normal_by_inverse(*base::inverse(m), v);
}

TEST_F(Transforms, NamedSpaces) {
    const Planes in = scattered(3, -2, 2);
    const Planes p = run_spaces("transform_to", in), v = run_spaces("vtransform_to", in),
                 m = run_spaces("ntransform_to", in);
    const Planes p2 = run_spaces("transform_from_to", in),
                 v2 = run_spaces("vtransform_from_to", in),
                 m2 = run_spaces("ntransform_from_to", in);
    for (std::size_t i = 0; i < n; i++) {
        const V3d a = triple(in, 0, i);
        expect_near(triple(p, 0, i), base::point(of(to_shader), a), 3e-6, "transform");
        expect_near(triple(v, 0, i), base::vector(of(to_shader), a), 3e-6, "vtransform");
        expect_near(triple(m, 0, i), normal(of(to_shader), a), 3e-6, "ntransform");
        expect_near(triple(p2, 0, i), base::point(of(projection), a), 3e-6, "divided by w");
        expect_near(triple(v2, 0, i), base::vector(of(projection), a), 3e-6, "vtransform");
        expect_near(triple(m2, 0, i), normal(of(projection), a), 3e-6, "ntransform");
    }
    EXPECT_TRUE(engine.reports.empty());
}

TEST_F(Transforms, MatrixPerLane) {
    const Planes in = scattered(3, -2, 2);
    const Planes p = run_spaces("transform_lanes", in), v = run_spaces("vtransform_lanes", in),
                 m = run_spaces("ntransform_lanes", in);
    for (std::size_t i = 0; i < n; i++) {
        const V3d a = triple(in, 0, i);
        const base::Mat4 here = of(moving(static_cast<std::uint32_t>(i)));
        expect_near(triple(p, 0, i), base::point(here, a), 5e-6, "transform");
        expect_near(triple(v, 0, i), base::vector(here, a), 5e-6, "vtransform");
        expect_near(triple(m, 0, i), normal(here, a), 5e-6, "ntransform");
    }
}

TEST_F(Transforms, GivenMatrices) {
    const Planes in = matrices(1, 3, 1);
    const Planes p = run_all("transform_m", in, n), v = run_all("vtransform_m", in, n),
                 m = run_all("ntransform_m", in, n);
    const Planes pf = run_spaces("transform_from_m", in), vf = run_spaces("vtransform_from_m", in),
                 mf = run_spaces("ntransform_from_m", in);
    for (std::size_t i = 0; i < n; i++) {
        const V3d a = triple(in, 16, i);
        const base::Mat4 g = matrix(in, 0, i);
        expect_near(triple(p, 0, i), base::point(g, a), 3e-5, "transform");
        expect_near(triple(v, 0, i), base::vector(g, a), 3e-6, "vtransform");
        expect_near(triple(m, 0, i), normal(g, a), 3e-6, "ntransform");
        expect_near(triple(pf, 0, i), base::point(g, base::point(of(projection), a)), 3e-5, "from");
        expect_near(triple(vf, 0, i), base::vector(g, base::vector(of(projection), a)), 5e-6,
                    "from");
        expect_near(triple(mf, 0, i), normal(g, normal(of(projection), a)), 5e-6, "from");
    }
}

TEST_F(Transforms, NormalsStayPerpendicular) {
    const Planes in = matrices(1, 3, 4);
    Planes tangent = in;
    const Planes other = scattered(3, -1, 1, n, 40);
    for (std::size_t i = 0; i < n; i++) {
        const V3d t = base::cross(triple(in, 16, i), triple(other, 0, i));
        for (std::size_t k = 0; k < 3; k++)
            tangent[16 + k][i] = static_cast<float>(t[static_cast<int>(k)]);
    }
    const Planes a = run_all("ntransform_m", in, n), b = run_all("vtransform_m", tangent, n);
    for (std::size_t i = 0; i < n; i++)
        EXPECT_NEAR(base::dot(triple(a, 0, i), triple(b, 0, i)), 0, 5e-6);
}

TEST_F(Transforms, OfMatrices) {
    const Planes in = matrices(1, 0, 1);
    const Planes a = run_spaces("mtransform_to", in), b = run_spaces("mtransform_from_to", in);
    for (std::size_t i = 0; i < n; i++) {
        expect_near(matrix(a, 0, i), of(to_shader) * matrix(in, 0, i), 2e-5, "mtransform");
        expect_near(matrix(b, 0, i), of(projection) * matrix(in, 0, i), 2e-5, "mtransform");
    }
}

TEST_F(Transforms, Depth) {
    engine.clipping = {2, 10};
    EXPECT_EQ(run_all("depth", {{0, 0, 0}, {0, 0, 0}, {2, 10, 4}}, 3, &batch.batch())[0],
              (std::vector<float>{0, 1, 0.25f}));
    engine.clipping = {1, 1};
    EXPECT_EQ(run_all("depth", {{0}, {0}, {2}}, 1, &batch.batch())[0][0], 0);
}

TEST_F(Transforms, UnknownSpaceIsIdentity) {
    engine.spaces.clear();
    const Planes in = scattered(3, -2, 2);
    EXPECT_EQ(run_spaces("transform_to", in), in);
    EXPECT_FALSE(engine.reports.empty());
}

// --- colour

std::array<double, 3> hsv_to_rgb(double h, double s, double v) { // the case table of sl.md 4.4
    const double h6 = 6 * (h - std::floor(h));
    const int sextant = static_cast<int>(std::floor(h6)) % 6;
    const double f = h6 - std::floor(h6), p = v * (1 - s), q = v * (1 - s * f),
                 t = v * (1 - s * (1 - f));
    const std::array<double, 3> rows[6] = {{v, t, p}, {q, v, p}, {p, v, t},
                                           {p, q, v}, {t, p, v}, {v, p, q}};
    return rows[sextant];
}

double hsl_hue(double m1, double m2, double h) {
    h -= std::floor(h);
    if (h < 1. / 6)
        return m1 + (m2 - m1) * 6 * h;
    if (h < 0.5)
        return m2;
    return h < 2. / 3 ? m1 + (m2 - m1) * (2. / 3 - h) * 6 : m1;
}

std::array<double, 3> hsl_to_rgb(double h, double s, double l) {
    const double m2 = l <= 0.5 ? l * (1 + s) : l + s - l * s, m1 = 2 * l - m2;
    return {hsl_hue(m1, m2, h + 1. / 3), hsl_hue(m1, m2, h), hsl_hue(m1, m2, h - 1. / 3)};
}

TEST(Colour, HueSpacesToRgb) {
    Planes in = scattered(3, 0, 1);
    in[0] = scatter(-1, 2, n, 8); // hue wraps
    const Planes hsv = run_all("from_hsv", in, n), hsl = run_all("from_hsl", in, n);
    for (std::size_t i = 0; i < n; i++) {
        const auto v = hsv_to_rgb(in[0][i], in[1][i], in[2][i]),
                   l = hsl_to_rgb(in[0][i], in[1][i], in[2][i]);
        expect_near(triple(hsv, 0, i), {v[0], v[1], v[2]}, 3e-6, "hsv"); // slope 6 in the hue
        expect_near(triple(hsl, 0, i), {l[0], l[1], l[2]}, 3e-6, "hsl");
    }
}

TEST(Colour, RoundTrips) {
    Planes in = scattered(3, 0.05, 1);
    for (const char* space : {"hsv", "hsl", "YIQ", "xyz", "xyY"}) {
        const Planes there = run_all(std::string("to_") + space, in, n);
        const Planes back = run_all(std::string("from_") + space, there, n);
        for (std::size_t i = 0; i < n; i++) // YIQ's published inverse is good to 3 digits only
            expect_near(triple(back, 0, i), triple(in, 0, i),
                        std::string(space) == "YIQ" ? 3e-3 : 5e-6, space);
    }
}

TEST(Colour, KnownValues) {
    const auto one = [](const char* name, double a, double b, double c) {
        const Planes got = run_all(
            name, {{static_cast<float>(a)}, {static_cast<float>(b)}, {static_cast<float>(c)}}, 1);
        return triple(got, 0, 0);
    };
    expect_near(one("to_hsv", 1, 0, 0), {0, 1, 1}, 1e-7, "red");
    expect_near(one("to_hsv", 0, 0, 1), {2. / 3, 1, 1}, 1e-7, "blue");
    expect_near(one("to_hsv", 1, 0, 1), {5. / 6, 1, 1}, 1e-7, "magenta");
    expect_near(one("to_hsv", 0.5, 0.5, 0.5), {0, 0, 0.5}, 1e-7, "grey");
    expect_near(one("to_hsv", 0, 0, 0), {0, 0, 0}, 0, "black");
    expect_near(one("to_hsl", 1, 1, 1), {0, 0, 1}, 0, "white");
    expect_near(one("to_hsl", 0.2, 0.6, 0.2), {1. / 3, 0.5, 0.4}, 1e-6, "green");
    expect_near(one("to_YIQ", 1, 1, 1), {1, 0, 0}, 1e-6, "white");
    expect_near(one("from_YIQ", 0.5, 0.1, -0.2),
                {0.5 + .0956 - .124, 0.5 - .0272 + .1294, 0.5 - .1108 - .341}, 1e-6, "YIQ");
    expect_near(one("to_xyz", 1, 1, 1), {0.9503, 1.0, 1.0887}, 2e-4,
                "D65 white"); // (0.9504, 1, 1.0889)
    expect_near(one("from_xyz", 0.2, 0.4, 0.1),
                {3.24079 * .2 - 1.53715 * .4 - .0498535, -.969256 * .2 + 1.875992 * .4 + .0041556,
                 .055648 * .2 - .204043 * .4 + .1057311},
                1e-6, "xyz");
    expect_near(one("to_xyY", 0, 0, 0), {0, 0, 0}, 0, "black");
    expect_near(one("from_xyY", 0.3, 0, 0.5), {0, 0, 0}, 0, "y = 0");
}

} // namespace
} // namespace lanes_test
