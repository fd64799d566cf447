// SPDX-License-Identifier: Apache-2.0
// Primitive variables that take the place of parameters (sl.md 5.8). All hits here are of
// one shape. Varying parameters take any variable point by point; uniform ones hold one value per
// batch, so points are first brought together by value: slow for variables that vary, but right.
#include "tracer/hit_shader.h"
#include "tracer/sl_types.h"

#include <algorithm>
#include <cstring>

namespace trace {

namespace {

bool fits(const rib::Param& variable, const sl_param& param) {
    const sl_type type = sl_type_of(variable.decl.type);
    const int length = variable.decl.is_array ? variable.decl.array_length : 0;
    return types_agree(type, param.type) && length == param.array_length &&
           variable.decl.type != rib::ParamType::HPoint;
}

std::size_t floats_of(const sl_param& param) {
    return static_cast<std::size_t>(rt::components_of(param.type) *
                                    std::max(param.array_length, 1));
}

} // namespace

const rib::Param* HitShader::overriding(const ShadingClass& c, const ParamOverride& o,
                                        const geo::Hit& hit) const {
    const rib::Param* variable = frame_.world->primitive_variable(hit, o.name);
    return variable != nullptr && fits(*variable, c.shader(o.stage)->object().params[o.param])
               ? variable
               : nullptr;
}

std::size_t HitShader::equal_values(const ShadingClass& c, std::span<std::uint32_t> members,
                                    std::size_t begin) {
    std::size_t end = members.size();
    for (const ParamOverride& o : c.overrides) {
        const sl_param& param = c.shader(o.stage)->object().params[o.param];
        const bool one_value = param.detail == SL_DETAIL_uniform && param.type != SL_TYPE_string;
        const rib::Param* variable = one_value ? overriding(c, o, hits_[members[begin]]) : nullptr;
        if (variable == nullptr || variable->decl.storage == rib::StorageClass::Constant) {
            continue;
        }
        // The candidates' values, batch by batch; those that match the first move to the front.
        const std::size_t num_floats = floats_of(param);
        std::vector<float> first;
        std::vector<std::uint32_t> equal, other;
        std::vector<geo::Hit> hits;
        for (std::size_t at = begin; at < end; at += SL_BATCH_MAX) {
            const std::size_t n = std::min<std::size_t>(SL_BATCH_MAX, end - at);
            hits.clear();
            for (std::size_t i = 0; i < n; ++i) {
                hits.push_back(hits_[members[at + i]]);
            }
            values_.assign(num_floats * SL_BATCH_MAX, 0);
            frame_.world->fill_primitive_variable(hits, o.name, SL_BATCH_MAX, values_.data());
            for (std::size_t i = 0; i < n; ++i) {
                std::vector<float> value(num_floats);
                for (std::size_t k = 0; k < num_floats; ++k) {
                    value[k] = values_[k * SL_BATCH_MAX + i];
                }
                first = first.empty() ? value : first;
                const bool same =
                    std::memcmp(first.data(), value.data(), num_floats * sizeof(float)) == 0;
                (same ? equal : other).push_back(members[at + i]);
            }
        }
        std::copy(equal.begin(), equal.end(), members.begin() + static_cast<std::ptrdiff_t>(begin));
        std::copy(other.begin(), other.end(),
                  members.begin() + static_cast<std::ptrdiff_t>(begin + equal.size()));
        end = begin + equal.size();
    }
    return end;
}

void HitShader::bind_overrides(const ShadeJob& job, Stage stage, rt::ShadeBatch& batch) {
    const ShadingClass& c = class_of(job);
    const std::span<const geo::Hit> hits = job.hits;
    for (const ParamOverride& o : c.overrides) {
        if (o.stage != stage) {
            continue;
        }
        const sl_param& param = c.shader(o.stage)->object().params[o.param];
        const rib::Param* variable = overriding(c, o, hits.front());
        if (variable == nullptr) {
            continue;
        }
        if (param.type == SL_TYPE_string) {
            const sl_string text = frame_.strings.intern(
                variable->strings.empty() ? std::string_view() : variable->strings.front());
            if (sl_string* each = batch.param_strings(o.param)) {
                std::fill_n(each, batch.stride(), text);
            } else {
                *batch.param_uniform_string(o.param) = text;
            }
        } else if (float* planes = batch.param_plane(o.param)) {
            frame_.world->fill_primitive_variable(hits, o.name, batch.stride(), planes);
            if (float* by_u = batch.param_aux(o.param, 1)) {
                frame_.world->fill_primitive_differences(hits, o.name,
                                                         {batch.plane(SL_VAR_du),
                                                          batch.plane(SL_VAR_dv), batch.stride(),
                                                          by_u, batch.param_aux(o.param, 2)});
            }
        } else {
            values_.assign(floats_of(param) * SL_LANES_MAX, 0);
            frame_.world->fill_primitive_variable(hits.first(1), o.name, SL_LANES_MAX,
                                                  values_.data());
            for (std::size_t k = 0; k < floats_of(param); ++k) {
                batch.param_uniform(o.param)[k] = values_[k * SL_LANES_MAX];
            }
        }
    }
}

} // namespace trace
