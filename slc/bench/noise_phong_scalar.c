/* SPDX-License-Identifier: Apache-2.0
 * The benchmark shader point by point, as well as scalar C can do it: the noise is inlined from the
 * library's text, so that the compiler sees all of it, and pow is libm's. */
#include "noise.c" /* the library's, for the uniform functions */
#include "noise_phong.h"

#include <math.h>

typedef struct vec {
    float x, y, z;
} vec;

static vec load3(const float* p, uint32_t stride, uint32_t i) {
    const vec r = {p[i], p[stride + i], p[2 * stride + i]};
    return r;
}

static float dot(vec a, vec b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static vec unit(vec a) {
    const float d = dot(a, a);
    const float k = d > 0 ? 1 / sqrtf(d) : 1;
    const vec r = {a.x * k, a.y * k, a.z * k};
    return r;
}

void noise_phong_scalar(const noise_phong_in* in, float* Ci, float* Oi) {
    const float l = 1.0f / 3.74165738677f;
    for (uint32_t i = 0; i < in->count; i++) {
        const vec P = load3(in->P, in->stride, i);
        float sum = 0, amplitude = 0.5f, frequency = 1;
        for (int octave = 0; octave < 8; octave++) {
            sum += amplitude *
                   slu_noise_f_3(slu_make_3(P.x * frequency, P.y * frequency, P.z * frequency));
            amplitude *= 0.5f;
            frequency *= 2;
        }
        const vec I = load3(in->I, in->stride, i);
        vec N = unit(load3(in->N, in->stride, i));
        if (dot(I, N) > 0) {
            N.x = -N.x, N.y = -N.y, N.z = -N.z;
        }
        const vec d = unit(I);
        const float twice = 2 * dot(d, N);
        const vec R = {d.x - twice * N.x, d.y - twice * N.y, d.z - twice * N.z};
        const float lambert = fmaxf(0, N.x * l + N.y * (2 * l) - N.z * (3 * l));
        const float shine = fmaxf(0, R.x * l + R.y * (2 * l) - R.z * (3 * l));
        const float base = sum * (in->Ka + in->Kd * lambert);
        const float high = in->Ks * powf(shine, in->size);
        for (uint32_t c = 0; c < 3; c++) {
            const float Cs = in->Cs[c * in->stride + i], Os = in->Os[c * in->stride + i];
            Ci[c * in->stride + i] = Os * (Cs * base + high);
            Oi[c * in->stride + i] = Os;
        }
    }
}
