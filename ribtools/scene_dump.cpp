// SPDX-License-Identifier: Apache-2.0
#include "ribtools/scene_dump.h"

#include "ribtools/declare.h"

#include <charconv>

namespace rib {

namespace {

// Long arrays are cut: a dump is for reading.
constexpr std::size_t max_shown = 16;

class Dump {
public:
    std::string text;

    void line(const std::string& s) { text += indent_ + s + "\n"; }
    void open(const std::string& s) {
        line(s);
        indent_ += "  ";
    }
    void close() { indent_.resize(indent_.size() - 2); }

private:
    std::string indent_;
};

std::string str(double x) {
    char buffer[40];
    const auto result =
        std::to_chars(buffer, std::end(buffer), x == 0 ? 0.0 : x, std::chars_format::general, 6);
    return {buffer, result.ptr};
}

template <class T> std::string list(const T& values) {
    std::string out = "[";
    std::size_t shown = 0;
    for (const auto& v : values) {
        if (shown == max_shown) {
            out += " ..." + std::to_string(std::size(values));
            break;
        }
        out += shown++ > 0 ? " " : "";
        if constexpr (std::is_same_v<std::decay_t<decltype(v)>, std::string>) {
            out += '"' + v + '"';
        } else {
            out += str(static_cast<double>(v));
        }
    }
    return out + "]";
}

std::string id(std::uint32_t i) {
    return i == none ? "-" : std::to_string(i);
}

void params(Dump& d, const ParamList& list_of) {
    for (const Param& p : list_of.params) {
        const std::string value = p.decl.type == ParamType::String    ? list(p.strings)
                                  : p.decl.type == ParamType::Integer ? list(p.ints)
                                                                      : list(p.floats);
        d.line(declaration_text(p.decl) + " " + p.name + " " + value +
               (p.guessed ? " guessed" : ""));
    }
}

void transform(Dump& d, const std::string& head, const Transform& t) {
    for (const Transform::Key& key : t.keys) {
        std::vector<double> rows;
        for (const auto& r : key.m.m) {
            rows.insert(rows.end(), std::begin(r), std::end(r));
        }
        d.line(head + (t.moving() ? " at " + str(static_cast<double>(key.time)) : "") + " " +
               list(rows));
    }
}

void shape(Dump& d, const Quadric& q) {
    static constexpr const char* names[] = {"Sphere",     "Cone", "Cylinder", "Hyperboloid",
                                            "Paraboloid", "Disk", "Torus"};
    d.line(std::string(names[static_cast<int>(q.kind)]) + " " + list(q.args));
}
void shape(Dump& d, const Polygons& p) {
    d.line("Polygons loops " + list(p.num_loops) + " vertices " + list(p.num_vertices) + " " +
           list(p.vertices));
}
void shape(Dump& d, const Patches& p) {
    d.line(std::string(p.is_mesh ? "PatchMesh " : "Patch ") +
           (p.bicubic ? "bicubic " : "bilinear ") + std::to_string(p.nu) +
           (p.uperiodic ? "p " : " ") + std::to_string(p.nv) + (p.vperiodic ? "p" : ""));
}
void shape(Dump& d, const NuPatch& p) {
    d.line("NuPatch " + std::to_string(p.nu) + " " + std::to_string(p.uorder) + " " +
           list(p.uknot) + " " + std::to_string(p.nv) + " " + std::to_string(p.vorder) + " " +
           list(p.vknot) + " " + list(std::array<float, 4>{p.umin, p.umax, p.vmin, p.vmax}));
}
void shape(Dump& d, const SubdivisionMesh& m) {
    d.line("SubdivisionMesh " + m.scheme + " " + list(m.num_vertices) + " " + list(m.vertices));
    d.line("tags " + list(m.tags) + " " + list(m.num_args) + " " + list(m.int_args) + " " +
           list(m.float_args) + " " + list(m.string_args));
}
void shape(Dump& d, const Points& p) {
    d.line("Points " + std::to_string(p.count));
}
void shape(Dump& d, const Curves& c) {
    d.line(std::string("Curves ") + (c.cubic ? "cubic " : "linear ") + list(c.num_vertices) +
           (c.periodic ? " periodic" : ""));
}
void shape(Dump& d, const Blobby& b) {
    d.line("Blobby " + std::to_string(b.num_leaves) + " " + list(b.code) + " " + list(b.floats) +
           " " + list(b.strings));
}
void shape(Dump& d, const Geometry& g) {
    d.line("Geometry " + g.name + " " + list(g.floats) + " " + list(g.ints));
}
void shape(Dump& d, const Procedural& p) {
    d.line("Procedural " + p.kind + " " + list(p.args) + " " + list(p.bound));
}

void primitive(Dump& d, const Primitive& p) {
    d.open("primitive attributes " + id(p.attributes) + " transform " + id(p.world_from_object) +
           (p.solid == none ? "" : " solid " + id(p.solid)));
    std::visit([&](const auto& s) { shape(d, s); }, p.shape);
    params(d, p.params);
    for (std::size_t i = 0; i < p.motion.size(); ++i) {
        d.open("key " + str(static_cast<double>(p.motion[i].time)));
        if (i > 0) {
            std::visit([&](const auto& s) { shape(d, s); }, p.motion[i].shape);
            params(d, p.motion[i].params);
        }
        d.close();
    }
    d.close();
}

void attributes(Dump& d, const Attributes& a) {
    const Attributes initial;
    d.line("color " + list(a.color) + " opacity " + list(a.opacity));
    d.line("surface " + id(a.surface) + " displacement " + id(a.displacement) + " atmosphere " +
           id(a.atmosphere) + " interior " + id(a.interior) + " exterior " + id(a.exterior));
    d.line("lights " + list(a.lights.get()) + " area " + id(a.area_light));
    d.line(std::string("orientation ") + (a.orientation_matches ? "outside" : "inside") +
           " sides " + std::to_string(a.sides) + " matte " + std::to_string(a.matte) + " rate " +
           str(static_cast<double>(a.shading_rate)) +
           (a.interpolation == Interpolation::Smooth ? " smooth" : " constant"));
    if (a.texture_coordinates != initial.texture_coordinates) {
        d.line("texture coordinates " + list(a.texture_coordinates));
    }
    if (a.has_bound) {
        d.line("bound " + list(a.bound));
    }
    if (a.has_detail || a.detail_range != initial.detail_range) {
        d.line("detail " + (a.has_detail ? str(static_cast<double>(a.detail_area_px)) : "none") +
               " range " + list(a.detail_range));
    }
    if (!(a.basis == initial.basis)) {
        d.line("basis " + list(a.basis->u) + " " + std::to_string(a.basis->ustep) + " " +
               list(a.basis->v) + " " + std::to_string(a.basis->vstep));
    }
    if (!a.trim->empty()) {
        d.line("trim curves " + list(a.trim->ncurves));
    }
    for (const auto& [name, value] : a.approximation) {
        d.line("approximation " + name + " " + str(static_cast<double>(value)));
    }
    ParamList user;
    for (const auto& [name, param] : a.user) {
        user.params.push_back(param);
        user.params.back().name = name;
    }
    params(d, user);
    for (const auto& [name, system] : a.scoped_systems) {
        d.line("scoped system " + name + " " + id(system));
    }
}

void options_camera(Dump& d, const Options& o) {
    d.line("frame " + std::to_string(o.frame) + " format " + std::to_string(o.xres) + " " +
           std::to_string(o.yres) + " " + str(static_cast<double>(o.pixel_aspect)));
    d.line("crop " + list(o.crop) + " window " + list(o.screen_window) + " aspect " +
           str(static_cast<double>(o.frame_aspect)));
    d.line("projection " + o.projection + " fov " + str(static_cast<double>(o.fov_deg)) +
           " clipping " + list(std::array<float, 2>{o.near_clip, o.far_clip}));
    params(d, o.projection_params);
    for (const Options::ClippingPlane& plane : o.clipping_planes) {
        d.line("clipping plane " + list(plane.point_world) + " " + list(plane.normal_world));
    }
    d.line("lens " + list(std::array<float, 3>{o.fstop, o.focal_length, o.focal_distance}) +
           " shutter " + list(std::array<float, 2>{o.shutter_open, o.shutter_close}));
}

void options(Dump& d, const Options& o) {
    d.open("options");
    options_camera(d, o);
    d.line("samples " + std::to_string(o.xsamples) + " " + std::to_string(o.ysamples) + " filter " +
           o.filter + " " + list(o.filter_width) + " exposure " +
           list(std::array<float, 2>{o.gain, o.gamma}) + " imager " + id(o.imager));
    const auto quantize = [&](const std::string& type, const Quantize& q) {
        d.line("quantize " + type + " " +
               list(std::array<float, 4>{q.one, q.min, q.max, q.dither}));
    };
    quantize("rgba", o.color_quantize);
    quantize("z", o.depth_quantize);
    for (const auto& [type, q] : o.other_quantize) {
        quantize(type, q);
    }
    for (const Display& display : o.displays) {
        d.open("display " + display.name + " " + display.type + " " + display.mode);
        params(d, display.params);
        d.close();
    }
    for (const ParamList& channel : o.display_channels) {
        d.open("channel");
        params(d, channel);
        d.close();
    }
    d.line("hider " + o.hider + " detail " + str(static_cast<double>(o.relative_detail)) +
           " colors " + std::to_string(o.color_samples));
    params(d, o.hider_params);
    ParamList user;
    for (const auto& [name, param] : o.user) {
        user.params.push_back(param);
        user.params.back().name = name;
    }
    params(d, user);
    for (const auto& [name, path] : o.search_paths) {
        d.line("path " + name + " " + list(path));
    }
    d.close();
}

void shaders_and_lights(Dump& d, const Scene& scene) {
    for (std::size_t i = 0; i < scene.shaders.size(); ++i) {
        const ShaderCall& s = scene.shaders[i];
        d.open("shader " + std::to_string(i) + " " + s.name + " transform " +
               id(s.world_from_shader) +
               (s.same_params_as == i ? "" : " as " + id(s.same_params_as)));
        params(d, s.params);
        d.close();
    }
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        const Light& l = scene.lights[i];
        d.line("light " + std::to_string(i) + " \"" + l.handle + "\" shader " + id(l.shader) +
               " attributes " + id(l.attributes) + (l.in_camera_space ? " camera" : "") +
               (l.is_area ? " area " + list(l.area_primitives) : ""));
    }
}

void geometry(Dump& d, const Scene& scene) {
    static constexpr const char* ops[] = {"primitive", "union", "intersection", "difference"};
    for (std::size_t i = 0; i < scene.solids.size(); ++i) {
        d.line("solid " + std::to_string(i) + " " + ops[static_cast<int>(scene.solids[i].op)] +
               " parent " + id(scene.solids[i].parent));
    }
    for (const Primitive& p : scene.primitives) {
        primitive(d, p);
    }
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        d.open("object " + std::to_string(i) + " \"" + scene.objects[i].handle + "\"");
        for (const Primitive& p : scene.objects[i].primitives) {
            primitive(d, p);
        }
        d.close();
    }
    for (const Instance& instance : scene.instances) {
        d.line("instance of " + id(instance.object) + " transform " +
               id(instance.world_from_object) + " attributes " + list(instance.attributes) +
               (instance.solid == none ? "" : " solid " + id(instance.solid)));
    }
}

} // namespace

std::string dump(const Scene& scene) {
    Dump d;
    options(d, scene.options);
    transform(d, "camera", scene.camera_from_world);
    if (scene.camera_exterior != none) {
        d.line("camera exterior " + id(scene.camera_exterior));
    }
    if (!(scene.screen_from_camera_extra == base::Mat4())) {
        transform(d, "screen", Transform{{Transform::Key{0, scene.screen_from_camera_extra}}});
    }
    for (std::size_t i = 0; i < scene.transforms.size(); ++i) {
        transform(d, "transform " + std::to_string(i), scene.transforms[i]);
    }
    for (const auto& [name, system] : scene.coordinate_systems) {
        d.line("system " + name + " " + id(system));
    }
    for (std::size_t i = 0; i < scene.attributes.size(); ++i) {
        d.open("attributes " + std::to_string(i));
        attributes(d, scene.attributes[i]);
        d.close();
    }
    shaders_and_lights(d, scene);
    geometry(d, scene);
    return std::move(d.text);
}

} // namespace rib
