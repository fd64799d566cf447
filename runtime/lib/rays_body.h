/* SPDX-License-Identifier: Apache-2.0
 * Functions that trace rays, one text per world: sl.md 4.6, 4.9. `_d` forms get the differences of
 * origin and direction at the two auxiliary points, the footprint of the ray.
 */

#define FAR K(1e30f)

static void FN(from_to_)(CALL, sl_ray_query* q, int kind, V p, V d) {
    begin_rays(call, q, kind, FN(asked_)(PASS));
    FN(put_triple_)(q->P, p);
    FN(put_triple_)(q->D, d);
}
static void FN(footprint_)(sl_ray_query* q, V p_u, V d_u, V p_v, V d_v) {
    FN(put_triple_)(q->P_u, p_u);
    FN(put_triple_)(q->D_u, d_u);
    FN(put_triple_)(q->P_v, p_v);
    FN(put_triple_)(q->D_v, d_v);
}
/* A question about single rays without a footprint. */
static void FN(ask_)(CALL, sl_ray_query* q, int kind, V p, V d) {
    const V none = FN(f_to_3)(K(0));
    FN(from_to_)(PASS, q, kind, p, d);
    FN(footprint_)(q, none, none, none, none);
}

/* --- rays that shade what they meet */

void FN(trace_c_d_ask)(CALL, sl_ray_query* q, V p, V r, V p_u, V r_u, V p_v, V r_v,
                       const sl_value* values, int n) {
    FN(from_to_)(PASS, q, SL_RAYS_trace, p, r);
    FN(footprint_)(q, p_u, r_u, p_v, r_v);
    take_pairs(q, values, n);
}
V FN(trace_c_d_answer)(CALL, const sl_ray_query* q) {
    return FN(get_triple_)(PASS, q->C);
}
V FN(trace_c_d)(CALL, V p, V r, V p_u, V r_u, V p_v, V r_v, const sl_value* values, int n) {
    sl_ray_query q;
    FN(trace_c_d_ask)(PASS, &q, p, r, p_u, r_u, p_v, r_v, values, n);
    answer_now(call, &q);
    return FN(trace_c_d_answer)(PASS, &q);
}
V FN(trace_c)(CALL, V p, V r, const sl_value* values, int n) {
    const V none = FN(f_to_3)(K(0));
    return FN(trace_c_d)(PASS, p, r, none, none, none, none, values, n);
}

void FN(fulltrace_d_ask)(CALL, sl_ray_query* q, V p, V r, V p_u, V r_u, V p_v, V r_v) {
    FN(from_to_)(PASS, q, SL_RAYS_fulltrace, p, r);
    FN(footprint_)(q, p_u, r_u, p_v, r_v);
}
/* Where the ray itself missed there is no colour and no place; where no ray of its tree did, no ray
 * that missed. */
F FN(fulltrace_d_answer)(CALL, const sl_ray_query* q, V* hitcolor, F* hitdist, V* Phit, V* Nhit,
                         V* Pmiss, V* Rmiss) {
    const V none = FN(f_to_3)(K(0));
    const I hit = FN(hit_)(PASS, q);
    const F level = FN(get_plane_)(PASS, q->level_missed);
    const I missed = LT(K(0), level);
    FN(put_masked_3)(PASS, hitcolor, FN(select_3)(hit, FN(get_triple_)(PASS, q->C), none));
    FN(put_masked_f)(PASS, hitdist, SEL(hit, FN(get_plane_)(PASS, q->distance), FAR));
    FN(put_masked_3)(PASS, Phit, FN(select_3)(hit, FN(get_triple_)(PASS, q->Phit), none));
    FN(put_masked_3)(PASS, Nhit, FN(select_3)(hit, FN(get_triple_)(PASS, q->Nhit), none));
    FN(put_masked_3)(PASS, Pmiss, FN(select_3)(missed, FN(get_triple_)(PASS, q->Pmiss), none));
    FN(put_masked_3)(PASS, Rmiss, FN(select_3)(missed, FN(get_triple_)(PASS, q->Rmiss), none));
    return level;
}
F FN(fulltrace_d)(CALL, V p, V r, V p_u, V r_u, V p_v, V r_v, V* hitcolor, F* hitdist, V* Phit,
                  V* Nhit, V* Pmiss, V* Rmiss) {
    sl_ray_query q;
    FN(fulltrace_d_ask)(PASS, &q, p, r, p_u, r_u, p_v, r_v);
    answer_now(call, &q);
    return FN(fulltrace_d_answer)(PASS, &q, hitcolor, hitdist, Phit, Nhit, Pmiss, Rmiss);
}
F FN(fulltrace)(CALL, V p, V r, V* hitcolor, F* hitdist, V* Phit, V* Nhit, V* Pmiss, V* Rmiss) {
    const V none = FN(f_to_3)(K(0));
    return FN(fulltrace_d)(PASS, p, r, none, none, none, none, hitcolor, hitdist, Phit, Nhit, Pmiss,
                           Rmiss);
}

void FN(gather_ray_d_ask)(CALL, sl_ray_query* q, sl_string category, V p, V d, V p_u, V d_u, V p_v,
                          V d_v, F angle, F sample, F samples, const sl_value* values, int n,
                          const sl_value* outputs, int num_outputs) {
    FN(from_to_)(PASS, q, SL_RAYS_gather, p, d);
    FN(footprint_)(q, p_u, d_u, p_v, d_v);
    q->category = category;
    take_pairs(q, values, n);
    FN(gathers_)(PASS, q, angle, sample, samples);
    ask_outputs(q, outputs, num_outputs);
}
F FN(gather_ray_d_answer)(CALL, const sl_ray_query* q, const sl_value* outputs, int num_outputs) {
    FN(take_outputs_)(PASS, q, outputs, num_outputs);
    return SEL(FN(hit_)(PASS, q), K(1), K(0));
}
F FN(gather_ray_d)(CALL, sl_string category, V p, V d, V p_u, V d_u, V p_v, V d_v, F angle,
                   F sample, F samples, const sl_value* values, int n, const sl_value* outputs,
                   int num_outputs) {
    sl_ray_query q;
    FN(gather_ray_d_ask)
    (PASS, &q, category, p, d, p_u, d_u, p_v, d_v, angle, sample, samples, values, n, outputs,
     num_outputs);
    answer_now(call, &q);
    return FN(gather_ray_d_answer)(PASS, &q, outputs, num_outputs);
}
F FN(gather_ray)(CALL, sl_string category, V p, V d, F angle, F sample, F samples,
                 const sl_value* values, int n, const sl_value* outputs, int num_outputs) {
    const V none = FN(f_to_3)(K(0));
    return FN(gather_ray_d)(PASS, category, p, d, none, none, none, none, angle, sample, samples,
                            values, n, outputs, num_outputs);
}

/* --- rays that only meet things: answered at once */

F FN(trace_f)(CALL, V p, V r, const sl_value* values, int n) {
    sl_ray_query q;
    FN(ask_)(PASS, &q, SL_RAYS_hittest, p, r);
    take_pairs(&q, values, n);
    answer_now(call, &q);
    return SEL(FN(hit_)(PASS, &q), FN(get_plane_)(PASS, q.distance), FAR);
}
F FN(rayhittest)(CALL, V p, V r, V* Ph, V* Nh) {
    sl_ray_query q;
    FN(ask_)(PASS, &q, SL_RAYS_hittest, p, r);
    answer_now(call, &q);
    const I hit = FN(hit_)(PASS, &q);
    const V far = FN(add_3)(p, FN(scale_3)(r, FAR));
    FN(put_masked_3)(PASS, Ph, FN(select_3)(hit, FN(get_triple_)(PASS, q.Phit), far));
    FN(put_masked_3)
    (PASS, Nh, FN(select_3)(hit, FN(get_triple_)(PASS, q.Nhit), FN(f_to_3)(K(0))));
    return SEL(hit, FN(get_plane_)(PASS, q.distance), FAR);
}
V FN(transmission)(CALL, V a, V b, const sl_value* values, int n) {
    sl_ray_query q;
    FN(ask_)(PASS, &q, SL_RAYS_transmission, a, b);
    take_pairs(&q, values, n);
    answer_now(call, &q);
    return FN(get_triple_)(PASS, q.C);
}
V FN(visibility)(CALL, V a, V b) {
    return FN(transmission)(PASS, a, b, 0, 0);
}

/* shadow("raytrace", P): what is missing of the light. */
V FN(shadow_rays_c)(CALL, V p, V to_light, const sl_value* values, int n) {
    sl_ray_query q;
    FN(ask_)(PASS, &q, SL_RAYS_shadow, p, to_light);
    take_pairs(&q, values, n);
    answer_now(call, &q);
    return FN(sub_3)(FN(f_to_3)(K(1)), FN(get_triple_)(PASS, q.C));
}
F FN(shadow_rays_f)(CALL, V p, V to_light, const sl_value* values, int n) {
    const V c = FN(shadow_rays_c)(PASS, p, to_light, values, n);
    return (c.x + c.y + c.z) * (1.0f / 3.0f);
}
F FN(shadow_no_light)(CALL) {
    report_no_light(call);
    return K(0);
}

/* --- cones about a normal: answered at once */

static void FN(cone_)(CALL, sl_ray_query* q, int kind, V p, V n, F samples, const sl_value* values,
                      int num, const sl_value* outputs, int num_outputs) {
    FN(ask_)(PASS, q, kind, p, n);
    FN(set_samples_)(q, samples);
    take_pairs(q, values, num);
    ask_outputs(q, outputs, num_outputs);
    answer_now(call, q);
    FN(take_outputs_)(PASS, q, outputs, num_outputs);
}
F FN(occlusion)(CALL, V p, V n, F samples, const sl_value* values, int num, const sl_value* outputs,
                int num_outputs) {
    sl_ray_query q;
    FN(cone_)
    (PASS, &q, SL_RAYS_occlusion, p, n, samples, values, num, outputs, num_outputs);
    return FN(get_plane_)(PASS, q.C);
}
V FN(indirectdiffuse)(CALL, V p, V n, F samples, const sl_value* values, int num,
                      const sl_value* outputs, int num_outputs) {
    sl_ray_query q;
    FN(cone_)
    (PASS, &q, SL_RAYS_indirect, p, n, samples, values, num, outputs, num_outputs);
    return FN(get_triple_)(PASS, q.C);
}

#undef FAR
