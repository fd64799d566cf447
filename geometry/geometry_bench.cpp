// SPDX-License-Identifier: Apache-2.0
// What World costs over raw Embree: the same rays through rtcIntersect8, through Embree's stream
// call, through World::intersect by packet and by span; then fill, spheres, and building. One
// thread; ratios within one run. In: nothing. Out: a table on standard output; exit code 1 if
// World::intersect falls below its limit.
#include "geometry/accel_level.h"
#include "geometry/test_scene.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <functional>

namespace {

using namespace geo::test;
using geo::Hit;
using geo::RayPacket;
using geo::World;

constexpr int grid = 708; // 2 * 707^2 = 999,698 triangles
constexpr int image = 512;
constexpr double least_ratio = 0.8; // of raw rtcIntersect8, see design.md section 9

using Work = std::function<void()>;

// Processor time of the best of several rounds, works taking turns: what else runs on the machine
// counts less, and alike.
std::vector<double> seconds(const std::vector<Work>& works) {
    const auto now = [] {
        timespec t{};
        clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
        return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
    };
    std::vector<double> best(works.size(), 1e30);
    for (int round = 0; round < 9; ++round) {
        for (std::size_t i = 0; i < works.size(); ++i) {
            const double start = now();
            works[i]();
            best[i] = std::min(best[i], now() - start);
        }
    }
    return best;
}

RTCScene raw_scene(RTCDevice device, std::vector<float>& xyz,
                   const std::vector<std::int32_t>& index) {
    xyz.resize(xyz.size() + 4);
    RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, xyz.data(), 0, 12,
                               (xyz.size() - 4) / 3);
    rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, index.data(), 0, 12,
                               index.size() / 3);
    rtcCommitGeometry(g);
    RTCScene scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    rtcAttachGeometry(scene, g);
    rtcReleaseGeometry(g);
    rtcCommitScene(scene);
    return scene;
}

// 4x2 pixels to a packet, in rows of blocks.
std::vector<RayPacket> camera_rays() {
    std::vector<RayPacket> packets;
    for (int y = 0; y < image; y += 2) {
        for (int x = 0; x < image; x += 4) {
            RayPacket p{};
            for (int i = 0; i < 8; ++i) {
                const float px = float(x + i % 4) + 0.43f, py = float(y + i / 4) + 0.57f;
                set_ray(p, i, {{0, 0, 0}, {px / image * 1.6f - 0.8f, py / image * 1.6f - 0.8f, 1}});
            }
            packets.push_back(p);
        }
    }
    return packets;
}

std::vector<RayPacket> bounce_rays(const World& world, const std::vector<RayPacket>& from,
                                   std::vector<Hit>& hits) {
    std::vector<RayPacket> packets = from;
    std::uint32_t state = 1;
    const auto random = [&] {
        state = state * 1664525u + 1013904223u;
        return float(state >> 8) / 8388608.0f - 1;
    };
    for (std::size_t k = 0; k < packets.size(); ++k) {
        packets[k].active = 0;
        for (int i = 0; i < 8; ++i) {
            const Hit& hit = hits[8 * k + std::size_t(i)];
            const V3f d = normalize(V3f(random(), random(), -std::fabs(random())));
            set_ray(packets[k], i, {hit.valid() ? world.spawn_origin(hit, d) : V3f(0, 0, -1), d});
        }
    }
    return packets;
}

void load(const RayPacket& r, RTCRayHit8& q) {
    std::memcpy(q.ray.org_x, r.ox, 96);
    std::memcpy(q.ray.dir_x, r.dx, 96);
    std::memcpy(q.ray.tnear, r.tnear, 32);
    std::memcpy(q.ray.tfar, r.tfar, 32);
    std::fill_n(q.ray.mask, 8, ~0u);
    std::fill_n(q.ray.flags, 8, 0u);
    std::fill_n(q.ray.time, 8, 0.0f);
    std::fill_n(q.hit.geomID, 8, RTC_INVALID_GEOMETRY_ID);
    std::fill_n(q.hit.instID[0], 8, RTC_INVALID_GEOMETRY_ID);
}

Work raw_packets(RTCScene scene, const std::vector<RayPacket>& packets, bool coherent) {
    return [=, &packets] {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        context.flags =
            coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
        alignas(32) const int valid[8] = {-1, -1, -1, -1, -1, -1, -1, -1};
        for (const RayPacket& p : packets) {
            RTCRayHit8 q;
            load(p, q);
            rtcIntersect8(valid, scene, &context, &q);
        }
    };
}

Work raw_streams(RTCScene scene, const std::vector<RayPacket>& packets, bool coherent) {
    return [=, &packets] {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        context.flags =
            coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
        constexpr std::size_t batch = 32;
        static RTCRayHit8 q[batch];
        for (std::size_t k = 0; k < packets.size(); k += batch) {
            const std::size_t n = std::min(batch, packets.size() - k);
            for (std::size_t i = 0; i < n; ++i) {
                load(packets[k + i], q[i]);
            }
            rtcIntersectNM(scene, &context, reinterpret_cast<RTCRayHitN*>(q), 8, unsigned(n),
                           sizeof(RTCRayHit8));
        }
    };
}

Work by_packet(const World& world, const std::vector<RayPacket>& packets, std::vector<Hit>& hits) {
    return [&] {
        for (std::size_t k = 0; k < packets.size(); ++k) {
            world.intersect(packets[k], &hits[8 * k]);
        }
    };
}

Work by_span(const World& world, const std::vector<RayPacket>& packets, std::vector<Hit>& hits) {
    return [&] {
        for (std::size_t k = 0; k < packets.size(); k += 32) {
            const std::size_t n = std::min<std::size_t>(32, packets.size() - k);
            world.intersect(std::span(packets).subspan(k, n), &hits[8 * k]);
        }
    };
}

// Nanoseconds per point to fill what a shader of that mask needs.
double fill_ns(const World& world, const std::vector<RayPacket>& packets,
               const std::vector<Hit>& hits, std::uint64_t needed, bool auxiliary) {
    constexpr std::uint32_t n = SL_BATCH_MAX;
    std::vector<float> store(3 * SL_VAR_COUNT * 3 * n), planes[7];
    sl_points points[3];
    for (int w = 0; w < 3; ++w) {
        for (int v = 0; v < SL_VAR_COUNT; ++v) {
            points[w].var[v] = &store[std::size_t(w * SL_VAR_COUNT + v) * 3 * n];
        }
    }
    for (auto& plane : planes) {
        plane.assign(n, 0.01f);
    }
    for (std::uint32_t i = 0; i < n; ++i) {
        planes[3][i] = packets[i / 8].dx[i % 8], planes[4][i] = packets[i / 8].dy[i % 8],
        planes[5][i] = 1;
    }
    const geo::Incident incident{planes[0], planes[1], planes[2], planes[3],
                                 planes[4], planes[5], planes[6]};
    const int rounds = 200;
    const double t = seconds({[&] {
        for (int k = 0; k < rounds; ++k) {
            world.fill(std::span(hits).subspan(std::size_t(k) * 512, n), incident, needed, n,
                       points[0], auxiliary ? &points[1] : nullptr,
                       auxiliary ? &points[2] : nullptr);
        }
    }})[0];
    return t / (rounds * n) * 1e9;
}

std::unique_ptr<World> many_polygons(int count, bool separate) {
    static std::vector<std::unique_ptr<SceneBuilder>> keep; // the scene must outlive the world
    keep.push_back(std::make_unique<SceneBuilder>());
    SceneBuilder& b = *keep.back();
    QuietDiag d;
    if (separate) {
        for (int i = 0; i < count; ++i) {
            const float x = float(i % 400), y = float(i / 400);
            b.scene.primitives.push_back(SceneBuilder::polygons(
                {1}, {4}, {0, 1, 2, 3}, {x, y, 9, x, y + 1, 9, x + 1, y + 1, 9, x + 1, y, 9}));
        }
    }
    return b.world(d.diag);
}

} // namespace

int main() {
    SceneBuilder b;
    std::vector<float> xyz;
    std::vector<std::int32_t> index;
    wavy_grid(grid, xyz, index);
    const std::size_t triangles = index.size() / 3;
    b.add(SceneBuilder::polygons(std::vector<std::int32_t>(triangles, 1),
                                 std::vector<std::int32_t>(triangles, 3), index, xyz));
    QuietDiag d;
    const auto world = b.world(d.diag);
    std::printf("build     %zu triangles: %.2f s, %.1f bytes per triangle\n", triangles,
                world->stats().build_seconds, double(world->stats().bytes) / double(triangles));
    const auto small = many_polygons(100000, true);
    std::printf("build     100000 Polygon requests: %.2f s, %.0f bytes each\n",
                small->stats().build_seconds, double(small->stats().bytes) / 1e5);

    RTCDevice device = rtcNewDevice("threads=1");
    RTCScene scene = raw_scene(device, xyz, index);
    std::vector<RayPacket> packets = camera_rays();
    std::vector<Hit> hits(packets.size() * 8);
    double worst = 1e9;
    for (const char* what : {"camera", "bounce"}) {
        const bool coherent = what[0] == 'c';
        const double rays = double(hits.size()) / 1e6;
        const std::vector<double> t =
            seconds({raw_packets(scene, packets, coherent), raw_streams(scene, packets, coherent),
                     by_packet(*world, packets, hits), by_span(*world, packets, hits)});
        std::printf("%s    Mray/s: rtcIntersect8 %.2f, rtcIntersectNM %.2f, World packet %.2f, "
                    "World span %.2f\n",
                    what, rays / t[0], rays / t[1], rays / t[2], rays / t[3]);
        // Spans are for camera rays, packets for all others.
        worst = std::min(worst, t[0] / (coherent ? t[3] : t[2]));
        if (coherent) {
            const auto bit = [](int v) { return std::uint64_t(1) << v; };
            std::printf("fill      ns/point: Cs Os %.0f; P N I %.0f; P N I s t %.0f; P N I dPdu "
                        "dPdv u v s t du dv %.0f; with aux %.0f\n",
                        fill_ns(*world, packets, hits, bit(SL_VAR_Cs) | bit(SL_VAR_Os), false),
                        fill_ns(*world, packets, hits,
                                bit(SL_VAR_P) | bit(SL_VAR_N) | bit(SL_VAR_I), false),
                        fill_ns(*world, packets, hits,
                                bit(SL_VAR_P) | bit(SL_VAR_N) | bit(SL_VAR_I) | bit(SL_VAR_s) |
                                    bit(SL_VAR_t),
                                false),
                        fill_ns(*world, packets, hits, ~std::uint64_t(0), false),
                        fill_ns(*world, packets, hits, ~std::uint64_t(0), true));
            packets = bounce_rays(*world, packets, hits);
        }
    }

    SceneBuilder balls;
    for (int i = 0; i < 900; ++i) {
        balls.add(SceneBuilder::quadric(rib::QuadricKind::Sphere, {0.2, -0.2, 0.2, 360}),
                  Mat4::translate({0.35 * (i % 30) - 5, 0.35 * (i / 30) - 5, 6}));
    }
    const auto spheres = balls.world(d.diag);
    packets = camera_rays();
    const double t = seconds({by_span(*spheres, packets, hits)})[0];
    std::size_t count = 0;
    for (const Hit& hit : hits) {
        count += hit.valid();
    }
    std::printf("spheres   900 analytic: %.2f Mray/s, %.0f %% hits\n",
                double(hits.size()) / 1e6 / t, 100.0 * double(count) / double(hits.size()));
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
    std::printf("least ratio to rtcIntersect8: %.2f (limit %.2f)\n", worst, least_ratio);
    return worst < least_ratio ? 1 : 0;
}
