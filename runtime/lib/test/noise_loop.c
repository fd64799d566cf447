/* SPDX-License-Identifier: Apache-2.0
 * noise_octaves for the width this file is compiled for, and for uniform values.
 */
#include "noise_loop.h"

#include "sl_shader.h"

#include <string.h>

static slf load(const float* p) {
    slf v;
    memcpy(&v, p, sizeof v);
    return v;
}

static void lanes(const float* x, const float* y, const float* z, float* result, int n) {
    for (int i = 0; i < n; i += SL_LANES) {
        slv p = slv_make_3(load(x + i), load(y + i), load(z + i));
        slf sum = {0}, weight = slv_spread_f(1);
        for (int octave = 0; octave < 8; octave++) {
            sum += weight * slv_noise_f_3(p);
            p = slv_scale_3(p, slv_spread_f(2));
            weight *= 0.5f;
        }
        memcpy(result + i, &sum, sizeof sum);
    }
}

#if SL_LANES == 8
typedef slf change_of_noise(slv p, slv u, slv v);

static slf apart(slv p, slv u, slv v) {
    return slv_noise_f_3(p) + slv_noise_f_3_d(p, u) * slv_noise_f_3_d(p, v);
}
static slf together(slv p, slv u, slv v) {
    slf by_u, by_v;
    const slf at = slv_noise_f_3_uv(p, u, v, &by_u, &by_v);
    return at + by_u * by_v;
}
static slf by_values(slv p, slv u, slv v) {
    const slf at = slv_noise_f_3(p);
    return at + (slv_noise_f_3(slv_add_3(p, u)) - at) * (slv_noise_f_3(slv_add_3(p, v)) - at);
}

SL_INLINE void differences(change_of_noise* change, const float* const* in, float* result, int n,
                           float step) {
    for (int i = 0; i < n; i += SL_LANES) {
        slv p = slv_make_3(load(in[0] + i), load(in[1] + i), load(in[2] + i));
        slv u = slv_spread_3(slu_make_3(step, 0.3f * step, 0.1f * step));
        slv v = slv_spread_3(slu_make_3(0.1f * step, step, 0.2f * step));
        slf sum = {0}, weight = slv_spread_f(1);
        for (int octave = 0; octave < 8; octave++) {
            sum += weight * change(p, u, v);
            p = slv_scale_3(p, slv_spread_f(2));
            u = slv_scale_3(u, slv_spread_f(2));
            v = slv_scale_3(v, slv_spread_f(2));
            weight *= 0.5f;
        }
        memcpy(result + i, &sum, sizeof sum);
    }
}

void noise_differences_apart(const float* x, const float* y, const float* z, float* result, int n,
                             float step) {
    differences(apart, (const float* const[3]){x, y, z}, result, n, step);
}
void noise_differences_together(const float* x, const float* y, const float* z, float* result,
                                int n, float step) {
    differences(together, (const float* const[3]){x, y, z}, result, n, step);
}
void noise_differences_by_values(const float* x, const float* y, const float* z, float* result,
                                 int n, float step) {
    differences(by_values, (const float* const[3]){x, y, z}, result, n, step);
}

void noise_octaves_8(const float* x, const float* y, const float* z, float* result, int n) {
    lanes(x, y, z, result, n);
}
#else
void noise_octaves_4(const float* x, const float* y, const float* z, float* result, int n) {
    lanes(x, y, z, result, n);
}

void noise_octaves_1(const float* x, const float* y, const float* z, float* result, int n) {
    for (int i = 0; i < n; i++) {
        slu3 p = {x[i], y[i], z[i]};
        float sum = 0, weight = 1;
        for (int octave = 0; octave < 8; octave++) {
            sum += weight * slu_noise_f_3(p);
            p = slu_scale_3(p, 2);
            weight *= 0.5f;
        }
        result[i] = sum;
    }
}
#endif
