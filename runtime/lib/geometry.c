/* SPDX-License-Identifier: Apache-2.0
 * Matrices, transforms and the larger geometric functions for both worlds.
 */
#include "body.h"

#include <stddef.h>

/* A matrix the engine answers with: planes of lanes (one matrix per lane), or 16 floats for all. */
typedef union space_matrix {
    slm lanes;
    float values[16 * SL_LANES_MAX];
} space_matrix;

static slum uniform_matrix(const float* values, int step, int lane) {
    slum m;
    for (int i = 0; i < 16; i++)
        m.m[i] = values[i * step + lane];
    return m;
}

/* Unknown spaces were reported by the engine and count as current. NULL is current. */
static slum slu_space_(const sl_call* call, sl_string from, sl_string to) {
    space_matrix m;
    const int kind = call->services->space(call->engine, from, to, call->first, m.values);
    if (kind == 2)
        return uniform_matrix(m.values, SL_LANES, sl_first_lane(call->live));
    return uniform_matrix(m.values, 1, 0);
}

static slm slv_space_(const sl_call* call, sli mask, sl_string from, sl_string to) {
    (void)mask;
    space_matrix m;
    const int kind = call->services->space(call->engine, from, to, call->first, m.values);
    if (kind == 2)
        return m.lanes;
    return slv_spread_m(uniform_matrix(m.values, 1, 0));
}

/* A predefined variable; in the uniform world that of the first live point. */
static slv slv_point_var_(const sl_call* call, sli mask, int id) {
    (void)mask;
    return slv_var_3(call, id);
}

static slu3 slu_point_var_(const sl_call* call, int id) {
    return slv_lane_3(slv_var_3(call, id), sl_first_lane(call->live));
}

#define SL_BODY "geometry_body.h"
#include "sl_both_worlds.h"
#define SL_BODY "diff_geometry_body.h"
#include "sl_both_worlds.h"
