// SPDX-License-Identifier: Apache-2.0
// Defaults of the Surface interface and its small helper types.
#include "geometry/surface.h"

#include <algorithm>

namespace geo {

void Box::add(const V3d& p) {
    for (int k = 0; k < 3; ++k) {
        lo[k] = std::min(lo[k], p[k]);
        hi[k] = std::max(hi[k], p[k]);
    }
}

void Box::add(const Box& b) {
    if (!b.empty()) {
        add(b.lo);
        add(b.hi);
    }
}

Box transformed(const Mat4& dst_from_src, const Box& box) {
    Box r;
    if (box.empty()) {
        return r;
    }
    for (int corner = 0; corner < 8; ++corner) {
        r.add(point(dst_from_src,
                    V3d((corner & 1) ? box.hi.x : box.lo.x, (corner & 2) ? box.hi.y : box.lo.y,
                        (corner & 4) ? box.hi.z : box.lo.z)));
    }
    return r;
}

void Stencil::add(std::uint32_t item, double weight) {
    if (count_ < inline_.size()) {
        inline_[count_++] = {item, weight};
    } else {
        overflow_.push_back({item, weight});
    }
}

void Stencil::scale(double factor) {
    for (std::size_t i = 0; i < count_; ++i) {
        inline_[i].weight *= factor;
    }
    for (Entry& e : overflow_) {
        e.weight *= factor;
    }
}

void Stencil::add_bilinear(const std::array<std::uint32_t, 4>& corners, double u, double v) {
    add(corners[0], (1 - u) * (1 - v));
    add(corners[1], u * (1 - v));
    add(corners[2], (1 - u) * v);
    add(corners[3], u * v);
}

void TraceBuffer::add_vertex(const V3d& p_trace) {
    for (int k = 0; k < 3; ++k) {
        xyz.push_back(static_cast<float>(p_trace[k]));
    }
}

std::uint64_t Surface::plan(const TraceContext&) {
    return 0;
}

void Surface::tessellate(const TraceContext&, TraceBuffer&) {}

bool Surface::intersect(const ObjectRay&, LocalHit&) const {
    return false;
}

void Surface::refine(const ObjectRay&, LocalHit&) const {}

TraceError Surface::trace_error(const LocalPoint&, const SurfacePoint& here) const {
    return {here.Ng, {}, 0};
}

bool Surface::corners(std::uint32_t, std::array<V3d, 3>&) const {
    return false;
}

LocalPoint Surface::step(const LocalPoint& at, double du, double dv) const {
    return {at.part, at.u + du, at.v + dv};
}

SurfacePoint Surface::difference(const LocalPoint& at, const SurfacePoint& here, double du,
                                 double dv) const {
    SurfacePoint d = evaluate(step(at, du, dv));
    d.u = du;
    d.v = dv;
    d.P = d.P - here.P;
    d.dPdu = d.dPdu - here.dPdu;
    d.dPdv = d.dPdv - here.dPdv;
    d.Ng = d.Ng - here.Ng;
    return d;
}

} // namespace geo
