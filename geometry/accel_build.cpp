// SPDX-License-Identifier: Apache-2.0
// Makes the Embree geometries of a level. Small meshes of equal mask and culling share one Embree
// mesh, so that a file of 100,000 Polygon requests does not become 100,000 geometries; all analytic
// surfaces of one mask share one user geometry. Vertex arrays are ours, shared with Embree.
#include "geometry/accel_level.h"

#include <cmath>
#include <map>
#include <tuple>

namespace geo::embree {

namespace {

// Meshes below this many parts are merged; groups are closed at the larger number to keep indices
// small.
constexpr std::size_t merge_below_parts = 4096;
constexpr std::size_t group_parts = std::size_t(1) << 22;
// Of all grids of a level: some 2 GB with Embree's tree.
constexpr std::uint64_t max_level_vertices = 48'000'000;

// Embree takes the shading order of the corners in trace space, where a mirroring transform turns
// it over.
int trace_cull(const TraceItem& item) {
    return base::determinant3(item.trace_from_object) < 0 ? -item.cull : item.cull;
}

class Builder {
public:
    Builder(RTCDevice device, const DiceContext& dice, Level& level)
        : device_(device), dice_(dice), level_(level) {}

    // Dicing at the flatness asked for, or as finely as memory allows: one flatness for all, so
    // that borders meet.
    void plan(std::span<const TraceItem> items) {
        level_.flatness_px = dice_.flatness_px;
        for (int attempt = 0; attempt < 8; ++attempt) {
            std::uint64_t vertices = 0;
            for (const TraceItem& item : items) {
                vertices += item.surface->plan(context(item));
            }
            if (vertices <= max_level_vertices) {
                break;
            }
            // Twice the segments, a quarter of the error.
            dice_.flatness_px *= 1.1 * double(vertices) / double(max_level_vertices);
            level_.flatness_px = dice_.flatness_px;
        }
    }

    void add(const TraceItem& item) {
        level_.filtering += item.filters ? 1 : 0;
        switch (item.surface->trace_form()) {
        case TraceForm::Analytic:
            add_analytic(item);
            break;
        case TraceForm::Triangles:
        case TraceForm::Grids:
            add_tessellated(item);
            break;
        }
    }

    void attach_all() {
        for (std::uint32_t id = 0; id < level_.geometries.size(); ++id) {
            Geometry& g = level_.geometries[id];
            RTCGeometry made = make(g);
            rtcSetGeometryMask(made, masks_[id]);
            rtcCommitGeometry(made);
            rtcAttachGeometryByID(level_.scene, made, id);
            rtcReleaseGeometry(made);
        }
    }

private:
    // form, mask, culling, refine, filters
    using Key = std::tuple<TraceForm, std::uint32_t, int, bool, bool>;

    RTCDevice device_;
    DiceContext dice_;
    Level& level_;
    std::vector<unsigned> masks_; // by geomID
    std::map<Key, Geometry*> open_;

    [[nodiscard]] TraceContext context(const TraceItem& item) const {
        TraceContext c{item.trace_from_object, dice_};
        c.dice.flatness_px *= item.flatness;
        return c;
    }

    Geometry& new_geometry(const Key& key) {
        const auto& [form, mask, cull, refine, filters] = key;
        Geometry& g = level_.geometries.emplace_back();
        g.form = form;
        g.cull_trace = cull;
        g.refine = refine;
        g.filters = filters;
        masks_.push_back(mask);
        return g;
    }

    const Mat4* stored(const Mat4& m) {
        if (level_.matrices.empty() || !(level_.matrices.back() == m)) {
            level_.matrices.push_back(m);
        }
        return &level_.matrices.back();
    }

    void add_analytic(const TraceItem& item) {
        const Key key{TraceForm::Analytic, item.mask, 0, false, item.filters};
        Geometry*& g = open_[key];
        if (!g) {
            g = &new_geometry(key);
        }
        g->members.push_back({item.shape, static_cast<std::uint32_t>(g->members.size()),
                              item.surface, stored(item.object_from_trace), item.cull});
        ++level_.analytic;
    }

    void add_tessellated(const TraceItem& item) {
        const TraceForm form = item.surface->trace_form();
        const int cull = trace_cull(item);
        const bool refine = item.surface->needs_refine();
        const bool small = item.surface->num_parts() < merge_below_parts;
        const Key key{form, item.mask, cull, refine, item.filters};
        Geometry* alone = nullptr;
        Geometry*& g = small ? open_[key] : alone;
        if (!g || g->member_of.size() > group_parts) {
            g = &new_geometry(key);
        }
        g->buffer.may_borrow = !small;
        const std::size_t first = num_parts(*g);
        item.surface->tessellate(context(item), g->buffer);
        const std::size_t added = num_parts(*g) - first;
        (form == TraceForm::Grids ? level_.grids : level_.triangles) += added;
        if (small) {
            g->member_of.insert(g->member_of.end(), added,
                                static_cast<std::uint32_t>(g->members.size()));
        }
        g->members.push_back({item.shape, static_cast<std::uint32_t>(first), item.surface,
                              refine ? stored(item.object_from_trace) : nullptr, item.cull});
    }

    static std::size_t num_parts(const Geometry& g) {
        return g.form == TraceForm::Grids  ? g.buffer.grids.size()
               : g.buffer.borrowed.empty() ? g.buffer.triangles.size() / 3
                                           : g.buffer.borrowed.size() / 3;
    }

    RTCGeometry make(Geometry& g) {
        RTCGeometry made = g.form == TraceForm::Analytic ? make_analytic(g) : make_mesh(g);
        rtcSetGeometryUserData(made, &g);
        return made;
    }

    RTCGeometry make_analytic(const Geometry& g) {
        RTCGeometry made = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_USER);
        rtcSetGeometryUserPrimitiveCount(made, static_cast<unsigned>(g.members.size()));
        rtcSetGeometryBoundsFunction(made, analytic_bounds, nullptr);
        rtcSetGeometryIntersectFunction(made, analytic_intersect);
        rtcSetGeometryOccludedFunction(made, analytic_occluded);
        return made;
    }

    RTCGeometry make_mesh(Geometry& g) {
        static_assert(sizeof(TraceBuffer::Grid) == sizeof(RTCGrid));
        const bool is_grid = g.form == TraceForm::Grids;
        RTCGeometry made =
            rtcNewGeometry(device_, is_grid ? RTC_GEOMETRY_TYPE_GRID : RTC_GEOMETRY_TYPE_TRIANGLE);
        TraceBuffer& b = g.buffer;
        const std::size_t vertices = b.num_vertices();
        b.xyz.resize(3 * vertices + 4); // Embree reads 16 bytes at the last vertex
        b.xyz.shrink_to_fit();
        b.triangles.shrink_to_fit();
        rtcSetSharedGeometryBuffer(made, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, b.xyz.data(),
                                   0, 12, vertices);
        if (is_grid) {
            rtcSetSharedGeometryBuffer(made, RTC_BUFFER_TYPE_GRID, 0, RTC_FORMAT_GRID,
                                       b.grids.data(), 0, sizeof(RTCGrid), b.grids.size());
        } else {
            const std::uint32_t* index =
                b.borrowed.empty() ? b.triangles.data() : b.borrowed.data();
            rtcSetSharedGeometryBuffer(made, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, index, 0,
                                       12, num_parts(g));
        }
        if (g.filters) {
            rtcSetGeometryOccludedFilterFunction(made, shadow_filter);
        }
        if (g.cull_trace != 0) {
            rtcSetGeometryIntersectFilterFunction(made, cull_filter);
        }
        return made;
    }
};

} // namespace

std::uint64_t Level::bytes() const {
    std::uint64_t sum = matrices.size() * sizeof(Mat4);
    for (const Geometry& g : geometries) {
        sum += sizeof(Geometry) + g.members.capacity() * sizeof(Geometry::Member) +
               g.member_of.capacity() * sizeof(std::uint32_t) +
               g.buffer.xyz.capacity() * sizeof(float) +
               g.buffer.triangles.capacity() * sizeof(std::uint32_t) +
               g.buffer.grids.capacity() * sizeof(TraceBuffer::Grid);
    }
    return sum;
}

void build_level(RTCDevice device, const DiceContext& dice, std::span<const TraceItem> items,
                 Level& level) {
    level.scene = rtcNewScene(device);
    // ROBUST: without it rays slip through between triangles (design.md, section 6).
    rtcSetSceneFlags(level.scene, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(level.scene, RTC_BUILD_QUALITY_MEDIUM);
    Builder builder(device, dice, level);
    builder.plan(items);
    for (const TraceItem& item : items) {
        builder.add(item);
    }
    builder.attach_all();
}

} // namespace geo::embree
