// SPDX-License-Identifier: Apache-2.0
// Irradiance records and how they are interpolated [Ward88] [Ward92]. In: records in a canonical
// order. Out: the mean radiance over the hemisphere of a point near enough to some of them, by
// weights that fall to 0 where a record's error reaches what is tolerated. What insert() leaves
// depends on the order of the records alone; lookups change nothing and are safe from any thread.
#pragma once

#include "runtime/base/vec.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

namespace trace {

struct IrradianceRecord {
    base::V3f P, N; // N unit
    base::Color mean;
    // By channel: HemisphereSamples' IrradianceGradients, in the space of P.
    std::array<base::V3f, 3> rotation{}, translation{};
    float radius = 0;    // distance at which the error of a parallel surface is 1
    float max_error = 0; // tolerated where it was made: reaches max_error * radius
};
// Finite numbers, N of unit length, positive radius and error: what insert() takes.
[[nodiscard]] bool is_sound(const IrradianceRecord& record);

// The radius of a new record: harmonic mean distance, no more than the gradient allows (a change of
// all of it at most) and within the least and the greatest [Krivanek06].
[[nodiscard]] float record_radius(const IrradianceRecord& record, float harmonic_mean, float least,
                                  float greatest);
// Gradients that would change all of the light within the radius, or within a turn of a radian, say
// more about the few rays they come from than about the surface: they are cut to that.
void limit_gradients(IrradianceRecord& record);

class IrradianceCache {
public:
    // Records reach this much farther when a picture is rendered than when it is decided where new
    // ones are needed: between the points that were asked all are covered.
    static constexpr float slack = 1.4f;
    // And this much where they are one of many: where rays of other points hit. Their errors
    // cancel.
    static constexpr float far_slack = 3;

    struct Point {
        base::V3f P, N; // N unit
        float max_error;
    };
    // False, and nothing changed: the record is not sound. Its radius, and those of others near it,
    // shrink until no two records differ by more than their distance [Krivanek06].
    bool insert(const IrradianceRecord& record);

    // nullopt: no record is near enough. `stretch` multiplies the tolerated error.
    [[nodiscard]] std::optional<base::Color> lookup(const Point& point, float stretch = 1) const;
    [[nodiscard]] bool covers(const Point& point) const { return lookup(point).has_value(); }

    [[nodiscard]] std::span<const IrradianceRecord> records() const { return records_; }
    [[nodiscard]] bool empty() const { return records_.empty(); }
    [[nodiscard]] std::size_t memory_bytes() const;

private:
    // A cube of 2^level; a record stands in every cube that its reach touches, of a level where
    // those are at most eight.
    struct Cell {
        std::int32_t level = 0;
        std::int64_t x = 0, y = 0, z = 0;
        friend bool operator==(const Cell&, const Cell&) = default;
    };
    struct CellHash {
        std::size_t operator()(const Cell& cell) const;
    };
    [[nodiscard]] static Cell cell_of(const base::V3f& P, std::int32_t level);
    void put(std::uint32_t index);
    void clamp_radii(IrradianceRecord& record);
    template <class Visit> void visit_near(const base::V3f& P, Visit visit) const;

    std::vector<IrradianceRecord> records_;
    std::vector<std::int32_t> levels_; // that have cells, ascending
    std::unordered_map<Cell, std::vector<std::uint32_t>, CellHash> cells_;
};

} // namespace trace
