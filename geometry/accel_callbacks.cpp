// SPDX-License-Identifier: Apache-2.0
// What Embree calls back: bounds and roots of analytic surfaces, and culling of one-sided
// triangles.
#include "geometry/accel_level.h"

#include <cmath>

namespace geo::embree {

namespace {

// Outwards by more than the error of Embree's float slabs at that distance.
float grown(double x, double direction) {
    constexpr double slack = 4 * 1.2e-7;
    return static_cast<float>(x + direction * (std::fabs(x) * slack + 1e-30));
}

bool meets(const Geometry::Member& member, RTCRayN* rays, unsigned n, unsigned i, bool may_cull,
           LocalHit& hit) {
    const V3d o(RTCRayN_org_x(rays, n, i), RTCRayN_org_y(rays, n, i), RTCRayN_org_z(rays, n, i));
    const V3d d(RTCRayN_dir_x(rays, n, i), RTCRayN_dir_y(rays, n, i), RTCRayN_dir_z(rays, n, i));
    const Mat4& m = *member.object_from_trace;
    const ObjectRay ray{point(m, o), vector(m, d), RTCRayN_tnear(rays, n, i),
                        RTCRayN_tfar(rays, n, i), may_cull ? member.cull : 0};
    return member.surface->intersect(ray, hit);
}

} // namespace

void analytic_bounds(const RTCBoundsFunctionArguments* args) {
    const auto& g = *static_cast<const Geometry*>(args->geometryUserPtr);
    const Geometry::Member& member = g.members[args->primID];
    const auto trace_from_object = base::inverse(*member.object_from_trace);
    const Box box = member.surface->bound(trace_from_object ? *trace_from_object : Mat4());
    RTCBounds& out = *args->bounds_o;
    out.lower_x = grown(box.lo.x, -1);
    out.lower_y = grown(box.lo.y, -1);
    out.lower_z = grown(box.lo.z, -1);
    out.upper_x = grown(box.hi.x, +1);
    out.upper_y = grown(box.hi.y, +1);
    out.upper_z = grown(box.hi.z, +1);
}

void analytic_intersect(const RTCIntersectFunctionNArguments* args) {
    const auto& g = *static_cast<const Geometry*>(args->geometryUserPtr);
    const Geometry::Member& member = g.members[args->primID];
    RTCRayN* rays = RTCRayHitN_RayN(args->rayhit, args->N);
    RTCHitN* hits = RTCRayHitN_HitN(args->rayhit, args->N);
    const unsigned n = args->N;
    for (unsigned i = 0; i < n; ++i) {
        LocalHit hit;
        if (args->valid[i] != -1 || !meets(member, rays, n, i, true, hit)) {
            continue;
        }
        RTCRayN_tfar(rays, n, i) = static_cast<float>(hit.t);
        RTCHitN_u(hits, n, i) = static_cast<float>(hit.at.u);
        RTCHitN_v(hits, n, i) = static_cast<float>(hit.at.v);
        RTCHitN_primID(hits, n, i) = args->primID;
        RTCHitN_geomID(hits, n, i) = args->geomID;
        RTCHitN_instID(hits, n, i, 0) = args->context->instID[0];
    }
}

// One-sided surfaces cast shadows from both sides: culling is for eyes, matter stops light
// (geo-006).
void analytic_occluded(const RTCOccludedFunctionNArguments* args) {
    const auto& g = *static_cast<const Geometry*>(args->geometryUserPtr);
    const Geometry::Member& member = g.members[args->primID];
    for (unsigned i = 0; i < args->N; ++i) {
        LocalHit hit;
        if (args->valid[i] == -1 && meets(member, args->ray, args->N, i, false, hit)) {
            RTCRayN_tfar(args->ray, args->N, i) = -std::numeric_limits<float>::infinity();
        }
    }
}

void cull_filter(const RTCFilterFunctionNArguments* args) {
    const auto& g = *static_cast<const Geometry*>(args->geometryUserPtr);
    const unsigned n = args->N;
    for (unsigned i = 0; i < n; ++i) {
        if (args->valid[i] != -1) {
            continue;
        }
        const V3f Ng(RTCHitN_Ng_x(args->hit, n, i), RTCHitN_Ng_y(args->hit, n, i),
                     RTCHitN_Ng_z(args->hit, n, i));
        const V3f d(RTCRayN_dir_x(args->ray, n, i), RTCRayN_dir_y(args->ray, n, i),
                    RTCRayN_dir_z(args->ray, n, i));
        if (!(static_cast<float>(g.cull_trace) * dot(Ng, d) < 0)) {
            args->valid[i] = 0;
        }
    }
}

} // namespace geo::embree
