// SPDX-License-Identifier: Apache-2.0
// Ray queries through Embree: the only part of the project that names it (accel.cpp,
// accel_build.cpp). In: the surfaces of a level (the world, or one prototype), each with its
// transform into the level's trace space. Out: hits that name shape, part, instance and local
// parameters. Rays that are not finite never reach Embree, which does not check them itself in this
// build.
#pragma once

#include "geometry/hit.h"
#include "geometry/surface.h"

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace geo {

// One surface of a level.
struct TraceItem {
    std::uint32_t shape = no_id;
    Surface* surface = nullptr;
    Mat4 trace_from_object;
    Mat4 object_from_trace;
    std::uint32_t mask = 0; // RayMask
    int cull = 0;           // ObjectRay::cull
    bool filters = false;   // lets part of the light through to shadow rays
    double flatness = 1;    // share of the level's flatness, at most 1
};

// How the camera sees a level: see DiceContext.
struct LevelView {
    std::vector<Mat4> cam_from_trace{Mat4()};
    double far_px_per_unit = 0;
};

struct AccelStats {
    std::uint64_t triangles = 0, analytic = 0, grids = 0, instances = 0;
    std::uint64_t filtering = 0; // surfaces that let part of the light through
    std::uint64_t bytes = 0;
    std::uint64_t embree_bytes = 0; // of them
    double flatness_px = 0; // what diced surfaces keep; more than asked for only to save memory
};

class Accel {
public:
    explicit Accel(int num_threads, const View& view);
    ~Accel();
    Accel(const Accel&) = delete;
    Accel& operator=(const Accel&) = delete;

    // A level that instances can show; its trace space is its own.
    std::uint32_t add_prototype(std::span<const TraceItem> items, const LevelView& seen);
    // instance: what Hit::instance will say.
    // False, and nothing added, when its scale is beyond what Embree can carry rays through.
    [[nodiscard]] bool add_instance(std::uint32_t prototype, std::uint32_t instance,
                                    const Mat4& cam_from_trace);
    // The world's own surfaces; call once, last. Queries are allowed afterwards, from any thread.
    void finish(std::span<const TraceItem> items);

    void intersect(const RayPacket& rays, Hit* hits) const;
    void intersect(std::span<const RayPacket> packets, Hit* hits) const;
    // crossings may be null.
    [[nodiscard]] std::uint32_t occluded(const RayPacket& rays, Crossings* crossings) const;

    [[nodiscard]] AccelStats stats() const;
    // What Embree complained about, "" if nothing.
    [[nodiscard]] std::string error() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace geo
