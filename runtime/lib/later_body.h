/* SPDX-License-Identifier: Apache-2.0
 * Functions that need what the engine does not offer yet (derivatives, rays, maps), one text per
 * world: each reports once per shader and returns its documented fallback
 * (reference/sl.md 4.2, 4.6, 4.7). Empty map names are no error.
 */

/* --- derivatives: 0; a step stays hard; the normal is N on the side of Ng
 * ------------------------------------------ */

#define NO_DERIVATIVES(name)                                                                       \
    report(call, name "(): derivatives are not computed in this version; the result is 0")

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
    report(call,
           "calculatenormal(): derivatives are not computed in this version; the result is N");
    const V n = FN(normal_at_)(PASS, SL_VAR_N), ng = FN(normal_at_)(PASS, SL_VAR_Ng);
    return FN(select_3)(LT(FN(dot_3)(n, ng), K(0)), FN(neg_3)(n), n);
}
F FN(filterstep)(CALL, F edge, F x, const sl_value* values, int n) {
    (void)values, (void)n;
    report(call, "filterstep(): derivatives are not computed in this version; the step is hard");
    return FN(step)(edge, x);
}

/* --- rays: nothing is hit
 * ----------------------------------------------------------------------------------------- */

#define NO_RAYS(name, result)                                                                      \
    report(call, name "(): shaders trace no rays in this version; " result)

V FN(trace_c)(CALL, V p, V r, const sl_value* values, int n) {
    (void)p, (void)r, (void)values, (void)n;
    NO_RAYS("trace", "the result is black");
    return FN(f_to_3)(K(0));
}
F FN(trace_f)(CALL, V p, V r, const sl_value* values, int n) {
    (void)p, (void)r, (void)values, (void)n;
    NO_RAYS("trace", "the distance is 1e30");
    return K(1e30f);
}
V FN(visibility)(CALL, V a, V b) {
    (void)a, (void)b;
    NO_RAYS("visibility", "the result is 1");
    return FN(f_to_3)(K(1));
}
V FN(transmission)(CALL, V a, V b, const sl_value* values, int n) {
    (void)a, (void)b, (void)values, (void)n;
    NO_RAYS("transmission", "the result is 1");
    return FN(f_to_3)(K(1));
}
F FN(rayhittest)(CALL, V p, V r, V* Ph, V* Nh) {
    NO_RAYS("rayhittest", "the distance is 1e30");
    FN(put_masked_3)(PASS, Ph, FN(add_3)(p, FN(scale_3)(r, K(1e30f))));
    FN(put_masked_3)(PASS, Nh, FN(f_to_3)(K(0)));
    return K(1e30f);
}
/* A ray that misses: the colour is 0, the distance very large, and this ray is the one that missed.
 */
F FN(fulltrace)(CALL, V p, V r, V* hitcolor, F* hitdist, V* Phit, V* Nhit, V* Pmiss, V* Rmiss) {
    NO_RAYS("fulltrace", "the ray misses");
    const V zero = FN(f_to_3)(K(0));
    FN(put_masked_3)(PASS, hitcolor, zero);
    FN(put_masked_f)(PASS, hitdist, K(1e30f));
    FN(put_masked_3)(PASS, Phit, zero);
    FN(put_masked_3)(PASS, Nhit, zero);
    FN(put_masked_3)(PASS, Pmiss, p);
    FN(put_masked_3)(PASS, Rmiss, r);
    return FN(raylevel)(PASS) + 1.0f;
}
F FN(occlusion)(CALL, V p, V n, F samples, const sl_value* values, int num) {
    (void)p, (void)n, (void)samples, (void)values, (void)num;
    NO_RAYS("occlusion", "the result is 0");
    return K(0);
}
V FN(indirectdiffuse)(CALL, V p, V n, F samples, const sl_value* values, int num) {
    (void)p, (void)n, (void)samples, (void)values, (void)num;
    NO_RAYS("indirectdiffuse", "the result is black");
    return FN(f_to_3)(K(0));
}

/* --- maps: a named map counts as unreadable, which gives the fill value
 * --------------------------------------------- */

#define NO_MAPS(name, file)                                                                        \
    do {                                                                                           \
        if (is_named(file))                                                                        \
            report(call,                                                                           \
                   name "(): maps are not read in this version; the result is the fill value");    \
    } while (0)

F FN(occlusion_map)(CALL, sl_string map, V p, V n, F a, const sl_value* values, int num) {
    (void)p, (void)n, (void)a;
    NO_MAPS("occlusion", map);
    return FN(fill_)(values, num);
}
F FN(occlusion_map_2)(CALL, sl_string map, V p, V n, F a, F b, const sl_value* values, int num) {
    (void)b;
    return FN(occlusion_map)(PASS, map, p, n, a, values, num);
}
V FN(indirectdiffuse_map)(CALL, sl_string map, V n, const sl_value* values, int num) {
    (void)n;
    NO_MAPS("indirectdiffuse", map);
    return FN(f_to_3)(FN(fill_)(values, num));
}

F FN(texture_f)(CALL, sl_string name, float channel, const sl_value* values, int n) {
    (void)channel;
    NO_MAPS("texture", name);
    return is_named(name) ? FN(fill_)(values, n) : K(0);
}
F FN(texture_f_st)(CALL, sl_string name, float channel, F s, F t, const sl_value* values, int n) {
    (void)s, (void)t;
    return FN(texture_f)(PASS, name, channel, values, n);
}
F FN(texture_f_quad)(CALL, sl_string name, float channel, F s1, F t1, F s2, F t2, F s3, F t3, F s4,
                     F t4, const sl_value* values, int n) {
    (void)s1, (void)t1, (void)s2, (void)t2, (void)s3, (void)t3, (void)s4, (void)t4;
    return FN(texture_f)(PASS, name, channel, values, n);
}
V FN(texture_c)(CALL, sl_string name, float channel, const sl_value* values, int n) {
    (void)channel;
    NO_MAPS("texture", name);
    return FN(f_to_3)(is_named(name) ? FN(fill_)(values, n) : K(1));
}
V FN(texture_c_st)(CALL, sl_string name, float channel, F s, F t, const sl_value* values, int n) {
    (void)s, (void)t;
    return FN(texture_c)(PASS, name, channel, values, n);
}
V FN(texture_c_quad)(CALL, sl_string name, float channel, F s1, F t1, F s2, F t2, F s3, F t3, F s4,
                     F t4, const sl_value* values, int n) {
    (void)s1, (void)t1, (void)s2, (void)t2, (void)s3, (void)t3, (void)s4, (void)t4;
    return FN(texture_c)(PASS, name, channel, values, n);
}
F FN(environment_f)(CALL, sl_string name, float channel, V r, const sl_value* values, int n) {
    (void)channel, (void)r;
    NO_MAPS("environment", name);
    return is_named(name) ? FN(fill_)(values, n) : K(0);
}
F FN(environment_f_quad)(CALL, sl_string name, float channel, V r1, V r2, V r3, V r4,
                         const sl_value* values, int n) {
    (void)r2, (void)r3, (void)r4;
    return FN(environment_f)(PASS, name, channel, r1, values, n);
}
V FN(environment_c)(CALL, sl_string name, float channel, V r, const sl_value* values, int n) {
    return FN(f_to_3)(FN(environment_f)(PASS, name, channel, r, values, n));
}
V FN(environment_c_quad)(CALL, sl_string name, float channel, V r1, V r2, V r3, V r4,
                         const sl_value* values, int n) {
    (void)r2, (void)r3, (void)r4;
    return FN(environment_c)(PASS, name, channel, r1, values, n);
}
F FN(shadow_f)(CALL, sl_string name, float channel, V p, const sl_value* values, int n) {
    (void)channel, (void)p, (void)values, (void)n;
    if (is_named(name))
        report(call, "shadow(): maps are not read in this version; nothing is in shadow");
    return K(0);
}
F FN(shadow_f_quad)(CALL, sl_string name, float channel, V p1, V p2, V p3, V p4,
                    const sl_value* values, int n) {
    (void)p2, (void)p3, (void)p4;
    return FN(shadow_f)(PASS, name, channel, p1, values, n);
}
V FN(shadow_c)(CALL, sl_string name, float channel, V p, const sl_value* values, int n) {
    return FN(f_to_3)(FN(shadow_f)(PASS, name, channel, p, values, n));
}
V FN(shadow_c_quad)(CALL, sl_string name, float channel, V p1, V p2, V p3, V p4,
                    const sl_value* values, int n) {
    (void)p2, (void)p3, (void)p4;
    return FN(shadow_c)(PASS, name, channel, p1, values, n);
}
V FN(bump)(CALL, sl_string name, float channel, V n, V dPds, V dPdt, const sl_value* values,
           int num) {
    (void)channel, (void)dPds, (void)dPdt, (void)values, (void)num;
    if (is_named(name))
        report(call, "bump(): maps are not read in this version; the normal stays");
    return n;
}
V FN(bump_st)(CALL, sl_string name, float channel, V n, V dPds, V dPdt, F s, F t,
              const sl_value* values, int num) {
    (void)s, (void)t;
    return FN(bump)(PASS, name, channel, n, dPds, dPdt, values, num);
}
V FN(bump_quad)(CALL, sl_string name, float channel, V n, V dPds, V dPdt, F s1, F t1, F s2, F t2,
                F s3, F t3, F s4, F t4, const sl_value* values, int num) {
    (void)s1, (void)t1, (void)s2, (void)t2, (void)s3, (void)t3, (void)s4, (void)t4;
    return FN(bump)(PASS, name, channel, n, dPds, dPdt, values, num);
}
F FN(textureinfo)(CALL, sl_string name, sl_string key, const sl_value* out) {
    (void)key, (void)out;
    if (is_named(name))
        report(call, "textureinfo(): maps are not read in this version; the result is 0");
    return K(0);
}
void FN(bake_f)(CALL, sl_string file, F s, F t, F value) {
    (void)file, (void)s, (void)t, (void)value;
    report(call, "bake(): nothing is written in this version");
}
void FN(bake_3)(CALL, sl_string file, F s, F t, V value) {
    (void)file, (void)s, (void)t, (void)value;
    report(call, "bake(): nothing is written in this version");
}
F FN(bake3d)(CALL, sl_string file, sl_string channels, V p, V n, const sl_value* values, int num) {
    (void)file, (void)channels, (void)p, (void)n, (void)values, (void)num;
    report(call, "bake3d(): nothing is written in this version; the result is 0");
    return K(0);
}
F FN(texture3d)(CALL, sl_string file, V p, V n, const sl_value* values, int num) {
    (void)file, (void)p, (void)n, (void)values, (void)num;
    report(call, "texture3d(): nothing is read in this version; the result is 0");
    return K(0);
}
