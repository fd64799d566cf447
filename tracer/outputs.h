// SPDX-License-Identifier: Apache-2.0
// What a frame's displays ask for. In: Display and DisplayChannel requests, declarations, the
// outputs of the scene's shaders. Out: per display the channels of its file, and the list of
// further values a sample must carry (Image::extra) beside colour, opacity and depth: only what
// some display shows, each once. Immutable. Source: ri.md 6.4; rules in docs/displays.md.
#pragma once

#include "ribtools/scene.h"
#include "runtime/abi/sl_abi.h"
#include "runtime/base/diag.h"
#include "tracer/film.h"
#include "tracer/quantize.h"

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace trace {

// How the values of surfaces behind each other become the value of a sample.
enum class Blend : std::uint8_t {
    Over,     // like Ci: the shader has multiplied by opacity
    Weighted, // the same, multiplied by opacity here
    Front     // of the surface that counts for depth; others leave it alone
};

// What the components of an output are.
enum class SampleValue : std::uint8_t { Shaded, Color, Opacity, Alpha, Depth };

// A filter other than the picture's own.
struct ChannelFilter {
    Combine combine = Combine::Mean;
    std::string name; // of a pixel filter; "" = the picture's own
    float width_px[2] = {0, 0};

    [[nodiscard]] bool is_own() const { return name.empty(); }
    friend bool operator==(const ChannelFilter& a, const ChannelFilter& b) {
        return a.combine == b.combine && a.name == b.name && a.width_px[0] == b.width_px[0] &&
               a.width_px[1] == b.width_px[1];
    }
};

// A value samples carry for some display.
struct Output {
    std::string variable; // as shaders and geometry call it
    rib::ParamDecl decl;
    SampleValue value = SampleValue::Shaded;
    Blend blend = Blend::Over;
    ChannelFilter filter;
    base::SourcePos pos; // of the Display that asked first
    int first = -1;      // of its channels in Image::extra

    [[nodiscard]] int num_components() const {
        return rib::components(decl.type) * decl.array_length;
    }
};

enum class ChannelRole : std::uint8_t { Color, Alpha, Depth, Other };
enum class ExrPixelType : std::uint8_t { Half, Float };

// One channel of a file.
struct ShownChannel {
    std::string name;  // R G B A Z, Cdiffuse.R, N.X
    std::string layer; // "" for those of the picture itself
    ChannelRole role = ChannelRole::Color;
    Plane plane = Plane::R;         // of the picture, where output is -1
    int output = -1, component = 0; // of OutputSet::outputs()
    int extra = -1;                 // the same as a channel of Image::extra
    Exposure exposure;              // of outputs; the picture's planes are exposed already
    Quantizer quantizer;
    ExrPixelType exr_type = ExrPixelType::Half;
    int dither_channel = 0;
};

struct DisplayPlan {
    rib::Display display;
    std::vector<ShownChannel> channels; // colors first, then alpha, depth, others; may be empty
    Exposure exposure;                  // of color
    // Color and opacity: the film's planes (-1), or six channels of Image::extra from here on,
    // where the display has a filter of its own.
    int picture = -1;
};

// Declarations of the output parameters of the scene's shaders, by name.
using ShaderOutputs = std::map<std::string, rib::ParamDecl, std::less<>>;

// Predefined variables of surfaces that displays may show.
struct ShownVariable {
    sl_variable id;
    Blend blend;
};
[[nodiscard]] const ShownVariable* find_shown_variable(std::string_view name);

class OutputSet {
public:
    OutputSet() = default;
    // Modes that name nothing known are reported; the display goes on without them.
    OutputSet(std::span<const rib::Display> displays, const rib::Options& options,
              const ShaderOutputs& shader_outputs, base::Diag& diag);

    [[nodiscard]] const std::vector<DisplayPlan>& displays() const { return displays_; }
    [[nodiscard]] const std::vector<Output>& outputs() const { return outputs_; }
    [[nodiscard]] std::size_t num_channels() const { return num_channels_; }

    // The filters of film_channels(), for one sampler.
    [[nodiscard]] std::vector<std::unique_ptr<FilterWeights>> weights(const Sampler& sampler,
                                                                      base::Diag& diag) const;
    // How the film combines each channel; weights: from weights().
    [[nodiscard]] std::vector<ExtraChannel>
    film_channels(std::span<const std::unique_ptr<FilterWeights>> weights) const;

private:
    friend class OutputPlanner;
    std::vector<DisplayPlan> displays_;
    std::vector<Output> outputs_;
    std::vector<ChannelFilter> filters_; // distinct, without the picture's own
    std::size_t num_channels_ = 0;
};

} // namespace trace
