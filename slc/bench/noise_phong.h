/* SPDX-License-Identifier: Apache-2.0
 * The benchmark shader of noise_phong.sl written by hand, for comparison: in lanes and point by
 * point. Planes of `stride` floats as sl_abi.h lays them out. */
#ifndef PERIGEE_NOISE_PHONG_H
#define PERIGEE_NOISE_PHONG_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct noise_phong_in {
    const float *P, *N, *I, *Cs, *Os;
    float Ka, Kd, Ks, size;
    uint32_t stride, count;
} noise_phong_in;

void noise_phong_lanes(const noise_phong_in* in, float* Ci, float* Oi);
void noise_phong_scalar(const noise_phong_in* in, float* Ci, float* Oi);

#ifdef __cplusplus
}
#endif
#endif
