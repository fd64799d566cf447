/* SPDX-License-Identifier: Apache-2.0
 * Matrices (rows, p' = p M), transforms and the larger geometric functions, one text per world;
 * reference/sl.md 4.3.
 */

/* --- matrices
 * -----------------------------------------------------------------------------------------------------
 */

M FN(mul_m)(M a, M b) {
    M r;
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++)
            r.m[4 * i + j] = a.m[4 * i] * b.m[j] + a.m[4 * i + 1] * b.m[4 + j] +
                             a.m[4 * i + 2] * b.m[8 + j] + a.m[4 * i + 3] * b.m[12 + j];
    return r;
}

/* 2x2 minors of the upper (s) and lower (c) two rows: determinant and inverse by Laplace expansion.
 */
typedef struct FN(minors_) {
    F s[6], c[6];
} FN(minors_);

static FN(minors_) FN(find_minors_)(const M* a) {
    static const int col[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
    FN(minors_) r;
    for (int k = 0; k < 6; k++) {
        const int i = col[k][0], j = col[k][1];
        r.s[k] = a->m[i] * a->m[4 + j] - a->m[j] * a->m[4 + i];
        r.c[k] = a->m[8 + i] * a->m[12 + j] - a->m[8 + j] * a->m[12 + i];
    }
    return r;
}

SL_INLINE F FN(minors_determinant_)(const FN(minors_) * k) {
    return k->s[0] * k->c[5] - k->s[1] * k->c[4] + k->s[2] * k->c[3] + k->s[3] * k->c[2] -
           k->s[4] * k->c[1] + k->s[5] * k->c[0];
}

F FN(determinant)(M a) {
    const FN(minors_) k = FN(find_minors_)(&a);
    return FN(minors_determinant_)(&k);
}

M FN(inverse_m)(M a) {
    const FN(minors_) k = FN(find_minors_)(&a);
    const F *m = a.m, *s = k.s, *c = k.c;
    const F det = FN(minors_determinant_)(&k);
    const I singular = EQ(det, K(0)) | ~EQ(det, det);
    const F d = 1.0f / SEL(singular, K(1), det);
    M r;
    r.m[0] = (m[5] * c[5] - m[6] * c[4] + m[7] * c[3]) * d;
    r.m[1] = (m[2] * c[4] - m[1] * c[5] - m[3] * c[3]) * d;
    r.m[2] = (m[13] * s[5] - m[14] * s[4] + m[15] * s[3]) * d;
    r.m[3] = (m[10] * s[4] - m[9] * s[5] - m[11] * s[3]) * d;
    r.m[4] = (m[6] * c[2] - m[4] * c[5] - m[7] * c[1]) * d;
    r.m[5] = (m[0] * c[5] - m[2] * c[2] + m[3] * c[1]) * d;
    r.m[6] = (m[14] * s[2] - m[12] * s[5] - m[15] * s[1]) * d;
    r.m[7] = (m[8] * s[5] - m[10] * s[2] + m[11] * s[1]) * d;
    r.m[8] = (m[4] * c[4] - m[5] * c[2] + m[7] * c[0]) * d;
    r.m[9] = (m[1] * c[2] - m[0] * c[4] - m[3] * c[0]) * d;
    r.m[10] = (m[12] * s[4] - m[13] * s[2] + m[15] * s[0]) * d;
    r.m[11] = (m[9] * s[2] - m[8] * s[4] - m[11] * s[0]) * d;
    r.m[12] = (m[5] * c[1] - m[4] * c[3] - m[6] * c[0]) * d;
    r.m[13] = (m[0] * c[3] - m[1] * c[1] + m[2] * c[0]) * d;
    r.m[14] = (m[13] * s[1] - m[12] * s[3] - m[14] * s[0]) * d;
    r.m[15] = (m[8] * s[3] - m[9] * s[1] + m[10] * s[0]) * d;
    return FN(select_m)(singular, FN(f_to_m)(K(1)), r);
}

M FN(div_m)(M a, M b) {
    return FN(mul_m)(a, FN(inverse_m)(b));
}

M FN(translate_m)(M m, V d) {
    M t = FN(f_to_m)(K(1));
    t.m[12] = d.x, t.m[13] = d.y, t.m[14] = d.z;
    return FN(mul_m)(t, m);
}

M FN(scale_m)(M m, V s) {
    M t = FN(f_to_m)(K(1));
    t.m[0] = s.x, t.m[5] = s.y, t.m[10] = s.z;
    return FN(mul_m)(t, m);
}

/* p cos + (a x p) sin + a (a.p) (1 - cos), by rows; a zero axis: no rotation. */
M FN(rotate_m)(M m, F angle, V axis) {
    const V a = FN(normalize)(axis);
    const I none = EQ(FN(dot_3)(a, a), K(0));
    const F s = SEL(none, K(0), FN(sin)(angle)), c = SEL(none, K(1), FN(cos)(angle));
    const F k = 1.0f - c;
    M t = FN(f_to_m)(K(1));
    t.m[0] = a.x * a.x * k + c, t.m[1] = a.x * a.y * k + a.z * s, t.m[2] = a.x * a.z * k - a.y * s;
    t.m[4] = a.y * a.x * k - a.z * s, t.m[5] = a.y * a.y * k + c, t.m[6] = a.y * a.z * k + a.x * s;
    t.m[8] = a.z * a.x * k + a.y * s, t.m[9] = a.z * a.y * k - a.x * s, t.m[10] = a.z * a.z * k + c;
    return FN(mul_m)(t, m);
}

F FN(comp_m)(M m, F row, F col) {
    const I at = FN(add_i)(FN(shl_i)(FN(index)(row, 4), 2), FN(index)(col, 4));
    F r = m.m[0];
    for (int i = 1; i < 16; i++)
        r = SEL(FN(eq_i)(at, KI(i)), m.m[i], r);
    return r;
}

void FN(setcomp_m)(M* m, F row, F col, F x) {
    const I at = FN(add_i)(FN(shl_i)(FN(index)(row, 4), 2), FN(index)(col, 4));
    for (int i = 0; i < 16; i++)
        m->m[i] = SEL(FN(eq_i)(at, KI(i)), x, m->m[i]);
}

/* --- transforms
 * -----------------------------------------------------------------------------------------------------
 */

V FN(transform_m)(M m, V p) { /* w = 0: not divided */
    const V q = FN(make_3)(p.x * m.m[0] + p.y * m.m[4] + p.z * m.m[8] + m.m[12],
                           p.x * m.m[1] + p.y * m.m[5] + p.z * m.m[9] + m.m[13],
                           p.x * m.m[2] + p.y * m.m[6] + p.z * m.m[10] + m.m[14]);
    const F w = p.x * m.m[3] + p.y * m.m[7] + p.z * m.m[11] + m.m[15];
    const F d = SEL(EQ(w, K(0)), K(1), w);
    return FN(make_3)(q.x / d, q.y / d, q.z / d);
}

V FN(vtransform_m)(M m, V v) {
    return FN(make_3)(v.x * m.m[0] + v.y * m.m[4] + v.z * m.m[8],
                      v.x * m.m[1] + v.y * m.m[5] + v.z * m.m[9],
                      v.x * m.m[2] + v.y * m.m[6] + v.z * m.m[10]);
}

/* n (A^-1)^T = cofactors of A / det A; a singular A gives the cofactors alone. */
V FN(ntransform_m)(M m, V n) {
    const V a = FN(make_3)(m.m[0], m.m[1], m.m[2]), b = FN(make_3)(m.m[4], m.m[5], m.m[6]),
            c = FN(make_3)(m.m[8], m.m[9], m.m[10]);
    const V bc = FN(cross_3)(b, c), ca = FN(cross_3)(c, a), ab = FN(cross_3)(a, b);
    const F det = FN(dot_3)(a, bc);
    const F d = SEL(EQ(det, K(0)), K(1), det);
    return FN(make_3)((n.x * bc.x + n.y * ca.x + n.z * ab.x) / d,
                      (n.x * bc.y + n.y * ca.y + n.z * ab.y) / d,
                      (n.x * bc.z + n.y * ca.z + n.z * ab.z) / d);
}

V FN(transform_from_to)(CALL, sl_string from, sl_string to, V p) {
    return FN(transform_m)(FN(space_)(PASS, from, to), p);
}
V FN(transform_to)(CALL, sl_string to, V p) {
    return FN(transform_from_to)(PASS, NULL, to, p);
}
V FN(transform_from_m)(CALL, sl_string from, M m, V p) {
    return FN(transform_m)(m, FN(transform_from_to)(PASS, from, NULL, p));
}
V FN(vtransform_from_to)(CALL, sl_string from, sl_string to, V v) {
    return FN(vtransform_m)(FN(space_)(PASS, from, to), v);
}
V FN(vtransform_to)(CALL, sl_string to, V v) {
    return FN(vtransform_from_to)(PASS, NULL, to, v);
}
V FN(vtransform_from_m)(CALL, sl_string from, M m, V v) {
    return FN(vtransform_m)(m, FN(vtransform_from_to)(PASS, from, NULL, v));
}
V FN(ntransform_from_to)(CALL, sl_string from, sl_string to, V n) {
    return FN(ntransform_m)(FN(space_)(PASS, from, to), n);
}
V FN(ntransform_to)(CALL, sl_string to, V n) {
    return FN(ntransform_from_to)(PASS, NULL, to, n);
}
V FN(ntransform_from_m)(CALL, sl_string from, M m, V n) {
    return FN(ntransform_m)(m, FN(ntransform_from_to)(PASS, from, NULL, n));
}
M FN(mtransform_from_to)(CALL, sl_string from, sl_string to, M m) {
    return FN(mul_m)(m, FN(space_)(PASS, from, to));
}
M FN(mtransform_to)(CALL, sl_string to, M m) {
    return FN(mtransform_from_to)(PASS, NULL, to, m);
}

F FN(depth)(
    CALL,
    V p) { /* current is camera space, so z is the distance the clipping planes are given in */
    float near_far[2] = {0, 1};
    call->services->depth_range(call->engine, near_far);
    const float range = near_far[1] - near_far[0];
    return range != 0 ? (p.z - near_far[0]) / range : K(0);
}

/* --- points and directions
 * ---------------------------------------------------------------------------------------- */

F FN(ptlined)(V a, V b, V q) {
    const V d = FN(sub_3)(b, a), e = FN(sub_3)(q, a);
    const F dd = FN(dot_3)(d, d);
    const I none = EQ(dd, K(0));
    const F t = FN(clamp_f)(SEL(none, K(0), FN(dot_3)(e, d) / SEL(none, K(1), dd)), K(0), K(1));
    return FN(length)(FN(sub_3)(e, FN(scale_3)(d, t)));
}

V FN(rotate_3)(V q, F angle, V p0, V p1) {
    const V a = FN(normalize)(FN(sub_3)(p1, p0)), d = FN(sub_3)(q, p0);
    const I none = EQ(FN(dot_3)(a, a), K(0));
    const F s = SEL(none, K(0), FN(sin)(angle)), c = SEL(none, K(1), FN(cos)(angle));
    const V turned = FN(add_3)(FN(scale_3)(d, c), FN(scale_3)(FN(cross_3)(a, d), s));
    return FN(add_3)(p0, FN(add_3)(turned, FN(scale_3)(a, FN(dot_3)(a, d) * (1.0f - c))));
}

V FN(refract)(V i, V n, F eta) {
    const F c = FN(dot_3)(i, n);
    const F k = 1.0f - eta * eta * (1.0f - c * c);
    const I reflected = LT(k, K(0));
    const V t = FN(sub_3)(FN(scale_3)(i, eta), FN(scale_3)(n, eta * c + FN(sqrt)(k)));
    return FN(select_3)(reflected, FN(f_to_3)(K(0)), t);
}

/* Unpolarised reflectance with c = |I.N|, g^2 = 1/eta^2 - 1 + c^2 [Cook82]; Kt = 1 - Kr. At
 * c = 0 all is reflected; g = c = 0 cannot be divided and is the same limit. */
void FN(fresnel)(V i, V n, F eta, F* Kr, F* Kt) {
    const F one = K(1);
    const I none = EQ(eta, K(0));
    const F e = 1.0f / SEL(none, one, eta);
    const F c = FN(abs)(FN(dot_3)(i, n));
    const F g2 = e * e - 1.0f + c * c;
    const F g = FN(sqrt)(g2);
    const I total = LT(g2, K(0)) | EQ(c, K(0)) | none;
    const F sum = SEL(total, one, g + c), difference = SEL(total, one, g - c);
    const F a = difference / sum;
    const F b = (c * sum - 1.0f) / (c * difference + 1.0f);
    const F r = 0.5f * a * a * (1.0f + b * b);
    *Kr = SEL(total, one, FN(min_f)(r, one));
    *Kt = 1.0f - *Kr;
}

void FN(fresnel_rt)(V i, V n, F eta, F* Kr, F* Kt, V* R, V* T) {
    FN(fresnel)(i, n, eta, Kr, Kt);
    *R = FN(reflect)(i, n);
    *T = FN(refract)(i, n, eta);
}

/* The reference normal is the batch's Ng; where there is none (lights, volumes, defaults) N itself.
 */
V FN(faceforward)(CALL, V n, V i) {
    const int has_ng = call->batch && call->batch->main->var[SL_VAR_Ng];
    return FN(faceforward_ref)(n, i, has_ng ? FN(point_var_)(PASS, SL_VAR_Ng) : n);
}
