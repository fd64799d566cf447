/* SPDX-License-Identifier: Apache-2.0
 * Differences of transforms and the larger geometric functions, one text per world; included by
 * geometry.c after geometry_body.h. Changes are carried through the formulas by the rule of
 * products, (a + da)(b + db) - a b = da (b + db) + a db. What holds for all: sl_diff_inline.h.
 */

SL_INLINE F FN(product_change_)(F a, F b, F da, F db) {
    return da * (b + db) + a * db;
}

/* --- matrices
 * -----------------------------------------------------------------------------------------------------
 */

SL_INLINE I FN(is_zero_m_)(const M* m) {
    I r = EQ(m->m[0], K(0));
    for (int i = 1; i < 16; i++)
        r = r & EQ(m->m[i], K(0));
    return r;
}

/* The determinant is linear in each row: rows change one after the other. */
F FN(determinant_d)(M m, M dm) {
    F sum = K(0);
    for (int row = 0; row < 4; row++) {
        M one = m;
        for (int j = 4 * row; j < 4 * row + 4; j++) {
            one.m[j] = dm.m[j];
            m.m[j] = m.m[j] + dm.m[j];
        }
        sum = sum + FN(determinant)(one);
    }
    return FN(finite_)(sum);
}

F FN(comp_m_d)(M m, F row, F col, M dm, F drow, F dcol) {
    const F row1 = row + drow, col1 = col + dcol;
    const F jump = FN(comp_m)(m, row1, col1) - FN(comp_m)(m, row, col);
    return FN(finite_)(jump + FN(comp_m)(dm, row1, col1));
}

/* --- transforms: numerators and the homogeneous coordinate change linearly
 * ---------------------------------------- */

SL_INLINE F FN(column_)(const M* m, V p, int j) {
    return p.x * m->m[j] + p.y * m->m[4 + j] + p.z * m->m[8 + j];
}

/* What column j of a point's product with m changes by. */
SL_INLINE F FN(column_change_)(const M* m, const M* dm, V p, V dp, int j) {
    const V p1 = FN(add_3)(p, dp);
    return FN(column_)(m, dp, j) + (FN(column_)(dm, p1, j) + dm->m[12 + j]);
}

/* q/w goes to (q + dq)/(w + dw); w = 0 is not divided by. */
SL_INLINE F FN(quotient_change_)(F q, F w, F dq, F dw) {
    const I none = EQ(w, K(0)), none1 = EQ(w + dw, K(0)), either = none | none1;
    const F d = SEL(none, K(1), w), d1 = SEL(none1, K(1), w + dw);
    const F near = (dq - q / d * dw) / d1;
    return FN(any)(either) ? SEL(either, (q + dq) / d1 - q / d, near) : near;
}

V FN(transform_m_d)(M m, V p, M dm, V dp) {
    F q[4], dq[4];
    for (int j = 0; j < 4; j++) {
        q[j] = FN(column_)(&m, p, j) + m.m[12 + j];
        dq[j] = FN(column_change_)(&m, &dm, p, dp, j);
    }
    return FN(finite_3_)(FN(make_3)(FN(quotient_change_)(q[0], q[3], dq[0], dq[3]),
                                    FN(quotient_change_)(q[1], q[3], dq[1], dq[3]),
                                    FN(quotient_change_)(q[2], q[3], dq[2], dq[3])));
}

V FN(vtransform_m_d)(M m, V v, M dm, V dv) {
    const V v1 = FN(add_3)(v, dv);
    return FN(finite_3_)(FN(add_3)(FN(vtransform_m)(m, dv), FN(vtransform_m)(dm, v1)));
}

/* Linear in n; what the matrix changes is subtracted, for it hardly ever does. */
V FN(ntransform_m_d)(M m, V n, M dm, V dn) {
    const I fixed = FN(is_zero_m_)(&dm);
    V r = FN(ntransform_m)(m, dn);
    if (FN(any)(~fixed)) {
        const V after = FN(ntransform_m)(FN(add_m)(m, dm), FN(add_3)(n, dn));
        r = FN(select_3)(fixed, r, FN(sub_3)(after, FN(ntransform_m)(m, n)));
    }
    return FN(finite_3_)(r);
}

V FN(transform_from_to_d)(CALL, sl_string from, sl_string to, V p, V dp) {
    return FN(transform_m_d)(FN(space_)(PASS, from, to), p, FN(f_to_m)(K(0)), dp);
}
V FN(transform_to_d)(CALL, sl_string to, V p, V dp) {
    return FN(transform_from_to_d)(PASS, NULL, to, p, dp);
}
V FN(transform_from_m_d)(CALL, sl_string from, M m, V p, M dm, V dp) {
    const V in_current = FN(transform_from_to)(PASS, from, NULL, p);
    return FN(transform_m_d)(m, in_current, dm, FN(transform_from_to_d)(PASS, from, NULL, p, dp));
}
V FN(vtransform_from_m_d)(CALL, sl_string from, M m, V v, M dm, V dv) {
    const M space = FN(space_)(PASS, from, NULL);
    return FN(vtransform_m_d)(m, FN(vtransform_m)(space, v), dm, FN(vtransform_m)(space, dv));
}
V FN(ntransform_from_m_d)(CALL, sl_string from, M m, V n, M dm, V dn) {
    const M space = FN(space_)(PASS, from, NULL);
    return FN(ntransform_m_d)(m, FN(ntransform_m)(space, n), dm, FN(ntransform_m)(space, dn));
}

F FN(depth_d)(CALL, V p, V dp) {
    (void)p;
    float near_far[2] = {0, 1};
    call->services->depth_range(call->engine, near_far);
    const float range = near_far[1] - near_far[0];
    return FN(finite_)(range != 0 ? dp.z / range : K(0));
}

/* --- points and directions
 * ---------------------------------------------------------------------------------------- */

F FN(ptlined_d)(V a, V b, V q, V da, V db, V dq) {
    const V d = FN(sub_3)(b, a), e = FN(sub_3)(q, a);
    const V dd = FN(sub_3)(db, da), de = FN(sub_3)(dq, da), d1 = FN(add_3)(d, dd);
    const F square = FN(dot_3)(d, d), square1 = FN(dot_3)(d1, d1);
    const I none = EQ(square, K(0)), none1 = EQ(square1, K(0));
    const F t = SEL(none, K(0), FN(dot_3)(e, d) / SEL(none, K(1), square));
    const F change = FN(dot_3_d)(e, d, de, dd) - t * FN(dot_3)(dd, FN(add_3)(d, d1));
    const F dt = SEL(none1, -t, change / SEL(none1, K(1), square1));
    const F at = FN(clamp_f)(t, K(0), K(1));
    const F move = FN(clamp_f_d)(t, K(0), K(1), dt, K(0), K(0));
    const V rest = FN(sub_3)(e, FN(scale_3)(d, at));
    const V along = FN(add_3)(FN(scale_3)(d1, move), FN(scale_3)(dd, at));
    return FN(length_d)(rest, FN(sub_3)(de, along));
}

/* p0 + d cos + (a x d) sin + a (a.d) (1 - cos), each term by the rule of products; a zero axis:
 * no rotation. 1 - cos as 2 sin^2 of half the angle. */
V FN(rotate_3_d)(V q, F angle, V p0, V p1, V dq, F dangle, V dp0, V dp1) {
    const V axis = FN(sub_3)(p1, p0), daxis = FN(sub_3)(dp1, dp0);
    const V a = FN(normalize)(axis), da = FN(normalize_d)(axis, daxis), a1 = FN(add_3)(a, da);
    const V d = FN(sub_3)(q, p0), dd = FN(sub_3)(dq, dp0);
    const I none = EQ(FN(dot_3)(a, a), K(0)), none1 = EQ(FN(dot_3)(a1, a1), K(0));
    const F s = SEL(none, K(0), FN(sin)(angle)), c = SEL(none, K(1), FN(cos)(angle));
    const F angle1 = FN(moved_)(angle, dangle);
    const I same = ~(none | none1);
    const F ds = SEL(same, FN(sin_d)(angle, dangle), SEL(none1, K(0), FN(sin)(angle1)) - s);
    const F dc = SEL(same, FN(cos_d)(angle, dangle), SEL(none1, K(1), FN(cos)(angle1)) - c);
    const V x = FN(cross_3)(a, d), dx = FN(cross_3_d)(a, d, da, dd);
    const F along = FN(dot_3)(a, d), dalong = FN(dot_3_d)(a, d, da, dd);
    const F k = along * (1.0f - c), dk = FN(product_change_)(along, 1.0f - c, dalong, -dc);
    V r = FN(add_3)(FN(scale_3)(dd, c + dc), FN(scale_3)(d, dc));
    r = FN(add_3)(r, FN(add_3)(FN(scale_3)(dx, s + ds), FN(scale_3)(x, ds)));
    r = FN(add_3)(r, FN(add_3)(FN(scale_3)(da, k + dk), FN(scale_3)(a, dk)));
    return FN(finite_3_)(FN(add_3)(dp0, r));
}

/* eta I - (eta c + sqrt k) N with k = 1 - eta^2 (1 - c^2); zero while k < 0. */
V FN(refract_d)(V i, V n, F eta, V di, V dn, F deta) {
    const F c = FN(dot_3)(i, n), dc = FN(dot_3_d)(i, n, di, dn);
    const F sine2 = 1.0f - c * c, dsine2 = -dc * (2.0f * c + dc);
    const F k = 1.0f - eta * eta * sine2;
    const F dk = -FN(product_change_)(eta * eta, sine2, deta * (2.0f * eta + deta), dsine2);
    const I none = LT(k, K(0)), none1 = LT(k + dk, K(0));
    const F m = eta * c + FN(sqrt)(k);
    const F dm = FN(product_change_)(eta, c, deta, dc) + FN(sqrt_d)(k, dk);
    const V t = FN(sub_3)(FN(scale_3)(i, eta), FN(scale_3)(n, m));
    const V dt = FN(sub_3)(FN(add_3)(FN(scale_3)(di, eta + deta), FN(scale_3)(i, deta)),
                           FN(add_3)(FN(scale_3)(dn, m + dm), FN(scale_3)(n, dm)));
    const V zero = FN(f_to_3)(K(0));
    const V arrives = FN(select_3)(none1, zero, FN(add_3)(t, dt));
    const V r = FN(select_3)(none, arrives, FN(select_3)(none1, FN(neg_3)(t), dt));
    const I still = FN(eq_3)(di, zero) & FN(eq_3)(dn, zero) & EQ(deta, K(0));
    return FN(select_3)(still, zero, FN(finite_3_)(r));
}

/* The reference normal is the batch's Ng at the main point for all three: facing forward is one
 * decision. */
V FN(faceforward_d)(CALL, V n, V i, V dn, V di) {
    const int has_ng = call->batch && call->batch->main->var[SL_VAR_Ng];
    const V nref = has_ng ? FN(point_var_)(PASS, SL_VAR_Ng) : n;
    return FN(faceforward_ref_d)(n, i, nref, dn, di, has_ng ? FN(f_to_3)(K(0)) : dn);
}
