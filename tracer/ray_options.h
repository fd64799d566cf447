// SPDX-License-Identifier: Apache-2.0
// How deep rays of shaders go: Option "render" "max_raylevel" ("trace" "maxdepth"), and Attribute
// "trace" "maxspeculardepth" and "maxdiffusedepth" of the surface that asks. Immutable.
#pragma once

#include "ribtools/scene.h"

#include <cstdint>
#include <vector>

namespace trace {

class RayOptions {
public:
    explicit RayOptions(const rib::Scene& scene);

    // The deepest level that is traced; cameras' is 0.
    [[nodiscard]] int max_level() const { return max_level_; }
    // False: a ray of this level, with so many diffuse ones among those before, itself included, is
    // too deep for a surface of this attribute state (rib::none: for any).
    [[nodiscard]] bool allows(std::uint32_t attributes, int level, int diffuse_level) const;

private:
    struct Depths {
        int specular = 0, diffuse = 0;
    };
    int max_level_;
    std::vector<Depths> of_attributes_; // empty: nobody has set any
};

} // namespace trace
