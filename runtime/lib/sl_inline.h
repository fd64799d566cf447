/* SPDX-License-Identifier: Apache-2.0
 * Operators and small built-in functions, one text for uniform values and lanes: included twice by
 * sl_shader.h with F I V M S the float, mask, triple, matrix and string types and FN(name) the
 * prefix. No include guard on purpose. Arithmetic on F is written with C operators; comparisons
 * return I (0 or -1). Semantics: reference/sl.md 1.4 (operators), 4.1, 4.3, 4.4; each edge case is
 * named where it is decided.
 */

/* --- triples
 * ------------------------------------------------------------------------------------------------------
 */

SL_INLINE V FN(make_3)(F x, F y, F z) {
    V r;
    r.x = x, r.y = y, r.z = z;
    return r;
}
SL_INLINE V FN(f_to_3)(F x) {
    return FN(make_3)(x, x, x);
}
SL_INLINE V FN(add_3)(V a, V b) {
    return FN(make_3)(a.x + b.x, a.y + b.y, a.z + b.z);
}
SL_INLINE V FN(sub_3)(V a, V b) {
    return FN(make_3)(a.x - b.x, a.y - b.y, a.z - b.z);
}
SL_INLINE V FN(mul_3)(V a, V b) {
    return FN(make_3)(a.x * b.x, a.y * b.y, a.z * b.z);
}
SL_INLINE V FN(div_3)(V a, V b) {
    return FN(make_3)(a.x / b.x, a.y / b.y, a.z / b.z);
}
SL_INLINE V FN(neg_3)(V a) {
    return FN(make_3)(-a.x, -a.y, -a.z);
}
SL_INLINE V FN(scale_3)(V a, F k) {
    return FN(make_3)(a.x * k, a.y * k, a.z * k);
}
SL_INLINE F FN(dot_3)(V a, V b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
SL_INLINE V FN(cross_3)(V a, V b) {
    return FN(make_3)(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
/* Relations of triples hold when they hold for all three components; ne_3 is the negation of eq_3.
 */
SL_INLINE I FN(eq_3)(V a, V b) {
    return FN(eq_f)(a.x, b.x) & FN(eq_f)(a.y, b.y) & FN(eq_f)(a.z, b.z);
}
SL_INLINE I FN(ne_3)(V a, V b) {
    return ~FN(eq_3)(a, b);
}
SL_INLINE I FN(lt_3)(V a, V b) {
    return FN(lt_f)(a.x, b.x) & FN(lt_f)(a.y, b.y) & FN(lt_f)(a.z, b.z);
}
SL_INLINE I FN(le_3)(V a, V b) {
    return FN(le_f)(a.x, b.x) & FN(le_f)(a.y, b.y) & FN(le_f)(a.z, b.z);
}
SL_INLINE V FN(select_3)(I m, V a, V b) {
    return FN(make_3)(FN(select_f)(m, a.x, b.x), FN(select_f)(m, a.y, b.y),
                      FN(select_f)(m, a.z, b.z));
}

/* --- matrices
 * -----------------------------------------------------------------------------------------------------
 */

SL_INLINE M FN(f_to_m)(F x) { /* f on the diagonal */
    M r;
    for (int i = 0; i < 16; i++)
        r.m[i] = i % 5 == 0 ? x : FN(spread_f)(0);
    return r;
}
SL_INLINE M FN(add_m)(M a, M b) {
    for (int i = 0; i < 16; i++)
        a.m[i] = a.m[i] + b.m[i];
    return a;
}
SL_INLINE M FN(sub_m)(M a, M b) {
    for (int i = 0; i < 16; i++)
        a.m[i] = a.m[i] - b.m[i];
    return a;
}
SL_INLINE M FN(neg_m)(M a) {
    for (int i = 0; i < 16; i++)
        a.m[i] = -a.m[i];
    return a;
}
SL_INLINE M FN(select_m)(I m, M a, M b) {
    for (int i = 0; i < 16; i++)
        a.m[i] = FN(select_f)(m, a.m[i], b.m[i]);
    return a;
}
SL_INLINE I FN(eq_m)(M a, M b) {
    I r = FN(eq_f)(a.m[0], b.m[0]);
    for (int i = 1; i < 16; i++)
        r = r & FN(eq_f)(a.m[i], b.m[i]);
    return r;
}
SL_INLINE I FN(ne_m)(M a, M b) {
    return ~FN(eq_m)(a, b);
}

/* --- mathematics
 * --------------------------------------------------------------------------------------------------
 */

SL_INLINE F FN(radians)(F deg) {
    return deg * 0.0174532925199432958f;
}
SL_INLINE F FN(degrees)(F rad) {
    return rad * 57.2957795130823209f;
}
SL_INLINE F FN(abs)(F x) {
    return FN(f_of_bits)(FN(bits_of_f)(x) & 0x7fffffff);
}
SL_INLINE F FN(sign)(F x) { /* 0 at exactly 0 and for NaN */
    const F zero = FN(spread_f)(0), one = FN(spread_f)(1);
    return FN(select_f)(FN(lt_f)(zero, x), one, FN(select_f)(FN(lt_f)(x, zero), -one, zero));
}
SL_INLINE F FN(ceil)(F x) {
    return -FN(floor)(-x);
}
SL_INLINE F FN(round)(F x) { /* floor(x + 1/2), except where the sum itself would round up */
    const F below = FN(floor)(x);
    return FN(select_f)(FN(lt_f)(x - below, FN(spread_f)(0.5f)), below, below + FN(spread_f)(1));
}
SL_INLINE F FN(sqrt)(F x) { /* 0 for x < 0 */
    const F zero = FN(spread_f)(0);
    return FN(root_f)(FN(select_f)(FN(lt_f)(x, zero), zero, x));
}
SL_INLINE F FN(inversesqrt)(F x) { /* 0 for x <= 0 */
    const F zero = FN(spread_f)(0), one = FN(spread_f)(1);
    const I none = FN(le_f)(x, zero);
    return FN(select_f)(none, zero, one / FN(root_f)(FN(select_f)(none, one, x)));
}
SL_INLINE F FN(mod)(F a, F b) { /* in [0,b) for b > 0; b = 0: 0 */
    const F zero = FN(spread_f)(0);
    const I none = FN(eq_f)(b, zero);
    const F d = FN(select_f)(none, FN(spread_f)(1), b);
    F r = a - d * FN(floor)(a / d);
    /* rounding of a/d or of the product may leave the interval by one d */
    r = FN(select_f)(FN(lt_f)(r * d, zero), r + d, r);
    r = FN(select_f)(FN(le_f)(FN(abs)(d), FN(abs)(r)), r - d, r);
    return FN(select_f)(none, zero, r);
}
SL_INLINE F FN(min_f)(F a, F b) {
    return FN(lesser_f)(b, a);
}
SL_INLINE F FN(max_f)(F a, F b) {
    return FN(greater_f)(b, a);
}
SL_INLINE V FN(min_3)(V a, V b) {
    return FN(make_3)(FN(min_f)(a.x, b.x), FN(min_f)(a.y, b.y), FN(min_f)(a.z, b.z));
}
SL_INLINE V FN(max_3)(V a, V b) {
    return FN(make_3)(FN(max_f)(a.x, b.x), FN(max_f)(a.y, b.y), FN(max_f)(a.z, b.z));
}
SL_INLINE F FN(clamp_f)(F x, F lo, F hi) { /* lo is tested first: it wins when lo > hi */
    return FN(select_f)(FN(lt_f)(x, lo), lo, FN(select_f)(FN(lt_f)(hi, x), hi, x));
}
SL_INLINE V FN(clamp_3)(V x, V lo, V hi) {
    return FN(make_3)(FN(clamp_f)(x.x, lo.x, hi.x), FN(clamp_f)(x.y, lo.y, hi.y),
                      FN(clamp_f)(x.z, lo.z, hi.z));
}
SL_INLINE F FN(mix_f)(F x, F y, F a) {
    return x * (1.0f - a) + y * a;
}
SL_INLINE V FN(mix_33)(V x, V y, V a) {
    return FN(make_3)(FN(mix_f)(x.x, y.x, a.x), FN(mix_f)(x.y, y.y, a.y), FN(mix_f)(x.z, y.z, a.z));
}
SL_INLINE V FN(mix_3)(V x, V y, F a) {
    return FN(mix_33)(x, y, FN(f_to_3)(a));
}
SL_INLINE F FN(step)(F edge, F x) {
    return FN(select_f)(FN(lt_f)(x, edge), FN(spread_f)(0), FN(spread_f)(1));
}
/* Tests in this order, so lo == hi and lo > hi give a hard step. */
SL_INLINE F FN(smoothstep)(F lo, F hi, F x) {
    const F zero = FN(spread_f)(0), one = FN(spread_f)(1);
    const I below = FN(lt_f)(x, lo), above = FN(le_f)(hi, x);
    const F t = (x - lo) / FN(select_f)(below | above, one, hi - lo);
    return FN(select_f)(below, zero, FN(select_f)(above, one, t * t * (3.0f - 2.0f * t)));
}
/* --- components
 * ---------------------------------------------------------------------------------------------------
 */

SL_INLINE F FN(xcomp)(V a) {
    return a.x;
}
SL_INLINE F FN(ycomp)(V a) {
    return a.y;
}
SL_INLINE F FN(zcomp)(V a) {
    return a.z;
}
SL_INLINE void FN(setxcomp)(V* a, F x) {
    a->x = x;
}
SL_INLINE void FN(setycomp)(V* a, F y) {
    a->y = y;
}
SL_INLINE void FN(setzcomp)(V* a, F z) {
    a->z = z;
}
/* SL index to 0 .. n-1: truncated toward zero, clamped; NaN: 0. */
SL_INLINE I FN(index)(F x, int n) {
    const F last = FN(spread_f)((float)(n - 1)), zero = FN(spread_f)(0);
    return FN(int_of_f)(
        FN(select_f)(FN(lt_f)(zero, x), FN(select_f)(FN(lt_f)(last, x), last, x), zero));
}
SL_INLINE F FN(comp_3)(V a, F i) {
    const I k = FN(index)(i, 3);
    return FN(select_f)(FN(eq_i)(k, FN(spread_i)(0)), a.x,
                        FN(select_f)(FN(eq_i)(k, FN(spread_i)(1)), a.y, a.z));
}
SL_INLINE void FN(setcomp_3)(V* a, F i, F x) {
    const I k = FN(index)(i, 3);
    a->x = FN(select_f)(FN(eq_i)(k, FN(spread_i)(0)), x, a->x);
    a->y = FN(select_f)(FN(eq_i)(k, FN(spread_i)(1)), x, a->y);
    a->z = FN(select_f)(FN(eq_i)(k, FN(spread_i)(2)), x, a->z);
}
SL_INLINE F FN(arraylength)(int n) {
    return FN(spread_f)((float)n);
}

/* --- geometry
 * -----------------------------------------------------------------------------------------------------
 */

SL_INLINE F FN(length)(V a) {
    return FN(root_f)(FN(dot_3)(a, a));
}
SL_INLINE F FN(distance)(V a, V b) {
    return FN(length)(FN(sub_3)(a, b));
}
/* Zero stays zero. Squares that leave the range of float (|a| below 1e-18 or above 1e18) are scaled
 * first. */
SL_INLINE V FN(normalize)(V a) {
    const F zero = FN(spread_f)(0), one = FN(spread_f)(1);
    const F big = FN(max_f)(FN(abs)(a.x), FN(max_f)(FN(abs)(a.y), FN(abs)(a.z)));
    const I tiny = FN(lt_f)(big, FN(spread_f)(1e-16f)), huge = FN(lt_f)(FN(spread_f)(1e16f), big);
    const F k = FN(select_f)(tiny, FN(spread_f)(0x1p100f),
                             FN(select_f)(huge, FN(spread_f)(0x1p-100f), one));
    const V b = FN(scale_3)(a, k);
    const F d = FN(dot_3)(b, b);
    const I none = FN(eq_f)(d, zero);
    const F inv = one / FN(root_f)(FN(select_f)(none, one, d));
    return FN(scale_3)(b, inv);
}
SL_INLINE V FN(reflect)(V i, V n) {
    return FN(sub_3)(i, FN(scale_3)(n, 2.0f * FN(dot_3)(i, n)));
}
/* (I.Nref <= 0 ? 1 : -1) (N.Nref >= 0 ? 1 : -1) N: never zero, and right for a bumped N tilted
 * beyond 90 degrees. */
SL_INLINE V FN(faceforward_ref)(V n, V i, V nref) {
    const I back = FN(lt_f)(FN(spread_f)(0), FN(dot_3)(i, nref));
    const I turned = FN(lt_f)(FN(dot_3)(n, nref), FN(spread_f)(0));
    return FN(select_3)(back ^ turned, FN(neg_3)(n), n);
}
