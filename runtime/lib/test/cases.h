/* SPDX-License-Identifier: Apache-2.0
 * CASE(name, body, planes in, planes out, code...): how tests call each body, one text per world.
 * In the code A(k) is input plane k, A3(k) the triple that starts there, AM(k) the matrix; R, R3,
 * RM store from plane 0, R_AT from plane k.
 */
#ifndef CASES_ONLY
#undef CASE
#define CASE(name, body, num_in, num_out, ...)                                                     \
    static void FN(case_##name)(CALL, const float* const* in, float* const* out, int i) {          \
        (void)in, (void)out, (void)i;                                                              \
        __VA_ARGS__;                                                                               \
    }
#define A(k)        FN(get_)(in[k], i)
#define A3(k)       FN(make_3)(A(k), A((k) + 1), A((k) + 2))
#define AM(k)       FN(case_matrix_)(in, k, i)
#define R(v)        FN(put_)(out[0], i, v)
#define R_AT(k, v)  FN(put_)(out[k], i, v)
#define R3(v)       FN(case_store_3_)(out, 0, i, v)
#define R3_AT(k, v) FN(case_store_3_)(out, k, i, v)
#define RM(v)       FN(case_store_m_)(out, i, v)

SL_INLINE M FN(case_matrix_)(const float* const* in, int k, int i) {
    M m;
    for (int j = 0; j < 16; j++)
        m.m[j] = A(k + j);
    return m;
}
SL_INLINE void FN(case_store_3_)(float* const* out, int k, int i, V v) {
    R_AT(k, v.x);
    R_AT(k + 1, v.y);
    R_AT(k + 2, v.z);
}
SL_INLINE void FN(case_store_m_)(float* const* out, int i, M m) {
    for (int j = 0; j < 16; j++)
        R_AT(j, m.m[j]);
}
#endif

/* Rows of a table, one a line. */
/* clang-format off */
/* one, two or three floats to a float */
#define F1(name) CASE(name, name, 1, 1, R(FN(name)(A(0))))
#define F2(name) CASE(name, name, 2, 1, R(FN(name)(A(0), A(1))))
#define F3(name) CASE(name, name, 3, 1, R(FN(name)(A(0), A(1), A(2))))
F1(radians)
F1(degrees)
F1(sin)
F1(asin)
F1(cos)
F1(acos)
F1(tan)
F1(atan)
F2(atan2)
F2(pow)
F1(exp)
F1(sqrt)
F1(inversesqrt)
F1(log)
F2(log_base)
F2(mod)
F1(abs)
F1(sign)
F1(floor)
F1(ceil)
F1(round)
F2(step)
F3(smoothstep)
F1(erf)
F1(erfc)
F2(min_f)
F2(max_f)
F3(clamp_f)
F3(mix_f)
CASE(min_3, min_3, 6, 3, R3(FN(min_3)(A3(0), A3(3))))
CASE(max_3, max_3, 6, 3, R3(FN(max_3)(A3(0), A3(3))))
CASE(clamp_3, clamp_3, 9, 3, R3(FN(clamp_3)(A3(0), A3(3), A3(6))))
CASE(mix_3, mix_3, 7, 3, R3(FN(mix_3)(A3(0), A3(3), A(6))))
CASE(mix_33, mix_33, 9, 3, R3(FN(mix_33)(A3(0), A3(3), A3(6))))

/* filterstep: edge, x1, x2 */
#define STEP_FILTER(label, text)                                                                   \
    CASE(label, filterstep_between, 3, 1, sl_string key = "filter"; sl_string value = text;        \
         sl_value pairs[2] = {{SL_TYPE_string, 0, 0, &key}, {SL_TYPE_string, 0, 0, &value}};       \
         R(FN(filterstep_between)(A(0), A(1), A(2), pairs, 2)))
CASE(filterstep_between, filterstep_between, 3, 1, R(FN(filterstep_between)(A(0), A(1), A(2), 0, 0)))
STEP_FILTER(filterstep_triangle, "triangle")
STEP_FILTER(filterstep_gaussian, "gaussian")
STEP_FILTER(filterstep_catmull, "catmull-rom")
CASE(filterstep_width, filterstep_between, 3, 1, sl_string key = "width"; float two = 2; sl_value pairs[2] = {{SL_TYPE_string, 0, 0, &key}, {SL_TYPE_float, 0, 0, &two}}; R(FN(filterstep_between)(A(0), A(1), A(2), pairs, 2)))
CASE(filterstep, filterstep, 2, 1, R(FN(filterstep)(PASS, A(0), A(1), 0, 0)))

/* spline: value, then knots */
#define SPLINE(label, basis, n)                                                                    \
    CASE(label, spline_f, 1 + n, 1, F k[n]; for (int j = 0; j < n; j++) k[j] = A(1 + j);           \
         R(FN(spline_f)(basis, A(0), k, n)))
SPLINE(spline_default, 0, 6)
SPLINE(spline_catmull, "catmull-rom", 4)
SPLINE(spline_bspline, "bspline", 6)
SPLINE(spline_b_spline, "b-spline", 4)
SPLINE(spline_bezier, "bezier", 7)
SPLINE(spline_hermite, "hermite", 6)
SPLINE(spline_linear, "linear", 6)
SPLINE(solve_default, "solve", 6)
SPLINE(solve_catmull, "solvecatmull-rom", 6)
SPLINE(solve_bspline, "solvebspline", 6)
SPLINE(solve_bezier, "solvebezier", 7)
SPLINE(solve_hermite, "solvehermite", 6)
SPLINE(solve_linear, "solvelinear", 6)
CASE(spline_3, spline_3, 16, 3, V k[5]; for (int j = 0; j < 5; j++) k[j] = A3(1 + 3 * j); R3(FN(spline_3)("bspline", A(0), k, 5)))

/* noise */ CASE(random_f, random_f, 0, 2, R(FN(random_f)(PASS)); R_AT(1, FN(random_f)(PASS)))
CASE(random_3, random_3, 0, 3, R3(FN(random_3)(PASS)))
#define NOISE(name)                                                                                \
    CASE(name##_f_1, name##_f_1, 1, 1, R(FN(name##_f_1)(A(0))))                                    \
    CASE(name##_f_2, name##_f_2, 2, 1, R(FN(name##_f_2)(A(0), A(1))))                              \
    CASE(name##_f_3, name##_f_3, 3, 1, R(FN(name##_f_3)(A3(0))))                                   \
    CASE(name##_f_4, name##_f_4, 4, 1, R(FN(name##_f_4)(A3(0), A(3))))                             \
    CASE(name##_3_1, name##_3_1, 1, 3, R3(FN(name##_3_1)(A(0))))                                   \
    CASE(name##_3_2, name##_3_2, 2, 3, R3(FN(name##_3_2)(A(0), A(1))))                             \
    CASE(name##_3_3, name##_3_3, 3, 3, R3(FN(name##_3_3)(A3(0))))                                  \
    CASE(name##_3_4, name##_3_4, 4, 3, R3(FN(name##_3_4)(A3(0), A(3))))
NOISE(noise)
NOISE(cellnoise)
CASE(pnoise_f_1, pnoise_f_1, 2, 1, R(FN(pnoise_f_1)(A(0), A(1))))
CASE(pnoise_f_2, pnoise_f_2, 4, 1, R(FN(pnoise_f_2)(A(0), A(1), A(2), A(3))))
CASE(pnoise_f_3, pnoise_f_3, 6, 1, R(FN(pnoise_f_3)(A3(0), A3(3))))
CASE(pnoise_f_4, pnoise_f_4, 8, 1, R(FN(pnoise_f_4)(A3(0), A(3), A3(4), A(7))))
CASE(pnoise_3_1, pnoise_3_1, 2, 3, R3(FN(pnoise_3_1)(A(0), A(1))))
CASE(pnoise_3_2, pnoise_3_2, 4, 3, R3(FN(pnoise_3_2)(A(0), A(1), A(2), A(3))))
CASE(pnoise_3_3, pnoise_3_3, 6, 3, R3(FN(pnoise_3_3)(A3(0), A3(3))))
CASE(pnoise_3_4, pnoise_3_4, 8, 3, R3(FN(pnoise_3_4)(A3(0), A(3), A3(4), A(7))))

/* geometry */ CASE(xcomp, xcomp, 3, 1, R(FN(xcomp)(A3(0))))
CASE(ycomp, ycomp, 3, 1, R(FN(ycomp)(A3(0))))
CASE(zcomp, zcomp, 3, 1, R(FN(zcomp)(A3(0))))
CASE(setxcomp, setxcomp, 4, 3, V v = A3(0); FN(setxcomp)(&v, A(3)); R3(v))
CASE(setycomp, setycomp, 4, 3, V v = A3(0); FN(setycomp)(&v, A(3)); R3(v))
CASE(setzcomp, setzcomp, 4, 3, V v = A3(0); FN(setzcomp)(&v, A(3)); R3(v))
CASE(length, length, 3, 1, R(FN(length)(A3(0))))
CASE(distance, distance, 6, 1, R(FN(distance)(A3(0), A3(3))))
CASE(normalize, normalize, 3, 3, R3(FN(normalize)(A3(0))))
CASE(ptlined, ptlined, 9, 1, R(FN(ptlined)(A3(0), A3(3), A3(6))))
CASE(rotate_3, rotate_3, 10, 3, R3(FN(rotate_3)(A3(0), A(3), A3(4), A3(7))))
CASE(rotate_m, rotate_m, 20, 16, RM(FN(rotate_m)(AM(0), A(16), A3(17))))
CASE(reflect, reflect, 6, 3, R3(FN(reflect)(A3(0), A3(3))))
CASE(refract, refract, 7, 3, R3(FN(refract)(A3(0), A3(3), A(6))))
CASE(fresnel, fresnel, 7, 2, F kr; F kt; FN(fresnel)(A3(0), A3(3), A(6), &kr, &kt); R(kr); R_AT(1, kt))
CASE(fresnel_rt, fresnel_rt, 7, 8, F kr; F kt; V r; V t; FN(fresnel_rt)(A3(0), A3(3), A(6), &kr, &kt, &r, &t); R(kr); R_AT(1, kt); R3_AT(2, r); R3_AT(5, t))
CASE(faceforward, faceforward, 6, 3, R3(FN(faceforward)(PASS, A3(0), A3(3))))
CASE(faceforward_ref, faceforward_ref, 9, 3, R3(FN(faceforward_ref)(A3(0), A3(3), A3(6))))
#define TRANSFORM(name)                                                                            \
    CASE(name##_to, name##_to, 3, 3, R3(FN(name##_to)(PASS, "shader", A3(0))))                     \
    CASE(name##_lanes, name##_to, 3, 3, R3(FN(name##_to)(PASS, "moving", A3(0))))                  \
    CASE(name##_from_to, name##_from_to, 3, 3,                                                     \
         R3(FN(name##_from_to)(PASS, "shader", "current", A3(0))))                                 \
    CASE(name##_m, name##_m, 19, 3, R3(FN(name##_m)(AM(0), A3(16))))                               \
    CASE(name##_from_m, name##_from_m, 19, 3, R3(FN(name##_from_m)(PASS, "shader", AM(0), A3(16))))
TRANSFORM(transform)
TRANSFORM(vtransform)
TRANSFORM(ntransform)
CASE(mtransform_to, mtransform_to, 16, 16, RM(FN(mtransform_to)(PASS, "shader", AM(0))))
CASE(mtransform_from_to, mtransform_from_to, 16, 16, RM(FN(mtransform_from_to)(PASS, "shader", "current", AM(0))))
CASE(depth, depth, 3, 1, R(FN(depth)(PASS, A3(0))))
CASE(determinant, determinant, 16, 1, R(FN(determinant)(AM(0))))
CASE(translate_m, translate_m, 19, 16, RM(FN(translate_m)(AM(0), A3(16))))
CASE(scale_m, scale_m, 19, 16, RM(FN(scale_m)(AM(0), A3(16))))
CASE(mul_m, mul_m, 32, 16, RM(FN(mul_m)(AM(0), AM(16))))
CASE(div_m, div_m, 32, 16, RM(FN(div_m)(AM(0), AM(16))))
CASE(inverse_m, inverse_m, 16, 16, RM(FN(inverse_m)(AM(0))))
CASE(comp_m, comp_m, 18, 1, R(FN(comp_m)(AM(0), A(16), A(17))))
CASE(setcomp_m, setcomp_m, 19, 16, M m = AM(0); FN(setcomp_m)(&m, A(16), A(17), A(18)); RM(m))
CASE(comp_3, comp_3, 4, 1, R(FN(comp_3)(A3(0), A(3))))
CASE(setcomp_3, setcomp_3, 5, 3, V v = A3(0); FN(setcomp_3)(&v, A(3), A(4)); R3(v))
CASE(arraylength, arraylength, 0, 1, R(FN(arraylength)(7)))

/* colour */
#define COLOUR(name)                                                                               \
    CASE(to_##name, ctransform_to, 3, 3, R3(FN(ctransform_to)(#name, A3(0))))                      \
    CASE(from_##name, ctransform_from_to, 3, 3, R3(FN(ctransform_from_to)(#name, "rgb", A3(0))))
COLOUR(hsv)
COLOUR(hsl)
COLOUR(YIQ)
COLOUR(xyz)
COLOUR(xyY)

/* lighting */ CASE(ambient, ambient, 0, 3, R3(FN(ambient)(PASS)))
CASE(diffuse, diffuse, 3, 3, R3(FN(diffuse)(PASS, A3(0))))
CASE(diffuse_at, diffuse_at, 7, 3, R3(FN(diffuse_at)(PASS, A3(0), A3(3), A(6))))
CASE(specular, specular, 7, 3, R3(FN(specular)(PASS, A3(0), A3(3), A(6))))
CASE(phong, phong, 7, 3, R3(FN(phong)(PASS, A3(0), A3(3), A(6))))
CASE(specularbrdf, specularbrdf, 10, 3, R3(FN(specularbrdf)(PASS, A3(0), A3(3), A3(6), A(9))))

/* state */ CASE(raylevel, raylevel, 0, 1, R(FN(raylevel)(PASS)))
CASE(isshadowray, isshadowray, 0, 1, R(FN(isshadowray)(PASS)))
CASE(isindirectray, isindirectray, 0, 1, R(FN(isindirectray)(PASS)))

/* rows of later versions; matrices of arguments are short here: the values are not read */ CASE(Du_f, Du_f, 1, 1, R(FN(Du_f)(PASS, A(0))))
CASE(Du_3, Du_3, 3, 3, R3(FN(Du_3)(PASS, A3(0))))
CASE(Dv_f, Dv_f, 1, 1, R(FN(Dv_f)(PASS, A(0))))
CASE(Dv_3, Dv_3, 3, 3, R3(FN(Dv_3)(PASS, A3(0))))
CASE(Deriv_f, Deriv_f, 2, 1, R(FN(Deriv_f)(PASS, A(0), A(1))))
CASE(Deriv_3, Deriv_3, 4, 3, R3(FN(Deriv_3)(PASS, A3(0), A(3))))
CASE(area, area, 3, 1, R(FN(area)(PASS, A3(0))))
CASE(area_strategy, area_strategy, 3, 1, R(FN(area_strategy)(PASS, A3(0), "shading")))
CASE(calculatenormal, calculatenormal, 3, 3, R3(FN(calculatenormal)(PASS, A3(0))))
CASE(trace_c, trace_c, 6, 3, R3(FN(trace_c)(PASS, A3(0), A3(3), 0, 0)))
CASE(trace_f, trace_f, 6, 1, R(FN(trace_f)(PASS, A3(0), A3(3), 0, 0)))
CASE(visibility, visibility, 6, 3, R3(FN(visibility)(PASS, A3(0), A3(3))))
CASE(transmission, transmission, 6, 3, R3(FN(transmission)(PASS, A3(0), A3(3), 0, 0)))
CASE(rayhittest, rayhittest, 6, 1, V p = A3(0); V n = A3(0); R(FN(rayhittest)(PASS, A3(0), A3(3), &p, &n)))
CASE(fulltrace, fulltrace, 6, 14, V c = A3(0); F d = A(0); V p = A3(0); V n = A3(0); V pm = A3(3); V rm = A3(0); R(FN(fulltrace)(PASS, A3(0), A3(3), &c, &d, &p, &n, &pm, &rm)); R_AT(1, d); R3_AT(2, c); R3_AT(5, pm); R3_AT(8, rm); R3_AT(11, n))
CASE(occlusion, occlusion, 7, 1, R(FN(occlusion)(PASS, A3(0), A3(3), A(6), 0, 0, 0, 0)))
CASE(occlusion_map, occlusion_map, 7, 1, R(FN(occlusion_map)(PASS, "m", A3(0), A3(3), A(6), 0, 0)))
CASE(occlusion_map_2, occlusion_map_2, 7, 1, R(FN(occlusion_map_2)(PASS, "m", A3(0), A3(3), A(6), A(6), 0, 0)))
CASE(indirectdiffuse, indirectdiffuse, 7, 3, R3(FN(indirectdiffuse)(PASS, A3(0), A3(3), A(6), 0, 0, 0, 0)))
CASE(indirectdiffuse_map, indirectdiffuse_map, 3, 3, R3(FN(indirectdiffuse_map)(PASS, "m", A3(0), 0, 0)))
CASE(caustic, caustic, 6, 3, R3(FN(caustic)(PASS, A3(0), A3(3))))
CASE(photonmap, photonmap, 6, 3, R3(FN(photonmap)(PASS, "m", A3(0), A3(3), 0, 0)))
CASE(subsurface, subsurface, 6, 3, R3(FN(subsurface)(PASS, A3(0), A3(3), 0, 0)))
#define MAP_FILL                                                                                   \
    sl_string key = "fill";                                                                        \
    float fill = 0.25f;                                                                            \
    sl_value pairs[2] = {{SL_TYPE_string, 0, 0, &key}, {SL_TYPE_float, 0, 0, &fill}}
CASE(texture_f, texture_f, 0, 1, R(FN(texture_f)(PASS, "", 0, 0, 0)))
CASE(texture_f_fill, texture_f, 0, 1, MAP_FILL; R(FN(texture_f)(PASS, "m", 0, pairs, 2)))
CASE(texture_f_st, texture_f_st, 2, 1, R(FN(texture_f_st)(PASS, "", 0, A(0), A(1), 0, 0)))
CASE(texture_f_quad, texture_f_quad, 1, 1, R(FN(texture_f_quad)(PASS, "", 0, A(0), A(0), A(0), A(0), A(0), A(0), A(0), A(0), 0, 0)))
CASE(texture_c, texture_c, 0, 3, R3(FN(texture_c)(PASS, "", 0, 0, 0)))
CASE(texture_c_fill, texture_c, 0, 3, MAP_FILL; R3(FN(texture_c)(PASS, "m", 0, pairs, 2)))
CASE(texture_c_st, texture_c_st, 2, 3, R3(FN(texture_c_st)(PASS, "", 0, A(0), A(1), 0, 0)))
CASE(texture_c_quad, texture_c_quad, 1, 3, R3(FN(texture_c_quad)(PASS, "", 0, A(0), A(0), A(0), A(0), A(0), A(0), A(0), A(0), 0, 0)))
CASE(environment_f, environment_f, 3, 1, R(FN(environment_f)(PASS, "", 0, A3(0), 0, 0)))
CASE(environment_f_quad, environment_f_quad, 3, 1, R(FN(environment_f_quad)(PASS, "", 0, A3(0), A3(0), A3(0), A3(0), 0, 0)))
CASE(environment_c, environment_c, 3, 3, R3(FN(environment_c)(PASS, "", 0, A3(0), 0, 0)))
CASE(environment_c_quad, environment_c_quad, 3, 3, R3(FN(environment_c_quad)(PASS, "", 0, A3(0), A3(0), A3(0), A3(0), 0, 0)))
CASE(shadow_f, shadow_f, 3, 1, R(FN(shadow_f)(PASS, "", 0, A3(0), 0, 0)))
CASE(shadow_f_named, shadow_f, 3, 1, R(FN(shadow_f)(PASS, "m", 0, A3(0), 0, 0)))
CASE(shadow_f_quad, shadow_f_quad, 3, 1, R(FN(shadow_f_quad)(PASS, "", 0, A3(0), A3(0), A3(0), A3(0), 0, 0)))
CASE(shadow_c, shadow_c, 3, 3, R3(FN(shadow_c)(PASS, "", 0, A3(0), 0, 0)))
CASE(shadow_c_quad, shadow_c_quad, 3, 3, R3(FN(shadow_c_quad)(PASS, "", 0, A3(0), A3(0), A3(0), A3(0), 0, 0)))
CASE(bump, bump, 3, 3, R3(FN(bump)(PASS, "m", 0, A3(0), A3(0), A3(0), 0, 0)))
CASE(bump_st, bump_st, 3, 3, R3(FN(bump_st)(PASS, "m", 0, A3(0), A3(0), A3(0), A(0), A(0), 0, 0)))
CASE(bump_quad, bump_quad, 3, 3, R3(FN(bump_quad)(PASS, "m", 0, A3(0), A3(0), A3(0), A(0), A(0), A(0), A(0), A(0), A(0), A(0), A(0), 0, 0)))
CASE(bake_f, bake_f, 1, 0, FN(bake_f)(PASS, "b", A(0), A(0), A(0)))
CASE(bake_3, bake_3, 3, 0, FN(bake_3)(PASS, "b", A(0), A(0), A3(0)))
CASE(bake3d, bake3d, 3, 1, R(FN(bake3d)(PASS, "b", "c", A3(0), A3(0), 0, 0)))
CASE(texture3d, texture3d, 3, 1, R(FN(texture3d)(PASS, "b", A3(0), A3(0), 0, 0, 0, 0)))
CASE(textureinfo, textureinfo, 0, 1, F x = K(5); sl_value o = {SL_TYPE_float, sizeof x > 4, 0, &x}; R(FN(textureinfo)(PASS, "m", "exists", &o) + x))
#undef F1
#undef F2
#undef F3
/* clang-format on */
#include "diff_cases.h"
