/* SPDX-License-Identifier: Apache-2.0
 * Cases of the difference bodies, in the notation of cases.h, which includes this: the planes are
 * those of the body's own case, then the differences of the same shape.
 */
/* clang-format off */
#define D1(name) CASE(name##_d, name##_d, 2, 1, R(FN(name##_d)(A(0), A(1))))
#define D2(name) CASE(name##_d, name##_d, 4, 1, R(FN(name##_d)(A(0), A(1), A(2), A(3))))
#define D3(name) CASE(name##_d, name##_d, 6, 1, R(FN(name##_d)(A(0), A(1), A(2), A(3), A(4), A(5))))
D1(sin)
D1(cos)
D1(tan)
D1(asin)
D1(acos)
D1(atan)
D2(atan2)
D2(pow)
D1(exp)
D1(sqrt)
D1(inversesqrt)
D1(log)
D2(log_base)
D2(mod)
D1(abs)
D1(sign)
D1(floor)
D1(ceil)
D1(round)
D2(step)
D3(smoothstep)
D1(erf)
D1(erfc)
D2(min_f)
D2(max_f)
D3(clamp_f)
D3(mix_f)
CASE(min_3_d, min_3_d, 12, 3, R3(FN(min_3_d)(A3(0), A3(3), A3(6), A3(9))))
CASE(max_3_d, max_3_d, 12, 3, R3(FN(max_3_d)(A3(0), A3(3), A3(6), A3(9))))
CASE(clamp_3_d, clamp_3_d, 18, 3, R3(FN(clamp_3_d)(A3(0), A3(3), A3(6), A3(9), A3(12), A3(15))))
CASE(mix_3_d, mix_3_d, 14, 3, R3(FN(mix_3_d)(A3(0), A3(3), A(6), A3(7), A3(10), A(13))))
CASE(mix_33_d, mix_33_d, 18, 3, R3(FN(mix_33_d)(A3(0), A3(3), A3(6), A3(9), A3(12), A3(15))))

#define STEP_FILTER_D(label, text)                                                                 \
    CASE(label, filterstep_between_d, 6, 1, sl_string key = "filter"; sl_string value = text;      \
         sl_value pairs[2] = {{SL_TYPE_string, 0, 0, &key}, {SL_TYPE_string, 0, 0, &value}};       \
         R(FN(filterstep_between_d)(A(0), A(1), A(2), pairs, 2, A(3), A(4), A(5))))
CASE(filterstep_between_d, filterstep_between_d, 6, 1, R(FN(filterstep_between_d)(A(0), A(1), A(2), 0, 0, A(3), A(4), A(5))))
STEP_FILTER_D(filterstep_triangle_d, "triangle")
STEP_FILTER_D(filterstep_gaussian_d, "gaussian")
STEP_FILTER_D(filterstep_catmull_d, "catmull-rom")
CASE(filterstep_width_d, filterstep_between_d, 6, 1, sl_string key = "width"; float two = 2; sl_value pairs[2] = {{SL_TYPE_string, 0, 0, &key}, {SL_TYPE_float, 0, 0, &two}}; R(FN(filterstep_between_d)(A(0), A(1), A(2), pairs, 2, A(3), A(4), A(5))))

/* spline: value, knots, step of the value */
#define SPLINE_D(label, basis, n)                                                                  \
    CASE(label, spline_f_d, 2 + n, 1, F k[n]; for (int j = 0; j < n; j++) k[j] = A(1 + j);         \
         R(FN(spline_f_d)(basis, A(0), k, n, A(1 + n))))
SPLINE_D(spline_default_d, 0, 6)
SPLINE_D(spline_bspline_d, "bspline", 6)
SPLINE_D(spline_bezier_d, "bezier", 7)
SPLINE_D(spline_hermite_d, "hermite", 6)
SPLINE_D(spline_linear_d, "linear", 6)
SPLINE_D(solve_default_d, "solve", 6)
SPLINE_D(solve_bezier_d, "solvebezier", 7)
CASE(spline_3_d, spline_3_d, 17, 3, V k[5]; for (int j = 0; j < 5; j++) k[j] = A3(1 + 3 * j); R3(FN(spline_3_d)("bspline", A(0), k, 5, A(16))))

#define NOISE_D(name)                                                                              \
    CASE(name##_f_1_d, name##_f_1_d, 2, 1, R(FN(name##_f_1_d)(A(0), A(1))))                        \
    CASE(name##_f_2_d, name##_f_2_d, 4, 1, R(FN(name##_f_2_d)(A(0), A(1), A(2), A(3))))            \
    CASE(name##_f_3_d, name##_f_3_d, 6, 1, R(FN(name##_f_3_d)(A3(0), A3(3))))                      \
    CASE(name##_f_4_d, name##_f_4_d, 8, 1, R(FN(name##_f_4_d)(A3(0), A(3), A3(4), A(7))))          \
    CASE(name##_3_1_d, name##_3_1_d, 2, 3, R3(FN(name##_3_1_d)(A(0), A(1))))                       \
    CASE(name##_3_2_d, name##_3_2_d, 4, 3, R3(FN(name##_3_2_d)(A(0), A(1), A(2), A(3))))           \
    CASE(name##_3_3_d, name##_3_3_d, 6, 3, R3(FN(name##_3_3_d)(A3(0), A3(3))))                     \
    CASE(name##_3_4_d, name##_3_4_d, 8, 3, R3(FN(name##_3_4_d)(A3(0), A(3), A3(4), A(7))))
NOISE_D(noise)
NOISE_D(cellnoise)
/* planes: point, steps u, steps v; value, then the changes */
#define NOISE_UV_F(dims, n, ...) CASE(noise_f_##dims##_uv, noise_f_##dims##_uv, n, 3, F u; F v; R(FN(noise_f_##dims##_uv)(__VA_ARGS__, &u, &v)); R_AT(1, u); R_AT(2, v))
#define NOISE_UV_3(dims, n, ...) CASE(noise_3_##dims##_uv, noise_3_##dims##_uv, n, 9, V u; V v; R3(FN(noise_3_##dims##_uv)(__VA_ARGS__, &u, &v)); R3_AT(3, u); R3_AT(6, v))
NOISE_UV_F(1, 3, A(0), A(1), A(2))
NOISE_UV_F(2, 6, A(0), A(1), A(2), A(3), A(4), A(5))
NOISE_UV_F(3, 9, A3(0), A3(3), A3(6))
NOISE_UV_F(4, 12, A3(0), A(3), A3(4), A(7), A3(8), A(11))
NOISE_UV_3(1, 3, A(0), A(1), A(2))
NOISE_UV_3(2, 6, A(0), A(1), A(2), A(3), A(4), A(5))
NOISE_UV_3(3, 9, A3(0), A3(3), A3(6))
NOISE_UV_3(4, 12, A3(0), A(3), A3(4), A(7), A3(8), A(11))
CASE(pnoise_f_1_d, pnoise_f_1_d, 4, 1, R(FN(pnoise_f_1_d)(A(0), A(1), A(2), A(3))))
CASE(pnoise_f_2_d, pnoise_f_2_d, 8, 1, R(FN(pnoise_f_2_d)(A(0), A(1), A(2), A(3), A(4), A(5), A(6), A(7))))
CASE(pnoise_f_3_d, pnoise_f_3_d, 12, 1, R(FN(pnoise_f_3_d)(A3(0), A3(3), A3(6), A3(9))))
CASE(pnoise_f_4_d, pnoise_f_4_d, 16, 1, R(FN(pnoise_f_4_d)(A3(0), A(3), A3(4), A(7), A3(8), A(11), A3(12), A(15))))
CASE(pnoise_3_1_d, pnoise_3_1_d, 4, 3, R3(FN(pnoise_3_1_d)(A(0), A(1), A(2), A(3))))
CASE(pnoise_3_2_d, pnoise_3_2_d, 8, 3, R3(FN(pnoise_3_2_d)(A(0), A(1), A(2), A(3), A(4), A(5), A(6), A(7))))
CASE(pnoise_3_3_d, pnoise_3_3_d, 12, 3, R3(FN(pnoise_3_3_d)(A3(0), A3(3), A3(6), A3(9))))
CASE(pnoise_3_4_d, pnoise_3_4_d, 16, 3, R3(FN(pnoise_3_4_d)(A3(0), A(3), A3(4), A(7), A3(8), A(11), A3(12), A(15))))

CASE(length_d, length_d, 6, 1, R(FN(length_d)(A3(0), A3(3))))
CASE(distance_d, distance_d, 12, 1, R(FN(distance_d)(A3(0), A3(3), A3(6), A3(9))))
CASE(normalize_d, normalize_d, 6, 3, R3(FN(normalize_d)(A3(0), A3(3))))
CASE(ptlined_d, ptlined_d, 18, 1, R(FN(ptlined_d)(A3(0), A3(3), A3(6), A3(9), A3(12), A3(15))))
CASE(rotate_3_d, rotate_3_d, 20, 3, R3(FN(rotate_3_d)(A3(0), A(3), A3(4), A3(7), A3(10), A(13), A3(14), A3(17))))
CASE(reflect_d, reflect_d, 12, 3, R3(FN(reflect_d)(A3(0), A3(3), A3(6), A3(9))))
CASE(refract_d, refract_d, 14, 3, R3(FN(refract_d)(A3(0), A3(3), A(6), A3(7), A3(10), A(13))))
CASE(faceforward_d, faceforward_d, 12, 3, R3(FN(faceforward_d)(PASS, A3(0), A3(3), A3(6), A3(9))))
CASE(faceforward_ref_d, faceforward_ref_d, 18, 3, R3(FN(faceforward_ref_d)(A3(0), A3(3), A3(6), A3(9), A3(12), A3(15))))
CASE(transform_to_d, transform_to_d, 6, 3, R3(FN(transform_to_d)(PASS, "shader", A3(0), A3(3))))
CASE(transform_lanes_d, transform_to_d, 6, 3, R3(FN(transform_to_d)(PASS, "moving", A3(0), A3(3))))
CASE(transform_from_to_d, transform_from_to_d, 6, 3, R3(FN(transform_from_to_d)(PASS, "shader", "current", A3(0), A3(3))))
#define TRANSFORM_D(name)                                                                          \
    CASE(name##_m_d, name##_m_d, 38, 3, R3(FN(name##_m_d)(AM(0), A3(16), AM(19), A3(35))))         \
    CASE(name##_from_m_d, name##_from_m_d, 38, 3, R3(FN(name##_from_m_d)(PASS, "shader", AM(0), A3(16), AM(19), A3(35))))
TRANSFORM_D(transform)
TRANSFORM_D(vtransform)
TRANSFORM_D(ntransform)
CASE(depth_d, depth_d, 6, 1, R(FN(depth_d)(PASS, A3(0), A3(3))))
CASE(determinant_d, determinant_d, 32, 1, R(FN(determinant_d)(AM(0), AM(16))))
CASE(comp_m_d, comp_m_d, 36, 1, R(FN(comp_m_d)(AM(0), A(16), A(17), AM(18), A(34), A(35))))
CASE(comp_3_d, comp_3_d, 8, 1, R(FN(comp_3_d)(A3(0), A(3), A3(4), A(7))))
#define COLOUR_D(name)                                                                             \
    CASE(to_##name##_d, ctransform_to_d, 6, 3, R3(FN(ctransform_to_d)(#name, A3(0), A3(3))))       \
    CASE(from_##name##_d, ctransform_from_to_d, 6, 3, R3(FN(ctransform_from_to_d)(#name, "rgb", A3(0), A3(3))))
COLOUR_D(hsv)
COLOUR_D(hsl)
COLOUR_D(YIQ)
COLOUR_D(xyz)
COLOUR_D(xyY)
CASE(specularbrdf_d, specularbrdf_d, 20, 3, R3(FN(specularbrdf_d)(PASS, A3(0), A3(3), A3(6), A(9), A3(10), A3(13), A3(16), A(19))))
#undef D1
#undef D2
#undef D3
/* clang-format on */
