/* SPDX-License-Identifier: Apache-2.0
 * Names of the world a shared text is compiled for; include with SL_WORLD set to 1 (uniform
 * values), 2 (lanes) or 0 (no names: leaves nothing behind). No include guard on purpose. F I V M S
 * float, mask, triple, matrix, string      FN(name)  prefixed name     OUT(name)  symbol attribute
 *   CALL       formal arguments of a function that sees its context; PASS the same as actual
 * arguments
 */
#undef F
#undef I
#undef V
#undef M
#undef S
#undef FN
#undef OUT
#undef CALL
#undef PASS
#if SL_WORLD == 1
#define F      float
#define I      int
#define V      slu3
#define M      slum
#define S      sl_string
#define FN(n)  slu_##n
#define OUT(n) SL_SYMBOL(slu_##n)
#define CALL   const sl_call* call __attribute__((unused))
#define PASS   call
#elif SL_WORLD == 2
#define F      slf
#define I      sli
#define V      slv
#define M      slm
#define S      sls
#define FN(n)  slv_##n
#define OUT(n) SL_SYMBOL(slv_##n)
#define CALL   const sl_call *call __attribute__((unused)), sli mask __attribute__((unused))
#define PASS   call, mask
#endif
#undef SL_WORLD
