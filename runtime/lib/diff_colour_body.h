/* SPDX-License-Identifier: Apache-2.0
 * Differences of colour transforms, one text per world; included by colour.c after colour_body.h.
 * Linear spaces change linearly. hsv and hsl are piecewise: within a piece the change is carried
 * through the formula, between pieces two values are subtracted; so the hue jumps by 1 where it
 * wraps. What holds for all: sl_diff_inline.h.
 */

/* q/w with a divisor that counts as 1, and the quotient as 0, where it is 0. */
SL_INLINE F FN(ratio_change_)(F q, F w, F dq, F dw) {
    const F w1 = w + dw, one = K(1), zero = K(0);
    const I none = EQ(w, zero), none1 = EQ(w1, zero);
    const F before = SEL(none, zero, q / SEL(none, one, w));
    const F near = (dq - before * dw) / SEL(none1, one, w1);
    return SEL(none1, -before, near + SEL(none, q / SEL(none1, one, w1), zero));
}

SL_INLINE V FN(moved_3_)(V a, V d) {
    return FN(make_3)(FN(moved_)(a.x, d.x), FN(moved_)(a.y, d.y), FN(moved_)(a.z, d.z));
}

/* --- from hsv and hsl: z - z y ramp(x), a polynomial while the ramp is
 * ------------------------------------------------ */

/* clamp(min(k - start, end - k)) with k = n + turns x modulo `turns`, and its change. */
SL_INLINE F FN(ramp_at_)(F k, float start, float end, float low) {
    return FN(clamp_f)(FN(min_f)(k - start, end - k), K(low), K(1));
}
SL_INLINE F FN(ramp_change_)(F k, F dk, float start, float end, float turns, float low) {
    const F k1 = k + dk, none = K(0);
    const F inner = FN(min_f_d)(k - start, end - k, dk, -dk);
    const F near = FN(clamp_f_d)(FN(min_f)(k - start, end - k), K(low), K(1), inner, none, none);
    const I wraps = LT(k1, none) | LE(K(turns), k1);
    const F jump =
        FN(ramp_at_)(FN(wrap_)(k1, turns), start, end, low) - FN(ramp_at_)(k, start, end, low);
    return SEL(wraps, jump, near);
}

SL_INLINE F FN(hsv_channel_change_)(V c, V d, float n) {
    const F k = FN(wrap_)((c.x - FN(floor)(c.x)) * 6.0f + n, 6);
    const F ramp = FN(ramp_at_)(k, 0, 4, 0);
    const F dramp = FN(ramp_change_)(k, 6.0f * d.x, 0, 4, 6, 0);
    const F depth = c.y * ramp, ddepth = d.y * (ramp + dramp) + c.y * dramp;
    return d.z * (1.0f - depth - ddepth) - c.z * ddepth;
}
SL_INLINE V FN(rgb_of_hsv_change_)(V c, V d) {
    return FN(make_3)(FN(hsv_channel_change_)(c, d, 5), FN(hsv_channel_change_)(c, d, 3),
                      FN(hsv_channel_change_)(c, d, 1));
}

SL_INLINE F FN(hsl_channel_change_)(V c, V d, float n) {
    const F k = FN(wrap_)((c.x - FN(floor)(c.x)) * 12.0f + n, 12);
    const F ramp = FN(ramp_at_)(k, 3, 9, -1);
    const F dramp = FN(ramp_change_)(k, 12.0f * d.x, 3, 9, 12, -1);
    const F room = FN(min_f)(c.z, 1.0f - c.z), droom = FN(min_f_d)(c.z, 1.0f - c.z, d.z, -d.z);
    const F depth = c.y * room, ddepth = d.y * (room + droom) + c.y * droom;
    return d.z - (ddepth * (ramp + dramp) + depth * dramp);
}
SL_INLINE V FN(rgb_of_hsl_change_)(V c, V d) {
    return FN(make_3)(FN(hsl_channel_change_)(c, d, 0), FN(hsl_channel_change_)(c, d, 8),
                      FN(hsl_channel_change_)(c, d, 4));
}

/* --- to hsv and hsl
 * ---------------------------------------------------------------------------------------------
 */

typedef struct FN(span_) {
    F most, range, dmost, drange, dleast;
} FN(span_);

SL_INLINE FN(span_) FN(span_of_)(V c, V d) {
    const F zero = K(0), yz = FN(max_f)(c.y, c.z), low = FN(min_f)(c.y, c.z);
    FN(span_) r;
    r.most = FN(max_f)(c.x, yz);
    r.dmost = FN(max_f_d)(c.x, yz, d.x, FN(max_f_d)(c.y, c.z, d.y, d.z));
    r.range = r.most - FN(min_f)(c.x, low);
    r.dleast = FN(min_f_d)(c.x, low, d.x, FN(min_f_d)(c.y, c.z, d.y, d.z));
    r.drange = FN(max_f)(r.dmost - r.dleast, zero - r.range);
    return r;
}

/* Within the third of the circle where the same component is the largest. */
SL_INLINE F FN(hue_change_)(V c, V d, FN(span_) s) {
    const V c1 = FN(add_3)(c, d);
    const F most1 = FN(largest_)(c1), range1 = most1 - FN(smallest_)(c1);
    const I red = EQ(c.x, s.most), green = ~red & EQ(c.y, s.most);
    const I red1 = EQ(c1.x, most1), green1 = ~red1 & EQ(c1.y, most1);
    const F over = SEL(red, c.y - c.z, SEL(green, c.z - c.x, c.x - c.y));
    const F dover = SEL(red, d.y - d.z, SEL(green, d.z - d.x, d.x - d.y));
    const F before = FN(hue_)(c, s.most, s.range), after = FN(hue_)(c1, most1, range1);
    const I wraps = red & (LT(over, K(0)) ^ LT(over + dover, K(0)));
    const I grey = LE(s.range, K(0)) | LE(s.range + s.drange, K(0));
    const I near = FN(eq_i)(red, red1) & FN(eq_i)(green, green1) & ~wraps & ~grey;
    const F turn = FN(ratio_change_)(over, s.range, dover, s.drange) * 0.166666667f;
    return SEL(near, turn, after - before);
}

SL_INLINE V FN(hsv_of_rgb_change_)(V c, V d) {
    const FN(span_) s = FN(span_of_)(c, d);
    return FN(make_3)(FN(hue_change_)(c, d, s),
                      FN(ratio_change_)(s.range, s.most, s.drange, s.dmost), s.dmost);
}

SL_INLINE V FN(hsl_of_rgb_change_)(V c, V d) {
    const FN(span_) s = FN(span_of_)(c, d);
    const F sum = s.most + (s.most - s.range), dsum = s.dmost + s.dleast;
    const F zero = K(0);
    const I dark = LT(sum, K(1)), dark1 = LT(sum + dsum, K(1));
    const F room = SEL(dark, sum, 2.0f - sum), droom = SEL(dark, dsum, -dsum);
    const F near = FN(ratio_change_)(s.range, room, s.drange, droom);
    const V after = FN(hsl_of_rgb_)(FN(add_3)(c, d)), before = FN(hsl_of_rgb_)(c);
    const I other = FN(ne_f)(FN(f_of_bits)(dark & 0x3f800000), FN(f_of_bits)(dark1 & 0x3f800000)) |
                    EQ(room, zero) | EQ(room + droom, zero);
    return FN(make_3)(FN(hue_change_)(c, d, s), SEL(other, after.y - before.y, near), 0.5f * dsum);
}

/* --- xyY
 * ----------------------------------------------------------------------------------------------------------
 */

SL_INLINE V FN(xyz_of_xyy_change_)(V c, V d) {
    const F none = K(0), y1 = c.y + d.y;
    const F k = SEL(EQ(c.y, none), none, c.z / SEL(EQ(c.y, none), K(1), c.y));
    const F dk = FN(ratio_change_)(c.z, c.y, d.z, d.y), rest = 1.0f - c.x - c.y;
    const F grey = SEL(EQ(c.y, none), none, c.z), grey1 = SEL(EQ(y1, none), none, c.z + d.z);
    const I both = ~(EQ(c.y, none) | EQ(y1, none));
    return FN(make_3)(d.x * (k + dk) + c.x * dk, SEL(both, d.z, grey1 - grey),
                      rest * dk - (d.x + d.y) * (k + dk));
}
SL_INLINE V FN(xyy_of_xyz_change_)(V c, V d) {
    const F sum = c.x + c.y + c.z, dsum = d.x + d.y + d.z;
    return FN(make_3)(FN(ratio_change_)(c.x, sum, d.x, dsum),
                      FN(ratio_change_)(c.y, sum, d.y, dsum), d.y);
}

/* --- from any space to any other
 * ------------------------------------------------------------------------------------ */

static V FN(to_rgb_change_)(int space, V c, V d) {
    switch (space) {
    case SPACE_HSV:
        return FN(rgb_of_hsv_change_)(c, d);
    case SPACE_HSL:
        return FN(rgb_of_hsl_change_)(c, d);
    case SPACE_XYY:
        return FN(rgb_of_xyz_)(FN(xyz_of_xyy_change_)(c, d));
    default:
        return FN(to_rgb_)(space, d);
    }
}

static V FN(from_rgb_change_)(int space, V c, V d) {
    switch (space) {
    case SPACE_HSV:
        return FN(hsv_of_rgb_change_)(c, d);
    case SPACE_HSL:
        return FN(hsl_of_rgb_change_)(c, d);
    case SPACE_XYY:
        return FN(xyy_of_xyz_change_)(FN(xyz_of_rgb_)(c), FN(xyz_of_rgb_)(d));
    default:
        return FN(from_rgb_)(space, d);
    }
}

V FN(ctransform_to_d)(sl_string to, V c, V dc) {
    return FN(finite_3_)(FN(from_rgb_change_)(colour_space(to), c, dc));
}

V FN(ctransform_from_to_d)(sl_string from, sl_string to, V c, V dc) {
    const int a = colour_space(from), b = colour_space(to);
    if (a == b)
        return dc;
    const V rgb = FN(to_rgb_)(a, c), change = FN(to_rgb_change_)(a, c, dc);
    return FN(finite_3_)(FN(from_rgb_change_)(b, rgb, change));
}
