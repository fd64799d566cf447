// SPDX-License-Identifier: Apache-2.0
// The extra channels of a pixel (docs/design/film.md, film-009): means, extremes, or the value of
// one sample. Values that are not finite count as 0. The order of the samples is the one of
// for_samples.
#include "tracer/gather.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace trace {

namespace {

float finite_or_zero(float value) {
    return std::isfinite(value) ? value : 0;
}

// Something lies there; what counts for depth does in any case.
bool is_covered(const Sample& sample) {
    return sample.z < uncovered_z || sample.opacity[0] > 0 || sample.opacity[1] > 0 ||
           sample.opacity[2] > 0;
}

} // namespace

void Gather::make_runs() {
    for (std::size_t first = 0; first < extra_.size();) {
        std::size_t end = first + 1;
        while (end < extra_.size() && extra_[end] == extra_[first]) {
            ++end;
        }
        const ExtraChannel& how = extra_[first];
        runs_.push_back(
            {first, end - first, how, how.weights != nullptr ? reach_of(*how.weights) : reach_});
        first = end;
    }
}

void Gather::extra_values(const Source* own, const Run& run, float* out) const {
    switch (run.how.combine) {
    case Combine::Mean:
        means(own, run, out);
        return;
    case Combine::CoveredMean:
        covered_means(own, run, out);
        return;
    case Combine::Min:
    case Combine::Max:
        extremes(own, run, out);
        return;
    case Combine::Nearest:
    case Combine::Farthest:
        outermost(own, run, out);
        return;
    }
}

// As it comes first: sums that are not finite are added up once more with care.
void Gather::means(const Source* own, const Run& run, float* out) const {
    if (!try_means(own, run, false, out, [](float value) { return value; })) {
        static_cast<void>(try_means(own, run, false, out, finite_or_zero));
    }
}

// plain: the mean of the own samples, as for colour where the weights say nothing.
template <class Clean>
bool Gather::try_means(const Source* own, const Run& run, bool plain, float* out,
                       const Clean& clean) const {
    const std::size_t stride = extra_.size();
    std::fill_n(out, run.count, 0.0f);
    float total = 0;
    const auto add = [&](const Source& source, std::size_t s, float weight) {
        const float* values = source.extra + s * stride + run.first;
        for (std::size_t c = 0; c < run.count; ++c) {
            out[c] += weight * clean(values[c]);
        }
        total += weight;
    };
    if (plain) {
        for (std::size_t s = 0; s < own->count; ++s) {
            add(*own, s, 1);
        }
    } else {
        for_samples(own, run.reach, add);
        if (!(total >= run.reach.weights->least_sum())) {
            return try_means(own, run, true, out, clean);
        }
    }
    float bad = 0; // x - x is 0 for every finite x
    for (std::size_t c = 0; c < run.count; ++c) {
        out[c] /= total;
        bad += out[c] - out[c];
    }
    return bad == 0;
}

void Gather::covered_means(const Source* own, const Run& run, float* out) const {
    const std::size_t stride = extra_.size();
    std::fill_n(out, run.count, 0.0f);
    float total = 0;
    for_samples(own, run.reach, [&](const Source& source, std::size_t s, float weight) {
        if (is_covered(source.samples[s])) {
            const float* values = source.extra + s * stride + run.first;
            for (std::size_t c = 0; c < run.count; ++c) {
                out[c] += weight * finite_or_zero(values[c]);
            }
            total += weight;
        }
    });
    const bool says_something = total >= run.reach.weights->least_sum();
    for (std::size_t c = 0; c < run.count; ++c) {
        out[c] = says_something ? out[c] / total : run.how.empty;
    }
}

void Gather::extremes(const Source* own, const Run& run, float* out) const {
    const std::size_t stride = extra_.size();
    const bool least = run.how.combine == Combine::Min;
    bool any = false;
    for_samples(own, run.reach, [&](const Source& source, std::size_t s, float weight) {
        if (weight == 0 || !is_covered(source.samples[s])) {
            return;
        }
        const float* values = source.extra + s * stride + run.first;
        for (std::size_t c = 0; c < run.count; ++c) {
            const float value = finite_or_zero(values[c]);
            out[c] = !any ? value : least ? std::min(out[c], value) : std::max(out[c], value);
        }
        any = true;
    });
    if (!any) {
        std::fill_n(out, run.count, run.how.empty);
    }
}

// The first of equally deep samples. What does not count for depth is farther than all that does.
void Gather::outermost(const Source* own, const Run& run, float* out) const {
    const std::size_t stride = extra_.size();
    const bool nearest = run.how.combine == Combine::Nearest;
    const float* chosen = nullptr;
    float chosen_z = 0;
    for_samples(own, run.reach, [&](const Source& source, std::size_t s, float weight) {
        const Sample& sample = source.samples[s];
        if (weight == 0 || !is_covered(sample)) {
            return;
        }
        const float z = sample.z;
        if (chosen == nullptr || (nearest ? z < chosen_z : z > chosen_z)) {
            chosen = source.extra + s * stride + run.first;
            chosen_z = z;
        }
    });
    for (std::size_t c = 0; c < run.count; ++c) {
        out[c] = chosen != nullptr ? finite_or_zero(chosen[c]) : run.how.empty;
    }
}

} // namespace trace
