// SPDX-License-Identifier: Apache-2.0
// The World: shapes, Embree's hierarchies and the fill function behind the interface of world.h.
#include "geometry/world.h"

#include "geometry/accel.h"
#include "geometry/area_set.h"
#include "geometry/instance.h"
#include "geometry/shade_point.h"
#include "geometry/shapes.h"

#include <chrono>

namespace geo {

namespace {

class WorldImpl final : public World {
public:
    WorldImpl(const rib::Scene& scene, const BuildOptions& options, base::Diag& diag)
        : options_(options), accel_(options.num_threads, options.view) {
        const auto start = std::chrono::steady_clock::now();
        table_ = collect_shapes(scene, options, diag);
        add_instances(table_, options.view, accel_, diag);
        accel_.finish(trace_items(table_, table_.world, no_id));
        if (const std::string error = accel_.error(); !error.empty()) {
            diag.report(base::Severity::Severe, base::Code::System, {}, "Embree: " + error);
        }
        if (const double flatness = accel_.stats().flatness_px;
            flatness > DiceContext().flatness_px) {
            diag.report(base::Severity::Warning, base::Code::Limit, {},
                        "curved surfaces would need too much memory; they keep within " +
                            std::to_string(flatness) + " pixels of their true shape");
        }
        const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
        count(spent.count());
    }

    void intersect(const RayPacket& rays, Hit* hits) const override {
        accel_.intersect(rays, hits);
    }
    void intersect(std::span<const RayPacket> packets, Hit* hits) const override {
        accel_.intersect(packets, hits);
    }
    [[nodiscard]] std::uint32_t occluded(const RayPacket& rays) const override {
        return accel_.occluded(rays, nullptr);
    }
    [[nodiscard]] std::uint32_t occluded(const RayPacket& rays,
                                         Crossings& crossings) const override {
        return accel_.occluded(rays, &crossings);
    }
    [[nodiscard]] bool filters_light() const override { return filters_light_; }
    [[nodiscard]] ShadowMode shadow_mode(const Hit& hit) const override {
        return table_.shadow_mode(table_.shapes[hit.shape],
                                  table_.attribute_id(hit.shape, hit.instance));
    }

    [[nodiscard]] Binding binding(const Hit& hit) const override {
        const Shape& shape = table_.shapes[hit.shape];
        return {table_.attribute_id(hit.shape, hit.instance), shape.primitive, shape.object,
                table_.transform_key(hit)};
    }

    void fill(std::span<const Hit> hits, const Incident& incident, std::uint64_t needed,
              std::uint32_t stride, const sl_points& out, const sl_points* aux_u,
              const sl_points* aux_v) const override {
        fill_points(table_,
                    {hits, incident, needed, stride, out, aux_u, aux_v, options_.view.perspective});
    }

    [[nodiscard]] const rib::Param* primitive_variable(const Hit& hit,
                                                       std::string_view name) const override {
        const Shape& shape = table_.shapes[hit.shape];
        const rib::Param* param = shape.source->params.find(name);
        return param && (param->decl.type == rib::ParamType::String ||
                         is_usable(*param, *shape.surface))
                   ? param
                   : nullptr;
    }

    void fill_primitive_variable(std::span<const Hit> hits, std::string_view name,
                                 std::uint32_t stride, float* out) const override {
        const rib::Param* param = hits.empty() ? nullptr : primitive_variable(hits.front(), name);
        if (param && param->decl.type != rib::ParamType::String) {
            fill_variable(table_, hits, *param, stride, out);
        }
    }

    void fill_primitive_differences(std::span<const Hit> hits, std::string_view name,
                                    const AuxiliaryPlanes& planes) const override {
        const rib::Param* param = hits.empty() ? nullptr : primitive_variable(hits.front(), name);
        if (param && param->decl.type != rib::ParamType::String) {
            fill_variable_differences(table_, hits, *param, planes);
        }
    }

    [[nodiscard]] V3f spawn_origin(const Hit& hit, const V3f& direction) const override {
        return spawn_points(table_, hit).towards(direction);
    }
    [[nodiscard]] SpawnPoint spawn(const Hit& hit) const override {
        return spawn_points(table_, hit);
    }
    [[nodiscard]] std::unique_ptr<const AreaSet>
    area_set(std::span<const std::uint32_t> primitives) const override {
        return make_area_set(table_, primitives);
    }
    [[nodiscard]] Mat4 camera_from_object(const Hit& hit, float) const override {
        return table_.cam_from_object(hit);
    }
    [[nodiscard]] const Stats& stats() const override { return stats_; }

private:
    BuildOptions options_;
    ShapeTable table_;
    Accel accel_;
    bool filters_light_ = false;
    Stats stats_;

    void count(double seconds) {
        const AccelStats a = accel_.stats();
        filters_light_ = a.filtering > 0;
        stats_.shapes = table_.shapes.size();
        stats_.triangles = a.triangles;
        stats_.quadrics = a.analytic;
        stats_.grids = a.grids;
        stats_.instances = a.instances;
        stats_.embree_bytes = a.embree_bytes;
        stats_.bytes = a.bytes + table_.shapes.capacity() * sizeof(Shape) +
                       table_.placements.capacity() * sizeof(Placement) +
                       table_.instances.capacity() * sizeof(InstanceRecord);
        for (const Shape& shape : table_.shapes) {
            stats_.bytes += shape.surface->heap_bytes();
        }
        stats_.build_seconds = seconds;
    }
};

} // namespace

World::~World() = default;

std::uint32_t World::occluded(const RayPacket& rays, Crossings& crossings) const {
    crossings = {};
    return occluded(rays);
}

SpawnPoint World::spawn(const Hit& hit) const {
    const V3f along(0, 0, 1);
    return {along, spawn_origin(hit, along), spawn_origin(hit, -along)};
}

std::unique_ptr<const AreaSet> World::area_set(std::span<const std::uint32_t>) const {
    return nullptr;
}

std::unique_ptr<World> World::build(const rib::Scene& scene, const BuildOptions& options,
                                    base::Diag& diag) {
    return std::make_unique<WorldImpl>(scene, options, diag);
}

} // namespace geo
