// SPDX-License-Identifier: Apache-2.0
// What Embree calls back: bounds and roots of analytic surfaces, and culling of one-sided
// triangles.
#include "geometry/accel_level.h"

#include <algorithm>
#include <cmath>

namespace geo::embree {

namespace {

// Outwards by more than the error of Embree's float slabs at that distance.
float grown(double x, double direction) {
    constexpr double slack = 4 * 1.2e-7;
    return static_cast<float>(x + direction * (std::fabs(x) * slack + 1e-30));
}

ObjectRay object_ray(const Geometry::Member& member, RTCRayN* rays, unsigned n, unsigned i) {
    const V3d o(RTCRayN_org_x(rays, n, i), RTCRayN_org_y(rays, n, i), RTCRayN_org_z(rays, n, i));
    const V3d d(RTCRayN_dir_x(rays, n, i), RTCRayN_dir_y(rays, n, i), RTCRayN_dir_z(rays, n, i));
    const Mat4& m = *member.object_from_trace;
    return {point(m, o), vector(m, d), RTCRayN_tnear(rays, n, i), RTCRayN_tfar(rays, n, i), 0};
}

// A shadow ray on a surface that lets part of the light through; others are stopped there.
bool passes(const Geometry& g, RTCRayN* rays, unsigned n, unsigned i) {
    return g.filters && (RTCRayN_mask(rays, n, i) & ShadowRay) != 0;
}

OcclusionContext::Ray* record(const RTCIntersectContext* context, RTCRayN* rays, unsigned n,
                              unsigned i) {
    const auto* occlusion = reinterpret_cast<const OcclusionContext*>(context);
    return occlusion->rays != nullptr ? occlusion->rays + RTCRayN_id(rays, n, i) : nullptr;
}

// All places where the ray passes an analytic surface.
void add_crossings(const Geometry::Member& member, ObjectRay ray, Crossing crossing,
                   OcclusionContext::Ray& out) {
    LocalHit hit;
    while (member.surface->intersect(ray, hit)) {
        crossing.t = static_cast<float>(hit.t);
        crossing.u = static_cast<float>(hit.at.u);
        crossing.v = static_cast<float>(hit.at.v);
        crossing.leaves = dot(member.surface->evaluate(hit.at).Ng, ray.d) > 0;
        out.add(crossing);
        ray.tnear = std::nextafter(hit.t, std::numeric_limits<double>::infinity());
    }
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
        if (args->valid[i] != -1) {
            continue;
        }
        LocalHit hit;
        ObjectRay ray = object_ray(member, rays, n, i);
        ray.cull = member.cull;
        if (!member.surface->intersect(ray, hit)) {
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
    const unsigned n = args->N;
    for (unsigned i = 0; i < n; ++i) {
        if (args->valid[i] != -1) {
            continue;
        }
        const ObjectRay ray = object_ray(member, args->ray, n, i);
        if (passes(g, args->ray, n, i)) {
            if (auto* out = record(args->context, args->ray, n, i)) {
                add_crossings(
                    member, ray,
                    {0, 0, 0, args->geomID, args->primID, args->context->instID[0], false}, *out);
            }
            continue;
        }
        LocalHit hit;
        if (member.surface->intersect(ray, hit)) {
            RTCRayN_tfar(args->ray, n, i) = -std::numeric_limits<float>::infinity();
        }
    }
}

void shadow_filter(const RTCFilterFunctionNArguments* args) {
    const auto& g = *static_cast<const Geometry*>(args->geometryUserPtr);
    const unsigned n = args->N;
    for (unsigned i = 0; i < n; ++i) {
        if (args->valid[i] != -1 || !passes(g, args->ray, n, i)) {
            continue;
        }
        args->valid[i] = 0;
        if (auto* out = record(args->context, args->ray, n, i)) {
            const V3f Ng(RTCHitN_Ng_x(args->hit, n, i), RTCHitN_Ng_y(args->hit, n, i),
                         RTCHitN_Ng_z(args->hit, n, i));
            const V3f d(RTCRayN_dir_x(args->ray, n, i), RTCRayN_dir_y(args->ray, n, i),
                        RTCRayN_dir_z(args->ray, n, i));
            out->add({RTCRayN_tfar(args->ray, n, i), RTCHitN_u(args->hit, n, i),
                      RTCHitN_v(args->hit, n, i), RTCHitN_geomID(args->hit, n, i),
                      RTCHitN_primID(args->hit, n, i), RTCHitN_instID(args->hit, n, i, 0),
                      dot(Ng, d) > 0});
        }
    }
}

bool Crossing::repeats(const Crossing& before) const {
    constexpr float roundings = 8 * 1.2e-7f;
    return geometry == before.geometry && instance == before.instance && leaves == before.leaves &&
           std::fabs(t - before.t) <= roundings * std::fabs(t);
}

// Kept by t; the farthest goes when there are too many.
void OcclusionContext::Ray::add(const Crossing& crossing) {
    std::uint32_t at = count;
    while (at > 0 && crossings[at - 1].t > crossing.t) {
        --at;
    }
    if (at == Crossings::most) {
        more = true;
        return;
    }
    more = more || count == Crossings::most;
    count = std::min<std::uint32_t>(count + 1, Crossings::most);
    std::copy_backward(crossings + at, crossings + count - 1, crossings + count);
    crossings[at] = crossing;
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
