// SPDX-License-Identifier: Apache-2.0
// Private to accel*.cpp: one Embree scene and the tables that turn its ids back into shapes.
#pragma once

#include "geometry/accel.h"

#include <embree3/rtcore.h>

#include <cstdint>
#include <deque>
#include <span>
#include <vector>

namespace geo::embree {

// Surfaces of one Embree geometry; geomID indexes Level::geometries.
struct Geometry {
    struct Member {
        std::uint32_t shape;
        std::uint32_t first; // primID of its part 0
        const Surface* surface;
        const Mat4* object_from_trace; // only where intersect() or refine() need it
        int cull;
    };
    TraceForm form = TraceForm::Triangles;
    std::vector<Member> members;
    std::vector<std::uint32_t>
        member_of;      // by primID; empty when there is one member, or one per primID
    int cull_trace = 0; // Triangles: sign of dot(Embree's Ng, direction) that is invisible
    bool refine = false;
    bool filters = false; // TraceItem::filters
    TraceBuffer buffer;   // what Embree reads stays here

    [[nodiscard]] const Member& member(std::uint32_t prim) const {
        return form == TraceForm::Analytic ? members[prim]
               : member_of.empty()         ? members.front()
                                           : members[member_of[prim]];
    }
};

struct Level {
    RTCScene scene = nullptr;
    std::deque<Geometry> geometries; // stable: Embree holds pointers
    std::deque<Mat4> matrices;
    std::uint64_t triangles = 0, analytic = 0, grids = 0;
    std::uint64_t filtering = 0; // TraceItem::filters
    double flatness_px = 0;

    [[nodiscard]] std::uint64_t bytes() const;
};

// A place a shadow ray passes, as Embree names it.
struct Crossing {
    float t, u, v;
    std::uint32_t geometry, part, instance;
    bool leaves; // the surface's own normal goes along the ray

    // What Embree tells twice: two parts that share the edge the ray goes through.
    [[nodiscard]] bool repeats(const Crossing& before) const;
};

// Occlusion queries: Embree hands the context to callbacks.
struct OcclusionContext {
    RTCIntersectContext embree; // first
    struct Ray {
        std::uint32_t count = 0;
        bool more = false;
        Crossing crossings[Crossings::most]; // by t
        void add(const Crossing& crossing);
    };
    Ray* rays = nullptr; // one per lane; null: nobody wants to know
};

// Creates the scene's geometries (uncommitted, so that instances can be added).
void build_level(RTCDevice device, const DiceContext& dice, std::span<const TraceItem> items,
                 Level& level);

// accel_callbacks.cpp
void analytic_bounds(const RTCBoundsFunctionArguments* args);
void analytic_intersect(const RTCIntersectFunctionNArguments* args);
void analytic_occluded(const RTCOccludedFunctionNArguments* args);
void shadow_filter(const RTCFilterFunctionNArguments* args);
void cull_filter(const RTCFilterFunctionNArguments* args);

} // namespace geo::embree
