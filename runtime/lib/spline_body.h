/* SPDX-License-Identifier: Apache-2.0
 * spline, one text per world. The value is clamped to [0,1] and spread over the segments;
 * sl.md 4.1.2. Fewer than 4 knots cannot reach this (slc checks); a shorter array gives its first
 * knot.
 */

typedef struct FN(place_) {
    I first; /* first knot of the segment */
    F weight[4];
} FN(place_);

SL_INLINE int FN(segments_)(const basis* b, int n) {
    return (n - 4) / b->step + 1;
}

SL_INLINE F FN(unit_)(F x) { /* NaN: 0 */
    return FN(lesser_f)(FN(greater_f)(x, K(0)), K(1));
}

static FN(place_) FN(find_place_)(const basis* b, F value, int n) {
    const int segments = FN(segments_)(b, n);
    const F x = FN(unit_)(value) * (float)segments;
    const F s = FN(lesser_f)(FN(floor)(x), K((float)(segments - 1)));
    const F t = x - s;
    FN(place_) p;
    p.first = FN(mul_i)(FN(int_of_f)(s), (uint32_t)b->step);
    for (int k = 0; k < 4; k++)
        p.weight[k] = ((t * b->m[k] + b->m[4 + k]) * t + b->m[8 + k]) * t + b->m[12 + k];
    return p;
}

static F FN(spline_at_)(const basis* b, F value, const F* knots, int n) {
    const FN(place_) p = FN(find_place_)(b, value, n);
    F r = K(0);
    for (int k = 0; k < 4; k++)
        r = r + p.weight[k] * FN(at_f)(knots, FN(add_i)(p.first, KI(k)));
    return r;
}

/* x in [0,1] with spline(x) = value, for knots that rise or fall throughout; bisection to 2^-31. */
static F FN(solve_)(const basis* b, F value, const F* knots, int n) {
    const F start = FN(spline_at_)(b, K(0), knots, n), end = FN(spline_at_)(b, K(1), knots, n);
    const F sign = SEL(LE(start, end), K(1), K(-1));
    const F wanted = value * sign;
    F low = K(0), width = K(0.5f);
    for (int i = 0; i < 31; i++) {
        const F here = FN(spline_at_)(b, low + width, knots, n) * sign;
        low = SEL(LE(here, wanted), low + width, low);
        width = width * 0.5f;
    }
    low = SEL(LE(wanted, start * sign), K(0), low);
    return SEL(LE(end * sign, wanted), K(1), low);
}

F FN(spline_f)(sl_string name, F x, const F* knots, int n) {
    int inverse;
    const basis* b = find_basis(name, &inverse);
    if (n < 4)
        return n > 0 ? knots[0] : K(0);
    return inverse ? FN(solve_)(b, x, knots, n) : FN(spline_at_)(b, x, knots, n);
}

V FN(spline_3)(sl_string name, F x, const V* knots, int n) {
    int inverse;
    const basis* b = find_basis(name, &inverse);
    if (n < 4)
        return n > 0 ? knots[0] : FN(f_to_3)(K(0));
    const FN(place_) p = FN(find_place_)(b, x, n);
    V r = FN(f_to_3)(K(0));
    for (int k = 0; k < 4; k++) {
        const V knot = FN(at_3)(knots, FN(add_i)(p.first, KI(k)));
        r = FN(add_3)(r, FN(scale_3)(knot, p.weight[k]));
    }
    return r;
}
