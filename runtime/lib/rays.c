/* SPDX-License-Identifier: Apache-2.0
 * Functions that ask the engine for rays, for both worlds: the arguments of a call and its
 * name/value pairs become one sl_ray_query per packet. Where a surface shader may wait, its frame
 * holds the query between <body>_ask and <body>_answer; elsewhere the service `rays` fills it at
 * once. Options: sl_ray_options.def.
 */
#include "body.h"
#include "pairs.h"

/* --- the question */

/* What lanes that nobody answers have: nothing is hit, nothing is in the way. */
static void answer_nothing(sl_ray_query* q) {
    const int passes = q->kind == SL_RAYS_transmission || q->kind == SL_RAYS_shadow;
    q->hit = 0;
    slv_put_triple_(q->C, slv_f_to_3(slv_spread_f(passes ? 1.0f : 0.0f)));
    slv_put_plane_(q->distance, slv_spread_f(1e30f));
    slv_put_plane_(q->level_missed, (slf){0});
}

static void begin_rays(const sl_call* call, sl_ray_query* q, int kind, uint32_t mask) {
    q->kind = kind;
    q->first = call->first;
    q->lanes = SL_LANES;
    q->mask = mask;
    slv_put_plane_(q->angle, (slf){0});
    q->sample = 0;
    q->samples = 1;
    q->category = 0;
    q->given = 0;
#define SL_RAY_NUMBER(id, default, note)                                                           \
    slv_put_plane_(q->option[SL_RAY_OPTION_##id], slv_spread_f(default));
#define SL_RAY_TEXT(id, note) q->text[SL_RAY_TEXT_##id] = 0;
#include "sl_ray_options.def"
    q->num_channels = 0;
    answer_nothing(q);
}

static void set_number(sl_ray_query* q, int slot, slf a) {
    q->given |= 1u << slot;
    slv_put_plane_(q->option[slot], a);
}

static void slv_set_samples_(sl_ray_query* q, slf samples) {
    set_number(q, SL_RAY_OPTION_samples, samples);
}
static void slu_set_samples_(sl_ray_query* q, float samples) {
    slv_set_samples_(q, slv_spread_f(samples));
}

static void take_option(sl_ray_query* q, sl_string name, const sl_value* value) {
    if (value->array_length)
        return;
    if (value->type == SL_TYPE_string) {
#define SL_RAY_TEXT(id, note)                                                                      \
    if (same_text(name, #id))                                                                      \
        q->text[SL_RAY_TEXT_##id] = text_of(value);
#include "sl_ray_options.def"
    } else if (value->type == SL_TYPE_float) {
#define SL_RAY_NUMBER(id, default, note)                                                           \
    if (same_text(name, #id))                                                                      \
        set_number(q, SL_RAY_OPTION_##id, lanes_of(value));
#include "sl_ray_options.def"
    }
}

static int is_sent(sl_string name) {
    const char* const prefix = "send:";
    for (int i = 0; prefix[i]; i++)
        if (name[i] != prefix[i])
            return 0;
    return 1;
}

/* Floats and triples can go to the hit or come from it. */
static sl_ray_channel* add_channel(sl_ray_query* q, sl_string name, const sl_value* value) {
    const int fits = value->type != SL_TYPE_string && value->type != SL_TYPE_matrix &&
                     !value->array_length && q->num_channels < SL_RAY_CHANNELS_MAX;
    if (!fits)
        return 0;
    sl_ray_channel* const c = &q->channel[q->num_channels++];
    c->name = name;
    c->type = value->type;
    c->is_sent = 0;
    c->set = 0;
    return c;
}

static void send(sl_ray_query* q, sl_string name, const sl_value* value) {
    sl_ray_channel* const c = add_channel(q, name, value);
    if (c) {
        c->is_sent = 1;
        load_channel(value, c->values);
    }
}

/* What the call's output pairs ask for; what is not found keeps its value. */
static void ask_outputs(sl_ray_query* q, const sl_value* outputs, int n) {
    for (int i = 0; i + 1 < n; i += 2)
        add_channel(q, text_of(&outputs[i]), &outputs[i + 1]);
}

static void take_outputs(const sl_ray_query* q, sli mask, const sl_value* outputs, int n) {
    for (int i = 0; i + 1 < n; i += 2)
        for (int k = 0; k < q->num_channels; k++) {
            const sl_ray_channel* const c = &q->channel[k];
            const sli set = sl_mask(c->set) & mask;
            if (c->name == text_of(&outputs[i]) && c->type == outputs[i + 1].type && sl_any(set))
                store_channel(&outputs[i + 1], set, c->values);
        }
}

static void slv_take_outputs_(const sl_call* call, sli mask, const sl_ray_query* q,
                              const sl_value* outputs, int n) {
    (void)call;
    take_outputs(q, mask, outputs, n);
}
static void slu_take_outputs_(const sl_call* call, const sl_ray_query* q, const sl_value* outputs,
                              int n) {
    take_outputs(q, call->live, outputs, n);
}

/* The number of the ray is the same in all lanes that are still in the loop; how many there are is
 * taken from the first. */
static int whole(float x) {
    return x > 0 && x < 1e9f ? (int)x : 0;
}
static void slv_gathers_(const sl_call* call, sli mask, sl_ray_query* q, slf angle, slf sample,
                         slf samples) {
    (void)call;
    const int lane = sl_first_lane(mask);
    slv_put_plane_(q->angle, angle);
    q->sample = whole(sample[lane]);
    q->samples = whole(samples[lane]);
}
static void slu_gathers_(const sl_call* call, sl_ray_query* q, float angle, float sample,
                         float samples) {
    slv_gathers_(call, call->live, q, slv_spread_f(angle), slv_spread_f(sample),
                 slv_spread_f(samples));
}

static void report_no_light(const sl_call* call) {
    call->services->report(call->engine, 0,
                           "shadow(\"raytrace\"): there is no light here, neither a light shader "
                           "nor illuminance around it; the result is 0");
}

static void take_pairs(sl_ray_query* q, const sl_value* values, int n) {
    for (int i = 0; i + 1 < n; i += 2) {
        const sl_string name = is_text(&values[i]) ? text_of(&values[i]) : 0;
        if (is_named(name) && is_sent(name))
            send(q, name, &values[i + 1]);
        else if (is_named(name))
            take_option(q, name, &values[i + 1]);
    }
}

/* --- without waiting */

static void answer_now(const sl_call* call, sl_ray_query* q) {
    if (q->mask)
        call->services->rays(call->engine, q);
}

/* --- the answer */

static sli slv_hit_(const sl_call* call, sli mask, const sl_ray_query* q) {
    (void)call, (void)mask;
    return sl_mask(q->hit);
}
static int slu_hit_(const sl_call* call, const sl_ray_query* q) {
    return -(int)(q->hit >> sl_first_lane(call->live) & 1u);
}

#define SL_BODY "rays_body.h"
#include "sl_both_worlds.h"
