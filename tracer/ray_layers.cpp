// SPDX-License-Identifier: Apache-2.0
#include "tracer/ray_layers.h"

#include "tracer/pixel_trace.h"
#include "tracer/ray_levels.h"
#include "tracer/ray_packets.h"

#include <algorithm>
#include <bit>
#include <optional>
#include <string_view>

namespace trace {

namespace {

constexpr std::uint32_t lanes = geo::RayPacket::size;
// A ray that is still not stopped has met a surface it cannot leave, or a scene nobody would wait
// for.
constexpr std::uint32_t max_layers = 10'000;
// Less than a thousandth of what lies behind is not worth a ray.
constexpr float default_opaque = 0.999f;

std::array<float, 3> threshold(const rib::Options& options, const char* name, float fallback) {
    const auto it = options.user.find(name);
    if (it == options.user.end() || it->second.floats.empty()) {
        return {fallback, fallback, fallback};
    }
    const std::vector<float>& v = it->second.floats;
    return v.size() >= 3 ? std::array<float, 3>{v[0], v[1], v[2]}
                         : std::array<float, 3>{v[0], v[0], v[0]};
}

float ray_z(const geo::RayPacket& packet, std::size_t lane, float t) {
    return packet.oz[lane] + t * packet.dz[lane];
}

// Any of the words of `subset` among those of `membership`; + and - only say how groups were made.
bool is_member(std::string_view membership, std::string_view subset) {
    constexpr std::string_view between = " \t,+-";
    const auto next_word = [&](std::string_view& text) {
        text.remove_prefix(std::min(text.find_first_not_of(between), text.size()));
        const std::string_view word = text.substr(0, text.find_first_of(between));
        text.remove_prefix(word.size());
        return word;
    };
    while (true) {
        const std::string_view wanted = next_word(subset);
        if (wanted.empty()) {
            return false;
        }
        std::string_view rest = membership;
        for (std::string_view have = next_word(rest); !have.empty(); have = next_word(rest)) {
            if (have == wanted) {
                return true;
            }
        }
    }
}

// Rays of shaders are part of shading.
class LevelTimer {
public:
    LevelTimer(Counters& counters, Part part, int level) {
        if (level == 0) {
            timer_.emplace(counters, part);
        }
    }

private:
    std::optional<PartTimer> timer_;
};

} // namespace

VisibilityOptions visibility_options(const rib::Options& options) {
    return {threshold(options, "limits:othreshold", default_opaque),
            threshold(options, "limits:zthreshold", 1)};
}

RayLayers::RayLayers(const FrameContext& frame, const ShadingClasses& classes,
                     const OutputBindings* outputs, const VisibilityOptions& options,
                     HitShader& shader, ThreadState& thread, ShadingReuse* reuse)
    : frame_(frame), classes_(classes),
      outputs_(outputs != nullptr && outputs->num_channels() > 0 ? outputs : nullptr),
      options_(options), opaque_counts_for_depth_(*std::max_element(options.depth_from.begin(),
                                                                    options.depth_from.end()) <= 1),
      shader_(shader), reuse_(reuse), thread_(thread) {}

std::uint32_t RayLayers::trace(const RayBundle& rays, const RayResults& results,
                               ShadeObserver* observer) {
    rays_ = rays;
    results_ = results;
    observer_ = observer;
    layer_ = 0;
    behind_.clear();
    trace_first();
    composite_first();
    tell_layer();
    while (!behind_.empty()) {
        if (++layer_ > max_layers) {
            frame_.diag.report_once(
                "layers", base::Severity::Warning, base::Code::Limit, {},
                "more than " + std::to_string(max_layers) +
                    " transparent surfaces lie behind each other; the rest is left out");
            break;
        }
        trace_behind();
        composite_behind();
        tell_layer();
    }
    return layer_ + 1;
}

// --- rays

base::V3f RayLayers::direction_of(std::uint32_t ray) const {
    const geo::RayPacket& packet = rays_.packets[ray / lanes];
    const std::size_t lane = ray % lanes;
    return {packet.dx[lane], packet.dy[lane], packet.dz[lane]};
}

void RayLayers::intersect(const RayBundle& rays, std::span<geo::Hit> hits) {
    rays_ = rays;
    frame_.world->intersect(rays.packets, hits.data());
    for (std::size_t p = 0; p < rays.packets.size(); ++p) {
        const std::uint32_t off = ~rays.packets[p].active & 0xffU;
        for (std::uint32_t rest = off; rest != 0; rest &= rest - 1) {
            hits[p * lanes + static_cast<std::size_t>(std::countr_zero(rest))] = {};
        }
    }
    if (!rays.filter.is_empty()) {
        skip_filtered(rays.packets, hits);
    }
}

bool RayLayers::passes(const geo::Hit& hit, const base::V3f& direction) const {
    const RayFilter& filter = rays_.filter;
    if (filter.subset != nullptr) {
        const std::uint32_t state = frame_.world->binding(hit).attributes;
        const rib::Param* groups = frame_.scene.attributes[state].find("grouping:membership");
        if (groups == nullptr || groups->strings.empty() ||
            !is_member(groups->strings.front(), filter.subset)) {
            return false;
        }
    }
    const std::string_view sides = filter.sides != nullptr ? filter.sides : "both";
    if (sides != "front" && sides != "back") {
        return true;
    }
    return (base::dot(geometric_normal(*frame_.world, hit), direction) > 0) == (sides == "back");
}

// Rays that met what they are not to meet go on behind it, one at a time: few do.
void RayLayers::skip_filtered(std::span<const geo::RayPacket> packets, std::span<geo::Hit> hits) {
    for (std::size_t i = 0; i < packets.size() * lanes; ++i) {
        const geo::RayPacket& from = packets[i / lanes];
        const std::size_t lane = i % lanes;
        const base::V3f direction(from.dx[lane], from.dy[lane], from.dz[lane]);
        float t = 0;
        for (std::uint32_t n = 0; hits[i].valid() && !passes(hits[i], direction); ++n) {
            t += hits[i].t;
            geo::RayPacket on = {};
            const base::V3f origin = frame_.world->spawn_origin(hits[i], direction);
            set_ray(on, 0,
                    {origin, direction, from.tfar[lane] - t, from.time[lane], from.mask[lane]});
            geo::Hit found[lanes];
            frame_.world->intersect(on, found);
            hits[i] = n < max_layers ? found[0] : geo::Hit{};
            hits[i].t += hits[i].valid() ? t : 0;
        }
    }
}

void RayLayers::trace_first() {
    const LevelTimer timer(thread_.counters, Part::work_rays, rays_.level);
    hits_.resize(std::max(hits_.size(), rays_.packets.size() * lanes));
    intersect(rays_, hits_);
    std::uint64_t num_rays = 0;
    for (const geo::RayPacket& packet : rays_.packets) {
        num_rays += static_cast<std::uint64_t>(std::popcount(packet.active & 0xffU));
    }
    thread_.counters.add(rays_.level == 0 ? Counter::rays_camera : Counter::rays_reflection,
                         num_rays);
    if (!results_.first.empty()) {
        std::copy_n(hits_.begin(), results_.first.size(), results_.first.begin());
    }
    tell_rays(rays_.packets, rays_.count);
}

// --trace-pixel: the rays of the layer in work.
void RayLayers::tell_rays(std::span<const geo::RayPacket> packets, std::size_t count) const {
    for (std::size_t i = 0; thread_.trace != nullptr && i < count; ++i) {
        const std::uint32_t ray = ray_of(static_cast<std::uint32_t>(i));
        thread_.trace->ray(sample_of(ray), packets[i / lanes], i % lanes, hits_[i], rays_.level);
    }
}

void RayLayers::make_behind(geo::RayPacket& to, std::size_t lane, const Behind& from) const {
    const geo::RayPacket& packet = rays_.packets[from.ray / lanes];
    const std::size_t source = from.ray % lanes;
    const base::V3f direction = direction_of(from.ray);
    const base::V3f origin = frame_.world->spawn_origin(from.hit, direction);
    set_ray(to, lane,
            {origin, direction, packet.tfar[source] - from.t, packet.time[source],
             packet.mask[source]});
}

// Rays restart outside the error of the surface they left, in the same direction.
void RayLayers::trace_behind() {
    const LevelTimer timer(thread_.counters, Part::work_rays, rays_.level);
    const std::size_t num_packets = (behind_.size() + lanes - 1) / lanes;
    packets_.assign(num_packets, {});
    hits_.resize(std::max(hits_.size(), num_packets * lanes));
    for (std::size_t i = 0; i < behind_.size(); ++i) {
        make_behind(packets_[i / lanes], i % lanes, behind_[i]);
    }
    frame_.world->intersect(packets_, hits_.data());
    if (!rays_.filter.is_empty()) {
        skip_filtered(packets_, hits_);
    }
    thread_.counters.add(Counter::rays_behind, behind_.size());
    tell_rays(packets_, behind_.size());
}

ShadingRays RayLayers::shading_rays() const {
    ShadingRays rays;
    rays.packets = rays_.packets;
    rays.seed = rays_.seeds;
    rays.layer = layer_;
    rays.level = rays_.level;
    rays.kind = rays_.kind;
    rays.diffuse_level = rays_.diffuse_level;
    rays.cones = rays_.cones;
    rays.labels = rays_.labels;
    rays.samples = rays_.samples;
    if (layer_ == 0) {
        rays.media = rays_.media;
        return rays;
    }
    rays.ray = behind_rays_;
    rays.t = behind_t_;
    rays.media = behind_media_;
    rays.since = behind_since_;
    return rays;
}

// --- rays that met nothing

void RayLayers::note_miss(std::uint32_t ray, const base::V3f& origin, const base::V3f& direction,
                          int level) {
    DeepestMiss& miss = results_.misses[ray];
    if (level <= miss.level) {
        return;
    }
    miss.level = level;
    for (int k = 0; k < 3; ++k) {
        miss.origin[k] = origin[k];
        miss.direction[k] = direction[k];
    }
}

// Of the layer in work.
void RayLayers::note_misses() {
    const std::size_t count = layer_ == 0 ? rays_.count : behind_.size();
    for (std::size_t i = 0; i < count && !results_.misses.empty(); ++i) {
        const std::uint32_t ray = ray_of(static_cast<std::uint32_t>(i));
        const geo::RayPacket& packet = rays_.packets[ray / lanes];
        const std::size_t lane = ray % lanes;
        if (!hits_[i].valid() && (packet.active >> lane & 1U) != 0) {
            note_miss(ray, {packet.ox[lane], packet.oy[lane], packet.oz[lane]}, direction_of(ray),
                      rays_.level);
        }
    }
}

// The rays that its points asked for belong to the tree of the ray that met them.
void RayLayers::finished(ShadeJob& job) {
    for (std::size_t i = 0; i < job.misses.size() && !results_.misses.empty(); ++i) {
        const DeepestMiss& miss = job.misses[i];
        if (miss.level > 0) {
            note_miss(ray_of(job.members[i]), {miss.origin[0], miss.origin[1], miss.origin[2]},
                      {miss.direction[0], miss.direction[1], miss.direction[2]}, miss.level);
        }
    }
    if (observer_ != nullptr) {
        observer_->finished(job);
    }
}

// --- samples

// --trace-pixel: what the layer that was just composited left.
void RayLayers::tell_layer() const {
    if (thread_.trace == nullptr || rays_.level > 0) {
        return;
    }
    thread_.trace->composited(results_.samples);
    for (const Behind& b : behind_) {
        thread_.trace->continues(sample_of(b.ray), b.transmitted);
    }
}

bool RayLayers::is_matte(const geo::Hit& hit) const {
    return classes_.has_matte() && hit.valid() &&
           classes_.facts(frame_.world->binding(hit).attributes).is_matte;
}

bool RayLayers::is_opaque(const Sample& shade) const {
    return shade.opacity[0] == 1 && shade.opacity[1] == 1 && shade.opacity[2] == 1 &&
           opaque_counts_for_depth_;
}

bool RayLayers::composite(Sample& sample, std::array<float, 3>& transmitted, const geo::Hit& hit,
                          const Sample& shade, float z_hit) const {
    const float shown = is_matte(hit) ? 0.0f : 1.0f;
    bool shows_behind = false, counts_for_depth = hit.valid();
    for (std::size_t k = 0; k < 3; ++k) {
        sample.color[k] += shown * transmitted[k] * shade.color[k];
        sample.opacity[k] += shown * transmitted[k] * shade.opacity[k];
        transmitted[k] *= 1 - shade.opacity[k];
        shows_behind |= 1 - transmitted[k] < options_.opaque_from[k];
        counts_for_depth &= shade.opacity[k] >= options_.depth_from[k];
    }
    if (counts_for_depth) {
        sample.z = std::min(sample.z, z_hit);
    }
    return shows_behind && hit.valid();
}

void RayLayers::composite_first_outputs(float* sample, bool is_matte, bool is_front) const {
    for (const BlendedChannel& b : outputs_->blended()) {
        if (is_matte || (b.front && !is_front)) {
            sample[b.channel] = 0;
        }
    }
}

void RayLayers::composite_outputs(float* sample, const float* shade,
                                  const std::array<float, 3>& transmitted, bool is_front) const {
    const float through[4] = {transmitted[0], transmitted[1], transmitted[2],
                              (transmitted[0] + transmitted[1] + transmitted[2]) / 3};
    for (const BlendedChannel& b : outputs_->blended()) {
        if (!b.front) {
            sample[b.channel] += through[b.transmission] * shade[b.channel];
        } else if (is_front) {
            sample[b.channel] = shade[b.channel];
        }
    }
}

// Camera rays have nobody who is told of batches.
void RayLayers::shade(std::span<const geo::Hit> hits, std::span<Sample> out,
                      std::span<float> out_extra) {
    if (reuse_ != nullptr) {
        reuse_->shade(shading_rays(), hits, out, out_extra);
    } else {
        shader_.shade(shading_rays(), hits, out, out_extra, this);
    }
}

// Shades go straight into the samples: for nearly all of them that is the result.
void RayLayers::composite_first() {
    const LevelTimer timer(thread_.counters, Part::work_shade, rays_.level);
    const std::span<const geo::Hit> hits(hits_.data(), rays_.count);
    shade(hits, results_.samples, results_.extra);
    note_misses();
    const bool may_be_matte = classes_.has_matte();
    for (std::uint32_t i = 0; i < hits.size(); ++i) {
        if (!hits[i].valid()) {
            continue;
        }
        Sample& sample = results_.samples[i];
        const float z = ray_z(rays_.packets[i / lanes], i % lanes, hits[i].t);
        if (is_opaque(sample) && !may_be_matte) {
            sample.z = z;
            continue;
        }
        const Sample shade = sample;
        sample = {};
        Behind behind{i, hits[i].t, hits[i], rays_.media.empty() ? 0 : rays_.media[i], {1, 1, 1}};
        if (composite(sample, behind.transmitted, hits[i], shade, z)) {
            behind_.push_back(behind);
        }
        if (outputs_ != nullptr) {
            composite_first_outputs(results_.extra.data() + i * outputs_->num_channels(),
                                    is_matte(hits[i]), sample.z < uncovered_z);
        }
    }
    cross_surfaces();
}

void RayLayers::composite_behind() {
    const LevelTimer timer(thread_.counters, Part::work_shade, rays_.level);
    shades_.assign(behind_.size(), Sample{});
    const std::size_t num_extra = outputs_ != nullptr ? outputs_->num_channels() : 0;
    shades_extra_.assign(behind_.size() * num_extra, 0.0f);
    const std::span<const geo::Hit> hits(hits_.data(), behind_.size());
    behind_rays_.clear();
    behind_t_.clear();
    behind_media_.clear();
    behind_since_.clear();
    for (std::size_t i = 0; i < behind_.size(); ++i) {
        behind_rays_.push_back(behind_[i].ray);
        behind_t_.push_back(behind_[i].t + hits[i].t);
        behind_media_.push_back(behind_[i].medium);
        behind_since_.push_back(behind_[i].t);
    }
    shade(hits, shades_, shades_extra_);
    note_misses();
    next_.clear();
    for (std::size_t i = 0; i < behind_.size(); ++i) {
        Behind b = behind_[i];
        b.t += hits[i].t;
        b.hit = hits[i];
        const float z = ray_z(packets_[i / lanes], i % lanes, hits[i].t);
        Sample& sample = results_.samples[b.ray];
        const std::array<float, 3> transmitted = b.transmitted;
        const bool had_depth = sample.z < uncovered_z;
        if (composite(sample, b.transmitted, b.hit, shades_[i], z)) {
            next_.push_back(b);
        }
        if (outputs_ != nullptr && b.hit.valid() && !is_matte(b.hit)) {
            composite_outputs(results_.extra.data() + b.ray * num_extra,
                              shades_extra_.data() + i * num_extra, transmitted,
                              !had_depth && sample.z < uncovered_z);
        }
    }
    behind_.swap(next_);
    cross_surfaces();
}

// The rays that go on do so on the other side.
void RayLayers::cross_surfaces() {
    if (thread_.levels == nullptr || !thread_.levels->media().any()) {
        return;
    }
    for (Behind& b : behind_) {
        const base::V3f Ng = geometric_normal(*frame_.world, b.hit);
        b.medium = thread_.levels->media().behind(b.medium, frame_.world->binding(b.hit).attributes,
                                                  base::dot(Ng, direction_of(b.ray)) < 0);
    }
}

} // namespace trace
