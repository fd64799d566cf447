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
