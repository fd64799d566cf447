/* SPDX-License-Identifier: Apache-2.0
 * What emitted shader code (and the bodies of the built-in functions) includes; plain C11 or C++,
 * GCC or Clang. Define SL_LANES as 8 (compile with -mavx2) or 4 (x86-64 baseline) first; flags:
 * -ffp-contract=off -fno-math-errno.
 *
 * Two worlds share one text: `slu_<name>` works on uniform values (float, slu3, slum, sl_string,
 * int conditions) and `slv_<name>` on lanes (slf, slv, slm, sls, sli masks of 0 and -1).
 * sl_inline.h holds what is inlined, for both; sl_calls.h declares the rest, which lives in
 * libsl_lanes8.a and libsl_lanes4.a under names that end in the width. sl_diff_inline.h and
 * sl_diff_calls.h are the same for differences to auxiliary points. Suffixes of operations: _f
 * float, _3 triple, _m matrix, _s string, _i int or mask.
 */
#ifndef PERIGEE_SL_SHADER_H
#define PERIGEE_SL_SHADER_H

#ifdef __cplusplus
extern "C" {
#endif

/* clang-format off: the order of these includes is their meaning */
#include "sl_abi.h"
#include "sl_lanes.h"
#define SL_BODY "sl_inline.h"
#include "sl_both_worlds.h"
#define SL_BODY "sl_diff_inline.h"
#include "sl_both_worlds.h"
#include "sl_packet.h"
#define SL_BODY "sl_calls.h"
#include "sl_both_worlds.h"
#define SL_BODY "sl_diff_calls.h"
#include "sl_both_worlds.h"
#include "sl_lights.h"
/* clang-format on */

#ifdef __cplusplus
}
#endif

#endif
