// SPDX-License-Identifier: Apache-2.0
// Where the points of a shading class find the values displays ask for. In: the outputs of the
// frame, its shading classes. Out: per class, the source of each channel of a sample: an output
// parameter of the atmosphere or surface shader, or a predefined variable at the surface shader's
// end. Made once per frame, immutable.
#pragma once

#include "runtime/base/diag.h"
#include "tracer/outputs.h"
#include "tracer/shading_classes.h"

#include <cstdint>
#include <span>
#include <vector>

namespace trace {

// Output parameters of the displacement, surface and atmosphere shaders that something drawn refers
// to.
[[nodiscard]] ShaderOutputs shader_outputs(const ShadingClasses& classes);

struct ChannelSource {
    enum class From : std::uint8_t {
        Displacement,
        Surface,
        Atmosphere,
        Variable,
        One
    } from = From::One;
    int index = 0; // parameter or sl_variable
    int component = 0;
    int channel = 0; // of the sample
    int weight = -1; // component of the opacity it is multiplied by; -1: none
};

// A channel whose value comes from the shaded surfaces, and how they are laid over each other.
struct BlendedChannel {
    int channel = 0;
    bool front = false;   // else it adds up
    int transmission = 3; // component it is seen through; 3: their mean
};

// A channel that shows the composited sample itself.
struct SampleChannel {
    int channel = 0;
    SampleValue value = SampleValue::Color;
    int component = 0;
};

class OutputBindings {
public:
    OutputBindings() = default;
    // Parameters whose types do not fit are reported once and left at 0.
    OutputBindings(const OutputSet& outputs, const ShadingClasses& classes, base::Diag& diag);

    [[nodiscard]] std::size_t num_channels() const { return num_channels_; }
    [[nodiscard]] std::span<const ChannelSource> sources(std::uint32_t shading_class) const {
        return by_class_[shading_class].sources;
    }
    // Bits of the predefined variables among them.
    [[nodiscard]] std::uint64_t variables(std::uint32_t shading_class) const {
        return by_class_[shading_class].variables;
    }
    // The same for all classes.
    [[nodiscard]] std::uint64_t all_variables() const { return all_variables_; }
    [[nodiscard]] std::span<const BlendedChannel> blended() const { return blended_; }
    [[nodiscard]] std::span<const SampleChannel> of_samples() const { return of_samples_; }

private:
    struct Class {
        std::vector<ChannelSource> sources;
        std::uint64_t variables = 0;
    };
    void add_common(const Output& output);
    void add(const Output& output, const ShadingClass& c, Class& to, base::Diag& diag);
    bool add_param(const Output& output, const ShaderEntry& shader, ChannelSource::From from,
                   Class& to, base::Diag& diag);
    static void add_variable(const Output& output, Class& to);

    std::size_t num_channels_ = 0;
    std::uint64_t all_variables_ = 0;
    std::vector<Class> by_class_;
    std::vector<BlendedChannel> blended_;
    std::vector<SampleChannel> of_samples_;
};

} // namespace trace
