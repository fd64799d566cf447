// SPDX-License-Identifier: Apache-2.0
#include "tracer/output_bindings.h"

#include "ribtools/declare.h"
#include "tracer/sl_types.h"

#include <algorithm>
#include <string>

namespace trace {

namespace {

rib::ParamDecl declaration_of(const sl_param& param) {
    const auto storage =
        param.detail == SL_DETAIL_varying ? rib::StorageClass::Varying : rib::StorageClass::Uniform;
    return {storage, rib_type_of(param.type), std::max(param.array_length, 1),
            param.array_length > 0};
}

void note_outputs(const ShaderEntry* shader, ShaderOutputs& out) {
    for (int i = 0; shader != nullptr && i < shader->object().num_params; ++i) {
        const sl_param& param = shader->object().params[i];
        if (param.is_output != 0 && param.type != SL_TYPE_string) {
            out.emplace(param.name, declaration_of(param));
        }
    }
}

int components_of(const sl_param& param) {
    return rt::components_of(param.type) * std::max(param.array_length, 1);
}

// The component of the opacity that goes with a component of a weighted output.
int weight_of(const Output& output, int component) {
    return output.blend != Blend::Weighted             ? -1
           : output.decl.type == rib::ParamType::Color ? component % 3
                                                       : 0;
}

} // namespace

ShaderOutputs shader_outputs(const ShadingClasses& classes) {
    ShaderOutputs out;
    for (std::uint32_t i = 0; i < classes.size(); ++i) {
        note_outputs(classes[i].atmosphere, out);
        note_outputs(classes[i].surface, out);
        note_outputs(classes[i].displacement, out);
    }
    return out;
}

OutputBindings::OutputBindings(const OutputSet& outputs, const ShadingClasses& classes,
                               base::Diag& diag)
    : num_channels_(outputs.num_channels()), by_class_(classes.size()) {
    for (const Output& output : outputs.outputs()) {
        add_common(output);
        for (std::uint32_t i = 0; output.value == SampleValue::Shaded && i < classes.size(); ++i) {
            add(output, classes[i], by_class_[i], diag);
        }
    }
    for (const Class& c : by_class_) {
        all_variables_ |= c.variables;
    }
}

void OutputBindings::add_common(const Output& output) {
    const bool is_color = output.decl.type == rib::ParamType::Color;
    for (int k = 0; k < output.num_components(); ++k) {
        const int channel = output.first + k;
        if (output.value == SampleValue::Shaded) {
            blended_.push_back({channel, output.blend == Blend::Front, is_color ? k % 3 : 3});
        } else {
            of_samples_.push_back({channel, output.value, k});
        }
    }
}

// The atmosphere comes last, so its parameter counts; then the surface's, the displacement's; then
// what the language predefines.
void OutputBindings::add(const Output& output, const ShadingClass& c, Class& to, base::Diag& diag) {
    const bool found =
        (c.atmosphere != nullptr &&
         add_param(output, *c.atmosphere, ChannelSource::From::Atmosphere, to, diag)) ||
        (c.surface != nullptr &&
         add_param(output, *c.surface, ChannelSource::From::Surface, to, diag)) ||
        (c.displacement != nullptr &&
         add_param(output, *c.displacement, ChannelSource::From::Displacement, to, diag));
    if (!found) {
        add_variable(output, to);
    }
}

bool OutputBindings::add_param(const Output& output, const ShaderEntry& shader,
                               ChannelSource::From from, Class& to, base::Diag& diag) {
    const int index = shader.instance->shader().find_param(output.variable);
    if (index < 0 || shader.object().params[index].is_output == 0) {
        return false;
    }
    const sl_param& param = shader.object().params[index];
    const bool is_hpoint = output.decl.type == rib::ParamType::HPoint && param.array_length == 0;
    const int wanted = output.num_components() - (is_hpoint ? 1 : 0);
    if (param.type == SL_TYPE_string || components_of(param) != wanted) {
        const std::string text = "Display: \"" + output.variable + "\" is shown as " +
                                 rib::declaration_text(output.decl) + ", shader \"" + shader.name +
                                 "\" has it as " + rt::type_text(param.type, param.array_length) +
                                 "; its channels are 0 there";
        diag.report_once(text, base::Severity::Warning, base::Code::Consistency, output.pos, text);
        return true;
    }
    for (int k = 0; k < wanted; ++k) {
        to.sources.push_back({from, index, k, output.first + k, weight_of(output, k)});
    }
    if (is_hpoint) {
        to.sources.push_back({ChannelSource::From::One, 0, 0, output.first + wanted, -1});
    }
    return true;
}

void OutputBindings::add_variable(const Output& output, Class& to) {
    using From = ChannelSource::From;
    const auto note = [&](sl_variable id, int component, int k) {
        to.variables |= std::uint64_t{1} << id;
        to.sources.push_back(
            {From::Variable, id, component, output.first + k, weight_of(output, component)});
    };
    if (output.variable == "st" && output.num_components() == 2) {
        note(SL_VAR_s, 0, 0);
        note(SL_VAR_t, 0, 1);
        return;
    }
    const ShownVariable* variable = find_shown_variable(output.variable);
    if (variable == nullptr) {
        return;
    }
    static constexpr int held_by[] = {
#define SL_VAR(name, type, detail, readable, writable, note)                                       \
    SL_TYPE_##type == SL_TYPE_float ? 1 : 3,
#include "runtime/abi/sl_variables.def"
#undef SL_VAR
    };
    const int held = held_by[variable->id], wanted = output.num_components();
    const bool is_hpoint = output.decl.type == rib::ParamType::HPoint && wanted == held + 1;
    for (int k = 0; (held == wanted || is_hpoint) && k < held; ++k) {
        note(variable->id, k, k);
    }
    if (is_hpoint) {
        to.sources.push_back({From::One, 0, 0, output.first + held, -1});
    }
}

} // namespace trace
