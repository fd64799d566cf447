/* SPDX-License-Identifier: Apache-2.0
 * Compiles the text SL_BODY for uniform values and for lanes (sl_world.h). No include guard on
 * purpose.
 */
/* clang-format off: the order of these includes is their meaning */
#define SL_WORLD 1
#include "sl_world.h"
#include SL_BODY
#define SL_WORLD 2
#include "sl_world.h"
#include SL_BODY
#define SL_WORLD 0
#include "sl_world.h"
#undef SL_BODY
