// SPDX-License-Identifier: Apache-2.0
#include "tracer/bucket.h"

#include "tracer/pixel_trace.h"
#include "tracer/ray_levels.h"

#include <algorithm>

namespace trace {

BucketRenderer::BucketRenderer(const FrameContext& frame, const Camera& camera,
                               const Sampler& sampler, const ShadingClasses& classes,
                               const OutputBindings* outputs, const VisibilityOptions& options)
    : camera_(camera), sampler_(sampler),
      outputs_(outputs != nullptr && outputs->num_channels() > 0 ? outputs : nullptr),
      shader_(frame, camera, classes, outputs, thread_),
      adaptive_(adaptive_settings(frame.scene.options, sampler.per_pixel()), frame.scene.options),
      reuse_(frame, camera, sampler, classes, shader_, thread_),
      layers_(frame, classes, outputs, options, shader_, thread_,
              reuse_.is_on() ? &reuse_ : nullptr) {
    thread_.levels = std::make_unique<RayLevels>(frame, camera, classes, options, thread_);
}

bool BucketRenderer::render(std::size_t bucket, Film& film) {
    SampleBuffer samples =
        sampler_.settings().least > 0 ? render_adaptive(bucket, film) : render_fixed(bucket, film);
    if (thread_.trace != nullptr) {
        thread_.trace->end_bucket(samples);
    }
    thread_.counters.add(Counter::buckets);
    if (thread_.is_abandoned) {
        return false;
    }
    const PartTimer timer(thread_.counters, Part::work_film);
    film.submit(bucket, std::move(samples));
    return true;
}

namespace {

// Samples `part` of a pass go behind those the pixel has.
void append(const SampleBuffer& from, SampleBuffer::Part part, SampleBuffer& to, std::size_t at) {
    std::copy_n(from.samples.begin() + static_cast<std::ptrdiff_t>(part.first), part.count,
                to.samples.begin() + static_cast<std::ptrdiff_t>(at));
    const auto n = static_cast<std::size_t>(to.num_extra);
    std::copy_n(from.extra.begin() + static_cast<std::ptrdiff_t>(part.first * n), part.count * n,
                to.extra.begin() + static_cast<std::ptrdiff_t>(at * n));
}

} // namespace

// All samples of all pixels in one pass.
SampleBuffer BucketRenderer::render_fixed(std::size_t bucket, Film& film) {
    SampleBuffer samples = film.buffer(bucket);
    const PixelRange tiles = reuse_.is_on() ? film.tile_pixels(bucket) : samples.pixels;
    reuse_.begin(tiles);
    sampler_.fill(tiles, block_);
    if (tiles == samples.pixels) {
        run_pass(samples);
        return samples;
    }
    SampleBuffer& pass = passes_[0];
    pass.pixels = tiles;
    clear(pass);
    run_pass(pass);
    for (int y = samples.pixels.y0; y < samples.pixels.y1; ++y) {
        for (int x = samples.pixels.x0; x < samples.pixels.x1; ++x) {
            append(pass, pass.part(x, y), samples, samples.part(x, y).first);
        }
    }
    return samples;
}

// The first samples of whole tiles, then more where they say so.
SampleBuffer BucketRenderer::render_adaptive(std::size_t bucket, Film& film) {
    const PixelRange tiles = film.tile_pixels(bucket), owned = film.sample_pixels(bucket);
    const int each = sampler_.settings().least / quarters;
    auto& [firsts, rest] = passes_;
    reuse_.begin(tiles);
    sampler_.fill_firsts(tiles, block_);
    firsts.pixels = tiles;
    clear(firsts);
    run_pass(firsts);
    adaptive_.decide(tiles, firsts.samples, owned, counts_);
    more_.clear();
    for (std::size_t i = 0; i < counts_.size(); ++i) {
        const int pixel = static_cast<int>(i / quarters);
        const int number = static_cast<int>(i % quarters) * sampler_.per_quarter();
        if (counts_[i] > each) {
            more_.push_back({owned.x0 + pixel % owned.width(), owned.y0 + pixel / owned.width(),
                             static_cast<std::uint16_t>(number + each),
                             static_cast<std::uint16_t>(number + counts_[i])});
        }
    }
    sampler_.fill(more_, block_);
    reuse_.begin_more();
    clear(rest);
    run_pass(rest);
    SampleBuffer samples = film.buffer(bucket, counts_);
    const auto few = static_cast<std::size_t>(each);
    std::size_t in_rest = 0;
    for (std::size_t i = 0; i < counts_.size(); ++i) {
        const int pixel = static_cast<int>(i / quarters);
        const std::size_t first =
            firsts.part(owned.x0 + pixel % owned.width(), owned.y0 + pixel / owned.width()).first;
        const std::size_t more = counts_[i] - few, at = samples.begins[i];
        append(firsts, {first + i % quarters * few, few}, samples, at);
        append(rest, {in_rest, more}, samples, at + few);
        in_rest += more;
    }
    return samples;
}

void BucketRenderer::clear(SampleBuffer& samples) const {
    samples.num_extra = outputs_ != nullptr ? static_cast<int>(outputs_->num_channels()) : 0;
    samples.samples.assign(block_.count, Sample{});
    samples.extra.assign(block_.count * static_cast<std::size_t>(samples.num_extra), 0.0f);
}

void BucketRenderer::run_pass(SampleBuffer& samples) {
    Counters& counters = thread_.counters;
    if (thread_.trace != nullptr) {
        thread_.trace->begin_pass(block_);
    }
    {
        const PartTimer timer(counters, Part::work_rays);
        camera_packets_.resize(block_.num_packets());
        camera_.make_rays(block_, camera_packets_);
    }
    RayBundle rays;
    rays.count = static_cast<std::uint32_t>(block_.count);
    rays.packets = camera_packets_;
    rays.seeds = block_.seed;
    RayResults results;
    results.samples = samples.samples;
    results.extra = samples.extra;
    reuse_.begin_pass(block_);
    const std::uint32_t layers = layers_.trace(rays, results);
    if (outputs_ != nullptr) {
        fill_sample_channels(samples);
    }
    counters.add(Counter::samples, block_.count);
    counters.add(Counter::layers, layers);
    counters.max_layers = std::max<std::uint64_t>(counters.max_layers, layers);
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

} // namespace trace
