/* SPDX-License-Identifier: Apache-2.0
 * Functions of places without neighbours, and of photon maps, which there are none of; one text per
 * world: each reports once per shader and returns its documented fallback
 * (reference/sl.md 4.2, 4.6).
 */

/* --- derivatives: the compiler replaces these by arithmetic on differences
 * (docs/area_operators.md); what still calls a body stands where no point has neighbours, as
 * defaults of parameters do. 0; a step stays hard; the normal is N on the side of Ng
 * ------------------------------------------ */

#define NO_DERIVATIVES(name) report(call, name "(): nothing varies here; the result is 0")

F FN(Du_f)(CALL, F a) {
    NO_DERIVATIVES("Du");
    return a * 0.0f;
}
V FN(Du_3)(CALL, V a) {
    NO_DERIVATIVES("Du");
    return FN(scale_3)(a, K(0));
}
F FN(Dv_f)(CALL, F a) {
    NO_DERIVATIVES("Dv");
    return a * 0.0f;
}
V FN(Dv_3)(CALL, V a) {
    NO_DERIVATIVES("Dv");
    return FN(scale_3)(a, K(0));
}
F FN(Deriv_f)(CALL, F a, F b) {
    (void)a, (void)b;
    NO_DERIVATIVES("Deriv");
    return K(0);
}
V FN(Deriv_3)(CALL, V a, F b) {
    (void)a, (void)b;
    NO_DERIVATIVES("Deriv");
    return FN(f_to_3)(K(0));
}
F FN(area)(CALL, V p) {
    (void)p;
    NO_DERIVATIVES("area");
    return K(0);
}
F FN(area_strategy)(CALL, V p, sl_string strategy) {
    (void)strategy;
    return FN(area)(PASS, p);
}
V FN(calculatenormal)(CALL, V p) {
    (void)p;
    report(call, "calculatenormal(): nothing varies here; the result is N");
    const V n = FN(normal_at_)(PASS, SL_VAR_N), ng = FN(normal_at_)(PASS, SL_VAR_Ng);
    return FN(select_3)(LT(FN(dot_3)(n, ng), K(0)), FN(neg_3)(n), n);
}
/* p_u ^ p_v / (du dv), on the side to which Ng lies from dPdu ^ dPdv (sl.md 4.2): the orientation
 * decides, not Ng itself, so that steep displacements may turn away from it. Where p does not span
 * a surface: N. */
V FN(calculatenormal_d)(CALL, V p_u, V p_v) {
    const V n = FN(normal_at_)(PASS, SL_VAR_N), ng = FN(normal_at_)(PASS, SL_VAR_Ng);
    const V across =
        FN(cross_3)(FN(normal_at_)(PASS, SL_VAR_dPdu), FN(normal_at_)(PASS, SL_VAR_dPdv));
    const F steps = FN(step_at_)(PASS, SL_VAR_du) * FN(step_at_)(PASS, SL_VAR_dv);
    const F scale = SEL(EQ(steps, K(0)), K(0), K(1) / SEL(EQ(steps, K(0)), K(1), steps));
    const V normal = FN(scale_3)(FN(cross_3)(p_u, p_v), scale);
    const F side = FN(dot_3)(across, ng);
    const F turned = SEL(EQ(side, K(0)), FN(dot_3)(normal, ng), side);
    const V oriented = FN(select_3)(LT(turned, K(0)), FN(neg_3)(normal), normal);
    const F length2 = FN(dot_3)(oriented, oriented);
    return FN(select_3)(LT(K(0), length2) & LT(length2, K(3e38f)), oriented, n);
}
F FN(filterstep)(CALL, F edge, F x, const sl_value* values, int n) {
    (void)values, (void)n;
    report(call, "filterstep(): nothing varies here; the step is hard");
    return FN(step)(edge, x);
}

/* --- photon maps: there are none */

V FN(caustic)(CALL, V p, V n) {
    (void)p, (void)n;
    report(call, "caustic(): there are no photon maps; the result is black");
    return FN(f_to_3)(K(0));
}
V FN(photonmap)(CALL, sl_string map, V p, V n, const sl_value* values, int num) {
    (void)map, (void)p, (void)n, (void)values, (void)num;
    report(call, "photonmap(): there are no photon maps; the result is black");
    return FN(f_to_3)(K(0));
}
V FN(subsurface)(CALL, V p, V n, const sl_value* values, int num) {
    (void)p, (void)n, (void)values, (void)num;
    report(call, "subsurface(): there are no photon maps; the result is black");
    return FN(f_to_3)(K(0));
}
