// SPDX-License-Identifier: Apache-2.0
#include "geometry/instance.h"

#include <map>
#include <utility>

namespace geo {

namespace {

// What Embree must know about a member besides its shape: the same for all instances of a
// prototype.
using Signature = std::vector<std::pair<std::uint32_t, int>>;

Signature signature(const ShapeTable& table, const ShapeGroup& group, std::uint32_t instance) {
    Signature s;
    for (std::uint32_t i = group.first_shape; i < group.first_shape + group.num_shapes; ++i) {
        const rib::Attributes& a = table.scene->attributes[table.attribute_id(i, instance)];
        s.emplace_back(visibility_mask(a), cull_side(a));
    }
    return s;
}

Box group_box(const ShapeTable& table, const ShapeGroup& group) {
    Box box;
    for (std::uint32_t i = group.first_shape; i < group.first_shape + group.num_shapes; ++i) {
        const Shape& shape = table.shapes[i];
        box.add(shape.surface->bound(table.placements[shape.placement].parent_from_object));
    }
    return box;
}

} // namespace

std::vector<TraceItem> trace_items(const ShapeTable& table, const ShapeGroup& group,
                                   std::uint32_t instance, std::span<const Mat4> cam_from_parent) {
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
        item.mask = visibility_mask(a);
        item.cull = cull_side(a);
        item.parent_from_object = placement.parent_from_object;
        item.cam_from_parent = cam_from_parent;
        item.shading_rate = a.shading_rate;
        if (item.mask != 0) {
            items.push_back(item);
        }
    }
    return items;
}

void add_instances(ShapeTable& table, Accel& accel, base::Diag& diag) {
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
    std::vector<bool> centred(table.objects.size());
    for (std::uint32_t i = 0; i < instances.size(); ++i) {
        if (!table.instances[i].drawn) {
            continue;
        }
        const std::uint32_t object = instances[i].object;
        ShapeGroup& group = table.objects[object];
        if (!centred[object]) {
            group.centre = group_box(table, group).center();
            centred[object] = true;
        }
        const auto [it, is_new] = prototypes.try_emplace({object, signature(table, group, i)}, 0);
        if (is_new) {
            it->second = accel.add_prototype(trace_items(table, group, i, placements[object]));
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
