// SPDX-License-Identifier: Apache-2.0
#include "geometry/offset_sweep.h"

#include "geometry/shadow_segment.h"
#include "geometry/test_scene.h"

#include <algorithm>
#include <numbers>
#include <random>

namespace geo {

namespace {

using namespace test;

// Convex shells: what leaves them outwards does not meet them again.
enum class Form : std::uint8_t {
    Sphere,
    Ellipsoid,
    PartOfSphere,
    Cylinder,
    Cone,
    Paraboloid,
    Disk,
    Ring,
    Polygon,
    TriangleSphere,
    BilinearPatch,
    BicubicPatch,
    Count
};

using Random = std::mt19937;

double unit(Random& rng) {
    return std::uniform_real_distribution<double>(0, 1)(rng);
}

V3d direction(Random& rng) {
    const double z = 2 * unit(rng) - 1, r = std::sqrt(1 - z * z);
    const double phi = 2 * std::numbers::pi * unit(rng);
    return {r * std::cos(phi), r * std::sin(phi), z};
}

rib::Primitive triangle_sphere() {
    constexpr int rows = 12, columns = 16;
    std::vector<float> xyz;
    std::vector<std::int32_t> index;
    for (int j = 0; j <= rows; ++j) {
        for (int i = 0; i < columns; ++i) {
            const double t = std::numbers::pi * j / rows, p = 2 * std::numbers::pi * i / columns;
            xyz.insert(xyz.end(), {float(std::sin(t) * std::cos(p)),
                                   float(std::sin(t) * std::sin(p)), float(std::cos(t))});
        }
    }
    for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i) {
            const int a = j * columns + i, b = j * columns + (i + 1) % columns;
            const int c = a + columns, d = b + columns;
            if (j > 0) {
                index.insert(index.end(), {a, c, b});
            }
            if (j + 1 < rows) {
                index.insert(index.end(), {b, c, d});
            }
        }
    }
    const auto n = index.size() / 3;
    return SceneBuilder::polygons(std::vector<std::int32_t>(n, 1), std::vector<std::int32_t>(n, 3),
                                  index, xyz);
}

// A flat patch, or a dome.
rib::Primitive patch(bool bicubic) {
    const int n = bicubic ? 4 : 2;
    rib::Patches shape;
    shape.bicubic = bicubic;
    shape.nu = shape.nv = n;
    std::vector<float> xyz;
    for (int j = 0; j < n; ++j) {
        for (int i = 0; i < n; ++i) {
            const float x = 2.0f * float(i) / float(n - 1) - 1,
                        y = 2.0f * float(j) / float(n - 1) - 1;
            xyz.insert(xyz.end(), {x, y, bicubic ? 1 - 0.5f * (x * x + y * y) : 0.0f});
        }
    }
    rib::Primitive p;
    p.shape = shape;
    p.params.params.push_back(positions(std::move(xyz)));
    return p;
}

rib::Primitive primitive(Form form) {
    using K = rib::QuadricKind;
    switch (form) {
    case Form::Sphere:
    case Form::Ellipsoid:
        return SceneBuilder::quadric(K::Sphere, {1, -1, 1, 360});
    case Form::PartOfSphere:
        return SceneBuilder::quadric(K::Sphere, {1, -0.5, 0.8, 270});
    case Form::Cylinder:
        return SceneBuilder::quadric(K::Cylinder, {1, -1, 1, 360});
    case Form::Cone:
        return SceneBuilder::quadric(K::Cone, {2, 1, 360});
    case Form::Paraboloid:
        return SceneBuilder::quadric(K::Paraboloid, {1, 0, 1.5, 360});
    case Form::Disk:
        return SceneBuilder::quadric(K::Disk, {0, 1, 360});
    case Form::Ring:
        return SceneBuilder::quadric(K::Hyperboloid, {1, 0, 0, 0.4, 0, 0, 360});
    case Form::Polygon:
        return SceneBuilder::polygons({1}, {5}, {0, 1, 2, 3, 4},
                                      {-1, -1, 0, 1, -1, 0, 1.3f, 0, 0, 1, 1, 0, -1, 1, 0});
    case Form::TriangleSphere:
        return triangle_sphere();
    case Form::BilinearPatch:
    case Form::BicubicPatch:
    case Form::Count:
        break;
    }
    return patch(form == Form::BicubicPatch);
}

// A point on the inner side of all of a shell; flat ones have none.
V3d inside(Form form) {
    switch (form) {
    case Form::Cone:
        return {0, 0, 0.5};
    case Form::Paraboloid:
        return {0, 0, 1};
    case Form::BicubicPatch:
        return {0, 0, -1};
    default:
        return {};
    }
}

bool is_flat(Form form) {
    return form == Form::Disk || form == Form::Ring || form == Form::Polygon ||
           form == Form::BilinearPatch;
}

Mat4 turned(Random& rng) {
    return Mat4::rotate(360 * unit(rng), direction(rng));
}

// Two shapes with a gap between them, each possibly an instance, as a world.
struct Pair {
    std::unique_ptr<World> world;
    QuietDiag quiet;
    SceneBuilder builder;
    V3d centre[2], inner[2];
    bool flat[2];
    double size[2];
    std::string name;

    Pair(Random& rng, std::uint32_t number) {
        const auto form = static_cast<Form>(number % static_cast<std::uint32_t>(Form::Count));
        const auto other = static_cast<Form>(rng() % static_cast<std::uint32_t>(Form::Count));
        size[0] = std::pow(10, -3 + 8 * unit(rng));
        size[1] = size[0] * std::pow(10, 2 * unit(rng) - 1);
        // Floats still tell a hundred places across the smaller one apart.
        const double farthest = std::min(1e5, 1e5 * std::min(size[0], size[1]));
        const double offset = unit(rng) < 0.2 ? 0 : std::pow(farthest, unit(rng));
        centre[0] = direction(rng) * offset;
        centre[1] = centre[0] + direction(rng) * ((size[0] + size[1]) * (4 + 20 * unit(rng)));
        add(rng, form, 0);
        add(rng, other, 1);
        name = "form " + std::to_string(static_cast<int>(form)) + " size " +
               std::to_string(size[0]) + ", form " + std::to_string(static_cast<int>(other)) +
               " size " + std::to_string(size[1]) + ", offset " + std::to_string(offset);
        world = build();
    }

    // Diced as finely as a picture that they fill.
    [[nodiscard]] std::unique_ptr<World> build() {
        BuildOptions options;
        options.num_threads = 1;
        options.view.perspective = false;
        options.view.pixels_per_unit_x = options.view.pixels_per_unit_y =
            500 / std::min(size[0], size[1]);
        options.view.corner_x = options.view.corner_y = 1e7; // no part is beside the picture
        return World::build(builder.scene, options, quiet.diag);
    }

    void add(Random& rng, Form form, std::size_t which) {
        const V3d stretch = form == Form::Ellipsoid ? V3d(1, 0.5, 0.2) : V3d(1, 1, 1);
        const Mat4 place =
            Mat4::translate(centre[which]) * turned(rng) * Mat4::scale(stretch * size[which]);
        const rib::Primitive p = primitive(form);
        inner[which] = point(place, inside(form));
        flat[which] = is_flat(form);
        if (unit(rng) < 0.7) {
            builder.add(p, place);
            return;
        }
        rib::Object object;
        object.primitives.edit().push_back(p);
        object.primitives.edit().front().world_from_object =
            builder.transform(Mat4::translate({50, -20, 7}));
        rib::Instance instance;
        instance.object = static_cast<std::uint32_t>(builder.scene.objects.size());
        instance.world_from_object = builder.transform(place * Mat4::translate({-50, 20, -7}));
        instance.attributes = {0};
        builder.scene.objects.push_back(object);
        builder.scene.instances.push_back(instance);
    }
};

// A place on one of them and its outer side.
struct Place {
    V3d P, out;
    SpawnPoint spawn;
};

// Found as renderers find them: by rays from afar.
std::vector<Place> places(const Pair& pair, std::size_t which, Random& rng, int count) {
    std::vector<Hit> hits;
    std::vector<Ray> rays;
    for (int n = 0; n < count; ++n) {
        const V3f from(pair.centre[which] + direction(rng) * (3 * pair.size[which]));
        const V3f aim(pair.centre[which] + direction(rng) * (unit(rng) * pair.size[which]));
        const Ray ray{from, aim - from, 0, 1e6f};
        const Hit hit = trace(*pair.world, ray);
        const bool is_this = hit.valid() && (hit.instance != no_id || hit.t < 2);
        if (is_this) {
            hits.push_back(hit);
            rays.push_back(ray);
        }
    }
    std::vector<Place> found;
    for (std::size_t first = 0; first < hits.size(); first += SL_BATCH_MAX) {
        const std::size_t n = std::min<std::size_t>(SL_BATCH_MAX, hits.size() - first);
        const std::vector<Hit> some(hits.begin() + std::ptrdiff_t(first),
                                    hits.begin() + std::ptrdiff_t(first + n));
        const std::vector<Ray> theirs(rays.begin() + std::ptrdiff_t(first),
                                      rays.begin() + std::ptrdiff_t(first + n));
        const Filled f(*pair.world, some, theirs);
        for (std::size_t i = 0; i < n; ++i) {
            Place p{f.vec(SL_VAR_P, i), f.vec(SL_VAR_Ng, i), pair.world->spawn(some[i])};
            const bool is_inner = dot(p.out, p.P - pair.inner[which]) < 0;
            const bool flip = pair.flat[which] ? unit(rng) < 0.5 : is_inner;
            p.out = flip ? -p.out : p.out;
            if (base::length(p.P - pair.centre[which]) < 3 * pair.size[which]) {
                found.push_back(p);
            }
        }
    }
    return found;
}

class Sweep {
public:
    explicit Sweep(SweepCount& count) : count_(count) {}

    void run(const Pair& pair, Random& rng, std::uint64_t rays) {
        const std::vector<Place> from = places(pair, 0, rng, 192), to = places(pair, 1, rng, 64);
        for (std::uint64_t n = 0; !from.empty() && n < rays; n += RayPacket::size) {
            RayPacket packet{};
            for (int i = 0; i < RayPacket::size; ++i) {
                const Place& a = from[rng() % from.size()];
                const bool to_other = i % 2 == 0 && !to.empty();
                to_other ? aim(a, to[rng() % to.size()], packet, i)
                         : leave(a, pair.size[0], rng, packet, i);
            }
            const std::uint32_t hits = pair.world->occluded(packet) & packet.active;
            count_.rays += static_cast<std::uint64_t>(std::popcount(packet.active));
            count_.false_hits += static_cast<std::uint64_t>(std::popcount(hits));
            if (hits != 0 && count_.first_false.empty()) {
                count_.first_false = pair.name + ", lane " + std::to_string(std::countr_zero(hits));
            }
        }
    }

private:
    SweepCount& count_;

    void set(const ShadowSegment& s, const Place& from, RayPacket& packet, int i) {
        set_ray(packet, i, {s.origin, s.direction, 0, s.tfar, ShadowRay});
        const double moved = base::length(V3d(s.origin) - from.P);
        count_.largest_offset =
            std::max(count_.largest_offset, moved / (1e-30 + base::length(from.P)));
    }

    // Away from the surface, grazing every other time, up to where the other shape cannot be.
    void leave(const Place& a, double size, Random& rng, RayPacket& packet, int i) {
        V3d d = direction(rng);
        const double along = dot(d, a.out);
        d = along < 0 ? d - a.out * (2 * along) : d;
        if (i % 4 == 1) { // almost in the tangent plane
            d = normalize(d - a.out * (dot(d, a.out) * (1 - std::pow(10, -6 * unit(rng)))));
        }
        const V3f direction_f(d);
        if (dot(V3d(direction_f), a.out) > 1e-6) {
            const auto reach = static_cast<float>(1.5 * size);
            set({a.spawn.towards(direction_f), direction_f, reach}, a, packet, i);
        }
    }

    // A segment that leaves one and arrives at the other from outside both.
    void aim(const Place& a, const Place& b, RayPacket& packet, int i) {
        const ShadowSegment segment = segment_between(a.spawn, b.spawn);
        const V3d from(segment.origin), to(segment.origin + segment.direction);
        // Both ends, as they are after all, on the outer side of the other.
        const double least = 1e-7 * (base::length(to - from) + base::length(b.P)); // P is rounded
        if (dot(to - a.P, a.out) > least && dot(from - b.P, b.out) > least) {
            set(segment, a, packet, i);
        }
    }
};

} // namespace

SweepCount sweep_offsets(std::uint64_t rays, std::uint32_t seed) {
    constexpr std::uint64_t per_pair = 4096;
    SweepCount count;
    Random rng(seed);
    Sweep sweep(count);
    for (std::uint32_t number = 0; count.rays < rays; ++number) {
        const Pair pair(rng, number);
        sweep.run(pair, rng, std::min(per_pair, rays));
    }
    return count;
}

} // namespace geo
