// SPDX-License-Identifier: Apache-2.0
// Which hits share batches: those of one shading class, behind one volume, told apart further where
// the class says so. In: hits. Out: groups_, each with its members in the order of the rays.
#include "tracer/hit_shader.h"
#include "tracer/ray_levels.h"

#include <cmath>

namespace trace {

std::size_t HitShader::KeyHash::operator()(const Key& key) const {
    constexpr auto mix = PixelHash::mix;
    return mix(key.shading_class ^ mix(key.a ^ mix(key.b ^ mix(key.medium))));
}

std::uint32_t HitShader::new_group(std::uint32_t shading_class, std::uint32_t attributes,
                                   MediumId medium) {
    groups_.push_back({shading_class, attributes, medium});
    return static_cast<std::uint32_t>(groups_.size() - 1);
}

std::uint32_t HitShader::keyed_group(const Key& key, std::uint32_t attributes) {
    const auto [it, is_new] = group_of_key_.emplace(key, 0);
    if (is_new) {
        it->second = new_group(key.shading_class, attributes, key.medium);
    }
    return it->second;
}

std::uint32_t HitShader::group_of(std::uint32_t hit_index) {
    const geo::Hit& hit = hits_[hit_index];
    const MediumId medium = medium_of(hit_index);
    const geo::Binding binding = frame_.world->binding(hit);
    const std::uint32_t shading_class = classes_.facts(binding.attributes).shading_class;
    const ShadingClass& c = classes_[shading_class];
    if (c.needs_key() || medium != 0) {
        Key key{shading_class, 0, geo::no_id, medium};
        if (!c.overrides.empty()) { // primitive variables are read shape by shape
            key.a = hit.shape;
            key.b = hit.instance;
        } else if (c.by_transform) {
            key.a = binding.transform_key;
        }
        return keyed_group(key, binding.attributes);
    }
    std::uint32_t& group = group_of_class_[shading_class];
    if (group == geo::no_id) {
        group = new_group(shading_class, binding.attributes, 0);
    }
    return group;
}

// Rays that end in a volume; no_id: there is none, or it has no end.
std::uint32_t HitShader::group_of_miss(std::uint32_t hit) {
    if (frame_.scene.camera_exterior == rib::none && rays_.media.empty()) {
        return geo::no_id;
    }
    const std::uint32_t ray = ray_of(hit);
    const bool is_active =
        (rays_.packets[ray / geo::RayPacket::size].active >> (ray % geo::RayPacket::size) & 1U) !=
        0;
    const MediumId medium = medium_of(hit);
    const Group group{geo::no_id, thread_.levels->media().attributes(medium), medium};
    if (!is_active || volume_of(group) == nullptr || !std::isfinite(far_end(ray))) {
        return geo::no_id;
    }
    return keyed_group({geo::no_id, 0, 0, medium}, group.attributes);
}

// Counting sort.
void HitShader::group_hits(std::span<const geo::Hit> hits) {
    for (const Group& group : groups_) {
        if (group.shading_class != geo::no_id) {
            group_of_class_[group.shading_class] = geo::no_id;
        }
    }
    groups_.clear();
    group_of_key_.clear();
    group_of_hit_.resize(hits.size());
    const geo::Hit* last = nullptr;
    MediumId last_medium = 0;
    std::uint32_t group = geo::no_id;
    for (std::uint32_t i = 0; i < hits.size(); ++i) {
        if (!hits[i].valid()) {
            group_of_hit_[i] = group_of_miss(i);
        } else {
            // Neighbouring rays mostly meet the same shape, whose parts bind alike.
            if (last == nullptr || last->shape != hits[i].shape ||
                last->instance != hits[i].instance || last_medium != medium_of(i)) {
                group = group_of(i);
                last = &hits[i];
                last_medium = medium_of(i);
            }
            group_of_hit_[i] = group;
        }
        if (group_of_hit_[i] != geo::no_id) {
            ++groups_[group_of_hit_[i]].count;
        }
    }
    list_members();
}

void HitShader::list_members() {
    std::uint32_t begin = 0;
    for (Group& g : groups_) {
        g.begin = begin;
        begin += g.count;
        g.count = 0;
    }
    members_.resize(begin);
    for (std::uint32_t i = 0; i < group_of_hit_.size(); ++i) {
        if (group_of_hit_[i] != geo::no_id) {
            Group& g = groups_[group_of_hit_[i]];
            members_[g.begin + g.count++] = i;
        }
    }
}

} // namespace trace
