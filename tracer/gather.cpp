// SPDX-License-Identifier: Apache-2.0
#include "tracer/gather.h"

#include "runtime/base/lanes4.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace trace {

namespace {

using base::Float4; // a Sample is two of them

const Float4* registers(const Sample& sample) {
    return reinterpret_cast<const Float4*>(&sample);
}
static_assert(offsetof(Sample, opacity) == 12 && offsetof(Sample, one) == 24);

} // namespace

// Colour, opacity and weight; the lane of depth is not used.
struct Gather::Sum {
    Float4 low{}, high{};

    void add(const Sample& sample, float weight) {
        low += registers(sample)[0] * weight;
        high += registers(sample)[1] * weight;
    }
    [[nodiscard]] float weight() const { return high[2]; }
    // x - x is 0 for every finite x, NaN otherwise.
    [[nodiscard]] bool finite() const {
        const Float4 a = low - low, b = high - high;
        return a[0] + a[1] + a[2] + a[3] + b[0] + b[1] == 0;
    }
};

namespace {

PixelRange in_reach(const PixelRange& output, const FilterWeights& weights,
                    std::span<const ExtraChannel> extra) {
    int x = weights.reach_x(), y = weights.reach_y();
    for (const ExtraChannel& c : extra) {
        if (c.weights != nullptr) {
            x = std::max(x, c.weights->reach_x());
            y = std::max(y, c.weights->reach_y());
        }
    }
    return output.grown(x, y);
}

} // namespace

Gather::Gather(const Sampler& sampler, const FilterWeights& weights,
               std::span<const ExtraChannel> extra, DepthFilter depth, const PixelRange& output)
    : sampler_(sampler), extra_(extra), depth_(depth), output_(output),
      pixels_(in_reach(output, weights, extra)), width_(static_cast<std::size_t>(pixels_.width())),
      per_pixel_(static_cast<std::size_t>(sampler.per_pixel())),
      per_quarter_(per_pixel_ / quarters), sources_(pixels_.area()), reach_(reach_of(weights)) {
    make_runs();
    if (sampler.settings().least > 0) {
        make_mean_weights();
    }
}

// Over the samples of a few patterns: stratified, so close to the integrals.
void Gather::make_mean_weights() {
    const std::size_t num_patterns = std::min<std::size_t>(sampler_.num_patterns(), 32);
    const FilterWeights& weights = *reach_.weights;
    mean_weights_.assign(weights.neighbours() * quarters, 0);
    const float share = 1 / static_cast<float>(num_patterns * per_quarter_);
    for (std::size_t p = 0; p < num_patterns; ++p) {
        for (std::size_t i = 0; i < mean_weights_.size(); ++i) {
            const float* w = weights.weights(p * weights.neighbours() + i / quarters) +
                             i % quarters * per_quarter_;
            for (std::size_t k = 0; k < per_quarter_; ++k) {
                mean_weights_[i] += w[k] * share;
            }
        }
    }
}

Gather::Reach Gather::reach_of(const FilterWeights& weights) const {
    Reach reach{&weights, {}};
    for (int dy = -weights.reach_y(); dy <= weights.reach_y(); ++dy) {
        for (int dx = -weights.reach_x(); dx <= weights.reach_x(); ++dx) {
            reach.near.push_back(static_cast<std::ptrdiff_t>(dy) * pixels_.width() + dx);
        }
    }
    return reach;
}

void Gather::add(const SampleBuffer& buffer) {
    const PixelRange common = buffer.pixels.intersected(pixels_);
    for (int y = common.y0; y < common.y1; ++y) {
        add_row(buffer, y, common.x0, common.x1);
    }
}

void Gather::add_row(const SampleBuffer& buffer, int y, int x0, int x1) {
    const auto buffer_width = static_cast<std::size_t>(buffer.pixels.width());
    std::size_t pixel = static_cast<std::size_t>(y - buffer.pixels.y0) * buffer_width +
                        static_cast<std::size_t>(x0 - buffer.pixels.x0);
    Source* to = &sources_[static_cast<std::size_t>(y - pixels_.y0) * width_ +
                           static_cast<std::size_t>(x0 - pixels_.x0)];
    const auto channels = static_cast<std::size_t>(buffer.num_extra);
    const PixelHash hash(y);
    for (int x = x0; x < x1; ++x, ++to, ++pixel) {
        const auto [first, count] = buffer.begins.empty()
                                        ? SampleBuffer::Part{pixel * per_pixel_, per_pixel_}
                                        : buffer.part(pixel);
        *to = {buffer.samples.data() + first, buffer.extra.data() + first * channels,
               static_cast<std::uint32_t>(sampler_.pattern(hash(x)) * reach_.near.size()),
               static_cast<std::uint32_t>(count),
               buffer.begins.empty() ? nullptr : buffer.begins.data() + pixel * quarters};
    }
}

// Planes of one row of the bucket. The image's planes lie far apart: written pixel by pixel, each
// store would wait for its own cache line.
struct Gather::Row {
    std::array<std::array<float, max_bucket_px>, static_cast<std::size_t>(Plane::Count)> planes;

    void set(Plane plane, std::size_t x, float value) {
        planes[static_cast<std::size_t>(plane)][x] = value;
    }
};

std::uint64_t Gather::run(Image& image) const {
    std::uint64_t bad = 0;
    const auto count = static_cast<std::size_t>(output_.width());
    Row row;
    std::vector<float> values(extra_.size());
    for (int y = output_.y0; y < output_.y1; ++y) {
        const std::size_t at = static_cast<std::size_t>(y - image.pixels.y0) *
                                   static_cast<std::size_t>(image.pixels.width()) +
                               static_cast<std::size_t>(output_.x0 - image.pixels.x0);
        const Source* own = &sources_[static_cast<std::size_t>(y - pixels_.y0) * width_ +
                                      static_cast<std::size_t>(output_.x0 - pixels_.x0)];
        for (std::size_t x = 0; x < count; ++x) {
            bad += pixel(own + x, row, x);
        }
        for (std::size_t x = 0; x < count && !runs_.empty(); ++x) {
            for (const Run& channels : runs_) {
                extra_values(own + x, channels, values.data() + channels.first);
            }
            for (std::size_t c = 0; c < values.size(); ++c) {
                image.extra[c][at + x] = values[c];
            }
        }
        for (std::size_t p = 0; p < row.planes.size(); ++p) {
            std::copy_n(row.planes[p].begin(), count, image.planes[p].data() + at);
        }
    }
    return bad;
}

Gather::Sum Gather::filtered(const Source* own) const {
    Sum sum;
    for_samples(own, reach_, [&](const Source& source, std::size_t s, float weight) {
        sum.add(source.samples[s], weight);
    });
    return sum;
}

// The same with samples that are not finite taken as uncovered. plain: the mean of the own samples.
Gather::Sum Gather::careful(const Source* own, bool plain) const {
    Sum sum;
    const auto add = [&](const Source& source, std::size_t s, float weight) {
        Sum alone;
        alone.add(source.samples[s], 1);
        sum.add(alone.finite() ? source.samples[s] : Sample{}, weight);
    };
    if (plain) {
        for (std::size_t s = 0; s < own->count; ++s) {
            add(*own, s, 1);
        }
    } else {
        for_samples(own, reach_, add);
    }
    return sum;
}

std::uint64_t Gather::pixel(const Source* own, Row& row, std::size_t x) const {
    Sum sum = filtered(own);
    std::uint64_t bad = 0;
    // A filter narrower than the spacing of samples, or one with negative lobes and few samples,
    // may leave nothing to divide by: the pixel is then the plain mean of its own samples.
    const bool plain = !(sum.weight() >= reach_.weights->least_sum());
    if (plain || !sum.finite()) {
        sum = careful(own, plain);
        for (std::size_t s = 0; s < own->count; ++s) {
            Sum alone;
            alone.add(own->samples[s], 1);
            bad += alone.finite() ? 0 : 1;
        }
    }
    const float total = sum.weight();
    const Float4 low = sum.low / total, high = sum.high / total;
    row.set(Plane::R, x, low[0]);
    row.set(Plane::G, x, low[1]);
    row.set(Plane::B, x, low[2]);
    row.set(Plane::OR, x, low[3]);
    row.set(Plane::OG, x, high[0]);
    row.set(Plane::OB, x, high[1]);
    row.set(Plane::A, x, (low[3] + high[0] + high[1]) / 3);
    row.set(Plane::Z, x, depth(*own));
    return bad;
}

// Of the pixel's own covered samples; ri.md 9: depth bypasses the filter. NaN counts as uncovered.
float Gather::depth(const Source& own) const {
    float nearest = uncovered_z, farthest = -uncovered_z;
    if (depth_ == DepthFilter::Min) {
        for (std::size_t s = 0; s < own.count; ++s) {
            nearest = own.samples[s].z < nearest ? own.samples[s].z : nearest;
        }
        return nearest;
    }
    double sum = 0;
    int covered = 0;
    for (std::size_t s = 0; s < own.count; ++s) {
        const float z = own.samples[s].z;
        if (z < uncovered_z) {
            sum += static_cast<double>(z);
            farthest = std::max(farthest, z);
            ++covered;
        }
    }
    if (covered == 0) {
        return uncovered_z;
    }
    return depth_ == DepthFilter::Max ? farthest : static_cast<float>(sum / covered);
}

} // namespace trace
