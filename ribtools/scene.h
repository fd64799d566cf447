// SPDX-License-Identifier: Apache-2.0
// The scene: everything one WorldBegin..WorldEnd described, as plain records. Filled by the
// graphics state, immutable afterwards; geometry, tracer and radiosity only read it. Records refer
// to each other by index.
//
// Transforms are kept as written, in double, per motion key: *_from_* reads destination-from-source
// (runtime/base/mat.h). "World" is the space after WorldBegin; camera space is left-handed, +z into
// the scene.
#pragma once

#include "ribtools/param.h"
#include "runtime/base/diag.h"
#include "runtime/base/mat.h"

#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace rib {

constexpr float ri_infinity = 1.0e38f;
constexpr float ri_epsilon = 1.0e-10f;
constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

// A value that copies of its owner share until one of them edits it: attribute states differ in
// little, and there may be millions of them. Reads like the value; edit() gives an unshared one to
// write to.
template <class T> class Shared {
public:
    Shared() = default;
    Shared(T value) : p_(std::make_shared<T>(std::move(value))) {}

    [[nodiscard]] const T& get() const {
        static const T empty{};
        return p_ ? *p_ : empty;
    }
    const T& operator*() const { return get(); }
    const T* operator->() const { return &get(); }
    operator const T&() const { return get(); }
    T& edit() {
        if (!p_) {
            p_ = std::make_shared<T>();
        } else if (p_.use_count() > 1) {
            p_ = std::make_shared<T>(*p_);
        }
        return *p_;
    }

    // Containers: reading as usual.
    [[nodiscard]] auto begin() const { return get().begin(); }
    [[nodiscard]] auto end() const { return get().end(); }
    [[nodiscard]] std::size_t size() const { return get().size(); }
    [[nodiscard]] bool empty() const { return get().empty(); }
    [[nodiscard]] const auto& operator[](std::size_t i) const { return get()[i]; }
    template <class Key> [[nodiscard]] auto find(const Key& key) const { return get().find(key); }

    [[nodiscard]] bool same_object(const Shared& other) const { return p_ == other.p_; }
    friend bool operator==(const Shared& a, const Shared& b) {
        return a.p_ == b.p_ || a.get() == b.get();
    }

private:
    std::shared_ptr<T> p_;
};

// --- transforms

// A possibly moving transform: one key when still. Times increase; linear between keys, constant
// outside.
struct Transform {
    struct Key {
        float time = 0;
        base::Mat4 m;
        friend bool operator==(const Key&, const Key&) = default;
    };
    std::vector<Key> keys = std::vector<Key>(1);

    [[nodiscard]] bool moving() const { return keys.size() > 1; }
    [[nodiscard]] base::Mat4 at(float time) const;
    [[nodiscard]] const base::Mat4& still() const { return keys.front().m; }
};
using TransformId = std::uint32_t; // index into Scene::transforms

// --- shaders and lights

struct ShaderCall {
    std::string name; // "" = none; as written, path and suffix included
    ParamList params;
    Shared<std::vector<std::string>> search_path; // that held at the request: "shader", "resource"
    TransformId world_from_shader =
        0; // for lights made before WorldBegin: camera-from-shader, see Light
    // First ShaderCall of the scene with equal name, path and params.
    std::uint32_t same_params_as = none;
    base::SourcePos pos;
};
using ShaderId = std::uint32_t; // index into Scene::shaders; none = no shader

struct Light {
    ShaderId shader = none;
    std::string handle;
    bool in_camera_space = false; // made before WorldBegin: world_from_shader is camera_from_shader
    bool is_area = false;
    std::uint32_t attributes = 0; // attribute state when it was made ("light" "shadows", Color ...)
    std::vector<std::uint32_t> area_primitives; // primitives that form an area light
};
using LightId = std::uint32_t;

// --- attributes

enum class Interpolation : std::uint8_t { Constant, Smooth };

struct Basis {
    // Rows = powers, columns = control points (ri.md 11.4). Default: bezier.
    std::array<float, 16> u{-1, 3, -3, 1, 3, -6, 3, 0, -3, 3, 0, 0, 1, 0, 0, 0};
    std::array<float, 16> v = u;
    int ustep = 3, vstep = 3;
    friend bool operator==(const Basis&, const Basis&) = default;
};

struct TrimCurve {
    std::vector<int> ncurves, order, n;
    std::vector<float> knot, min, max, u, v, w;
    [[nodiscard]] bool empty() const { return ncurves.empty(); }
    friend bool operator==(const TrimCurve&, const TrimCurve&) = default;
};

// Attribute state of one primitive. Shared: consecutive primitives with equal state have the same
// index.
struct Attributes {
    std::array<float, 3> color{1, 1, 1};
    std::array<float, 3> opacity{1, 1, 1};
    std::array<float, 8> texture_coordinates{0, 0, 1, 0, 0, 1, 1, 1};
    ShaderId surface = none, displacement = none, atmosphere = none, interior = none,
             exterior = none;
    Shared<std::vector<LightId>> lights; // on, in declaration order
    LightId area_light = none;
    float shading_rate = 1;
    Interpolation interpolation = Interpolation::Constant;
    int matte = 0;
    int sides = 2;
    bool orientation_matches =
        true; // ri.md 8.6: current orientation == coordinate system orientation
    std::array<float, 6> bound{-ri_infinity, ri_infinity,  -ri_infinity,
                               ri_infinity,  -ri_infinity, ri_infinity};
    bool has_bound = false;
    bool has_detail = false;
    float detail_area_px = ri_infinity; // raster area of the Detail box, times RelativeDetail
    std::array<float, 4> detail_range{0, 0, ri_infinity, ri_infinity};
    Shared<std::map<std::string, float>> approximation; // GeometricApproximation
    Shared<Basis> basis;
    Shared<TrimCurve> trim;
    // Attribute "group" "name": key "group:name"; standard ones with their table defaults applied
    // by attribute().
    Shared<std::map<std::string, Param>> user;
    Shared<std::map<std::string, TransformId>>
        scoped_systems; // ScopedCoordinateSystem, world_from_*

    [[nodiscard]] const Param* find(const std::string& group_name) const;
    friend bool operator==(const Attributes&, const Attributes&) = default;
};

// --- primitives

enum class QuadricKind : std::uint8_t {
    Sphere,
    Cone,
    Cylinder,
    Hyperboloid,
    Paraboloid,
    Disk,
    Torus
};

// Arguments as in the request (ri.md 6.9), angles in degrees.
struct Quadric {
    QuadricKind kind = QuadricKind::Sphere;
    std::array<double, 7> args{};
};

// All four polygon requests, brought to the form of PointsGeneralPolygons.
struct Polygons {
    std::vector<std::int32_t> num_loops;    // per polygon
    std::vector<std::int32_t> num_vertices; // per loop
    std::vector<std::int32_t> vertices;     // indices into "P"
};

struct Patches { // Patch and PatchMesh
    bool bicubic = false;
    bool is_mesh = false; // PatchMesh
    int nu = 0, nv = 0;   // control points
    bool uperiodic = false, vperiodic = false;
};

struct NuPatch {
    int nu = 0, uorder = 0, nv = 0, vorder = 0;
    std::vector<float> uknot, vknot;
    float umin = 0, umax = 1, vmin = 0, vmax = 1;
};

struct SubdivisionMesh {
    std::string scheme;
    std::vector<std::int32_t> num_vertices, vertices;
    std::vector<std::string> tags;
    std::vector<std::int32_t> num_args; // 2 per tag, 3 per tag in the hierarchical form
    std::vector<std::int32_t> int_args;
    std::vector<float> float_args;
    std::vector<std::string> string_args;
    bool hierarchical = false;
};

struct Points {
    std::size_t count = 0;
};

struct Curves {
    bool cubic = false;
    std::vector<std::int32_t> num_vertices;
    bool periodic = false;
};

struct Blobby {
    int num_leaves = 0;
    std::vector<std::int32_t> code;
    std::vector<float> floats;
    std::vector<std::string> strings;
};

struct Geometry { // Geometry, Volume and the like: by name
    std::string name;
    std::vector<float> floats;
    std::vector<std::int32_t> ints;
};

struct Procedural {
    std::string kind; // DelayedReadArchive, RunProgram, DynamicLoad, or Procedural2's name
    std::vector<std::string> args;
    std::array<float, 6> bound{};
};

using Shape = std::variant<Quadric, Polygons, Patches, NuPatch, SubdivisionMesh, Points, Curves,
                           Blobby, Geometry, Procedural>;

struct Primitive {
    Shape shape;
    ParamList params; // counts already checked against the shape (ri.md 10.3)
    // Keys of a deformation motion block: empty when still. motion[0] has the first time only (its
    // values are shape and params above); the others have the same topology.
    struct MotionKey {
        float time = 0;
        Shape shape;
        ParamList params;
    };
    std::vector<MotionKey> motion;
    std::uint32_t attributes = 0;      // index into Scene::attributes
    TransformId world_from_object = 0; // inside an Object: object-definition-from-primitive
    std::uint32_t solid = none;        // innermost solid node, index into Scene::solids
    base::SourcePos pos;
};

enum class SolidOp : std::uint8_t { Primitive, Union, Intersection, Difference };
struct SolidNode {
    SolidOp op = SolidOp::Primitive;
    std::uint32_t parent = none;
};

// ObjectBegin..ObjectEnd: geometry shared by its instances.
struct Object {
    std::string handle;
    Shared<std::vector<Primitive>> primitives;
};

// ObjectInstance. Member i of the object is drawn with attributes[i]: the attributes at the
// instance, with those the object itself set inside overriding them (ri.md 12.2).
struct Instance {
    std::uint32_t object = 0;
    TransformId world_from_object = 0; // world from object-definition space
    std::vector<std::uint32_t> attributes;
    std::uint32_t solid = none;
    base::SourcePos pos;
};

// --- options

struct Quantize {
    float one = 255, min = 0, max = 255, dither = 0.5f;
};

struct Display {
    std::string name, type, mode; // name without the leading '+'
    ParamList params;
    base::SourcePos pos;
};

// RiOptions frozen at WorldBegin. Optional things are resolved by resolve(): see the member
// comments.
struct Options {
    int frame = 0;
    bool in_frame = false;
    int xres = 640, yres = 480;
    float pixel_aspect = 1;
    std::array<float, 4> crop{0, 1, 0, 1};
    float frame_aspect = 0; // 0: not given
    bool has_screen_window = false;
    std::array<float, 4> screen_window{};    // left right bottom top, always valid after WorldBegin
    std::string projection = "orthographic"; // perspective, orthographic, null, or an unknown name
    ParamList projection_params;
    float fov_deg = 90;
    float near_clip = ri_epsilon, far_clip = ri_infinity;
    struct ClippingPlane {
        std::array<double, 3> point_world, normal_world;
    };
    std::vector<ClippingPlane> clipping_planes;
    float fstop = ri_infinity, focal_length = 0, focal_distance = 0;
    float shutter_open = 0, shutter_close = 0;
    float pixel_variance = 0; // 0: not given
    int xsamples = 2, ysamples = 2;
    base::SourcePos samples_pos; // of PixelSamples, for messages about it
    std::string filter = "gaussian";
    float filter_width[2] = {2, 2};
    base::SourcePos filter_pos; // of PixelFilter
    float gain = 1, gamma = 1;
    ShaderId imager = none;
    Quantize color_quantize;
    Quantize depth_quantize{0, 0, 0, 0};
    std::map<std::string, Quantize> other_quantize;
    std::vector<Display> displays; // first = primary; empty: the command line decides
    // DisplayChannel: first the channel itself as a parameter without values (guessed: its type is
    // not given).
    std::vector<ParamList> display_channels;
    // What Declare and the predeclared names say about names in the modes of displays and in
    // channels.
    std::map<std::string, ParamDecl> declared_outputs;
    std::string hider = "hidden";
    ParamList hider_params;
    float relative_detail = 1;
    int color_samples = 3;
    // Option "group" "name": key "group:name".
    std::map<std::string, Param> user;
    // Search paths after & and @ were expanded: "shader", "texture", "archive", "procedural",
    // "display".
    std::map<std::string, std::vector<std::string>> search_paths;
};

// --- scene

struct Scene {
    Options options;
    Transform camera_from_world;
    // Transformations given before Projection act between camera and screen (ri.md 6.3); usually
    // identity.
    base::Mat4 screen_from_camera_extra;
    std::vector<Transform> transforms;
    std::vector<Attributes> attributes;
    std::vector<ShaderCall> shaders;
    std::vector<Light> lights;
    std::vector<SolidNode> solids;
    std::vector<Primitive> primitives;
    std::vector<Object> objects;
    std::vector<Instance> instances;
    std::map<std::string, TransformId>
        coordinate_systems;          // CoordinateSystem "name": world_from_named
    ShaderId camera_exterior = none; // Exterior in force where the world began: the camera is in it
};

} // namespace rib
