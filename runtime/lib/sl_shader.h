/* SPDX-License-Identifier: Apache-2.0
 * What emitted shader code (and the bodies of the built-in functions) includes; plain C11 or C++, GCC or Clang.
 * Define SL_LANES as 8 (compile with -mavx2) or 4 (x86-64 baseline) first; flags: -ffp-contract=off -fno-math-errno.
 *
 * Two worlds share one text: `slu_<name>` works on uniform values (float, slu3, slum, sl_string, int conditions) and
 * `slv_<name>` on lanes (slf, slv, slm, sls, sli masks of 0 and -1). sl_inline.h holds what is inlined, for both;
 * sl_calls.h declares the rest, which lives in libsl_lanes8.a and libsl_lanes4.a under names that end in the width.
 * Suffixes of operations: _f float, _3 triple, _m matrix, _s string, _i int or mask.
 */
#ifndef PERIGEE_SL_SHADER_H
#define PERIGEE_SL_SHADER_H

#include "sl_abi.h"

#include "sl_lanes.h"

#define F     float
#define I     int
#define V     slu3
#define M     slum
#define S     sl_string
#define FN(n) slu_##n
#include "sl_inline.h"
#undef F
#undef I
#undef V
#undef M
#undef S
#undef FN

#define F     slf
#define I     sli
#define V     slv
#define M     slm
#define S     sls
#define FN(n) slv_##n
#include "sl_inline.h"
#undef F
#undef I
#undef V
#undef M
#undef S
#undef FN

#include "sl_packet.h"

#define SL_TEXT_(x) #x
#define SL_TEXT(x)  SL_TEXT_(x)
/* Symbols carry the width (slv_sin_8), so that both archives can serve one shared object. */
#define SL_SYMBOL(name) __asm__(#name "_" SL_TEXT(SL_LANES)) __attribute__((visibility("hidden")))

#ifdef __cplusplus
extern "C" {
#endif

#define F      float
#define I      int
#define V      slu3
#define M      slum
#define S      sl_string
#define FN(n)  slu_##n
#define OUT(n) SL_SYMBOL(slu_##n)
#define CALL   const sl_call *call
#include "sl_calls.h"
#undef F
#undef I
#undef V
#undef M
#undef S
#undef FN
#undef OUT
#undef CALL

#define F      slf
#define I      sli
#define V      slv
#define M      slm
#define S      sls
#define FN(n)  slv_##n
#define OUT(n) SL_SYMBOL(slv_##n)
#define CALL   const sl_call *call, sli mask
#include "sl_calls.h"
#undef F
#undef I
#undef V
#undef M
#undef S
#undef FN
#undef OUT
#undef CALL

#include "sl_lights.h"

#ifdef __cplusplus
}
#endif

#endif
