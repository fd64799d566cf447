// SPDX-License-Identifier: Apache-2.0
// Primitive variables: which standard ones a primitive has, and any variable's value at a place of
// its surface. Values stay in object space; shade_point transforms them. Every access is checked
// against the data's size once, when the variable is bound, so that short arrays of a broken file
// are never read past their end.
#pragma once

#include "geometry/surface.h"
#include "ribtools/scene.h"

#include <cstdint>

namespace geo {

// The standard variables that shade_point reads (ri.md 10.4); nullptr = not given or unusable.
struct StandardVars {
    const rib::Param* Cs = nullptr;
    const rib::Param* Os = nullptr;
    const rib::Param* N = nullptr; // or "Np"
    const rib::Param* s = nullptr;
    const rib::Param* t = nullptr;
    const rib::Param* st = nullptr;

    [[nodiscard]] bool any() const { return Cs || Os || N || s || t || st; }
};

// Reports variables whose type or count does not fit and leaves them out.
[[nodiscard]] StandardVars bind_standard_vars(const rib::Primitive& primitive,
                                              const Surface& surface, base::Diag& diag);

// Floats per place: components times array length.
[[nodiscard]] std::size_t floats_per_item(const rib::ParamDecl& decl);
// Numeric, and long enough for its class on this surface.
[[nodiscard]] bool is_usable(const rib::Param& param, const Surface& surface);

// The value at a place; out receives floats_per_item() numbers.
void interpolate(const rib::Param& param, const Surface& surface, const LocalPoint& at,
                 double* out);
// value(to) - value(from), summed item by item in double.
void interpolate_difference(const rib::Param& param, const Surface& surface, const LocalPoint& from,
                            const LocalPoint& to, double* out);

} // namespace geo
