/* SPDX-License-Identifier: Apache-2.0
 * state_driver for the width this file is compiled for.
 */
#include "state_driver.h"

#include "sl_shader.h"

#include <string.h>

static sl_call begin(const sl_batch* batch) {
    sl_call call;
    sl_call_begin(&call, batch, 0, batch->count < SL_LANES ? batch->count : SL_LANES);
    return call;
}

static void print(const sl_batch* batch, uint32_t mask, int uniform, sl_string format,
                  const sl_value* values, int n) {
    sl_call call = begin(batch);
    call.counters = &call.own_counters;
    if (uniform)
        slu_printf(&call, format, values, n);
    else
        slv_printf(&call, sl_mask(mask), format, values, n);
}

static void format(const sl_batch* batch, uint32_t mask, int uniform, sl_string text,
                   const sl_value* values, int n, sl_string* result) {
    const sl_call call = begin(batch);
    if (uniform) {
        result[0] = slu_format(&call, text, values, n);
        return;
    }
    const sls s = slv_format(&call, sl_mask(mask), text, values, n);
    memcpy(result, s.s, sizeof s.s);
}

static void concat(const sl_batch* batch, int uniform, const sl_string* parts, int n,
                   sl_string* result) {
    const sl_call call = begin(batch);
    result[0] = uniform ? slu_concat(&call, parts, n)
                        : slv_concat(&call, call.live, parts, n).s[SL_LANES - 1];
}

static float match(const sl_batch* batch, int uniform, sl_string pattern, sl_string subject) {
    const sl_call call = begin(batch);
    return uniform ? slu_match(&call, pattern, subject)
                   : slv_match(&call, call.live, pattern, subject)[SL_LANES - 1];
}

static void shadeop(const sl_batch* batch, uint32_t mask, int uniform, sl_string function,
                    const sl_value* outputs, int num_outputs, const sl_value* inputs) {
    const sl_call call = begin(batch);
    const sli m = sl_mask(mask);
    if (uniform && num_outputs == 0)
        slu_shadeop_0(&call, function, inputs, 2);
    else if (uniform && num_outputs == 1)
        slu_shadeop_1(&call, function, &outputs[0], inputs, 2);
    else if (uniform)
        slu_shadeop_2(&call, function, &outputs[0], &outputs[1], inputs, 2);
    else if (num_outputs == 0)
        slv_shadeop_0(&call, m, function, inputs, 2);
    else if (num_outputs == 1)
        slv_shadeop_1(&call, m, function, &outputs[0], inputs, 2);
    else
        slv_shadeop_2(&call, m, function, &outputs[0], &outputs[1], inputs, 2);
}

typedef float ask_uniform(const sl_call* call, sl_string name, const sl_value* out);
typedef slf ask_lanes(const sl_call* call, sli mask, sl_string name, const sl_value* out);

static void ask(const sl_batch* batch, uint32_t mask, int uniform, int kind, sl_string name,
                const sl_value* out, float* result) {
    static const struct {
        int kind;
        ask_uniform* uniform;
        ask_lanes* lanes;
    } rows[] = {
        {SL_MESSAGE_lightsource, slu_message_lightsource, slv_message_lightsource},
        {SL_MESSAGE_surface, slu_message_surface, slv_message_surface},
        {SL_MESSAGE_displacement, slu_message_displacement, slv_message_displacement},
        {SL_MESSAGE_atmosphere, slu_message_atmosphere, slv_message_atmosphere},
        {SL_MESSAGE_incident, slu_message_incident, slv_message_incident},
        {SL_MESSAGE_opposite, slu_message_opposite, slv_message_opposite},
        {SL_MESSAGE_attribute, slu_message_attribute, slv_message_attribute},
        {SL_MESSAGE_option, slu_message_option, slv_message_option},
        {SL_MESSAGE_rendererinfo, slu_message_rendererinfo, slv_message_rendererinfo},
        {DRIVER_rayinfo, slu_rayinfo, slv_rayinfo},
    };
    sl_call call = begin(batch);
    sl_light_loop loop = {0};
    if (kind == SL_MESSAGE_lightsource) /* as if inside illuminance */
        call.lights = &loop;
    for (unsigned i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        if (rows[i].kind != kind)
            continue;
        if (uniform) {
            result[0] = rows[i].uniform(&call, name, out);
            return;
        }
        const slf r = rows[i].lanes(&call, sl_mask(mask), name, out);
        memcpy(result, &r, sizeof r);
    }
}

static sl_string shader_name(const sl_batch* batch, int uniform, sl_string type) {
    const sl_call call = begin(batch);
    if (uniform)
        return type ? slu_shadername_of(&call, type) : slu_shadername(&call);
    const sls s =
        type ? slv_shadername_of(&call, call.live, type) : slv_shadername(&call, call.live);
    return s.s[SL_LANES - 1];
}

static sl_string ray_label(const sl_batch* batch, int uniform) {
    const sl_call call = begin(batch);
    return uniform ? slu_raylabel(&call) : slv_raylabel(&call, call.live).s[0];
}

static int outputs_respect_mask(const sl_batch* batch) {
    const sl_call call = begin(batch);
    const slv seven = slv_f_to_3(slv_spread_f(7));
    slv a = seven, b = seven, c = seven, d = seven, e = seven;
    slf f = seven.x;
    const sli mask = sl_mask(1);
    slv_rayhittest(&call, mask, seven, seven, &a, &b);
    int untouched = a.x[1] == 7 && b.z[2] == 7 && b.z[0] == 0;
    slv_fulltrace(&call, mask, seven, seven, &a, &f, &b, &c, &d, &e);
    untouched &=
        a.y[1] == 7 && f[1] == 7 && b.x[3] == 7 && c.x[3] == 7 && d.x[2] == 7 && f[0] == 1e30f;
    return untouched;
}

#if SL_LANES == 8
const state_driver state_driver_8
#else
const state_driver state_driver_4
#endif
    = {SL_LANES, print,       format,    concat,  match,
       ask,      shader_name, ray_label, shadeop, outputs_respect_mask};
