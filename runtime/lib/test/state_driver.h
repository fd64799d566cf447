/* SPDX-License-Identifier: Apache-2.0
 * Strings, messages and queries as emitted code calls them, without vector types. `lanes` values
 * are SL_LANES floats per component or SL_LANES strings; every call is about the first packet of
 * the batch.
 */
#ifndef PERIGEE_STATE_DRIVER_H
#define PERIGEE_STATE_DRIVER_H

#include "sl_abi.h"

#ifdef __cplusplus
extern "C" {
#endif

enum {
    DRIVER_rayinfo = 100 /* after the SL_MESSAGE_* kinds */
};

typedef struct state_driver {
    int lanes;
    void (*print)(const sl_batch* batch, uint32_t mask, int uniform, sl_string format,
                  const sl_value* values, int n);
    /* per lane; uniform: result[0] */
    void (*format)(const sl_batch* batch, uint32_t mask, int uniform, sl_string format,
                   const sl_value* values, int n, sl_string* result);
    void (*concat)(const sl_batch* batch, int uniform, const sl_string* parts, int n,
                   sl_string* result);
    float (*match)(const sl_batch* batch, int uniform, sl_string pattern, sl_string subject);
    /* message and query functions by kind; result: 1 or 0 per lane (uniform: result[0]) */
    void (*ask)(const sl_batch* batch, uint32_t mask, int uniform, int kind, sl_string name,
                const sl_value* out, float* result);
    /* type NULL: shadername(); label: raylabel() */
    sl_string (*shader_name)(const sl_batch* batch, int uniform, sl_string type);
    sl_string (*ray_label)(const sl_batch* batch, int uniform);
    /* shadeop with n outputs (up to 2) and two inputs */
    void (*shadeop)(const sl_batch* batch, uint32_t mask, int uniform, sl_string function,
                    const sl_value* outputs, int num_outputs, const sl_value* inputs);
    /* textureinfo and rayhittest, fulltrace outputs leave masked lanes alone: 1 if so */
    int (*outputs_respect_mask)(const sl_batch* batch);
} state_driver;

extern const state_driver state_driver_4;
extern const state_driver state_driver_8;

#ifdef __cplusplus
}
#endif
#endif
