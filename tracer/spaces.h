// SPDX-License-Identifier: Apache-2.0
// Named coordinate systems of a frame (sl.md 5.9). In: the scene and the camera's projection. Out:
// for a name, the matrices to and from camera space, which is "current" space. "object" and
// "shader" depend on what is being shaded and are given by the caller. Immutable; composed in
// double, moving systems taken at shutter open.
#pragma once

#include "ribtools/scene.h"
#include "runtime/base/mat.h"

#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>

namespace trace {

// A transform with its inverse. Systems that cannot be inverted are left out when they are made.
struct Space {
    base::Mat4 camera_from_space;
    base::Mat4 space_from_camera;

    static std::optional<Space> from(const base::Mat4& camera_from_space);
    [[nodiscard]] base::V3d point_to_camera(const base::V3d& p) const {
        return base::point(camera_from_space, p);
    }
    [[nodiscard]] base::V3d vector_to_camera(const base::V3d& v) const {
        return base::vector(camera_from_space, v);
    }
    [[nodiscard]] base::V3d normal_to_camera(const base::V3d& n) const {
        return base::normal_by_inverse(space_from_camera, n);
    }
};

// What the camera does to points: screen is the image plane plus z in 0..1 between the clipping
// distances.
struct ProjectionMatrices {
    base::Mat4 screen_from_camera;
    base::Mat4 ndc_from_screen;
    base::Mat4 raster_from_screen;
};

class Spaces {
public:
    Spaces(const rib::Scene& scene, const ProjectionMatrices& projection);

    // camera (eye, current), world, screen, NDC, raster and the systems of CoordinateSystem.
    // scoped: attribute state whose ScopedCoordinateSystem names come first, or nullptr. nullptr:
    // no such system.
    [[nodiscard]] const Space* find(std::string_view name,
                                    const rib::Attributes* scoped = nullptr) const;

    // Space of a shader call (in_camera_space: made before WorldBegin), or of any other transform
    // of the scene.
    [[nodiscard]] base::Mat4 camera_from(rib::TransformId transform, bool in_camera_space) const;
    [[nodiscard]] const base::Mat4& camera_from_world() const { return camera_from_world_; }
    [[nodiscard]] float shutter_open() const { return time_; }

private:
    struct Hash {
        using is_transparent = void;
        std::size_t operator()(std::string_view text) const {
            return std::hash<std::string_view>{}(text);
        }
    };
    const rib::Scene& scene_;
    float time_;
    base::Mat4 camera_from_world_;
    std::unordered_map<std::string, Space, Hash, std::equal_to<>> named_;
    std::unordered_map<rib::TransformId, Space> scoped_;
};

} // namespace trace
