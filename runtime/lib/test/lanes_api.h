/* SPDX-License-Identifier: Apache-2.0
 * Calls built-in bodies from tests by name at widths 1, 4 and 8, without vector types in the test:
 * arguments and results are planes of floats, one per component. A case is one body with its string
 * arguments fixed (cases.h).
 */
#ifndef PERIGEE_LANES_API_H
#define PERIGEE_LANES_API_H

#include "sl_abi.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct lanes_case {
    const char* name;
    const char* body; /* body column of sl_builtins.def, or an operator */
    int num_in, num_out;
} lanes_case;

typedef struct lanes_api {
    int lanes;
    int num_cases;
    const lanes_case* cases;
    /* Runs points 0 .. n-1. uniform: one point after the other through the slu_ body, else packets
     * through slv_. in and out have room for n rounded up to 8. batch may be NULL for cases that
     * read none. */
    void (*run)(int case_index, int uniform, const sl_batch* batch, const float* const* in,
                float* const* out, int n);
} lanes_api;

extern const lanes_api lanes_api_4;
extern const lanes_api lanes_api_8;

#ifdef __cplusplus
}
#endif
#endif
