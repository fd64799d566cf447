// SPDX-License-Identifier: Apache-2.0
// What a ray travels through: volumes inside and outside of surfaces (sl.md 5.1, 5.7; ri.md 6.6). A
// medium is a surface's Interior or Exterior, together with what it was entered from, so that rays
// come out of nested solids into the right one. Handles are small numbers of one thread: 0 is where
// cameras are. Crossing the same surface from the same medium gives the same handle.
#pragma once

#include "ribtools/scene.h"

#include <cstdint>
#include <unordered_map>
#include <vector>

namespace trace {

using MediumId = std::uint32_t;

class Media {
public:
    explicit Media(const rib::Scene& scene);

    // Where a ray is that leaves a surface of this attribute state, having come through `from`: on
    // the inside or on the side its normal points to. A surface with neither Interior nor Exterior
    // bounds nothing.
    [[nodiscard]] MediumId behind(MediumId from, std::uint32_t attributes, bool inside);

    // False: everything is one empty space.
    [[nodiscard]] bool any() const { return any_; }
    // The volume shader of a medium; rib::none: nothing is there, or (is_open) nobody has said.
    [[nodiscard]] rib::ShaderId volume(MediumId id) const { return all_[id].volume; }
    // The attribute state that says so; rib::none: the camera's.
    [[nodiscard]] std::uint32_t attributes(MediumId id) const { return all_[id].attributes; }
    // Outside of everything: camera rays are subject to the Atmosphere there.
    [[nodiscard]] bool is_open(MediumId id) const { return !all_[id].is_inside; }

private:
    // Solids within each other, at most; what lies farther out is forgotten.
    static constexpr std::uint32_t max_depth = 16;
    struct Medium {
        rib::ShaderId volume = rib::none;
        std::uint32_t attributes = rib::none;
        bool is_inside = false;
        rib::ShaderId solid = rib::none; // Interior of the innermost solid the ray is in
        MediumId outer = 0;              // what that was entered from
        std::uint32_t depth = 0;
        friend bool operator==(const Medium&, const Medium&) = default;
    };
    [[nodiscard]] Medium entered(MediumId from, std::uint32_t attributes) const;
    [[nodiscard]] Medium left(MediumId from, std::uint32_t attributes) const;
    // The medium within which the solid with this Interior was entered; no_medium: it was not.
    [[nodiscard]] MediumId find_solid(MediumId from, rib::ShaderId solid) const;
    [[nodiscard]] rib::ShaderId solid_of(std::uint32_t attributes) const;
    static constexpr MediumId no_medium = ~0U;

    const rib::Scene& scene_;
    bool any_ = false;
    std::vector<Medium> all_;
    std::unordered_map<std::uint64_t, MediumId> behind_; // by medium, attributes, side
};

} // namespace trace
