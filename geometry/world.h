// SPDX-License-Identifier: Apache-2.0
// The scene as rays see it: bounded surfaces in camera space, Embree's hierarchies over them, and
// the one function that turns hits into ShaderVariables. Immutable after build(); every const
// member may be called from any thread.
//
// Camera space is Perigee's "current" space: everything that enters or leaves is in it. Transforms
// are composed in double and rounded once; instances are stored about their own centre (design.md,
// section 6).
#pragma once

#include "geometry/hit.h"
#include "ribtools/scene.h"
#include "runtime/abi/sl_abi.h"
#include "runtime/base/diag.h"
#include "runtime/base/mat.h"

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace geo {

// What dicing and detail need to know about the camera.
struct View {
    bool perspective = true;
    // Raster pixels per unit of camera x (y) at z = 1 (perspective) or anywhere (orthographic).
    double pixels_per_unit_x = 1, pixels_per_unit_y = 1;
    double near_clip = 1e-10;
    // Largest |x| and |y| of the picture, at z = 1 (perspective) or anywhere (orthographic).
    double corner_x = 1, corner_y = 1;
};

struct BuildOptions {
    View view;
    float time = 0;      // where still pictures of moving things are taken: shutter open
    int num_threads = 0; // 0: all
    // By attribute state: the surface shader may change the opacity. Empty: all may.
    std::vector<bool> shades_opacity;
};

// What a surface point belongs to, besides its position.
struct Binding {
    std::uint32_t attributes; // index into Scene::attributes
    std::uint32_t primitive;  // index into Scene::primitives, or into the object's
    std::uint32_t object;     // index into Scene::objects, or no_id
    std::uint32_t
        transform_key; // equal for equal object spaces: the batching key of SL_FACT_object_space
};

// The incident side of a batch of hits: origins and directions of the rays that found them, camera
// space.
struct Incident {
    std::span<const float> ox, oy, oz, dx, dy, dz;
    // Distance on the surface, perpendicular to the ray, to the next shading sample; per hit. For
    // du and dv.
    std::span<const float> footprint;
    // Share of that distance by which neighbouring rays have drawn apart since their origins: 1
    // where they come from one point, 0 where they are parallel, other values behind mirrors. For
    // differences of I; empty: rays of the camera.
    std::span<const float> widening = {};
};

struct Stats {
    std::uint64_t shapes = 0, triangles = 0, quadrics = 0, grids = 0, instances = 0;
    std::uint64_t bytes = 0; // Embree's and ours
    std::uint64_t embree_bytes = 0;
    double build_seconds = 0;
};

// Where differences of a primitive variable go: steps per hit, planes of stride floats; a NULL base
// is skipped.
struct AuxiliaryPlanes {
    const float *du, *dv;
    std::uint32_t stride;
    float *out_u, *out_v;
};

// Where rays that leave a hit may start: to either side of the surface, outside its rounding error.
struct SpawnPoint {
    base::V3f normal; // of what is traced there, unit
    base::V3f front, back;
    [[nodiscard]] const base::V3f& towards(const base::V3f& direction) const {
        return base::dot(normal, direction) < 0 ? back : front;
    }
};

class AreaSet;

class World {
public:
    // Reports degenerate geometry and leaves it out. scene must outlive the World.
    static std::unique_ptr<World> build(const rib::Scene& scene, const BuildOptions& options,
                                        base::Diag& diag);
    virtual ~World();

    // Closest hit per active ray; hits[i].shape = no_id where nothing was hit. Sides, visibility
    // bits applied.
    virtual void intersect(const RayPacket& rays, Hit* hits) const = 0;
    // The same for any number of rays that lie near each other (a bucket of camera rays); fastest
    // path.
    virtual void intersect(std::span<const RayPacket> packets, Hit* hits) const = 0;
    // Bit i: something opaque lies on ray i between tnear and tfar. To shadow rays, what lets part
    // of the light through is not opaque; to others it is.
    [[nodiscard]] virtual std::uint32_t occluded(const RayPacket& rays) const = 0;
    // The same for shadow rays, with all that lets part of the light through, up to
    // Crossings::most per ray. What they hold of blocked rays means nothing.
    [[nodiscard]] virtual std::uint32_t occluded(const RayPacket& rays, Crossings& crossings) const;
    // Some shape lets part of the light through: else occluded(rays) says all.
    [[nodiscard]] virtual bool filters_light() const { return false; }
    [[nodiscard]] virtual ShadowMode shadow_mode(const Hit&) const { return ShadowMode::Opaque; }

    [[nodiscard]] virtual Binding binding(const Hit& hit) const = 0;

    // Fills the variables in `needed` (bits of sl_variable that geometry owns: P N Ng I E dPdu dPdv
    // u v du dv s t Cs Os time dPdtime) for hits.size() <= SL_BATCH_MAX points. Planes as in
    // sl_abi.h; NULL pointers are skipped. If aux_u, aux_v are given, they receive the
    // *differences* to the auxiliary points (design.md, section 5).
    virtual void fill(std::span<const Hit> hits, const Incident& incident, std::uint64_t needed,
                      std::uint32_t stride, const sl_points& out, const sl_points* aux_u,
                      const sl_points* aux_v) const = 0;

    // A primitive variable that overrides a shader parameter, camera space for P, V, N. Finds it by
    // name and type for the shape of this hit; nullptr if it has none.
    [[nodiscard]] virtual const rib::Param* primitive_variable(const Hit& hit,
                                                               std::string_view name) const = 0;
    // Its value at the hits (all of one shape): planes of stride floats, array elements one after
    // another.
    virtual void fill_primitive_variable(std::span<const Hit> hits, std::string_view name,
                                         std::uint32_t stride, float* out) const = 0;
    // Its differences to the auxiliary points of the steps that fill() gave.
    virtual void fill_primitive_differences(std::span<const Hit> hits, std::string_view name,
                                            const AuxiliaryPlanes& planes) const = 0;

    // Where a ray leaving the hit may start without meeting the surface again: P moved along Ng
    // towards direction by a bound of the rounding errors of P. [pbrt4] 6.8; no global epsilon.
    [[nodiscard]] virtual base::V3f spawn_origin(const Hit& hit,
                                                 const base::V3f& direction) const = 0;

    // The same for all directions.
    [[nodiscard]] virtual SpawnPoint spawn(const Hit& hit) const;

    // The surfaces of these primitives of the scene as one set to choose points from; null where
    // none has an area.
    [[nodiscard]] virtual std::unique_ptr<const AreaSet>
    area_set(std::span<const std::uint32_t> primitives) const;

    // Object space of a hit, at a time: for named coordinate systems.
    [[nodiscard]] virtual base::Mat4 camera_from_object(const Hit& hit, float time) const = 0;

    [[nodiscard]] virtual const Stats& stats() const = 0;
};

} // namespace geo
