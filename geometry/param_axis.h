// SPDX-License-Identifier: Apache-2.0
// Where the vertices of a diced part lie along one parameter: runs of equal segments over [0, 1].
// Enters: needs, each "segments of [lo, hi] may be no longer than this", whose ends are dyadic
// (k / 2^n), so that mirrored ones are exact. Leaves: the coarsest such axis with a vertex at all
// those ends. Most axes are one run and hold no memory; those of parts that come near the eye have
// short segments there.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace geo {

class ParamAxis {
public:
    struct Need {
        double lo, hi, spacing;
        [[nodiscard]] Need mirrored() const { return {1 - hi, 1 - lo, spacing}; }
    };

    ParamAxis() = default; // one segment
    explicit ParamAxis(int segments) : segments_(segments) {}
    // Fulfils all needs with at most max_segments; more are spread thinner, evenly.
    static ParamAxis covering(std::span<const Need> needs, int max_segments);

    [[nodiscard]] int segments() const { return segments_; }
    // The parameter of vertex k, 0 <= k <= segments(); exactly 0 and 1 at the ends.
    [[nodiscard]] double vertex(int k) const;
    // The vertex nearest to a parameter.
    [[nodiscard]] int nearest(double parameter) const;
    // Position in [0, 1] over the vertices, equal steps from vertex to vertex, to parameter and
    // back; both go on beyond the ends.
    [[nodiscard]] double parameter(double position) const;
    [[nodiscard]] double position(double parameter) const;
    // Length of the segment at a parameter.
    [[nodiscard]] double spacing(double parameter) const;
    // Length of the longest segment that meets [lo, hi].
    [[nodiscard]] double longest_segment(double lo, double hi) const;
    // What another axis needs to have a vertex for each of this one's.
    void append_needs(std::vector<Need>& out) const;
    [[nodiscard]] std::size_t heap_bytes() const;

private:
    struct Run {
        double lo, hi;
        int first, segments; // first: vertex at lo
    };
    [[nodiscard]] Run whole() const { return {0, 1, 0, segments_}; }
    [[nodiscard]] Run run_of_vertex(double vertex) const;
    [[nodiscard]] Run run_of_parameter(double parameter) const;

    int segments_ = 1;
    std::shared_ptr<const std::vector<Run>> runs_; // null: one run
};

} // namespace geo
