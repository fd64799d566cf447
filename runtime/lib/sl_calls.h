/* SPDX-License-Identifier: Apache-2.0
 * Declarations of the out-of-line built-in functions, one text for uniform values and lanes:
 * included twice by sl_shader.h with the types of sl_inline.h, CALL (the leading arguments of
 * functions that see their context) and OUT(name) (symbol name with the width, hidden). Argument
 * order is that of sl_builtins.def; then: strings are uniform; a texture's channel is a float after
 * its name; a spline basis of NULL is "not given"; outputs are pointers, an X output is a sl_value;
 * `values, n` are n typed values (name/value pairs: n is even); `outputs, n` the pairs that set
 * variables (sl_output_pairs.def).
 */

/* operators */
M FN(mul_m)(M a, M b) OUT(mul_m);
M FN(div_m)(M a, M b) OUT(div_m);    /* a * inverse(b) */
M FN(inverse_m)(M a) OUT(inverse_m); /* singular: identity */

/* mathematics */
F FN(sin)(F x) OUT(sin);
F FN(asin)(F x) OUT(asin);
F FN(cos)(F x) OUT(cos);
F FN(acos)(F x) OUT(acos);
F FN(tan)(F x) OUT(tan);
F FN(atan)(F x) OUT(atan);
F FN(atan2)(F y, F x) OUT(atan2);
F FN(pow)(F x, F y) OUT(pow);
F FN(exp)(F x) OUT(exp);
F FN(log)(F x) OUT(log);
F FN(log_base)(F x, F base) OUT(log_base);
F FN(erf)(F x) OUT(erf);
F FN(erfc)(F x) OUT(erfc);
F FN(filterstep)(CALL, F edge, F x, const sl_value* values, int n) OUT(filterstep);
F FN(filterstep_between)(F edge, F x1, F x2, const sl_value* values, int n) OUT(filterstep_between);
F FN(spline_f)(sl_string basis, F x, const F* knots, int n) OUT(spline_f);
V FN(spline_3)(sl_string basis, F x, const V* knots, int n) OUT(spline_3);
F FN(random_f)(CALL) OUT(random_f);
V FN(random_3)(CALL) OUT(random_3);

/* noise */
F FN(noise_f_1)(F x) OUT(noise_f_1);
F FN(noise_f_2)(F x, F y) OUT(noise_f_2);
F FN(noise_f_3)(V p) OUT(noise_f_3);
F FN(noise_f_4)(V p, F t) OUT(noise_f_4);
V FN(noise_3_1)(F x) OUT(noise_3_1);
V FN(noise_3_2)(F x, F y) OUT(noise_3_2);
V FN(noise_3_3)(V p) OUT(noise_3_3);
V FN(noise_3_4)(V p, F t) OUT(noise_3_4);
F FN(cellnoise_f_1)(F x) OUT(cellnoise_f_1);
F FN(cellnoise_f_2)(F x, F y) OUT(cellnoise_f_2);
F FN(cellnoise_f_3)(V p) OUT(cellnoise_f_3);
F FN(cellnoise_f_4)(V p, F t) OUT(cellnoise_f_4);
V FN(cellnoise_3_1)(F x) OUT(cellnoise_3_1);
V FN(cellnoise_3_2)(F x, F y) OUT(cellnoise_3_2);
V FN(cellnoise_3_3)(V p) OUT(cellnoise_3_3);
V FN(cellnoise_3_4)(V p, F t) OUT(cellnoise_3_4);
F FN(pnoise_f_1)(F x, F px) OUT(pnoise_f_1);
F FN(pnoise_f_2)(F x, F y, F px, F py) OUT(pnoise_f_2);
F FN(pnoise_f_3)(V p, V pp) OUT(pnoise_f_3);
F FN(pnoise_f_4)(V p, F t, V pp, F pt) OUT(pnoise_f_4);
V FN(pnoise_3_1)(F x, F px) OUT(pnoise_3_1);
V FN(pnoise_3_2)(F x, F y, F px, F py) OUT(pnoise_3_2);
V FN(pnoise_3_3)(V p, V pp) OUT(pnoise_3_3);
V FN(pnoise_3_4)(V p, F t, V pp, F pt) OUT(pnoise_3_4);

/* derivatives */
F FN(Du_f)(CALL, F a) OUT(Du_f);
V FN(Du_3)(CALL, V a) OUT(Du_3);
F FN(Dv_f)(CALL, F a) OUT(Dv_f);
V FN(Dv_3)(CALL, V a) OUT(Dv_3);
F FN(Deriv_f)(CALL, F a, F b) OUT(Deriv_f);
V FN(Deriv_3)(CALL, V a, F b) OUT(Deriv_3);
F FN(area)(CALL, V p) OUT(area);
F FN(area_strategy)(CALL, V p, sl_string strategy) OUT(area_strategy);
V FN(calculatenormal)(CALL, V p) OUT(calculatenormal);

/* geometry */
F FN(ptlined)(V a, V b, V q) OUT(ptlined);
V FN(rotate_3)(V q, F angle, V p0, V p1) OUT(rotate_3);
M FN(rotate_m)(M m, F angle, V axis) OUT(rotate_m);
V FN(refract)(V i, V n, F eta) OUT(refract);
void FN(fresnel)(V i, V n, F eta, F* Kr, F* Kt) OUT(fresnel);
void FN(fresnel_rt)(V i, V n, F eta, F* Kr, F* Kt, V* R, V* T) OUT(fresnel_rt);
V FN(faceforward)(CALL, V n, V i) OUT(faceforward);
V FN(transform_to)(CALL, sl_string to, V p) OUT(transform_to);
V FN(transform_from_to)(CALL, sl_string from, sl_string to, V p) OUT(transform_from_to);
V FN(transform_m)(M m, V p) OUT(transform_m);
V FN(transform_from_m)(CALL, sl_string from, M m, V p) OUT(transform_from_m);
V FN(vtransform_to)(CALL, sl_string to, V v) OUT(vtransform_to);
V FN(vtransform_from_to)(CALL, sl_string from, sl_string to, V v) OUT(vtransform_from_to);
V FN(vtransform_m)(M m, V v) OUT(vtransform_m);
V FN(vtransform_from_m)(CALL, sl_string from, M m, V v) OUT(vtransform_from_m);
V FN(ntransform_to)(CALL, sl_string to, V n) OUT(ntransform_to);
V FN(ntransform_from_to)(CALL, sl_string from, sl_string to, V n) OUT(ntransform_from_to);
V FN(ntransform_m)(M m, V n) OUT(ntransform_m);
V FN(ntransform_from_m)(CALL, sl_string from, M m, V n) OUT(ntransform_from_m);
M FN(mtransform_to)(CALL, sl_string to, M m) OUT(mtransform_to);
M FN(mtransform_from_to)(CALL, sl_string from, sl_string to, M m) OUT(mtransform_from_to);
F FN(depth)(CALL, V p) OUT(depth);
F FN(determinant)(M m) OUT(determinant);
M FN(translate_m)(M m, V d) OUT(translate_m);
M FN(scale_m)(M m, V s) OUT(scale_m);
F FN(comp_m)(M m, F row, F col) OUT(comp_m);
void FN(setcomp_m)(M* m, F row, F col, F x) OUT(setcomp_m);

/* colour and strings */
V FN(ctransform_to)(sl_string to, V c) OUT(ctransform_to);
V FN(ctransform_from_to)(sl_string from, sl_string to, V c) OUT(ctransform_from_to);
S FN(concat)(CALL, const sl_string* parts, int n) OUT(concat);
void FN(printf)(CALL, sl_string format, const sl_value* values, int n) OUT(printf);
S FN(format)(CALL, sl_string format, const sl_value* values, int n) OUT(format);
F FN(match)(CALL, sl_string pattern, sl_string subject) OUT(match);

/* lighting; the slu_ forms answer for the first live lane */
V FN(ambient)(CALL) OUT(ambient);
V FN(diffuse)(CALL, V n) OUT(diffuse);
V FN(diffuse_at)(CALL, V p, V n, F angle) OUT(diffuse_at);
V FN(specular)(CALL, V n, V v, F roughness) OUT(specular);
V FN(phong)(CALL, V n, V v, F size) OUT(phong);
V FN(specularbrdf)(CALL, V l, V n, V v, F roughness) OUT(specularbrdf);
V FN(trace_c)(CALL, V p, V r, const sl_value* values, int n) OUT(trace_c);
F FN(trace_f)(CALL, V p, V r, const sl_value* values, int n) OUT(trace_f);
V FN(trace_c_d)(CALL, V p, V r, V p_u, V r_u, V p_v, V r_v, const sl_value* values, int n)
    OUT(trace_c_d);
F FN(fulltrace_d)(CALL, V p, V r, V p_u, V r_u, V p_v, V r_v, V* hitcolor, F* hitdist, V* Phit,
                  V* Nhit, V* Pmiss, V* Rmiss) OUT(fulltrace_d);
/* SL_WAITS: question and answer apart */
void FN(trace_c_d_ask)(CALL, sl_ray_query* q, V p, V r, V p_u, V r_u, V p_v, V r_v,
                       const sl_value* values, int n) OUT(trace_c_d_ask);
V FN(trace_c_d_answer)(CALL, const sl_ray_query* q) OUT(trace_c_d_answer);
void FN(fulltrace_d_ask)(CALL, sl_ray_query* q, V p, V r, V p_u, V r_u, V p_v, V r_v)
    OUT(fulltrace_d_ask);
F FN(fulltrace_d_answer)(CALL, const sl_ray_query* q, V* hitcolor, F* hitdist, V* Phit, V* Nhit,
                         V* Pmiss, V* Rmiss) OUT(fulltrace_d_answer);
V FN(visibility)(CALL, V a, V b) OUT(visibility);
V FN(transmission)(CALL, V a, V b, const sl_value* values, int n) OUT(transmission);
F FN(rayhittest)(CALL, V p, V r, V* Ph, V* Nh) OUT(rayhittest);
F FN(fulltrace)(CALL, V p, V r, V* hitcolor, F* hitdist, V* Phit, V* Nhit, V* Pmiss, V* Rmiss)
    OUT(fulltrace);
F FN(gather_ray)(CALL, sl_string category, V p, V d, F angle, F sample, F samples,
                 const sl_value* values, int n, const sl_value* outputs, int num_outputs)
    OUT(gather_ray);
F FN(gather_ray_d)(CALL, sl_string category, V p, V d, V p_u, V d_u, V p_v, V d_v, F angle,
                   F sample, F samples, const sl_value* values, int n, const sl_value* outputs,
                   int num_outputs) OUT(gather_ray_d);
void FN(gather_ray_d_ask)(CALL, sl_ray_query* q, sl_string category, V p, V d, V p_u, V d_u, V p_v,
                          V d_v, F angle, F sample, F samples, const sl_value* values, int n,
                          const sl_value* outputs, int num_outputs) OUT(gather_ray_d_ask);
F FN(gather_ray_d_answer)(CALL, const sl_ray_query* q, const sl_value* outputs, int num_outputs)
    OUT(gather_ray_d_answer);
V FN(shadow_rays_c)(CALL, V p, V to_light, const sl_value* values, int n) OUT(shadow_rays_c);
F FN(shadow_rays_f)(CALL, V p, V to_light, const sl_value* values, int n) OUT(shadow_rays_f);
F FN(shadow_no_light)(CALL) OUT(shadow_no_light);
F FN(occlusion)(CALL, V p, V n, F samples, const sl_value* values, int num, const sl_value* outputs,
                int num_outputs) OUT(occlusion);
F FN(occlusion_map)(CALL, sl_string map, V p, V n, F a, const sl_value* values, int num)
    OUT(occlusion_map);
F FN(occlusion_map_2)(CALL, sl_string map, V p, V n, F a, F b, const sl_value* values, int num)
    OUT(occlusion_map_2);
V FN(indirectdiffuse)(CALL, V p, V n, F samples, const sl_value* values, int num,
                      const sl_value* outputs, int num_outputs) OUT(indirectdiffuse);
V FN(indirectdiffuse_map)(CALL, sl_string map, V n, const sl_value* values, int num)
    OUT(indirectdiffuse_map);
V FN(caustic)(CALL, V p, V n) OUT(caustic);
V FN(photonmap)(CALL, sl_string map, V p, V n, const sl_value* values, int num) OUT(photonmap);
V FN(subsurface)(CALL, V p, V n, const sl_value* values, int num) OUT(subsurface);
F FN(raylevel)(CALL) OUT(raylevel);
F FN(isshadowray)(CALL) OUT(isshadowray);
F FN(isindirectray)(CALL) OUT(isindirectray);
S FN(raylabel)(CALL) OUT(raylabel);
F FN(rayinfo)(CALL, sl_string key, const sl_value* out) OUT(rayinfo);

/* maps; _d: with the differences of the coordinates to the auxiliary points */
F FN(texture_f_d)(CALL, sl_string name, float channel, F s, F t, F s_u, F t_u, F s_v, F t_v,
                  const sl_value* values, int n) OUT(texture_f_d);
V FN(texture_c_d)(CALL, sl_string name, float channel, F s, F t, F s_u, F t_u, F s_v, F t_v,
                  const sl_value* values, int n) OUT(texture_c_d);
F FN(environment_f_d)(CALL, sl_string name, float channel, V r, V r_u, V r_v,
                      const sl_value* values, int n) OUT(environment_f_d);
V FN(environment_c_d)(CALL, sl_string name, float channel, V r, V r_u, V r_v,
                      const sl_value* values, int n) OUT(environment_c_d);
F FN(shadow_f_d)(CALL, sl_string name, float channel, V p, V p_u, V p_v, const sl_value* values,
                 int n) OUT(shadow_f_d);
V FN(shadow_c_d)(CALL, sl_string name, float channel, V p, V p_u, V p_v, const sl_value* values,
                 int n) OUT(shadow_c_d);
V FN(bump_d)(CALL, sl_string name, float channel, V n, V dPds, V dPdt, F s, F t, F s_u, F t_u,
             F s_v, F t_v, const sl_value* values, int num) OUT(bump_d);
F FN(texture_f)(CALL, sl_string name, float channel, const sl_value* values, int n) OUT(texture_f);
F FN(texture_f_st)(CALL, sl_string name, float channel, F s, F t, const sl_value* values, int n)
    OUT(texture_f_st);
F FN(texture_f_quad)(CALL, sl_string name, float channel, F s1, F t1, F s2, F t2, F s3, F t3, F s4,
                     F t4, const sl_value* values, int n) OUT(texture_f_quad);
V FN(texture_c)(CALL, sl_string name, float channel, const sl_value* values, int n) OUT(texture_c);
V FN(texture_c_st)(CALL, sl_string name, float channel, F s, F t, const sl_value* values, int n)
    OUT(texture_c_st);
V FN(texture_c_quad)(CALL, sl_string name, float channel, F s1, F t1, F s2, F t2, F s3, F t3, F s4,
                     F t4, const sl_value* values, int n) OUT(texture_c_quad);
F FN(environment_f)(CALL, sl_string name, float channel, V r, const sl_value* values, int n)
    OUT(environment_f);
F FN(environment_f_quad)(CALL, sl_string name, float channel, V r1, V r2, V r3, V r4,
                         const sl_value* values, int n) OUT(environment_f_quad);
V FN(environment_c)(CALL, sl_string name, float channel, V r, const sl_value* values, int n)
    OUT(environment_c);
V FN(environment_c_quad)(CALL, sl_string name, float channel, V r1, V r2, V r3, V r4,
                         const sl_value* values, int n) OUT(environment_c_quad);
F FN(shadow_f)(CALL, sl_string name, float channel, V p, const sl_value* values, int n)
    OUT(shadow_f);
F FN(shadow_f_quad)(CALL, sl_string name, float channel, V p1, V p2, V p3, V p4,
                    const sl_value* values, int n) OUT(shadow_f_quad);
V FN(shadow_c)(CALL, sl_string name, float channel, V p, const sl_value* values, int n)
    OUT(shadow_c);
V FN(shadow_c_quad)(CALL, sl_string name, float channel, V p1, V p2, V p3, V p4,
                    const sl_value* values, int n) OUT(shadow_c_quad);
V FN(bump)(CALL, sl_string name, float channel, V n, V dPds, V dPdt, const sl_value* values,
           int num) OUT(bump);
V FN(bump_st)(CALL, sl_string name, float channel, V n, V dPds, V dPdt, F s, F t,
              const sl_value* values, int num) OUT(bump_st);
V FN(bump_quad)(CALL, sl_string name, float channel, V n, V dPds, V dPdt, F s1, F t1, F s2, F t2,
                F s3, F t3, F s4, F t4, const sl_value* values, int num) OUT(bump_quad);
/* what area operators become: with the differences at u + du (_u) and v + dv (_v) */
V FN(calculatenormal_d)(CALL, V p_u, V p_v) OUT(calculatenormal_d);
F FN(textureinfo)(CALL, sl_string name, sl_string key, const sl_value* out) OUT(textureinfo);
void FN(bake_f)(CALL, sl_string file, F s, F t, F value) OUT(bake_f);
void FN(bake_3)(CALL, sl_string file, F s, F t, V value) OUT(bake_3);
F FN(bake3d)(CALL, sl_string file, sl_string channels, V p, V n, const sl_value* values, int num)
    OUT(bake3d);
F FN(texture3d)(CALL, sl_string file, V p, V n, const sl_value* values, int num,
                const sl_value* outputs, int num_outputs) OUT(texture3d);

/* messages and state: 1 and the output set, or 0 and the output as it was */
F FN(message_atmosphere)(CALL, sl_string name, const sl_value* out) OUT(message_atmosphere);
F FN(message_displacement)(CALL, sl_string name, const sl_value* out) OUT(message_displacement);
F FN(message_lightsource)(CALL, sl_string name, const sl_value* out) OUT(message_lightsource);
F FN(message_surface)(CALL, sl_string name, const sl_value* out) OUT(message_surface);
F FN(message_incident)(CALL, sl_string name, const sl_value* out) OUT(message_incident);
F FN(message_opposite)(CALL, sl_string name, const sl_value* out) OUT(message_opposite);
F FN(message_attribute)(CALL, sl_string name, const sl_value* out) OUT(message_attribute);
F FN(message_option)(CALL, sl_string name, const sl_value* out) OUT(message_option);
F FN(message_rendererinfo)(CALL, sl_string name, const sl_value* out) OUT(message_rendererinfo);
S FN(shadername)(CALL) OUT(shadername);
S FN(shadername_of)(CALL, sl_string type) OUT(shadername_of);

/* functions of DSOs: result and outputs, then inputs */
void FN(shadeop_0)(CALL, sl_string function, const sl_value* values, int n) OUT(shadeop_0);
void FN(shadeop_1)(CALL, sl_string function, const sl_value* a, const sl_value* values, int n)
    OUT(shadeop_1);
void FN(shadeop_2)(CALL, sl_string function, const sl_value* a, const sl_value* b,
                   const sl_value* values, int n) OUT(shadeop_2);
void FN(shadeop_3)(CALL, sl_string function, const sl_value* a, const sl_value* b,
                   const sl_value* c, const sl_value* values, int n) OUT(shadeop_3);
void FN(shadeop_4)(CALL, sl_string function, const sl_value* a, const sl_value* b,
                   const sl_value* c, const sl_value* d, const sl_value* values, int n)
    OUT(shadeop_4);
void FN(shadeop_5)(CALL, sl_string function, const sl_value* a, const sl_value* b,
                   const sl_value* c, const sl_value* d, const sl_value* e, const sl_value* values,
                   int n) OUT(shadeop_5);
void FN(shadeop_6)(CALL, sl_string function, const sl_value* a, const sl_value* b,
                   const sl_value* c, const sl_value* d, const sl_value* e, const sl_value* f,
                   const sl_value* values, int n) OUT(shadeop_6);
void FN(shadeop_7)(CALL, sl_string function, const sl_value* a, const sl_value* b,
                   const sl_value* c, const sl_value* d, const sl_value* e, const sl_value* f,
                   const sl_value* g, const sl_value* values, int n) OUT(shadeop_7);
void FN(shadeop_8)(CALL, sl_string function, const sl_value* a, const sl_value* b,
                   const sl_value* c, const sl_value* d, const sl_value* e, const sl_value* f,
                   const sl_value* g, const sl_value* h, const sl_value* values, int n)
    OUT(shadeop_8);
