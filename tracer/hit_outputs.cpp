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
void HitShader::add_shown_planes(std::uint64_t variables, sl_points& planes) {
    std::size_t used = 0;
    for (std::uint64_t rest = variables; rest != 0; rest &= rest - 1) {
        const auto id = static_cast<std::size_t>(std::countr_zero(rest));
        if (planes.var[id] == nullptr) {
            planes.var[id] = shown_planes_[used++].values.data();
        }
    }
}

void HitShader::scatter_outputs(std::uint32_t shading_class, const sl_points& planes,
                                std::span<const std::uint32_t> members, const ShaderEntry& shader) {
    const std::size_t num_channels = outputs_->num_channels();
    std::uint64_t num_bad = 0;
    for (const ChannelSource& source : outputs_->sources(shading_class)) {
        Planes from;
        switch (source.from) {
        case ChannelSource::From::Displacement:
            from = param_planes(thread_.displacement, source);
            break;
        case ChannelSource::From::Surface:
            from = param_planes(thread_.surface, source);
            break;
        case ChannelSource::From::Atmosphere:
            from = param_planes(thread_.volume, source);
            break;
        case ChannelSource::From::Variable:
            from.first =
                planes.var[source.index] + static_cast<std::size_t>(source.component) * stride_;
            break;
        case ChannelSource::From::One:
            from = {&one, 0};
            break;
        }
        const float* weight =
            source.weight < 0 ? nullptr : Oi_ + static_cast<std::size_t>(source.weight) * stride_;
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
        thread_.bad.note(shader, BadResult::Output, num_bad);
    }
}

} // namespace trace
