/* SPDX-License-Identifier: Apache-2.0
 * Transcendental functions, one text per world. Polynomials: tools/fit_polynomials.py. Measured
 * errors and the edge cases: docs/design/runtime-lib.md, lib-002. Only + - * / sqrt and integer
 * operations, in a fixed order: every width gives the same bits. Special values follow
 * reference/sl.md 4.1.
 */

/* --- angles
 * -------------------------------------------------------------------------------------------------------
 */

/* x = quadrant pi/2 + r + tail, |r| <= pi/4. pi/2 in four parts of 12 bits: for |x| < 6400 the
 * products with the quadrant and the first two differences are exact [Cody80], what the others lose
 * is the tail; the bits of x + 1.5 2^23 hold the rounded integer. */
SL_INLINE F FN(reduce_angle_)(F x, F* tail, I* quadrant) {
    const I huge = ~LE(FN(abs)(x), K(6400));
    const F near = SEL(huge, K(0), x);
    const F sum = near * 0.636619772f + 12582912.0f;
    const F n = sum - 12582912.0f;
    *quadrant = BITS(sum);
    const F a = (near - n * 0x1.92p+0f) - n * 0x1.fb4p-12f;
    const F third = n * 0x1.444p-24f, fourth = n * 0x1.68c234p-39f;
    const F b = a - third;
    const F r = b - fourth;
    *tail = ((a - b) - third) + ((b - r) - fourth);
    return FN(any)(huge) ? FN(huge_angle_)(x, huge, r, tail, quadrant) : r;
}

SL_INLINE F FN(sine_of_octant_)(F r, F tail) {
    const F z = r * r;
    const F p = -0.166666552f + z * (0.0083321901f + z * -0.000195183922f);
    return r + (r * z * p + tail);
}

SL_INLINE F FN(cosine_of_octant_)(F r, F tail) {
    const F z = r * r;
    const F half = z * 0.5f;
    const F w = 1.0f - half;
    const F p = 0.0416666456f + z * (-0.00138873013f + z * 2.44306702e-05f);
    return w + (((1.0f - w) - half) + (z * z * p - r * tail));
}

SL_INLINE F FN(sine_in_quadrant_)(F r, F tail, I q) {
    const F s = FN(sine_of_octant_)(r, tail), c = FN(cosine_of_octant_)(r, tail);
    const F v = SEL(FN(eq_i)(q & 1, KI(0)), s, c);
    return FLOAT(BITS(v) ^ FN(shl_i)(q & 2, 30));
}

F FN(sin)(F x) {
    I q;
    F tail;
    const F r = FN(reduce_angle_)(x, &tail, &q);
    return FN(sine_in_quadrant_)(r, tail, q);
}

F FN(cos)(F x) {
    I q;
    F tail;
    const F r = FN(reduce_angle_)(x, &tail, &q);
    return FN(sine_in_quadrant_)(r, tail, FN(add_i)(q, KI(1)));
}

F FN(tan)(F x) {
    I q;
    F tail;
    const F r = FN(reduce_angle_)(x, &tail, &q);
    const F z = r * r;
    F p = 0.0109455436f + z * (-4.61868476e-05f + z * 0.0044418294f);
    p = 0.333333522f + z * (0.13332583f + z * (0.0540686511f + z * (0.0212386101f + z * p)));
    const F t = r + (r * z * p + tail * (1.0f + z));
    const I even = FN(eq_i)(q & 1, KI(0));
    return SEL(even, t, -1.0f / SEL(even, K(1), t));
}

/* --- inverse functions
 * -------------------------------------------------------------------------------------------- */

SL_INLINE F FN(atan_small_)(F r) { /* |r| <= tan(3 pi/16) */
    const F z = r * r;
    F p = -0.0824874789f + z * (0.0506185517f + z * -0.0171257854f);
    p = 0.199991822f + z * (-0.142693222f + z * (0.109529585f + z * p));
    return r + r * z * (-0.333333194f + z * p);
}

/* atan(num/den) for 0 <= num <= den, den > 0; above tan(3 pi/16) as pi/4 +
 * atan((num-den)/(num+den)). */
SL_INLINE F FN(atan_quotient_)(F num, F den) {
    const I big = LT(den * 0.668178637f, num);
    const F r = FN(atan_small_)(SEL(big, num - den, num) / SEL(big, num + den, den));
    return SEL(big, 0.785398163f + (r - 2.18556941e-08f), r);
}

F FN(atan)(F x) {
    const F a = FN(abs)(x), one = K(1);
    const I inverse = LT(one, a);
    F r = FN(atan_quotient_)(SEL(inverse, one, a), SEL(inverse, a, one));
    r = SEL(inverse, SL_HALF_PI - (r + 4.37113883e-08f), r);
    r = SEL(EQ(a, K(__builtin_inff())), K(SL_HALF_PI), r);
    return FLOAT(BITS(r) ^ (BITS(x) & (int)0x80000000));
}

/* In (-pi, pi]; atan(0, 0) = 0 and atan(+-0, x<0) = pi. */
F FN(atan2)(F y, F x) {
    const F inf = K(__builtin_inff()), zero = K(0), one = K(1);
    F ax = FN(abs)(x), ay = FN(abs)(y);
    const I both = EQ(ax, inf) & EQ(ay, inf);
    ax = SEL(both, one, ax), ay = SEL(both, one, ay);
    const I steep = LT(ax, ay);
    F num = SEL(steep, ax, ay), den = SEL(steep, ay, ax);
    const I huge = LT(K(1e37f), den) & ~EQ(den, inf), none = EQ(den, zero), far = EQ(den, inf);
    num = SEL(huge, num * 0.25f, num), den = SEL(huge, den * 0.25f, den);
    F r = FN(atan_quotient_)(SEL(none | far, zero, num), SEL(none | far, one, den));
    r = SEL(steep, SL_HALF_PI - (r + 4.37113883e-08f), r);
    r = SEL(LT(x, zero), SL_PI - (r + 8.74227766e-08f), r);
    r = SEL(LT(y, zero), -r, r);
    const I number = EQ(x, x) & EQ(y, y);
    return SEL(number, r, x + y);
}

SL_INLINE F FN(head_)(F x) { /* upper 12 bits: products of two heads are exact */
    return FLOAT(BITS(x) & (int)0xfffff000);
}

/* asin of |x| in two parts, head + tail, for acos too. Above 1/2 they give r with asin |x| = pi/2 -
 * 2 r: there r = asin sqrt(z), and the root's own rounding goes into the tail. */
SL_INLINE F FN(asin_parts_)(F x, F* tail, I* above) {
    const F one = K(1);
    const F a0 = FN(abs)(x), a = SEL(LT(one, a0), one, a0);
    *above = LT(K(0.5f), a);
    const F z = SEL(*above, 0.5f * (1.0f - a), a * a);
    const F w = SEL(*above, FN(root_f)(z), a);
    const F p = 0.0454766601f + z * (0.0241481289f + z * 0.0422197841f);
    const F q = w * z * (0.166667536f + z * (0.0749524906f + z * p));
    const F head = SEL(*above, FN(head_)(w), w), sum = w + head;
    const F lost = (z - head * head) / SEL(EQ(sum, K(0)), one, sum);
    *tail = SEL(*above, q + lost, q);
    return head;
}

F FN(asin)(F x) {
    I above;
    F tail;
    const F head = FN(asin_parts_)(x, &tail, &above);
    const F outer = (SL_HALF_PI - 2.0f * head) - (2.0f * tail + 4.37113883e-08f);
    const F v = SEL(above, outer, head + tail);
    return FLOAT(BITS(v) ^ (BITS(x) & (int)0x80000000));
}

F FN(acos)(F x) {
    I above;
    F tail;
    const F head = FN(asin_parts_)(x, &tail, &above), r = head + tail;
    const I negative = LT(x, K(0));
    const F behind = (SL_PI - 2.0f * head) - (2.0f * tail + 8.74227766e-08f);
    const F outer = SEL(negative, behind, 2.0f * r);
    const F inner = SL_HALF_PI - (SEL(negative, -r, r) + 4.37113883e-08f);
    return SEL(above, outer, inner);
}

/* --- exponential and logarithm
 * ------------------------------------------------------------------------------------ */

SL_INLINE F FN(two_to_)(I n) { /* -126 <= n <= 127 */
    return FLOAT(FN(shl_i)(FN(add_i)(n, KI(127)), 23));
}

/* (1 + r + ...) 2^n for |r| <= ln2/2 and -151 <= n <= 128; two factors, so that results may be
 * denormal. */
SL_INLINE F FN(exp_reduced_)(F r, I n) {
    const F p = 0.49999994f + r * (0.166665196f +
                                   r * (0.0416684076f + r * (0.00836891402f + r * 0.00138141867f)));
    const F e = 1.0f + (r + r * r * p);
    const I half = n >> 1;
    return e * FN(two_to_)(half) * FN(two_to_)(FN(add_i)(n, -half));
}

/* e^(x + tail) for a tail far below x. */
SL_INLINE F FN(exp_sum_)(F x, F tail) {
    const I over = LT(K(88.7228394f), x), under = LT(x, K(-104)), number = EQ(x, x);
    const F near = SEL(over | under | ~number, K(0), x);
    const F sum = near * 1.44269504f + 12582912.0f;
    const F n = sum - 12582912.0f;
    const F r = ((near - n * 0.693359375f) - n * -2.12194440e-4f) + SEL(number, tail, K(0));
    const F e = FN(exp_reduced_)(r, FN(add_i)(BITS(sum), KI(-0x4b400000)));
    return SEL(number, SEL(over, K(__builtin_inff()), SEL(under, K(0), e)), x);
}

F FN(exp)(F x) {
    return FN(exp_sum_)(x, K(0));
}

/* x = m 2^e, m in [sqrt(1/2), sqrt 2); x positive and finite. */
SL_INLINE F FN(mantissa_)(F x, F* e) {
    const I denormal = LT(x, K(0x1p-126f));
    const I bits = FN(add_i)(BITS(SEL(denormal, x * 0x1p24f, x)), KI(-0x3f3504f3));
    *e = FN(float_of_i)(bits >> 23) - SEL(denormal, K(24), K(0));
    return FLOAT(FN(add_i)(bits & 0x7fffff, KI(0x3f3504f3)));
}

F FN(log)(F x) {
    const F inf = K(__builtin_inff());
    const I number = EQ(x, x), infinite = EQ(x, inf);
    /* x <= 0 counts as the smallest normal float: log stays finite */
    const F positive = SEL(LE(x, K(0)), K(0x1p-126f), SEL(infinite | ~number, K(1), x));
    F e;
    const F f = FN(mantissa_)(positive, &e) - 1.0f;
    const F z = f * f;
    F p = 0.110362872f + f * (-0.108196333f + f * (0.106315956f + f * -0.0597625338f));
    p = 0.200000912f + f * (-0.16669406f + f * (0.142851129f + f * (-0.124243997f + f * p)));
    p = 0.333333313f + f * (-0.249999672f + f * p);
    F r = f * z * p;
    r = r + e * -2.12194440e-4f;
    r = r - 0.5f * z;
    r = (f + r) + e * 0.693359375f;
    return SEL(number, SEL(infinite, inf, r), x);
}

F FN(log_base)(F x, F base) {
    return FN(log)(x) / FN(log)(base);
}

/* --- power
 * --------------------------------------------------------------------------------------------------------
 */

/* log2 of x > 0 as a sum, head of 12 bits and tail, with about 2^-30 relative error.
 * With s = (m-1)/(m+1): log m = 2 s + s^3 Q(s^2); only s itself needs two floats. */
SL_INLINE F FN(log2_parts_)(F x, F* tail) {
    F e;
    const F m = FN(mantissa_)(x, &e);
    const F f = m - 1.0f, d = m + 1.0f;
    const F s = f / d, s_head = FN(head_)(s), d_head = FN(head_)(d);
    const F d_tail = m - (d_head - 1.0f);
    const F s_tail = ((f - s_head * d_head) - s_head * d_tail) / d;
    const F z = s * s;
    const F q = 0.666666627f + z * (0.400009722f + z * (0.284987926f + z * 0.242788494f));
    const F c = 2.0f * s_tail + s * z * q;
    /* log2 e = 0x1.714p0 + 0x1.47652cp-12, the first of 12 bits */
    const F a = 2.0f * s_head * 0x1.714p+0f;
    const F b = 2.0f * s_head * 0x1.47652cp-12f + c * 1.44269504f;
    const F sum = e + a, lost = SEL(EQ(e, K(0)), K(0), a - (sum - e));
    const F head = FN(head_)(sum + b);
    *tail = ((sum - head) + lost) + b;
    return head;
}

/* x < 0 with non-integral y: 0; 0^0 = 1; 0^negative = 0. */
F FN(pow)(F x, F y) {
    const F zero = K(0), one = K(1), inf = K(__builtin_inff());
    const F ax = FN(abs)(x), ay = FN(abs)(y);
    const I none = EQ(ax, zero), far = EQ(ax, inf), number = EQ(x, x) & EQ(y, y);
    F l_tail;
    const F l_head = FN(log2_parts_)(SEL(none | far | ~number, one, ax), &l_tail);
    /* beyond 4e9 the power of any x but 1 is 0 or infinite already */
    const F yc = SEL(number, FN(clamp_f)(y, K(-4e9f), K(4e9f)), zero);
    const F y_head = FN(head_)(yc), y_tail = yc - y_head;
    const F p_head = y_head * l_head, p_tail = y_tail * l_head + yc * l_tail;
    const F power = p_head + p_tail;
    const I over = LE(K(128), power), under = LT(power, K(-151)), out = over | under;
    const F sum = SEL(out, zero, power) + 12582912.0f;
    const F n = sum - 12582912.0f;
    const F r = SEL(out, zero, (p_head - n) + p_tail) * 0.693147181f;
    F v = FN(exp_reduced_)(r, FN(add_i)(BITS(sum), KI(-0x4b400000)));
    v = SEL(over, inf, SEL(under, zero, v));
    v = SEL(none, zero, SEL(far, SEL(LT(y, zero), zero, inf), v));
    /* the sign: floats from 2^24 on are even */
    const I integral = EQ(FN(floor)(y), y);
    const F half = yc * 0.5f;
    const I odd = integral & LT(ay, K(0x1p24f)) & ~EQ(FN(floor)(half), half);
    v = SEL(LT(x, zero), SEL(integral, SEL(odd, -v, v), zero), v);
    v = SEL(number, v, x + y);
    return SEL(EQ(y, zero), one, v);
}

/* --- error function
 * -----------------------------------------------------------------------------------------------
 */

/* erfc for 0.5 <= x: e^(-x^2) P((x-3)/(x+3)) / (1+2x), x^2 split so that its rounding does not
 * reach the exponent. */
SL_INLINE F FN(erfc_tail_)(F x) {
    const F far = K(10.2f);
    const F a = SEL(LT(far, x), far, x);
    const F t = (a - 3.0f) / (a + 3.0f);
    F p = 0.00250655878f + t * (0.00195570872f + t * (-0.000692922389f + t * -0.000187149592f));
    p = 0.12964502f + t * (-0.119271472f + t * (0.0683107078f + t * (-0.0237894598f + t * p)));
    p = 1.25300801f + t * (-0.135621101f + t * (-0.0475623831f + t * p));
    const F head = FN(head_)(a), tail = a - head;
    const F e = FN(exp_sum_)(-(head * head), -(tail * (head + a)));
    return SEL(LT(far, x), K(0), e * (p / (1.0f + 2.0f * a)));
}

SL_INLINE F FN(erf_small_)(F x) { /* |x| <= 0.92 */
    const F z = x * x;
    F p = 0.00516492873f + z * (-0.000752013351f + z * (3.04757159e-05f + z * 1.78810333e-05f));
    p = 0.128379166f + z * (-0.37612626f + z * (0.112835445f + z * (-0.0268486664f + z * p)));
    return x + x * p;
}

F FN(erf)(F x) {
    const F a = FN(abs)(x);
    const I small = LT(a, K(0.92f));
    const F tail = 1.0f - FN(erfc_tail_)(SEL(small, K(1), a));
    const F r = SEL(small, FN(erf_small_)(SEL(small, a, K(0))), tail);
    return SEL(EQ(x, x), FLOAT(BITS(r) | (BITS(x) & (int)0x80000000)), x);
}

F FN(erfc)(F x) {
    const F a = FN(abs)(x);
    const I small = LT(a, K(0.5f));
    const F tail = FN(erfc_tail_)(SEL(small, K(1), a));
    const F inner = 1.0f - FN(erf_small_)(SEL(small, x, K(0)));
    return SEL(EQ(x, x), SEL(small, inner, SEL(LT(x, K(0)), 2.0f - tail, tail)), x);
}
