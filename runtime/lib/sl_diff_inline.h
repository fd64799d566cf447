/* SPDX-License-Identifier: Apache-2.0
 * Differences of the small built-in functions, one text per world: <body>_d(a..., d...) is
 * f(a + d) - f(a) for the real numbers a and d, not for the rounded sum. Tiny steps lose nothing to
 * cancellation; large ones across edges and limits give the true jump. Finite arguments give finite
 * results: what overflows is limited to the largest float, what is undefined counts as 0
 * (docs/design/runtime-diff.md). No include guard on purpose.
 */

/* --- limits
 * -------------------------------------------------------------------------------------------------------
 */

/* Within the floats; NaN: 0. */
SL_INLINE F FN(finite_)(F x) {
    const F most = FN(spread_f)(3.40282347e38f);
    const F limited = FN(lesser_f)(FN(greater_f)(x, -most), most);
    return FN(f_of_bits)(FN(bits_of_f)(limited) & FN(eq_f)(x, x));
}
SL_INLINE V FN(finite_3_)(V a) {
    return FN(make_3)(FN(finite_)(a.x), FN(finite_)(a.y), FN(finite_)(a.z));
}
/* a + d within the floats. */
SL_INLINE F FN(moved_)(F a, F d) {
    const F most = FN(spread_f)(3.40282347e38f);
    return FN(lesser_f)(FN(greater_f)(a + d, -most), most);
}

/* --- pieces and steps
 * ---------------------------------------------------------------------------------------------
 */

SL_INLINE F FN(abs_d)(F a, F d) {
    const F zero = FN(spread_f)(0);
    const I before = FN(lt_f)(a, zero), after = FN(lt_f)(a + d, zero);
    const F r = FN(select_f)(before ^ after, 2.0f * a + d, d);
    return FN(finite_)(FN(select_f)(after, -r, r));
}
SL_INLINE F FN(sign_d)(F a, F d) {
    return FN(sign)(a + d) - FN(sign)(a);
}

/* a + d = whole + sum + lost without any rounding: |sum| is small where d is, and a's own floor is
 * whole + own. (a - floor a rounds where a lies in (-1/2, 0).) */
typedef struct FN(parted_) {
    F place, sum, lost, own;
} FN(parted_);

SL_INLINE FN(parted_) FN(part_)(F a, F d) {
    const F zero = FN(spread_f)(0);
    const F below = FN(floor)(a);
    const I small = FN(lt_f)(FN(spread_f)(-0.5f), a) & FN(lt_f)(a, zero);
    FN(parted_) r;
    r.place = FN(select_f)(small, a, a - below);
    r.own = FN(select_f)(small, FN(spread_f)(-1), zero);
    r.sum = r.place + d;
    const F part = r.sum - r.place;
    r.lost = (r.place - (r.sum - part)) + (d - part);
    return r;
}
SL_INLINE F FN(floor_d)(F a, F d) {
    const FN(parted_) p = FN(part_)(a, d);
    const F zero = FN(spread_f)(0), one = FN(spread_f)(1);
    const F below = FN(floor)(p.sum);
    const I short_of = FN(eq_f)(below, p.sum) & FN(lt_f)(p.lost, zero);
    return FN(select_f)(short_of, below - one, below) - p.own;
}
SL_INLINE F FN(ceil_d)(F a, F d) {
    return -FN(floor_d)(-a, -d);
}
SL_INLINE F FN(round_d)(F a, F d) {
    const FN(parted_) p = FN(part_)(a, d);
    const F zero = FN(spread_f)(0), one = FN(spread_f)(1), half = FN(spread_f)(0.5f);
    const F below = FN(floor)(p.sum), rest = p.sum - below;
    const I up = FN(lt_f)(half, rest) | (FN(eq_f)(rest, half) & FN(le_f)(zero, p.lost));
    const F before = FN(select_f)(FN(lt_f)(p.place, half), zero, one);
    return FN(select_f)(up, below + one, below) - before;
}
SL_INLINE F FN(step_d)(F edge, F x, F d_edge, F dx) {
    const F zero = FN(spread_f)(0), gap = x - edge;
    return FN(step)(zero, gap + (dx - d_edge)) - FN(step)(zero, gap);
}

/* The chosen value moves from `from` to `to` + d. */
SL_INLINE F FN(min_f_d)(F a, F b, F da, F db) {
    const I before = FN(lt_f)(b, a), after = FN(lt_f)((b - a) + (db - da), FN(spread_f)(0));
    const F jump = FN(select_f)(after, b, a) - FN(select_f)(before, b, a);
    return FN(finite_)(jump + FN(select_f)(after, db, da));
}
SL_INLINE F FN(max_f_d)(F a, F b, F da, F db) {
    return -FN(min_f_d)(-a, -b, -da, -db);
}
SL_INLINE F FN(clamp_f_d)(F x, F lo, F hi, F dx, F dlo, F dhi) {
    const F zero = FN(spread_f)(0);
    const I above = FN(lt_f)((hi - x) + (dhi - dx), zero);
    const I below = FN(lt_f)((x - lo) + (dx - dlo), zero);
    const F to = FN(select_f)(below, lo, FN(select_f)(above, hi, x));
    const F d = FN(select_f)(below, dlo, FN(select_f)(above, dhi, dx));
    return FN(finite_)((to - FN(clamp_f)(x, lo, hi)) + d);
}
SL_INLINE F FN(mix_f_d)(F x, F y, F a, F dx, F dy, F da) {
    return FN(finite_)((dx * ((1.0f - a) - da) + dy * (a + da)) + (y - x) * da);
}
SL_INLINE V FN(min_3_d)(V a, V b, V da, V db) {
    return FN(make_3)(FN(min_f_d)(a.x, b.x, da.x, db.x), FN(min_f_d)(a.y, b.y, da.y, db.y),
                      FN(min_f_d)(a.z, b.z, da.z, db.z));
}
SL_INLINE V FN(max_3_d)(V a, V b, V da, V db) {
    return FN(make_3)(FN(max_f_d)(a.x, b.x, da.x, db.x), FN(max_f_d)(a.y, b.y, da.y, db.y),
                      FN(max_f_d)(a.z, b.z, da.z, db.z));
}
SL_INLINE V FN(clamp_3_d)(V x, V lo, V hi, V dx, V dlo, V dhi) {
    return FN(make_3)(FN(clamp_f_d)(x.x, lo.x, hi.x, dx.x, dlo.x, dhi.x),
                      FN(clamp_f_d)(x.y, lo.y, hi.y, dx.y, dlo.y, dhi.y),
                      FN(clamp_f_d)(x.z, lo.z, hi.z, dx.z, dlo.z, dhi.z));
}
SL_INLINE V FN(mix_33_d)(V x, V y, V a, V dx, V dy, V da) {
    return FN(make_3)(FN(mix_f_d)(x.x, y.x, a.x, dx.x, dy.x, da.x),
                      FN(mix_f_d)(x.y, y.y, a.y, dx.y, dy.y, da.y),
                      FN(mix_f_d)(x.z, y.z, a.z, dx.z, dy.z, da.z));
}
SL_INLINE V FN(mix_3_d)(V x, V y, F a, V dx, V dy, F da) {
    return FN(mix_33_d)(x, y, FN(f_to_3)(a), dx, dy, FN(f_to_3)(da));
}

/* The change of t^2 (3 - 2 t) from a to a + d. */
SL_INLINE F FN(cubic_change_)(F a, F b, F d) {
    return d * (3.0f * (a + b) - 2.0f * (a * a + a * b + b * b));
}
/* Seen from the nearer end of the ramp, so that its small values near either end stay exact. */
SL_INLINE F FN(smoothstep_d)(F lo, F hi, F x, F dlo, F dhi, F dx) {
    const F zero = FN(spread_f)(0), one = FN(spread_f)(1);
    const F width = hi - lo, dwidth = dhi - dlo, width1 = width + dwidth;
    const F over = x - lo, over1 = over + (dx - dlo), under = hi - x;
    const I hard = FN(le_f)(width, zero), hard1 = FN(le_f)(width1, zero);
    const F safe = FN(select_f)(hard, one, width), safe1 = FN(select_f)(hard1, one, width1);
    const I far_side = FN(lt_f)(under, over);
    const F from = FN(select_f)(far_side, under, over);
    const F move = FN(select_f)(far_side, dhi - dx, dx - dlo);
    const F a = from / safe, b = (from + move) / safe1;
    const I inside = FN(le_f)(zero, a) & FN(le_f)(a, one) & FN(le_f)(zero, b) & FN(le_f)(b, one);
    const F a01 = FN(clamp_f)(a, zero, one), b01 = FN(clamp_f)(b, zero, one);
    const F d = FN(select_f)(inside, (move - a * dwidth) / safe1, b01 - a01);
    F r = FN(cubic_change_)(a01, b01, d);
    r = FN(select_f)(far_side, -r, r);
    if (FN(any)(hard | hard1)) {
        const F ramp = FN(smoothstep)(zero, one, over / safe),
                ramp1 = FN(smoothstep)(zero, one, over1 / safe1);
        const F before = FN(select_f)(hard, FN(step)(zero, over), ramp);
        const F after = FN(select_f)(hard1, FN(step)(zero, over1), ramp1);
        r = FN(select_f)(hard | hard1, after - before, r);
    }
    return FN(finite_)(r);
}

/* --- roots and remainders
 * -----------------------------------------------------------------------------------------
 */

SL_INLINE F FN(sqrt_d)(F a, F d) {
    const F zero = FN(spread_f)(0), one = FN(spread_f)(1);
    const F b = a + d, from = FN(max_f)(a, zero), to = FN(max_f)(b, zero);
    const I inside = FN(le_f)(zero, a) & FN(le_f)(zero, b);
    const F sum = FN(root_f)(from) + FN(root_f)(to);
    const I none = FN(eq_f)(sum, zero);
    return FN(finite_)(FN(select_f)(
        none, zero, FN(select_f)(inside, d, to - from) / FN(select_f)(none, one, sum)));
}
SL_INLINE F FN(inversesqrt_d)(F a, F d) {
    const F zero = FN(spread_f)(0), one = FN(spread_f)(1);
    const F b = a + d;
    const I smooth = FN(lt_f)(zero, a) & FN(lt_f)(zero, b);
    const F p = FN(root_f)(FN(select_f)(smooth, a, one)),
            q = FN(root_f)(FN(select_f)(smooth, b, one));
    const F change = (-d / (p + q)) / p / q;
    return FN(finite_)(FN(select_f)(smooth, change, FN(inversesqrt)(b) - FN(inversesqrt)(a)));
}
/* From the place in a's own cell: whole cells are counted, not subtracted. */
SL_INLINE F FN(mod_d)(F a, F b, F da, F db) {
    const F zero = FN(spread_f)(0), one = FN(spread_f)(1);
    const F b1 = FN(moved_)(b, db), r0 = FN(finite_)(FN(mod)(a, b));
    const I none = FN(eq_f)(b, zero), none1 = FN(eq_f)(b1, zero);
    const F safe = FN(select_f)(none, one, b);
    const F cell = FN(floor)((a - r0) / safe + 0.5f);
    const F rise = da - FN(select_f)(none, zero, FN(select_f)(FN(eq_f)(db, zero), zero, db * cell));
    const F offset = FN(select_f)(none, a, zero);
    const F to = FN(floor)((r0 + offset + rise) / FN(select_f)(none1, one, b1));
    const F crossed = to - FN(floor)(r0 / safe); /* where r0 was rounded up to b: not 0 */
    const F r = FN(select_f)(FN(eq_f)(crossed, zero), rise, rise - b1 * crossed) + offset;
    const F most = FN(max_f)(FN(abs)(b), FN(abs)(b1));
    const F limited = FN(clamp_f)(FN(finite_)(r), -most, most);
    return FN(select_f)(none1, -r0, limited);
}

/* --- triples
 * ------------------------------------------------------------------------------------------------------
 */

/* (a + da).(b + db) - a.b and the same of the cross product. */
SL_INLINE F FN(dot_3_d)(V a, V b, V da, V db) {
    return FN(dot_3)(da, FN(add_3)(b, db)) + FN(dot_3)(a, db);
}
SL_INLINE V FN(cross_3_d)(V a, V b, V da, V db) {
    return FN(add_3)(FN(cross_3)(da, FN(add_3)(b, db)), FN(cross_3)(a, db));
}
SL_INLINE F FN(length_d)(V a, V d) {
    const F zero = FN(spread_f)(0), one = FN(spread_f)(1);
    const V b = FN(add_3)(a, d);
    const F sum = FN(length)(a) + FN(length)(b);
    const I none = FN(eq_f)(sum, zero);
    return FN(finite_)(FN(dot_3)(d, FN(add_3)(a, b)) / FN(select_f)(none, one, sum));
}
SL_INLINE F FN(distance_d)(V a, V b, V da, V db) {
    return FN(length_d)(FN(sub_3)(a, b), FN(sub_3)(da, db));
}
/* (d - n |change of length|) / length: what turns the direction. Steps as long as the vector are
 * subtracted. */
SL_INLINE V FN(normalize_d)(V a, V d) {
    const F zero = FN(spread_f)(0), one = FN(spread_f)(1);
    const F big = FN(max_f)(FN(abs)(a.x), FN(max_f)(FN(abs)(a.y), FN(abs)(a.z)));
    const F step = FN(max_f)(FN(abs)(d.x), FN(max_f)(FN(abs)(d.y), FN(abs)(d.z)));
    const I tiny = FN(lt_f)(big, FN(spread_f)(1e-16f)), huge = FN(lt_f)(FN(spread_f)(1e16f), big);
    const F k = FN(select_f)(tiny, FN(spread_f)(0x1p100f),
                             FN(select_f)(huge, FN(spread_f)(0x1p-100f), one));
    const I far = FN(le_f)(0.25f * big, step);
    const V from = FN(scale_3)(a, k), move = FN(scale_3)(d, k), to = FN(add_3)(from, move);
    const F from_length = FN(length)(from), to_length = FN(length)(to);
    const F safe = FN(select_f)(far, one, from_length), safe1 = FN(select_f)(far, one, to_length);
    const F growth = FN(dot_3)(move, FN(add_3)(from, to)) / (safe + safe1);
    const V turn = FN(sub_3)(move, FN(scale_3)(from, growth / safe));
    V r = FN(scale_3)(turn, one / safe1);
    if (FN(any)(far)) {
        const V after =
            FN(make_3)(FN(moved_)(a.x, d.x), FN(moved_)(a.y, d.y), FN(moved_)(a.z, d.z));
        r = FN(select_3)(far, FN(sub_3)(FN(normalize)(after), FN(normalize)(a)), r);
    }
    return FN(select_3)(FN(eq_f)(step, zero), FN(f_to_3)(zero), r);
}
SL_INLINE V FN(reflect_d)(V i, V n, V di, V dn) {
    const F along = FN(dot_3)(i, n), change = FN(dot_3_d)(i, n, di, dn);
    const V turned = FN(add_3)(FN(scale_3)(dn, along), FN(scale_3)(FN(add_3)(n, dn), change));
    return FN(finite_3_)(FN(sub_3)(di, FN(scale_3)(turned, FN(spread_f)(2))));
}
SL_INLINE V FN(faceforward_ref_d)(V n, V i, V nref, V dn, V di, V dnref) {
    const F zero = FN(spread_f)(0);
    const F facing = FN(dot_3)(i, nref), side = FN(dot_3)(n, nref);
    const F facing1 = facing + FN(dot_3_d)(i, nref, di, dnref);
    const F side1 = side + FN(dot_3_d)(n, nref, dn, dnref);
    const I before = FN(lt_f)(zero, facing) ^ FN(lt_f)(side, zero);
    const I after = FN(lt_f)(zero, facing1) ^ FN(lt_f)(side1, zero);
    const V whole = FN(add_3)(FN(add_3)(n, n), dn);
    const V r = FN(select_3)(before ^ after, whole, dn);
    return FN(finite_3_)(FN(select_3)(after, FN(neg_3)(r), r));
}
SL_INLINE F FN(comp_3_d)(V a, F i, V da, F di) {
    const F i1 = i + di;
    return FN(finite_)((FN(comp_3)(a, i1) - FN(comp_3)(a, i)) + FN(comp_3)(da, i1));
}
