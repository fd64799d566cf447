// SPDX-License-Identifier: Apache-2.0
#include "geometry/shapes.h"

#include "geometry/patch.h"
#include "geometry/polygon.h"
#include "geometry/revolution.h"

#include <cmath>
#include <map>
#include <string_view>
#include <utility>

namespace geo {

namespace {

using base::Code;
using base::Severity;

// Names for messages, in the order of rib::Shape's alternatives.
const char* shape_name(const rib::Shape& shape) {
    struct Name {
        const char* operator()(const rib::Quadric& q) const { return quadric_name(q.kind); }
        const char* operator()(const rib::Polygons&) const { return "polygons"; }
        const char* operator()(const rib::Patches&) const { return "Patch"; }
        const char* operator()(const rib::NuPatch&) const { return "NuPatch"; }
        const char* operator()(const rib::SubdivisionMesh&) const { return "SubdivisionMesh"; }
        const char* operator()(const rib::Points&) const { return "Points"; }
        const char* operator()(const rib::Curves&) const { return "Curves"; }
        const char* operator()(const rib::Blobby&) const { return "Blobby"; }
        const char* operator()(const rib::Geometry&) const { return "Geometry"; }
        const char* operator()(const rib::Procedural&) const { return "Procedural"; }
    };
    return std::visit(Name{}, shape);
}

std::optional<std::string_view> text(const rib::Attributes& attributes, const char* name) {
    const rib::Param* p = attributes.find(name);
    return p && !p->strings.empty() ? std::optional<std::string_view>(p->strings.front())
                                    : std::nullopt;
}

// The words of BMRT and those of PRMan.
std::optional<ShadowMode> shadow_mode_of(std::string_view word) {
    static constexpr std::pair<std::string_view, ShadowMode> words[] = {
        {"none", ShadowMode::None},     {"transparent", ShadowMode::None},
        {"opaque", ShadowMode::Opaque}, {"Os", ShadowMode::Os},
        {"shader", ShadowMode::Shader}, {"shade", ShadowMode::Shader}};
    for (const auto& [name, mode] : words) {
        if (name == word) {
            return mode;
        }
    }
    return std::nullopt;
}

constexpr const char* shadow_attributes[] = {"visibility:transmission", "render:casts_shadows",
                                             "radiosity:casts_shadows"};

const rib::Param* unknown_shadow_word(const rib::Attributes& attributes) {
    for (const char* name : shadow_attributes) {
        const auto word = text(attributes, name);
        if (word && !shadow_mode_of(*word)) {
            return attributes.find(name);
        }
    }
    return nullptr;
}

class Collector {
public:
    Collector(const rib::Scene& scene, const BuildOptions& options, base::Diag& diag)
        : scene_(scene), options_(options), diag_(diag) {
        table_.scene = &scene;
    }

    ShapeTable run() {
        find_shadow_modes();
        const Mat4 cam_from_world = scene_.camera_from_world.at(options_.time);
        table_.world = add_group(scene_.primitives, no_id, cam_from_world);
        for (std::uint32_t i = 0; i < scene_.objects.size(); ++i) {
            table_.objects.push_back(add_group(scene_.objects[i].primitives, i, Mat4()));
        }
        std::uint32_t next_key = table_.world.num_placements;
        for (const rib::Instance& instance : scene_.instances) {
            add_instance(instance, cam_from_world, next_key);
        }
        report_degenerate();
        return std::move(table_);
    }

private:
    const rib::Scene& scene_;
    const BuildOptions& options_;
    base::Diag& diag_;
    ShapeTable table_;
    // Strips of exporters hold them by the thousand: told once.
    std::size_t degenerate_ = 0;
    base::SourcePos first_degenerate_;

    void find_shadow_modes() {
        table_.shadow_modes.reserve(scene_.attributes.size());
        for (std::size_t i = 0; i < scene_.attributes.size(); ++i) {
            const ShadowMode mode = geo::shadow_mode(scene_.attributes[i]);
            if (const rib::Param* word = unknown_shadow_word(scene_.attributes[i])) {
                diag_.report_once("casts_shadows " + word->strings.front(), Severity::Warning,
                                  Code::Range, word->pos,
                                  "\"" + word->name + "\" \"" + word->strings.front() +
                                      "\": expected none, opaque, Os or shader; it does nothing");
            }
            const bool is_shaded =
                i >= options_.shades_opacity.size() || options_.shades_opacity[i];
            table_.shadow_modes.push_back(mode == ShadowMode::Shader && !is_shaded ? ShadowMode::Os
                                                                                   : mode);
        }
    }

    void report_degenerate() {
        if (degenerate_ > 0) {
            diag_.report(Severity::Info, Code::None, first_degenerate_,
                         "polygons without area are left out, here and in " +
                             std::to_string(degenerate_ - 1) + " requests more");
        }
    }

    ShapeGroup add_group(const std::vector<rib::Primitive>& primitives, std::uint32_t object,
                         const Mat4& parent_from_world) {
        ShapeGroup group;
        group.first_shape = static_cast<std::uint32_t>(table_.shapes.size());
        group.first_placement = static_cast<std::uint32_t>(table_.placements.size());
        std::map<rib::TransformId, std::uint32_t> placed; // no_id: cannot be drawn
        for (std::uint32_t i = 0; i < primitives.size(); ++i) {
            const rib::Primitive& p = primitives[i];
            if (p.attributes >= scene_.attributes.size() || !drawn_at_this_detail(p)) {
                continue;
            }
            auto [it, is_new] = placed.try_emplace(p.world_from_object, no_id);
            if (is_new) {
                it->second = place(p, parent_from_world);
            }
            if (it->second != no_id) {
                add_shape(p, i, object, it->second);
            }
        }
        group.num_shapes = static_cast<std::uint32_t>(table_.shapes.size()) - group.first_shape;
        group.num_placements =
            static_cast<std::uint32_t>(table_.placements.size()) - group.first_placement;
        return group;
    }

    std::uint32_t place(const rib::Primitive& p, const Mat4& parent_from_world) {
        const auto placement =
            p.world_from_object < scene_.transforms.size()
                ? make_placement(parent_from_world * at_time(p.world_from_object))
                : std::nullopt;
        if (!placement) {
            diag_.report(
                Severity::Error, Code::Math, p.pos,
                std::string(shape_name(p.shape)) +
                    ": the transformation is singular or not affine; what it holds is left out");
            return no_id;
        }
        table_.placements.push_back(*placement);
        return static_cast<std::uint32_t>(table_.placements.size() - 1);
    }

    Mat4 at_time(rib::TransformId id) { return scene_.transforms[id].at(options_.time); }

    // Levels of detail without blending (ri.md 12.4): in a transition, the one with the larger
    // weight is drawn, so that two representations that share the range never both appear nor
    // vanish.
    bool drawn_at_this_detail(const rib::Primitive& p) {
        const rib::Attributes& a = scene_.attributes[p.attributes];
        const auto [least, low, up, most] = a.detail_range;
        const float detail = a.detail_area_px;
        if (detail >= low && (detail < up || up >= rib::ri_infinity)) {
            return true;
        }
        if (detail < least || detail >= most) {
            return false;
        }
        diag_.report_once(
            "geo:detail", Severity::Warning, Code::Unimplement, p.pos,
            "DetailRange: levels of detail are switched, not blended, by this version");
        return detail < low ? detail - least >= low - detail : detail - up < most - detail;
    }

    void add_shape(const rib::Primitive& p, std::uint32_t index, std::uint32_t object,
                   std::uint32_t placement) {
        note_unsupported_state(p);
        std::unique_ptr<Surface> surface = make_surface(p);
        if (!surface) {
            return;
        }
        Shape shape;
        shape.vars = bind_standard_vars(p, *surface, diag_);
        shape.surface = std::move(surface);
        shape.source = &p;
        shape.primitive = index;
        shape.object = object;
        shape.placement = placement;
        table_.shapes.push_back(std::move(shape));
    }

    void note_unsupported_state(const rib::Primitive& p) {
        if (p.solid != rib::none) {
            diag_.report_once(
                "geo:solid", Severity::Warning, Code::Unimplement, p.pos,
                "SolidBegin: set operations are not done by this version; the surfaces are "
                "drawn as they are");
        }
        if (!p.motion.empty() || scene_.transforms[p.world_from_object].moving()) {
            diag_.report_once(
                "geo:motion", Severity::Warning, Code::Unimplement, p.pos,
                "MotionBegin: motion is not blurred by this version; things stand as they "
                "are when the shutter opens");
        }
    }

    // The one place that knows kinds.
    std::unique_ptr<Surface> make_surface(const rib::Primitive& p) {
        if (const auto* quadric = std::get_if<rib::Quadric>(&p.shape)) {
            return quadric_surface(p, *quadric);
        }
        if (const auto* polygons = std::get_if<rib::Polygons>(&p.shape)) {
            return polygon_surface(p, *polygons);
        }
        if (const auto* patches = std::get_if<rib::Patches>(&p.shape)) {
            std::string why;
            return patch_surface(
                p, make_patches(*patches, scene_.attributes[p.attributes].basis, p.params, why),
                why);
        }
        if (const auto* nupatch = std::get_if<rib::NuPatch>(&p.shape)) {
            std::string why;
            return patch_surface(p, make_nupatch(*nupatch, p.params, why), why);
        }
        const std::string name = shape_name(p.shape);
        diag_.report_once("geo:" + name, Severity::Warning, Code::Unimplement, p.pos,
                          name + ": not drawn by this version");
        return nullptr;
    }

    std::unique_ptr<Surface> quadric_surface(const rib::Primitive& p, const rib::Quadric& quadric) {
        std::string why;
        std::unique_ptr<Surface> surface = geo::make_quadric(quadric, why);
        if (!surface) {
            diag_.report(Severity::Error, Code::Range, p.pos,
                         std::string(quadric_name(quadric.kind)) + ": " + why + "; left out");
        }
        return surface;
    }

    std::unique_ptr<Surface> patch_surface(const rib::Primitive& p,
                                           std::unique_ptr<Surface> surface,
                                           const std::string& why) {
        if (!surface) {
            diag_.report(Severity::Error, Code::Consistency, p.pos,
                         std::string(shape_name(p.shape)) + ": " + why + "; left out");
        } else if (std::holds_alternative<rib::NuPatch>(p.shape) &&
                   !scene_.attributes[p.attributes].trim->empty()) {
            diag_.report_once("geo:trim", Severity::Warning, Code::Unimplement, p.pos,
                              "TrimCurve: this version draws NuPatches untrimmed");
        }
        return surface;
    }

    std::unique_ptr<Surface> polygon_surface(const rib::Primitive& p,
                                             const rib::Polygons& polygons) {
        PolygonFaults faults;
        std::unique_ptr<Surface> surface = make_polygons(polygons, p.params, faults);
        if (faults.no_positions) {
            diag_.report(Severity::Error, Code::MissingData, p.pos,
                         "polygons: no positions \"P\"; left out");
            return surface;
        }
        report_count(p, faults.bad_index, Severity::Error, Code::Range,
                     "refer to vertices that are not there; left out");
        report_count(p, faults.not_finite, Severity::Error, Code::Range,
                     "have coordinates that are not finite or above 1e18; left out");
        if (faults.degenerate > 0 && degenerate_++ == 0) {
            first_degenerate_ = p.pos;
        }
        report_count(p, faults.tangled, Severity::Warning, Code::Consistency,
                     "have outlines that cross; filled as well as it goes");
        return surface;
    }

    void report_count(const rib::Primitive& p, std::size_t count, Severity severity, Code code,
                      const char* text) {
        if (count > 0) {
            diag_.report(severity, code, p.pos,
                         "polygons: " + std::to_string(count) + " of them " + text);
        }
    }

    void add_instance(const rib::Instance& instance, const Mat4& cam_from_world,
                      std::uint32_t& next_key) {
        InstanceRecord record;
        const bool known = instance.object < table_.objects.size() &&
                           instance.world_from_object < scene_.transforms.size();
        const auto placement =
            known ? make_placement(cam_from_world * at_time(instance.world_from_object))
                  : std::nullopt;
        if (!placement) {
            diag_.report(Severity::Error, Code::Math, instance.pos,
                         "ObjectInstance: the transformation is singular or not affine; left out");
        } else {
            const ShapeGroup& group = table_.objects[instance.object];
            record = {group.num_shapes > 0, *placement, next_key};
            next_key += group.num_placements;
        }
        table_.instances.push_back(record);
    }
};

} // namespace

std::optional<Placement> make_placement(const Mat4& parent_from_object) {
    Mat4 m = parent_from_object;
    const double w = m.m[3][3];
    if (w != 1 && w != 0 && std::isfinite(w)) {
        for (auto& row : m.m) {
            for (double& x : row) {
                x /= w;
            }
        }
        m.m[3][3] = 1;
    }
    const auto inv = base::inverse(m);
    if (!inv || !base::is_affine(m)) {
        return std::nullopt;
    }
    Mat4 back = *inv;
    for (int i = 0; i < 4; ++i) {
        back.m[i][3] = i == 3 ? 1 : 0; // exactly affine
    }
    return Placement{m, back};
}

std::uint32_t ShapeTable::attribute_id(std::uint32_t shape, std::uint32_t instance) const {
    const Shape& s = shapes[shape];
    if (instance != no_id) {
        const auto& own = scene->instances[instance].attributes;
        if (s.primitive < own.size() && own[s.primitive] < scene->attributes.size()) {
            return own[s.primitive];
        }
    }
    return s.source->attributes;
}

std::uint32_t ShapeTable::transform_key(const Hit& hit) const {
    const Shape& s = shapes[hit.shape];
    if (hit.instance == no_id) {
        return s.placement - world.first_placement;
    }
    return instances[hit.instance].first_key + s.placement - objects[s.object].first_placement;
}

ShadowMode ShapeTable::shadow_mode(const Shape& shape, std::uint32_t attributes) const {
    const ShadowMode mode = shadow_modes[attributes];
    if (mode != ShadowMode::Os || shape.vars.Os != nullptr) {
        return mode;
    }
    const auto all = [&](float value) {
        const auto& os = scene->attributes[attributes].opacity;
        return os[0] == value && os[1] == value && os[2] == value;
    };
    return all(1) ? ShadowMode::Opaque : all(0) ? ShadowMode::None : mode;
}

V3d ShapeTable::cam_point(const Hit& hit, const V3d& P_object) const {
    const V3d p = point(placements[shapes[hit.shape].placement].parent_from_object, P_object);
    return hit.instance == no_id
               ? p
               : point(instances[hit.instance].cam_from_definition.parent_from_object, p);
}

V3d ShapeTable::cam_vector(const Hit& hit, const V3d& v_object) const {
    const V3d v = vector(placements[shapes[hit.shape].placement].parent_from_object, v_object);
    return hit.instance == no_id
               ? v
               : vector(instances[hit.instance].cam_from_definition.parent_from_object, v);
}

V3d ShapeTable::cam_normal(const Hit& hit, const V3d& n_object) const {
    const V3d n =
        normal_by_inverse(placements[shapes[hit.shape].placement].object_from_parent, n_object);
    return hit.instance == no_id
               ? n
               : normal_by_inverse(instances[hit.instance].cam_from_definition.object_from_parent,
                                   n);
}

Mat4 ShapeTable::cam_from_object(const Hit& hit) const {
    const Mat4& m = placements[shapes[hit.shape].placement].parent_from_object;
    return hit.instance == no_id
               ? m
               : instances[hit.instance].cam_from_definition.parent_from_object * m;
}

ShapeTable collect_shapes(const rib::Scene& scene, const BuildOptions& options, base::Diag& diag) {
    return Collector(scene, options, diag).run();
}

namespace {

// The first number of an attribute, if it was set.
std::optional<int> number(const rib::Attributes& attributes, const char* name) {
    const rib::Param* p = attributes.find(name);
    if (p && !p->ints.empty()) {
        return p->ints.front();
    }
    if (p && !p->floats.empty()) {
        return static_cast<int>(std::lround(std::fmin(std::fmax(p->floats.front(), -1e6f), 1e6f)));
    }
    return std::nullopt;
}

} // namespace

// BMRT's bits first; the later "visibility" attributes override the kinds of ray they name
// (ri.md 14.3).
std::uint32_t visibility_mask(const rib::Attributes& attributes) {
    const auto set = [](std::uint32_t mask, std::uint32_t bit, bool on) {
        return on ? mask | bit : mask & ~bit;
    };
    std::uint32_t mask = CameraRay | ReflectionRay | ShadowRay;
    if (attributes.user.empty()) {
        return mask;
    }
    if (const auto bits = number(attributes, "render:visibility")) {
        mask = static_cast<std::uint32_t>(*bits) & mask;
    }
    if (const auto on = number(attributes, "visibility:camera")) {
        mask = set(mask, CameraRay, *on != 0);
    }
    bool named = false, seen = false;
    for (const char* name :
         {"visibility:trace", "visibility:specular", "visibility:diffuse", "visibility:indirect"}) {
        if (const auto on = number(attributes, name)) {
            named = true;
            seen = seen || *on != 0;
        }
    }
    if (named) {
        mask = set(mask, ReflectionRay, seen);
    }
    if (const auto on = number(attributes, "visibility:transmission")) {
        mask = set(mask, ShadowRay, *on != 0);
    }
    return shadow_mode(attributes) == ShadowMode::None ? set(mask, ShadowRay, false) : mask;
}

// The newest attribute that says something known, by age of the renderers that had it.
ShadowMode shadow_mode(const rib::Attributes& attributes) {
    if (attributes.user.empty()) {
        return ShadowMode::Os;
    }
    if (const auto mode = text(attributes, "shade:transmissionhitmode")) {
        return *mode == "shader" ? ShadowMode::Shader : ShadowMode::Os;
    }
    for (const char* name : shadow_attributes) {
        const auto word = text(attributes, name);
        if (const auto mode = word ? shadow_mode_of(*word) : std::nullopt) {
            return *mode;
        }
    }
    return ShadowMode::Os;
}

int cull_side(const rib::Attributes& attributes) {
    return attributes.sides != 1 ? 0 : attributes.orientation_matches ? 1 : -1;
}

} // namespace geo
