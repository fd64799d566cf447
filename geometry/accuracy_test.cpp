// SPDX-License-Identifier: Apache-2.0
// Diced patches: distance from the true surface in the picture, and no way out of closed ones.
#include "geometry/accuracy.h"

#include <gtest/gtest.h>

namespace {

using namespace geo::test;
using geo::View;
using geo::World;

constexpr double flatness_px = 0.1;

struct Figures {
    std::vector<double> deviation, silhouette;
    std::size_t outline_points = 0;
    std::int64_t vertices = 0;

    void add(const PartAccuracy& a) {
        deviation.push_back(a.deviation_px);
        silhouette.push_back(a.silhouette_px);
        outline_points += a.outline_points;
        vertices += a.vertices;
    }
    void check(const char* what) const {
        EXPECT_LE(percentile(silhouette, 1), flatness_px) << what;
        EXPECT_LE(percentile(deviation, 1), flatness_px) << what;
        std::printf("%-12s %zu parts, %zu outline points, %lld vertices; outline px median %.3f, "
                    "99 %% %.3f, most %.3f; deviation px median %.3f, 99 %% %.3f, most %.3f\n",
                    what, deviation.size(), outline_points, static_cast<long long>(vertices),
                    percentile(silhouette, .5), percentile(silhouette, .99),
                    percentile(silhouette, 1), percentile(deviation, .5),
                    percentile(deviation, .99), percentile(deviation, 1));
    }
};

TEST(Accuracy, OutlinesKeepWithinTheFlatness) {
    std::mt19937 rng(1);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int degree : {1, 3}) {
        Figures f;
        for (int k = 0; k < 40; ++k) {
            const View view = test_view(200 + 1000 * unit(rng), 20 + 80 * unit(rng));
            const double z = 2 + 8 * unit(rng), size = 0.1 + 1.2 * unit(rng);
            const V3d centre((unit(rng) - .5) * z * view.corner_x,
                             (unit(rng) - .5) * z * view.corner_y, z);
            f.add(measure_part(degree, random_part(rng, degree, size, centre), view, flatness_px));
        }
        f.check(degree == 1 ? "bilinear" : "bicubic");
    }
}

TEST(Accuracy, PartsThatComeNearTheEyeOrPassIt) {
    std::mt19937 rng(2);
    std::uniform_real_distribution<double> unit(-1, 1);
    Figures f;
    for (int k = 0; k < 20; ++k) {
        const View view = test_view(500, 60);
        const V3d centre(0.5 * unit(rng), 0.4 + 0.3 * unit(rng), 0.6 * unit(rng));
        f.add(measure_part(3, random_part(rng, 3, 1.5, centre), view, flatness_px));
    }
    f.check("near");
}

TEST(Accuracy, ClosedSurfacesAreTight) {
    for (const Closed kind :
         {Closed::SplineTorus, Closed::BezierPot, Closed::PatchesPot, Closed::RationalBall}) {
        int seed = 0;
        for (const Mat4& camera :
             {Mat4::translate({0.1, 0.2, 4}), Mat4::translate({0.97, 0.03, 0.2}),
              Mat4::translate({0, 0, -3})}) {
            const rib::Scene scene = closed_scene(kind, 1, camera);
            QuietDiag d;
            geo::BuildOptions options;
            options.view = test_view(1000, 50);
            options.num_threads = 1;
            const auto world = World::build(scene, options, d.diag);
            EXPECT_EQ(d.diag.messages().size(), 0u);
            EXPECT_EQ(count_leaks(*world, kind, 1, camera, 40000, unsigned(++seed)), 0u)
                << int(kind) << " " << seed;
            std::printf("kind %d camera %d: %llu grids, %.2f MB, %.3f s\n", int(kind), seed,
                        static_cast<unsigned long long>(world->stats().grids),
                        double(world->stats().bytes) / 1e6, world->stats().build_seconds);
        }
    }
}

} // namespace
