// SPDX-License-Identifier: Apache-2.0
// PatchSurface: variables, refinement onto the true surface, degenerate edges, bad input.
#include "geometry/patch.h"

#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace {

using base::V3d;

rib::Param floats(std::string name, std::vector<float> values) {
    rib::Param p;
    p.name = std::move(name);
    p.decl = {.storage = rib::StorageClass::Vertex, .type = rib::ParamType::Point};
    p.floats = std::move(values);
    return p;
}

rib::Basis bezier_basis() {
    const std::array<float, 16> m{-1, 3, -3, 1, 3, -6, 3, 0, -3, 3, 0, 0, 1, 0, 0, 0};
    return {.u = m, .v = m, .ustep = 3, .vstep = 3};
}

// A bulging 2 x 1 mesh of bicubic parts around z = 5.
std::unique_ptr<geo::Surface> bulge(rib::ParamList& params) {
    std::mt19937 rng(5);
    std::uniform_real_distribution<float> jitter(-0.2f, 0.2f);
    std::vector<float> P;
    for (int j = 0; j < 4; ++j) {
        for (int i = 0; i < 7; ++i) {
            P.insert(P.end(), {float(i) / 3 - 1, float(j) / 1.5f - 1, 5 + jitter(rng)});
        }
    }
    params.params.push_back(floats("P", P));
    std::string why;
    auto s = geo::make_patches({.bicubic = true, .nu = 7, .nv = 4}, bezier_basis(), params, why);
    EXPECT_TRUE(s) << why;
    return s;
}

TEST(Patch, VertexStencilReproducesThePosition) {
    rib::ParamList params;
    const auto s = bulge(params);
    ASSERT_EQ(s->num_parts(), 2u);
    EXPECT_EQ(s->num_items(rib::StorageClass::Vertex), 28u);
    EXPECT_EQ(s->num_items(rib::StorageClass::Varying), 6u);
    EXPECT_EQ(s->num_items(rib::StorageClass::Uniform), 2u);
    for (std::uint32_t part = 0; part < 2; ++part) {
        const geo::LocalPoint at{part, 0.3, 0.8};
        geo::Stencil stencil;
        s->stencil(rib::StorageClass::Vertex, at, stencil);
        V3d sum;
        for (std::size_t i = 0; i < stencil.size(); ++i) {
            const float* p = params.params[0].floats.data() + 3 * stencil[i].item;
            sum += V3d{double(p[0]), double(p[1]), double(p[2])} * stencil[i].weight;
        }
        EXPECT_LT(length(sum - s->evaluate(at).P), 1e-13);
    }
}

TEST(Patch, SurfaceParametersRunOverTheWholeMesh) {
    rib::ParamList params;
    const auto s = bulge(params);
    const auto p = s->evaluate({1, 0.5, 0.25});
    EXPECT_DOUBLE_EQ(p.u, 0.75);
    EXPECT_DOUBLE_EQ(p.v, 0.25);
    const double h = 1e-6;
    const auto q = s->evaluate(s->step({1, 0.5, 0.25}, h, 0));
    EXPECT_LT(length((q.P - p.P) / h - p.dPdu), 1e-4); // h |d2P/du2| / 2
    EXPECT_NEAR(length(p.Ng), 1, 1e-14);
}

TEST(Patch, RefineMovesHitsOntoTheTrueSurface) {
    rib::ParamList params;
    const auto s = bulge(params);
    std::mt19937 rng(9);
    std::uniform_real_distribution<double> uniform(0.1, 0.9);
    for (int i = 0; i < 1000; ++i) {
        const geo::LocalPoint truth{std::uint32_t(i % 2), uniform(rng), uniform(rng)};
        const auto p = s->evaluate(truth);
        geo::ObjectRay ray;
        ray.d = p.P * 0.25; // t = 4 at the surface
        ray.tfar = 1e30;
        geo::LocalHit hit{{truth.part, truth.u + 0.03, truth.v - 0.02}, 3.9};
        s->refine(ray, hit);
        EXPECT_NEAR(hit.t, 4, 1e-12);
        EXPECT_LT(length(s->evaluate(hit.at).P - p.P), 1e-12);
    }
}

TEST(Patch, CollapsedEdgeHasTheLimitNormal) {
    // A cone-like patch: the edge v = 0 is one point.
    std::vector<float> P;
    for (int j = 0; j < 4; ++j) {
        for (int i = 0; i < 4; ++i) {
            const float r = float(j) / 3;
            P.insert(P.end(), {r * (float(i) / 1.5f - 1), r, 0});
        }
    }
    rib::ParamList params;
    params.params.push_back(floats("P", P));
    std::string why;
    const auto s =
        geo::make_patches({.bicubic = true, .nu = 4, .nv = 4}, bezier_basis(), params, why);
    ASSERT_TRUE(s) << why;
    const auto p = s->evaluate({0, 0.5, 0});
    EXPECT_NEAR(std::fabs(p.Ng.z), 1, 1e-9);
    EXPECT_TRUE(std::isfinite(p.dPdu.x));
}

TEST(Patch, HeightFieldIsExactInXAndY) {
    rib::ParamList params;
    params.params.push_back(floats("Pz", {0, 1, 2, 3}));
    std::string why;
    const auto s =
        geo::make_patches({.bicubic = false, .nu = 2, .nv = 2}, bezier_basis(), params, why);
    ASSERT_TRUE(s) << why;
    const auto p = s->evaluate({0, 0.25, 0.5});
    EXPECT_LT(length(p.P - V3d{0.25, 0.5, 1.25}), 1e-15);
}

// The half circle of three points: the middle one has no weight.
TEST(Patch, ControlPointsWithoutWeightAreLegal) {
    rib::ParamList params;
    params.params.push_back(
        floats("Pw", {-1, 0, 0, 1, 0, 1, 0, 0, 1, 0, 0, 1, -1, 0, 1, 1, 0, 1, 0, 0, 1, 0, 1, 1}));
    std::string why;
    const rib::NuPatch patch{.nu = 3,
                             .uorder = 3,
                             .nv = 2,
                             .vorder = 2,
                             .uknot = {0, 0, 0, 1, 1, 1},
                             .vknot = {0, 0, 1, 1}};
    const auto s = geo::make_nupatch(patch, params, why);
    ASSERT_TRUE(s) << why;
    EXPECT_EQ(s->num_items(rib::StorageClass::Varying), 4u);
    for (std::uint32_t part = 0; part < s->num_parts(); ++part) {
        for (double x : {0.0, 0.3, 1.0}) {
            const auto p = s->evaluate({part, x, 0.5});
            EXPECT_NEAR(p.P.x * p.P.x + p.P.y * p.P.y, 1, 1e-14);
        }
    }
}

TEST(Patch, BadInputIsRefusedWithAReason) {
    std::string why;
    rib::ParamList none;
    EXPECT_FALSE(
        geo::make_patches({.bicubic = false, .nu = 2, .nv = 2}, bezier_basis(), none, why));
    EXPECT_NE(why.find("\"P\""), std::string::npos);
    rib::ParamList negative;
    negative.params.push_back(floats("Pw", {0, 0, 0, 1, 1, 0, 0, 1, 0, 1, 0, -1, 1, 1, 0, 1}));
    EXPECT_FALSE(
        geo::make_patches({.bicubic = false, .nu = 2, .nv = 2}, bezier_basis(), negative, why));
    rib::ParamList nan;
    nan.params.push_back(floats("P", {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, std::nanf(""), 0}));
    EXPECT_FALSE(geo::make_patches({.bicubic = false, .nu = 2, .nv = 2}, bezier_basis(), nan, why));
}

} // namespace
