/* SPDX-License-Identifier: Apache-2.0
 * Difference of filterstep over an explicit interval, one text per world; included by filter.c
 * after filter_body.h. Options do not differ between the points. What holds for all:
 * sl_diff_inline.h.
 */

/* Each kernel's integral from u to u + d, both in [0,1]. */
SL_INLINE F FN(triangle_change_)(F u, F d) {
    const F half = K(0.5f), v = u + d, one = K(1);
    const F a0 = FN(min_f)(u, half), a1 = FN(min_f)(v, half);
    const F b0 = FN(max_f)(u, half), b1 = FN(max_f)(v, half);
    const F da = FN(min_f_d)(u, half, d, K(0)), db = FN(max_f_d)(u, half, d, K(0));
    return 2.0f * (da * (a0 + a1) + db * ((one - b0) + (one - b1)));
}

SL_INLINE F FN(gaussian_change_)(F u, F d) {
    return 0.523834613f * FN(erf_d)((2.0f * u - 1.0f) * 1.41421356f, 2.82842712f * d);
}

/* From a to a + d, 0 <= a: the two polynomials of catmull_rom_ meet at 1. */
SL_INLINE F FN(catmull_rom_side_)(F a, F d) {
    const F one = K(1), zero = K(0), b = a + d;
    const F p = FN(min_f)(a, one), q = FN(min_f)(b, one), dp = FN(min_f_d)(a, one, d, zero);
    const F r = FN(max_f)(a, one), s = FN(max_f)(b, one), dr = FN(max_f_d)(a, one, d, zero);
    const F pq = p * p + p * q + q * q, fourth = (p + q) * (p * p + q * q);
    const F inner = dp * (1.0f - 0.833333333f * pq + 0.375f * fourth);
    const F rs = r * r + r * s + s * s, fourth1 = (r + s) * (r * r + s * s);
    const F outer = dr * (2.0f - 2.0f * (r + s) + 0.833333333f * rs - 0.125f * fourth1);
    return inner + outer;
}

SL_INLINE F FN(catmull_rom_change_)(F u, F d) {
    const F z = 4.0f * u - 2.0f, dz = 4.0f * d, zero = K(0);
    const F above = FN(catmull_rom_side_)(FN(max_f)(z, zero), FN(max_f_d)(z, zero, dz, zero));
    const F below = FN(catmull_rom_side_)(-FN(min_f)(z, zero), -FN(min_f_d)(z, zero, dz, zero));
    return above - below;
}

F FN(filterstep_between_d)(F edge, F x1, F x2, const sl_value* values, int n, F d_edge, F dx1,
                           F dx2) {
    const sl_string filter = filter_name(values, n);
    const sl_value* width = filter_width(values, n);
    F low = FN(min_f)(x1, x2), high = FN(max_f)(x1, x2);
    F dlow = FN(min_f_d)(x1, x2, dx1, dx2), dhigh = FN(max_f_d)(x1, x2, dx1, dx2);
    if (width) {
        const F k = FN(abs)(FN(number_)(width));
        const F middle = (low + high) * 0.5f, half = (high - low) * 0.5f * k;
        const F dmiddle = (dlow + dhigh) * 0.5f, dhalf = (dhigh - dlow) * 0.5f * k;
        low = middle - half, high = middle + half;
        dlow = dmiddle - dhalf, dhigh = dmiddle + dhalf;
    }
    const F zero = K(0), one = K(1);
    const I thin = LE(high, low), thin1 = LE(high + dhigh, low + dlow);
    const F range = SEL(thin, one, high - low), drange = dhigh - dlow;
    const F range1 = SEL(thin1, one, (high - low) + drange);
    const F over = (high - edge) / range;
    const F move = ((dhigh - d_edge) - over * drange) / range1;
    const F u = FN(clamp_f)(over, zero, one), d = FN(clamp_f_d)(over, zero, one, move, zero, zero);
    F r = d;
    if (filter && same_text(filter, "triangle"))
        r = FN(triangle_change_)(u, d);
    else if (filter && same_text(filter, "gaussian"))
        r = FN(gaussian_change_)(u, d);
    else if (filter && same_text(filter, "catmull-rom"))
        r = FN(catmull_rom_change_)(u, d);
    const I either = thin | thin1;
    if (FN(any)(either)) {
        const F jump = FN(filterstep_between)(edge + d_edge, x1 + dx1, x2 + dx2, values, n) -
                       FN(filterstep_between)(edge, x1, x2, values, n);
        r = SEL(either, SEL(thin & thin1, FN(step_d)(edge, high, d_edge, dhigh), jump), r);
    }
    return FN(finite_)(r);
}
