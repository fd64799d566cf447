// SPDX-License-Identifier: Apache-2.0
// A scene as text, for tests and for looking at what a RIB file became. Stable: no addresses, no
// hash order, numbers with six significant digits.
#pragma once

#include "ribtools/scene.h"

#include <string>

namespace rib {

[[nodiscard]] std::string dump(const Scene& scene);

} // namespace rib
