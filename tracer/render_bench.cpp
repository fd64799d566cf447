// SPDX-License-Identifier: Apache-2.0
// How much of the bare ray tracer's speed is left when pictures are made: a million triangles under
// a constant shader and box filter, camera rays, one thread. In the same run: Embree alone on the
// same rays, the world's queries, and whole buckets (rays, hits, shades, film). Prints JSON. Goals
// (design.md 9): 0.8 of Embree, 0.65 with a gaussian filter.
#include "tracer/bucket.h"
#include "tracer/filter.h"
#include "tracer/test_world.h"

#include <embree3/rtcore.h>

#include <cmath>
#include <cstdio>
#include <ctime>
#include <functional>
#include <numbers>

namespace {

using namespace trace;

constexpr int resolution_px = 512;
constexpr int grid = 708; // 2 grid^2 = a million triangles

base::V3f bumpy_sphere(int i, int j) {
    const double u = 2 * std::numbers::pi * i / grid, v = std::numbers::pi * (j + 0.5) / (grid + 1);
    const double r = 1 + 0.05 * std::sin(9 * u) * std::sin(7 * v);
    return base::V3f(base::V3d(r * std::cos(u) * std::sin(v), r * std::cos(v),
                               3 + r * std::sin(u) * std::sin(v)));
}

// Triangles of the grid, closed around u.
void make_mesh(std::vector<float>& points, std::vector<std::int32_t>& vertices) {
    for (int j = 0; j <= grid; ++j) {
        for (int i = 0; i < grid; ++i) {
            const base::V3f P = bumpy_sphere(i, j);
            points.insert(points.end(), {P.x, P.y, P.z});
        }
    }
    for (int j = 0; j < grid; ++j) {
        for (int i = 0; i < grid; ++i) {
            const int a = j * grid + i, b = j * grid + (i + 1) % grid, c = a + grid, d = b + grid;
            vertices.insert(vertices.end(), {a, b, c, b, d, c});
        }
    }
}

rib::Scene make_scene() {
    rib::Scene scene;
    rib::Options& o = scene.options;
    o.xres = o.yres = resolution_px;
    o.xsamples = o.ysamples = 2;
    o.filter = "box";
    o.filter_width[0] = o.filter_width[1] = 1;
    o.projection = "perspective";
    o.fov_deg = 45;
    o.has_screen_window = true;
    o.screen_window = {-1, 1, -1, 1};
    scene.transforms.emplace_back();
    scene.shaders.emplace_back();
    scene.shaders.back().name = "flat";
    scene.attributes.emplace_back();
    scene.attributes.back().surface = 0;
    rib::Polygons mesh;
    rib::Param P;
    P.name = "P";
    P.decl = {rib::StorageClass::Vertex, rib::ParamType::Point, 1, false};
    make_mesh(P.floats, mesh.vertices);
    mesh.num_loops.assign(mesh.vertices.size() / 3, 1);
    mesh.num_vertices.assign(mesh.vertices.size() / 3, 3);
    rib::Primitive& primitive = scene.primitives.emplace_back();
    primitive.params.params.push_back(std::move(P));
    primitive.shape = std::move(mesh);
    return scene;
}

double cpu_seconds() { // of this thread: other work on the machine does not count
    timespec t = {};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double seconds_of(const std::function<void()>& work) {
    double best = 1e30;
    for (int run = 0; run < 5; ++run) {
        const double start = cpu_seconds();
        work();
        best = std::min(best, cpu_seconds() - start);
    }
    return best;
}

RTCScene bare_scene(RTCDevice device, const rib::Scene& scene) {
    const auto& mesh = std::get<rib::Polygons>(scene.primitives[0].shape);
    const std::vector<float>& points = scene.primitives[0].params.params[0].floats;
    RTCScene bare = rtcNewScene(device);
    rtcSetSceneFlags(bare, RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* p = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, points.size() / 3));
    std::copy(points.begin(), points.end(), p);
    auto* v = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, mesh.vertices.size() / 3));
    std::copy(mesh.vertices.begin(), mesh.vertices.end(), v);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(bare, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(bare);
    return bare;
}

RTCRayHit8 query_of(const geo::RayPacket& rays) {
    RTCRayHit8 q = {};
    for (int i = 0; i < 8; ++i) {
        q.ray.org_x[i] = rays.ox[i], q.ray.org_y[i] = rays.oy[i], q.ray.org_z[i] = rays.oz[i];
        q.ray.dir_x[i] = rays.dx[i], q.ray.dir_y[i] = rays.dy[i], q.ray.dir_z[i] = rays.dz[i];
        q.ray.tnear[i] = rays.tnear[i], q.ray.tfar[i] = rays.tfar[i];
        q.ray.mask[i] = ~0U;
        q.hit.geomID[i] = q.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
    return q;
}

struct Setting {
    rib::Scene scene = make_scene();
    base::Diag diag;
    rt::StringTable strings;
    rt::ShaderLibrary library{{}, strings, diag};
    Camera camera{scene, diag};
    Spaces spaces{
        scene,
        {camera.screen_from_camera(), camera.ndc_from_screen(), camera.raster_from_screen()}};
    Sampler sampler{sampler_settings(scene.options, diag)};
    std::unique_ptr<geo::World> world = geo::World::build(scene, {camera.view(), 0, 0, {}}, diag);
};

std::unique_ptr<Film> new_film(Setting& s, const FilterWeights& weights) {
    return Film::create(s.camera.raster(), s.sampler, weights,
                        film_settings(s.scene.options, s.diag), s.diag);
}

// Whole buckets: rays, hits, shades, film.
double render_seconds(Setting& s, const FrameContext& frame, const ShadingClasses& classes,
                      const FilterWeights& weights) {
    return seconds_of([&] {
        const auto picture = new_film(s, weights);
        BucketRenderer renderer(frame, s.camera, s.sampler, classes, nullptr,
                                visibility_options(s.scene.options));
        for (std::size_t b = 0; b < picture->num_buckets(); ++b) {
            if (!renderer.render(b, *picture)) {
                return; // interrupted
            }
        }
    });
}

} // namespace

int main() {
    Setting s;
    test::adopt_test_shaders(s.library);
    const ShaderSet shaders({s.scene, s.spaces, s.library, s.strings, s.diag});
    const LightSet lights(s.scene, shaders);
    const ShadingClasses classes(s.scene, shaders, lights);
    const FrameContext frame{s.scene,       s.spaces, s.strings, s.diag,
                             s.world.get(), &shaders, &lights};
    // The rays of all buckets, in the order they are rendered.
    std::vector<geo::RayPacket> packets;
    std::vector<RTCRayHit8> queries;
    SampleBlock block;
    const FilterWeights box(Filter("box", 1, 1, s.diag), s.sampler);
    const auto film = new_film(s, box);
    for (std::size_t b = 0; b < film->num_buckets(); ++b) {
        s.sampler.fill(film->sample_pixels(b), block);
        std::vector<geo::RayPacket> more(block.num_packets());
        s.camera.make_rays(block, more);
        packets.insert(packets.end(), more.begin(), more.end());
    }
    for (const geo::RayPacket& packet : packets) {
        queries.push_back(query_of(packet));
    }
    const double num_rays = 8 * static_cast<double>(packets.size());

    RTCDevice device = rtcNewDevice(nullptr);
    RTCScene bare = bare_scene(device, s.scene);
    const double bare_s = seconds_of([&] {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
        alignas(32) const int valid[8] = {-1, -1, -1, -1, -1, -1, -1, -1};
        for (const RTCRayHit8& query : queries) {
            RTCRayHit8 q = query;
            rtcIntersect8(valid, bare, &context, &q);
        }
    });
    std::vector<geo::Hit> hits(packets.size() * 8);
    const double world_s = seconds_of([&] { s.world->intersect(packets, hits.data()); });
    const auto print = [&](const char* name, double seconds, double goal) {
        std::printf(
            "{\"name\": \"constant shader, 1 M triangles, %s, of raw Embree\", \"value\": %.3f, "
            "\"unit\": \"ratio\", \"limit\": %.2f, \"better\": \"higher\", \"error\": \"same "
            "hits\", "
            "\"note\": \"%.1f of %.1f Mrays/s, one thread\"}\n",
            name, bare_s / seconds, goal, num_rays / seconds * 1e-6, num_rays / bare_s * 1e-6);
    };
    print("World::intersect", world_s, 0.8);
    print("render with box 1x1", render_seconds(s, frame, classes, box), 0.8);
    const FilterWeights gaussian(Filter("gaussian", 2, 2, s.diag), s.sampler);
    print("render with gaussian 2x2", render_seconds(s, frame, classes, gaussian), 0.65);
    rtcReleaseScene(bare);
    rtcReleaseDevice(device);
    return 0;
}
