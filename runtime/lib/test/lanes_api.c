/* SPDX-License-Identifier: Apache-2.0
 * lanes_api for the width this file is compiled for.
 */
#include "lanes_api.h"

#include "body.h"

#include <string.h>

/* Scratch for outputs of calls that a case does not check. */
typedef void uniform_case(const sl_call* call, const float* const* in, float* const* out, int i);
typedef void lanes_case_function(const sl_call* call, sli mask, const float* const* in,
                                 float* const* out, int i);

static float slu_get_(const float* plane, int i) {
    return plane[i];
}
static slf slv_get_(const float* plane, int i) {
    slf v;
    memcpy(&v, plane + i, sizeof v);
    return v;
}
static void slu_put_(float* plane, int i, float v) {
    plane[i] = v;
}
static void slv_put_(float* plane, int i, slf v) {
    memcpy(plane + i, &v, sizeof v);
}

#define SL_BODY "cases.h"
#include "sl_both_worlds.h"

#undef CASE
#define CASE(name, body, num_in, num_out, ...) {#name, #body, num_in, num_out},
#define CASES_ONLY
static const lanes_case cases[] = {
#include "cases.h"
};
#undef CASE
#define CASE(name, body, num_in, num_out, ...) slu_case_##name,
static uniform_case* const uniform_cases[] = {
#include "cases.h"
};
#undef CASE
#define CASE(name, body, num_in, num_out, ...) slv_case_##name,
static lanes_case_function* const lanes_cases[] = {
#include "cases.h"
};

static void run_packet(int k, int uniform, const sl_batch* batch, int i, int count,
                       const float* const* in, float* const* out) {
    sl_call call;
    sl_call_begin(&call, batch, (uint32_t)i, (uint32_t)count);
    if (!uniform) {
        lanes_cases[k](&call, call.live, in, out, i);
        return;
    }
    for (int lane = 0; lane < count; lane++) {
        call.live = sl_mask(1u << lane);
        uniform_cases[k](&call, in, out, i + lane);
    }
}

static void run(int k, int uniform, const sl_batch* batch, const float* const* in,
                float* const* out, int n) {
    sl_batch none;
    memset(&none, 0, sizeof none);
    for (int i = 0; i < n; i += SL_LANES)
        run_packet(k, uniform, batch ? batch : &none, i, n - i < SL_LANES ? n - i : SL_LANES, in,
                   out);
}

#if SL_LANES == 8
const lanes_api lanes_api_8
#else
const lanes_api lanes_api_4
#endif
    = {SL_LANES, sizeof cases / sizeof cases[0], cases, run};
