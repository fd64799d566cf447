// SPDX-License-Identifier: Apache-2.0
// The engine's side of runtime/abi/sl_services.def. The engine pointer of every call is a
// trace::Execution.
#pragma once

#include "runtime/abi/sl_abi.h"

namespace trace {

[[nodiscard]] const sl_services& service_table();

} // namespace trace
