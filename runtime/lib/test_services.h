// SPDX-License-Identifier: Apache-2.0
// A complete engine for tests of compiled shaders and of built-in bodies: lights, spaces, messages,
// printed text and reports are plain data that a test sets or reads. Nothing is traced, no light
// shader runs. Not thread-safe.
//
//   rt::TestEngine engine(8);                 // lanes of the code under test
//   engine.lights.push_back({.position = {0, 0, 5}});
//   batch.services = &engine.services(); batch.engine = &engine;
#pragma once

#include "runtime/abi/sl_abi.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <regex.h>
#include <string>
#include <unordered_set>
#include <utility>
#include <vector>

namespace rt {

// A light without a shader: constant colour from a point (or against a direction), in current
// space.
struct TestLight {
    std::array<float, 3> position{}; // directional: the direction the light travels in
    std::array<float, 3> color{1, 1, 1};
    bool directional = false;
    bool falloff = false; // color / (L.L)
    float nondiffuse = 0, nonspecular = 0;
    std::string category = {}; // comma-separated list, as __category
    int samples = 1;           // more than one: answers that many times with `more`
};

// What message() finds under a name: one value for all points, or lane-dependent values by a
// function of the index.
struct TestMessage {
    int type = SL_TYPE_float;
    int array_length = 0;
    std::vector<float> values = {};
    std::vector<std::string> texts = {};
    std::uint32_t answers = ~0u; // lanes that know it
};

class TestEngine {
public:
    explicit TestEngine(int lanes) : lanes_(static_cast<std::uint32_t>(lanes)) {
#define SL_SERVICE(name, result, arguments, note) services_.name = name##_;
#include "runtime/abi/sl_services.def"
#undef SL_SERVICE
    }
    TestEngine(const TestEngine&) = delete;
    TestEngine& operator=(const TestEngine&) = delete;

    using Matrix = std::array<float, 16>;

    std::vector<TestLight> lights;
    std::array<float, 3> ambient_color{};
    std::map<std::pair<std::string, std::string>, Matrix> spaces; // (from, to); "current" for NULL
    // Spaces with a matrix per point: called with the index in the batch.
    std::map<std::pair<std::string, std::string>, std::function<Matrix(std::uint32_t)>>
        moving_spaces;
    std::map<std::pair<int, std::string>, TestMessage> messages; // (SL_MESSAGE_*, name)
    std::map<std::string, std::string> shader_names;             // "" = the running shader
    std::array<float, 2> clipping{0, 1};
    std::uint32_t max_loop_steps = 1 << 20;
    int ray_level = 0, ray_type = SL_RAY_camera;
    std::function<void(const std::string&, std::uint32_t first, std::uint32_t mask,
                       const sl_value* outputs, int num_outputs, const sl_value* inputs,
                       int num_inputs)>
        shadeop;

    // What map() answers for a channel and a lane; none: there are no maps.
    std::function<float(const sl_map_query&, int, std::uint32_t)> map;
    std::vector<sl_map_query> queries; // those that were asked
    std::vector<sl_ray_query> ray_queries;
    std::function<void(sl_ray_query&)> trace;

    std::vector<std::string> printed;
    std::vector<std::string> reports;
    int num_light_calls = 0;

    const sl_services& services() const {
        return services_;
    }
    void set_lanes(int lanes) {
        lanes_ = static_cast<std::uint32_t>(lanes);
    }
    sl_string text(const std::string& s) {
        return texts_.insert(s).first->c_str();
    }

private:
    static TestEngine& of(void* engine) {
        return *static_cast<TestEngine*>(engine);
    }

    static bool selected(const std::string& list, sl_string wanted) {
        const std::string w = wanted ? wanted : "";
        if (w.empty())
            return true;
        const bool exclude = w[0] == '-';
        const bool found =
            ("," + list + ",").find("," + w.substr(exclude ? 1 : 0) + ",") != std::string::npos;
        return exclude != found;
    }

    static std::int32_t light_count_(void* engine) {
        return static_cast<std::int32_t>(of(engine).lights.size());
    }

    static std::uint32_t light_(void* engine, const sl_light_query* query,
                                sl_light_result* result) {
        TestEngine& e = of(engine);
        const TestLight& light = e.lights[static_cast<std::size_t>(query->index)];
        e.num_light_calls++;
        e.sample_ = e.sample_ + 1 < light.samples ? e.sample_ + 1 : 0;
        result->more = e.sample_ != 0;
        if (!selected(light.category, query->category))
            return 0;
        for (std::uint32_t i = 0; i < query->lanes; i++)
            if (query->mask >> i & 1)
                light_lane(light, *query, i, *result);
        return query->mask;
    }

    static void light_lane(const TestLight& light, const sl_light_query& query, std::uint32_t i,
                           sl_light_result& result) {
        float squared = 0;
        for (std::uint32_t k = 0; k < 3; k++) {
            const float towards = light.directional
                                      ? -light.position[k]
                                      : light.position[k] - query.P[k * query.lanes + i];
            result.L[k * query.lanes + i] = towards;
            squared += towards * towards;
        }
        const float strength =
            (light.falloff ? 1 / squared : 1) / static_cast<float>(light.samples);
        for (std::uint32_t k = 0; k < 3; k++) {
            result.Cl[k * query.lanes + i] = light.color[k] * strength;
            result.Ol[k * query.lanes + i] = 1;
        }
        result.nondiffuse[i] = light.nondiffuse;
        result.nonspecular[i] = light.nonspecular;
    }

    static void ambient_(void* engine, std::uint32_t, std::uint32_t mask, const float*, float* C) {
        TestEngine& e = of(engine);
        for (std::uint32_t k = 0; k < 3; k++)
            for (std::uint32_t i = 0; i < e.lanes_; i++)
                if (mask >> i & 1)
                    C[k * e.lanes_ + i] = e.ambient_color[k];
    }

    static std::int32_t space_(void* engine, sl_string from, sl_string to, std::uint32_t first,
                               float* m) {
        TestEngine& e = of(engine);
        const std::pair<std::string, std::string> key(from ? from : "current", to ? to : "current");
        for (int i = 0; i < 16; i++)
            m[i] = i % 5 == 0 ? 1.0f : 0.0f;
        if (const auto moving = e.moving_spaces.find(key); moving != e.moving_spaces.end()) {
            for (std::uint32_t lane = 0; lane < e.lanes_; lane++) {
                const Matrix a = moving->second(first + lane);
                for (std::uint32_t i = 0; i < 16; i++)
                    m[i * e.lanes_ + lane] = a[i];
            }
            return 2;
        }
        const auto it = e.spaces.find(key);
        if (it == e.spaces.end()) {
            if (key.first != key.second)
                e.reports.push_back("unknown space " + key.first + " to " + key.second);
            return key.first == key.second;
        }
        for (std::size_t i = 0; i < 16; i++)
            m[i] = it->second[i];
        return 1;
    }

    static std::uint32_t message_(void* engine, std::int32_t kind, sl_string name,
                                  std::int32_t type, std::int32_t array_length, std::uint32_t,
                                  std::uint32_t mask, float* value) {
        TestEngine& e = of(engine);
        const auto it = e.messages.find({kind, name ? name : ""});
        if (it == e.messages.end() || it->second.type != type ||
            it->second.array_length != array_length)
            return 0;
        const TestMessage& found = it->second;
        const std::uint32_t set = mask & found.answers;
        for (std::uint32_t i = 0; i < e.lanes_; i++) {
            if (!(set >> i & 1))
                continue;
            for (std::size_t k = 0; k < found.texts.size(); k++)
                reinterpret_cast<sl_string*>(value)[k * e.lanes_ + i] = e.text(found.texts[k]);
            for (std::size_t k = 0; k < found.values.size(); k++)
                value[k * e.lanes_ + i] = found.values[k];
        }
        return set;
    }

    static std::uint32_t light_message_(void* engine, const sl_light_query* query, sl_string name,
                                        std::int32_t type, std::int32_t array_length,
                                        float* value) {
        return message_(engine, SL_MESSAGE_lightsource, name, type, array_length, query->first,
                        query->mask, value);
    }
    static std::int32_t match_(void*, sl_string pattern, sl_string subject) {
        regex_t regex;
        if (!pattern || !subject || regcomp(&regex, pattern, REG_NOSUB) != 0)
            return 0;
        const int found = regexec(&regex, subject, 0, nullptr, 0) == 0;
        regfree(&regex);
        return found;
    }
    // Calls shadeop, if a test has set it.
    static void shadeop_(void* engine, sl_string function, std::uint32_t first, std::uint32_t mask,
                         const sl_value* outputs, std::int32_t num_outputs, const sl_value* inputs,
                         std::int32_t num_inputs) {
        if (of(engine).shadeop)
            of(engine).shadeop(function, first, mask, outputs, num_outputs, inputs, num_inputs);
    }
    static void print_(void* engine, uint32_t, sl_string text) {
        of(engine).printed.emplace_back(text);
    }
    static void print_uniform_(void* engine, uint32_t, sl_string text) {
        of(engine).printed.emplace_back(text);
    }
    static sl_string intern_(void* engine, const char* text) {
        return of(engine).text(text);
    }
    static sl_string shader_name_(void* engine, sl_string type) {
        TestEngine& e = of(engine);
        return e.text(e.shader_names[type ? type : ""]);
    }
    static void report_(void* engine, std::int32_t, const char* text) {
        TestEngine& e = of(engine);
        for (const std::string& r : e.reports)
            if (r == text)
                return;
        e.reports.emplace_back(text);
    }
    static void depth_range_(void* engine, float* near_far) {
        near_far[0] = of(engine).clipping[0];
        near_far[1] = of(engine).clipping[1];
    }
    static std::uint32_t loop_steps_(void* engine, std::uint32_t used, std::uint32_t, sl_string,
                                     std::int32_t line) {
        TestEngine& e = of(engine);
        if (used < e.max_loop_steps)
            return e.max_loop_steps - used;
        report_(engine, line, "a loop does not end");
        return 0;
    }
    static void not_a_number_(void* engine, std::uint32_t, std::uint32_t, sl_string,
                              std::int32_t line, const char* text) {
        of(engine).reports.push_back(std::to_string(line) + ": " + text);
    }
    static std::int32_t raylevel_(void* engine) {
        return of(engine).ray_level;
    }
    static std::int32_t ray_kind_(void* engine) {
        return of(engine).ray_type;
    }

    // Every map is missing: reported once by name, the fill value for textures and environments.
    static void map_(void* engine, const sl_map_query* query, float* result) {
        TestEngine& e = of(engine);
        e.queries.push_back(*query);
        const bool fills = query->kind == SL_MAP_texture || query->kind == SL_MAP_environment;
        for (std::uint32_t i = 0; i < query->lanes; i++) {
            if (!(query->mask >> i & 1))
                continue;
            if (!e.map)
                report_(engine, 0, (std::string("no map ") + query->name[i]).c_str());
            for (int k = 0; k < query->num_channels; k++)
                result[static_cast<std::uint32_t>(k) * query->lanes + i] =
                    e.map   ? e.map(*query, k, i)
                    : fills ? query->option[SL_MAP_OPTION_fill][i]
                            : 0;
        }
    }
    static std::int32_t map_info_(void* engine, sl_string name, sl_string, std::int32_t,
                                  std::int32_t, void*) {
        report_(engine, 0, (std::string("no map ") + name).c_str());
        return 0;
    }
    static std::uint32_t bake_(void* engine, const sl_point_query* query) {
        report_(engine, 0, (std::string("not baked: ") + query->file).c_str());
        return 0;
    }
    static std::uint32_t texture3d_(void* engine, const sl_point_query* query) {
        report_(engine, 0, (std::string("no points ") + query->file).c_str());
        return 0;
    }
    // Without `trace` every ray misses: black, or nothing is in the way.
    static void rays_(void* engine, sl_ray_query* query) {
        TestEngine& e = of(engine);
        e.ray_queries.push_back(*query);
        if (e.trace) {
            e.trace(*query);
        }
    }
    static void solar_direction_(void* engine, std::uint32_t, std::uint32_t, const float* axis,
                                 const float*, float* L) {
        for (std::uint32_t k = 0; k < 3 * of(engine).lanes_ && axis != nullptr; ++k)
            L[k] = axis[k];
    }
    static sl_profile_row* profile_(void*) {
        return nullptr;
    }

    sl_services services_{};
    std::uint32_t lanes_;
    int sample_ = 0;
    std::unordered_set<std::string> texts_; // node-based: addresses stay
};

// A batch with its own memory: set() allocates the planes of a variable. n is rounded up to whole
// packets of 8.
class TestBatch {
public:
    TestBatch(std::uint32_t count, const TestEngine& engine)
        : count_(count), stride_((count + 7) / 8 * 8) {
        seeds_.resize((stride_ + 15) / 16);
        lit_.resize(stride_);
        for (std::uint32_t i = 0; i < stride_; i++)
            seeds_[i / 16].values[i % 16] = i * 2654435761u + 17;
        batch_.main = &points_;
        batch_.services = &engine.services();
        batch_.engine = const_cast<TestEngine*>(&engine);
        batch_.seed = seeds_[0].values;
        batch_.lit = lit_.data();
        batch_.count = count_;
        batch_.stride = stride_;
    }
    TestBatch(const TestBatch&) = delete;
    TestBatch& operator=(const TestBatch&) = delete;

    // Planes of variable `id`, zeroed when new; plane k of point i is [k * stride() + i].
    float* set(sl_variable id, int components) {
        auto& memory = planes_[id];
        if (memory.empty()) {
            memory.resize((stride_ * static_cast<std::uint32_t>(components) + 15) / 16);
            points_.var[id] = memory[0].values;
        }
        return points_.var[id];
    }
    void set_triple(sl_variable id, std::uint32_t point, const std::array<float, 3>& v) {
        float* base = set(id, 3);
        for (std::uint32_t k = 0; k < 3; k++)
            base[k * stride_ + point] = v[k];
    }
    std::uint32_t stride() const { return stride_; }
    std::uint32_t count() const { return count_; }
    sl_batch& batch() { return batch_; }
    std::uint32_t lit(std::uint32_t packet) const { return lit_[packet]; }

private:
    struct alignas(64) Line {
        float values[16] = {};
    };
    struct alignas(64) SeedLine {
        std::uint32_t values[16] = {};
    };
    std::uint32_t count_, stride_;
    sl_points points_{};
    sl_batch batch_{};
    std::map<int, std::vector<Line>> planes_;
    std::vector<SeedLine> seeds_;
    std::vector<std::uint32_t> lit_;
};

} // namespace rt
