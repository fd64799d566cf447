// SPDX-License-Identifier: Apache-2.0
// Transforms at a time and attribute lookup.
#include "ribtools/scene.h"

#include <algorithm>

namespace rib {

base::Mat4 Transform::at(float time) const {
    if (time <= keys.front().time || keys.size() == 1) {
        return keys.front().m;
    }
    if (time >= keys.back().time) {
        return keys.back().m;
    }
    const auto next = std::upper_bound(keys.begin(), keys.end(), time,
                                       [](float t, const Key& key) { return t < key.time; });
    const Key& a = *(next - 1);
    const Key& b = *next;
    const double weight = static_cast<double>((time - a.time) / (b.time - a.time));
    base::Mat4 m;
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j) {
            m.m[i][j] = a.m.m[i][j] * (1 - weight) + b.m.m[i][j] * weight;
        }
    }
    return m;
}

const Param* Attributes::find(const std::string& group_name) const {
    const auto it = user.find(group_name);
    return it == user.end() ? nullptr : &it->second;
}

} // namespace rib
