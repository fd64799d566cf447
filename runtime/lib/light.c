/* SPDX-License-Identifier: Apache-2.0
 * Light loops and the lighting functions built on them; reference/sl.md 4.6 and 5.5. Lanes only:
 * light is never uniform, so the slu_ forms answer for the first live lane.
 */
#include "body.h"

/* --- the loop
 * -----------------------------------------------------------------------------------------------------
 */

static slv result_planes(const float* planes) {
    slv v;
    __builtin_memcpy(&v, planes, sizeof v); /* planes of SL_LANES floats */
    return v;
}

static slf result_plane(const float* plane) {
    slf v;
    __builtin_memcpy(&v, plane, sizeof v);
    return v;
}

static void take_result(sl_light_loop* loop, const sl_light_result* result) {
    loop->L = result_planes(result->L);
    loop->Cl = result_planes(result->Cl);
    loop->Ol = result_planes(result->Ol);
    loop->nondiffuse = result_plane(result->nondiffuse);
    loop->nonspecular = result_plane(result->nonspecular);
}

/* The engine tests the cone before it runs the light; testing again here costs little and makes the
 * rule hold for every engine. L = 0 (a light at P) is outside every cone and lights nothing. */
static sli reached(const sl_light_loop* loop, sli lit) {
    const slf squared = slv_dot_3(loop->L, loop->L);
    lit &= squared > (slf){0};
    if (!loop->has_cone)
        return lit;
    const slf cosine = slv_dot_3(slv_normalize(loop->L), slv_normalize(loop->axis));
    return lit & (cosine >= loop->cosangle);
}

int sl_lights_next(const sl_call* call, sl_light_loop* loop, sli* lit) {
    while (loop->index < loop->count && sl_any(loop->live)) {
        sl_light_result result = {0};
        const sl_light_query query =
            sl_lights_query(call, loop, loop->index, loop->sample, loop->live);
        loop->at_index = loop->index;
        loop->at_sample = loop->sample;
        const uint32_t bits = call->services->light(call->engine, &query, &result);
        if (!result.more)
            loop->index = result.next > loop->index ? result.next : loop->index + 1;
        loop->sample = result.more ? loop->sample + 1 : 0;
        take_result(loop, &result);
        *lit = reached(loop, loop->live & sl_mask(bits));
        if (sl_any(*lit))
            return 1;
    }
    return 0;
}

/* --- what lights do to a point
 * -------------------------------------------------------------------------------------- */

static slv shaded_point(const sl_call* call) {
    return slv_var_3(call, SL_VAR_P);
}

static slv add_lit(slv sum, sli lit, slv Cl, slf k) {
    return slv_select_3(lit, slv_add_3(sum, slv_scale_3(Cl, k)), sum);
}

static void begin_hemisphere(const sl_call* call, sl_light_loop* loop, sli mask, slv n) {
    sl_lights_begin(call, loop, mask, shaded_point(call), "");
    loop->has_cone = 1;
    loop->axis = n;
    loop->cosangle = (slf){0};
}

slv slv_ambient(const sl_call* call, sli mask) {
    const slv p = shaded_point(call);
    slv c = slv_f_to_3((slf){0});
    call->services->ambient(call->engine, call->first, sl_bits(mask), (const float*)&p, (float*)&c);
    return slv_select_3(mask, c, slv_f_to_3((slf){0}));
}

static slv sum_diffuse(const sl_call* call, sl_light_loop* loop, slv n) {
    slv sum = slv_f_to_3((slf){0});
    for (sli lit; sl_lights_next(call, loop, &lit);)
        sum = add_lit(sum, lit, loop->Cl,
                      (1.0f - loop->nondiffuse) * slv_dot_3(slv_normalize(loop->L), n));
    return sum;
}

slv slv_diffuse(const sl_call* call, sli mask, slv n) {
    sl_light_loop loop;
    begin_hemisphere(call, &loop, mask, n);
    return sum_diffuse(call, &loop, n);
}

/* Beyond the horizon the cosine is negative; a cone wider than a half space takes light, it does
 * not remove it. */
slv slv_diffuse_at(const sl_call* call, sli mask, slv p, slv n, slf angle) {
    sl_light_loop loop;
    slv sum = slv_f_to_3((slf){0});
    sl_lights_begin_cone(call, &loop, mask, p, n, angle, "");
    for (sli lit; sl_lights_next(call, &loop, &lit);) {
        const slf cosine = slv_max_f((slf){0}, slv_dot_3(slv_normalize(loop.L), n));
        sum = add_lit(sum, lit, loop.Cl, (1.0f - loop.nondiffuse) * cosine);
    }
    return sum;
}

/* Option "render" "prmanspecular" asks for the wider highlight of that renderer: exponent
 * 8/roughness. */
static float exponent_scale(const sl_call* call) {
    slf value = {0};
    const uint32_t bit = sl_bits(call->live) & (0u - sl_bits(call->live));
    const uint32_t set =
        call->services->message(call->engine, SL_MESSAGE_option, "render:prmanspecular",
                                SL_TYPE_float, 0, call->first, bit, (float*)&value);
    return (set & bit) && value[__builtin_ctz(bit)] != 0 ? 8 : 1;
}

static slf highlight(slv l, slv n, slv v, slf exponent) {
    const slv h = slv_normalize(slv_add_3(l, v));
    return slv_pow(slv_max_f((slf){0}, slv_dot_3(n, h)), exponent);
}

/* Roughness 0 is a mirror: a large finite exponent keeps pow(1, .) at 1. */
static slf exponent_of(slf roughness, float scale) {
    return scale / slv_max_f(roughness, slv_spread_f(1e-6f));
}

slv slv_specularbrdf(const sl_call* call, sli mask, slv l, slv n, slv v, slf roughness) {
    (void)mask;
    return slv_f_to_3(highlight(l, n, v, exponent_of(roughness, exponent_scale(call))));
}

/* Its difference: the power of a clamped cosine of two directions, each step by its own
 * difference. */
slv slv_specularbrdf_d(const sl_call* call, sli mask, slv l, slv n, slv v, slf roughness, slv dl,
                       slv dn, slv dv, slf droughness) {
    (void)mask;
    const float scale = exponent_scale(call);
    const slv middle = slv_add_3(l, v), dmiddle = slv_add_3(dl, dv);
    const slv h = slv_normalize(middle), dh = slv_normalize_d(middle, dmiddle);
    const slf along = slv_dot_3(n, h), dalong = slv_dot_3_d(n, h, dn, dh), zero = {0};
    const slf cosine = slv_max_f(zero, along), dcosine = slv_max_f_d(zero, along, zero, dalong);
    const slf least = slv_spread_f(1e-6f);
    const slf rough = slv_max_f(roughness, least);
    const slf drough = slv_max_f_d(roughness, least, droughness, zero);
    const slf exponent = exponent_of(roughness, scale);
    const slf dexponent = -exponent * drough / (rough + drough);
    return slv_f_to_3(slv_pow_d(cosine, exponent, dcosine, dexponent));
}

slv slv_specular(const sl_call* call, sli mask, slv n, slv v, slf roughness) {
    sl_light_loop loop;
    slv sum = slv_f_to_3((slf){0});
    const slf exponent = exponent_of(roughness, exponent_scale(call));
    begin_hemisphere(call, &loop, mask, n);
    for (sli lit; sl_lights_next(call, &loop, &lit);) {
        const slf k = highlight(slv_normalize(loop.L), n, v, exponent);
        sum = add_lit(sum, lit, loop.Cl, (1.0f - loop.nonspecular) * k);
    }
    return sum;
}

slv slv_phong(const sl_call* call, sli mask, slv n, slv v, slf size) {
    sl_light_loop loop;
    slv sum = slv_f_to_3((slf){0});
    const slv unit_n = slv_normalize(n);
    const slv r = slv_reflect(slv_neg_3(slv_normalize(v)), unit_n);
    begin_hemisphere(call, &loop, mask, n);
    for (sli lit; sl_lights_next(call, &loop, &lit);) {
        const slf k = slv_pow(slv_max_f((slf){0}, slv_dot_3(r, slv_normalize(loop.L))), size);
        sum = add_lit(sum, lit, loop.Cl, (1.0f - loop.nonspecular) * k);
    }
    return sum;
}

/* --- for the first live lane
 * ---------------------------------------------------------------------------------------- */

static sli first_live(const sl_call* call) {
    return sl_mask(1u << sl_first_lane(call->live));
}

static slu3 of_first(const sl_call* call, slv v) {
    return slv_lane_3(v, sl_first_lane(call->live));
}

slu3 slu_ambient(const sl_call* call) {
    return of_first(call, slv_ambient(call, first_live(call)));
}

slu3 slu_diffuse(const sl_call* call, slu3 n) {
    return of_first(call, slv_diffuse(call, first_live(call), slv_spread_3(n)));
}

slu3 slu_diffuse_at(const sl_call* call, slu3 p, slu3 n, float angle) {
    return of_first(call, slv_diffuse_at(call, first_live(call), slv_spread_3(p), slv_spread_3(n),
                                         slv_spread_f(angle)));
}

slu3 slu_specular(const sl_call* call, slu3 n, slu3 v, float roughness) {
    return of_first(call, slv_specular(call, first_live(call), slv_spread_3(n), slv_spread_3(v),
                                       slv_spread_f(roughness)));
}

slu3 slu_phong(const sl_call* call, slu3 n, slu3 v, float size) {
    return of_first(call, slv_phong(call, first_live(call), slv_spread_3(n), slv_spread_3(v),
                                    slv_spread_f(size)));
}

slu3 slu_specularbrdf(const sl_call* call, slu3 l, slu3 n, slu3 v, float roughness) {
    return of_first(call, slv_specularbrdf(call, first_live(call), slv_spread_3(l), slv_spread_3(n),
                                           slv_spread_3(v), slv_spread_f(roughness)));
}

slu3 slu_specularbrdf_d(const sl_call* call, slu3 l, slu3 n, slu3 v, float roughness, slu3 dl,
                        slu3 dn, slu3 dv, float droughness) {
    return of_first(
        call, slv_specularbrdf_d(call, first_live(call), slv_spread_3(l), slv_spread_3(n),
                                 slv_spread_3(v), slv_spread_f(roughness), slv_spread_3(dl),
                                 slv_spread_3(dn), slv_spread_3(dv), slv_spread_f(droughness)));
}
