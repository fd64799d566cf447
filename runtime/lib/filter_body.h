/* SPDX-License-Identifier: Apache-2.0
 * Integrals of the filters of reference/sl.md 4.1.1 from the left end of their support to u in
 * [0,1], one text per world. Supports: box and triangle as they are, gaussian e^(-2 z^2) cut at |z|
 * = 1, catmull-rom |z| <= 2.
 */

SL_INLINE F FN(triangle_)(F u) {
    const F v = 1.0f - u;
    return SEL(LT(u, K(0.5f)), 2.0f * u * u, 1.0f - 2.0f * v * v);
}

SL_INLINE F FN(gaussian_)(F u) { /* 1/(2 erf sqrt 2) */
    return 0.5f + 0.523834613f * FN(erf)((2.0f * u - 1.0f) * 1.41421356f);
}

/* Antiderivative of the kernel from its centre: it overshoots slightly, as the filter does. */
SL_INLINE F FN(catmull_rom_)(F u) {
    const F z = 4.0f * u - 2.0f, a = FN(abs)(z), aa = a * a;
    const F inner = a * (1.0f + aa * (0.375f * a - 0.833333333f));
    const F outer = a * (2.0f + a * (-2.0f + a * (0.833333333f - 0.125f * a))) - 0.166666667f;
    const F half = SEL(LT(a, K(1)), inner, outer);
    return 0.5f + SEL(LT(z, K(0)), -half, half);
}

F FN(filterstep_between)(F edge, F x1, F x2, const sl_value* values, int n) {
    const sl_string filter = filter_name(values, n);
    const sl_value* width = filter_width(values, n);
    F low = FN(min_f)(x1, x2), high = FN(max_f)(x1, x2);
    if (width) {
        const F middle = (low + high) * 0.5f;
        const F half = (high - low) * 0.5f * FN(abs)(FN(number_)(width));
        low = middle - half, high = middle + half;
    }
    const I thin = LE(high, low);
    const F range = SEL(thin, K(1), high - low);
    const F u = FN(clamp_f)((high - edge) / range, K(0), K(1));
    F r = u;
    if (filter && same_text(filter, "triangle"))
        r = FN(triangle_)(u);
    else if (filter && same_text(filter, "gaussian"))
        r = FN(gaussian_)(u);
    else if (filter && same_text(filter, "catmull-rom"))
        r = FN(catmull_rom_)(u);
    return SEL(thin, FN(step)(edge, high), r);
}
