// SPDX-License-Identifier: Apache-2.0
#include "geometry/shadow_segment.h"

#include <algorithm>
#include <cmath>

namespace geo {

namespace {

float largest(const base::V3f& v) {
    return std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
}

} // namespace

float far_end_error(const base::V3f& from, const base::V3f& direction) {
    constexpr float roundings = 8 * 0x1p-24f; // half units in the last place
    return roundings * (largest(from) + largest(direction));
}

ShadowSegment segment_to(const base::V3f& origin, const base::V3f& end) {
    const base::V3f d = end - origin;
    const float length = base::length(d);
    return {origin, d, length > 0 ? std::max(0.0f, 1 - far_end_error(origin, d) / length) : 0};
}

namespace {

base::V3f middle(const SpawnPoint& spawn) {
    return (spawn.front + spawn.back) * 0.5f;
}

// The place at `end`, moved off its surface towards a ray from there.
base::V3f end_seen_from(const base::V3f& origin, const SpawnPoint& end) {
    const base::V3f d = middle(end) - origin;
    const bool from_behind = base::dot(end.normal, d) > 0;
    const base::V3f out = from_behind ? -end.normal : end.normal;
    return (from_behind ? end.back : end.front) + out * far_end_error(origin, d);
}

} // namespace

ShadowSegment segment_to(const base::V3f& origin, const SpawnPoint& end) {
    return {origin, end_seen_from(origin, end) - origin, 1};
}

// The end decides the side: at grazing angles it may be another than that of the place itself.
ShadowSegment segment_between(const SpawnPoint& from, const SpawnPoint& end) {
    const base::V3f P = middle(from);
    return segment_to(from.towards(end_seen_from(P, end) - P), end);
}

ShadowSegment segment_between(const SpawnPoint& from, const base::V3f& end) {
    return segment_to(from.towards(end - middle(from)), end);
}

} // namespace geo
