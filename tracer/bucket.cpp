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
      layers_(frame, classes, outputs, options, shader_, thread_) {
    thread_.levels = std::make_unique<RayLevels>(frame, camera, classes, options, thread_);
}

bool BucketRenderer::render(std::size_t bucket, Film& film) {
    sampler_.fill(film.sample_pixels(bucket), block_);
    SampleBuffer samples = film.buffer(bucket);
    Counters& counters = thread_.counters;
    if (thread_.trace != nullptr) {
        thread_.trace->begin_bucket(block_);
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
    const std::uint32_t layers = layers_.trace(rays, results);
    if (thread_.trace != nullptr) {
        thread_.trace->end_bucket(samples);
    }
    if (outputs_ != nullptr) {
        fill_sample_channels(samples);
    }
    counters.add(Counter::buckets);
    counters.add(Counter::samples, block_.count);
    counters.add(Counter::layers, layers);
    counters.max_layers = std::max<std::uint64_t>(counters.max_layers, layers);
    if (thread_.is_abandoned) {
        return false;
    }
    const PartTimer timer(counters, Part::work_film);
    film.submit(bucket, std::move(samples));
    return true;
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
