/* SPDX-License-Identifier: Apache-2.0
 * marble.sl by hand: planes of `stride` floats, `count` points, count a multiple of 8. */
#ifndef PERIGEE_BENCH_MARBLE_H
#define PERIGEE_BENCH_MARBLE_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct marble_in {
    const float *P, *N, *I, *Cs, *Os;
    float scale, contrast, Ka, Kd, polish, size;
    float shader_from_current[16];
    uint32_t stride, count;
} marble_in;

void marble_lanes(const marble_in* in, float* Ci, float* Oi);

#ifdef __cplusplus
}
#endif
#endif
