// SPDX-License-Identifier: Apache-2.0
#include "tracer/media.h"

#include <algorithm>

namespace trace {

namespace {

bool bounds_media(const rib::Attributes& surface) {
    return surface.interior != rib::none || surface.exterior != rib::none;
}

} // namespace

Media::Media(const rib::Scene& scene) : scene_(scene) {
    Medium& open = all_.emplace_back();
    open.volume = scene.camera_exterior;
    any_ = open.volume != rib::none || std::ranges::any_of(scene.attributes, bounds_media);
}

// Calls with equal parameters are one: exporters repeat them surface by surface.
rib::ShaderId Media::solid_of(std::uint32_t attributes) const {
    const rib::ShaderId interior = scene_.attributes[attributes].interior;
    const rib::ShaderId same =
        interior < scene_.shaders.size() ? scene_.shaders[interior].same_params_as : rib::none;
    return same != rib::none ? same : interior;
}

MediumId Media::find_solid(MediumId from, rib::ShaderId solid) const {
    for (MediumId id = from; all_[id].is_inside; id = all_[id].outer) {
        if (all_[id].solid == solid) {
            return id;
        }
    }
    return no_medium;
}

// A ray that stays inside (total reflection) keeps what it was entered from.
Media::Medium Media::entered(MediumId from, std::uint32_t attributes) const {
    const rib::ShaderId solid = solid_of(attributes);
    const MediumId known = find_solid(from, solid);
    Medium medium{scene_.attributes[attributes].interior,
                  attributes,
                  true,
                  solid,
                  from,
                  all_[from].depth + 1};
    if (known != no_medium) {
        medium.outer = all_[known].outer;
        medium.depth = all_[known].depth;
    } else if (all_[from].depth >= max_depth) {
        medium.outer = 0;
        medium.depth = 1;
    }
    return medium;
}

Media::Medium Media::left(MediumId from, std::uint32_t attributes) const {
    const rib::Attributes& surface = scene_.attributes[attributes];
    const MediumId known = find_solid(from, solid_of(attributes));
    Medium medium = all_[known != no_medium ? all_[known].outer : from];
    if (surface.exterior != rib::none) {
        medium.volume = surface.exterior;
        medium.attributes = attributes;
    }
    return medium;
}

MediumId Media::behind(MediumId from, std::uint32_t attributes, bool inside) {
    if (!bounds_media(scene_.attributes[attributes])) {
        return from;
    }
    const std::uint64_t key =
        std::uint64_t{from} << 33 | std::uint64_t{attributes} << 1 | (inside ? 1U : 0U);
    const auto found = behind_.find(key);
    if (found != behind_.end()) {
        return found->second;
    }
    const Medium medium = inside ? entered(from, attributes) : left(from, attributes);
    MediumId id = 0;
    while (id < all_.size() && !(all_[id] == medium)) {
        ++id;
    }
    if (id == all_.size()) {
        all_.push_back(medium);
    }
    behind_.emplace(key, id);
    return id;
}

} // namespace trace
