// SPDX-License-Identifier: Apache-2.0
// Patch, PatchMesh and NuPatch as one Surface: a rectangle of Bezier parts (bezier.h), diced into
// one grid per part (dice.h); hits are moved onto the true surface. Local parameters of a part are
// (s,t) in [0,1]; shaders see the parameters of the whole surface.
#pragma once

#include "geometry/surface.h"
#include "ribtools/scene.h"

#include <memory>
#include <string>

namespace geo {

// nullptr and the reason when counts, basis, knots or positions describe no surface. params must
// hold "P", "Pw" or (patches only) "Pz" with the right number of items.
[[nodiscard]] std::unique_ptr<Surface> make_patches(const rib::Patches& patches,
                                                    const rib::Basis& basis,
                                                    const rib::ParamList& params, std::string& why);
[[nodiscard]] std::unique_ptr<Surface> make_nupatch(const rib::NuPatch& patch,
                                                    const rib::ParamList& params, std::string& why);

} // namespace geo
