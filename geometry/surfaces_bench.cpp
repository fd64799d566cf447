// SPDX-License-Identifier: Apache-2.0
// Surfaces at scale and their error (docs/surfaces.md): outlines of diced patches, tightness of
// closed ones, places after refinement; 5 million triangles, many small requests and many instances
// beside raw Embree on the same data. In: nothing. Out: JSON lines; exit code 1 if a limit is
// broken.
#include "geometry/accel_level.h"
#include "geometry/accuracy.h"

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <numbers>

namespace {

using namespace geo::test;
using geo::Hit;
using geo::RayPacket;
using geo::View;
using geo::World;

bool all_kept = true;

// limit < 0: none.
void report(const char* name, double value, const char* unit, double limit, const char* note) {
    std::printf("{\"name\": \"%s\", \"value\": %.4g, \"unit\": \"%s\"", name, value, unit);
    if (limit >= 0) {
        std::printf(", \"limit\": %g, \"better\": \"lower\"", limit);
        all_kept = all_kept && value <= limit;
    }
    std::printf(", \"note\": \"%s\"}\n", note);
    std::fflush(stdout);
}

double cpu_seconds() {
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

std::string text(const char* format, auto... values) {
    char buffer[200];
    std::snprintf(buffer, sizeof buffer, format, values...);
    return buffer;
}

void outlines() {
    std::mt19937 rng(1);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int degree : {1, 3}) {
        std::vector<double> outline, deviation;
        std::size_t points = 0;
        double vertices = 0;
        for (int k = 0; k < 100; ++k) {
            const View view = test_view(200 + 1000 * unit(rng), 20 + 80 * unit(rng));
            const double z = 0.5 + 8 * unit(rng), size = 0.1 + 1.2 * unit(rng);
            const V3d centre((unit(rng) - .5) * z * view.corner_x,
                             (unit(rng) - .5) * z * view.corner_y, z);
            const PartAccuracy a =
                measure_part(degree, random_part(rng, degree, size, centre), view, 0.1);
            outline.push_back(a.silhouette_px);
            deviation.push_back(a.deviation_px);
            points += a.outline_points;
            vertices += double(a.vertices);
        }
        const char* what = degree == 1 ? "bilinear" : "bicubic";
        report(
            text("outline error, %s patches", what).c_str(), percentile(outline, 1), "pixel", 0.1,
            text("largest of 100 patches, %zu points; median %.3f, 99 %% %.3f; %.0f vertices each",
                 points, percentile(outline, .5), percentile(outline, .99), vertices / 100)
                .c_str());
        report(text("distance in the picture, %s patches", what).c_str(), percentile(deviation, 1),
               "pixel", 0.1,
               text("any point of the grid; median %.3f, 99 %% %.3f", percentile(deviation, .5),
                    percentile(deviation, .99))
                   .c_str());
    }
}

void tightness(std::size_t rays) {
    const struct {
        Closed kind;
        const char* name;
    } kinds[] = {{Closed::SplineTorus, "periodic B-spline torus"},
                 {Closed::BezierPot, "Bezier pot, one mesh, poles"},
                 {Closed::PatchesPot, "the pot of 12 Patch requests, turned"},
                 {Closed::RationalBall, "NURBS ball, poles"}};
    const Mat4 cameras[] = {Mat4::translate({0.1, 0.2, 4}), Mat4::translate({0.97, 0.03, 0.2}),
                            Mat4::translate({0, 0, -3}), Mat4::translate({1000, 2000, 3000})};
    for (const auto& k : kinds) {
        std::size_t leaks = 0;
        unsigned seed = 1;
        for (const double scale : {1.0, 1e-4, 1e4}) {
            for (const Mat4& camera : cameras) {
                const rib::Scene scene = closed_scene(k.kind, scale, camera);
                QuietDiag d;
                geo::BuildOptions options;
                options.view = test_view(1000, 50);
                options.num_threads = 1;
                const auto world = World::build(scene, options, d.diag);
                // Far from the eye and small: floats cannot hold the points inside.
                if (scale < 1 && camera.m[3][0] > 100) {
                    continue;
                }
                leaks += count_leaks(*world, k.kind, scale, camera, rays, ++seed);
            }
        }
        report(text("rays that leave the %s", k.name).c_str(), double(leaks), "rays", 0,
               text("of %zu, from inside; 3 sizes, 4 cameras", rays * 11).c_str());
    }
}

// Distance of refined places from the ray, in half ulps of the place's largest coordinate.
void places() {
    const rib::Scene scene = closed_scene(Closed::RationalBall, 1, Mat4::translate({0.3, 0.2, 3}));
    QuietDiag d;
    geo::BuildOptions options;
    options.view = test_view(1000, 50);
    const auto world = World::build(scene, options, d.diag);
    std::mt19937 rng(5);
    std::uniform_real_distribution<float> unit(-.9f, .9f);
    std::vector<double> miss, round;
    while (miss.size() < 20000) {
        std::vector<Hit> hits;
        std::vector<Ray> rays;
        while (hits.size() < SL_BATCH_MAX) {
            const Ray ray{{0, 0, 0}, {0.1f + .3f * unit(rng), .07f + .3f * unit(rng), 1}};
            const Hit hit = trace(*world, ray);
            // Well inside the outline: on it the ray may pass by the true surface.
            const V3d c(0.3, 0.2, 3), n = normalize(V3d(ray.d));
            if (hit.valid() && length(cross(c, n)) < 0.97) {
                hits.push_back(hit);
                rays.push_back(ray);
            }
        }
        const Filled f(*world, hits, rays);
        for (std::size_t i = 0; i < hits.size(); ++i) {
            const V3d P = f.vec(SL_VAR_P, i);
            const double ulp = 3 * 6e-8;
            miss.push_back(length(cross(P, normalize(V3d(rays[i].d)))) / ulp);
            round.push_back(std::fabs(length(P - V3d(0.3, 0.2, 3)) - 1) / ulp);
        }
    }
    report("refined place to its ray", percentile(miss, 1), "half ulp", 8,
           text("20,000 hits of a NURBS ball; median %.2f, 99 %% %.2f", percentile(miss, .5),
                percentile(miss, .99))
               .c_str());
    report("refined place to the sphere", percentile(round, 1), "half ulp", 4,
           text("median %.2f, 99 %% %.2f", percentile(round, .5), percentile(round, .99)).c_str());
}

struct RawEmbree {
    std::atomic<std::int64_t> bytes{0};
    RTCDevice device = rtcNewDevice("threads=1");
    RTCScene scene;

    RawEmbree() {
        rtcSetDeviceMemoryMonitorFunction(
            device,
            [](void* self, std::ptrdiff_t n, bool) {
                static_cast<RawEmbree*>(self)->bytes += n;
                return true;
            },
            this);
        scene = rtcNewScene(device);
        rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    }
    ~RawEmbree() {
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }
    void add_mesh(RTCScene to, const std::vector<float>& xyz,
                  const std::vector<std::int32_t>& index) {
        RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, xyz.data(), 0,
                                   12, xyz.size() / 3 - 2);
        rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, index.data(), 0,
                                   12, index.size() / 3);
        rtcCommitGeometry(g);
        rtcAttachGeometry(to, g);
        rtcReleaseGeometry(g);
    }
};

void triangles() {
    constexpr int n = 1582; // 2 * 1581^2 = 4,999,122
    std::vector<float> xyz;
    std::vector<std::int32_t> index;
    wavy_grid(n, xyz, index);
    const double count = double(index.size() / 3);
    SceneBuilder b;
    b.add(SceneBuilder::polygons(std::vector<std::int32_t>(std::size_t(count), 1),
                                 std::vector<std::int32_t>(std::size_t(count), 3), index, xyz));
    double raw_seconds, raw_bytes;
    {
        xyz.resize(xyz.size() + 6);
        RawEmbree raw;
        const double start = cpu_seconds();
        raw.add_mesh(raw.scene, xyz, index);
        rtcCommitScene(raw.scene);
        raw_seconds = cpu_seconds() - start;
        raw_bytes = double(raw.bytes) / count;
    }
    QuietDiag d;
    const double start = cpu_seconds();
    const auto world = b.world(d.diag);
    const double seconds = cpu_seconds() - start;
    report("5 M triangles: World beside raw Embree", seconds / raw_seconds, "x", 1.5,
           text("%.2f s against %.2f s of rtcCommitScene", seconds, raw_seconds).c_str());
    report("5 M triangles: bytes each", double(world->stats().bytes) / count, "bytes", -1,
           text("Embree alone on the same arrays: %.1f", raw_bytes).c_str());
}

void quads() {
    constexpr int n = 1000;
    std::vector<float> xyz;
    std::vector<std::int32_t> index, corners;
    wavy_grid(n, xyz, index);
    for (int j = 0; j + 1 < n; ++j) {
        for (int i = 0; i + 1 < n; ++i) {
            const int a = j * n + i;
            corners.insert(corners.end(), {a, a + 1, a + n + 1, a + n});
        }
    }
    const std::size_t count = corners.size() / 4;
    SceneBuilder b;
    b.add(SceneBuilder::polygons(std::vector<std::int32_t>(count, 1),
                                 std::vector<std::int32_t>(count, 4), corners, xyz));
    QuietDiag d;
    const auto world = b.world(d.diag);
    report("1 M quads in one request: bytes each", double(world->stats().bytes) / double(count),
           "bytes", -1, text("two triangles; %.2f s", world->stats().build_seconds).c_str());
}

void small_requests() {
    QuietDiag d;
    SceneBuilder polygons;
    for (int i = 0; i < 100000; ++i) {
        const float x = float(i % 400), y = float(i / 400);
        polygons.scene.primitives.push_back(SceneBuilder::polygons(
            {1}, {4}, {0, 1, 2, 3}, {x, y, 9, x, y + 1, 9, x + 1, y + 1, 9, x + 1, y, 9}));
    }
    const auto flat = polygons.world(d.diag);
    report("100,000 Polygon requests: bytes each", double(flat->stats().bytes) / 1e5, "bytes", -1,
           text("%.2f s", flat->stats().build_seconds).c_str());
    SceneBuilder patches;
    for (int i = 0; i < 30000; ++i) {
        const float x = float(i % 200), y = float(i / 200);
        std::vector<float> P;
        for (int k = 0; k < 16; ++k) {
            P.insert(P.end(),
                     {x + float(k % 4) / 3, y + float(k / 4) / 3, 300 + ((k % 5) == 0 ? 0.5f : 0)});
        }
        rib::Primitive p;
        p.shape = rib::Patches{.bicubic = true, .nu = 4, .nv = 4};
        p.params.params.push_back(positions(P));
        patches.scene.primitives.push_back(std::move(p));
    }
    const double start = cpu_seconds();
    const auto curved = [&] {
        geo::BuildOptions options;
        options.view = test_view(1000, 50);
        options.num_threads = 1;
        return World::build(patches.scene, options, d.diag);
    }();
    report("30,000 Patch requests: bytes each", double(curved->stats().bytes) / 3e4, "bytes", -1,
           text("%.2f s; %.0f of them Embree's", cpu_seconds() - start,
                double(curved->stats().embree_bytes) / 3e4)
               .c_str());
}

std::vector<RayPacket> camera_rays(int image) {
    std::vector<RayPacket> packets;
    for (int y = 0; y < image; y += 2) {
        for (int x = 0; x < image; x += 4) {
            RayPacket p{};
            for (int i = 0; i < 8; ++i) {
                const float px = float(x + i % 4) + 0.43f, py = float(y + i / 4) + 0.57f;
                set_ray(p, i,
                        {{0, 0, 0},
                         {px / float(image) * 1.6f - 0.8f, py / float(image) * 1.6f - 0.8f, 1}});
            }
            packets.push_back(p);
        }
    }
    return packets;
}

// 50,000 boxes of six polygons, as Structure Synth writes them.
void instances() {
    constexpr int side = 37; // 50,653
    SceneBuilder b;
    rib::Object object;
    std::vector<float> xyz;
    for (int k = 0; k < 8; ++k) {
        xyz.insert(xyz.end(), {float(k & 1) - .5f, float(k >> 1 & 1) - .5f, float(k >> 2) - .5f});
    }
    const std::vector<std::vector<std::int32_t>> faces = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                                          {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    std::vector<std::int32_t> index;
    for (const auto& f : faces) {
        object.primitives.edit().push_back(SceneBuilder::polygons({1}, {4}, f, xyz));
        index.insert(index.end(), {f[0], f[1], f[2], f[0], f[2], f[3]});
    }
    b.scene.objects.push_back(object);
    std::vector<Mat4> placed;
    for (int k = 0; k < side * side * side; ++k) {
        const Mat4 m = Mat4::translate({0.3 * (k % side) - 5.5, 0.3 * (k / side % side) - 5.5,
                                        3 + 0.3 * (k / side / side)}) *
                       Mat4::scale({0.15, 0.15, 0.15});
        placed.push_back(m);
        rib::Instance instance;
        instance.world_from_object = b.transform(m);
        instance.attributes.assign(6, 0);
        b.scene.instances.push_back(instance);
    }
    QuietDiag d;
    const double begin = cpu_seconds();
    const auto world = b.world(d.diag);
    const double build = cpu_seconds() - begin;

    RawEmbree raw;
    xyz.resize(xyz.size() + 6);
    const double raw_begin = cpu_seconds();
    RTCScene box = rtcNewScene(raw.device);
    rtcSetSceneFlags(box, RTC_SCENE_FLAG_ROBUST);
    raw.add_mesh(box, xyz, index);
    rtcCommitScene(box);
    for (const Mat4& m : placed) {
        RTCGeometry g = rtcNewGeometry(raw.device, RTC_GEOMETRY_TYPE_INSTANCE);
        rtcSetGeometryInstancedScene(g, box);
        float f[12];
        for (int i = 0; i < 12; ++i) {
            f[i] = float(m.m[i / 3][i % 3]);
        }
        rtcSetGeometryTransform(g, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, f);
        rtcCommitGeometry(g);
        rtcAttachGeometry(raw.scene, g);
        rtcReleaseGeometry(g);
    }
    rtcCommitScene(raw.scene);
    const double raw_build = cpu_seconds() - raw_begin;
    const double count = double(placed.size());
    report("50,653 instances: World beside raw Embree", build / raw_build, "x", 2,
           text("%.3f s against %.3f s", build, raw_build).c_str());
    report("50,653 instances: bytes each", double(world->stats().bytes) / count, "bytes", -1,
           text("Embree alone counts %.0f", double(raw.bytes) / count).c_str());

    const auto packets = camera_rays(512);
    std::vector<Hit> hits(packets.size() * 8);
    double best = 1e30, raw_best = 1e30;
    for (int round = 0; round < 5; ++round) {
        double start = cpu_seconds();
        for (std::size_t k = 0; k < packets.size(); k += 32) {
            world->intersect(std::span(packets).subspan(k, 32), &hits[8 * k]);
        }
        best = std::min(best, cpu_seconds() - start);
        start = cpu_seconds();
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
        for (const RayPacket& p : packets) {
            alignas(32) const int valid[8] = {-1, -1, -1, -1, -1, -1, -1, -1};
            RTCRayHit8 q{};
            for (int i = 0; i < 8; ++i) {
                q.ray.dir_x[i] = p.dx[i], q.ray.dir_y[i] = p.dy[i], q.ray.dir_z[i] = p.dz[i];
                q.ray.tfar[i] = 1e30f, q.ray.mask[i] = ~0u;
                q.hit.geomID[i] = q.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
            }
            rtcIntersect8(valid, raw.scene, &context, &q);
        }
        raw_best = std::min(raw_best, cpu_seconds() - start);
    }
    report("50,653 instances: camera rays, time beside raw Embree", best / raw_best, "x", 1.25,
           text("%.2f against %.2f Mray/s", double(hits.size()) / best / 1e6,
                double(hits.size()) / raw_best / 1e6)
               .c_str());
    rtcReleaseScene(box);
}

// Patches that would not fit: bounded, and fast.
void extremes() {
    std::mt19937 rng(9);
    const struct {
        const char* name;
        double pixels, size;
        V3d centre;
    } cases[] = {{"a patch that fills 8K", 8192, 1, {0, 0, 2}},
                 {"a patch 10^6 times the picture, eye beside it", 1000, 1e6, {0, 1e6, 0}},
                 {"a patch through the eye plane", 1000, 10, {0, 3, 0}},
                 {"a patch of a thousandth of a pixel", 1000, 1e-6, {0, 0, 1}}};
    for (const auto& c : cases) {
        const View view = test_view(c.pixels, 50);
        const std::vector<double> net = random_part(rng, 3, c.size, c.centre);
        const Mat4 identity;
        const double start = cpu_seconds();
        const geo::DicePlan plan =
            geo::plan_part(3, 3, net.data(), {view, std::span(&identity, 1), 0, 0.1});
        std::vector<V3d> P;
        geo::dice_part(3, 3, net.data(), plan, P);
        report(c.name, cpu_seconds() - start, "s", 2, text("%zu vertices", P.size()).c_str());
    }
}

} // namespace

int main(int argc, char** argv) {
    const std::size_t rays = argc > 1 ? std::size_t(std::atol(argv[1])) : 400000;
    outlines();
    tightness(rays);
    places();
    extremes();
    triangles();
    quads();
    small_requests();
    instances();
    return all_kept ? 0 : 1;
}
