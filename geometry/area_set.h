// SPDX-License-Identifier: Apache-2.0
// The surfaces of an area light as one set to choose points from. In: the primitives, later a point
// that is lit and numbers of [0,1)^2. Out: a place on a surface, as a Hit, and a weight such that
// the mean of weight * f over the numbers is the mean of f over the area, whichever way the place
// was chosen (design.md, section 7: a light is the mean of Cl over its surface). Neighbouring
// numbers give neighbouring places, so that strata stay strata. All in camera space; immutable.
#pragma once

#include "geometry/hit.h"
#include "runtime/base/vec.h"

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace geo {

struct ShapeTable;
class Surface;

struct AreaPoint {
    Hit hit;           // no shape: there is no such place
    double weight = 0; // (1 / area) / (density by area)
};

// A density over the unit square, linear between the nodes of a grid; exact inversion.
class GridDensity {
public:
    GridDensity() = default;
    // size x size nodes, row by row along x; negative values count as 0.
    GridDensity(std::size_t size, std::vector<double> values);

    [[nodiscard]] double integral() const { return total_; }
    // Moves (x, y) to where the density is; returns the density there, its integral being 1.
    double warp(double& x, double& y) const;
    [[nodiscard]] std::size_t bytes() const {
        return (nodes_.size() + along_.size() + rows_.size()) * sizeof(double);
    }

private:
    std::size_t size_ = 0;
    std::vector<double> nodes_;
    std::vector<double> along_; // per row: integral up to each node
    std::vector<double> rows_;  // integral of the rows up to each
    double total_ = 0;

    [[nodiscard]] double at(std::size_t ix, std::size_t iy) const {
        return nodes_[iy * size_ + ix];
    }
};

// Triangles and parallelograms are chosen from exactly, other surfaces by their area element at
// the nodes of a grid. By solid angle: one whole sphere, or a few flat elements.
class AreaSet {
public:
    AreaSet(const ShapeTable& table, std::span<const std::uint32_t> primitives);

    [[nodiscard]] double area() const { return area_; }
    [[nodiscard]] std::size_t num_elements() const { return elements_.size(); }
    // Uniform over the area.
    [[nodiscard]] AreaPoint by_area(double x, double y) const;

    // What the set looks like from a point.
    struct View {
        double solid_angle = 0; // 0: cannot be chosen from by solid angle
        double hidden = 0;      // share of the area that by_angle() never chooses
    };
    [[nodiscard]] View seen_from(const base::V3d& P) const;
    // Uniform over the solid angle from P, of a set with View::solid_angle.
    [[nodiscard]] AreaPoint by_angle(const base::V3d& P, double x, double y) const;
    // Uniform over the hidden part; both together are the mean.
    [[nodiscard]] AreaPoint by_hidden(const base::V3d& P, double x, double y) const;

private:
    enum class Kind : std::uint8_t { Triangle, Parallelogram, Sphere, Curved };
    struct Element {
        Kind kind = Kind::Curved;
        std::uint32_t shape = no_id, part = 0;
        double area = 0;
        std::array<base::V3d, 3> corner; // flat: corner, then edges; sphere: centre, {radius}
        bool is_rectangle = false;
        GridDensity density;
    };

    const ShapeTable& table_;
    std::vector<Element> elements_;
    std::vector<double> up_to_; // area of the elements up to each
    double area_ = 0;

    void add_shape(std::uint32_t shape);
    [[nodiscard]] bool add_flat(std::uint32_t shape);
    [[nodiscard]] bool add_sphere(std::uint32_t shape);
    void add_curved(std::uint32_t shape, std::uint32_t part, std::size_t size);
    void add(Element element);
    [[nodiscard]] double curved_area_element(const Element& e, double s, double t) const;
    [[nodiscard]] AreaPoint on_element(const Element& e, double x, double y) const;
    [[nodiscard]] static AreaPoint on_flat(const Element& e, double a, double b);
    [[nodiscard]] AreaPoint on_sphere(const Element& e, const base::V3d& from,
                                      const base::V3d& direction) const;
    [[nodiscard]] AreaPoint on_seen_sphere(const base::V3d& P, double x, double y) const;
    [[nodiscard]] AreaPoint towards(const Element& e, const base::V3d& direction,
                                    const base::V3d& P, double solid_angle) const;
};

// Null where nothing has an area.
[[nodiscard]] std::unique_ptr<const AreaSet>
make_area_set(const ShapeTable& table, std::span<const std::uint32_t> primitives);

} // namespace geo
