/* SPDX-License-Identifier: Apache-2.0
 * Declarations of the out-of-line difference bodies, one text per world, as sl_calls.h: the
 * arguments of <body>, then the difference of every numeric one in order (knots, name/value pairs
 * and strings have none). What holds for all: sl_diff_inline.h.
 */

/* mathematics */
F FN(sin_d)(F x, F dx) OUT(sin_d);
F FN(cos_d)(F x, F dx) OUT(cos_d);
F FN(tan_d)(F x, F dx) OUT(tan_d);
F FN(asin_d)(F x, F dx) OUT(asin_d);
F FN(acos_d)(F x, F dx) OUT(acos_d);
F FN(atan_d)(F x, F dx) OUT(atan_d);
F FN(atan2_d)(F y, F x, F dy, F dx) OUT(atan2_d);
F FN(exp_d)(F x, F dx) OUT(exp_d);
F FN(log_d)(F x, F dx) OUT(log_d);
F FN(log_base_d)(F x, F base, F dx, F dbase) OUT(log_base_d);
F FN(pow_d)(F x, F y, F dx, F dy) OUT(pow_d);
F FN(erf_d)(F x, F dx) OUT(erf_d);
F FN(erfc_d)(F x, F dx) OUT(erfc_d);
F FN(filterstep_between_d)(F edge, F x1, F x2, const sl_value* values, int n, F d_edge, F dx1,
                           F dx2) OUT(filterstep_between_d);
F FN(spline_f_d)(sl_string basis, F x, const F* knots, int n, F dx) OUT(spline_f_d);
V FN(spline_3_d)(sl_string basis, F x, const V* knots, int n, F dx) OUT(spline_3_d);

/* noise */
F FN(noise_f_1_d)(F x, F dx) OUT(noise_f_1_d);
F FN(noise_f_2_d)(F x, F y, F dx, F dy) OUT(noise_f_2_d);
F FN(noise_f_3_d)(V p, V dp) OUT(noise_f_3_d);
F FN(noise_f_4_d)(V p, F t, V dp, F dt) OUT(noise_f_4_d);
V FN(noise_3_1_d)(F x, F dx) OUT(noise_3_1_d);
V FN(noise_3_2_d)(F x, F y, F dx, F dy) OUT(noise_3_2_d);
V FN(noise_3_3_d)(V p, V dp) OUT(noise_3_3_d);
V FN(noise_3_4_d)(V p, F t, V dp, F dt) OUT(noise_3_4_d);
/* value, and the changes by two steps */
F FN(noise_f_1_uv)(F x, F xu, F xv, F* by_u, F* by_v) OUT(noise_f_1_uv);
F FN(noise_f_2_uv)(F x, F y, F xu, F yu, F xv, F yv, F* by_u, F* by_v) OUT(noise_f_2_uv);
F FN(noise_f_3_uv)(V p, V u, V v, F* by_u, F* by_v) OUT(noise_f_3_uv);
F FN(noise_f_4_uv)(V p, F t, V u, F tu, V v, F tv, F* by_u, F* by_v) OUT(noise_f_4_uv);
V FN(noise_3_1_uv)(F x, F xu, F xv, V* by_u, V* by_v) OUT(noise_3_1_uv);
V FN(noise_3_2_uv)(F x, F y, F xu, F yu, F xv, F yv, V* by_u, V* by_v) OUT(noise_3_2_uv);
V FN(noise_3_3_uv)(V p, V u, V v, V* by_u, V* by_v) OUT(noise_3_3_uv);
V FN(noise_3_4_uv)(V p, F t, V u, F tu, V v, F tv, V* by_u, V* by_v) OUT(noise_3_4_uv);
F FN(cellnoise_f_1_d)(F x, F dx) OUT(cellnoise_f_1_d);
F FN(cellnoise_f_2_d)(F x, F y, F dx, F dy) OUT(cellnoise_f_2_d);
F FN(cellnoise_f_3_d)(V p, V dp) OUT(cellnoise_f_3_d);
F FN(cellnoise_f_4_d)(V p, F t, V dp, F dt) OUT(cellnoise_f_4_d);
V FN(cellnoise_3_1_d)(F x, F dx) OUT(cellnoise_3_1_d);
V FN(cellnoise_3_2_d)(F x, F y, F dx, F dy) OUT(cellnoise_3_2_d);
V FN(cellnoise_3_3_d)(V p, V dp) OUT(cellnoise_3_3_d);
V FN(cellnoise_3_4_d)(V p, F t, V dp, F dt) OUT(cellnoise_3_4_d);
F FN(pnoise_f_1_d)(F x, F px, F dx, F dpx) OUT(pnoise_f_1_d);
F FN(pnoise_f_2_d)(F x, F y, F px, F py, F dx, F dy, F dpx, F dpy) OUT(pnoise_f_2_d);
F FN(pnoise_f_3_d)(V p, V pp, V dp, V dpp) OUT(pnoise_f_3_d);
F FN(pnoise_f_4_d)(V p, F t, V pp, F pt, V dp, F dt, V dpp, F dpt) OUT(pnoise_f_4_d);
V FN(pnoise_3_1_d)(F x, F px, F dx, F dpx) OUT(pnoise_3_1_d);
V FN(pnoise_3_2_d)(F x, F y, F px, F py, F dx, F dy, F dpx, F dpy) OUT(pnoise_3_2_d);
V FN(pnoise_3_3_d)(V p, V pp, V dp, V dpp) OUT(pnoise_3_3_d);
V FN(pnoise_3_4_d)(V p, F t, V pp, F pt, V dp, F dt, V dpp, F dpt) OUT(pnoise_3_4_d);

/* geometry */
F FN(ptlined_d)(V a, V b, V q, V da, V db, V dq) OUT(ptlined_d);
V FN(rotate_3_d)(V q, F angle, V p0, V p1, V dq, F dangle, V dp0, V dp1) OUT(rotate_3_d);
V FN(refract_d)(V i, V n, F eta, V di, V dn, F deta) OUT(refract_d);
V FN(faceforward_d)(CALL, V n, V i, V dn, V di) OUT(faceforward_d);
V FN(transform_to_d)(CALL, sl_string to, V p, V dp) OUT(transform_to_d);
V FN(transform_from_to_d)(CALL, sl_string from, sl_string to, V p, V dp) OUT(transform_from_to_d);
V FN(transform_m_d)(M m, V p, M dm, V dp) OUT(transform_m_d);
V FN(transform_from_m_d)(CALL, sl_string from, M m, V p, M dm, V dp) OUT(transform_from_m_d);
V FN(vtransform_m_d)(M m, V v, M dm, V dv) OUT(vtransform_m_d);
V FN(vtransform_from_m_d)(CALL, sl_string from, M m, V v, M dm, V dv) OUT(vtransform_from_m_d);
V FN(ntransform_m_d)(M m, V n, M dm, V dn) OUT(ntransform_m_d);
V FN(ntransform_from_m_d)(CALL, sl_string from, M m, V n, M dm, V dn) OUT(ntransform_from_m_d);
F FN(depth_d)(CALL, V p, V dp) OUT(depth_d);
F FN(determinant_d)(M m, M dm) OUT(determinant_d);
F FN(comp_m_d)(M m, F row, F col, M dm, F drow, F dcol) OUT(comp_m_d);

/* colour and light */
V FN(ctransform_to_d)(sl_string to, V c, V dc) OUT(ctransform_to_d);
V FN(ctransform_from_to_d)(sl_string from, sl_string to, V c, V dc) OUT(ctransform_from_to_d);
V FN(specularbrdf_d)(CALL, V l, V n, V v, F roughness, V dl, V dn, V dv, F droughness)
    OUT(specularbrdf_d);
