// SPDX-License-Identifier: Apache-2.0
#include "tracer/ray_options.h"

#include <algorithm>

namespace trace {

namespace {

constexpr int default_max_level = 4;
// What the machine's stack holds with room to spare: each level is a few frames.
constexpr int deepest = 128;
constexpr int no_limit = deepest;

int int_of(const rib::Param* param, int fallback) {
    if (param == nullptr) {
        return fallback;
    }
    const double value = !param->ints.empty()     ? param->ints.front()
                         : !param->floats.empty() ? static_cast<double>(param->floats.front())
                                                  : fallback;
    return value >= 0 ? static_cast<int>(std::min<double>(value, deepest)) : 0;
}

const rib::Param* find(const rib::Options& options, const char* key) {
    const auto it = options.user.find(key);
    return it == options.user.end() ? nullptr : &it->second;
}

} // namespace

RayOptions::RayOptions(const rib::Scene& scene)
    : max_level_(int_of(find(scene.options, "render:max_raylevel"),
                        int_of(find(scene.options, "trace:maxdepth"), default_max_level))) {
    const auto limits = [](const rib::Attributes& a) {
        return Depths{int_of(a.find("trace:maxspeculardepth"), no_limit),
                      int_of(a.find("trace:maxdiffusedepth"), no_limit)};
    };
    for (const rib::Attributes& attributes : scene.attributes) {
        of_attributes_.push_back(limits(attributes));
    }
    if (std::ranges::all_of(of_attributes_, [](const Depths& d) {
            return d.specular == no_limit && d.diffuse == no_limit;
        })) {
        of_attributes_.clear();
    }
}

bool RayOptions::allows(std::uint32_t attributes, int level, int diffuse_level) const {
    if (level > max_level_) {
        return false;
    }
    if (attributes >= of_attributes_.size()) {
        return true;
    }
    const Depths& depths = of_attributes_[attributes];
    return level - diffuse_level <= depths.specular && diffuse_level <= depths.diffuse;
}

} // namespace trace
