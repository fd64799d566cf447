// SPDX-License-Identifier: Apache-2.0
#include "tracer/shader_set.h"

#include "tracer/default_surface.h"
#include "tracer/execution.h"
#include "tracer/indirect_light.h"
#include "tracer/services.h"
#include "tracer/sl_types.h"

#include <algorithm>
#include <span>

namespace trace {

namespace {

base::V3d triple(const std::vector<float>& values, std::size_t at) {
    return base::V3d(base::V3f(values[at], values[at + 1], values[at + 2]));
}

void put(std::vector<float>& values, std::size_t at, const base::V3d& v) {
    for (int k = 0; k < 3; ++k) {
        values[at + static_cast<std::size_t>(k)] = static_cast<float>(v[k]);
    }
}

void transform_triples(rib::ParamType type, const Space& space, std::vector<float>& values) {
    for (std::size_t at = 0; at + 3 <= values.size(); at += 3) {
        const base::V3d v = triple(values, at);
        put(values, at,
            type == rib::ParamType::Point    ? space.point_to_camera(v)
            : type == rib::ParamType::Vector ? space.vector_to_camera(v)
                                             : space.normal_to_camera(v));
    }
}

std::vector<float> divide_hpoints(const std::vector<float>& values, const Space& space) {
    std::vector<float> points;
    for (std::size_t at = 0; at + 4 <= values.size(); at += 4) {
        const double w = values[at + 3] != 0 ? static_cast<double>(values[at + 3]) : 1.0;
        points.resize(points.size() + 3);
        put(points, points.size() - 3, space.point_to_camera(triple(values, at) / w));
    }
    return points;
}

// A matrix takes points from its own frame to the space it is given in; camera_from_space follows
// it.
void transform_matrices(const Space& space, std::vector<float>& values) {
    for (std::size_t at = 0; at + 16 <= values.size(); at += 16) {
        const base::Mat4 m = space.camera_from_space * base::Mat4::from_rows(values.data() + at);
        for (std::size_t i = 0; i < 16; ++i) {
            values[at + i] = static_cast<float>(m.m[i / 4][i % 4]);
        }
    }
}

// Names that are no identifiers of the Shading Language but are met in shader calls, and the
// parameter they mean.
struct ParamAlias {
    std::string_view written, parameter;
};
constexpr ParamAlias param_aliases[] = {{"color", "bgcolor"}};

const sl_param* find_param(const sl_object& object, std::string_view name) {
    const std::span<const sl_param> params(object.params,
                                           static_cast<std::size_t>(object.num_params));
    const auto it = std::find_if(params.begin(), params.end(),
                                 [&](const sl_param& p) { return p.name == name; });
    return it == params.end() ? nullptr : &*it;
}

std::string_view param_name(const sl_object& object, std::string_view written) {
    for (const ParamAlias& alias : param_aliases) {
        if (alias.written == written && find_param(object, alias.parameter) != nullptr) {
            return alias.parameter;
        }
    }
    return written;
}

rib::ParamDecl declaration(const rib::Param& param, const sl_param* wanted) {
    rib::ParamDecl decl = param.decl;
    if (param.guessed && wanted != nullptr) {
        decl.type = rib_type_of(wanted->type);
        decl.array_length = std::max(wanted->array_length, 1);
        decl.is_array = wanted->array_length > 0;
    }
    return decl;
}

} // namespace

bool is_null_shader(const rib::ShaderCall& call) {
    return call.name.empty() || call.name == "null";
}

rt::BoundValue bound_value(const rib::Param& param, const sl_object& object, const Space& space) {
    rt::BoundValue value;
    value.name = param_name(object, param.name);
    const rib::ParamDecl decl = declaration(param, find_param(object, value.name));
    value.type = sl_type_of(decl.type);
    value.array_length = decl.is_array ? decl.array_length : 0;
    value.strings = param.strings;
    value.pos = param.pos;
    value.floats = param.floats;
    switch (decl.type) {
    case rib::ParamType::Integer:
        value.floats.assign(param.ints.begin(), param.ints.end());
        break;
    case rib::ParamType::HPoint:
        value.floats = divide_hpoints(param.floats, space);
        break;
    case rib::ParamType::Point:
    case rib::ParamType::Vector:
    case rib::ParamType::Normal:
        transform_triples(decl.type, space, value.floats);
        break;
    case rib::ParamType::Matrix:
    case rib::ParamType::MPoint:
        transform_matrices(space, value.floats);
        break;
    case rib::ParamType::Float:
    case rib::ParamType::Color:
    case rib::ParamType::String:
    case rib::ParamType::Pointer:
        break;
    }
    return value;
}

namespace {

Space call_space(const ShaderSources& sources, const std::string& name,
                 const base::Mat4& camera_from_shader, base::SourcePos pos) {
    if (const std::optional<Space> space = Space::from(camera_from_shader)) {
        return *space;
    }
    sources.diag.report(
        base::Severity::Error, base::Code::Math, pos,
        "shader \"" + name +
            "\": the current transformation cannot be inverted; camera space is used");
    return {};
}

// Binding runs the default expressions, which may ask for spaces: the execution knows the entry it
// is made for.
std::unique_ptr<ShaderEntry> make_entry(const ShaderSources& sources,
                                        const rt::ShaderObject& object, const std::string& name,
                                        const rib::ParamList& params,
                                        const base::Mat4& camera_from_shader, base::SourcePos pos) {
    auto entry = std::make_unique<ShaderEntry>();
    const Space space = call_space(sources, name, camera_from_shader, pos);
    entry->name = name;
    entry->pos = pos;
    entry->camera_from_shader = space.camera_from_space;
    std::vector<rt::BoundValue> values;
    values.reserve(params.params.size());
    for (const rib::Param& param : params.params) {
        values.push_back(bound_value(param, object.object(), space));
    }
    const FrameContext frame{sources.scene, sources.spaces, sources.strings, sources.diag};
    Execution execution(frame, *entry);
    entry->instance = std::make_unique<rt::ShaderInstance>(
        object, values, service_table(), &execution, sources.strings, sources.diag);
    return entry;
}

// The shader sees the space of its call: through a name, or in a parameter that lies in it.
bool depends_on_space(const sl_object& object) {
    bool depends = (object.facts & (SL_FACT_object_space | SL_FACT_shader_space)) != 0;
    for (int i = 0; i < object.num_params; ++i) {
        const int type = object.params[i].type;
        depends |= type == SL_TYPE_point || type == SL_TYPE_vector || type == SL_TYPE_normal ||
                   type == SL_TYPE_matrix;
    }
    return depends;
}

} // namespace

ShaderSet::ShaderSet(const ShaderSources& sources)
    : entries_(sources.scene.shaders.size()), tried_(sources.scene.shaders.size()) {
    const rib::Scene& scene = sources.scene;
    if (const rt::ShaderObject* fallback = sources.library.adopt(default_surface_object())) {
        default_surface_ = add(make_entry(sources, *fallback, "defaultsurface", {},
                                          sources.spaces.camera_from_world(), {}));
    }
    for (const rib::Attributes& attributes : scene.attributes) {
        load(sources, attributes.displacement, SL_SHADER_displacement, false);
        load(sources, attributes.surface, SL_SHADER_surface, false);
        for (const rib::ShaderId volume :
             {attributes.atmosphere, attributes.interior, attributes.exterior}) {
            load(sources, volume, SL_SHADER_volume, false);
        }
    }
    load(sources, scene.camera_exterior, SL_SHADER_volume, false);
    for (const rib::Light& light : scene.lights) {
        if (!is_indirect_light(scene, light)) {
            load(sources, light.shader, SL_SHADER_light, light.in_camera_space);
        }
    }
    load(sources, scene.options.imager, SL_SHADER_imager, true);
}

ShaderSet::~ShaderSet() = default;

// Exporters write one Surface per object: calls with equal names and values share an instance where
// the place of the call makes no difference, so that their points fill batches together.
const ShaderEntry* ShaderSet::shareable(const rib::Scene& scene, rib::ShaderId id) const {
    const rib::ShaderId same = scene.shaders[id].same_params_as;
    const ShaderEntry* entry = same != id ? get(same) : nullptr;
    return entry != nullptr && !depends_on_space(entry->object()) ? entry : nullptr;
}

void ShaderSet::load(const ShaderSources& sources, rib::ShaderId id, sl_shader_type type,
                     bool in_camera_space) {
    if (id >= entries_.size() || tried_[id]) {
        return;
    }
    tried_[id] = true;
    const rib::ShaderCall& call = sources.scene.shaders[id];
    if (is_null_shader(call) && type != SL_SHADER_surface) {
        return;
    }
    const ShaderEntry* shared = shareable(sources.scene, id);
    if (shared != nullptr && shared->object().type == type) {
        entries_[id] = shared;
        return;
    }
    const rt::ShaderObject* object =
        sources.library.find(call.name, type, call.pos, *call.search_path);
    if (object == nullptr) { // the library has said why
        return;
    }
    entries_[id] = add(
        make_entry(sources, *object, call.name, call.params,
                   sources.spaces.camera_from(call.world_from_shader, in_camera_space), call.pos));
}

const ShaderEntry* ShaderSet::add(std::unique_ptr<ShaderEntry> entry) {
    const sl_object& object = entry->object();
    const auto [it, is_new] =
        number_of_object_.emplace(&object, static_cast<std::uint32_t>(names_.size()));
    if (is_new) {
        names_.push_back({entry->name, object.source, static_cast<sl_shader_type>(object.type), 0});
    }
    entry->number = it->second;
    ++names_[entry->number].num_instances;
    owned_.push_back(std::move(entry));
    return owned_.back().get();
}

} // namespace trace
