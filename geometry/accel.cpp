// SPDX-License-Identifier: Apache-2.0
#include "geometry/accel.h"

#include "geometry/accel_level.h"
#include "runtime/base/lanes4.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <mutex>

namespace geo {

namespace {

constexpr float embree_limit = 1.8e18f;
// Instances that would push the limit of rays below this are left out.
constexpr double least_ray_limit = 1e9;

// Coordinates up to which points stay within embree_limit when transformed.
double source_limit(const Mat4& dst_from_src) {
    double limit = embree_limit;
    const auto& m = dst_from_src.m;
    for (int k = 0; k < 3; ++k) {
        const double row = std::fabs(m[0][k]) + std::fabs(m[1][k]) + std::fabs(m[2][k]);
        limit = std::min(limit, (0.5 * embree_limit - std::fabs(m[3][k])) / std::max(row, 0.5));
    }
    return limit;
}

} // namespace

struct Accel::Impl {
    RTCDevice device = nullptr;
    View view;
    embree::Level top;
    std::deque<embree::Level> prototypes;
    // By geomID in the top scene, from the first id behind top.geometries on.
    struct Placed {
        std::uint32_t prototype, instance;
        Mat4 trace_from_cam;
        RTCGeometry geometry;
    };
    std::vector<Placed> placed;
    // Largest coordinate of rays. Debian's Embree keeps its assertions: a ray beyond embree_limit,
    // in the world or in the space of an instance it is carried into, would end the program.
    float ray_limit = embree_limit;
    std::atomic<std::int64_t> embree_bytes{0};
    std::mutex error_mutex;
    std::string error;

    ~Impl() {
        for (const Placed& p : placed) {
            rtcReleaseGeometry(p.geometry);
        }
        for (const embree::Level& level : prototypes) {
            if (level.scene) {
                rtcReleaseScene(level.scene);
            }
        }
        if (top.scene) {
            rtcReleaseScene(top.scene);
        }
        if (device) {
            rtcReleaseDevice(device);
        }
    }

    static void on_error(void* self, RTCError, const char* text) {
        auto& impl = *static_cast<Impl*>(self);
        const std::lock_guard lock(impl.error_mutex);
        if (impl.error.empty()) {
            impl.error = text ? text : "unknown error";
        }
    }
    static bool on_memory(void* self, std::ptrdiff_t bytes, bool) {
        static_cast<Impl*>(self)->embree_bytes += bytes;
        return true;
    }

    // Inlined: as a call it costs camera rays a hundredth of their time.
    [[gnu::always_inline]] void to_hit(const RTCRay8& ray, int i, const embree::Crossing& met,
                                       Hit& hit) const;
    void refine(const embree::Geometry::Member& member, const Mat4* trace_from_cam,
                const RTCRay8& ray, int i, Hit& hit) const;
    void to_crossings(const RTCRay8& rays, const embree::OcclusionContext::Ray* met,
                      Crossings& out) const;
};

namespace {

constexpr int lanes = RayPacket::size;

// RayPacket's arrays are aligned for reading four lanes at a time.
using base::Float4, base::Int4;
constexpr int group = 4;

// One int per lane, -1 = trace it: origin and direction finite and within limit, a direction at
// all, an interval. Comparisons with NaN are false, so NaN fails.
void valid_rays(const RayPacket& r, float limit, int* valid) {
    const Int4 bits = {1, 2, 4, 8};
    for (int first = 0; first < lanes; first += group) {
        const auto at = [first](const float* values) -> const Float4& {
            return *reinterpret_cast<const Float4*>(values + first);
        };
        const auto within = [&](const float* values) {
            return (at(values) <= limit) & (at(values) >= -limit);
        };
        const Int4 bounded =
            within(r.ox) & within(r.oy) & within(r.oz) & within(r.dx) & within(r.dy) & within(r.dz);
        const Int4 moves = (at(r.dx) != 0) | (at(r.dy) != 0) | (at(r.dz) != 0);
        const Int4 interval = (at(r.tnear) <= at(r.tfar)) & (at(r.tfar) >= 0);
        const Int4 active = (bits & static_cast<int>(r.active >> first)) != 0;
        *reinterpret_cast<Int4*>(valid + first) = bounded & moves & interval & active;
    }
}

void load_rays(const RayPacket& r, RTCRay8& q) {
    static_assert(sizeof q.org_x == sizeof r.ox);
    std::memcpy(q.org_x, r.ox, sizeof r.ox);
    std::memcpy(q.org_y, r.oy, sizeof r.oy);
    std::memcpy(q.org_z, r.oz, sizeof r.oz);
    std::memcpy(q.dir_x, r.dx, sizeof r.dx);
    std::memcpy(q.dir_y, r.dy, sizeof r.dy);
    std::memcpy(q.dir_z, r.dz, sizeof r.dz);
    std::memcpy(q.tfar, r.tfar, sizeof r.tfar);
    std::memcpy(q.time, r.time, sizeof r.time);
    std::memcpy(q.mask, r.mask, sizeof r.mask);
    for (int i = 0; i < lanes; ++i) {
        q.tnear[i] = std::max(r.tnear[i], 0.0f);
        q.id[i] = static_cast<unsigned>(i);
        q.flags[i] = 0;
    }
}

void load_query(const RayPacket& r, RTCRayHit8& q) {
    load_rays(r, q.ray);
    std::fill_n(q.hit.geomID, lanes, RTC_INVALID_GEOMETRY_ID);
    std::fill_n(q.hit.instID[0], lanes, RTC_INVALID_GEOMETRY_ID);
}

} // namespace

Accel::Accel(int num_threads, const View& view) : impl_(std::make_unique<Impl>()) {
    const std::string config =
        num_threads > 0 ? "threads=" + std::to_string(num_threads) : std::string();
    impl_->view = view;
    impl_->device = rtcNewDevice(config.c_str());
    if (!impl_->device) { // out of memory: every ray misses, and error() says why
        impl_->error = "no device could be made";
        return;
    }
    rtcSetDeviceErrorFunction(impl_->device, Impl::on_error, impl_.get());
    rtcSetDeviceMemoryMonitorFunction(impl_->device, Impl::on_memory, impl_.get());
}

Accel::~Accel() = default;

std::uint32_t Accel::add_prototype(std::span<const TraceItem> items, const LevelView& seen) {
    embree::Level& level = impl_->prototypes.emplace_back();
    if (!impl_->device) {
        return 0;
    }
    embree::build_level(impl_->device,
                        {.view = impl_->view,
                         .cam_from_trace = seen.cam_from_trace,
                         .far_px_per_unit = seen.far_px_per_unit},
                        items, level);
    rtcCommitScene(level.scene);
    return static_cast<std::uint32_t>(impl_->prototypes.size() - 1);
}

bool Accel::add_instance(std::uint32_t prototype, std::uint32_t instance,
                         const Mat4& cam_from_trace) {
    const auto trace_from_cam = base::inverse(cam_from_trace);
    const double limit = trace_from_cam ? source_limit(*trace_from_cam) : 0;
    if (!impl_->device || !(limit >= least_ray_limit) || !(source_limit(cam_from_trace) >= 1)) {
        return false;
    }
    impl_->ray_limit = std::min(impl_->ray_limit, static_cast<float>(limit));
    RTCGeometry g = rtcNewGeometry(impl_->device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(g, impl_->prototypes[prototype].scene);
    float m[12]; // columns of Embree's p' = M p: our rows
    for (int i = 0; i < 4; ++i) {
        for (int k = 0; k < 3; ++k) {
            m[3 * i + k] = static_cast<float>(cam_from_trace.m[i][k]);
        }
    }
    rtcSetGeometryTransform(g, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, m);
    rtcSetGeometryMask(g, ~0u);
    rtcCommitGeometry(g);
    impl_->placed.push_back({prototype, instance, *trace_from_cam, g});
    return true;
}

void Accel::finish(std::span<const TraceItem> items) {
    if (!impl_->device) {
        return;
    }
    const Mat4 identity;
    embree::build_level(impl_->device,
                        {.view = impl_->view, .cam_from_trace = std::span(&identity, 1)}, items,
                        impl_->top);
    auto id = static_cast<unsigned>(impl_->top.geometries.size());
    for (const Impl::Placed& p : impl_->placed) {
        rtcAttachGeometryByID(impl_->top.scene, p.geometry, id++);
    }
    rtcCommitScene(impl_->top.scene);
}

// What Embree names, in our names; t of a miss means nothing.
inline void Accel::Impl::to_hit(const RTCRay8& ray, int i, const embree::Crossing& met,
                                Hit& hit) const {
    hit = Hit{};
    hit.time = ray.time[i];
    if (met.geometry == RTC_INVALID_GEOMETRY_ID) {
        return;
    }
    const embree::Level* level = &top;
    const Mat4* trace_from_cam = nullptr;
    if (met.instance != RTC_INVALID_GEOMETRY_ID) {
        const Placed& p = placed[met.instance - top.geometries.size()];
        level = &prototypes[p.prototype];
        trace_from_cam = &p.trace_from_cam;
        hit.instance = p.instance;
    }
    const embree::Geometry& g = level->geometries[met.geometry];
    const embree::Geometry::Member& member = g.member(met.part);
    hit.shape = member.shape;
    hit.part = met.part - member.first;
    hit.u = met.u;
    hit.v = met.v;
    hit.t = met.t;
    if (g.refine) {
        refine(member, trace_from_cam, ray, i, hit);
    }
}

void Accel::Impl::refine(const embree::Geometry::Member& member, const Mat4* trace_from_cam,
                         const RTCRay8& q, int i, Hit& hit) const {
    V3d o(q.org_x[i], q.org_y[i], q.org_z[i]);
    V3d d(q.dir_x[i], q.dir_y[i], q.dir_z[i]);
    if (trace_from_cam) {
        o = point(*trace_from_cam, o);
        d = vector(*trace_from_cam, d);
    }
    const ObjectRay ray{point(*member.object_from_trace, o), vector(*member.object_from_trace, d),
                        q.tnear[i], q.tfar[i], 0};
    LocalHit local{{hit.part, hit.u, hit.v}, hit.t};
    member.surface->refine(ray, local);
    hit.part = local.at.part;
    hit.u = static_cast<float>(local.at.u);
    hit.v = static_cast<float>(local.at.v);
    hit.t = static_cast<float>(local.t);
}

void Accel::Impl::to_crossings(const RTCRay8& rays, const embree::OcclusionContext::Ray* met,
                               Crossings& out) const {
    for (int i = 0; i < lanes; ++i) {
        const embree::OcclusionContext::Ray& of_ray = met[i];
        out.count[i] = 0;
        out.more |= (of_ray.more ? 1u : 0u) << i;
        for (std::uint32_t k = 0; k < of_ray.count; ++k) {
            if (k == 0 || !of_ray.crossings[k].repeats(of_ray.crossings[k - 1])) {
                to_hit(rays, i, of_ray.crossings[k], out.hits[i][out.count[i]++]);
            }
        }
    }
}

namespace {

embree::Crossing closest(const RTCRayHit8& q, int i) {
    return {q.ray.tfar[i],   q.hit.u[i],         q.hit.v[i], q.hit.geomID[i],
            q.hit.primID[i], q.hit.instID[0][i], false};
}

} // namespace

void Accel::intersect(const RayPacket& rays, Hit* hits) const {
    alignas(32) int valid[lanes];
    RTCRayHit8 q;
    RTCIntersectContext context;
    valid_rays(rays, impl_->ray_limit, valid);
    load_query(rays, q);
    rtcInitIntersectContext(&context);
    if (impl_->top.scene) {
        rtcIntersect8(valid, impl_->top.scene, &context, &q);
    }
    for (int i = 0; i < lanes; ++i) {
        impl_->to_hit(q.ray, i, closest(q, i), hits[i]);
    }
}

void Accel::intersect(std::span<const RayPacket> packets, Hit* hits) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    for (const RayPacket& rays : packets) {
        alignas(32) int valid[lanes];
        RTCRayHit8 q;
        valid_rays(rays, impl_->ray_limit, valid);
        load_query(rays, q);
        if (impl_->top.scene) {
            rtcIntersect8(valid, impl_->top.scene, &context, &q);
        }
        for (int i = 0; i < lanes; ++i) {
            impl_->to_hit(q.ray, i, closest(q, i), *hits++);
        }
    }
}

std::uint32_t Accel::occluded(const RayPacket& rays, Crossings* crossings) const {
    alignas(32) int valid[lanes];
    RTCRay8 q;
    embree::OcclusionContext context;
    embree::OcclusionContext::Ray met[lanes];
    valid_rays(rays, impl_->ray_limit, valid);
    load_rays(rays, q);
    rtcInitIntersectContext(&context.embree);
    context.rays = crossings != nullptr ? met : nullptr;
    if (impl_->top.scene) {
        rtcOccluded8(valid, impl_->top.scene, &context.embree, &q);
    }
    std::uint32_t bits = 0;
    for (int i = 0; i < lanes; ++i) {
        bits |= (valid[i] == -1 && q.tfar[i] < 0 ? 1u : 0u) << i;
    }
    if (crossings != nullptr) {
        crossings->more = 0;
        load_rays(rays, q); // tfar as asked
        impl_->to_crossings(q, met, *crossings);
    }
    return bits;
}

AccelStats Accel::stats() const {
    AccelStats s;
    s.triangles = impl_->top.triangles;
    s.analytic = impl_->top.analytic;
    s.grids = impl_->top.grids;
    s.instances = impl_->placed.size();
    s.filtering = impl_->top.filtering;
    s.flatness_px = impl_->top.flatness_px;
    s.embree_bytes =
        static_cast<std::uint64_t>(std::max<std::int64_t>(impl_->embree_bytes.load(), 0));
    s.bytes = s.embree_bytes + impl_->top.bytes();
    for (const embree::Level& level : impl_->prototypes) {
        s.triangles += level.triangles;
        s.analytic += level.analytic;
        s.grids += level.grids;
        s.filtering += level.filtering;
        s.bytes += level.bytes();
        s.flatness_px = std::max(s.flatness_px, level.flatness_px);
    }
    return s;
}

std::string Accel::error() const {
    const std::lock_guard lock(impl_->error_mutex);
    return impl_->error;
}

} // namespace geo
