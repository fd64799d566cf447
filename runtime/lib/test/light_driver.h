/* SPDX-License-Identifier: Apache-2.0
 * What an emitted shader does with light loops and light statements, callable from tests without
 * vector types.
 */
#ifndef PERIGEE_LIGHT_DRIVER_H
#define PERIGEE_LIGHT_DRIVER_H

#include "sl_abi.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct light_result {
    float all[SL_LANES_MAX], cone[SL_LANES_MAX]; /* 1 where the body ran */
    float L[3][SL_LANES_MAX], solar_L[3][SL_LANES_MAX], axis_L[3][SL_LANES_MAX];
    uint32_t lit_by_cone;
} light_result;

typedef struct light_driver {
    int lanes;
    /* illuminance(category, P): lights seen by each point; odd points break after stop_after of
     * them. */
    void (*count_lights)(const sl_batch* batch, sl_string category, float stop_after, float* count,
                         int n);
    /* illuminance(P, axis, angle) */
    void (*count_in_cone)(const sl_batch* batch, const float* axis, float angle, float* count,
                          int n);
    /* the light statements from the origin along z, for the first packet */
    void (*illuminate)(const sl_batch* batch, float angle, light_result* result);
} light_driver;

extern const light_driver light_driver_4;
extern const light_driver light_driver_8;

#ifdef __cplusplus
}
#endif
#endif
