/* SPDX-License-Identifier: Apache-2.0
 * Differences f(a + d) - f(a) of the transcendental functions, one text per world; included by
 * math.c after math_body.h. Each is an addition theorem, so that d enters as a factor; what holds
 * for all: sl_diff_inline.h.
 */

/* --- angles: sin(a + d) - sin(a) = 2 sin(d/2) cos(a + d/2), the last written out, because a + d/2
 * would be rounded */

SL_INLINE void FN(sine_cosine_)(F x, F* s, F* c) {
    I q;
    F tail;
    const F r = FN(reduce_angle_)(x, &tail, &q);
    *s = FN(sine_in_quadrant_)(r, tail, q);
    *c = FN(sine_in_quadrant_)(r, tail, FN(add_i)(q, KI(1)));
}

F FN(sin_d)(F x, F dx) {
    F s, c, half_s, half_c;
    FN(sine_cosine_)(x, &s, &c);
    FN(sine_cosine_)(0.5f * dx, &half_s, &half_c);
    return 2.0f * half_s * (c * half_c - s * half_s);
}

F FN(cos_d)(F x, F dx) {
    F s, c, half_s, half_c;
    FN(sine_cosine_)(x, &s, &c);
    FN(sine_cosine_)(0.5f * dx, &half_s, &half_c);
    return -2.0f * half_s * (s * half_c + c * half_s);
}

/* sin d / (cos a cos(a + d)) */
F FN(tan_d)(F x, F dx) {
    F s, c, step_s, step_c;
    FN(sine_cosine_)(x, &s, &c);
    FN(sine_cosine_)(dx, &step_s, &step_c);
    return FN(finite_)(step_s / c / (c * step_c - s * step_s));
}

/* The angle between the two directions: its sine and cosine come from products. 1 - x and 1 + x of
 * both points keep the ends exact; beyond them asin is constant. */
F FN(asin_d)(F x, F dx) {
    const F zero = K(0), one = K(1), two = K(2);
    const F below1 = 1.0f - x, above1 = 1.0f + x;
    const F p0 = FN(clamp_f)(below1, zero, two), p1 = FN(clamp_f)(below1 - dx, zero, two);
    const F q0 = FN(clamp_f)(above1, zero, two), q1 = FN(clamp_f)(above1 + dx, zero, two);
    const F a = FN(clamp_f)(x, -one, one), b = FN(clamp_f)(x + dx, -one, one);
    const F ca = FN(root_f)(p0 * q0), cb = FN(root_f)(p1 * q1);
    const I inside = LE(FN(abs)(x), one) & LE(FN(abs)(x + dx), one);
    const F d = SEL(inside, dx, SEL(LT(zero, a + b), p0 - p1, q1 - q0));
    const I opposite = LT(a * b, zero);
    const F sum = b * ca + a * cb;
    const I none = EQ(sum, zero);
    const F beside = SEL(none, zero, d * ((a + b) / SEL(none, one, sum)));
    const F sine = SEL(opposite, b * ca - a * cb, beside);
    const F straight = SEL(EQ(a, zero) & EQ(b, zero), d, sine);
    const F angle = FN(atan2)(FN(abs)(straight), ca * cb + a * b);
    return FLOAT(BITS(angle) ^ (BITS(dx) & (int)0x80000000));
}

F FN(acos_d)(F x, F dx) {
    return -FN(asin_d)(x, dx);
}

F FN(atan_d)(F x, F dx) {
    return FN(atan2)(dx, 1.0f + x * FN(moved_)(x, dx));
}

/* A power of two p with 1/4 < p |x| <= 2, for all but denormal x. */
SL_INLINE F FN(scale_to_unit_)(F x) {
    const I exponent = BITS(FN(lesser_f)(x, K(0x1p125f))) & 0x7f800000;
    return FLOAT(FN(add_i)(KI(0x7f000000), -exponent));
}

/* The angle between the two points plus the whole turn where the step crosses the branch cut. The
 * origin counts as a point at angle 0. */
F FN(atan2_d)(F y, F x, F dy, F dx) {
    const F zero = K(0), one = K(1);
    const F y1 = FN(moved_)(y, dy), x1 = FN(moved_)(x, dx);
    const I none = EQ(x, zero) & EQ(y, zero), none1 = EQ(x1, zero) & EQ(y1, zero);
    const F big = FN(max_f)(FN(abs)(x), FN(abs)(y));
    const F k = FN(scale_to_unit_)(big);
    const F k1 = FN(scale_to_unit_)(FN(max_f)(big, FN(max_f)(FN(abs)(dx), FN(abs)(dy))));
    const F px = SEL(none, one, x * k), py = SEL(none, zero, y * k);
    const F qx = SEL(none1, one, x1 * k1), qy = SEL(none1, zero, y1 * k1);
    const F by_step = px * (dy * k1) - py * (dx * k1);
    const F cross = SEL(none | none1, px * qy - py * qx, by_step);
    const F angle = FN(atan2)(cross, px * qx + py * qy);
    const I above = LE(zero, SEL(none, zero, y)), above1 = LE(zero, SEL(none1, zero, y1));
    const F turn = SEL(above & ~above1 & LT(zero, angle), K(-2 * SL_PI),
                       SEL(above1 & ~above & LT(angle, zero), K(2 * SL_PI), zero));
    return angle + turn;
}

/* --- exponential and logarithm
 * ------------------------------------------------------------------------------------ */

/* e^d - 1 for |d| <= 1 (others give some number). */
SL_INLINE F FN(expm1_)(F d) {
    const F near = FN(clamp_f)(d, K(-1), K(1));
    const F sum = near * 1.44269504f + 12582912.0f;
    const F n = sum - 12582912.0f;
    const F r = (near - n * 0.693359375f) - n * -2.12194440e-4f;
    const F p = 0.49999994f + r * (0.166665196f +
                                   r * (0.0416684076f + r * (0.00836891402f + r * 0.00138141867f)));
    const F two = FN(two_to_)(FN(add_i)(BITS(sum), KI(-0x4b400000)));
    return two * (r + r * r * p) + (two - 1.0f);
}

F FN(exp_d)(F x, F dx) {
    const F e = FN(exp)(x);
    const I near = LE(FN(abs)(dx), K(1));
    F r = e * FN(expm1_)(dx);
    if (FN(any)(~near))
        r = SEL(near, r, FN(exp)(FN(moved_)(x, dx)) - e);
    return FN(finite_)(r);
}

/* log|1 + q|, without loss for small q; the polynomial of log2_parts_. */
SL_INLINE F FN(log1p_)(F q) {
    const I near = LE(K(-0.29f), q) & LE(q, K(0.41f));
    const F c = SEL(near, q, K(0));
    const F s = c / (2.0f + c), z = s * s;
    const F tail = 0.666666627f + z * (0.400009722f + z * (0.284987926f + z * 0.242788494f));
    const F r = 2.0f * s + s * z * tail;
    return FN(any)(~near) ? SEL(near, r, FN(log)(FN(abs)(FN(moved_)(K(1), q)))) : r;
}

SL_INLINE F FN(log_domain_)(F x) { /* as log: x <= 0 counts as the smallest normal float */
    return SEL(LE(x, K(0)), K(0x1p-126f), x);
}

F FN(log_d)(F x, F dx) {
    const F x1 = FN(moved_)(x, dx), from = FN(log_domain_)(x), to = FN(log_domain_)(x1);
    const I inside = LT(K(0), x) & LT(K(0), x1);
    const F q = SEL(inside, dx, to - from) / from;
    const I near = LE(K(-0.29f), q) & LE(q, K(0.41f));
    const F r = FN(log1p_)(SEL(near, q, K(0)));
    return FN(any)(~near) ? SEL(near, r, FN(log)(to) - FN(log)(from)) : r;
}

F FN(log_base_d)(F x, F base, F dx, F dbase) {
    const F below = FN(log)(base), d_below = FN(log_d)(base, dbase), below1 = below + d_below;
    const F ratio = FN(finite_)(FN(log)(x) / below);
    return FN(finite_)((FN(log_d)(x, dx) - ratio * d_below) / below1);
}

/* x^y (e^t - 1) with t the change of y log|x|, where sign and neighbourhood allow; else the
 * difference of two powers, which then do not cancel. */
F FN(pow_d)(F x, F y, F dx, F dy) {
    const F zero = K(0), one = K(1);
    const F x1 = FN(moved_)(x, dx), y1 = FN(moved_)(y, dy);
    const F before = FN(pow)(x, y);
    const I grows = ~(EQ(x, zero) | EQ(x1, zero));
    const F q = dx / SEL(EQ(x, zero), one, x);
    const F growth = FN(log1p_)(SEL(grows, q, zero));
    const F by_exponent = SEL(EQ(dy, zero), zero, dy * FN(log)(FN(abs)(x)));
    const F t = y1 * growth + by_exponent;
    const F whole = FN(floor)(y), half = 0.5f * y;
    const I even = EQ(FN(floor)(half), half), fixed = EQ(dy, zero);
    const I odd = EQ(whole, y) & ~even;
    const I positive = LT(zero, x) & LT(zero, x1), negative = LT(x, zero) & LT(x1, zero);
    const I same_sign = positive | (fixed & (even | (odd & negative)));
    const I near = grows & same_sign & LE(FN(abs)(t), one);
    F r = before * FN(expm1_)(t);
    if (FN(any)(~near))
        r = SEL(near, r, FN(finite_)(FN(pow)(x1, y1)) - FN(finite_)(before));
    return FN(finite_)(r);
}

/* --- error function
 * -----------------------------------------------------------------------------------------------
 */

SL_INLINE F FN(bell_)(F x) {
    return FN(exp)(-(x * x));
}

/* Short steps by three-point Gauss quadrature of 2/sqrt(pi) e^(-x^2): error below 1e-6 of the
 * result while |d| (1 + |a|) <= 1/2. Long ones are subtracted, both from the nearer end. */
F FN(erf_d)(F x, F dx) {
    const F h = 0.5f * dx, m = x + h, node = 0.774596669f * h, x1 = FN(moved_)(x, dx);
    const I near = LE(FN(abs)(dx) * (1.0f + FN(abs)(x)), K(0.5f));
    const F mean =
        0.277777778f * (FN(bell_)(m - node) + FN(bell_)(m + node)) + 0.444444444f * FN(bell_)(m);
    F r = 1.12837917f * dx * mean;
    if (FN(any)(~near)) {
        const I above = LT(K(0.5f), x) & LT(K(0.5f), x1),
                below = LT(x, K(-0.5f)) & LT(x1, K(-0.5f));
        const F tails = FN(erfc)(FN(abs)(x)) - FN(erfc)(FN(abs)(x1));
        const F long_step = SEL(above, tails, SEL(below, -tails, FN(erf)(x1) - FN(erf)(x)));
        r = SEL(near, r, long_step);
    }
    return r;
}

F FN(erfc_d)(F x, F dx) {
    return -FN(erf_d)(x, dx);
}
