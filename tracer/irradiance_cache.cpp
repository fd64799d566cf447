// SPDX-License-Identifier: Apache-2.0
#include "tracer/irradiance_cache.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace trace {

namespace {

bool is_finite(const base::V3f& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool is_finite(const std::array<base::V3f, 3>& vectors) {
    return std::ranges::all_of(vectors, [](const base::V3f& v) { return is_finite(v); });
}

float largest(const std::array<base::V3f, 3>& gradient) {
    return std::max(
        {base::length(gradient[0]), base::length(gradient[1]), base::length(gradient[2])});
}

constexpr float unit_tolerance = 1e-3f;
constexpr float farthest = 1e15f; // cells are counted in 64 bits
constexpr float smallest = 1e-15f;

// [Ward88] eq. 5: what a record is worth elsewhere, by distance and by the turn of the normal.
float error_of(const IrradianceRecord& record, const base::V3f& offset, const base::V3f& N) {
    const float turn = std::sqrt(std::max(1 - base::dot(record.N, N), 0.0f));
    return base::length(offset) / record.radius + turn;
}

// Points clearly in front of the record's surface see what it does not ([Ward88] section 2.2).
bool is_in_front(const IrradianceRecord& record, const base::V3f& offset, const base::V3f& N) {
    constexpr float in_front = -0.05f;
    return 0.5f * base::dot(offset, record.N + N) < in_front * record.radius;
}

base::Color extrapolate(const IrradianceRecord& record, const base::V3f& offset,
                        const base::V3f& N) {
    const base::V3f turn = base::cross(record.N, N);
    const auto channel = [&](float mean, std::size_t k) {
        return std::max(mean + base::dot(turn, record.rotation[k]) +
                            base::dot(offset, record.translation[k]),
                        0.0f);
    };
    return {channel(record.mean.r, 0), channel(record.mean.g, 1), channel(record.mean.b, 2)};
}

} // namespace

bool is_sound(const IrradianceRecord& r) {
    const bool is_unit = std::fabs(base::dot(r.N, r.N) - 1) < unit_tolerance;
    const bool is_near =
        std::fabs(r.P.x) < farthest && std::fabs(r.P.y) < farthest && std::fabs(r.P.z) < farthest;
    const bool is_light = std::isfinite(r.mean.r) && std::isfinite(r.mean.g) &&
                          std::isfinite(r.mean.b) && r.mean.r >= 0 && r.mean.g >= 0 &&
                          r.mean.b >= 0;
    return is_unit && is_near && is_light && is_finite(r.rotation) && is_finite(r.translation) &&
           r.radius > smallest && r.radius < farthest && r.max_error > 1e-3f && r.max_error <= 10;
}

float record_radius(const IrradianceRecord& record, float harmonic_mean, float least,
                    float greatest) {
    const float gradient = largest(record.translation);
    const float mean = std::max({record.mean.r, record.mean.g, record.mean.b});
    const float by_gradient =
        gradient > 0 ? mean / gradient : std::numeric_limits<float>::infinity();
    return std::clamp(std::min(harmonic_mean, by_gradient), least, std::max(least, greatest));
}

namespace {

void cut(std::array<base::V3f, 3>& gradient, float longest) {
    const float length = largest(gradient);
    for (base::V3f& g : gradient) {
        g *= length > longest ? longest / length : 1;
    }
}

} // namespace

void limit_gradients(IrradianceRecord& record) {
    const float mean = std::max({record.mean.r, record.mean.g, record.mean.b});
    cut(record.translation, mean / record.radius);
    cut(record.rotation, mean);
}

std::size_t IrradianceCache::CellHash::operator()(const Cell& cell) const {
    std::uint64_t h = static_cast<std::uint64_t>(cell.x) * 0x9e3779b97f4a7c15ULL;
    h = (h ^ static_cast<std::uint64_t>(cell.y)) * 0xbf58476d1ce4e5b9ULL;
    h = (h ^ static_cast<std::uint64_t>(cell.z)) * 0x94d049bb133111ebULL;
    h ^= static_cast<std::uint64_t>(static_cast<std::uint32_t>(cell.level)) << 32;
    return static_cast<std::size_t>(h ^ h >> 29);
}

IrradianceCache::Cell IrradianceCache::cell_of(const base::V3f& P, std::int32_t level) {
    const auto along = [level](float x) {
        const double cells = std::floor(std::ldexp(static_cast<double>(x), -level));
        return static_cast<std::int64_t>(std::clamp(cells, -0x1p62, 0x1p62));
    };
    return {level, along(P.x), along(P.y), along(P.z)};
}

template <class Visit> void IrradianceCache::visit_near(const base::V3f& P, Visit visit) const {
    for (const std::int32_t level : levels_) {
        const auto it = cells_.find(cell_of(P, level));
        if (it == cells_.end()) {
            continue;
        }
        for (const std::uint32_t index : it->second) {
            visit(index);
        }
    }
}

// Cubes at least twice as wide as the reach: at most two of them along each axis.
void IrradianceCache::put(std::uint32_t index) {
    const IrradianceRecord& record = records_[index];
    const float reach = far_slack * record.max_error * record.radius;
    const std::int32_t level = static_cast<std::int32_t>(std::ceil(std::log2(2 * reach)));
    const Cell low = cell_of(record.P - base::V3f(reach), level);
    const Cell high = cell_of(record.P + base::V3f(reach), level);
    for (std::int64_t x = low.x; x <= high.x; ++x) {
        for (std::int64_t y = low.y; y <= high.y; ++y) {
            for (std::int64_t z = low.z; z <= high.z; ++z) {
                cells_[{level, x, y, z}].push_back(index);
            }
        }
    }
    const auto at = std::ranges::lower_bound(levels_, level);
    if (at == levels_.end() || *at != level) {
        levels_.insert(at, level);
    }
}

// A record that misses a small thing near it learns of it from its neighbour. Radii only shrink:
// the cells a record stands in stay right.
void IrradianceCache::clamp_radii(IrradianceRecord& record) {
    visit_near(record.P, [&](std::uint32_t index) {
        const float apart = base::length(records_[index].P - record.P);
        record.radius = std::min(record.radius, records_[index].radius + apart);
    });
    visit_near(record.P, [&](std::uint32_t index) {
        const float apart = base::length(records_[index].P - record.P);
        records_[index].radius = std::min(records_[index].radius, record.radius + apart);
    });
}

bool IrradianceCache::insert(const IrradianceRecord& record) {
    if (!is_sound(record) || records_.size() >= std::numeric_limits<std::uint32_t>::max()) {
        return false;
    }
    IrradianceRecord clamped = record;
    clamp_radii(clamped);
    records_.push_back(clamped);
    put(static_cast<std::uint32_t>(records_.size() - 1));
    return true;
}

std::optional<base::Color> IrradianceCache::lookup(const Point& point, float stretch) const {
    base::Color sum;
    float weights = 0;
    visit_near(point.P, [&](std::uint32_t index) {
        const IrradianceRecord& record = records_[index];
        const base::V3f offset = point.P - record.P;
        const float tolerated = stretch * std::min(point.max_error, record.max_error);
        const float error = error_of(record, offset, point.N);
        if (!(error < tolerated) || is_in_front(record, offset, point.N)) {
            return;
        }
        constexpr float least_error = 1e-4f; // a record asked about its own point
        const float weight = 1 / std::max(error, least_error) - 1 / tolerated;
        sum += extrapolate(record, offset, point.N) * weight;
        weights += weight;
    });
    return weights > 0 ? std::optional(sum * (1 / weights)) : std::nullopt;
}

std::size_t IrradianceCache::memory_bytes() const {
    std::size_t bytes = records_.capacity() * sizeof(IrradianceRecord);
    for (const auto& [cell, list] : cells_) {
        bytes += sizeof(cell) + sizeof(list) + list.capacity() * sizeof(std::uint32_t);
    }
    return bytes;
}

} // namespace trace
