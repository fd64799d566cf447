// SPDX-License-Identifier: Apache-2.0
#include "tracer/pixel_trace.h"

#include "tracer/lights.h"
#include "tracer/pixel_trace_text.h"
#include "tracer/shader_set.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

namespace trace {

namespace {

// Samples told in full; of the rest the results only.
constexpr std::size_t max_told = 64;

void line(std::string& to, int level, const std::string& text) {
    to.append(2 * static_cast<std::size_t>(level), ' ');
    to += text;
    to += '\n';
}

std::string triple(const float* planes, std::size_t stride, std::size_t i) {
    const float values[] = {planes[i], planes[stride + i], planes[2 * stride + i]};
    return numbers_text(values);
}

// Levels of indentation.
enum Level : int { at_sample = 1, at_ray = 2, at_hit = 3, at_shader = 4, at_light = 5 };

void append_parameters(std::string& to, int level, rt::ShadeBatch& batch, std::uint32_t point) {
    const sl_object& object = batch.instance().object();
    for (int p = 0; p < object.num_params; ++p) {
        const sl_param& param = object.params[p];
        line(to, level,
             "parameter " + rt::type_text(param.type, param.array_length) + " " + param.name +
                 " = " + parameter_text(batch, p, point));
    }
}

} // namespace

// --- whose text

PixelTrace::SampleText* PixelTrace::of_sample(std::uint32_t sample) {
    const auto it = std::find_if(samples_.begin(), samples_.end(), [&](const SampleText& s) {
        return s.sample == sample && s.pass == pass_;
    });
    return it == samples_.end() ? nullptr : &*it;
}

PixelTrace::SampleText* PixelTrace::of_point(std::size_t point) {
    return point < sample_of_point_.size() ? of_sample(sample_of_point_[point]) : nullptr;
}

std::string PixelTrace::place(base::SourcePos pos) const {
    const std::string file = frame_.diag.file_name(pos.file_id);
    return file.empty() ? std::string() : " (" + file + ":" + std::to_string(pos.line) + ")";
}

// --- rays

namespace {

std::string ray_title(int level, bool is_first) {
    return level > 0 ? "ray of level " + std::to_string(level)
                     : std::string(is_first ? "camera ray" : "ray goes on");
}

} // namespace

void PixelTrace::begin_pass(const SampleBlock& block) {
    ++pass_;
    for (std::uint32_t i = 0; i < block.count && samples_.size() < max_told; ++i) {
        if (block.px[i] != x_ || block.py[i] != y_) {
            continue;
        }
        SampleText& s = samples_.emplace_back();
        s.sample = i;
        s.pass = pass_;
        std::string head = "sample " + std::to_string(samples_.size() - 1) + ": raster " +
                           number_text(static_cast<float>(block.px[i]) + block.x[i]) + " " +
                           number_text(static_cast<float>(block.py[i]) + block.y[i]) + ", time " +
                           number_text(block.time[i]);
        if (!block.lens_x.empty()) {
            head += ", lens " + number_text(block.lens_x[i]) + " " + number_text(block.lens_y[i]);
        }
        line(s.text, at_sample, head);
    }
}

void PixelTrace::ray(std::uint32_t sample, const geo::RayPacket& packet, std::size_t lane,
                     const geo::Hit& hit, int level) {
    SampleText* s = of_sample(sample);
    if (s == nullptr) {
        return;
    }
    const float origin[] = {packet.ox[lane], packet.oy[lane], packet.oz[lane]};
    const float direction[] = {packet.dx[lane], packet.dy[lane], packet.dz[lane]};
    line(s->text, at_ray,
         ray_title(level, s->num_hits == 0) + " from " + numbers_text(origin) + " along " +
             numbers_text(direction) + ", t " + number_text(packet.tnear[lane]) + " to " +
             number_text(packet.tfar[lane]));
    if (level == 0) {
        s->is_hit = hit.valid();
        s->num_hits += hit.valid() ? 1 : 0;
    }
    if (hit.valid()) {
        describe_hit(*s, packet, lane, hit, level);
    } else {
        line(s->text, at_ray, "meets nothing");
    }
}

std::string PixelTrace::primitive_title(const geo::Hit& hit) const {
    const geo::Binding binding = frame_.world->binding(hit);
    const rib::Scene& scene = frame_.scene;
    const bool in_object = binding.object != geo::no_id;
    const auto& primitives =
        in_object ? scene.objects[binding.object].primitives.get() : scene.primitives;
    std::string text = "primitive";
    if (binding.primitive < primitives.size()) {
        const rib::Primitive& primitive = primitives[binding.primitive];
        text = shape_name(primitive) + place(primitive.pos);
    }
    const rib::Param* name = scene.attributes[binding.attributes].find("identifier:name");
    if (name != nullptr && !name->strings.empty()) {
        text += " " + quoted(name->strings.front());
    }
    if (in_object) {
        text += ", member of object " + quoted(scene.objects[binding.object].handle);
        text += hit.instance < scene.instances.size() ? place(scene.instances[hit.instance].pos)
                                                      : std::string();
    }
    return text;
}

// Where it is, by the function that fills shader variables.
void PixelTrace::describe_hit(SampleText& to, const geo::RayPacket& packet, std::size_t lane,
                              const geo::Hit& hit, int level) {
    constexpr std::uint32_t stride = 8;
    const auto one = [&](const float* values) { return std::span<const float>(values + lane, 1); };
    const float footprint = 0;
    const geo::Incident incident{one(packet.ox), one(packet.oy), one(packet.oz), one(packet.dx),
                                 one(packet.dy), one(packet.dz), {&footprint, 1}};
    alignas(64) float planes[5][3 * stride] = {};
    sl_points points{};
    constexpr sl_variable ids[] = {SL_VAR_P, SL_VAR_N, SL_VAR_Ng, SL_VAR_u, SL_VAR_v};
    std::uint64_t needed = 0;
    for (std::size_t i = 0; i < std::size(ids); ++i) {
        points.var[ids[i]] = planes[i];
        needed |= 1ULL << ids[i];
    }
    frame_.world->fill({&hit, 1}, incident, needed, stride, points, nullptr, nullptr);
    const auto value = [&](std::size_t i) {
        return base::V3f(planes[i][0], planes[i][stride], planes[i][2 * stride]);
    };
    const std::string number = level == 0 ? " " + std::to_string(to.num_hits) : std::string();
    line(to.text, at_ray, "hit" + number + ": " + primitive_title(hit));
    line(to.text, at_hit,
         "t " + number_text(hit.t) + ", u " + number_text(planes[3][0]) + ", v " +
             number_text(planes[4][0]) + ", part " + std::to_string(hit.part));
    std::string P = "P  " + triple(planes[0], stride, 0) + " camera";
    if (const Space* world = frame_.spaces.find("world")) {
        P += ", " + vector_text(base::point(world->space_from_camera, base::V3d(value(0)))) +
             " world";
    }
    line(to.text, at_hit, P);
    line(to.text, at_hit, "N  " + triple(planes[1], stride, 0) + " camera");
    const base::V3f direction(packet.dx[lane], packet.dy[lane], packet.dz[lane]);
    line(to.text, at_hit,
         "Ng " + triple(planes[2], stride, 0) + " camera, " +
             (base::dot(value(2), direction) < 0 ? "facing the ray" : "facing away"));
}

// --- shaders

void PixelTrace::begin_batch(std::span<const std::uint32_t> sample_of_point) {
    sample_of_point_.assign(sample_of_point.begin(), sample_of_point.end());
}

void PixelTrace::before_shader(const Execution& execution, rt::ShadeBatch& batch) {
    const ShaderEntry& shader = execution.running;
    const sl_object& object = shader.object();
    for (std::uint32_t i = 0; i < batch.count(); ++i) {
        SampleText* s = of_point(i);
        if (s == nullptr) {
            continue;
        }
        line(s->text, at_hit,
             std::string(shader_type_name(static_cast<sl_shader_type>(object.type))) + " shader " +
                 quoted(shader.name) + place(shader.pos));
        s->lights_told.clear();
        append_parameters(s->text, at_shader, batch, i);
        for (int id = 0; id < SL_VAR_COUNT; ++id) {
            const auto variable = static_cast<sl_variable>(id);
            if ((object.needed >> id & 1U) != 0 && batch.has(variable)) {
                line(s->text, at_shader,
                     "variable " + std::string(variable_type(variable)) + " " +
                         std::string(variable_name(variable)) + " = " +
                         variable_text(batch, variable, i));
            }
        }
    }
}

void PixelTrace::after_shader(const Execution& execution, rt::ShadeBatch& batch) {
    const sl_object& object = execution.running.object();
    for (std::uint32_t i = 0; i < batch.count(); ++i) {
        SampleText* s = of_point(i);
        if (s == nullptr) {
            continue;
        }
        for (int id = 0; id < SL_VAR_COUNT; ++id) {
            const auto variable = static_cast<sl_variable>(id);
            if ((object.written >> id & 1U) != 0 && batch.has(variable)) {
                line(s->text, at_shader,
                     "sets " + std::string(variable_name(variable)) + " = " +
                         variable_text(batch, variable, i));
            }
        }
        for (int p = 0; p < object.num_params; ++p) {
            if (object.params[p].is_output != 0) {
                line(s->text, at_shader,
                     std::string("sets output ") + object.params[p].name + " = " +
                         parameter_text(batch, p, i));
            }
        }
    }
}

void PixelTrace::answered(std::uint32_t sample, const ShaderEntry& shader, const Answer& answer) {
    if (SampleText* s = of_sample(sample)) {
        line(s->text, at_shader,
             "rays answer shader " + quoted(shader.name) + " at level " +
                 std::to_string(answer.level) + ": color " + numbers_text(answer.color) +
                 ", distance " + number_text(answer.distance));
    }
}

void PixelTrace::printed(std::uint32_t point, std::string_view text) {
    if (SampleText* s = of_point(point)) {
        line(s->text, at_shader, "prints " + quoted(text));
    }
}

void PixelTrace::printed_uniform(std::uint32_t first, std::uint32_t lanes, std::string_view text) {
    for (std::uint32_t lane = 0; lane < lanes; ++lane) {
        printed(first + lane, text);
    }
}

void PixelTrace::shaded(std::span<const std::uint32_t> members, std::span<const Sample> results) {
    for (std::size_t i = 0; i < members.size(); ++i) {
        if (SampleText* s = of_point(i)) {
            const Sample& result = results[members[i]];
            line(s->text, at_hit,
                 "shaded: color " + numbers_text(result.color) + ", opacity " +
                     numbers_text(result.opacity));
        }
    }
}

void PixelTrace::reused(std::uint32_t sample, float x_px, float y_px, const Sample& result) {
    if (SampleText* s = of_sample(sample)) {
        line(s->text, at_hit,
             "shading reused from the sample at raster " + number_text(x_px) + " " +
                 number_text(y_px) + ": color " + numbers_text(result.color) + ", opacity " +
                 numbers_text(result.opacity));
    }
}

// --- lights

// A light is asked several times by one shader; its parameters are told once.
void PixelTrace::tell_light(SampleText& to, rib::LightId id, rt::ShadeBatch& batch,
                            std::uint32_t lane, const std::string& result) {
    const ShaderEntry& shader = *(*frame_.lights)[id].shader;
    line(to.text, at_shader,
         "light " + quoted(frame_.scene.lights[id].handle) + ", shader " + quoted(shader.name) +
             place(shader.pos) + ": " + result);
    if (std::find(to.lights_told.begin(), to.lights_told.end(), id) == to.lights_told.end()) {
        to.lights_told.push_back(id);
        append_parameters(to.text, at_light, batch, lane);
    }
}

void PixelTrace::light(rib::LightId id, rt::ShadeBatch& batch, const sl_light_query& query,
                       const sl_light_result& result, std::uint32_t reached,
                       std::uint32_t shadowed) {
    for (std::uint32_t lane = 0; lane < query.lanes; ++lane) {
        SampleText* s = (query.mask >> lane & 1U) != 0 ? of_point(query.first + lane) : nullptr;
        if (s == nullptr) {
            continue;
        }
        if ((reached >> lane & 1U) == 0) {
            tell_light(*s, id, batch, lane, "does not reach");
            continue;
        }
        const char* shadow = !(*frame_.lights)[id].casts_shadows ? "no shadows asked for"
                             : (shadowed >> lane & 1U) != 0      ? "in shadow"
                                                                 : "not in shadow";
        tell_light(*s, id, batch, lane,
                   "L " + triple(result.L, query.lanes, lane) + ", Cl " +
                       triple(result.Cl, query.lanes, lane) + ", Ol " +
                       triple(result.Ol, query.lanes, lane) + ", " + shadow);
    }
}

void PixelTrace::ambient(rib::LightId id, rt::ShadeBatch& batch, std::uint32_t first,
                         std::uint32_t mask) {
    const float* Cl = batch.points().var[SL_VAR_Cl];
    for (std::uint32_t rest = Cl != nullptr ? mask : 0; rest != 0; rest &= rest - 1) {
        const auto lane = static_cast<std::uint32_t>(std::countr_zero(rest));
        if (SampleText* s = of_point(first + lane)) {
            tell_light(*s, id, batch, lane, "ambient, Cl " + triple(Cl, batch.stride(), lane));
        }
    }
}

// The first thing a shadow ray meets, whatever becomes of the light there.
std::string PixelTrace::first_on(const geo::RayPacket& rays, std::uint32_t lane) const {
    geo::RayPacket one = rays;
    one.active = 1U << lane;
    geo::Hit hits[geo::RayPacket::size];
    frame_.world->intersect(one, hits);
    if (!hits[lane].valid()) {
        return "";
    }
    return " by " + primitive_title(hits[lane]) + " at t " + number_text(hits[lane].t);
}

void PixelTrace::shadow_rays(std::uint32_t first, const geo::RayPacket& rays, const float* passes) {
    for (std::uint32_t rest = rays.active; rest != 0; rest &= rest - 1) {
        const auto lane = static_cast<std::uint32_t>(std::countr_zero(rest));
        SampleText* s = of_point(first + lane);
        if (s == nullptr) {
            continue;
        }
        const float origin[] = {rays.ox[lane], rays.oy[lane], rays.oz[lane]};
        const float direction[] = {rays.dx[lane], rays.dy[lane], rays.dz[lane]};
        const float left[] = {passes[lane], passes[8 + lane], passes[16 + lane]};
        const bool is_open = left[0] == 1 && left[1] == 1 && left[2] == 1;
        const bool is_blocked = left[0] == 0 && left[1] == 0 && left[2] == 0;
        line(s->text, at_shader,
             "shadow ray from " + numbers_text(origin) + " along " + numbers_text(direction) +
                 ", t 0 to " + number_text(rays.tfar[lane]) + ": " +
                 (is_open ? "open"
                  : is_blocked
                      ? "blocked" + first_on(rays, lane)
                      : "filtered to " + numbers_text(left) + ", first" + first_on(rays, lane)));
    }
}

// --- layers

void PixelTrace::composited(std::span<const Sample> samples) {
    for (SampleText& s : samples_) {
        if (s.is_hit && s.pass == pass_) {
            const Sample& so_far = samples[s.sample];
            line(s.text, at_ray,
                 "so far: color " + numbers_text(so_far.color) + ", opacity " +
                     numbers_text(so_far.opacity) + ", z " + number_text(so_far.z));
            s.is_hit = false;
        }
    }
}

void PixelTrace::continues(std::uint32_t sample, std::span<const float> transmitted) {
    if (SampleText* s = of_sample(sample)) {
        line(s->text, at_ray, "what lies behind shows by " + numbers_text(transmitted));
    }
}

void PixelTrace::end_bucket(const SampleBuffer& samples) {
    kept_ = samples;
}

// --- the pixel

namespace {

// The samples of the pixel and of its neighbours with their weights, in the order the film adds
// them.
template <class Body>
void for_weights(const Sampler& sampler, const FilterWeights& weights, int x, int y,
                 const Body& body) {
    std::size_t neighbour = 0;
    for (int dy = -weights.reach_y(); dy <= weights.reach_y(); ++dy) {
        const PixelHash hash(y + dy);
        for (int dx = -weights.reach_x(); dx <= weights.reach_x(); ++dx, ++neighbour) {
            const std::size_t slot =
                sampler.pattern(hash(x + dx)) * weights.neighbours() + neighbour;
            const FilterWeights::Span span = weights.span(slot);
            for (int s = span.first; s < span.last; ++s) {
                body(x + dx, y + dy, s, weights.weights(slot)[s]);
            }
        }
    }
}

} // namespace

namespace {

struct KeptSample {
    const Sample* sample = nullptr; // null: the pixel did not get it
    float density = 1;              // what its filter weight is multiplied by
};

KeptSample kept_sample(const SampleBuffer& kept, const Sampler& sampler, int x, int y,
                       std::size_t number) {
    const std::size_t first = kept.part(x, y).first;
    if (kept.begins.empty()) {
        return {&kept.samples[first + number], 1};
    }
    const auto most = static_cast<std::size_t>(sampler.per_quarter());
    const auto* const begins = kept.begins.data() + kept.pixel(x, y) * quarters;
    const std::size_t begin = begins[number / most], count = begins[number / most + 1] - begin;
    if (number % most >= count) {
        return {};
    }
    return {&kept.samples[begin + number % most],
            static_cast<float>(most) / static_cast<float>(count)};
}

// Numbers of the samples of a pixel in the order they were taken: the first few of every quarter,
// then the rest.
std::vector<std::size_t> numbers_taken(const Sampler& sampler) {
    const auto all = static_cast<std::size_t>(sampler.per_pixel());
    const auto first = static_cast<std::size_t>(sampler.settings().least / quarters);
    const auto most = static_cast<std::size_t>(sampler.per_quarter());
    std::vector<std::size_t> out(all);
    std::iota(out.begin(), out.end(), 0U);
    if (first > 0) {
        std::ranges::stable_partition(out, [&](std::size_t n) { return n % most < first; });
    }
    return out;
}

} // namespace

void PixelTrace::append_filter(const Sampler& sampler, const FilterWeights& weights) {
    float sum = 0;
    line(text_, at_sample, "filter: weight, sample, color, opacity");
    for_weights(sampler, weights, x_, y_, [&](int x, int y, int s, float weight) {
        if (!kept_.pixels.contains(x, y)) {
            return;
        }
        const KeptSample kept = kept_sample(kept_, sampler, x, y, static_cast<std::size_t>(s));
        if (kept.sample == nullptr) {
            return;
        }
        const Sample& sample = *kept.sample;
        weight *= kept.density;
        sum += weight;
        line(text_, at_ray,
             number_text(weight) + ", sample " + std::to_string(s) + " of pixel " +
                 std::to_string(x) + " " + std::to_string(y) + ", " + numbers_text(sample.color) +
                 ", " + numbers_text(sample.opacity));
    });
    line(text_, at_ray, "sum of weights " + number_text(sum));
}

namespace {

std::string pixel_text(const Image& image, std::size_t at) {
    const auto value = [&](Plane plane) { return number_text(image.plane(plane)[at]); };
    return "color " + value(Plane::R) + " " + value(Plane::G) + " " + value(Plane::B) +
           ", opacity " + value(Plane::OR) + " " + value(Plane::OG) + " " + value(Plane::OB) +
           ", alpha " + value(Plane::A) + ", z " + value(Plane::Z);
}

} // namespace

void PixelTrace::finish(const Sampler& sampler, const FilterWeights& weights,
                        const Image& filtered) {
    const rib::Options& options = frame_.scene.options;
    text_ = "pixel " + std::to_string(x_) + " " + std::to_string(y_) +
            (options.in_frame ? " of frame " + std::to_string(options.frame) : std::string()) +
            ", " + std::to_string(options.xres) + " by " + std::to_string(options.yres) +
            " pixels; points, vectors and normals are in camera space\n";
    std::size_t told = 0;
    for (const std::size_t number : numbers_taken(sampler)) {
        const Sample* result = kept_sample(kept_, sampler, x_, y_, number).sample;
        if (result == nullptr || told == samples_.size()) {
            continue;
        }
        text_ += samples_[told++].text;
        line(text_, at_ray,
             "result: color " + numbers_text(result->color) + ", opacity " +
                 numbers_text(result->opacity) + ", z " + number_text(result->z));
    }
    const std::size_t count = kept_.part(x_, y_).count;
    if (told < count) {
        line(text_, at_sample,
             std::to_string(count - told) +
                 " more samples are not told one by one; the list of the filter has their results");
    }
    append_filter(sampler, weights);
    line(text_, at_sample, "filtered: " + pixel_text(filtered, 0));
}

// --- displays

std::string display_text(const DisplayPlan& plan, const Image& exposed) {
    std::string text;
    line(text, at_sample,
         "display " + quoted(plan.display.name) + ", mode " + quoted(plan.display.mode));
    line(text, at_ray,
         "exposed, gain " + number_text(plan.exposure.gain) + ", gamma " +
             number_text(plan.exposure.gamma) + ": " + pixel_text(exposed, 0));
    return text;
}

std::string channels_text(const DisplayPlan& plan, const Image& developed) {
    std::string text;
    for (const ShownChannel& c : plan.channels) {
        float value = c.extra < 0 ? developed.plane(c.plane)[0]
                                  : developed.extra[static_cast<std::size_t>(c.extra)][0];
        value = c.output >= 0 && !(c.exposure == Exposure{}) ? Exposer(c.exposure)(value) : value;
        std::string channel = "channel " + quoted(c.name) + " = " + number_text(value);
        if (c.quantizer.storage() != Storage::Float) {
            const float noise =
                dither_noise(developed.pixels.x0, developed.pixels.y0, c.dither_channel);
            channel += ", level " + std::to_string(Levels(c.quantizer)(value, noise));
        }
        line(text, at_ray, channel);
    }
    return text;
}

std::string imaged_text(const Image& imaged, const std::string& imager) {
    std::string text;
    line(text, at_ray, "imager " + quoted(imager) + ": " + pixel_text(imaged, 0));
    return text;
}

void report_outside(int x, int y, const PixelRange& rendered, base::Diag& diag) {
    std::string text = "--trace-pixel: pixel " + std::to_string(x) + " " + std::to_string(y) +
                       " is not in the picture, which ";
    text += rendered.empty()
                ? std::string("is empty")
                : "spans " + std::to_string(rendered.x0) + " to " +
                      std::to_string(rendered.x1 - 1) + " and " + std::to_string(rendered.y0) +
                      " to " + std::to_string(rendered.y1 - 1);
    diag.report(base::Severity::Error, base::Code::Range, {}, text + "; nothing is traced");
}

} // namespace trace
