// SPDX-License-Identifier: Apache-2.0
#include "geometry/instance.h"

#include <algorithm>
#include <cmath>
#include <compare>
#include <map>
#include <utility>

namespace geo {

namespace {

// What Embree must know about a member besides its shape: the same for all instances of a
// prototype.
struct Facts {
    std::uint32_t mask;
    int cull;
    bool filters;
    friend auto operator<=>(const Facts&, const Facts&) = default;
};
using Signature = std::vector<Facts>;

Facts facts(const ShapeTable& table, std::uint32_t shape, std::uint32_t instance) {
    const std::uint32_t id = table.attribute_id(shape, instance);
    const rib::Attributes& a = table.scene->attributes[id];
    const ShadowMode mode = table.shadow_mode(table.shapes[shape], id);
    const std::uint32_t unseen = mode == ShadowMode::None ? std::uint32_t{ShadowRay} : 0;
    return {visibility_mask(a) & ~unseen, cull_side(a),
            mode == ShadowMode::Os || mode == ShadowMode::Shader};
}

Signature signature(const ShapeTable& table, const ShapeGroup& group, std::uint32_t instance) {
    Signature s;
    for (std::uint32_t i = group.first_shape; i < group.first_shape + group.num_shapes; ++i) {
        s.push_back(facts(table, i, instance));
    }
    return s;
}

// Upper bound of the largest stretch of a linear map, exact for rotations and uniform scales: from
// mean m and spread s of the eigenvalues of A A^T, m + s sqrt(2) [Wolkowicz80].
double largest_stretch(const Mat4& map) {
    double trace = 0, squares = 0;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            double sum = 0;
            for (int k = 0; k < 3; ++k) {
                sum += map.m[i][k] * map.m[j][k];
            }
            trace += i == j ? sum : 0;
            squares += sum * sum;
        }
    }
    const double mean = trace / 3, variance = std::max(squares / 3 - mean * mean, 0.0);
    return std::sqrt(mean + std::sqrt(2 * variance));
}

Box group_box(const ShapeTable& table, const ShapeGroup& group) {
    Box box;
    for (std::uint32_t i = group.first_shape; i < group.first_shape + group.num_shapes; ++i) {
        const Shape& shape = table.shapes[i];
        box.add(shape.surface->bound(table.placements[shape.placement].parent_from_object));
    }
    return box;
}

// GeometricApproximation "flatness", in pixels: finer than usual if it says so.
double flatness_share(const rib::Attributes& a) {
    constexpr double least_px = 0.001;
    const auto flatness = a.approximation->find("flatness");
    return flatness == a.approximation->end() ? 1.0
                                              : std::clamp(static_cast<double>(flatness->second),
                                                           least_px, DiceContext().flatness_px) /
                                                    DiceContext().flatness_px;
}

} // namespace

std::vector<TraceItem> trace_items(const ShapeTable& table, const ShapeGroup& group,
                                   std::uint32_t instance) {
    const Mat4 trace_from_parent = Mat4::translate(-group.centre);
    const Mat4 parent_from_trace = Mat4::translate(group.centre);
    std::vector<TraceItem> items;
    items.reserve(group.num_shapes);
    for (std::uint32_t i = group.first_shape; i < group.first_shape + group.num_shapes; ++i) {
        const Shape& shape = table.shapes[i];
        const Placement& placement = table.placements[shape.placement];
        const rib::Attributes& a = table.scene->attributes[table.attribute_id(i, instance)];
        TraceItem item;
        item.shape = i;
        item.surface = shape.surface.get();
        item.trace_from_object = trace_from_parent * placement.parent_from_object;
        item.object_from_trace = placement.object_from_parent * parent_from_trace;
        const auto [mask, cull, filters] = facts(table, i, instance);
        item.mask = mask;
        item.cull = cull;
        item.filters = filters && (mask & ShadowRay) != 0;
        item.flatness = flatness_share(a);
        if (item.mask != 0) {
            items.push_back(item);
        }
    }
    return items;
}

LevelView level_view(const Box& box, std::vector<Mat4> cam_from_trace, const View& view) {
    constexpr std::size_t most_near = 256;
    struct Near {
        double distance;
        std::size_t index;
        double px_per_unit; // stands in where there are too many
    };
    LevelView seen{{}, 0};
    std::vector<Near> near;
    for (std::size_t i = 0; i < cam_from_trace.size(); ++i) {
        const Box b = transformed(cam_from_trace[i], box);
        const Distances d = distances(b.lo, b.hi, view);
        const double stretch = largest_stretch(cam_from_trace[i]);
        if (d.is_even()) {
            seen.far_px_per_unit =
                std::max(seen.far_px_per_unit, stretch * pixels_per_unit(b.lo, b.hi, view));
        } else {
            View floored = view;
            floored.near_clip = std::max(view.near_clip, 0.05 * length(b.hi - b.lo));
            near.push_back({d.nearest, i, stretch * pixels_per_unit(b.lo, b.hi, floored)});
        }
    }
    std::stable_sort(near.begin(), near.end(),
                     [](const Near& a, const Near& b) { return a.distance < b.distance; });
    for (std::size_t k = 0; k < near.size(); ++k) {
        if (k < most_near) {
            seen.cam_from_trace.push_back(cam_from_trace[near[k].index]);
        } else {
            seen.far_px_per_unit = std::max(seen.far_px_per_unit, near[k].px_per_unit);
        }
    }
    return seen;
}

void add_instances(ShapeTable& table, const View& view, Accel& accel, base::Diag& diag) {
    const std::vector<rib::Instance>& instances = table.scene->instances;
    std::vector<std::vector<Mat4>> placements(
        table.objects.size()); // dicing looks at all of an object's
    for (std::uint32_t i = 0; i < instances.size(); ++i) {
        if (table.instances[i].drawn) {
            placements[instances[i].object].push_back(
                table.instances[i].cam_from_definition.parent_from_object);
        }
    }
    std::map<std::pair<std::uint32_t, Signature>, std::uint32_t> prototypes;
    std::vector<LevelView> seen(table.objects.size());
    std::vector<bool> centred(table.objects.size());
    for (std::uint32_t i = 0; i < instances.size(); ++i) {
        if (!table.instances[i].drawn) {
            continue;
        }
        const std::uint32_t object = instances[i].object;
        ShapeGroup& group = table.objects[object];
        if (!centred[object]) {
            centred[object] = true;
            Box box = group_box(table, group);
            group.centre = box.center();
            for (Mat4& m : placements[object]) {
                m = m * Mat4::translate(group.centre);
            }
            box.lo = box.lo - group.centre, box.hi = box.hi - group.centre;
            seen[object] = level_view(box, std::move(placements[object]), view);
        }
        const auto [it, is_new] = prototypes.try_emplace({object, signature(table, group, i)}, 0);
        if (is_new) {
            it->second = accel.add_prototype(trace_items(table, group, i), seen[object]);
        }
        const Mat4 cam_from_trace = table.instances[i].cam_from_definition.parent_from_object *
                                    Mat4::translate(group.centre);
        if (!accel.add_instance(it->second, i, cam_from_trace)) {
            diag.report(base::Severity::Error, base::Code::Range, instances[i].pos,
                        "ObjectInstance: its scale or place is beyond 1e9; left out");
        }
    }
}

} // namespace geo
