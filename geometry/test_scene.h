// SPDX-License-Identifier: Apache-2.0
// For tests: small rib::Scene values made by hand, rays in packets, and filled variables as plain
// vectors.
#pragma once

#include "geometry/world.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace geo::test {

using base::Mat4;
using base::V3d;
using base::V3f;

inline rib::Param param(const char* name, rib::StorageClass storage, rib::ParamType type,
                        std::vector<float> values, int array_length = 1) {
    rib::Param p;
    p.name = name;
    p.decl = {storage, type, array_length, array_length > 1};
    p.floats = std::move(values);
    return p;
}

inline rib::Param positions(std::vector<float> xyz) {
    return param("P", rib::StorageClass::Vertex, rib::ParamType::Point, std::move(xyz));
}

inline rib::Transform still(const Mat4& m) {
    rib::Transform t;
    t.keys.front().m = m;
    return t;
}

struct SceneBuilder {
    rib::Scene scene;

    SceneBuilder() {
        scene.transforms.emplace_back();
        scene.attributes.emplace_back();
    }
    std::uint32_t transform(const Mat4& m) {
        scene.transforms.push_back(still(m));
        return static_cast<std::uint32_t>(scene.transforms.size() - 1);
    }
    rib::Attributes& attributes() { return scene.attributes.front(); }
    static rib::Primitive quadric(rib::QuadricKind kind, std::array<double, 7> args) {
        rib::Primitive p;
        p.shape = rib::Quadric{kind, args};
        return p;
    }
    static rib::Primitive polygons(std::vector<std::int32_t> loops, std::vector<std::int32_t> sizes,
                                   std::vector<std::int32_t> vertices, std::vector<float> xyz) {
        rib::Primitive p;
        p.shape = rib::Polygons{std::move(loops), std::move(sizes), std::move(vertices)};
        p.params.params.push_back(positions(std::move(xyz)));
        return p;
    }
    rib::Primitive& add(rib::Primitive p, const Mat4& world_from_object = Mat4()) {
        p.world_from_object = transform(world_from_object);
        scene.primitives.push_back(std::move(p));
        return scene.primitives.back();
    }
    std::unique_ptr<World> world(base::Diag& diag) const {
        BuildOptions options;
        options.num_threads = 1;
        return World::build(scene, options, diag);
    }
};

// A Diag that keeps its messages to itself.
struct QuietDiag {
    std::FILE* sink = std::fopen("/dev/null", "w");
    base::Diag diag{sink};
    ~QuietDiag() { std::fclose(sink); }
    [[nodiscard]] bool said(const std::string& text) const {
        for (const std::string& m : diag.messages()) {
            if (m.find(text) != std::string::npos) {
                return true;
            }
        }
        return false;
    }
};

struct Ray {
    V3f o, d;
    float tnear = 0, tfar = 1e30f;
    std::uint32_t mask = CameraRay;
};

inline void set_ray(RayPacket& p, int i, const Ray& r) {
    p.ox[i] = r.o.x, p.oy[i] = r.o.y, p.oz[i] = r.o.z;
    p.dx[i] = r.d.x, p.dy[i] = r.d.y, p.dz[i] = r.d.z;
    p.tnear[i] = r.tnear, p.tfar[i] = r.tfar, p.time[i] = 0, p.mask[i] = r.mask;
    p.active |= 1u << i;
}

inline Hit trace(const World& world, const Ray& ray) {
    RayPacket p{};
    set_ray(p, 0, ray);
    Hit hits[RayPacket::size];
    world.intersect(p, hits);
    return hits[0];
}

inline bool occluded(const World& world, Ray ray) {
    RayPacket p{};
    ray.mask = ShadowRay;
    set_ray(p, 0, ray);
    return (world.occluded(p) & 1) != 0;
}

// Every variable geometry owns, of one batch: value(id, point, component).
class Filled {
public:
    static constexpr std::uint32_t stride = SL_BATCH_MAX;

    Filled(const World& world, const std::vector<Hit>& hits, const std::vector<Ray>& rays,
           float footprint = 0.01f, std::uint64_t needed = ~std::uint64_t(0)) {
        std::array<std::vector<float>, 6> planes;
        for (const Ray& r : rays) {
            const float x[] = {r.o.x, r.o.y, r.o.z, r.d.x, r.d.y, r.d.z};
            for (std::size_t k = 0; k < 6; ++k) {
                planes[k].push_back(x[k]);
            }
        }
        const std::vector<float> feet(rays.size(), footprint);
        const Incident incident{planes[0], planes[1], planes[2], planes[3],
                                planes[4], planes[5], feet};
        for (int which = 0; which < 3; ++which) {
            for (int v = 0; v < SL_VAR_COUNT; ++v) {
                data_[which][v].assign(3 * stride, unset);
                points_[which].var[v] = data_[which][v].data();
            }
        }
        world.fill(hits, incident, needed, stride, points_[0], &points_[1], &points_[2]);
    }
    static constexpr float unset = -12345;

    [[nodiscard]] float at(sl_variable v, std::size_t i, int component = 0, int which = 0) const {
        return data_[which][v][static_cast<std::size_t>(component) * stride + i];
    }
    [[nodiscard]] V3d vec(sl_variable v, std::size_t i, int which = 0) const {
        return {at(v, i, 0, which), at(v, i, 1, which), at(v, i, 2, which)};
    }

private:
    std::vector<float> data_[3][SL_VAR_COUNT];
    sl_points points_[3];
};

// A wavy surface in front of the eye, of n * n vertices in two triangles a cell; appended.
inline void wavy_grid(int n, std::vector<float>& xyz, std::vector<std::int32_t>& index) {
    for (int j = 0; j < n; ++j) {
        for (int i = 0; i < n; ++i) {
            const double x = 12.0 * i / (n - 1) - 6, y = 12.0 * j / (n - 1) - 6;
            xyz.insert(xyz.end(),
                       {float(x), float(y), float(6 + 0.7 * std::sin(3 * x) * std::cos(2 * y))});
        }
    }
    for (int j = 0; j + 1 < n; ++j) {
        for (int i = 0; i + 1 < n; ++i) {
            const int a = j * n + i, b = a + 1, c = a + n, d = c + 1;
            index.insert(index.end(), {a, b, d, a, d, c});
        }
    }
}

} // namespace geo::test
