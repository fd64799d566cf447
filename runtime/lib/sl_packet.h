/* SPDX-License-Identifier: Apache-2.0
 * One execution of a shader on one packet (sl_call), and how values move between planes of a batch
 * and lanes. Plane bases are those of sl_points and of varying parameters: 64-byte aligned, stride
 * floats per plane. Stores touch live lanes only.
 */
#ifndef PERIGEE_SL_PACKET_H
#define PERIGEE_SL_PACKET_H

/* What an execution changes besides variables; its own in the call unless it must outlive a
 * suspension. */
typedef struct sl_counters {
    sli random_lanes;        /* random() calls each lane has made */
    uint32_t random_uniform; /* random() calls for uniform targets */
} sl_counters;

typedef struct sl_call {
    const sl_batch* batch; /* NULL while defaults are evaluated */
    const sl_services* services;
    void* engine;
    sl_counters* counters;
    uint32_t first; /* index in the batch of lane 0 */
    uint32_t count; /* lanes that are real points */
    sli live;       /* the same as a mask */
    sl_counters own_counters;
    const struct sl_light_loop* lights; /* lightsource(): the illuminance loop around the call */
    uint32_t steps;                     /* iterations of loops, as far as the engine was told */
    sli checked; /* checked code: lanes whose values are all numbers so far */
} sl_call;

SL_INLINE void sl_call_begin(sl_call* call, const sl_batch* batch, uint32_t first, uint32_t count) {
    call->batch = batch;
    call->services = batch->services;
    call->engine = batch->engine;
    call->first = first;
    call->count = count;
    call->live = sl_mask((1u << count) - 1);
    call->own_counters.random_lanes = (sli){0};
    call->own_counters.random_uniform = 0;
    call->counters = &call->own_counters;
    call->lights = 0;
    call->steps = 0;
    call->checked = call->live;
}

/* For parameter defaults: only slu_ functions may be called. */
SL_INLINE void sl_call_begin_init(sl_call* call, const sl_init* init) {
    call->batch = 0;
    call->services = init->services;
    call->engine = init->engine;
    call->first = 0;
    call->count = 1;
    call->live = sl_mask(1);
    call->own_counters.random_lanes = (sli){0};
    call->own_counters.random_uniform = 0;
    call->counters = &call->own_counters;
    call->lights = 0;
    call->steps = 0;
    call->checked = call->live;
}

/* --- loops without a known end
 * ------------------------------------------------------------------------------------------------
 */

/* Iterations between two questions to the engine. */
enum { SL_STEPS_AT_ONCE = 1 << 14 };

/* The packet has used up its iterations: how many follow, 0 if the lanes in mask have to stop. */
static __attribute__((noinline, cold, unused)) int32_t
sl_more_steps(sl_call* call, sli mask, const char* file, int32_t line) {
    call->steps += SL_STEPS_AT_ONCE;
    const uint32_t more =
        call->services->loop_steps(call->engine, call->steps, sl_bits(mask), file, line);
    if (more == 0)
        call->steps = 0; /* the lanes that go on start counting anew */
    return more < SL_STEPS_AT_ONCE ? (int32_t)more : SL_STEPS_AT_ONCE;
}

/* --- checked code
 * ---------------------------------------------------------------------------------------------- */

static __attribute__((noinline, cold, unused)) void
sl_complain(sl_call* call, sli bad, const char* file, int32_t line, const char* text) {
    call->checked &= ~bad;
    call->services->not_a_number(call->engine, call->first, sl_bits(bad), file, line, text);
}
/* x - x is 0 for numbers, NaN for the rest. */
SL_INLINE void sl_check_f(sl_call* call, sli mask, slf a, const char* file, int32_t line,
                          const char* text) {
    const sli bad = mask & call->checked & ~(a - a == 0.0f);
    if (sl_any(bad))
        sl_complain(call, bad, file, line, text);
}
SL_INLINE void sl_check_3(sl_call* call, sli mask, slv a, const char* file, int32_t line,
                          const char* text) {
    sl_check_f(call, mask, (a.x - a.x) + (a.y - a.y) + (a.z - a.z), file, line, text);
}
SL_INLINE void sl_check_m(sl_call* call, sli mask, slm a, const char* file, int32_t line,
                          const char* text) {
    for (int i = 0; i < 16; i++)
        sl_check_f(call, mask, a.m[i], file, line, text);
}
SL_INLINE sli sl_some_zero_f(slf a) {
    return a == 0.0f;
}
SL_INLINE sli sl_some_zero_3(slv a) {
    return (a.x == 0.0f) | (a.y == 0.0f) | (a.z == 0.0f);
}

/* --- uniform to lanes
 * --------------------------------------------------------------------------------------------- */

SL_INLINE slv slv_spread_3(slu3 a) {
    return slv_make_3(slv_spread_f(a.x), slv_spread_f(a.y), slv_spread_f(a.z));
}
SL_INLINE slm slv_spread_m(slum a) {
    slm r;
    for (int i = 0; i < 16; i++)
        r.m[i] = slv_spread_f(a.m[i]);
    return r;
}
SL_INLINE sls slv_spread_s(sl_string a) {
    sls r;
    for (int i = 0; i < SL_LANES; i++)
        r.s[i] = a;
    return r;
}
SL_INLINE float slv_lane_f(slf a, int lane) {
    return a[lane];
}
SL_INLINE slu3 slv_lane_3(slv a, int lane) {
    return slu_make_3(a.x[lane], a.y[lane], a.z[lane]);
}
SL_INLINE slum slv_lane_m(slm a, int lane) {
    slum r;
    for (int i = 0; i < 16; i++)
        r.m[i] = a.m[i][lane];
    return r;
}
SL_INLINE sl_string slv_lane_s(sls a, int lane) {
    return a.s[lane];
}

/* --- strings
 * ------------------------------------------------------------------------------------------------------
 */

SL_INLINE int slu_eq_s(sl_string a, sl_string b) { /* interned: equal texts have equal pointers */
    return -(a == b);
}
SL_INLINE int slu_ne_s(sl_string a, sl_string b) {
    return -(a != b);
}
SL_INLINE sli slv_eq_s(sls a, sls b) {
    sli r = {0};
    for (int i = 0; i < SL_LANES; i++)
        r[i] = -(a.s[i] == b.s[i]);
    return r;
}
SL_INLINE sli slv_ne_s(sls a, sls b) {
    return ~slv_eq_s(a, b);
}
SL_INLINE sls slv_select_s(sli m, sls a, sls b) {
    for (int i = 0; i < SL_LANES; i++)
        a.s[i] = m[i] ? a.s[i] : b.s[i];
    return a;
}
SL_INLINE sl_string slu_select_s(int m, sl_string a, sl_string b) {
    return m ? a : b;
}

/* --- planes to lanes
 * ---------------------------------------------------------------------------------------------- */

SL_INLINE slf sl_load_f(const sl_call* call, const float* base) {
    return *(const slf*)(const void*)(base + call->first);
}
SL_INLINE slv sl_load_3(const sl_call* call, const float* base) {
    const uint32_t stride = call->batch->stride;
    return slv_make_3(sl_load_f(call, base), sl_load_f(call, base + stride),
                      sl_load_f(call, base + 2 * stride));
}
SL_INLINE slm sl_load_m(const sl_call* call, const float* base) {
    slm r;
    for (int i = 0; i < 16; i++)
        r.m[i] = sl_load_f(call, base + i * call->batch->stride);
    return r;
}
SL_INLINE sls sl_load_s(const sl_call* call, const sl_string* base) {
    sls r;
    for (uint32_t i = 0; i < SL_LANES; i++)
        r.s[i] = base[call->first + (i < call->count ? i : 0)];
    return r;
}
SL_INLINE void sl_store_f(const sl_call* call, sli mask, float* base, slf a) {
    slf* p = (slf*)(void*)(base + call->first);
    *p = slv_select_f(mask, a, *p);
}
SL_INLINE void sl_store_3(const sl_call* call, sli mask, float* base, slv a) {
    const uint32_t stride = call->batch->stride;
    sl_store_f(call, mask, base, a.x);
    sl_store_f(call, mask, base + stride, a.y);
    sl_store_f(call, mask, base + 2 * stride, a.z);
}
SL_INLINE void sl_store_m(const sl_call* call, sli mask, float* base, slm a) {
    for (int i = 0; i < 16; i++)
        sl_store_f(call, mask, base + i * call->batch->stride, a.m[i]);
}
SL_INLINE void sl_store_s(const sl_call* call, sli mask, sl_string* base, sls a) {
    for (uint32_t i = 0; i < call->count; i++)
        if (mask[i])
            base[call->first + i] = a.s[i];
}
/* Predefined variables: varying ones by planes, uniform ones (E, ncomps) by value. */
SL_INLINE slf slv_var_f(const sl_call* call, int id) {
    return sl_load_f(call, call->batch->main->var[id]);
}
SL_INLINE slv slv_var_3(const sl_call* call, int id) {
    return sl_load_3(call, call->batch->main->var[id]);
}
SL_INLINE float slu_var_f(const sl_call* call, int id) {
    return call->batch->main->var[id][0];
}
SL_INLINE slu3 slu_var_3(const sl_call* call, int id) {
    const float* base = call->batch->main->var[id];
    return slu_make_3(base[0], base[1], base[2]);
}

/* Differences at an auxiliary point: 0 where the engine has no record or no plane. */
SL_INLINE slf slv_aux_f(const sl_call* call, const sl_points* points, int id) {
    return points && points->var[id] ? sl_load_f(call, points->var[id]) : (slf){0};
}
SL_INLINE slv slv_aux_3(const sl_call* call, const sl_points* points, int id) {
    const slf zero = {0};
    return points && points->var[id] ? sl_load_3(call, points->var[id])
                                     : slv_make_3(zero, zero, zero);
}
SL_INLINE void sl_store_aux_f(const sl_call* call, const sl_points* points, int id, slf a) {
    if (points && points->var[id])
        sl_store_f(call, call->live, points->var[id], a);
}
SL_INLINE void sl_store_aux_3(const sl_call* call, const sl_points* points, int id, slv a) {
    if (points && points->var[id])
        sl_store_3(call, call->live, points->var[id], a);
}

/* --- arrays of lanes with an index per lane; indices come from slv_index, so they are in range
 * --------------------- */

SL_INLINE slf slv_at_f(const slf* array, sli index) {
    slf r = {0};
    for (int i = 0; i < SL_LANES; i++)
        r[i] = array[index[i]][i];
    return r;
}
SL_INLINE void slv_put_f(slf* array, sli index, sli mask, slf a) {
    for (int i = 0; i < SL_LANES; i++)
        if (mask[i])
            array[index[i]][i] = a[i];
}
SL_INLINE slv slv_at_3(const slv* array, sli index) {
    slv r = {{0}, {0}, {0}};
    for (int i = 0; i < SL_LANES; i++) {
        const slv* a = &array[index[i]];
        r.x[i] = a->x[i], r.y[i] = a->y[i], r.z[i] = a->z[i];
    }
    return r;
}
SL_INLINE void slv_put_3(slv* array, sli index, sli mask, slv a) {
    for (int i = 0; i < SL_LANES; i++)
        if (mask[i]) {
            slv* to = &array[index[i]];
            to->x[i] = a.x[i], to->y[i] = a.y[i], to->z[i] = a.z[i];
        }
}
SL_INLINE slm slv_at_m(const slm* array, sli index) {
    slm r = array[0];
    for (int i = 0; i < SL_LANES; i++)
        for (int k = 0; k < 16; k++)
            r.m[k][i] = array[index[i]].m[k][i];
    return r;
}
SL_INLINE void slv_put_m(slm* array, sli index, sli mask, slm a) {
    for (int i = 0; i < SL_LANES; i++)
        for (int k = 0; k < 16 && mask[i]; k++)
            array[index[i]].m[k][i] = a.m[k][i];
}
SL_INLINE sls slv_at_s(const sls* array, sli index) {
    sls r;
    for (int i = 0; i < SL_LANES; i++)
        r.s[i] = array[index[i]].s[i];
    return r;
}
SL_INLINE void slv_put_s(sls* array, sli index, sli mask, sls a) {
    for (int i = 0; i < SL_LANES; i++)
        if (mask[i])
            array[index[i]].s[i] = a.s[i];
}
SL_INLINE float slu_at_f(const float* array, int index) {
    return array[index];
}
SL_INLINE slu3 slu_at_3(const slu3* array, int index) {
    return array[index];
}
/* Uniform arrays with an index per lane. */
SL_INLINE slf slu_at_lanes_f(const float* array, sli index) {
#if SL_LANES == 8
    return __builtin_ia32_gathersiv8sf((slf){0}, array, index, (slf) ~(sli){0}, 4);
#else
    slf r = {0};
    for (int i = 0; i < SL_LANES; i++)
        r[i] = array[index[i]];
    return r;
#endif
}
SL_INLINE slv slu_at_lanes_3(const slu3* array, sli index) {
    const sli at = index + index + index; /* slu3 is three floats */
    slv r;
    r.x = slu_at_lanes_f(&array->x, at);
    r.y = slu_at_lanes_f(&array->y, at);
    r.z = slu_at_lanes_f(&array->z, at);
    return r;
}
/* spline() on knots that all lanes share. */
slf slv_spline_f_shared(sl_string basis, slf x, const float* knots, int n)
    SL_SYMBOL(slv_spline_f_shared);
slv slv_spline_3_shared(sl_string basis, slf x, const slu3* knots, int n)
    SL_SYMBOL(slv_spline_3_shared);
SL_INLINE slm slu_at_lanes_m(const slum* array, sli index) {
    slm r = slv_spread_m(array[0]);
    for (int i = 0; i < SL_LANES; i++)
        for (int k = 0; k < 16; k++)
            r.m[k][i] = array[index[i]].m[k];
    return r;
}
SL_INLINE sls slu_at_lanes_s(const sl_string* array, sli index) {
    sls r;
    for (int i = 0; i < SL_LANES; i++)
        r.s[i] = array[index[i]];
    return r;
}

#endif
