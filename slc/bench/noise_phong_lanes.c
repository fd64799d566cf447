/* SPDX-License-Identifier: Apache-2.0
 * What a programmer would write with vector extensions for eight points at once: no masks, because
 * nothing diverges, reciprocals and constants hoisted. Noise is compiled along with it, pow comes
 * from the library. */
#include "by_hand.h"
#include "noise.c" /* the library's, so that the compiler sees all of it */
#include "noise_phong.h"

void noise_phong_lanes(const noise_phong_in* in, float* Ci, float* Oi) {
    const float l = 1.0f / 3.74165738677f; /* |(1, 2, -3)| */
    for (uint32_t i = 0; i < in->count; i += SL_LANES) {
        const slv P = load3(in->P, in->stride, i);
        slf sum = {0};
        float amplitude = 0.5f, frequency = 1;
        for (int octave = 0; octave < 8; octave++) {
            const slv p = {P.x * frequency, P.y * frequency, P.z * frequency};
            sum += slv_noise_f_3(p) * amplitude;
            amplitude *= 0.5f;
            frequency *= 2;
        }
        const slv I = load3(in->I, in->stride, i);
        slv N = unit(load3(in->N, in->stride, i));
        const slf flip = slv_select_f(dot(I, N) > 0.0f, slv_spread_f(-1), slv_spread_f(1));
        N = slv_scale_3(N, flip);
        const slv d = unit(I);
        const slf twice = dot(d, N) * 2.0f;
        const slv R = {d.x - twice * N.x, d.y - twice * N.y, d.z - twice * N.z};
        const slf zero = {0};
        const slf lambert = slv_max_f(zero, N.x * l + N.y * (2 * l) - N.z * (3 * l));
        const slf shine = slv_max_f(zero, R.x * l + R.y * (2 * l) - R.z * (3 * l));
        const slf base = sum * (in->Ka + in->Kd * lambert);
        const slf high = in->Ks * slv_pow(shine, slv_spread_f(in->size));
        for (uint32_t c = 0; c < 3; c++) {
            slf Cs, Os;
            __builtin_memcpy(&Cs, in->Cs + c * in->stride + i, sizeof(slf));
            __builtin_memcpy(&Os, in->Os + c * in->stride + i, sizeof(slf));
            const slf result = Os * (Cs * base + high);
            __builtin_memcpy(Ci + c * in->stride + i, &result, sizeof(slf));
            __builtin_memcpy(Oi + c * in->stride + i, &Os, sizeof(slf));
        }
    }
}
