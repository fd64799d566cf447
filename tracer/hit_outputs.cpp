// SPDX-License-Identifier: Apache-2.0
// Values of a batch that displays show besides colour and opacity: from the planes of its shaders
// to the channels of the hits. Variables the shader does not hold are filled here, and only when a
// display asks for them.
#include "tracer/hit_shader.h"

#include <algorithm>
#include <bit>

namespace trace {

namespace {

constexpr float one = 1;

struct Planes {
    const float* first = nullptr; // null: no value
    std::size_t step = 1;         // 0: one value for all points
};

Planes param_planes(rt::ShadeBatch& batch, const ChannelSource& source) {
    if (const float* plane = batch.param_plane(source.index, source.component)) {
        return {plane, 1};
    }
    const float* uniform = batch.param_uniform(source.index);
    return {uniform != nullptr ? uniform + source.component : nullptr, 0};
}

} // namespace

// Gives planes to the variables displays ask for and the shader does not.
void HitShader::add_shown_planes(ShadeJob& job, std::uint64_t variables) {
    sl_points& planes = job.planes;
    const auto most = static_cast<std::size_t>(std::popcount(variables));
    job.shown_planes.resize(std::max(job.shown_planes.size(), most));
    std::size_t used = 0;
    for (std::uint64_t rest = variables; rest != 0; rest &= rest - 1) {
        const auto id = static_cast<std::size_t>(std::countr_zero(rest));
        if (planes.var[id] == nullptr) {
            planes.var[id] = job.shown_planes[used++].values.data();
        }
    }
}

void HitShader::scatter_outputs(ShadeJob& job) {
    const std::span<const std::uint32_t> members = job.members;
    const std::size_t stride = job.stride;
    const ShaderEntry* atmosphere = class_of(job).atmosphere;
    const std::size_t num_channels = outputs_->num_channels();
    std::uint64_t num_bad = 0;
    for (const ChannelSource& source : outputs_->sources(job.shading_class)) {
        Planes from;
        switch (source.from) {
        case ChannelSource::From::Displacement:
            from = param_planes(job.displacement, source);
            break;
        case ChannelSource::From::Surface:
            from = param_planes(job.surface, source);
            break;
        case ChannelSource::From::Atmosphere:
            from = job.volume_shader == atmosphere ? param_planes(job.volume, source) : Planes{};
            break;
        case ChannelSource::From::Variable:
            from.first =
                job.planes.var[source.index] + static_cast<std::size_t>(source.component) * stride;
            break;
        case ChannelSource::From::One:
            from = {&one, 0};
            break;
        }
        const float* weight =
            source.weight < 0 ? nullptr : job.Oi + static_cast<std::size_t>(source.weight) * stride;
        float* out = out_extra_.data() + source.channel;
        for (std::size_t i = 0; from.first != nullptr && i < members.size(); ++i) {
            const float value = from.first[i * from.step] * (weight != nullptr ? weight[i] : 1);
            const bool good = value - value == 0;
            out[members[i] * num_channels] = good ? value : 0;
            num_bad += good ? 0 : 1;
        }
    }
    if (num_bad > 0) {
        thread_.counters.add(Counter::bad_values, num_bad);
        thread_.bad.note(*class_of(job).surface, BadResult::Output, num_bad);
    }
}

} // namespace trace
