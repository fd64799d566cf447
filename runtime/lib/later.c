/* SPDX-License-Identifier: Apache-2.0
 * Rows of sl_builtins.def that later versions bring to life, for both worlds.
 */
#include "body.h"

/* One message per function and shader; the engine drops repetitions. */
static void report(const sl_call* call, const char* text) {
    call->services->report(call->engine, 0, text);
}

/* Normals that a batch may lack. */
static slv slv_normal_at_(const sl_call* call, sli mask, int id) {
    (void)mask;
    if (!call->batch || !call->batch->main->var[id])
        return slv_f_to_3((slf){0});
    return slv_var_3(call, id);
}
static slu3 slu_normal_at_(const sl_call* call, int id) {
    return slv_lane_3(slv_normal_at_(call, call->live, id), sl_first_lane(call->live));
}

/* du, dv; 0 outside a batch. */
static slf slv_step_at_(const sl_call* call, sli mask, int id) {
    (void)mask;
    if (!call->batch || !call->batch->main->var[id])
        return (slf){0};
    return slv_var_f(call, id);
}
static float slu_step_at_(const sl_call* call, int id) {
    return slv_lane_f(slv_step_at_(call, call->live, id), sl_first_lane(call->live));
}

#define SL_BODY "later_body.h"
#include "sl_both_worlds.h"
