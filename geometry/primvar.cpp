// SPDX-License-Identifier: Apache-2.0
#include "geometry/primvar.h"

#include <algorithm>

namespace geo {

namespace {

// What a standard variable must look like.
struct Expected {
    const char* name;
    std::size_t floats;
    const rib::Param* StandardVars::*slot;
};

constexpr Expected expected[] = {
    {"Cs", 3, &StandardVars::Cs}, {"Os", 3, &StandardVars::Os}, {"Np", 3, &StandardVars::N},
    {"N", 3, &StandardVars::N},   {"s", 1, &StandardVars::s},   {"t", 1, &StandardVars::t},
    {"st", 2, &StandardVars::st}, // "N" after "Np": it wins
};

void add_scaled(const rib::Param& param, std::size_t width, const Stencil& stencil, double* out) {
    for (std::size_t i = 0; i < stencil.size(); ++i) {
        const auto [item, weight] = stencil[i];
        for (std::size_t k = 0; k < width; ++k) {
            const std::size_t at = item * width + k;
            out[k] += weight * static_cast<double>(param.decl.type == rib::ParamType::Integer
                                                       ? static_cast<float>(param.ints[at])
                                                       : param.floats[at]);
        }
    }
}

void constant_stencil_or(const rib::Param& param, const Surface& surface, const LocalPoint& at,
                         Stencil& stencil) {
    if (param.decl.storage == rib::StorageClass::Constant) {
        stencil.add(0, 1);
    } else {
        surface.stencil(param.decl.storage, at, stencil);
    }
}

} // namespace

std::size_t floats_per_item(const rib::ParamDecl& decl) {
    return static_cast<std::size_t>(rib::components(decl.type)) *
           static_cast<std::size_t>(std::max(decl.array_length, 1));
}

bool is_usable(const rib::Param& param, const Surface& surface) {
    if (param.decl.type == rib::ParamType::String || param.decl.type == rib::ParamType::Pointer) {
        return false;
    }
    const std::size_t held =
        param.decl.type == rib::ParamType::Integer ? param.ints.size() : param.floats.size();
    return held / floats_per_item(param.decl) >= surface.num_items(param.decl.storage);
}

StandardVars bind_standard_vars(const rib::Primitive& primitive, const Surface& surface,
                                base::Diag& diag) {
    StandardVars vars;
    for (const Expected& e : expected) {
        const rib::Param* param = primitive.params.find(e.name);
        if (!param) {
            continue;
        }
        if (floats_per_item(param->decl) == e.floats && is_usable(*param, surface)) {
            vars.*e.slot = param;
        } else {
            diag.report(base::Severity::Warning, base::Code::Consistency, primitive.pos,
                        std::string("primitive variable \"") + e.name +
                            "\" does not fit the primitive in type or count; ignored");
        }
    }
    return vars;
}

void interpolate(const rib::Param& param, const Surface& surface, const LocalPoint& at,
                 double* out) {
    const std::size_t width = floats_per_item(param.decl);
    std::fill_n(out, width, 0.0);
    Stencil stencil;
    constant_stencil_or(param, surface, at, stencil);
    add_scaled(param, width, stencil, out);
}

void interpolate_difference(const rib::Param& param, const Surface& surface, const LocalPoint& from,
                            const LocalPoint& to, double* out) {
    const std::size_t width = floats_per_item(param.decl);
    std::fill_n(out, width, 0.0);
    if (param.decl.storage == rib::StorageClass::Constant ||
        param.decl.storage == rib::StorageClass::Uniform) {
        return;
    }
    Stencil stencil;
    surface.stencil(param.decl.storage, from, stencil);
    stencil.scale(-1);
    surface.stencil(param.decl.storage, to, stencil);
    add_scaled(param, width, stencil, out);
}

} // namespace geo
