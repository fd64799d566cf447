// SPDX-License-Identifier: Apache-2.0
#include "tracer/bucket.h"

#include "tracer/pixel_trace.h"

#include <algorithm>
#include <bit>

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

} // namespace

VisibilityOptions visibility_options(const rib::Options& options) {
    return {threshold(options, "limits:othreshold", default_opaque),
            threshold(options, "limits:zthreshold", 1)};
}

BucketRenderer::BucketRenderer(const FrameContext& frame, const Camera& camera,
                               const Sampler& sampler, const ShadingClasses& classes,
                               const OutputBindings* outputs, const VisibilityOptions& options)
    : frame_(frame), camera_(camera), sampler_(sampler), classes_(classes),
      outputs_(outputs != nullptr && outputs->num_channels() > 0 ? outputs : nullptr),
      options_(options), opaque_counts_for_depth_(*std::max_element(options.depth_from.begin(),
                                                                    options.depth_from.end()) <= 1),
      shader_(frame, camera, classes, outputs, thread_) {}

bool BucketRenderer::render(std::size_t bucket, Film& film) {
    sampler_.fill(film.sample_pixels(bucket), block_);
    SampleBuffer samples = film.buffer(bucket);
    Counters& counters = thread_.counters;
    layer_ = 0;
    behind_.clear();
    if (thread_.trace != nullptr) {
        thread_.trace->begin_bucket(block_);
    }
    trace_camera_rays();
    composite_first(samples);
    tell_layer(samples);
    while (!behind_.empty()) {
        if (++layer_ > max_layers) {
            frame_.diag.report_once(
                "layers", base::Severity::Warning, base::Code::Limit, {},
                "more than " + std::to_string(max_layers) +
                    " transparent surfaces lie behind each other; the rest is left out");
            break;
        }
        trace_behind();
        composite_behind(samples);
        tell_layer(samples);
    }
    if (thread_.trace != nullptr) {
        thread_.trace->end_bucket(samples);
    }
    if (outputs_ != nullptr) {
        fill_sample_channels(samples);
    }
    counters.add(Counter::buckets);
    counters.add(Counter::samples, block_.count);
    counters.add(Counter::layers, layer_ + 1);
    counters.max_layers = std::max<std::uint64_t>(counters.max_layers, layer_ + 1);
    if (thread_.is_abandoned) {
        return false;
    }
    const PartTimer timer(counters, Part::work_film);
    film.submit(bucket, std::move(samples));
    return true;
}

void BucketRenderer::trace_camera_rays() {
    const PartTimer timer(thread_.counters, Part::work_rays);
    const std::size_t num_packets = block_.num_packets();
    camera_packets_.resize(num_packets);
    hits_.resize(num_packets * lanes);
    camera_.make_rays(block_, camera_packets_);
    frame_.world->intersect(camera_packets_, hits_.data());
    std::uint64_t num_rays = 0;
    for (std::size_t p = 0; p < num_packets; ++p) {
        const std::uint32_t active = camera_packets_[p].active & 0xffU;
        num_rays += static_cast<std::uint64_t>(std::popcount(active));
        for (std::uint32_t off = active ^ 0xffU; off != 0; off &= off - 1) {
            hits_[p * lanes + static_cast<std::size_t>(std::countr_zero(off))] = {};
        }
    }
    thread_.counters.add(Counter::rays_camera, num_rays);
    for (std::uint32_t i = 0; thread_.trace != nullptr && i < block_.count; ++i) {
        thread_.trace->ray(i, camera_packets_[i / lanes], i % lanes, hits_[i]);
    }
}

// --trace-pixel: what the layer that was just composited left.
void BucketRenderer::tell_layer(const SampleBuffer& samples) const {
    if (thread_.trace == nullptr) {
        return;
    }
    thread_.trace->composited(samples.samples);
    for (const Behind& b : behind_) {
        thread_.trace->continues(b.ray, b.transmitted);
    }
}

bool BucketRenderer::is_matte(const geo::Hit& hit) const {
    return classes_.has_matte() && classes_.facts(frame_.world->binding(hit).attributes).is_matte;
}

bool BucketRenderer::is_opaque(const Sample& shade) const {
    return shade.opacity[0] == 1 && shade.opacity[1] == 1 && shade.opacity[2] == 1 &&
           opaque_counts_for_depth_;
}

bool BucketRenderer::composite(Sample& sample, std::array<float, 3>& transmitted,
                               const geo::Hit& hit, const Sample& shade, float z_hit) const {
    const float shown = is_matte(hit) ? 0.0f : 1.0f;
    bool shows_behind = false, counts_for_depth = true;
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
    return shows_behind;
}

void BucketRenderer::composite_first_outputs(float* sample, bool is_matte, bool is_front) const {
    for (const BlendedChannel& b : outputs_->blended()) {
        if (is_matte || (b.front && !is_front)) {
            sample[b.channel] = 0;
        }
    }
}

void BucketRenderer::composite_outputs(float* sample, const float* shade,
                                       const std::array<float, 3>& transmitted,
                                       bool is_front) const {
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

void BucketRenderer::fill_sample_channels(SampleBuffer& samples) const {
    const std::size_t stride = outputs_->num_channels();
    for (const SampleChannel& c : outputs_->of_samples()) {
        float* out = samples.extra.data() + c.channel;
        for (std::size_t i = 0; i < samples.samples.size(); ++i) {
            const Sample& s = samples.samples[i];
            out[i * stride] = c.value == SampleValue::Depth ? s.z
                              : c.component < 3             ? s.color[c.component]
                                                            : s.opacity[c.component - 3];
        }
    }
}

// Shades go straight into the samples: for nearly all of them that is the result.
void BucketRenderer::composite_first(SampleBuffer& samples) {
    const PartTimer timer(thread_.counters, Part::work_shade);
    const std::span<const geo::Hit> hits(hits_.data(), block_.count);
    shader_.shade({camera_packets_, {}, block_.seed, {}, 0}, hits, samples.samples, samples.extra);
    const bool may_be_matte = classes_.has_matte();
    for (std::uint32_t i = 0; i < hits.size(); ++i) {
        if (!hits[i].valid()) {
            continue;
        }
        Sample& sample = samples.samples[i];
        const float z = ray_z(camera_packets_[i / lanes], i % lanes, hits[i].t);
        if (is_opaque(sample) && !may_be_matte) {
            sample.z = z;
            continue;
        }
        const Sample shade = sample;
        sample = {};
        std::array<float, 3> transmitted = {1, 1, 1};
        if (composite(sample, transmitted, hits[i], shade, z)) {
            behind_.push_back({i, hits[i].t, hits[i], transmitted});
        }
        if (outputs_ != nullptr) {
            composite_first_outputs(samples.extra.data() + i * outputs_->num_channels(),
                                    is_matte(hits[i]), sample.z < uncovered_z);
        }
    }
}

void BucketRenderer::composite_behind(SampleBuffer& samples) {
    const PartTimer timer(thread_.counters, Part::work_shade);
    shades_.resize(std::max(shades_.size(), behind_.size()));
    const std::size_t num_extra = outputs_ != nullptr ? outputs_->num_channels() : 0;
    shades_extra_.assign(behind_.size() * num_extra, 0.0f);
    const std::span<const geo::Hit> hits(hits_.data(), behind_.size());
    behind_rays_.clear();
    behind_t_.clear();
    for (std::size_t i = 0; i < behind_.size(); ++i) {
        behind_rays_.push_back(behind_[i].ray);
        behind_t_.push_back(behind_[i].t + hits[i].t);
    }
    shader_.shade({camera_packets_, behind_rays_, block_.seed, behind_t_, layer_}, hits, shades_,
                  shades_extra_);
    next_.clear();
    for (std::size_t i = 0; i < behind_.size(); ++i) {
        Behind b = behind_[i];
        if (!hits[i].valid()) {
            continue;
        }
        b.t += hits[i].t;
        b.hit = hits[i];
        const float z = ray_z(packets_[i / lanes], i % lanes, hits[i].t);
        Sample& sample = samples.samples[b.ray];
        const std::array<float, 3> transmitted = b.transmitted;
        const bool had_depth = sample.z < uncovered_z;
        if (composite(sample, b.transmitted, b.hit, shades_[i], z)) {
            next_.push_back(b);
        }
        if (outputs_ != nullptr && !is_matte(b.hit)) {
            composite_outputs(samples.extra.data() + b.ray * num_extra,
                              shades_extra_.data() + i * num_extra, transmitted,
                              !had_depth && sample.z < uncovered_z);
        }
    }
    behind_.swap(next_);
}

// Rays restart outside the error of the surface they left, in the same direction.
void BucketRenderer::trace_behind() {
    const PartTimer timer(thread_.counters, Part::work_rays);
    const std::size_t num_packets = (behind_.size() + lanes - 1) / lanes;
    packets_.assign(num_packets, {});
    hits_.resize(std::max(hits_.size(), num_packets * lanes));
    for (std::size_t i = 0; i < behind_.size(); ++i) {
        const Behind& b = behind_[i];
        const geo::RayPacket& from = camera_packets_[b.ray / lanes];
        const std::size_t source = b.ray % lanes, lane = i % lanes;
        geo::RayPacket& to = packets_[i / lanes];
        const base::V3f direction(from.dx[source], from.dy[source], from.dz[source]);
        const base::V3f origin = frame_.world->spawn_origin(b.hit, direction);
        to.ox[lane] = origin.x, to.oy[lane] = origin.y, to.oz[lane] = origin.z;
        to.dx[lane] = direction.x, to.dy[lane] = direction.y, to.dz[lane] = direction.z;
        to.tnear[lane] = 0;
        to.tfar[lane] = from.tfar[source] - b.t;
        to.time[lane] = from.time[source];
        to.mask[lane] = from.mask[source];
        to.active |= 1U << lane;
    }
    frame_.world->intersect(packets_, hits_.data());
    thread_.counters.add(Counter::rays_behind, behind_.size());
    for (std::size_t i = 0; thread_.trace != nullptr && i < behind_.size(); ++i) {
        thread_.trace->ray(behind_[i].ray, packets_[i / lanes], i % lanes, hits_[i]);
    }
}

} // namespace trace
