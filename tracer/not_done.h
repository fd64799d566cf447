// SPDX-License-Identifier: Apache-2.0
// What a scene asks for and this version does not do, as far as nobody else notices: each thing is
// reported once, by name, at the first place that asks for it. Geometry reports shapes, the
// displays their types.
#pragma once

#include "ribtools/scene.h"
#include "runtime/base/diag.h"

namespace trace {

void report_not_done(const rib::Scene& scene, base::Diag& diag);

} // namespace trace
