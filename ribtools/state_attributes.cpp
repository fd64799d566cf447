// SPDX-License-Identifier: Apache-2.0
// State: shading and geometry attributes, shaders, lights (ri.md 6.6, 6.7, 12.5).
#include "ribtools/check.h"
#include "ribtools/detail.h"
#include "ribtools/number.h"
#include "ribtools/state_impl.h"

#include <algorithm>

namespace rib {

namespace {

std::string lower(std::string text) {
    for (char& c : text) {
        c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    }
    return text;
}

// ri.md 11.4, rows = powers.
struct NamedBasis {
    std::string_view name;
    std::array<float, 16> rows;
};
constexpr float sixth = 1.0f / 6;
constexpr NamedBasis bases[] = {
    {"bezier", {-1, 3, -3, 1, 3, -6, 3, 0, -3, 3, 0, 0, 1, 0, 0, 0}},
    {"b-spline",
     {-sixth, 3 * sixth, -3 * sixth, sixth, 3 * sixth, -6 * sixth, 3 * sixth, 0, -3 * sixth, 0,
      3 * sixth, 0, sixth, 4 * sixth, sixth, 0}},
    {"catmull-rom", {-.5f, 1.5f, -1.5f, .5f, 1, -2.5f, 2, -.5f, -.5f, 0, .5f, 0, 0, 1, 0, 0}},
    {"hermite", {2, 1, -2, 1, -3, -2, 3, -1, 0, 1, 0, 0, 1, 0, 0, 0}},
    {"power", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}},
};

constexpr int max_basis_step = 1 << 20;

} // namespace

// --- shading ---

void State::set_color(std::array<float, 3>& target, const Request& request) {
    for (int i = 0; i < 3; ++i) {
        target[static_cast<std::size_t>(i)] =
            narrow(request.args[0].numbers[static_cast<std::size_t>(i)]);
    }
}

void State::do_Color(Request& request) {
    set_color(edit_attributes().color, request);
}

void State::do_Opacity(Request& request) {
    set_color(edit_attributes().opacity, request);
    Attributes& a = edit_attributes();
    if (std::any_of(a.opacity.begin(), a.opacity.end(), [](float o) { return o < 0 || o > 1; })) {
        warn(base::Code::Range, request, "components must lie in 0..1; clamped");
        for (float& o : a.opacity) {
            o = std::clamp(o, 0.0f, 1.0f);
        }
    }
}

void State::do_TextureCoordinates(Request& request) {
    Attributes& a = edit_attributes();
    for (int i = 0; i < 8; ++i) {
        a.texture_coordinates[static_cast<std::size_t>(i)] = request.real(i);
    }
}

// "" and "null" mean none, except for Surface, where null is a shader of its own (ri.md 6.6).
ShaderId State::shader_attribute(Request& request, ShaderRole role) {
    const std::string& name = request.string(0);
    if (name.empty() || (name == "null" && request.id != RequestId::Surface)) {
        return none;
    }
    return add_shader(name, std::move(request.params), freeze_transform(), request.pos, role);
}

void State::do_Surface(Request& request) {
    const ShaderId id = shader_attribute(request, ShaderRole::Surface);
    edit_attributes().surface = id;
}

void State::do_Displacement(Request& request) {
    const ShaderId id = shader_attribute(request, ShaderRole::Displacement);
    edit_attributes().displacement = id;
}

void State::do_Atmosphere(Request& request) {
    const ShaderId id = shader_attribute(request, ShaderRole::Atmosphere);
    edit_attributes().atmosphere = id;
}

void State::do_Interior(Request& request) {
    const ShaderId id = shader_attribute(request, ShaderRole::Interior);
    edit_attributes().interior = id;
}

void State::do_Exterior(Request& request) {
    const ShaderId id = shader_attribute(request, ShaderRole::Exterior);
    edit_attributes().exterior = id;
}

void State::do_Deformation(Request& request) {
    warn_once("Deformation", base::Code::Incapable, request,
              "withdrawn in RI 3.2; use a displacement shader; ignored");
}

void State::do_ShaderLayer(Request& request) {
    warn_once("ShaderLayer", base::Code::Unimplement, request,
              "layered shaders are outside RI 3.2; ignored");
}

void State::do_ConnectShaderLayers(Request& request) {
    do_ShaderLayer(request);
}

void State::do_ShadingRate(Request& request) {
    if (!(request.real(0) > 0)) {
        error(base::Code::Range, request, "must be positive; ignored");
        return;
    }
    edit_attributes().shading_rate = std::min(request.real(0), ri_infinity);
}

void State::do_ShadingInterpolation(Request& request) {
    const std::string type = lower(request.string(0));
    if (type != "constant" && type != "smooth") {
        error(base::Code::BadToken, request,
              "unknown type " + quoted(request.string(0)) + " (constant, smooth); unchanged");
        return;
    }
    edit_attributes().interpolation =
        type == "smooth" ? Interpolation::Smooth : Interpolation::Constant;
}

void State::do_Matte(Request& request) {
    edit_attributes().matte = std::clamp(request.integer(0), 0, 2);
}

// --- lights ---

LightId State::add_light(Request& request, bool is_area) {
    Light light;
    light.shader = add_shader(request.string(0), std::move(request.params), freeze_transform(),
                              request.pos, ShaderRole::Light);
    light.handle = request.string(1);
    light.in_camera_space = !blocks_.inside(BlockKind::World);
    light.is_area = is_area;
    light.attributes = freeze_attributes();
    const auto id = static_cast<LightId>(scene_->lights.size());
    if (request.args[1].given) {
        light_handles_[light.handle] = id;
    }
    scene_->lights.push_back(std::move(light));
    edit_attributes().lights.edit().push_back(id);
    return id;
}

void State::do_LightSource(Request& request) {
    add_light(request, false);
}

// A null shader ends the list of primitives that form the light.
void State::do_AreaLightSource(Request& request) {
    const std::string& name = request.string(0);
    if (name.empty() || name == "null") {
        edit_attributes().area_light = none;
        return;
    }
    const LightId id = add_light(request, true);
    edit_attributes().area_light = id;
}

void State::do_Illuminate(Request& request) {
    const std::string& handle = request.string(0);
    const auto it = light_handles_.find(handle);
    if (it == light_handles_.end()) {
        error(base::Code::BadHandle, request,
              "no light has the handle " + quoted(handle) + "; ignored");
        return;
    }
    const LightId id = it->second;
    const std::vector<LightId>& lights = attributes_.value.lights;
    const bool is_on = std::find(lights.begin(), lights.end(), id) != lights.end();
    const bool wanted = request.integer(1) != 0;
    if (wanted == is_on) {
        return;
    }
    std::vector<LightId>& edited = edit_attributes().lights.edit();
    if (wanted) {
        edited.insert(std::upper_bound(edited.begin(), edited.end(), id), id);
    } else {
        std::erase(edited, id);
    }
}

// --- geometry ---

void State::do_Bound(Request& request) {
    Attributes& a = edit_attributes();
    const std::vector<double>& b = request.args[0].numbers;
    std::transform(b.begin(), b.end(), a.bound.begin(), narrow);
    a.has_bound = true;
}

void State::do_Detail(Request& request) {
    std::array<double, 6> box{};
    std::copy_n(request.args[0].numbers.begin(), 6, box.begin());
    const bool in_world = blocks_.inside(BlockKind::World);
    const Options& o = in_world ? scene_->options : options_;
    const base::Mat4 cam_from_box = camera_from_current();
    Attributes& a = edit_attributes();
    a.has_detail = true;
    a.detail_area_px = raster_area(o, cam_from_box, box) * o.relative_detail;
}

void State::do_DetailRange(Request& request) {
    std::array<float, 4> range{};
    for (int i = 0; i < 4; ++i) {
        range[static_cast<std::size_t>(i)] = std::min(request.real(i), ri_infinity);
    }
    if (!std::is_sorted(range.begin(), range.end())) {
        error(base::Code::Range, request, "the four values must not decrease; ignored");
        return;
    }
    edit_attributes().detail_range = range;
}

void State::do_GeometricApproximation(Request& request) {
    const std::string& type = request.string(0);
    if (!find_option(OptionCategory::Approximation, "", type)) {
        warn_once("approximation:" + type, base::Code::BadToken, request,
                  "type " + quoted(type) + " is not known; kept");
    }
    edit_attributes().approximation.edit()[type] = request.real(1);
}

void State::do_GeometricRepresentation(Request& request) {
    warn_once("GeometricRepresentation", base::Code::Unimplement, request,
              "a preview hint; ignored");
}

// ri.md 8.6: one bit says whether the current orientation is that of the coordinate system.
void State::do_Orientation(Request& request) {
    const std::string type = lower(request.string(0));
    const bool is_left_handed = base::determinant3(camera_from_current()) >= 0;
    if (type == "outside" || type == "inside") {
        edit_attributes().orientation_matches = type == "outside";
    } else if (type == "lh" || type == "rh") {
        edit_attributes().orientation_matches = (type == "lh") == is_left_handed;
    } else {
        error(base::Code::BadToken, request,
              "unknown orientation " + quoted(request.string(0)) +
                  " (outside, inside, lh, rh); unchanged");
    }
}

void State::do_ReverseOrientation(Request&) {
    Attributes& a = edit_attributes();
    a.orientation_matches = !a.orientation_matches;
}

void State::do_Sides(Request& request) {
    const int sides = request.integer(0);
    if (sides != 1 && sides != 2) {
        error(base::Code::Range, request, "must be 1 or 2; unchanged");
        return;
    }
    edit_attributes().sides = sides;
}

void State::do_Basis(Request& request) {
    Basis basis = attributes_.value.basis;
    const auto read = [&](int i, std::array<float, 16>& rows, int& step) {
        const Arg& arg = request.args[static_cast<std::size_t>(i)];
        if (!arg.numbers.empty()) {
            std::transform(arg.numbers.begin(), arg.numbers.end(), rows.begin(), narrow);
        } else {
            const std::string name = lower(request.string(i));
            const auto* found = std::find_if(std::begin(bases), std::end(bases),
                                             [&](const NamedBasis& b) { return b.name == name; });
            if (found == std::end(bases)) {
                error(base::Code::BadToken, request,
                      "unknown basis " + quoted(request.string(i)) + "; unchanged");
                return false;
            }
            rows = found->rows;
        }
        step = request.integer(i + 1);
        if (step < 1 || step > max_basis_step) {
            error(base::Code::Range, request, "a step must be at least 1; unchanged");
            return false;
        }
        return true;
    };
    if (read(0, basis.u, basis.ustep) && read(2, basis.v, basis.vstep)) {
        edit_attributes().basis = basis;
    }
}

void State::do_TrimCurve(Request& request) {
    TrimCurve trim;
    trim.ncurves = std::move(request.args[0].ints);
    trim.order = std::move(request.args[1].ints);
    trim.knot = std::move(request.args[2].floats);
    trim.min = std::move(request.args[3].floats);
    trim.max = std::move(request.args[4].floats);
    trim.n = std::move(request.args[5].ints);
    trim.u = std::move(request.args[6].floats);
    trim.v = std::move(request.args[7].floats);
    trim.w = std::move(request.args[8].floats);
    const std::string fault = trim_curve_fault(trim);
    if (!fault.empty()) {
        error(base::Code::Consistency, request, fault + "; ignored");
        return;
    }
    edit_attributes().trim = std::move(trim);
}

// --- implementation-specific ---

void State::do_Attribute(Request& request) {
    const std::string& group = request.string(0);
    for (Param& p : request.params.params) {
        check_option_name(OptionCategory::Attribute, request, p);
        edit_attributes().user.edit()[group + ":" + p.name] = std::move(p);
    }
}

} // namespace rib
