// SPDX-License-Identifier: Apache-2.0
// From rib::Scene to drawable shapes: surfaces, placements, instances. Everything that cannot be
// drawn is reported here, once, and left out; what is in the tables is sound. Order follows the
// scene, so ids are deterministic.
#pragma once

#include "geometry/primvar.h"
#include "geometry/surface.h"
#include "geometry/world.h"
#include "ribtools/scene.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace geo {

// An affine, invertible transform with its inverse.
struct Placement {
    Mat4 parent_from_object;
    Mat4 object_from_parent;
};
// nullopt for perspective, singular and non-finite matrices. Divides by a constant w.
[[nodiscard]] std::optional<Placement> make_placement(const Mat4& parent_from_object);

// One primitive that is drawn, in the world or in an object.
struct Shape {
    std::unique_ptr<Surface> surface;
    const rib::Primitive* source = nullptr;
    std::uint32_t primitive = no_id; // index into Scene::primitives or Object::primitives
    std::uint32_t object = no_id;
    std::uint32_t placement = no_id; // camera (or object definition) from object
    StandardVars vars;
};

// How much light a shape lets pass to shadow rays, by its attributes (ri.md 14.3).
[[nodiscard]] ShadowMode shadow_mode(const rib::Attributes& attributes);

// The shapes and placements of one rib::Object, or of the world.
struct ShapeGroup {
    std::uint32_t first_shape = 0, num_shapes = 0;
    std::uint32_t first_placement = 0, num_placements = 0;
    V3d centre; // of an object: origin of its trace space, in its own definition space
};

struct InstanceRecord {
    bool drawn = false;
    Placement cam_from_definition;
    std::uint32_t first_key =
        0; // transform keys of its members: first_key + placement - group.first_placement
};

struct ShapeTable {
    const rib::Scene* scene = nullptr;
    std::vector<Shape> shapes;
    std::vector<Placement> placements;
    ShapeGroup world;
    std::vector<ShapeGroup> objects;       // as Scene::objects
    std::vector<InstanceRecord> instances; // as Scene::instances
    std::vector<ShadowMode> shadow_modes;  // by attribute state; shapes() decide with their own Os

    // Of a shape with these attributes: Os and Shader only where they can let light through.
    [[nodiscard]] ShadowMode shadow_mode(const Shape& shape, std::uint32_t attributes) const;

    [[nodiscard]] const rib::Attributes& attributes(const Hit& hit) const {
        return scene->attributes[attribute_id(hit.shape, hit.instance)];
    }
    [[nodiscard]] std::uint32_t attribute_id(std::uint32_t shape, std::uint32_t instance) const;
    [[nodiscard]] std::uint32_t transform_key(const Hit& hit) const;
    // Through both levels.
    [[nodiscard]] V3d cam_point(const Hit& hit, const V3d& P_object) const;
    [[nodiscard]] V3d cam_vector(const Hit& hit, const V3d& v_object) const;
    // By the inverse transpose: stays on the same side of the surface in mirrored spaces.
    [[nodiscard]] V3d cam_normal(const Hit& hit, const V3d& n_object) const;
    [[nodiscard]] Mat4 cam_from_object(const Hit& hit) const;
};

[[nodiscard]] ShapeTable collect_shapes(const rib::Scene& scene, const BuildOptions& options,
                                        base::Diag& diag);

// RayMask bits of the attributes "render" and "visibility".
[[nodiscard]] std::uint32_t visibility_mask(const rib::Attributes& attributes);
// Sides 1: the sign of dot(Ng, direction) that is invisible, for ObjectRay::cull; 0 for two sides.
[[nodiscard]] int cull_side(const rib::Attributes& attributes);

} // namespace geo
