// SPDX-License-Identifier: Apache-2.0
// What the bodies of State share besides its header: saved states and object records. Included by
// state*.cpp only.
#pragma once

#include "ribtools/spelling.h"
#include "ribtools/state.h"

namespace rib {

// What a block puts back. Frames and worlds also put back the scene they began with and the handles
// made inside.
struct State::Saved {
    struct Stream {
        Options options;
        std::unique_ptr<Scene> scene;
        std::vector<std::shared_ptr<ObjectRecord>> objects;
        std::unordered_map<std::string, LightId> light_handles;
        std::unordered_map<std::string, std::uint32_t> object_handles;
        base::Mat4 screen_from_camera_extra;
        std::size_t num_archives = 0;
    };
    std::optional<Frozen<Attributes>> attributes;
    std::optional<Frozen<Transform>> transform;
    std::unique_ptr<Stream> stream;
    std::unique_ptr<std::unordered_map<std::string, Frozen<Attributes>>> resources;
    std::uint32_t edit = none;
    std::uint32_t solid = none;
};

// One attribute request inside an object; the chain of parents is what the object itself set for a
// primitive.
struct State::Edit {
    std::uint32_t parent = none;
    Request request;
    Transform definition_from_current;
};

struct State::ObjectRecord {
    struct Group { // primitives that get the same attributes at every instance
        std::uint32_t edit = none;
        Shared<Basis> basis; // these two belong to the geometry: always those of the definition
        Shared<TrimCurve> trim;
    };
    struct Child { // an instance inside an object
        std::uint32_t object = none;
        std::uint32_t edit = none;
        Transform definition_from_child;
        std::uint32_t solid = none;
    };
    std::vector<Edit> edits;
    std::vector<Group> groups;
    std::vector<std::uint32_t> group_of_primitive;
    std::vector<Primitive> primitives; // until ObjectEnd
    std::vector<Child> children;
};

// dst_from_mid * mid_from_src where either may move: keys at the times of both.
[[nodiscard]] Transform operator*(const Transform& dst_from_mid, const Transform& mid_from_src);
// Key by key; nullopt if one is singular.
[[nodiscard]] std::optional<Transform> inverse(const Transform& t);
[[nodiscard]] inline Transform still_transform(const base::Mat4& m) {
    return Transform{{Transform::Key{0, m}}};
}

// "'text'", made printable.
[[nodiscard]] inline std::string quoted(std::string_view text) {
    return "'" + printable(text) + "'";
}

} // namespace rib
