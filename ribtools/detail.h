// SPDX-License-Identifier: Apache-2.0
// The size on screen of a Detail box (ri.md 12.4).
#pragma once

#include "ribtools/scene.h"

namespace rib {

// Area in raster pixels of the projection of a box (xmin xmax ymin ymax zmin zmax), clipped by the
// near plane only. Finished options (after WorldBegin). A box behind the camera has area 0.
[[nodiscard]] float raster_area(const Options& options, const base::Mat4& cam_from_box,
                                const std::array<double, 6>& bound);

} // namespace rib
