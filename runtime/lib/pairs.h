/* SPDX-License-Identifier: Apache-2.0
 * What queries to the engine are filled from: planes of a packet's lanes and name/value pairs.
 * Static on purpose: a few lines for each file that asks (maps.c, rays.c).
 */
#ifndef PERIGEE_LIB_PAIRS_H
#define PERIGEE_LIB_PAIRS_H

#include "body.h"

#define PAIRS static __attribute__((unused))

PAIRS int is_named(sl_string name) {
    return name && name[0];
}

PAIRS int same_text(const char* a, const char* b) {
    while (*a && *a == *b)
        a++, b++;
    return *a == *b;
}

/* --- planes: a uniform value stands in all lanes, of which the first live one is asked */

PAIRS uint32_t slu_asked_(const sl_call* call) {
    return 1u << sl_first_lane(call->live);
}
PAIRS uint32_t slv_asked_(const sl_call* call, sli mask) {
    (void)call;
    return sl_bits(mask);
}
PAIRS void slv_put_plane_(float* plane, slf a) {
    __builtin_memcpy(plane, &a, sizeof a);
}
PAIRS void slu_put_plane_(float* plane, float a) {
    slv_put_plane_(plane, slv_spread_f(a));
}
PAIRS slf slv_get_plane_(const sl_call* call, sli mask, const float* plane) {
    (void)call, (void)mask;
    slf r;
    __builtin_memcpy(&r, plane, sizeof r);
    return r;
}
PAIRS float slu_get_plane_(const sl_call* call, const float* plane) {
    return plane[sl_first_lane(call->live)];
}
PAIRS void slv_put_triple_(float* planes, slv a) {
    slv_put_plane_(planes, a.x);
    slv_put_plane_(planes + SL_LANES, a.y);
    slv_put_plane_(planes + 2 * SL_LANES, a.z);
}
PAIRS void slu_put_triple_(float* planes, slu3 a) {
    slv_put_triple_(planes, slv_spread_3(a));
}
PAIRS slv slv_get_triple_(const sl_call* call, sli mask, const float* planes) {
    return slv_make_3(slv_get_plane_(call, mask, planes),
                      slv_get_plane_(call, mask, planes + SL_LANES),
                      slv_get_plane_(call, mask, planes + 2 * SL_LANES));
}
PAIRS slu3 slu_get_triple_(const sl_call* call, const float* planes) {
    return slv_lane_3(slv_get_triple_(call, call->live, planes), sl_first_lane(call->live));
}

/* --- outputs under the mask */

PAIRS void slu_put_masked_3(const sl_call* call, slu3* to, slu3 a) {
    (void)call;
    *to = a;
}
PAIRS void slu_put_masked_f(const sl_call* call, float* to, float a) {
    (void)call;
    *to = a;
}
PAIRS void slv_put_masked_3(const sl_call* call, sli mask, slv* to, slv a) {
    (void)call;
    *to = slv_select_3(mask, a, *to);
}
PAIRS void slv_put_masked_f(const sl_call* call, sli mask, slf* to, slf a) {
    (void)call;
    *to = slv_select_f(mask, a, *to);
}

/* --- name/value pairs */

PAIRS slf lanes_of(const sl_value* value) {
    return value->varying ? *(const slf*)value->data : slv_spread_f(*(const float*)value->data);
}

PAIRS int is_text(const sl_value* value) {
    return value->type == SL_TYPE_string && !value->array_length;
}

PAIRS sl_string text_of(const sl_value* value) {
    return value->varying ? ((const sls*)value->data)->s[0] : *(const sl_string*)value->data;
}

/* --- channels: values with a name that go to the engine or come from it */

PAIRS int components_of(int type) {
    return type == SL_TYPE_float ? 1 : type == SL_TYPE_matrix ? 16 : 3;
}

PAIRS void load_channel(const sl_value* value, float* planes) {
    for (int k = 0; k < components_of(value->type); k++)
        slv_put_plane_(planes + k * SL_LANES, value->varying
                                                  ? ((const slf*)value->data)[k]
                                                  : slv_spread_f(((const float*)value->data)[k]));
}

PAIRS void store_channel(const sl_value* value, sli set, const float* planes) {
    const sli all = sl_mask((1u << SL_LANES) - 1);
    for (int k = 0; k < components_of(value->type); k++) {
        const float* plane = planes + k * SL_LANES;
        if (value->varying) {
            slf* to = &((slf*)value->data)[k];
            *to = slv_select_f(set, slv_get_plane_(0, all, plane), *to);
        } else {
            ((float*)value->data)[k] = plane[sl_first_lane(set)];
        }
    }
}

#endif
