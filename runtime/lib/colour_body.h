/* SPDX-License-Identifier: Apache-2.0
 * Colour spaces, one text per world; formulas and constants of reference/sl.md 4.4. All hues lie in
 * [0,1] and wrap. hsv and hsl are written without sextants: channel = v - v s clamp(min(k, 4-k))
 * with k = n + 6 h mod 6, equal to the case table.
 */

SL_INLINE F FN(wrap_)(F x, float period) {
    return x - FN(floor)(x * (1.0f / period)) * period;
}

SL_INLINE F FN(hsv_channel_)(V c, float n) {
    const F k = FN(wrap_)((c.x - FN(floor)(c.x)) * 6.0f + n, 6);
    const F ramp = FN(clamp_f)(FN(min_f)(k, 4.0f - k), K(0), K(1));
    return c.z - c.z * c.y * ramp;
}

SL_INLINE V FN(rgb_of_hsv_)(V c) {
    return FN(make_3)(FN(hsv_channel_)(c, 5), FN(hsv_channel_)(c, 3), FN(hsv_channel_)(c, 1));
}

SL_INLINE F FN(hsl_channel_)(V c, float n) {
    const F k = FN(wrap_)((c.x - FN(floor)(c.x)) * 12.0f + n, 12);
    const F ramp = FN(clamp_f)(FN(min_f)(k - 3.0f, 9.0f - k), K(-1), K(1));
    return c.z - c.y * FN(min_f)(c.z, 1.0f - c.z) * ramp;
}

SL_INLINE V FN(rgb_of_hsl_)(V c) {
    return FN(make_3)(FN(hsl_channel_)(c, 0), FN(hsl_channel_)(c, 8), FN(hsl_channel_)(c, 4));
}

SL_INLINE F FN(largest_)(V c) {
    return FN(max_f)(c.x, FN(max_f)(c.y, c.z));
}
SL_INLINE F FN(smallest_)(V c) {
    return FN(min_f)(c.x, FN(min_f)(c.y, c.z));
}

/* 0 for greys. */
SL_INLINE F FN(hue_)(V c, F most, F range) {
    const I grey = LE(range, K(0));
    const F d = SEL(grey, K(1), range);
    const F r = (c.y - c.z) / d, g = 2.0f + (c.z - c.x) / d, b = 4.0f + (c.x - c.y) / d;
    F h = SEL(EQ(c.x, most), r, SEL(EQ(c.y, most), g, b)) * 0.166666667f;
    h = SEL(LT(h, K(0)), h + 1.0f, h);
    return SEL(grey, K(0), h);
}

SL_INLINE V FN(hsv_of_rgb_)(V c) {
    const F most = FN(largest_)(c), range = most - FN(smallest_)(c);
    const I black = EQ(most, K(0));
    const F s = SEL(black, K(0), range / SEL(black, K(1), most));
    return FN(make_3)(FN(hue_)(c, most, range), s, most);
}

SL_INLINE V FN(hsl_of_rgb_)(V c) {
    const F most = FN(largest_)(c), least = FN(smallest_)(c);
    const F range = most - least, sum = most + least, l = sum * 0.5f;
    const F d = SEL(LT(l, K(0.5f)), sum, 2.0f - sum);
    const I none = EQ(d, K(0)) | LE(range, K(0));
    const F s = SEL(none, K(0), range / SEL(none, K(1), d));
    return FN(make_3)(FN(hue_)(c, most, range), s, l);
}

SL_INLINE V FN(linear_)(V c, const float* m) { /* rows of the result */
    return FN(make_3)(c.x * m[0] + c.y * m[1] + c.z * m[2], c.x * m[3] + c.y * m[4] + c.z * m[5],
                      c.x * m[6] + c.y * m[7] + c.z * m[8]);
}

static V FN(rgb_of_yiq_)(V c) {
    static const float m[9] = {1, .956f, .620f, 1, -.272f, -.647f, 1, -1.108f, 1.705f};
    return FN(linear_)(c, m);
}
static V FN(yiq_of_rgb_)(V c) {
    static const float m[9] = {.299f, .587f, .114f, .596f, -.275f, -.321f, .212f, -.523f, .311f};
    return FN(linear_)(c, m);
}
static V FN(rgb_of_xyz_)(V c) { /* Rec. 709 primaries, D65 */
    static const float m[9] = {3.24079f, -1.53715f, -.498535f, -.969256f, 1.875992f,
                               .041556f, .055648f,  -.204043f, 1.057311f};
    return FN(linear_)(c, m);
}
static V FN(xyz_of_rgb_)(V c) { /* inverse of the above, computed in double precision */
    static const float m[9] = {0.412400320f,  0.357533719f, 0.180399450f,
                               0.212643845f,  0.715135558f, 0.0721568450f,
                               0.0193313368f, 0.119191390f, 0.950225838f};
    return FN(linear_)(c, m);
}

SL_INLINE V FN(xyz_of_xyy_)(V c) { /* y = 0: black */
    const I none = EQ(c.y, K(0));
    const F k = SEL(none, K(0), c.z / SEL(none, K(1), c.y));
    return FN(make_3)(c.x * k, SEL(none, K(0), c.z), (1.0f - c.x - c.y) * k);
}
SL_INLINE V FN(xyy_of_xyz_)(V c) { /* black: all 0 */
    const F sum = c.x + c.y + c.z;
    const I none = EQ(sum, K(0));
    const F k = SEL(none, K(0), 1.0f / SEL(none, K(1), sum));
    return FN(make_3)(c.x * k, c.y * k, c.y);
}

static V FN(to_rgb_)(int space, V c) {
    switch (space) {
    case SPACE_HSV:
        return FN(rgb_of_hsv_)(c);
    case SPACE_HSL:
        return FN(rgb_of_hsl_)(c);
    case SPACE_YIQ:
        return FN(rgb_of_yiq_)(c);
    case SPACE_XYZ:
        return FN(rgb_of_xyz_)(c);
    case SPACE_XYY:
        return FN(rgb_of_xyz_)(FN(xyz_of_xyy_)(c));
    default:
        return c;
    }
}

static V FN(from_rgb_)(int space, V c) {
    switch (space) {
    case SPACE_HSV:
        return FN(hsv_of_rgb_)(c);
    case SPACE_HSL:
        return FN(hsl_of_rgb_)(c);
    case SPACE_YIQ:
        return FN(yiq_of_rgb_)(c);
    case SPACE_XYZ:
        return FN(xyz_of_rgb_)(c);
    case SPACE_XYY:
        return FN(xyy_of_xyz_)(FN(xyz_of_rgb_)(c));
    default:
        return c;
    }
}

V FN(ctransform_to)(sl_string to, V c) {
    return FN(from_rgb_)(colour_space(to), c);
}

V FN(ctransform_from_to)(sl_string from, sl_string to, V c) {
    const int a = colour_space(from), b = colour_space(to);
    return a == b ? c : FN(from_rgb_)(b, FN(to_rgb_)(a, c));
}
