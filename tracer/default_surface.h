// SPDX-License-Identifier: Apache-2.0
// The surface of things that have none, or whose shader cannot be had: matte under a lamp at the
// eye (ri.md 6.6). Part of the program, so that something is seen even where no shader is
// installed.
#pragma once

#include "runtime/abi/sl_abi.h"

namespace trace {

[[nodiscard]] const sl_object& default_surface_object();

} // namespace trace
