// SPDX-License-Identifier: Apache-2.0
// Services that shaders call while they run. Each entry unpacks the Execution and hands over to the
// part that knows: lights, messages, spaces. Nothing here allocates per point.
#include "tracer/services.h"

#include "tracer/execution.h"
#include "tracer/lights.h"
#include "tracer/messages.h"
#include "tracer/pattern_cache.h"
#include "tracer/pixel_trace.h"
#include "tracer/ray_queries.h"
#include "tracer/shadeop_call.h"
#include "tracer/shader_profile.h"
#include "tracer/shader_set.h"
#include "tracer/texture_frame.h"

#include <algorithm>
#include <bit>
#include <string_view>

namespace trace {

namespace {

constexpr std::string_view current_space = "current";

Execution& of(void* engine) {
    return *static_cast<Execution*>(engine);
}

// --- spaces

const rib::Attributes* attributes_of(const Execution& execution) {
    const BatchSubject* subject = execution.subject;
    return subject != nullptr && subject->attributes < execution.frame.scene.attributes.size()
               ? &execution.frame.scene.attributes[subject->attributes]
               : nullptr;
}

// Object space of the first point: batches that name it hold one object space only
// (SL_FACT_object_space). Lights, imagers and parameter defaults have no object: shader space
// stands in ([R] of sl.md 5.9).
base::Mat4 camera_from_object(const Execution& execution) {
    const bool has_object = execution.asked_by == nullptr && execution.subject != nullptr &&
                            !execution.subject->hits.empty() && execution.frame.world != nullptr;
    if (!has_object) {
        return execution.running.camera_from_shader;
    }
    const geo::Hit& hit = execution.subject->hits.front();
    return execution.frame.world->camera_from_object(hit, hit.time);
}

std::optional<Space> find_space(const Execution& execution, std::string_view name) {
    if (name.empty() || name == current_space) {
        return Space{};
    }
    if (name == "shader") {
        return Space::from(execution.running.camera_from_shader);
    }
    if (name == "object") {
        return Space::from(camera_from_object(execution));
    }
    const Space* named = execution.frame.spaces.find(name, attributes_of(execution));
    return named != nullptr ? std::optional<Space>(*named) : std::nullopt;
}

void report_unknown_space(const Execution& execution, std::string_view name) {
    report_shader(execution, base::Severity::Warning, 0,
                  "coordinate system \"" + std::string(name) +
                      "\" is unknown; nothing is transformed");
}

SpaceCache::Item lookup_space(const Execution& execution, sl_string from, sl_string to) {
    SpaceCache::Item item{from, to};
    // No name means current space.
    const auto from_space = find_space(execution, from != nullptr ? from : "");
    const auto to_space = find_space(execution, to != nullptr ? to : "");
    if (!from_space) {
        report_unknown_space(execution, from);
    }
    if (!to_space) {
        report_unknown_space(execution, to);
    }
    item.known = from_space && to_space;
    const base::Mat4 m =
        item.known ? to_space->space_from_camera * from_space->camera_from_space : base::Mat4{};
    for (std::size_t i = 0; i < 16; ++i) {
        item.m[i] = static_cast<float>(m.m[i / 4][i % 4]);
    }
    return item;
}

int32_t space(void* engine, sl_string from, sl_string to, uint32_t /*first*/, float* m) {
    Execution& execution = of(engine);
    SpaceCache& cache = execution.spaces;
    const auto end = cache.items.begin() + static_cast<std::ptrdiff_t>(cache.size);
    const auto it = std::find_if(cache.items.begin(), end, [&](const SpaceCache::Item& item) {
        return item.from == from && item.to == to;
    });
    if (it != end) {
        std::copy(it->m.begin(), it->m.end(), m);
        return it->known ? 1 : 0;
    }
    const SpaceCache::Item item = lookup_space(execution, from, to);
    if (cache.size < SpaceCache::capacity) {
        cache.items[cache.size++] = item;
    }
    std::copy(item.m.begin(), item.m.end(), m);
    return item.known ? 1 : 0;
}

// --- lights

// Shaders that are asked for their opacity alone see no lights.
int32_t light_count(void* engine) {
    const Execution& execution = of(engine);
    const bool has_lights = execution.ray_kind != SL_RAY_shadow && execution.thread != nullptr &&
                            execution.subject != nullptr && execution.subject->lights != nullptr;
    return has_lights ? static_cast<int32_t>(execution.subject->lights->directional.size()) : 0;
}

uint32_t light(void* engine, const sl_light_query* query, sl_light_result* result) {
    return query->index < light_count(engine) ? run_light(of(engine), *query, *result) : 0;
}

void ambient(void* engine, uint32_t first, uint32_t mask, const float* P, float* C) {
    run_ambient(of(engine), first, mask, P, C);
}

// --- state

uint32_t message(void* engine, int32_t kind, sl_string name, int32_t type, int32_t array_length,
                 uint32_t first, uint32_t mask, float* value) {
    const Execution& execution = of(engine);
    return answer_message(execution,
                          {kind, name, type, array_length, first, mask, value, execution.lanes()});
}

uint32_t light_message(void* engine, const sl_light_query* query, sl_string name, int32_t type,
                       int32_t array_length, float* value) {
    return query->index < light_count(engine)
               ? answer_light_message(of(engine), *query, name, type, array_length, value)
               : 0;
}

int32_t match(void* engine, sl_string pattern, sl_string subject) {
    return match_pattern(of(engine), pattern, subject) ? 1 : 0;
}

void shadeop(void* engine, sl_string function, uint32_t /*first*/, uint32_t mask,
             const sl_value* outputs, int32_t num_outputs, const sl_value* inputs,
             int32_t num_inputs) {
    call_shadeop(of(engine), function, mask, {outputs, static_cast<std::size_t>(num_outputs)},
                 {inputs, static_cast<std::size_t>(num_inputs)});
}

// A light runs for whole packets, of which some lanes only were asked about: those print.
bool may_print(const Execution& execution, std::uint32_t point, std::uint32_t num_points) {
    const std::uint32_t lanes = ((1ULL << num_points) - 1) << point & 0xffffffffU;
    return execution.asked_by == nullptr || (execution.asked_mask & lanes) != 0;
}

void print(void* engine, uint32_t point, sl_string text) {
    Execution& execution = of(engine);
    ThreadState* thread = execution.thread;
    if (thread == nullptr || !may_print(execution, point, 1)) {
        return;
    }
    if (thread->trace != nullptr) {
        thread->trace->printed(execution.asked_first + point, text);
    } else {
        thread->printed += text;
    }
}

void print_uniform(void* engine, uint32_t first, sl_string text) {
    Execution& execution = of(engine);
    ThreadState* thread = execution.thread;
    if (thread == nullptr || !may_print(execution, first, execution.lanes())) {
        return;
    }
    if (thread->trace != nullptr) {
        thread->trace->printed_uniform(execution.asked_first + first, execution.lanes(), text);
    } else if (execution.uniform_prints.is_new(execution.asked_first + first, text)) {
        thread->printed += text;
    }
}

sl_string intern(void* engine, const char* text) {
    return of(engine).frame.strings.intern(text);
}

sl_string shader_name(void* engine, sl_string type) {
    const Execution& execution = of(engine);
    return execution.frame.strings.intern(type == nullptr ? execution.running.name
                                                          : bound_shader_name(execution, type));
}

void report(void* engine, int32_t line, const char* text) {
    report_shader(of(engine), base::Severity::Warning, line, text);
}

uint32_t loop_steps(void* engine, uint32_t used, uint32_t mask, sl_string file, int32_t line) {
    Execution& execution = of(engine);
    const FrameContext& frame = execution.frame;
    ThreadState* thread = execution.thread;
    if (thread != nullptr && frame.interrupted != nullptr && frame.interrupted()) {
        thread->is_abandoned = true;
        return 0;
    }
    if (used < frame.max_loop_steps) {
        return frame.max_loop_steps - used;
    }
    if (thread != nullptr) {
        thread->counters.add(Counter::stopped_points,
                             static_cast<std::uint64_t>(std::popcount(mask)));
    }
    if (mask != 0) {
        report_shader(execution, base::Severity::Warning, line,
                      "a loop did not end in " + std::to_string(frame.max_loop_steps) +
                          " rounds; its points keep the results they came with (Option "
                          "\"limits\" \"loopsteps\")",
                      file);
    }
    return 0;
}

void not_a_number(void* engine, uint32_t first, uint32_t mask, sl_string file, int32_t line,
                  const char* text) {
    Execution& execution = of(engine);
    BadPlace* place = execution.frame.bad_place;
    const auto lanes = static_cast<std::uint32_t>(std::popcount(mask));
    if (place != nullptr && !place->is_found() && place->shader == &execution.running &&
        may_print(execution, first + static_cast<std::uint32_t>(std::countr_zero(mask)), lanes)) {
        place->file = file;
        place->line = line;
        place->text = text;
    }
}

void depth_range(void* engine, float* near_far) {
    const rib::Options& options = of(engine).frame.scene.options;
    near_far[0] = options.near_clip;
    near_far[1] = options.far_clip;
}

// --- maps

// Once per map and mistake, whichever shader met it first.
void report_map(const Execution& execution, const std::string& text) {
    execution.frame.diag.report_once("map: " + text, base::Severity::Error, base::Code::NoFile,
                                     execution.running.pos,
                                     "shader \"" + execution.running.name + "\": " + text);
}

ShadowBias bias_of(const Execution& execution) {
    const rib::Attributes* attributes = attributes_of(execution);
    if (attributes != nullptr && !attributes->user.empty()) {
        if (const ShadowBias bias = shadow_bias(*attributes->user); bias.given) {
            return bias;
        }
    }
    return execution.frame.textures->default_bias();
}

Counter counter_of(int kind) {
    switch (kind) {
    case SL_MAP_shadow:
    case SL_MAP_occlusion:
        return Counter::map_shadow;
    case SL_MAP_environment:
    case SL_MAP_irradiance:
        return Counter::map_environment;
    default:
        return Counter::map_texture;
    }
}

void map(void* engine, const sl_map_query* query, float* result) {
    const Execution& execution = of(engine);
    if (execution.frame.textures == nullptr || execution.thread == nullptr) {
        return; // parameters are being bound: there are no maps yet
    }
    execution.thread->counters.add(counter_of(query->kind),
                                   static_cast<std::uint64_t>(std::popcount(query->mask)));
    const bool is_shadow = query->kind == SL_MAP_shadow || query->kind == SL_MAP_occlusion;
    execution.frame.textures->lookup(
        *query, is_shadow ? bias_of(execution) : ShadowBias{},
        [&execution](const std::string& text) { report_map(execution, text); }, result);
}

// True if a value of this type takes what is known.
bool fits(int32_t type, int32_t array_length, std::size_t count) {
    const std::size_t items = array_length > 0 ? static_cast<std::size_t>(array_length) : 1;
    return (type == SL_TYPE_float && items == count) ||
           (type == SL_TYPE_matrix && array_length == 0 && count == 16);
}

int32_t map_info(void* engine, sl_string name, sl_string key, int32_t type, int32_t array_length,
                 void* value) {
    const Execution& execution = of(engine);
    if (execution.frame.textures == nullptr) {
        return 0;
    }
    const TextureFrame::Info& info = execution.frame.textures->info(name, key);
    if (type == SL_TYPE_string && !info.text.empty()) {
        *static_cast<sl_string*>(value) = execution.frame.strings.intern(info.text);
        return 1;
    }
    if (info.numbers.empty() || !fits(type, array_length, info.numbers.size())) {
        return 0;
    }
    std::copy(info.numbers.begin(), info.numbers.end(), static_cast<float*>(value));
    return 1;
}

// World space, unless the shader says otherwise.
base::Mat4 file_from_current(const Execution& execution, sl_string space) {
    const std::string_view name = space != nullptr && space[0] != 0 ? space : "world";
    const auto found = find_space(execution, name);
    if (!found) {
        report_unknown_space(execution, name);
    }
    return found ? found->space_from_camera : base::Mat4{};
}

uint32_t bake(void* engine, const sl_point_query* query) {
    const Execution& execution = of(engine);
    if (execution.frame.textures == nullptr || execution.thread == nullptr) {
        return 0;
    }
    if (execution.thread->wanted != nullptr) {
        return query->mask; // a rehearsal
    }
    const std::uint32_t taken = execution.frame.textures->textures().points().add(
        *query, file_from_current(execution, query->space));
    if (taken == 0 && query->mask != 0) {
        report_map(execution,
                   "samples for \"" + std::string(query->file) +
                       "\" differ from its first ones, or it is full; they are left out");
    }
    return taken;
}

uint32_t texture3d(void* engine, const sl_point_query* query) {
    const Execution& execution = of(engine);
    if (execution.frame.textures == nullptr) {
        return 0;
    }
    const TextureFrame& textures = *execution.frame.textures;
    const auto path = find_map(query->file, textures.directories());
    std::string error = path ? "" : "no such file";
    const std::uint32_t set =
        path ? textures.textures().points().lookup(
                   *path, *query, file_from_current(execution, query->space), error)
             : 0;
    if (!error.empty()) {
        report_map(execution,
                   "cannot read the points \"" + std::string(query->file) + "\": " + error);
    }
    return set;
}

int32_t raylevel(void* engine) {
    return of(engine).ray_level;
}

int32_t ray_kind(void* engine) {
    return of(engine).ray_kind;
}

void rays(void* engine, sl_ray_query* query) {
    answer_rays(of(engine), *query);
}

void solar_direction(void* engine, uint32_t first, uint32_t mask, const float* axis,
                     const float* angle, float* L) {
    choose_solar_direction(of(engine), {first, mask, axis, angle, L});
}

sl_profile_row* profile(void* engine) {
    const Execution& execution = of(engine);
    const bool is_counted = execution.thread != nullptr && execution.thread->profile != nullptr &&
                            execution.batch != nullptr;
    return is_counted ? execution.thread->profile->rows(execution.batch->instance().object())
                      : nullptr;
}

} // namespace

const sl_services& service_table() {
    static constexpr sl_services table = {
#define SL_SERVICE(name, result, arguments, note) .name = name,
#include "runtime/abi/sl_services.def"
#undef SL_SERVICE
    };
    return table;
}

} // namespace trace
