// SPDX-License-Identifier: Apache-2.0
// A scene as one number: equal for scenes that describe the same picture, different otherwise as
// far as SHA-256 goes. Everything counts to the last bit except places in source files and the
// names of pictures. Records are taken apart by structured bindings: a member that somebody adds
// does not compile until it is decided here.
#pragma once

#include "ribtools/scene.h"

#include <string>

namespace rib {

// 64 hexadecimal digits. Cost: a few ns per byte of the scene.
[[nodiscard]] std::string scene_hash(const Scene& scene);

} // namespace rib
