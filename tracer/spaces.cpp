// SPDX-License-Identifier: Apache-2.0
#include "tracer/spaces.h"

namespace trace {

std::optional<Space> Space::from(const base::Mat4& camera_from_space) {
    const std::optional<base::Mat4> inv = base::inverse(camera_from_space);
    return inv ? std::optional<Space>({camera_from_space, *inv}) : std::nullopt;
}

Spaces::Spaces(const rib::Scene& scene, const ProjectionMatrices& projection)
    : scene_(scene), time_(scene.options.shutter_open),
      camera_from_world_(scene.camera_from_world.at(scene.options.shutter_open)) {
    const auto add = [this](const std::string& name, const base::Mat4& camera_from_space) {
        if (const auto space = Space::from(camera_from_space)) {
            named_.insert_or_assign(name, *space);
        }
    };
    // Given the other way round: these are what the camera applies to points.
    const auto add_inverse = [this](const std::string& name, const base::Mat4& space_from_camera) {
        if (const auto camera_from_space = base::inverse(space_from_camera)) {
            named_.insert_or_assign(name, Space{*camera_from_space, space_from_camera});
        }
    };
    for (const auto& [name, transform] : scene.coordinate_systems) {
        add(name, camera_from(transform, false));
    }
    for (const rib::Attributes& attributes : scene.attributes) {
        for (const auto& [name, transform] : attributes.scoped_systems) {
            if (const auto space = Space::from(camera_from(transform, false))) {
                scoped_.emplace(transform, *space);
            }
        }
    }
    // The standard names come last: a user system of the same name does not hide them.
    for (const char* name : {"camera", "eye", "current"}) {
        add(name, base::Mat4{});
    }
    add("world", camera_from_world_);
    add_inverse("screen", projection.screen_from_camera);
    add_inverse("NDC", projection.ndc_from_screen * projection.screen_from_camera);
    add_inverse("raster", projection.raster_from_screen * projection.screen_from_camera);
}

const Space* Spaces::find(std::string_view name, const rib::Attributes* scoped) const {
    if (scoped != nullptr && !scoped->scoped_systems.empty()) {
        const auto system = scoped->scoped_systems.find(std::string(name));
        if (system != scoped->scoped_systems.end()) {
            const auto space = scoped_.find(system->second);
            return space == scoped_.end() ? nullptr : &space->second;
        }
    }
    const auto it = named_.find(name);
    return it == named_.end() ? nullptr : &it->second;
}

base::Mat4 Spaces::camera_from(rib::TransformId transform, bool in_camera_space) const {
    if (transform >= scene_.transforms.size()) {
        return in_camera_space ? base::Mat4{} : camera_from_world_;
    }
    const base::Mat4 m = scene_.transforms[transform].at(time_);
    return in_camera_space ? m : camera_from_world_ * m;
}

} // namespace trace
