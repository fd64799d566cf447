// SPDX-License-Identifier: Apache-2.0
#include "tracer/outputs.h"

#include "tracer/output_modes.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace trace {

namespace {

// More channels than any picture has use for: a bound on memory.
constexpr std::size_t max_channels = 1024;

struct ShownVariableRow {
    std::string_view name;
    ShownVariable variable;
};
#define SHOWN(name, blend)                                                                         \
    {                                                                                              \
#name, {                                                                                   \
            SL_VAR_##name, Blend::blend                                                            \
        }                                                                                          \
    }
constexpr ShownVariableRow shown_variables[] = {
    SHOWN(P, Front),    SHOWN(N, Front),    SHOWN(Ng, Front),      SHOWN(I, Front),
    SHOWN(dPdu, Front), SHOWN(dPdv, Front), SHOWN(u, Front),       SHOWN(v, Front),
    SHOWN(du, Front),   SHOWN(dv, Front),   SHOWN(s, Front),       SHOWN(t, Front),
    SHOWN(time, Front), SHOWN(Os, Over),    SHOWN(dPdtime, Front), SHOWN(Cs, Weighted),
};
#undef SHOWN

Blend default_blend(const ModeElement& e) {
    if (e.variable == "st") {
        return Blend::Front;
    }
    if (const ShownVariable* variable = find_shown_variable(e.variable)) {
        return variable->blend;
    }
    const bool adds = e.decl.type == rib::ParamType::Color || e.decl.type == rib::ParamType::Float;
    return adds ? Blend::Over : Blend::Front;
}

// Numbers that say where something is, or which way: rounding to levels or 11 bits ruins them.
bool is_place(rib::ParamType type) {
    return type == rib::ParamType::Point || type == rib::ParamType::HPoint ||
           type == rib::ParamType::Matrix;
}
bool is_geometric(rib::ParamType type) {
    return is_place(type) || type == rib::ParamType::Vector || type == rib::ParamType::Normal;
}

bool is_picture(SampleValue value) {
    return value == SampleValue::Color || value == SampleValue::Opacity ||
           value == SampleValue::Alpha;
}

// What compositing programs append to the name of a layer.
std::string component_name(const ModeElement& e, int component) {
    static constexpr const char *colors[] = {"R", "G", "B"}, *axes[] = {"X", "Y", "Z", "W"},
                                *coordinates[] = {"S", "T"};
    const int per_item = rib::components(e.decl.type);
    const auto k = static_cast<std::size_t>(component % per_item);
    if (e.variable == "st" && e.decl.array_length == 2) {
        return coordinates[component];
    }
    std::string prefix;
    if (e.decl.array_length > 1) {
        prefix = std::to_string(component / per_item);
    }
    std::string suffix;
    if (e.decl.type == rib::ParamType::Color) {
        suffix = colors[k];
    } else if (is_geometric(e.decl.type) && e.decl.type != rib::ParamType::Matrix) {
        suffix = axes[k];
    } else if (e.decl.type == rib::ParamType::Matrix) {
        suffix = std::to_string(k);
    }
    return prefix.empty() || suffix.empty() ? prefix + suffix : prefix + "." + suffix;
}

} // namespace

const ShownVariable* find_shown_variable(std::string_view name) {
    const auto* row = std::ranges::find(shown_variables, name, &ShownVariableRow::name);
    return row == std::end(shown_variables) ? nullptr : &row->variable;
}

// --- one display

class OutputPlanner {
public:
    OutputPlanner(OutputSet& set, const rib::Options& options, const ShaderOutputs& shader_outputs,
                  base::Diag& diag)
        : set_(set), options_(options), shader_outputs_(shader_outputs), diag_(diag) {}

    void add(const rib::Display& display);
    void finish();

private:
    static const rib::ParamList& first_with(const ModeElement& e, const rib::Display& display,
                                            std::string_view name) {
        return e.channel != nullptr && e.channel->find(name) != nullptr ? *e.channel
                                                                        : display.params;
    }
    ChannelFilter filter_of(const rib::ParamList& params, std::string_view default_name) const;
    ChannelFilter element_filter(const ModeElement& e, bool alone) const;
    void plan_picture(DisplayPlan& plan, const std::vector<ModeElement>& elements);
    void plan_element(DisplayPlan& plan, const ModeElement& e, bool alone);
    void plan_depth(const ModeElement& e, bool alone, ShownChannel& channel);
    int output_of(const ModeElement& e, const ChannelFilter& filter, Blend blend);
    Quantizer quantizer_of(const ModeElement& e, bool alone) const;
    ExrPixelType pixel_type(const ModeElement& e) const;
    void push(DisplayPlan& plan, const ModeElement& e, ShownChannel channel, int component);
    static void give_roles(DisplayPlan& plan);

    OutputSet& set_;
    const rib::Options& options_;
    const ShaderOutputs& shader_outputs_;
    base::Diag& diag_;
    const rib::Display* display_ = nullptr;
};

namespace {

struct CombineRow {
    std::string_view name;
    Combine combine;
};
// Filters that are no functions of the position: over the samples within filterwidth, a pixel by
// default.
constexpr CombineRow combine_rows[] = {
    {"min", Combine::Min},      {"max", Combine::Max},       {"average", Combine::Mean},
    {"zmin", Combine::Nearest}, {"zmax", Combine::Farthest},
};

} // namespace

ChannelFilter OutputPlanner::filter_of(const rib::ParamList& params,
                                       std::string_view default_name) const {
    const std::string name = params.get_string("filter", default_name);
    const std::vector<float> width = params.get_numbers("filterwidth");
    const auto* row = std::ranges::find(combine_rows, name, &CombineRow::name);
    ChannelFilter f;
    const bool is_statistic = row != std::end(combine_rows);
    f.combine = is_statistic ? row->combine : Combine::Mean;
    f.name = is_statistic ? "box" : name;
    for (std::size_t i = 0; i < 2; ++i) {
        const float fallback = is_statistic ? 1 : options_.filter_width[i];
        const float given = width.size() > i ? width[i] : width.empty() ? fallback : width[0];
        f.width_px[i] = given > 0 && std::isfinite(given) ? given : fallback;
    }
    const bool same = f.combine == Combine::Mean && f.name == options_.filter &&
                      f.width_px[0] == options_.filter_width[0] &&
                      f.width_px[1] == options_.filter_width[1];
    return same ? ChannelFilter{} : f;
}

// Depth is not filtered by what is meant for the colors beside it.
ChannelFilter OutputPlanner::element_filter(const ModeElement& e, bool alone) const {
    const auto asks = [](const rib::ParamList& p) {
        return p.find("filter") != nullptr || p.find("filterwidth") != nullptr;
    };
    if (e.channel != nullptr && asks(*e.channel)) {
        return filter_of(*e.channel, options_.filter);
    }
    const bool meant = e.value != SampleValue::Depth || alone;
    return meant && asks(display_->params) ? filter_of(display_->params, options_.filter)
                                           : ChannelFilter{};
}

// The outputs are numbered as they come; channels are given when all are known.
int OutputPlanner::output_of(const ModeElement& e, const ChannelFilter& filter, Blend blend) {
    for (std::size_t i = 0; i < set_.outputs_.size(); ++i) {
        const Output& o = set_.outputs_[i];
        if (o.variable == e.variable && o.value == e.value && o.blend == blend &&
            o.filter == filter && o.decl.type == e.decl.type &&
            o.decl.array_length == e.decl.array_length) {
            return static_cast<int>(i);
        }
    }
    const Output output{e.variable, e.decl, e.value, blend, filter, display_->pos, -1};
    const auto count = static_cast<std::size_t>(output.num_components());
    if (set_.num_channels_ + count > max_channels) {
        diag_.report_once("displays:channels", base::Severity::Error, base::Code::Limit,
                          display_->pos,
                          "displays ask for more than " + std::to_string(max_channels) +
                              " channels; the rest is left out");
        return -1;
    }
    set_.num_channels_ += count;
    set_.outputs_.push_back(output);
    return static_cast<int>(set_.outputs_.size()) - 1;
}

// Levels and floats

Quantizer OutputPlanner::quantizer_of(const ModeElement& e, bool alone) const {
    const bool is_depth = e.value == SampleValue::Depth;
    const auto named = [&](std::string_view name) -> const rib::Quantize* {
        const auto it = options_.other_quantize.find(std::string(name));
        return it == options_.other_quantize.end() ? nullptr : &it->second;
    };
    const rib::Quantize* own = named(e.name);
    own = own != nullptr ? own : named(e.variable);
    own = own == nullptr && e.value == SampleValue::Color ? named("rgb") : own;
    const bool as_depth = is_depth || is_geometric(e.decl.type);
    Quantizer q = quantizer(own != nullptr ? *own
                            : as_depth     ? options_.depth_quantize
                                           : options_.color_quantize);
    // The display's own values are meant for what it mainly holds: not for the depth beside a
    // color.
    const bool only_channel = is_depth && !alone;
    const rib::ParamList none;
    const rib::ParamList& channel = e.channel != nullptr ? *e.channel : none;
    const rib::ParamList& display = only_channel ? none : display_->params;
    const auto dither = static_cast<float>(q.dither);
    const float own_dither = channel.get_float("dither", display.get_float("dither", dither));
    std::vector<float> levels = channel.get_numbers("quantize");
    levels = levels.size() >= 4 ? levels : display.get_numbers("quantize");
    if (levels.size() >= 4) {
        q = quantizer({levels[1], levels[2], levels[3], own_dither});
        q.zero = std::isfinite(levels[0]) ? static_cast<double>(levels[0]) : 0;
    }
    q.dither = std::isfinite(own_dither) ? static_cast<double>(own_dither) : 0;
    return q;
}

ExrPixelType OutputPlanner::pixel_type(const ModeElement& e) const {
    const auto asked = [](const rib::ParamList& p) {
        return p.get_string("exrpixeltype", p.get_string("type", ""));
    };
    std::string type = e.channel != nullptr ? asked(*e.channel) : "";
    type = type.empty() ? asked(display_->params) : type;
    const bool precise = e.value == SampleValue::Depth || (type.empty() && is_place(e.decl.type));
    return precise || type == "float" ? ExrPixelType::Float : ExrPixelType::Half;
}

// --- channels

void OutputPlanner::push(DisplayPlan& plan, const ModeElement& e, ShownChannel channel,
                         int component) {
    const std::string suffix = component_name(e, component);
    const bool is_main = e.name == "Ci";
    channel.layer = is_main || e.name == "a" || e.name == "z" ? "" : e.name;
    channel.name = e.name == "a"   ? "A"
                   : e.name == "z" ? "Z"
                   : is_main       ? suffix
                                   : e.name + (suffix.empty() ? "" : ".") + suffix;
    channel.exr_type = pixel_type(e);
    const auto place = static_cast<int>(plan.channels.size());
    channel.dither_channel = channel.output < 0 ? static_cast<int>(channel.plane)
                                                : static_cast<int>(Plane::Count) + place;
    plan.channels.push_back(std::move(channel));
}

void OutputPlanner::plan_depth(const ModeElement& e, bool alone, ShownChannel& channel) {
    ChannelFilter filter = element_filter(e, alone);
    channel.role = ChannelRole::Depth;
    channel.plane = Plane::Z;
    if (!filter.is_own()) {
        filter.combine = filter.combine == Combine::Mean ? Combine::CoveredMean : filter.combine;
        channel.output = output_of(e, filter, Blend::Front);
    }
}

void OutputPlanner::plan_element(DisplayPlan& plan, const ModeElement& e, bool alone) {
    ShownChannel channel;
    channel.quantizer = quantizer_of(e, alone);
    if (e.value == SampleValue::Alpha) {
        channel.role = ChannelRole::Alpha;
        channel.plane = Plane::A;
    } else if (e.value == SampleValue::Depth) {
        plan_depth(e, alone, channel);
    } else if (e.value == SampleValue::Shaded) {
        const rib::ParamList& says = first_with(e, *display_, "composite");
        const int adds = says.get_int("composite", -1);
        const Blend blend = adds < 0 ? default_blend(e) : adds == 0 ? Blend::Front : Blend::Over;
        channel.role = ChannelRole::Other;
        channel.output = output_of(e, element_filter(e, alone), blend);
        if (channel.output < 0) {
            return;
        }
        const bool takes_display = e.decl.type == rib::ParamType::Color;
        channel.exposure = exposure_over({}, e.channel != nullptr ? *e.channel : rib::ParamList{},
                                         takes_display ? display_->params : rib::ParamList{});
    } else {
        channel.role = e.value == SampleValue::Color ? ChannelRole::Color : ChannelRole::Other;
    }
    const Plane first = e.value == SampleValue::Opacity ? Plane::OR : channel.plane;
    for (int k = 0; k < rib::components(e.decl.type) * e.decl.array_length; ++k) {
        ShownChannel component = channel;
        if (is_picture(e.value)) {
            component.plane = static_cast<Plane>(static_cast<int>(first) + k);
        }
        component.component = k;
        push(plan, e, std::move(component), k);
    }
}

// Exposure and filter of the picture's own channels.
void OutputPlanner::plan_picture(DisplayPlan& plan, const std::vector<ModeElement>& elements) {
    plan.exposure = exposure_of(options_, *display_);
    ChannelFilter filter;
    for (const ModeElement& e : elements) {
        if (is_picture(e.value)) {
            filter = filter.is_own() ? element_filter(e, true) : filter;
        }
        if (e.value == SampleValue::Color && e.channel != nullptr) {
            plan.exposure = exposure_over(plan.exposure, *e.channel, {});
        }
    }
    if (filter.is_own()) {
        return;
    }
    ModeElement all;
    all.variable = "Ci";
    all.decl = {rib::StorageClass::Varying, rib::ParamType::Color, 2, true}; // Ci, then Oi
    all.value = SampleValue::Color;
    plan.picture = output_of(all, filter, Blend::Over);
}

// Files that hold colors want them first; a lone triple is shown as one.
void OutputPlanner::give_roles(DisplayPlan& plan) {
    auto& channels = plan.channels;
    const auto is_color = [](const ShownChannel& c) { return c.role == ChannelRole::Color; };
    if (std::ranges::none_of(channels, is_color)) {
        for (std::size_t i = 0; i + 3 <= channels.size(); ++i) {
            const auto stem = [&](std::size_t k) {
                return channels[k].name.substr(0, channels[k].name.rfind('.'));
            };
            const bool is_triple = channels[i].role == ChannelRole::Other && stem(i) == stem(i + 2);
            if (is_triple) {
                for (std::size_t k = i; k < i + 3; ++k) {
                    channels[k].role = ChannelRole::Color;
                }
                break;
            }
        }
    }
    std::ranges::stable_sort(channels, {}, &ShownChannel::role);
}

void OutputPlanner::add(const rib::Display& display) {
    display_ = &display;
    DisplayPlan plan;
    plan.display = display;
    const std::vector<ModeElement> elements = read_mode(display, options_, shader_outputs_, diag_);
    plan_picture(plan, elements);
    for (const ModeElement& e : elements) {
        plan_element(plan, e, elements.size() == 1);
    }
    give_roles(plan);
    set_.displays_.push_back(std::move(plan));
}

// Channels that are computed alike lie beside each other.
void OutputPlanner::finish() {
    std::vector<Output>& outputs = set_.outputs_;
    for (const Output& o : outputs) {
        if (!o.filter.is_own() &&
            std::ranges::find(set_.filters_, o.filter) == set_.filters_.end()) {
            set_.filters_.push_back(o.filter);
        }
    }
    int next = 0;
    const auto place = [&](const ChannelFilter& filter) {
        for (Output& o : outputs) {
            if (o.filter == filter) {
                o.first = next;
                next += o.num_components();
            }
        }
    };
    place({});
    for (const ChannelFilter& filter : set_.filters_) {
        place(filter);
    }
    for (DisplayPlan& plan : set_.displays_) {
        if (plan.picture >= 0) {
            plan.picture = outputs[static_cast<std::size_t>(plan.picture)].first;
        }
        for (ShownChannel& c : plan.channels) {
            if (c.output >= 0) {
                c.extra = outputs[static_cast<std::size_t>(c.output)].first + c.component;
            }
        }
    }
}

// --- the set

OutputSet::OutputSet(std::span<const rib::Display> displays, const rib::Options& options,
                     const ShaderOutputs& shader_outputs, base::Diag& diag) {
    OutputPlanner planner(*this, options, shader_outputs, diag);
    for (const rib::Display& display : displays) {
        planner.add(display);
    }
    planner.finish();
}

std::vector<std::unique_ptr<FilterWeights>> OutputSet::weights(const Sampler& sampler,
                                                               base::Diag& diag) const {
    std::vector<std::unique_ptr<FilterWeights>> all;
    for (const ChannelFilter& f : filters_) {
        const auto asks = [&](const Output& o) { return o.filter == f; };
        const Filter filter(f.name, f.width_px[0], f.width_px[1], diag,
                            std::ranges::find_if(outputs_, asks)->pos);
        all.push_back(std::make_unique<FilterWeights>(filter, sampler));
    }
    return all;
}

std::vector<ExtraChannel>
OutputSet::film_channels(std::span<const std::unique_ptr<FilterWeights>> weights) const {
    std::vector<ExtraChannel> channels(num_channels_);
    for (const Output& o : outputs_) {
        ExtraChannel how;
        how.combine = o.filter.combine;
        const auto it = std::ranges::find(filters_, o.filter);
        if (it != filters_.end()) {
            how.weights = weights[static_cast<std::size_t>(it - filters_.begin())].get();
        }
        how.empty = o.value == SampleValue::Depth ? uncovered_z : 0;
        std::fill_n(channels.begin() + o.first, o.num_components(), how);
    }
    return channels;
}

} // namespace trace
