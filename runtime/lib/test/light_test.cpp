// SPDX-License-Identifier: Apache-2.0
// Lighting functions against sums written out in double: cosines, cones, categories' neighbours
// (nondiffuse, area samples), and the light statements' helpers through a driver in lanes.
// reference/sl.md 4.6, 5.4, 5.5.
#include "runtime/base/vec.h"
#include "runtime/lib/test/fixture.h"
#include "runtime/lib/test/light_driver.h"
#include "runtime/lib/test_services.h"

#include <cmath>
#include <gtest/gtest.h>

namespace lanes_test {
namespace {

const Covers covers{"ambient", "diffuse", "diffuse_at", "specular", "phong", "specularbrdf"};

using base::V3d;
constexpr std::size_t n = 60;

class Lighting : public testing::Test {
protected:
    Lighting() : engine(8), batch(n, engine) {
        for (std::uint32_t i = 0; i < n; i++) {
            const auto x = static_cast<float>(i);
            batch.set_triple(SL_VAR_P, i, {0.1f * x, -0.05f * x, 1 + 0.02f * x});
        }
        normals = {scatter(-1, 1, n, 0), scatter(-1, 1, n, 1), scatter(-1, 1, n, 2)};
        views = {scatter(-1, 1, n, 4), scatter(-1, 1, n, 5), scatter(-1, 1, n, 6)};
        normalise(normals);
        normalise(views);
    }
    static void normalise(Planes& p) {
        for (std::size_t i = 0; i < n; i++) {
            const V3d v = base::normalize(V3d(p[0][i], p[1][i], p[2][i]));
            for (int k = 0; k < 3; k++)
                p[static_cast<std::size_t>(k)][i] = static_cast<float>(v[k]);
        }
    }
    Planes run(const char* name, const Planes& in) {
        return run_all(name, in, n, &batch.batch(),
                       [this](const Width& w) { engine.set_lanes(w.api->lanes); });
    }
    V3d point(std::size_t i) {
        const float* p = batch.set(SL_VAR_P, 3);
        return {p[i], p[batch.stride() + i], p[2 * batch.stride() + i]};
    }
    static V3d at(const Planes& p, std::size_t i) { return {p[0][i], p[1][i], p[2][i]}; }

    // Sum over lights of Cl k(L, light) for lights above the horizon of N.
    template <class K>
    V3d sum(std::size_t i, const V3d& p, const V3d& normal, double min_cosine, K k) {
        V3d total(0, 0, 0);
        for (const rt::TestLight& light : engine.lights) {
            const V3d from(light.position[0], light.position[1], light.position[2]);
            const V3d towards = light.directional ? -from : from - p;
            const V3d unit = base::normalize(towards);
            if (base::dot(unit, base::normalize(normal)) < min_cosine)
                continue;
            const double strength = light.falloff ? 1 / base::dot(towards, towards) : 1;
            const double weight = k(unit, light, i) * strength;
            total += V3d(light.color[0], light.color[1], light.color[2]) * weight;
        }
        return total;
    }
    template <class K> void expect_sum(const Planes& got, K k) {
        for (std::size_t i = 0; i < n; i++) {
            const V3d want = sum(i, point(i), at(normals, i), 0, k);
            for (int c = 0; c < 3;
                 c++) // 1e-5 relative: pow with exponents up to 20 and cosines of 24 bits
                EXPECT_NEAR(got[static_cast<std::size_t>(c)][i], want[c],
                            1e-5 * std::abs(want[c]) + 1e-5)
                    << i;
        }
    }
    void three_lights() {
        engine.lights = {{.position = {3, 2, -4}, .color = {1, 0.5f, 0.25f}},
                         {.position = {-1, 5, 2},
                          .color = {4, 4, 4},
                          .falloff = true,
                          .nondiffuse = 0.25f,
                          .nonspecular = 0.5f},
                         {.position = {0.5f, -1, 0.75f},
                          .color = {0.2f, 0.3f, 0.1f},
                          .directional = true,
                          .samples = 4}};
    }
    rt::TestEngine engine;
    rt::TestBatch batch;
    Planes normals, views;
};

Planes join(std::initializer_list<Planes> parts) {
    Planes all;
    for (const Planes& p : parts)
        all.insert(all.end(), p.begin(), p.end());
    return all;
}

TEST_F(Lighting, Ambient) {
    engine.ambient_color = {0.1f, 0.2f, 0.3f};
    const Planes got = run("ambient", {});
    for (std::size_t i = 0; i < n; i++)
        EXPECT_EQ(at(got, i), V3d(0.1f, 0.2f, 0.3f));
}

TEST_F(Lighting, Diffuse) {
    three_lights();
    expect_sum(run("diffuse", normals),
               [this](const V3d& l, const rt::TestLight& light, std::size_t i) {
                   return (1 - light.nondiffuse) * base::dot(l, at(normals, i));
               });
}

TEST_F(Lighting, DiffuseOfNothing) {
    const Planes got = run("diffuse", normals);
    for (std::size_t i = 0; i < n; i++)
        EXPECT_EQ(at(got, i), V3d(0, 0, 0));
}

TEST_F(Lighting, DiffuseAtWithCone) {
    three_lights();
    const Planes points = {scatter(-2, 2, n, 7), scatter(-2, 2, n, 8), scatter(-2, 2, n, 9)};
    for (const double angle : {0.7, 1.5707963267948966, 3.15}) {
        const Planes got =
            run("diffuse_at",
                join({points, normals, {std::vector<float>(n, static_cast<float>(angle))}}));
        const double limit = angle > 3.1415926 ? -2 : angle == 0.7 ? std::cos(0.7) : 0;
        for (std::size_t i = 0; i < n; i++) {
            const V3d want =
                sum(i, at(points, i), at(normals, i), limit,
                    [&](const V3d& l, const rt::TestLight& light, std::size_t k) {
                        return (1 - light.nondiffuse) * std::fmax(0, base::dot(l, at(normals, k)));
                    });
            for (int c = 0; c < 3; c++)
                EXPECT_NEAR(got[static_cast<std::size_t>(c)][i], want[c], 1e-5)
                    << i << " " << angle;
        }
    }
}

TEST_F(Lighting, SpecularAndItsExponent) {
    three_lights();
    const Planes in = join({normals, views, {std::vector<float>(n, 0.1f)}});
    for (const double scale : {1.0, 8.0}) {
        const auto brdf = [&](const V3d& l, const rt::TestLight& light, std::size_t i) {
            const V3d h = base::normalize(l + at(views, i));
            return (1 - light.nonspecular) * std::pow(std::fmax(0, base::dot(at(normals, i), h)),
                                                      scale / static_cast<double>(0.1f));
        };
        expect_sum(run("specular", in), brdf);
        engine.messages[{SL_MESSAGE_option, "render:prmanspecular"}] = {.values = {1}};
    }
}

TEST_F(Lighting, Phong) {
    three_lights();
    const Planes in = join({normals, views, {std::vector<float>(n, 20)}});
    expect_sum(run("phong", in), [this](const V3d& l, const rt::TestLight& light, std::size_t i) {
        const V3d v = -base::normalize(at(views, i)), m = base::normalize(at(normals, i));
        const V3d r = v - m * (2 * base::dot(v, m));
        return (1 - light.nonspecular) * std::pow(std::fmax(0, base::dot(r, l)), 20);
    });
}

TEST_F(Lighting, SpecularBrdf) {
    const Planes l = {scatter(-1, 1, n, 11), scatter(-1, 1, n, 12), scatter(0, 1, n, 13)};
    Planes in = join({l, normals, views, {std::vector<float>(n, 0.25f)}});
    const Planes got = run("specularbrdf", in);
    for (std::size_t i = 0; i < n; i++) {
        const V3d h = base::normalize(at(l, i) + at(views, i));
        const double want = std::pow(std::fmax(0, base::dot(at(normals, i), h)), 4);
        for (const auto& plane : got)
            EXPECT_NEAR(plane[i], want, 2e-6);
    }
    in[9].assign(n, 0); // a mirror: finite everywhere
    for (const auto& plane : run("specularbrdf", in))
        for (const float v : plane)
            EXPECT_TRUE(std::isfinite(v));
}

TEST_F(Lighting, ALightAtThePointGivesNothing) {
    engine.lights = {{.position = {0, 0, 0}}};
    Planes points(3, std::vector<float>(n, 0.0f));
    const Planes got = run("diffuse_at", join({points, normals, {std::vector<float>(n, 4)}}));
    for (std::size_t i = 0; i < n; i++)
        EXPECT_EQ(at(got, i), V3d(0, 0, 0));
}

// --- the loop itself and the light's side

const std::vector<const light_driver*>& drivers() {
    static const std::vector<const light_driver*> all = [] {
        std::vector<const light_driver*> d{&light_driver_4};
        if (__builtin_cpu_supports("avx2"))
            d.push_back(&light_driver_8);
        return d;
    }();
    return all;
}

TEST_F(Lighting, LoopFollowsCategoriesAndBreak) {
    engine.lights = {{.position = {0, 0, 9}, .category = "key"},
                     {.position = {0, 0, 9}, .category = "fill,rim"},
                     {.position = {0, 0, 9}}};
    for (const light_driver* driver : drivers()) {
        std::vector<float> count(64);
        engine.set_lanes(driver->lanes);
        const auto run_loop = [&](const char* category, float stop_after) {
            driver->count_lights(&batch.batch(), engine.text(category), stop_after, count.data(),
                                 static_cast<int>(n));
            return count[0];
        };
        EXPECT_EQ(run_loop("", 99), 3);
        EXPECT_EQ(run_loop("key", 99), 1);
        EXPECT_EQ(run_loop("rim", 99), 1);
        EXPECT_EQ(run_loop("-fill", 99), 2);
        EXPECT_EQ(run_loop("none", 99), 0);
        run_loop("", 1); // odd points leave after one light
        EXPECT_EQ(count[0], 3);
        EXPECT_EQ(count[1], 1);
        EXPECT_EQ(count[n - 1], 1);
    }
}

TEST_F(Lighting, ConesIncludeTheirEdge) {
    engine.lights = {{.position = {0, 0, -1}, .directional = true}}; // L = +z
    for (const light_driver* driver : drivers()) {
        std::vector<float> count(64);
        const auto lit = [&](V3d axis, double angle) {
            const float a[3] = {static_cast<float>(axis.x), static_cast<float>(axis.y),
                                static_cast<float>(axis.z)};
            driver->count_in_cone(&batch.batch(), a, static_cast<float>(angle), count.data(), 8);
            return count[3] == 1;
        };
        EXPECT_TRUE(lit({0, 0, 3}, 0.1));
        EXPECT_TRUE(
            lit({0, 1, 0}, 1.5707963267948966)); // on the horizon: N.L = 0 contributes 0 anyway
        EXPECT_FALSE(lit({0, 1, -1e-3}, 1.5707963267948966));
        EXPECT_FALSE(lit({0, 0, -1}, 3.0));
        EXPECT_TRUE(lit({0, 0, -1}, 3.1415926535897932)); // pi accepts all
        EXPECT_FALSE(lit({1, 0, 1}, 0.78));
        EXPECT_TRUE(lit({1, 0, 1}, 0.79));
    }
}

TEST_F(Lighting, IlluminateAndSolar) {
    for (std::uint32_t i = 0; i < n; i++) {
        batch.set_triple(SL_VAR_Ps, i, {static_cast<float>(i % 4), 0, 2});
        batch.set_triple(SL_VAR_Ns, i, {0, 0, 5});
    }
    for (const light_driver* driver : drivers()) {
        light_result r{};
        driver->illuminate(&batch.batch(), 0.785f,
                           &r); // from the origin along z, half angle 45 degrees
        const auto lanes = static_cast<std::uint32_t>(driver->lanes);
        for (std::uint32_t i = 0; i < lanes; i++) {
            EXPECT_EQ(r.all[i], 1);
            EXPECT_EQ(r.L[0][i], static_cast<float>(i % 4));
            EXPECT_EQ(r.L[2][i], 2);
            EXPECT_EQ(r.cone[i],
                      i % 4 < 2 ? 1
                                : 0); // atan(x/2) <= 45 degrees: x = 0, 1 (x = 2 is just outside)
            EXPECT_EQ(r.solar_L[2][i], -1); // solar(): against Ns
            EXPECT_EQ(r.axis_L[1][i], -7);  // solar(axis, 0): L = axis, not normalised
        }
        EXPECT_EQ(r.lit_by_cone, lanes == 8 ? 0x33u : 0x3u);
    }
}

} // namespace
} // namespace lanes_test
