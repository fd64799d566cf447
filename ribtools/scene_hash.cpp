// SPDX-License-Identifier: Apache-2.0
#include "ribtools/scene_hash.h"

#include "runtime/base/sha256.h"

#include <concepts>
#include <string_view>
#include <type_traits>

namespace rib {

namespace {

// A type whose bytes are its value: no padding, no pointers.
template <class T>
concept Plain = std::is_arithmetic_v<T> || std::is_enum_v<T> || std::same_as<T, base::Mat4>;

class Hasher {
public:
    template <Plain T> void add(const T& value) { bytes(&value, sizeof value); }
    void add(const std::string& text) {
        add(text.size());
        bytes(text.data(), text.size());
    }
    template <class T, std::size_t n> void add(const std::array<T, n>& values) {
        for (const T& value : values) {
            add(value);
        }
    }
    template <Plain T, std::size_t n> void add(const T (&values)[n]) {
        bytes(values, sizeof values);
    }
    template <class T> void add(const std::vector<T>& values) {
        add(values.size());
        if constexpr (Plain<T>) {
            bytes(values.data(), values.size() * sizeof(T));
        } else {
            for (const T& value : values) {
                add(value);
            }
        }
    }
    template <class Key, class T> void add(const std::map<Key, T>& values) {
        add(values.size());
        for (const auto& [key, value] : values) {
            add(key);
            add(value);
        }
    }
    template <class T> void add(const Shared<T>& value) { add(value.get()); }
    void add(const Shape& shape) {
        add(shape.index());
        std::visit([this](const auto& record) { add(record); }, shape);
    }

    void add(const ParamDecl& decl);
    void add(const Param& param);
    void add(const ParamList& list) { add(list.params); }
    void add(const Transform& transform) { add(transform.keys); }
    void add(const Transform::Key& key);
    void add(const ShaderCall& call);
    void add(const Light& light);
    void add(const Basis& basis);
    void add(const TrimCurve& trim);
    void add(const Attributes& attributes);
    void add(const Quadric& q);
    void add(const Polygons& p);
    void add(const Patches& p);
    void add(const NuPatch& p);
    void add(const SubdivisionMesh& m);
    void add(const Points& p) { add(p.count); }
    void add(const Curves& c);
    void add(const Blobby& b);
    void add(const Geometry& g);
    void add(const Procedural& p);
    void add(const Primitive::MotionKey& key);
    void add(const Primitive& primitive);
    void add(const SolidNode& node);
    void add(const Object& object);
    void add(const Instance& instance);
    void add(const Quantize& q);
    void add(const Display& display);
    void add(const Options::ClippingPlane& plane);
    void add(const Options& options);
    void add(const Scene& scene);

    [[nodiscard]] std::string hex() { return sha_.hex(); }

private:
    void bytes(const void* data, std::size_t size) {
        sha_.add(std::string_view(static_cast<const char*>(data), size));
    }
    template <class... T> void all(const T&... values) { (add(values), ...); }

    base::Sha256 sha_;
};

// --- parameters, transformations, shaders

void Hasher::add(const ParamDecl& decl) {
    const auto& [storage, type, array_length, is_array] = decl;
    all(storage, type, array_length, is_array);
}

void Hasher::add(const Param& param) {
    const auto& [name, decl, guessed, floats, ints, strings, pos] = param;
    all(name, decl, guessed, floats, ints, strings);
    static_cast<void>(pos);
}

void Hasher::add(const Transform::Key& key) {
    const auto& [time, m] = key;
    all(time, m);
}

void Hasher::add(const ShaderCall& call) {
    const auto& [name, params, search_path, world_from_shader, same_params_as, pos] = call;
    all(name, params, world_from_shader, same_params_as);
    static_cast<void>(search_path); // what was found on it counts, and not here
    static_cast<void>(pos);
}

void Hasher::add(const Light& light) {
    const auto& [shader, handle, in_camera_space, is_area, attributes, area_primitives] = light;
    all(shader, handle, in_camera_space, is_area, attributes, area_primitives);
}

// --- attributes

void Hasher::add(const Basis& basis) {
    const auto& [u, v, ustep, vstep] = basis;
    all(u, v, ustep, vstep);
}

void Hasher::add(const TrimCurve& trim) {
    const auto& [ncurves, order, n, knot, min, max, u, v, w] = trim;
    all(ncurves, order, n, knot, min, max, u, v, w);
}

void Hasher::add(const Attributes& attributes) {
    const auto& [color, opacity, texture_coordinates, surface, displacement, atmosphere, interior,
                 exterior, lights, area_light, shading_rate, interpolation, matte, sides,
                 orientation_matches, bound, has_bound, has_detail, detail_area_px, detail_range,
                 approximation, basis, trim, user, scoped_systems] = attributes;
    all(color, opacity, texture_coordinates, surface, displacement, atmosphere, interior, exterior,
        lights, area_light, shading_rate, interpolation, matte, sides, orientation_matches, bound,
        has_bound, has_detail, detail_area_px, detail_range, approximation, basis, trim, user,
        scoped_systems);
}

// --- shapes

void Hasher::add(const Quadric& q) {
    const auto& [kind, args] = q;
    all(kind, args);
}

void Hasher::add(const Polygons& p) {
    const auto& [num_loops, num_vertices, vertices] = p;
    all(num_loops, num_vertices, vertices);
}

void Hasher::add(const Patches& p) {
    const auto& [bicubic, is_mesh, nu, nv, uperiodic, vperiodic] = p;
    all(bicubic, is_mesh, nu, nv, uperiodic, vperiodic);
}

void Hasher::add(const NuPatch& p) {
    const auto& [nu, uorder, nv, vorder, uknot, vknot, umin, umax, vmin, vmax] = p;
    all(nu, uorder, nv, vorder, uknot, vknot, umin, umax, vmin, vmax);
}

void Hasher::add(const SubdivisionMesh& m) {
    const auto& [scheme, num_vertices, vertices, tags, num_args, int_args, float_args, string_args,
                 hierarchical] = m;
    all(scheme, num_vertices, vertices, tags, num_args, int_args, float_args, string_args,
        hierarchical);
}

void Hasher::add(const Curves& c) {
    const auto& [cubic, num_vertices, periodic] = c;
    all(cubic, num_vertices, periodic);
}

void Hasher::add(const Blobby& b) {
    const auto& [num_leaves, code, floats, strings] = b;
    all(num_leaves, code, floats, strings);
}

void Hasher::add(const Geometry& g) {
    const auto& [name, floats, ints] = g;
    all(name, floats, ints);
}

void Hasher::add(const Procedural& p) {
    const auto& [kind, args, bound] = p;
    all(kind, args, bound);
}

// --- primitives, objects

void Hasher::add(const Primitive::MotionKey& key) {
    const auto& [time, shape, params] = key;
    all(time, shape, params);
}

void Hasher::add(const Primitive& primitive) {
    const auto& [shape, params, motion, attributes, world_from_object, solid, pos] = primitive;
    all(shape, params, motion, attributes, world_from_object, solid);
    static_cast<void>(pos);
}

void Hasher::add(const SolidNode& node) {
    const auto& [op, parent] = node;
    all(op, parent);
}

void Hasher::add(const Object& object) {
    const auto& [handle, primitives] = object;
    all(handle, primitives);
}

void Hasher::add(const Instance& instance) {
    const auto& [object, world_from_object, attributes, solid, pos] = instance;
    all(object, world_from_object, attributes, solid);
    static_cast<void>(pos);
}

// --- options

void Hasher::add(const Quantize& q) {
    const auto& [one, min, max, dither] = q;
    all(one, min, max, dither);
}

void Hasher::add(const Display& display) {
    const auto& [name, type, mode, params, pos] = display;
    all(type, mode, params);
    static_cast<void>(name);
    static_cast<void>(pos);
}

void Hasher::add(const Options::ClippingPlane& plane) {
    const auto& [point_world, normal_world] = plane;
    all(point_world, normal_world);
}

void Hasher::add(const Options& options) {
    const auto& [frame, in_frame, xres, yres, pixel_aspect, crop, frame_aspect, has_screen_window,
                 screen_window, projection, projection_params, fov_deg, near_clip, far_clip,
                 clipping_planes, fstop, focal_length, focal_distance, shutter_open, shutter_close,
                 pixel_variance, xsamples, ysamples, samples_pos, filter, filter_width, filter_pos,
                 gain, gamma, imager, color_quantize, depth_quantize, other_quantize, displays,
                 display_channels, declared_outputs, hider, hider_params, relative_detail,
                 color_samples, user, search_paths] = options;
    all(frame, in_frame, xres, yres, pixel_aspect, crop, frame_aspect, has_screen_window,
        screen_window, projection, projection_params, fov_deg, near_clip, far_clip, clipping_planes,
        fstop, focal_length, focal_distance, shutter_open, shutter_close, pixel_variance, xsamples,
        ysamples, filter, filter_width, gain, gamma, imager, color_quantize, depth_quantize,
        other_quantize, displays, display_channels, declared_outputs, hider, hider_params,
        relative_detail, color_samples, user, search_paths);
    static_cast<void>(samples_pos);
    static_cast<void>(filter_pos);
}

void Hasher::add(const Scene& scene) {
    const auto& [options, camera_from_world, screen_from_camera_extra, transforms, attributes,
                 shaders, lights, solids, primitives, objects, instances, coordinate_systems,
                 camera_exterior] = scene;
    all(options, camera_from_world, screen_from_camera_extra, transforms, attributes, shaders,
        lights, solids, primitives, objects, instances, coordinate_systems, camera_exterior);
}

} // namespace

std::string scene_hash(const Scene& scene) {
    Hasher hasher;
    hasher.add(scene);
    return hasher.hex();
}

} // namespace rib
