// SPDX-License-Identifier: Apache-2.0
// Four values in one register, for loops over arrays outside of shaders. 16 bytes is the widest
// register that every x86-64 processor has: GCC takes comparisons of wider vectors apart there.
// They may alias, so arrays are read through them; such arrays must be aligned to 16 bytes.
#pragma once

#include <cstdint>

namespace base {

using Float4 [[gnu::vector_size(16), gnu::may_alias]] = float;
using Int4 [[gnu::vector_size(16), gnu::may_alias]] = std::int32_t;

} // namespace base
