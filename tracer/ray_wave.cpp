// SPDX-License-Identifier: Apache-2.0
#include "tracer/ray_wave.h"

#include "tracer/pixel_trace.h"
#include "tracer/ray_channels.h"
#include "tracer/ray_levels.h"
#include "tracer/ray_packets.h"
#include "tracer/ray_queries.h"
#include "tracer/shader_set.h"
#include "tracer/texture_frame.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <string_view>

namespace trace {

namespace {

using base::V3d;
using base::V3f;

constexpr std::uint32_t lanes_of_packet = geo::RayPacket::size;

V3f get(const float* planes, std::uint32_t lanes, std::uint32_t lane) {
    return {planes[lane], planes[lanes + lane], planes[2 * lanes + lane]};
}

void put(float* planes, std::uint32_t lanes, std::uint32_t lane, const V3f& v) {
    planes[lane] = v.x, planes[lanes + lane] = v.y, planes[2 * lanes + lane] = v.z;
}

bool is_shaded(const sl_ray_query& query) {
    return query.kind == SL_RAYS_trace || query.kind == SL_RAYS_fulltrace ||
           (query.kind == SL_RAYS_gather && asks_for_shading(query));
}

bool is_mine(const sl_ray_query& query) {
    return query.kind == SL_RAYS_trace || query.kind == SL_RAYS_fulltrace ||
           query.kind == SL_RAYS_gather || query.kind == SL_RAYS_hittest;
}

bool has_text(sl_string text) {
    return text != nullptr && text[0] != '\0';
}

RayFilter filter_of(const sl_ray_query& query) {
    RayFilter filter;
    if (has_text(query.text[SL_RAY_TEXT_subset])) {
        filter.subset = query.text[SL_RAY_TEXT_subset];
    }
    if (has_text(query.text[SL_RAY_TEXT_hitsides])) {
        filter.sides = query.text[SL_RAY_TEXT_hitsides];
    }
    return filter;
}

std::uint32_t seed_of(std::uint32_t parent, const V3f& direction, std::uint32_t sample) {
    std::uint32_t seed = PixelHash::mix(parent + 0x72617973U + sample);
    for (int k = 0; k < 3; ++k) {
        seed = PixelHash::mix(seed ^ std::bit_cast<std::uint32_t>(direction[k]));
    }
    return seed;
}

int num_samples(const sl_ray_query& query, std::uint32_t lane) {
    const float given = query.option[SL_RAY_OPTION_samples][lane];
    constexpr float most = 65536;
    const bool counts = query.kind == SL_RAYS_trace || query.kind == SL_RAYS_fulltrace;
    return counts && given >= 1 ? static_cast<int>(std::min(given, most)) : 1;
}

} // namespace

RayWave::RayWave(const FrameContext& frame, RayLayers& layers, ThreadState& thread)
    : frame_(frame), layers_(layers), thread_(thread) {}

void RayWave::answer(std::span<ShadeJob* const> waiting) {
    waiting_asks_.clear();
    for (ShadeJob* job : waiting) {
        for (std::uint32_t packet = 0; packet < job->surface.num_packets(); ++packet) {
            sl_ray_query* query = job->surface.request(packet);
            if (query == nullptr) {
                continue;
            }
            if (is_mine(*query)) {
                waiting_asks_.push_back({query, &*job->surface_execution});
            } else {
                answer_rays(*job->surface_execution, *query);
            }
        }
    }
    answer(waiting_asks_);
}

void RayWave::answer(std::span<const RayAsk> asks) {
    asks_ = asks;
    rays_.clear();
    hits_of_lane_.assign(asks.size() * SL_LANES_MAX, 0);
    for (std::uint32_t i = 0; i < asks.size(); ++i) {
        begin_answer(*asks[i].query);
        add_rays(i);
    }
    flush();
    for (std::size_t i = 0; i < asks.size(); ++i) {
        end_answer(i);
    }
}

// --- questions to rays

void RayWave::begin_answer(sl_ray_query& query) const {
    const std::size_t planes = 3 * std::size_t{query.lanes};
    query.hit = 0;
    for (float* values : {query.C, query.Phit, query.Nhit, query.Pmiss, query.Rmiss}) {
        std::fill_n(values, planes, 0.0f);
    }
    std::fill_n(query.distance, query.lanes, 0.0f);
    std::fill_n(query.level_missed, query.lanes, 0.0f);
    for (std::int32_t c = 0; c < std::min<std::int32_t>(query.num_channels, SL_RAY_CHANNELS_MAX);
         ++c) {
        query.channel[c].set = 0;
    }
}

void RayWave::add_rays(std::uint32_t ask) {
    const sl_ray_query& query = *asks_[ask].query;
    const RayFilter filter = filter_of(query);
    const bool shades = is_shaded(query);
    if (!rays_.empty() && (!(filter == filter_) || shades != shades_)) {
        flush();
    }
    filter_ = filter;
    shades_ = shades;
    for (std::uint32_t rest = query.mask; rest != 0; rest &= rest - 1) {
        const auto lane = static_cast<std::uint32_t>(std::countr_zero(rest));
        if (!rays_.empty() &&
            !sends_alike(query, lane, *asks_[rays_.back().ask].query, rays_.back().lane)) {
            flush();
        }
        add_lane(ask, lane);
    }
}

RayWave::Place RayWave::place_of(const RayAsk& ask, std::uint32_t lane) const {
    Place place;
    const Execution& execution = *ask.execution;
    place.execution = &execution;
    place.point = execution.asked_first + ask.query->first + lane;
    const BatchSubject* subject = execution.subject;
    if (subject != nullptr && place.point < subject->hits.size()) {
        place.hit = &subject->hits[place.point];
    }
    if (subject != nullptr && place.point < subject->rays.seeds.size()) {
        place.seed = subject->rays.seeds[place.point];
    }
    return place;
}

RayWave::Cone RayWave::cone_of(const sl_ray_query& query, std::uint32_t lane,
                               const Place& place) const {
    const bool is_gather = query.kind == SL_RAYS_gather;
    const V3d D(get(query.D, query.lanes, lane));
    const double length = base::length(D);
    const sl_string distribution = query.text[SL_RAY_TEXT_distribution];
    Cone cone;
    cone.axis = D / length;
    cone.half_angle = static_cast<double>(is_gather ? query.angle[lane]
                                                    : query.option[SL_RAY_OPTION_samplecone][lane]);
    cone.samples = num_samples(query, lane);
    cone.which.seed = seed_of(place.seed, V3f(cone.axis), 0);
    cone.which.samples = is_gather ? std::max(query.samples, 1) : cone.samples;
    cone.which.shift = query.option[SL_RAY_OPTION_samplebase][lane];
    const bool is_cosine =
        has_text(distribution) ? std::string_view(distribution) == "cosine" : is_gather;
    cone.which.distribution = is_cosine ? ConeDistribution::Cosine : ConeDistribution::Uniform;
    cone.width = width(query, lane, place, cone.axis, length);
    if (cone.half_angle > 0) {
        const double solid_angle = cone_solid_angle(cone.half_angle) / cone.which.samples;
        cone.width.widen(static_cast<float>(std::sqrt(solid_angle)));
    }
    return cone;
}

void RayWave::add_lane(std::uint32_t ask_index, std::uint32_t lane) {
    const RayAsk& ask = asks_[ask_index];
    const sl_ray_query& query = *ask.query;
    const Place place = place_of(ask, lane);
    const double length = base::length(V3d(get(query.D, query.lanes, lane)));
    if (!(length > 0) || !std::isfinite(length) ||
        !std::isfinite(base::length(get(query.P, query.lanes, lane)))) {
        return; // no direction, or no number: nothing is met
    }
    const std::uint32_t attributes =
        place.hit != nullptr ? frame_.world->binding(*place.hit).attributes : rib::none;
    const RaySubject* rays =
        place.execution->subject != nullptr ? &place.execution->subject->rays : nullptr;
    const int level = place.execution->ray_level + 1;
    if (shades_ && !thread_.levels->options().allows(attributes, level,
                                                     rays != nullptr ? rays->diffuse_level : 0)) {
        too_deep(ask, lane);
        return;
    }
    const Cone cone = cone_of(query, lane, place);
    Ray ray;
    ray.ask = ask_index;
    ray.lane = lane;
    ray.of_sample =
        rays != nullptr && place.point < rays->samples.size() ? rays->samples[place.point] : ~0U;
    for (int s = 0; s < cone.samples; ++s) {
        ray.number = query.kind == SL_RAYS_gather ? query.sample : s;
        add_ray(place, cone, ray);
    }
}

void RayWave::add_ray(const Place& place, const Cone& cone, Ray ray) {
    const RayAsk& ask = asks_[ray.ask];
    ConeSample which = cone.which;
    which.sample = ray.number;
    const V3f direction(cone.half_angle > 0 ? cone_direction(cone.axis, cone.half_angle, which)
                                            : cone.axis);
    const float farthest = ask.query->option[SL_RAY_OPTION_maxdist][ray.lane];
    const bool is_limited = farthest > 0 && farthest < very_far;
    ray.ray = {origin(ask, ray.lane, place, direction), direction,
               is_limited ? farthest : std::numeric_limits<float>::infinity(),
               place.hit != nullptr ? place.hit->time : frame_.spaces.shutter_open(),
               geo::ReflectionRay};
    ray.cone = cone.width;
    ray.medium = medium(place, direction);
    ray.seed = seed_of(place.seed, direction, static_cast<std::uint32_t>(ray.number));
    rays_.push_back(ray);
    if (rays_.size() >= max_rays) {
        flush();
    }
}

// As if it met nothing.
void RayWave::too_deep(const RayAsk& ask, std::uint32_t lane) {
    sl_ray_query& query = *ask.query;
    thread_.counters.add(Counter::rays_too_deep);
    const int level = ask.execution->ray_level + 1;
    query.level_missed[lane] = static_cast<float>(level);
    put(query.Pmiss, query.lanes, lane, get(query.P, query.lanes, lane));
    put(query.Rmiss, query.lanes, lane, base::normalize(get(query.D, query.lanes, lane)));
}

// Rays from the point that is shaded start outside its rounding error; points that shaders made up
// lie on nothing and start as they are. What went through another space and back is the same point.
V3f RayWave::origin(const RayAsk& ask, std::uint32_t lane, const Place& place,
                    const V3f& direction) const {
    const sl_ray_query& query = *ask.query;
    const V3f P = get(query.P, query.lanes, lane);
    const float bias = query.option[SL_RAY_OPTION_bias][lane];
    if (bias > 0) {
        return P + direction * bias;
    }
    if (place.hit == nullptr) {
        return P;
    }
    const V3f outside = frame_.world->spawn_origin(*place.hit, direction);
    const Execution& asker =
        place.execution->asked_by != nullptr ? *place.execution->asked_by : *place.execution;
    rt::ShadeBatch* batch = asker.batch;
    if (batch != nullptr && batch->has(SL_VAR_P) && place.point < batch->count()) {
        const std::size_t stride = batch->stride();
        const float* shaded = batch->plane(SL_VAR_P) + place.point;
        if (shaded[0] == P.x && shaded[stride] == P.y && shaded[2 * stride] == P.z) {
            return outside;
        }
    }
    const V3f other = frame_.world->spawn_origin(*place.hit, -direction);
    const V3f middle = (outside + other) * 0.5f;
    return base::length(P - middle) <= base::length(outside - other) ? outside : P;
}

// Where the shader knows no differences the ray goes on as wide as the one that came.
RayCone RayWave::width(const sl_ray_query& query, std::uint32_t lane, const Place& place,
                       const V3d& direction, double length) const {
    const auto triple = [&](const float* planes) { return V3d(get(planes, query.lanes, lane)); };
    const RayCone cone = RayCone::from(direction, triple(query.P_u), triple(query.P_v),
                                       triple(query.D_u) / length, triple(query.D_v) / length);
    if (!cone.is_empty()) {
        return cone;
    }
    const BatchSubject* subject = place.execution->subject;
    if (subject == nullptr || place.point >= subject->incident.footprint.size() ||
        place.point >= subject->rays.spread.size()) {
        return {};
    }
    return RayCone::from(subject->incident.footprint[place.point],
                         subject->rays.spread[place.point]);
}

// A surface's rays go out on the side they point to; what volumes and lights trace stays within.
MediumId RayWave::medium(const Place& place, const V3f& direction) const {
    Media& media = thread_.levels->media();
    const BatchSubject* subject = place.execution->subject;
    if (!media.any() || subject == nullptr) {
        return 0;
    }
    const MediumId came =
        place.point < subject->rays.media.size() ? subject->rays.media[place.point] : 0;
    const int type = place.execution->running.object().type;
    if (place.hit == nullptr || type != SL_SHADER_surface) {
        return came;
    }
    const V3f Ng = geometric_normal(*frame_.world, *place.hit);
    return media.behind(came, frame_.world->binding(*place.hit).attributes,
                        base::dot(Ng, direction) < 0);
}

// --- rays

// Rays of one octant of directions go together; within it they keep their order, and so their
// neighbours on the surface.
void RayWave::sort_rays() {
    const auto octant = [](const Ray& ray) {
        const V3f& d = ray.ray.direction;
        return (d.x < 0 ? 1U : 0U) | (d.y < 0 ? 2U : 0U) | (d.z < 0 ? 4U : 0U);
    };
    std::array<std::uint32_t, 9> begin{};
    for (const Ray& ray : rays_) {
        ++begin[octant(ray) + 1];
    }
    for (std::size_t i = 1; i < begin.size(); ++i) {
        begin[i] += begin[i - 1];
    }
    order_.resize(rays_.size());
    for (std::uint32_t i = 0; i < rays_.size(); ++i) {
        order_[begin[octant(rays_[i])]++] = i;
    }
}

void RayWave::flush() {
    if (rays_.empty() || thread_.is_abandoned) {
        rays_.clear();
        return;
    }
    sort_rays();
    has_channels_ = is_sending_ = false;
    for (const Ray& ray : rays_) {
        const sl_ray_query& query = *asks_[ray.ask].query;
        has_channels_ |= query.num_channels > 0;
        is_sending_ |= query.num_channels > 0 && trace::sends(query);
    }
    const std::size_t count = rays_.size();
    packets_.assign((count + lanes_of_packet - 1) / lanes_of_packet, {});
    seeds_.resize(count);
    cones_.resize(count);
    samples_.resize(count);
    media_.resize(count);
    labels_.resize(count);
    for (std::size_t slot = 0; slot < count; ++slot) {
        const Ray& ray = rays_[order_[slot]];
        set_ray(packets_[slot / lanes_of_packet], slot % lanes_of_packet, ray.ray);
        seeds_[slot] = ray.seed;
        cones_[slot] = ray.cone;
        samples_[slot] = ray.of_sample;
        media_[slot] = ray.medium;
        labels_[slot] = asks_[ray.ask].query->text[SL_RAY_TEXT_label];
    }
    trace(shades_);
    std::vector<std::uint32_t> slot_of(count);
    for (std::uint32_t slot = 0; slot < count; ++slot) {
        slot_of[order_[slot]] = slot;
    }
    for (std::size_t i = 0; i < count; ++i) { // in the order they were asked for
        fold(rays_[i], slot_of[i]);
    }
    rays_.clear();
}

void RayWave::trace(bool shaded) {
    const Execution& asker = *asks_[rays_.front().ask].execution;
    const RaySubject from = asker.subject != nullptr ? asker.subject->rays : RaySubject{};
    RayBundle bundle;
    bundle.count = static_cast<std::uint32_t>(rays_.size());
    bundle.packets = packets_;
    bundle.seeds = seeds_;
    bundle.level = from.level + 1;
    bundle.kind = SL_RAY_reflection;
    bundle.diffuse_level = from.diffuse_level;
    bundle.cones = cones_;
    bundle.labels = labels_;
    bundle.samples = samples_;
    bundle.filter = filter_;
    if (thread_.levels->media().any()) {
        bundle.media = media_;
    }
    first_.resize(packets_.size() * lanes_of_packet);
    colors_.assign(rays_.size(), Sample{});
    misses_.assign(rays_.size(), DeepestMiss{});
    if (shaded) {
        layers_.trace(bundle, {colors_, {}, first_, misses_}, has_channels_ ? this : nullptr);
    } else {
        layers_.intersect(bundle, first_);
        thread_.counters.add(Counter::rays_probe, rays_.size());
    }
}

// --- answers

// All rays of a wave send the same.
void RayWave::starting(ShadeJob& job) {
    const Ray& ray = rays_.front();
    bind_sent(*asks_[ray.ask].query, ray.lane, job);
}

// The first surface of each ray has been shaded.
void RayWave::finished(ShadeJob& job) {
    for (std::uint32_t i = 0; layers_.layer() == 0 && i < job.count(); ++i) {
        const Ray& ray = rays_[order_[layers_.ray_of(job.members[i])]];
        read_shaded(*asks_[ray.ask].query, ray.lane, job, i);
    }
}

void RayWave::fold(const Ray& ray, std::size_t slot) {
    sl_ray_query& query = *asks_[ray.ask].query;
    const std::uint32_t lanes = query.lanes, lane = ray.lane;
    const auto share = 1 / static_cast<float>(num_samples(query, lane));
    const Sample& seen = colors_[slot];
    const bool sees_map = has_text(query.text[SL_RAY_TEXT_environmentmap]) &&
                          *std::min_element(seen.opacity, seen.opacity + 3) < 1;
    const base::Color beyond = sees_map ? environment(ray) : base::Color();
    const float behind[] = {beyond.r, beyond.g, beyond.b};
    for (std::uint32_t k = 0; k < 3; ++k) {
        query.C[k * lanes + lane] +=
            share * (seen.color[k] + (sees_map ? (1 - seen.opacity[k]) * behind[k] : 0));
    }
    if (first_[slot].valid()) {
        fold_hit(ray, first_[slot]);
    }
    if (query.num_channels > 0) {
        fold_channels(ray, slot);
    }
    const DeepestMiss& miss = misses_[slot];
    if (static_cast<float>(miss.level) <= query.level_missed[lane]) {
        return;
    }
    query.level_missed[lane] = static_cast<float>(miss.level);
    put(query.Pmiss, lanes, lane, {miss.origin[0], miss.origin[1], miss.origin[2]});
    put(query.Rmiss, lanes, lane, {miss.direction[0], miss.direction[1], miss.direction[2]});
}

void RayWave::fold_channels(const Ray& ray, std::size_t slot) {
    sl_ray_query& query = *asks_[ray.ask].query;
    const geo::Hit& hit = first_[slot];
    read_ray(query, ray.lane, {ray.ray.origin, ray.ray.direction, hit.valid() ? hit.t : very_far});
    if (!hit.valid()) {
        return;
    }
    read_hit(query, ray.lane, frame_, hit);
    if (shades_) {
        read_color(query, ray.lane, colors_[slot]);
    }
}

// "environmentmap": what rays see that meet nothing.
base::Color RayWave::environment(const Ray& ray) const {
    const RayAsk& ask = asks_[ray.ask];
    if (frame_.textures == nullptr) {
        return {};
    }
    const sl_string space = ask.query->text[SL_RAY_TEXT_coordsystem];
    const Space* named = has_text(space) ? frame_.spaces.find(space) : nullptr;
    V3d direction(ray.ray.direction);
    if (named != nullptr) {
        direction = base::vector(named->space_from_camera, direction);
    }
    sl_map_query query = {};
    query.kind = SL_MAP_environment;
    query.num_channels = 3;
    query.lanes = SL_LANES_MAX;
    query.mask = 1;
    query.name[0] = ask.query->text[SL_RAY_TEXT_environmentmap];
    put(query.at, SL_LANES_MAX, 0, V3f(direction));
    float result[3 * SL_LANES_MAX] = {};
    thread_.counters.add(Counter::map_environment);
    frame_.textures->lookup(
        query, {},
        [&](const std::string& text) {
            report_shader(*ask.execution, base::Severity::Error, 0, "map: " + text);
        },
        result);
    return {result[0], result[SL_LANES_MAX], result[2 * SL_LANES_MAX]};
}

// Distances of several samples that meet something are averaged; the first of them tells where.
void RayWave::fold_hit(const Ray& ray, const geo::Hit& hit) {
    sl_ray_query& query = *asks_[ray.ask].query;
    const std::uint32_t lanes = query.lanes, lane = ray.lane;
    const bool is_first = (query.hit >> lane & 1U) == 0;
    query.hit |= 1U << lane;
    query.distance[lane] += hit.t;
    ++hits_of_lane_[ray.ask * SL_LANES_MAX + lane];
    if (!is_first || query.kind == SL_RAYS_trace) {
        return;
    }
    alignas(64) float P[3 * SL_LANES_MAX] = {}, N[3 * SL_LANES_MAX] = {};
    sl_points points = {};
    points.var[SL_VAR_P] = P;
    points.var[SL_VAR_N] = N;
    fill_one(*frame_.world, hit, points);
    put(query.Phit, lanes, lane, get(P, SL_LANES_MAX, 0));
    put(query.Nhit, lanes, lane, get(N, SL_LANES_MAX, 0));
}

void RayWave::end_answer(std::size_t index) {
    const RayAsk& ask = asks_[index];
    sl_ray_query& query = *ask.query;
    for (std::uint32_t lane = 0; lane < query.lanes; ++lane) {
        const std::uint32_t hits = hits_of_lane_[index * SL_LANES_MAX + lane];
        query.distance[lane] =
            hits > 0 ? query.distance[lane] / static_cast<float>(hits) : very_far;
        const BatchSubject* subject = ask.execution->subject;
        const bool is_of_point =
            subject != nullptr && subject->misses != nullptr && ask.execution->asked_by == nullptr;
        if (is_of_point && is_shaded(query) && query.level_missed[lane] > 0) {
            note_miss(*subject, query, lane);
        }
        if (thread_.trace != nullptr && (query.mask >> lane & 1U) != 0) {
            tell(ask, lane);
        }
    }
}

// --trace-pixel
void RayWave::tell(const RayAsk& ask, std::uint32_t lane) const {
    const Place place = place_of(ask, lane);
    const BatchSubject* subject = place.execution->subject;
    if (subject != nullptr && place.point < subject->rays.samples.size()) {
        const V3f C = get(ask.query->C, ask.query->lanes, lane);
        const float color[] = {C.x, C.y, C.z};
        thread_.trace->answered(subject->rays.samples[place.point], ask.execution->running,
                                {color, ask.query->distance[lane], ask.execution->ray_level});
    }
}

// The tree of the ray that met this point grows by these.
void RayWave::note_miss(const BatchSubject& subject, const sl_ray_query& query,
                        std::uint32_t lane) {
    std::vector<DeepestMiss>& misses = *subject.misses;
    misses.resize(subject.hits.size());
    const std::size_t point = query.first + lane;
    if (point >= misses.size() ||
        static_cast<float>(misses[point].level) >= query.level_missed[lane]) {
        return;
    }
    DeepestMiss& miss = misses[point];
    miss.level = static_cast<int>(query.level_missed[lane]);
    for (std::uint32_t k = 0; k < 3; ++k) {
        miss.origin[k] = query.Pmiss[k * query.lanes + lane];
        miss.direction[k] = query.Rmiss[k * query.lanes + lane];
    }
}

} // namespace trace
