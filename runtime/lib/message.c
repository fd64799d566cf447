/* SPDX-License-Identifier: Apache-2.0
 * Message passing and state queries through the engine's services; reference/sl.md 4.8. Each
 * function gives 1 and the value where the engine knows it, 0 and the old value elsewhere.
 */
#include "body.h"

#include <stdlib.h>
#include <string.h>

static int components_of(int type) {
    return type == SL_TYPE_float ? 1 : type == SL_TYPE_matrix ? 16 : 3;
}

static int elements_of(const sl_value* value) {
    return value->array_length > 0 ? value->array_length : 1;
}

/* --- lanes
 * --------------------------------------------------------------------------------------------------------
 */

/* Questions about a light go with what its loop asked. */
static uint32_t post(const sl_call* call, uint32_t mask, int kind, sl_string name,
                     const sl_value* out, float* planes) {
    if (kind != SL_MESSAGE_lightsource)
        return call->services->message(call->engine, kind, name, out->type, out->array_length,
                                       call->first, mask, planes);
    const sl_light_loop* loop = call->lights;
    if (!loop)
        return 0;
    const sl_light_query query =
        sl_lights_query(call, loop, loop->at_index, loop->at_sample, sl_mask(mask));
    return call->services->light_message(call->engine, &query, name, out->type, out->array_length,
                                         planes);
}

/* A varying variable is planes already. */
static uint32_t ask_lanes(const sl_call* call, uint32_t mask, int kind, sl_string name,
                          const sl_value* out) {
    return post(call, mask, kind, name, out, (float*)out->data) & mask;
}

/* --- uniform variables: asked for one lane, then that lane is taken
 * -------------------------------------------------- */

static void take_lane(const sl_value* out, const float* planes, int lane) {
    const int n = elements_of(out) * components_of(out->type);
    for (int i = 0; i < n; i++)
        ((float*)out->data)[i] = planes[i * SL_LANES + lane];
}

static void take_string_lane(const sl_value* out, const sl_string* strings, int lane) {
    for (int i = 0; i < elements_of(out); i++)
        ((sl_string*)out->data)[i] = strings[i * SL_LANES + lane];
}

static int ask_one(const sl_call* call, int lane, int kind, sl_string name, const sl_value* out) {
    enum { SMALL = 1024 };
    _Alignas(64) unsigned char small[SMALL];
    const int is_string = out->type == SL_TYPE_string;
    const size_t item =
        is_string ? sizeof(sl_string) : sizeof(float) * (size_t)components_of(out->type);
    const size_t size = (size_t)elements_of(out) * item * SL_LANES;
    void* planes = size <= SMALL ? small : aligned_alloc(64, (size + 63) / 64 * 64);
    if (!planes)
        return 0;
    memset(planes, 0, size);
    const uint32_t bit = 1u << lane;
    const int set = (post(call, bit, kind, name, out, planes) & bit) != 0;
    if (set && is_string)
        take_string_lane(out, planes, lane);
    else if (set)
        take_lane(out, planes, lane);
    if (planes != small)
        free(planes);
    return set;
}

static slf slv_ask_(const sl_call* call, sli mask, int kind, sl_string name, const sl_value* out) {
    if (sl_none(mask))
        return (slf){0};
    if (out->varying)
        return slv_f_of_mask(sl_mask(ask_lanes(call, sl_bits(mask), kind, name, out)));
    return slv_f_of_mask(mask) * (float)ask_one(call, sl_first_lane(mask), kind, name, out);
}

static float slu_ask_(const sl_call* call, int kind, sl_string name, const sl_value* out) {
    if (out->varying)
        return slv_any(slv_ask_(call, call->live, kind, name, out) != (slf){0}) ? 1.0f : 0.0f;
    return (float)ask_one(call, sl_first_lane(call->live), kind, name, out);
}

/* --- rayinfo
 * ---------------------------------------------------------------------------------------------------------
 */

static const char* ray_type_name(int kind) {
    switch (kind) {
    case SL_RAY_reflection:
        return "specular";
    case SL_RAY_shadow:
        return "transmission";
    case SL_RAY_diffuse:
        return "diffuse";
    default:
        return "camera";
    }
}

static int put_string(const sl_call* call, sli mask, const sl_value* out, const char* text) {
    if (out->type != SL_TYPE_string || out->array_length)
        return 0;
    const sl_string s = call->services->intern(call->engine, text);
    if (!out->varying)
        *(sl_string*)out->data = s;
    else
        *(sls*)out->data = slv_select_s(mask, slv_spread_s(s), *(sls*)out->data);
    return 1;
}

static int put_float(sli mask, const sl_value* out, slf x) {
    if (out->type != SL_TYPE_float || out->array_length)
        return 0;
    if (!out->varying)
        *(float*)out->data = x[sl_first_lane(mask)];
    else
        *(slf*)out->data = slv_select_f(mask, x, *(slf*)out->data);
    return 1;
}

static int put_triple(sli mask, const sl_value* out, slv v) {
    if (components_of(out->type) != 3 || out->type == SL_TYPE_string || out->array_length)
        return 0;
    if (!out->varying)
        *(slu3*)out->data = slv_lane_3(v, sl_first_lane(mask));
    else
        *(slv*)out->data = slv_select_3(mask, v, *(slv*)out->data);
    return 1;
}

/* The ray itself, from I and P where the batch has them. */
static int put_ray(const sl_call* call, sli mask, const char* key, const sl_value* out) {
    const sl_points* points = call->batch ? call->batch->main : 0;
    if (!points || !points->var[SL_VAR_I])
        return 0;
    const slv ray = slv_var_3(call, SL_VAR_I);
    if (!strcmp(key, "length"))
        return put_float(mask, out, slv_length(ray));
    if (!strcmp(key, "direction"))
        return put_triple(mask, out, slv_normalize(ray));
    if (!strcmp(key, "origin") && points->var[SL_VAR_P])
        return put_triple(mask, out, slv_sub_3(slv_var_3(call, SL_VAR_P), ray));
    return 0;
}

static int ray_info(const sl_call* call, sli mask, sl_string key, const sl_value* out) {
    const int kind = call->services->ray_kind(call->engine);
    const float level = (float)call->services->raylevel(call->engine);
    if (!key)
        return 0;
    if (!strcmp(key, "type"))
        return put_string(call, mask, out, ray_type_name(kind));
    if (!strcmp(key, "label"))
        return put_string(call, mask, out, "");
    if (!strcmp(key, "depth"))
        return put_float(mask, out, slv_spread_f(level));
    if (!strcmp(key, "diffusedepth"))
        return put_float(mask, out, slv_spread_f(kind == SL_RAY_diffuse ? level : 0));
    if (!strcmp(key, "speculardepth"))
        return put_float(mask, out, slv_spread_f(kind == SL_RAY_reflection ? level : 0));
    if (!strcmp(key, "shadowdepth"))
        return put_float(mask, out, slv_spread_f(kind == SL_RAY_shadow ? level : 0));
    return put_ray(call, mask, key, out);
}

/* The engine knows more of each ray; what it does not answer follows from the packet. */
slf slv_rayinfo(const sl_call* call, sli mask, sl_string key, const sl_value* out) {
    const slf told = key ? slv_ask_(call, mask, SL_MESSAGE_ray, key, out) : (slf){0};
    const sli rest = mask & (told == 0.0f);
    if (sl_none(rest))
        return told;
    return slv_select_f(rest, slv_spread_f((float)ray_info(call, rest, key, out)), told);
}

float slu_rayinfo(const sl_call* call, sl_string key, const sl_value* out) {
    if (key && slu_ask_(call, SL_MESSAGE_ray, key, out) != 0)
        return 1;
    return (float)ray_info(call, call->live, key, out);
}

static sls slv_label_(const sl_call* call, sli mask) {
    sls label = slv_spread_s(call->services->intern(call->engine, ""));
    const sl_value out = {SL_TYPE_string, 1, 0, &label};
    ask_lanes(call, sl_bits(mask), SL_MESSAGE_ray, call->services->intern(call->engine, "label"),
              &out);
    return label;
}
static sl_string slu_label_(const sl_call* call) {
    return slv_lane_s(slv_label_(call, call->live), sl_first_lane(call->live));
}

/* --- strings spread to lanes
 * ------------------------------------------------------------------------------------------ */

static sl_string light_name(const sl_call* call) {
    const sl_value out = {SL_TYPE_string, 0, 0, 0};
    sl_string names[SL_LANES] = {0};
    const uint32_t bit = 1u << sl_first_lane(call->live);
    const int known = post(call, bit, SL_MESSAGE_lightsource, 0, &out, (float*)names) != 0;
    return known ? names[sl_first_lane(call->live)] : call->services->intern(call->engine, "");
}

/* shadername(type) */
static sl_string name_of(const sl_call* call, sl_string type) {
    return type && !strcmp(type, "lightsource") ? light_name(call)
                                                : call->services->shader_name(call->engine, type);
}

static sl_string slu_of_string_(sl_string s) {
    return s;
}

static sls slv_of_string_(sl_string s) {
    return slv_spread_s(s);
}

#define SL_BODY "message_body.h"
#include "sl_both_worlds.h"
