/* SPDX-License-Identifier: Apache-2.0
 * Map functions, one text per world. `_d` forms get the differences of their coordinates to the two
 * auxiliary points, which span the footprint; forms with four corners compute centre and
 * differences from the corners, an unordered quadrilateral of (u0v0) (u1v0) (u0v1) (u1v1).
 */

static F FN(run_f_)(CALL, sl_map_query* query, const sl_value* values, int n) {
    float result[SL_LANES_MAX] = {0};
    take_options(query, values, n);
    if (query->mask)
        call->services->map(call->engine, query, result);
    return FN(get_plane_)(PASS, result);
}

static V FN(run_3_)(CALL, sl_map_query* query, const sl_value* values, int n) {
    float result[3 * SL_LANES_MAX] = {0};
    query->num_channels = 3;
    take_options(query, values, n);
    if (query->mask)
        call->services->map(call->engine, query, result);
    return FN(get_triple_)(PASS, result);
}

/* Mean of four corners, and what changes along u and v. */
static F FN(centre_f_)(F a, F b, F c, F d) {
    return 0.25f * ((a + b) + (c + d));
}
static F FN(along_u_f_)(F a, F b, F c, F d) {
    return 0.5f * ((b - a) + (d - c));
}
static F FN(along_v_f_)(F a, F b, F c, F d) {
    return 0.5f * ((c - a) + (d - b));
}
static V FN(centre_3_)(V a, V b, V c, V d) {
    return FN(scale_3)(FN(add_3)(FN(add_3)(a, b), FN(add_3)(c, d)), K(0.25f));
}
static V FN(along_u_3_)(V a, V b, V c, V d) {
    return FN(scale_3)(FN(add_3)(FN(sub_3)(b, a), FN(sub_3)(d, c)), K(0.5f));
}
static V FN(along_v_3_)(V a, V b, V c, V d) {
    return FN(scale_3)(FN(add_3)(FN(sub_3)(c, a), FN(sub_3)(d, b)), K(0.5f));
}

/* --- texture */

static void FN(texture_query_)(CALL, sl_map_query* query, int kind, sl_string name, float channel,
                               F s, F t, F s_u, F t_u, F s_v, F t_v) {
    begin_query(call, query, kind, name, FN(asked_)(PASS));
    query->channel = channel_of(channel);
    FN(put_plane_)(query->at, s);
    FN(put_plane_)(query->at + SL_LANES, t);
    FN(put_plane_)(query->du, s_u);
    FN(put_plane_)(query->du + SL_LANES, t_u);
    FN(put_plane_)(query->dv, s_v);
    FN(put_plane_)(query->dv + SL_LANES, t_v);
}

F FN(texture_f_d)(CALL, sl_string name, float channel, F s, F t, F s_u, F t_u, F s_v, F t_v,
                  const sl_value* values, int n) {
    if (!is_named(name))
        return K(0);
    sl_map_query query;
    FN(texture_query_)(PASS, &query, SL_MAP_texture, name, channel, s, t, s_u, t_u, s_v, t_v);
    return FN(run_f_)(PASS, &query, values, n);
}
V FN(texture_c_d)(CALL, sl_string name, float channel, F s, F t, F s_u, F t_u, F s_v, F t_v,
                  const sl_value* values, int n) {
    if (!is_named(name))
        return FN(f_to_3)(K(1));
    sl_map_query query;
    FN(texture_query_)(PASS, &query, SL_MAP_texture, name, channel, s, t, s_u, t_u, s_v, t_v);
    return FN(run_3_)(PASS, &query, values, n);
}
F FN(texture_f_st)(CALL, sl_string name, float channel, F s, F t, const sl_value* values, int n) {
    return FN(texture_f_d)(PASS, name, channel, s, t, K(0), K(0), K(0), K(0), values, n);
}
V FN(texture_c_st)(CALL, sl_string name, float channel, F s, F t, const sl_value* values, int n) {
    return FN(texture_c_d)(PASS, name, channel, s, t, K(0), K(0), K(0), K(0), values, n);
}
F FN(texture_f)(CALL, sl_string name, float channel, const sl_value* values, int n) {
    if (!is_named(name))
        return K(0);
    return FN(texture_f_st)(PASS, name, channel, FN(global_f_)(PASS, SL_VAR_s),
                            FN(global_f_)(PASS, SL_VAR_t), values, n);
}
V FN(texture_c)(CALL, sl_string name, float channel, const sl_value* values, int n) {
    if (!is_named(name))
        return FN(f_to_3)(K(1));
    return FN(texture_c_st)(PASS, name, channel, FN(global_f_)(PASS, SL_VAR_s),
                            FN(global_f_)(PASS, SL_VAR_t), values, n);
}
F FN(texture_f_quad)(CALL, sl_string name, float channel, F s1, F t1, F s2, F t2, F s3, F t3, F s4,
                     F t4, const sl_value* values, int n) {
    return FN(texture_f_d)(PASS, name, channel, FN(centre_f_)(s1, s2, s3, s4),
                           FN(centre_f_)(t1, t2, t3, t4), FN(along_u_f_)(s1, s2, s3, s4),
                           FN(along_u_f_)(t1, t2, t3, t4), FN(along_v_f_)(s1, s2, s3, s4),
                           FN(along_v_f_)(t1, t2, t3, t4), values, n);
}
V FN(texture_c_quad)(CALL, sl_string name, float channel, F s1, F t1, F s2, F t2, F s3, F t3, F s4,
                     F t4, const sl_value* values, int n) {
    return FN(texture_c_d)(PASS, name, channel, FN(centre_f_)(s1, s2, s3, s4),
                           FN(centre_f_)(t1, t2, t3, t4), FN(along_u_f_)(s1, s2, s3, s4),
                           FN(along_u_f_)(t1, t2, t3, t4), FN(along_v_f_)(s1, s2, s3, s4),
                           FN(along_v_f_)(t1, t2, t3, t4), values, n);
}

/* --- environment and shadow */

static void FN(triple_query_)(CALL, sl_map_query* query, int kind, sl_string name, float channel,
                              V a, V a_u, V a_v) {
    begin_query(call, query, kind, name, FN(asked_)(PASS));
    query->channel = channel_of(channel);
    FN(put_triple_)(query->at, a);
    FN(put_triple_)(query->du, a_u);
    FN(put_triple_)(query->dv, a_v);
}

static F FN(triple_lookup_f_)(CALL, int kind, sl_string name, float channel, V a, V a_u, V a_v,
                              const sl_value* values, int n) {
    if (!is_named(name))
        return K(0);
    sl_map_query query;
    FN(triple_query_)(PASS, &query, kind, name, channel, a, a_u, a_v);
    return FN(run_f_)(PASS, &query, values, n);
}
static V FN(triple_lookup_3_)(CALL, int kind, sl_string name, float channel, V a, V a_u, V a_v,
                              const sl_value* values, int n) {
    if (!is_named(name))
        return FN(f_to_3)(K(0));
    sl_map_query query;
    FN(triple_query_)(PASS, &query, kind, name, channel, a, a_u, a_v);
    return FN(run_3_)(PASS, &query, values, n);
}

#define NO_DIFFERENCE FN(f_to_3)(K(0))

F FN(environment_f_d)(CALL, sl_string name, float channel, V r, V r_u, V r_v,
                      const sl_value* values, int n) {
    return FN(triple_lookup_f_)(PASS, SL_MAP_environment, name, channel, r, r_u, r_v, values, n);
}
V FN(environment_c_d)(CALL, sl_string name, float channel, V r, V r_u, V r_v,
                      const sl_value* values, int n) {
    return FN(triple_lookup_3_)(PASS, SL_MAP_environment, name, channel, r, r_u, r_v, values, n);
}
F FN(environment_f)(CALL, sl_string name, float channel, V r, const sl_value* values, int n) {
    return FN(environment_f_d)(PASS, name, channel, r, NO_DIFFERENCE, NO_DIFFERENCE, values, n);
}
V FN(environment_c)(CALL, sl_string name, float channel, V r, const sl_value* values, int n) {
    return FN(environment_c_d)(PASS, name, channel, r, NO_DIFFERENCE, NO_DIFFERENCE, values, n);
}
F FN(environment_f_quad)(CALL, sl_string name, float channel, V r1, V r2, V r3, V r4,
                         const sl_value* values, int n) {
    return FN(environment_f_d)(PASS, name, channel, FN(centre_3_)(r1, r2, r3, r4),
                               FN(along_u_3_)(r1, r2, r3, r4), FN(along_v_3_)(r1, r2, r3, r4),
                               values, n);
}
V FN(environment_c_quad)(CALL, sl_string name, float channel, V r1, V r2, V r3, V r4,
                         const sl_value* values, int n) {
    return FN(environment_c_d)(PASS, name, channel, FN(centre_3_)(r1, r2, r3, r4),
                               FN(along_u_3_)(r1, r2, r3, r4), FN(along_v_3_)(r1, r2, r3, r4),
                               values, n);
}

F FN(shadow_f_d)(CALL, sl_string name, float channel, V p, V p_u, V p_v, const sl_value* values,
                 int n) {
    return FN(triple_lookup_f_)(PASS, SL_MAP_shadow, name, channel, p, p_u, p_v, values, n);
}
V FN(shadow_c_d)(CALL, sl_string name, float channel, V p, V p_u, V p_v, const sl_value* values,
                 int n) {
    return FN(f_to_3)(FN(shadow_f_d)(PASS, name, channel, p, p_u, p_v, values, n));
}
F FN(shadow_f)(CALL, sl_string name, float channel, V p, const sl_value* values, int n) {
    return FN(shadow_f_d)(PASS, name, channel, p, NO_DIFFERENCE, NO_DIFFERENCE, values, n);
}
V FN(shadow_c)(CALL, sl_string name, float channel, V p, const sl_value* values, int n) {
    return FN(f_to_3)(FN(shadow_f)(PASS, name, channel, p, values, n));
}
F FN(shadow_f_quad)(CALL, sl_string name, float channel, V p1, V p2, V p3, V p4,
                    const sl_value* values, int n) {
    return FN(shadow_f_d)(PASS, name, channel, FN(centre_3_)(p1, p2, p3, p4),
                          FN(along_u_3_)(p1, p2, p3, p4), FN(along_v_3_)(p1, p2, p3, p4), values,
                          n);
}
V FN(shadow_c_quad)(CALL, sl_string name, float channel, V p1, V p2, V p3, V p4,
                    const sl_value* values, int n) {
    return FN(f_to_3)(FN(shadow_f_quad)(PASS, name, channel, p1, p2, p3, p4, values, n));
}

F FN(occlusion_map)(CALL, sl_string map, V p, V n, F a, const sl_value* values, int num) {
    (void)a;
    return FN(triple_lookup_f_)(PASS, SL_MAP_occlusion, map, 0, p, FN(normalize)(n), NO_DIFFERENCE,
                                values, num);
}
F FN(occlusion_map_2)(CALL, sl_string map, V p, V n, F a, F b, const sl_value* values, int num) {
    (void)b;
    return FN(occlusion_map)(PASS, map, p, n, a, values, num);
}
V FN(indirectdiffuse_map)(CALL, sl_string map, V n, const sl_value* values, int num) {
    return FN(triple_lookup_3_)(PASS, SL_MAP_irradiance, map, 0, FN(normalize)(n), NO_DIFFERENCE,
                                NO_DIFFERENCE, values, num);
}

/* --- bump: the normal of the surface raised by F along its unit normal [Blinn78]:
 * n + (F_s n^Pt - F_t n^Ps) / |Ps^Pt|, turned where N looks against Ps^Pt; the length is kept. */

V FN(bump_d)(CALL, sl_string name, float channel, V normal, V dPds, V dPdt, F s, F t, F s_u, F t_u,
             F s_v, F t_v, const sl_value* values, int num) {
    if (!is_named(name))
        return normal;
    float slopes[2 * SL_LANES_MAX] = {0};
    sl_map_query query;
    FN(texture_query_)(PASS, &query, SL_MAP_bump, name, channel, s, t, s_u, t_u, s_v, t_v);
    query.num_channels = 2;
    take_options(&query, values, num);
    if (query.mask)
        call->services->map(call->engine, &query, slopes);
    const F F_s = FN(get_plane_)(PASS, slopes), F_t = FN(get_plane_)(PASS, slopes + SL_LANES);
    const V n = FN(normalize)(normal), flat = FN(cross_3)(dPds, dPdt);
    const F area = FN(length)(flat);
    const I is_flat = LE(area * (FN(abs)(F_s) + FN(abs)(F_t)), K(0));
    const F side = SEL(LT(FN(dot_3)(n, flat), K(0)), K(-1), K(1));
    const F scale = side / SEL(is_flat, K(1), area);
    const V turn = FN(sub_3)(FN(scale_3)(FN(cross_3)(n, dPdt), F_s * scale),
                             FN(scale_3)(FN(cross_3)(n, dPds), F_t * scale));
    const V bent = FN(scale_3)(FN(normalize)(FN(add_3)(n, turn)), FN(length)(normal));
    return FN(select_3)(is_flat, normal, bent);
}
V FN(bump_st)(CALL, sl_string name, float channel, V n, V dPds, V dPdt, F s, F t,
              const sl_value* values, int num) {
    return FN(bump_d)(PASS, name, channel, n, dPds, dPdt, s, t, K(0), K(0), K(0), K(0), values,
                      num);
}
V FN(bump)(CALL, sl_string name, float channel, V n, V dPds, V dPdt, const sl_value* values,
           int num) {
    if (!is_named(name))
        return n;
    return FN(bump_st)(PASS, name, channel, n, dPds, dPdt, FN(global_f_)(PASS, SL_VAR_s),
                       FN(global_f_)(PASS, SL_VAR_t), values, num);
}
V FN(bump_quad)(CALL, sl_string name, float channel, V n, V dPds, V dPdt, F s1, F t1, F s2, F t2,
                F s3, F t3, F s4, F t4, const sl_value* values, int num) {
    return FN(bump_d)(PASS, name, channel, n, dPds, dPdt, FN(centre_f_)(s1, s2, s3, s4),
                      FN(centre_f_)(t1, t2, t3, t4), FN(along_u_f_)(s1, s2, s3, s4),
                      FN(along_u_f_)(t1, t2, t3, t4), FN(along_v_f_)(s1, s2, s3, s4),
                      FN(along_v_f_)(t1, t2, t3, t4), values, num);
}

/* --- what a map is, and files of samples */

F FN(textureinfo)(CALL, sl_string name, sl_string key, const sl_value* out) {
    return FN(textureinfo_)(PASS, name, key, out);
}

static void FN(bake_)(CALL, sl_string file, F s, F t, int type, const F* value) {
    point_samples p;
    if (!is_named(file))
        return;
    begin_points(call, &p, file, FN(asked_)(PASS), 2);
    FN(put_plane_)(p.at, s);
    FN(put_plane_)(p.at + SL_LANES, t);
    for (int k = 0; k < components_of(type); k++)
        FN(put_plane_)(p.values[0] + k * SL_LANES, value[k]);
    p.query.num_channels = 1;
    p.query.channel[0] = (sl_point_channel){"value", type, p.values[0]};
    if (p.query.mask)
        call->services->bake(call->engine, &p.query);
}
void FN(bake_f)(CALL, sl_string file, F s, F t, F value) {
    FN(bake_)(PASS, file, s, t, SL_TYPE_float, &value);
}
void FN(bake_3)(CALL, sl_string file, F s, F t, V value) {
    const F values[3] = {value.x, value.y, value.z};
    FN(bake_)(PASS, file, s, t, SL_TYPE_color, values);
}

static void FN(point_query_)(CALL, point_samples* points, sl_string file, V p, V n) {
    begin_points(call, points, file, FN(asked_)(PASS), 6);
    FN(put_triple_)(points->at, p);
    FN(put_triple_)(points->at + 3 * SL_LANES, n);
}
F FN(bake3d)(CALL, sl_string file, sl_string channels, V p, V n, const sl_value* values, int num) {
    (void)channels; /* the pairs name them */
    point_samples points;
    if (!is_named(file))
        return K(0);
    FN(point_query_)(PASS, &points, file, p, n);
    return FN(succeeded_)(PASS, points.query.mask ? bake_points(call, &points, values, num) : 0);
}
F FN(texture3d)(CALL, sl_string file, V p, V n, const sl_value* values, int num,
                const sl_value* outputs, int num_outputs) {
    point_samples points;
    if (!is_named(file))
        return K(0);
    FN(point_query_)(PASS, &points, file, p, n);
    take_point_options(&points, values, num);
    return FN(succeeded_)(PASS,
                          points.query.mask ? read_points(call, &points, outputs, num_outputs) : 0);
}
#undef NO_DIFFERENCE
