// SPDX-License-Identifier: Apache-2.0
// What becomes of the results of a batch: opacities are clamped, what is no number is replaced and
// noted, the rest goes to the samples of its rays.
#include "runtime/base/lanes4.h"
#include "tracer/hit_shader.h"

#include <algorithm>

namespace trace {

namespace {

bool is_number(float x) {
    return x - x == 0;
}

// Planes are aligned to 64 bytes and padded to eight.
using base::Float4;

// Clamps the opacities, where they are about to be composited; colours stay (sl.md 5.2). False if a
// value is no number.
bool finish_planes(const float* Ci, float* Oi, std::size_t num_floats) {
    Float4 bad = {}; // x - x is 0 for numbers, NaN for the rest
    for (std::size_t at = 0; at < num_floats; at += 4) {
        const Float4 c = *reinterpret_cast<const Float4*>(Ci + at);
        auto& opacity = *reinterpret_cast<Float4*>(Oi + at);
        Float4 o = opacity;
        bad += (c - c) + (o - o);
        o = o < 0 ? Float4{} : o; // NaN stays, to be found
        opacity = o > 1 ? Float4{} + 1 : o;
    }
    return (bad[0] + bad[1]) + (bad[2] + bad[3]) == 0;
}

} // namespace

bool HitShader::scatter(const ShadeJob& job) {
    const std::span<const std::uint32_t> members = job.members;
    const bool all_good = finish_planes(job.Ci, job.Oi, 3 * std::size_t{job.stride});
    const std::size_t stride = job.stride;
    for (std::size_t i = 0; i < members.size(); ++i) {
        Sample& out = out_[members[i]];
        for (std::size_t k = 0; k < 3; ++k) {
            out.color[k] = job.Ci[k * stride + i];
            out.opacity[k] = job.Oi[k * stride + i];
        }
    }
    return all_good;
}

// Before a volume takes them: its own light still comes from there.
void HitShader::drop_bad_surface(ShadeJob& job) {
    const ShaderEntry& shader = *class_of(job).surface;
    std::uint64_t num_bad = 0;
    for (std::uint32_t i = 0; i < job.count(); ++i) {
        float sum = 0; // x - x is 0 for numbers, NaN for the rest
        for (std::size_t at = i; at < 3 * std::size_t{job.stride}; at += job.stride) {
            sum += (job.Ci[at] - job.Ci[at]) + (job.Oi[at] - job.Oi[at]);
        }
        for (std::size_t at = i; sum != 0 && at < 3 * std::size_t{job.stride}; at += job.stride) {
            job.Ci[at] = job.Oi[at] = 0;
        }
        num_bad += sum != 0 ? 1 : 0;
    }
    thread_.counters.add(Counter::bad_values, num_bad);
    thread_.bad.note(shader, BadResult::Color, num_bad);
}

// What is no number becomes a transparent black point.
void HitShader::blacken_bad(const ShadeJob& job, const ShaderEntry& shader) {
    std::uint64_t num_bad = 0;
    for (const std::uint32_t member : job.members) {
        Sample& out = out_[member];
        const auto is_good = [](const float* rgb) {
            return is_number(rgb[0]) && is_number(rgb[1]) && is_number(rgb[2]);
        };
        if (!is_good(out.color) || !is_good(out.opacity)) {
            out = {};
            if (outputs_ != nullptr) {
                const std::size_t n = outputs_->num_channels();
                std::ranges::fill(out_extra_.subspan(member * n, n), 0.0f);
            }
            ++num_bad;
        }
    }
    if (num_bad == 0) {
        return; // it was in the padding
    }
    thread_.counters.add(Counter::bad_values, num_bad);
    thread_.bad.note(shader, BadResult::Color, num_bad);
}

} // namespace trace
