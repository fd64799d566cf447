// SPDX-License-Identifier: Apache-2.0
// Identifies all that decides the filtered pixels of a frame: scene, shaders, program. Two runs
// with one hash make the same bytes, bucket by bucket.
#pragma once

#include "ribtools/scene.h"
#include "tracer/shader_set.h"

#include <array>
#include <cstdint>

namespace trace {

[[nodiscard]] std::array<std::uint8_t, 32> frame_hash(const rib::Scene& scene,
                                                      const ShaderSet& shaders);

} // namespace trace
