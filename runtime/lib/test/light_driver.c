/* SPDX-License-Identifier: Apache-2.0
 * light_driver for the width this file is compiled for; written as the emitter writes light
 * statements.
 */
#include "light_driver.h"

#include "sl_shader.h"

#include <string.h>

static sli odd_lanes(void) {
    sli r;
    for (int i = 0; i < SL_LANES; i++)
        r[i] = i % 2 ? -1 : 0;
    return r;
}

static void count_lights(const sl_batch* batch, sl_string category, float stop_after, float* count,
                         int n) {
    for (int i = 0; i < n; i += SL_LANES) {
        sl_call call;
        sl_call_begin(&call, batch, (uint32_t)i, (uint32_t)(n - i < SL_LANES ? n - i : SL_LANES));
        slf seen = {0};
        sl_light_loop loop;
        sl_lights_begin(&call, &loop, call.live, slv_var_3(&call, SL_VAR_P), category);
        for (sli lit; sl_lights_next(&call, &loop, &lit);) {
            seen += slv_f_of_mask(lit);
            loop.live &= ~(odd_lanes() & (seen >= stop_after));
        }
        memcpy(count + i, &seen, sizeof seen);
    }
}

static void count_in_cone(const sl_batch* batch, const float* axis, float angle, float* count,
                          int n) {
    for (int i = 0; i < n; i += SL_LANES) {
        sl_call call;
        sl_call_begin(&call, batch, (uint32_t)i, SL_LANES);
        slf seen = {0};
        sl_light_loop loop;
        sl_lights_begin_cone(&call, &loop, call.live, slv_var_3(&call, SL_VAR_P),
                             slv_spread_3(slu_make_3(axis[0], axis[1], axis[2])),
                             slv_spread_f(angle), "");
        for (sli lit; sl_lights_next(&call, &loop, &lit);)
            seen += slv_f_of_mask(lit);
        memcpy(count + i, &seen, sizeof seen);
    }
}

static void put(float* to, slf v) {
    memcpy(to, &v, sizeof v);
}

static void put_3(float (*to)[SL_LANES_MAX], slv v) {
    put(to[0], v.x), put(to[1], v.y), put(to[2], v.z);
}

static void illuminate(const sl_batch* batch, float angle, light_result* result) {
    sl_call call;
    slv L;
    const slv origin = slv_f_to_3((slf){0});
    const slv z = slv_make_3((slf){0}, (slf){0}, slv_spread_f(3));
    sl_call_begin(&call, batch, 0, SL_LANES);
    batch->lit[0] = 0;
    put(result->cone,
        slv_f_of_mask(sl_illuminate_cone(&call, call.live, origin, z, slv_spread_f(angle), &L)));
    result->lit_by_cone = batch->lit[0];
    put(result->all, slv_f_of_mask(sl_illuminate(&call, call.live, origin, &L)));
    put_3(result->L, L);
    sl_solar(&call, call.live, &L);
    put_3(result->solar_L, L);
    sl_solar_cone(&call, call.live, slv_make_3((slf){0}, slv_spread_f(-7), (slf){0}), (slf){0}, &L);
    put_3(result->axis_L, L);
}

#if SL_LANES == 8
const light_driver light_driver_8
#else
const light_driver light_driver_4
#endif
    = {SL_LANES, count_lights, count_in_cone, illuminate};
