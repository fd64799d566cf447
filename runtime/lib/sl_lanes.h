/* SPDX-License-Identifier: Apache-2.0
 * Value types of shader code and the few operations on them that depend on compiler and processor.
 * Everything else is written with these (design.md 4: no system intrinsics, they cost 350 ms of
 * compile time). Results are the same bits at every width: all operations here are exact or
 * correctly rounded.
 */
#ifndef PERIGEE_SL_LANES_H
#define PERIGEE_SL_LANES_H

/* One lane is scalar C, which tests and benchmarks compare with; no object holds it. */
#if !defined(SL_LANES) || (SL_LANES != 1 && SL_LANES != 4 && SL_LANES != 8)
#error "define SL_LANES as 4 or 8 before including sl_shader.h"
#endif
#if SL_LANES == 8 && !defined(__AVX2__)
#error "SL_LANES 8 needs -mavx2"
#endif

#define SL_INLINE static inline __attribute__((always_inline, unused))

#define SL_TEXT_(x) #x
#define SL_TEXT(x)  SL_TEXT_(x)
/* Symbols carry the width (slv_sin_8), so that both archives can serve one shared object. */
#define SL_SYMBOL(name) __asm__(#name "_" SL_TEXT(SL_LANES)) __attribute__((visibility("hidden")))

typedef float slf __attribute__((vector_size(SL_LANES * 4)));
typedef int32_t sli __attribute__((vector_size(SL_LANES * 4)));
typedef uint32_t slw __attribute__((vector_size(SL_LANES * 4)));

typedef struct slu3 {
    float x, y, z;
} slu3;
typedef struct slum {
    float m[16]; /* rows; p' = p M */
} slum;
typedef struct slv {
    slf x, y, z;
} slv;
typedef struct slm {
    slf m[16];
} slm;
typedef struct sls {
    sl_string s[SL_LANES];
} sls;

/* --- conversions
 * -------------------------------------------------------------------------------------------------
 */

SL_INLINE slf slv_spread_f(float x) {
    return x - (slf){0};
}
SL_INLINE sli slv_spread_i(int x) {
    return x - (sli){0};
}
SL_INLINE float slu_spread_f(float x) {
    return x;
}
SL_INLINE int slu_spread_i(int x) {
    return x;
}
SL_INLINE slf slv_float_of_i(sli x) {
    return __builtin_convertvector(x, slf);
}
SL_INLINE float slu_float_of_i(int x) {
    return (float)x;
}
/* Truncates; the caller keeps |x| below 2^31. */
SL_INLINE sli slv_int_of_f(slf x) {
    return __builtin_convertvector(x, sli);
}
SL_INLINE int slu_int_of_f(float x) {
    return (int)x;
}
/* Truncates; -2^31 for NaN and what does not fit. */
SL_INLINE int slu_whole_of_f(float x) {
    return x >= -2147483648.0f && x < 2147483648.0f ? (int)x : -2147483647 - 1;
}
SL_INLINE sli slv_whole_of_f(slf x) {
#if SL_LANES == 8
    return (sli)__builtin_ia32_cvttps2dq256(x);
#elif SL_LANES == 4
    return (sli)__builtin_ia32_cvttps2dq(x);
#else
    return (sli){slu_whole_of_f(x[0])};
#endif
}
SL_INLINE sli slv_bits_of_f(slf x) {
    return (sli)x;
}
SL_INLINE int slu_bits_of_f(float x) {
    int bits;
    __builtin_memcpy(&bits, &x, sizeof bits);
    return bits;
}
SL_INLINE slf slv_f_of_bits(sli x) {
    return (slf)x;
}
SL_INLINE float slu_f_of_bits(int bits) {
    float x;
    __builtin_memcpy(&x, &bits, sizeof x);
    return x;
}

/* --- comparisons: 0 and -1 in both worlds, so that & | ~ work on them
 * --------------------------------------------- */

SL_INLINE sli slv_lt_f(slf a, slf b) {
    return a < b;
}
SL_INLINE sli slv_le_f(slf a, slf b) {
    return a <= b;
}
SL_INLINE sli slv_eq_f(slf a, slf b) {
    return a == b;
}
SL_INLINE sli slv_ne_f(slf a, slf b) {
    return a != b;
}
SL_INLINE sli slv_eq_i(sli a, sli b) {
    return a == b;
}
SL_INLINE int slu_lt_f(float a, float b) {
    return -(a < b);
}
SL_INLINE int slu_le_f(float a, float b) {
    return -(a <= b);
}
SL_INLINE int slu_eq_f(float a, float b) {
    return -(a == b);
}
SL_INLINE int slu_ne_f(float a, float b) {
    return -(a != b);
}
SL_INLINE int slu_eq_i(int a, int b) {
    return -(a == b);
}

/* --- selection: m ? a : b
 * ----------------------------------------------------------------------------------------- */

SL_INLINE sli slv_select_i(sli m, sli a, sli b) {
    return (a & m) | (b & ~m);
}
SL_INLINE slf slv_select_f(sli m, slf a, slf b) {
#if SL_LANES == 8
    return __builtin_ia32_blendvps256(b, a, (slf)m);
#elif SL_LANES == 4
    return (slf)(((sli)a & m) | ((sli)b & ~m));
#else
    return (slf){m[0] ? a[0] : b[0]};
#endif
}
SL_INLINE int slu_select_i(int m, int a, int b) {
    return m ? a : b;
}
SL_INLINE float slu_select_f(int m, float a, float b) {
    return m ? a : b;
}

/* By the sign bit of m: negative ? a : b. */
SL_INLINE slf slv_select_sign_f(sli m, slf a, slf b) {
#if SL_LANES == 8
    return __builtin_ia32_blendvps256(b, a, (slf)m);
#else
    return slv_select_f(m >> 31, a, b);
#endif
}
SL_INLINE float slu_select_sign_f(int m, float a, float b) {
    return m < 0 ? a : b;
}
/* a < b ? a : b and a > b ? a : b; b where either is NaN. */
SL_INLINE float slu_lesser_f(float a, float b) {
    return a < b ? a : b;
}
SL_INLINE float slu_greater_f(float a, float b) {
    return a > b ? a : b;
}
SL_INLINE slf slv_lesser_f(slf a, slf b) {
#if SL_LANES == 8
    return __builtin_ia32_minps256(a, b);
#elif SL_LANES == 4
    return __builtin_ia32_minps(a, b);
#else
    return (slf){slu_lesser_f(a[0], b[0])};
#endif
}
SL_INLINE slf slv_greater_f(slf a, slf b) {
#if SL_LANES == 8
    return __builtin_ia32_maxps256(a, b);
#elif SL_LANES == 4
    return __builtin_ia32_maxps(a, b);
#else
    return (slf){slu_greater_f(a[0], b[0])};
#endif
}

/* --- masks
 * --------------------------------------------------------------------------------------------------------
 */

/* One bit per lane, lane 0 lowest: what services take. */
SL_INLINE uint32_t sl_bits(sli mask) {
#if SL_LANES == 8
    return (uint32_t)__builtin_ia32_movmskps256((slf)mask);
#elif SL_LANES == 4
    return (uint32_t)__builtin_ia32_movmskps((slf)mask);
#else
    return mask[0] < 0;
#endif
}
SL_INLINE sli sl_mask(uint32_t bits) {
#if SL_LANES == 8
    const sli lane = {1, 2, 4, 8, 16, 32, 64, 128};
#elif SL_LANES == 4
    const sli lane = {1, 2, 4, 8};
#else
    const sli lane = {1};
#endif
    return (((int)bits) & lane) == lane;
}
SL_INLINE int sl_any(sli mask) {
    return sl_bits(mask) != 0;
}
SL_INLINE int sl_all(sli mask) {
    return sl_bits(mask) == (1u << SL_LANES) - 1;
}
SL_INLINE int sl_none(sli mask) {
    return sl_bits(mask) == 0;
}
/* Lowest live lane, 0 if there is none. */
SL_INLINE int sl_first_lane(sli mask) {
    return __builtin_ctz(sl_bits(mask) | 1u << SL_LANES) % SL_LANES;
}
SL_INLINE sli slv_mask_of_f(slf x) { /* SL truth: any float but 0 */
    return x != (slf){0};
}
SL_INLINE slf slv_f_of_mask(sli m) {
    return (slf)(m & 0x3f800000);
}

SL_INLINE int slv_any(sli mask) {
    return sl_any(mask);
}
SL_INLINE int slu_any(int mask) {
    return mask != 0;
}

/* --- integers modulo 2^32
 * ----------------------------------------------------------------------------------------- */

SL_INLINE sli slv_add_i(sli a, sli b) {
    return (sli)((slw)a + (slw)b);
}
SL_INLINE int slu_add_i(int a, int b) {
    return (int)((uint32_t)a + (uint32_t)b);
}
SL_INLINE sli slv_mul_i(sli a, uint32_t b) {
    return (sli)((slw)a * b);
}
SL_INLINE int slu_mul_i(int a, uint32_t b) {
    return (int)((uint32_t)a * b);
}
SL_INLINE sli slv_shl_i(sli a, int n) {
    return (sli)((slw)a << n);
}
SL_INLINE int slu_shl_i(int a, int n) {
    return (int)((uint32_t)a << n);
}
SL_INLINE sli slv_shr_i(sli a, int n) { /* zeros come in from the left */
    return (sli)((slw)a >> n);
}
SL_INLINE int slu_shr_i(int a, int n) {
    return (int)((uint32_t)a >> n);
}

/* --- roots and rounding
 * ------------------------------------------------------------------------------------------- */

SL_INLINE float slu_root_f(float x) {
    typedef float four __attribute__((vector_size(16)));
    return __builtin_ia32_sqrtps((four){x, 0, 0, 0})[0];
}
SL_INLINE slf slv_root_f(slf x) { /* IEEE square root */
#if SL_LANES == 8
    return __builtin_ia32_sqrtps256(x);
#elif SL_LANES == 4
    return __builtin_ia32_sqrtps(x);
#else
    return (slf){slu_root_f(x[0])};
#endif
}
/* Largest integer not above x. Huge values, infinities and NaN are their own floor; the sign of
 * zero stays. */
SL_INLINE float slu_floor(float x) {
    const float magnitude = x < 0 ? -x : x;
    if (!(magnitude < 8388608.0f))
        return x;
    float t = (float)(int)x;
    if (t > x)
        t -= 1;
    return slu_f_of_bits(slu_bits_of_f(t) | (slu_bits_of_f(x) & (int)0x80000000));
}
SL_INLINE slf slv_floor(slf x) {
#if SL_LANES == 8
    return __builtin_ia32_roundps256(x, 1);
#elif SL_LANES == 4
    const sli small = (slf)((sli)x & 0x7fffffff) < 8388608.0f;
    slf t = slv_float_of_i(slv_int_of_f((slf)((sli)x & small)));
    t -= (slf)((sli)(t > x) & 0x3f800000);
    return slv_select_f(small, (slf)((sli)t | ((sli)x & (int)0x80000000)), x);
#else
    return (slf){slu_floor(x[0])};
#endif
}

#endif
