/* SPDX-License-Identifier: Apache-2.0
 * Light loops: illuminance on the surface's side, illuminate and solar on the light's side
 * (sl.md 5.4, 5.5).
 *
 *   sl_light_loop loop;
 *   sl_lights_begin_cone(call, &loop, mask, P, axis, angle, category);     or sl_lights_begin
 *   for (sli lit; sl_lights_next(call, &loop, &lit);) { body with loop.L, loop.Cl, loop.Ol under
 * mask `lit` }
 *
 * `break` in the body: loop.live &= ~lanes that left; `continue` needs nothing.
 */
#ifndef PERIGEE_SL_LIGHTS_H
#define PERIGEE_SL_LIGHTS_H

typedef struct sl_light_loop {
    slv P;        /* points being lit */
    slv axis;     /* with has_cone */
    slf cosangle; /* cosine of the cone's half angle; -2 and less: everything */
    sli live;     /* lanes still in the loop */
    sl_string category;
    int32_t has_cone;
    int32_t index;     /* light to ask next */
    int32_t count;     /* lights of the batch */
    int32_t sample;    /* of that light to ask next */
    int32_t refresh;   /* "lightcache" "refresh" */
    int32_t num_sends; /* "send:light:name": pairs of name and value */
    const sl_value* sends;
    /* the sample at hand, and what was asked to get it */
    int32_t at_index, at_sample;
    slv L; /* from P towards the light */
    slv Cl, Ol;
    slf nondiffuse, nonspecular; /* the light's __nondiffuse and __nonspecular */
} sl_light_loop;

/* What a loop goes on from after a suspension: all but the sample at hand, whose values the shader
 * has in variables, and what is sent, which lies on the stack. */
typedef struct sl_saved_lights {
    unsigned char bytes[__builtin_offsetof(sl_light_loop, L)]
        __attribute__((aligned(sizeof(slf)))); /* C++ tests read this header, too */
} sl_saved_lights;

/* The next light sample that reaches any lane: 1 and the lanes reached; 0 when there is none left.
 */
int sl_lights_next(const sl_call* call, sl_light_loop* loop, sli* lit) SL_SYMBOL(sl_lights_next);

/* What is asked about light `index`. */
SL_INLINE sl_light_query sl_lights_query(const sl_call* call, const sl_light_loop* loop,
                                         int32_t index, int32_t sample, sli mask) {
    return (sl_light_query){
        .index = index,
        .first = call->first,
        .lanes = SL_LANES,
        .mask = sl_bits(mask),
        .P = (const float*)&loop->P,
        .N = 0,
        .axis = loop->has_cone ? (const float*)&loop->axis : 0,
        .cosangle = loop->has_cone ? (const float*)&loop->cosangle : 0,
        .category = loop->category,
        .sample = sample,
        .refresh = loop->refresh,
        .num_sends = loop->num_sends,
        .sends = loop->sends,
    };
}

SL_INLINE void sl_lights_begin(const sl_call* call, sl_light_loop* loop, sli mask, slv P,
                               sl_string category) {
    loop->P = P;
    loop->axis = slv_f_to_3((slf){0});
    loop->cosangle = slv_spread_f(-2);
    loop->live = mask;
    loop->category = category;
    loop->has_cone = 0;
    loop->index = loop->sample = loop->refresh = loop->num_sends = 0;
    loop->sends = 0;
    loop->count = call->services->light_count(call->engine);
}

SL_INLINE void sl_lights_save(const sl_light_loop* loop, sl_saved_lights* saved) {
    __builtin_memcpy(saved->bytes, loop, sizeof saved->bytes);
}
SL_INLINE void sl_lights_restore(sl_light_loop* loop, const sl_saved_lights* saved) {
    __builtin_memcpy(loop, saved->bytes, sizeof saved->bytes);
}

/* Cosine of a cone's half angle as the cone tests use it: exactly 0 at pi/2, and everything passes
 * from pi on. */
SL_INLINE slf slv_cone_cosine(slf angle) {
    const slf c = slv_cos(angle);
    const sli right = (slv_abs(angle - 1.57079632679489662f) < 1e-6f);
    return slv_select_f(angle >= 3.14159f, slv_spread_f(-2), slv_select_f(right, (slf){0}, c));
}

SL_INLINE void sl_lights_begin_cone(const sl_call* call, sl_light_loop* loop, sli mask, slv P,
                                    slv axis, slf angle, sl_string category) {
    sl_lights_begin(call, loop, mask, P, category);
    loop->axis = axis;
    loop->cosangle = slv_cone_cosine(angle);
    loop->has_cone = 1;
}

/* --- the light's side; each returns the lanes whose body runs. In the other lanes the emitter sets
 * Cl to 0. -------- */

SL_INLINE void sl_mark_lit(const sl_call* call, sli lit) {
    if (call->batch->lit)
        call->batch->lit[call->first / SL_LANES] |= sl_bits(lit);
}

/* illuminate(from): L = Ps - from. */
SL_INLINE sli sl_illuminate(const sl_call* call, sli mask, slv from, slv* L) {
    *L = slv_sub_3(slv_var_3(call, SL_VAR_Ps), from);
    sl_mark_lit(call, mask);
    return mask;
}

/* illuminate(from, axis, angle): lit where L lies within angle of axis. */
SL_INLINE sli sl_illuminate_cone(const sl_call* call, sli mask, slv from, slv axis, slf angle,
                                 slv* L) {
    *L = slv_sub_3(slv_var_3(call, SL_VAR_Ps), from);
    const slf cosine = slv_dot_3(slv_normalize(*L), slv_normalize(axis));
    const sli lit = mask & (cosine >= slv_cone_cosine(angle));
    sl_mark_lit(call, lit);
    return lit;
}

/* solar(axis, angle): L = axis, or a direction within the angle for each sample of the disc. */
SL_INLINE sli sl_solar_cone(const sl_call* call, sli mask, slv axis, slf angle, slv* L) {
    *L = axis;
    if (sl_any(mask & (angle != (slf){0})))
        call->services->solar_direction(call->engine, call->first, sl_bits(mask),
                                        (const float*)&axis, (const float*)&angle, (float*)L);
    sl_mark_lit(call, mask);
    return mask;
}

/* solar(): light from everywhere, a direction for each sample; needs Ns. */
SL_INLINE sli sl_solar(const sl_call* call, sli mask, slv* L) {
    *L = slv_neg_3(slv_normalize(slv_var_3(call, SL_VAR_Ns)));
    call->services->solar_direction(call->engine, call->first, sl_bits(mask), 0, 0, (float*)L);
    sl_mark_lit(call, mask);
    return mask;
}

#endif
