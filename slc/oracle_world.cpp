// SPDX-License-Identifier: Apache-2.0
#include "slc/oracle_world.h"

#include "runtime/base/pattern.h"

#include <algorithm>
#include <cmath>

namespace slc {

namespace {

OracleWorld& world_of(void* engine) {
    return *static_cast<OracleWorld*>(engine);
}

// What a space's coordinates become in current space; "object" turns with the point.
Matrix16 to_current(const std::string& name, int point) {
    if (name == "shader") {
        return {2, 0, 0, 0, 0, 1, 0.5, 0, 0, -0.5, 1, 0, 1, 2, 3, 1};
    }
    if (name == "world") {
        return {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0.5, 0, 0.25, 1};
    }
    if (name == "object") {
        const double a = 0.125 * point;
        return {std::cos(a), std::sin(a), 0, 0, -std::sin(a), std::cos(a), 0, 0, 0, 0, 1.5, 0,
                0,           a,           0, 1};
    }
    return {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
}

bool is_known(const std::string& name) {
    return name == "current" || name == "camera" || name == "shader" || name == "world" ||
           name == "object";
}

constexpr const char* categories[] = {"key,fill", "rim"};

bool in_category(int light, const std::string& wanted) {
    if (wanted.empty()) {
        return true;
    }
    const bool negative = wanted[0] == '-';
    const std::string name = "," + (negative ? wanted.substr(1) : wanted) + ",";
    const bool has = ("," + std::string(categories[light]) + ",").find(name) != std::string::npos;
    return has != negative;
}

constexpr std::string_view message_functions[] = {
    "lightsource", "surface",   "displacement", "atmosphere",   "incident",
    "opposite",    "attribute", "option",       "rendererinfo", "rayinfo"};

std::uint32_t serve_light(void* engine, const sl_light_query* query, sl_light_result* result) {
    OracleWorld& world = world_of(engine);
    result->more = 0;
    std::uint32_t reached = 0;
    for (std::uint32_t lane = 0; lane < query->lanes; ++lane) {
        if ((query->mask >> lane & 1U) == 0) {
            continue;
        }
        const auto triple = [&](const float* p) {
            return Triple3{p[lane], p[query->lanes + lane], p[2 * query->lanes + lane]};
        };
        LightSample sample;
        const Triple3 axis = query->axis ? triple(query->axis) : Triple3{0, 0, 1};
        const double cosangle = query->axis ? query->cosangle[lane] : -2;
        if (!world.light(query->index, static_cast<int>(query->first + lane), triple(query->P),
                         axis, cosangle, query->category, sample)) {
            continue;
        }
        reached |= 1U << lane;
        for (std::size_t k = 0; k < 3; ++k) {
            result->L[k * query->lanes + lane] = static_cast<float>(sample.L[k]);
            result->Cl[k * query->lanes + lane] = static_cast<float>(sample.Cl[k]);
            result->Ol[k * query->lanes + lane] = static_cast<float>(sample.Ol[k]);
        }
        result->nondiffuse[lane] = static_cast<float>(sample.nondiffuse);
        result->nonspecular[lane] = static_cast<float>(sample.nonspecular);
    }
    return reached;
}

void serve_ambient(void* engine, std::uint32_t first, std::uint32_t mask, const float* P,
                   float* C) {
    const std::uint32_t lanes = world_of(engine).lanes();
    for (std::uint32_t lane = 0; lane < lanes; ++lane) {
        if ((mask >> lane & 1U) != 0) {
            const Triple3 c = world_of(engine).ambient(
                static_cast<int>(first + lane), {P[lane], P[lanes + lane], P[2 * lanes + lane]});
            for (std::size_t k = 0; k < 3; ++k) {
                C[k * lanes + lane] = static_cast<float>(c[k]);
            }
        }
    }
}

std::int32_t serve_space(void* engine, sl_string from, sl_string to, std::uint32_t first,
                         float* m) {
    const std::uint32_t lanes = world_of(engine).lanes();
    const std::string source = from ? from : "current";
    const std::string target = to ? to : "current";
    const bool per_lane = source == "object" || target == "object";
    bool known = true;
    for (std::uint32_t lane = 0; lane < (per_lane ? lanes : 1); ++lane) {
        Matrix16 matrix{};
        known = world_of(engine).space(source, target, static_cast<int>(first + lane), matrix);
        for (std::size_t k = 0; k < 16; ++k) {
            m[per_lane ? k * lanes + lane : k] = static_cast<float>(matrix[k]);
        }
    }
    return !known ? 0 : per_lane ? 2 : 1;
}

std::uint32_t serve_message(void* engine, std::int32_t kind, sl_string name, std::int32_t type,
                            std::int32_t array_length, std::uint32_t first, std::uint32_t mask,
                            float* value) {
    const std::uint32_t lanes = world_of(engine).lanes();
    if (type == SL_TYPE_string) {
        return 0;
    }
    std::uint32_t set = 0;
    for (std::uint32_t lane = 0; lane < lanes; ++lane) {
        Value v = Value::zero(static_cast<Type>(type), array_length);
        if ((mask >> lane & 1U) != 0 &&
            world_of(engine).message(message_functions[kind], name, static_cast<int>(first + lane),
                                     v)) {
            set |= 1U << lane;
            for (std::size_t k = 0; k < v.x.size(); ++k) {
                value[k * lanes + lane] = static_cast<float>(v.x[k]);
            }
        }
    }
    return set;
}

std::uint32_t serve_light_message(void* engine, const sl_light_query* query, sl_string name,
                                  std::int32_t type, std::int32_t array_length, float* value) {
    return serve_message(engine, SL_MESSAGE_lightsource, name, type, array_length, query->first,
                         query->mask, value);
}

// Component k of a value as one lane sees it.
float component(const sl_value& v, std::size_t k, std::uint32_t lane, std::uint32_t lanes) {
    const auto* floats = static_cast<const float*>(v.data);
    return v.varying != 0 ? floats[k * lanes + lane] : floats[k];
}

std::size_t floats_of(const sl_value& v) {
    return v.type == SL_TYPE_string
               ? 0
               : static_cast<std::size_t>(std::max(v.array_length, 1)) *
                     static_cast<std::size_t>(num_components(static_cast<Type>(v.type)));
}

void serve_shadeop(void* engine, sl_string function, std::uint32_t, std::uint32_t mask,
                   const sl_value* outputs, std::int32_t num_outputs, const sl_value* inputs,
                   std::int32_t num_inputs) {
    const std::uint32_t lanes = world_of(engine).lanes();
    for (std::uint32_t lane = 0; lane < lanes; ++lane) {
        if ((mask >> lane & 1U) == 0) {
            continue;
        }
        double sum = 0;
        for (std::int32_t i = 0; i < num_inputs; ++i) {
            for (std::size_t k = 0; k < floats_of(inputs[i]); ++k) {
                sum += component(inputs[i], k, lane, lanes);
            }
        }
        for (std::int32_t i = 0; i < num_outputs; ++i) {
            auto* out = static_cast<float*>(outputs[i].data);
            for (std::size_t k = 0; k < floats_of(outputs[i]); ++k) {
                out[outputs[i].varying != 0 ? k * lanes + lane : k] =
                    static_cast<float>(OracleWorld::shadeop_value(function, sum, i, k));
            }
        }
    }
}

// Names of the numbers and texts of a ray query, by their slots.
constexpr const char* ray_numbers[] = {
#define SL_RAY_NUMBER(name, default, note) #name,
#include "runtime/abi/sl_ray_options.def"
};
constexpr const char* ray_texts[] = {
#define SL_RAY_TEXT(name, note) #name,
#include "runtime/abi/sl_ray_options.def"
};

Triple3 triple_of(const float* planes, std::uint32_t lane, std::uint32_t lanes) {
    return {planes[lane], planes[lanes + lane], planes[2 * lanes + lane]};
}

void put_triple(float* planes, std::uint32_t lane, std::uint32_t lanes, const Triple3& t) {
    for (std::size_t k = 0; k < 3; ++k) {
        planes[k * lanes + lane] = static_cast<float>(t[k]);
    }
}

RayQuestion question_of(const sl_ray_query& q, std::uint32_t lane) {
    RayQuestion r;
    const auto triple = [&](const float* planes) { return triple_of(planes, lane, q.lanes); };
    r.kind = q.kind;
    r.P = triple(q.P);
    r.D = triple(q.D);
    r.P_u = triple(q.P_u);
    r.P_v = triple(q.P_v);
    r.D_u = triple(q.D_u);
    r.D_v = triple(q.D_v);
    for (std::size_t i = 0; i < SL_RAY_OPTIONS; ++i) {
        if ((q.given >> i & 1U) != 0) {
            r.options[ray_numbers[i]] = Value(q.option[i][lane]);
        }
    }
    for (std::size_t i = 0; i < SL_RAY_TEXTS; ++i) {
        if (q.text[i] != nullptr) {
            r.options[ray_texts[i]] = Value(std::string(q.text[i]));
        }
    }
    r.angle = q.angle[lane];
    r.sample = q.sample;
    r.category = q.category != nullptr ? q.category : "";
    for (std::int32_t i = 0; i < q.num_channels; ++i) {
        const sl_ray_channel& c = q.channel[i];
        const auto type = static_cast<Type>(c.type);
        if (c.is_sent == 0) {
            r.wanted[c.name] = type;
            continue;
        }
        Value sent = Value::zero(type);
        for (std::size_t k = 0; k < sent.x.size(); ++k) {
            sent.x[k] = c.values[k * q.lanes + lane];
        }
        r.options[c.name] = sent;
    }
    return r;
}

void put_answer(sl_ray_query& q, std::uint32_t lane, const RayAnswer& a) {
    q.hit |= a.hit ? 1U << lane : 0;
    put_triple(q.C, lane, q.lanes, a.C);
    put_triple(q.Phit, lane, q.lanes, a.Phit);
    put_triple(q.Nhit, lane, q.lanes, a.Nhit);
    put_triple(q.Pmiss, lane, q.lanes, a.Pmiss);
    put_triple(q.Rmiss, lane, q.lanes, a.Rmiss);
    q.distance[lane] = static_cast<float>(a.distance);
    q.level_missed[lane] = static_cast<float>(a.level_missed);
    for (std::int32_t i = 0; i < q.num_channels; ++i) {
        sl_ray_channel& c = q.channel[i];
        const auto it = a.found.find(c.name);
        if (c.is_sent != 0 || it == a.found.end()) {
            continue;
        }
        c.set |= 1U << lane;
        for (std::size_t k = 0; k < it->second.x.size(); ++k) {
            c.values[k * q.lanes + lane] = static_cast<float>(it->second.x[k]);
        }
    }
}

} // namespace

void OracleWorld::answer(sl_ray_query& query) {
    for (std::uint32_t lane = 0; lane < query.lanes; ++lane) {
        if ((query.mask >> lane & 1U) != 0) {
            RayAnswer a;
            rays(static_cast<int>(query.first + lane), question_of(query, lane), a);
            put_answer(query, lane, a);
        }
    }
}

void OracleWorld::rays(int point, const RayQuestion& question, RayAnswer& answer) {
    const RayQuestion& q = question;
    double options = 0.25 * q.kind + 0.5 * q.angle + 0.25 * q.sample +
                     0.125 * static_cast<double>(q.category.size());
    const auto is_known = [](const std::string& name) {
        return std::ranges::find(ray_numbers, name) != std::end(ray_numbers) ||
               std::ranges::find(ray_texts, name) != std::end(ray_texts) ||
               name.starts_with("send:");
    };
    for (const auto& [name, value] : q.options) {
        if (!is_known(name)) {
            continue;
        }
        options += value.type == Type::String ? 0.125 * static_cast<double>(value.text().size())
                                              : 0.5 * std::tanh(value.f());
    }
    answer.hit = (point + q.sample) % 3 != 2;
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t n = (k + 1) % 3;
        const double spread = q.P_u[k] + 0.5 * q.P_v[k] + 0.25 * q.D_u[k] + 0.125 * q.D_v[k];
        answer.C[k] = 0.5 + 0.25 * std::sin(q.P[k] + 0.5 * q.D[n] + options) + 0.5 * spread;
        answer.Phit[k] = q.P[k] + 0.5 * q.D[k];
        answer.Nhit[k] = std::cos(q.D[k]);
        answer.Pmiss[k] = q.P[n];
        answer.Rmiss[k] = q.D[n] + 0.125;
    }
    answer.distance = 1 + 0.25 * std::tanh(q.P[0] + q.D[1]);
    answer.level_missed = point % 3 == 2 ? 1 : point % 3;
    for (const auto& [name, type] : q.wanted) { // directions of rays are known where they miss
        Value v = Value::zero(type);
        for (std::size_t k = 0; k < v.x.size(); ++k) {
            v.x[k] = answer.C[k] + 0.125 * static_cast<double>(name.size());
        }
        if (answer.hit || name.starts_with("ray:")) {
            answer.found[name] = v;
        }
    }
}

sl_services OracleWorld::services() {
    sl_services s{};
    s.light_count = [](void* engine) -> std::int32_t { return world_of(engine).num_lights(); };
    s.light = serve_light;
    s.ambient = serve_ambient;
    s.space = serve_space;
    s.message = serve_message;
    s.print = [](void* engine, std::uint32_t, sl_string text) { world_of(engine).print(text); };
    s.print_uniform = [](void* engine, std::uint32_t first, sl_string text) {
        if (world_of(engine).uniform_prints_.is_new(first, text)) {
            world_of(engine).print(text);
        }
    };
    s.intern = [](void* engine, const char* text) {
        return world_of(engine).strings().intern(text);
    };
    s.shader_name = [](void* engine, sl_string type) -> sl_string {
        return world_of(engine).strings().intern(world_of(engine).shader_name(type ? type : ""));
    };
    s.report = [](void*, std::int32_t, const char*) {};
    s.loop_steps = [](void*, std::uint32_t used, std::uint32_t, sl_string,
                      std::int32_t) -> std::uint32_t { return used < (1U << 20) ? 1U << 20 : 0; };
    s.not_a_number = [](void*, std::uint32_t, std::uint32_t, sl_string, std::int32_t, const char*) {
    };
    s.depth_range = [](void* engine, float* near_far) {
        double range[2];
        world_of(engine).depth_range(range[0], range[1]);
        near_far[0] = static_cast<float>(range[0]);
        near_far[1] = static_cast<float>(range[1]);
    };
    s.raylevel = [](void* engine) -> std::int32_t { return world_of(engine).raylevel(); };
    s.ray_kind = [](void*) -> std::int32_t { return SL_RAY_camera; };
    s.light_message = serve_light_message;
    s.match = [](void*, sl_string pattern, sl_string subject) -> std::int32_t {
        return base::Pattern(pattern).matches(subject) ? 1 : 0;
    };
    s.shadeop = serve_shadeop;
    s.solar_direction = [](void*, std::uint32_t, std::uint32_t, const float*, const float*,
                           float*) {};
    s.rays = [](void* engine, sl_ray_query* query) { world_of(engine).answer(*query); };
    return s;
}

double OracleWorld::shadeop_value(const std::string& function, double sum, int output,
                                  std::size_t component) {
    return 0.25 * sum + output + 0.125 * static_cast<double>(component) +
           static_cast<double>(function.size());
}

void OracleWorld::shadeop(const std::string& function, int, std::vector<Value>& values,
                          std::size_t num_outputs) {
    double sum = 0;
    for (std::size_t i = num_outputs; i < values.size(); ++i) {
        for (const double x : values[i].x) {
            sum += x;
        }
    }
    for (std::size_t i = 0; i < num_outputs; ++i) {
        for (std::size_t k = 0; k < values[i].x.size(); ++k) {
            values[i].x[k] = shadeop_value(function, sum, static_cast<int>(i), k);
        }
    }
}

float OracleWorld::input(std::size_t variable, int component, int point) {
    const auto k = static_cast<float>(variable * 3 + static_cast<std::size_t>(component));
    return 0.9F + 0.85F * std::sin(1.7F * k + 0.61F * static_cast<float>(point) + 0.3F);
}

bool OracleWorld::light(int index, int, const Triple3& P, const Triple3& axis, double cos_angle,
                        const std::string& category, LightSample& sample) {
    if (!in_category(index, category)) {
        return false;
    }
    sample.L = index == 0 ? Triple3{2 - P[0], 3 - P[1], -4 - P[2]} : Triple3{0.5, 1, 2};
    sample.Cl = index == 0 ? Triple3{1, 0.5, 0.25} : Triple3{0.125, 0.25, 0.5};
    sample.nondiffuse = index == 0 ? 0 : 0.25;
    sample.nonspecular = index == 0 ? 0.5 : 0;
    return cos_angle <= -1 || dot3(normalize3(sample.L), normalize3(axis)) >= cos_angle;
}

Triple3 OracleWorld::ambient(int point, const Triple3& P) {
    return {0.1 + 0.01 * point, 0.2 + 0.125 * P[0], 0.3};
}

bool OracleWorld::space(const std::string& from, const std::string& to, int point, Matrix16& m) {
    m = multiply(to_current(from, point), inverse(to_current(to, point)));
    return is_known(from) && is_known(to);
}

// Only "known" has an answer, and not at every third point.
bool OracleWorld::message(std::string_view function, const std::string& name, int point,
                          Value& value) {
    // attribute() and the like answer once for all points of the batch.
    const bool per_batch =
        function == "attribute" || function == "option" || function == "rendererinfo";
    if (name != "known" || value.type == Type::String || (!per_batch && point % 3 == 1)) {
        return false;
    }
    for (std::size_t k = 0; k < value.x.size(); ++k) {
        value.x[k] = 0.5 + 0.25 * static_cast<double>(k) + (per_batch ? 0 : 0.125 * point);
    }
    return true;
}

void OracleWorld::depth_range(double& near_z, double& far_z) {
    near_z = 0.5;
    far_z = 20;
}

} // namespace slc
