/* SPDX-License-Identifier: Apache-2.0
 * marble.sl as a programmer would write it with vector extensions: no masks, constants outside the
 * loop, the spline's polynomial coefficients in tables that are looked up within registers. Noise
 * is compiled along with it, pow comes from the library. */
#include "by_hand.h"
#include "marble.h"
#include "noise.c" /* the library's, so that the compiler sees all of it */

enum { SPANS = 8, KNOTS = 11 };

static const float knots[3][KNOTS] = {
    {.93f, .93f, .86f, .74f, .52f, .31f, .20f, .12f, .08f, .05f, .05f},
    {.91f, .91f, .85f, .75f, .55f, .34f, .22f, .12f, .08f, .05f, .05f},
    {.88f, .88f, .84f, .78f, .62f, .42f, .30f, .18f, .12f, .08f, .08f}};

typedef struct cubic {
    slf c[4]; /* by span, of 1 t t^2 t^3 */
} cubic;

static cubic catmull_rom(const float* k) {
    cubic r;
    for (int i = 0; i < SPANS; i++) {
        const float a = k[i], b = k[i + 1], c = k[i + 2], d = k[i + 3];
        r.c[0][i] = b;
        r.c[1][i] = 0.5f * (c - a);
        r.c[2][i] = a - 2.5f * b + 2.0f * c - 0.5f * d;
        r.c[3][i] = 1.5f * (b - c) + 0.5f * (d - a);
    }
    return r;
}

static slf at(const cubic* p, sli span, slf t) {
    const slf c0 = __builtin_ia32_permvarsf256(p->c[0], span);
    const slf c1 = __builtin_ia32_permvarsf256(p->c[1], span);
    const slf c2 = __builtin_ia32_permvarsf256(p->c[2], span);
    const slf c3 = __builtin_ia32_permvarsf256(p->c[3], span);
    return c0 + t * (c1 + t * (c2 + t * c3));
}

static slf veins(slv q) {
    slf sum = {0};
    float amplitude = 1, frequency = 1;
    for (int octave = 0; octave < 8; octave++) {
        const slv p = {q.x * frequency, q.y * frequency, q.z * frequency};
        const slf n = 0.5f - slv_noise_f_3(p);
        sum += slv_greater_f(n, -n) * amplitude;
        amplitude *= 0.5f;
        frequency *= 2;
    }
    return sum;
}

void marble_lanes(const marble_in* in, float* Ci, float* Oi) {
    const float l = 1.0f / 3.74165738677f; /* |(1, 2, -3)| */
    const float* m = in->shader_from_current;
    const cubic stone[3] = {catmull_rom(knots[0]), catmull_rom(knots[1]), catmull_rom(knots[2])};
    const slf zero = {0}, one = slv_spread_f(1);
    for (uint32_t i = 0; i < in->count; i += SL_LANES) {
        const slv P = load3(in->P, in->stride, i);
        const slv Q = {in->scale * (P.x * m[0] + P.y * m[4] + P.z * m[8] + m[12]),
                       in->scale * (P.x * m[1] + P.y * m[5] + P.z * m[9] + m[13]),
                       in->scale * (P.x * m[2] + P.y * m[6] + P.z * m[10] + m[14])};
        const slf x =
            slv_lesser_f(one, slv_greater_f(zero, in->contrast * veins(Q))) * (float)SPANS;
        const slf whole = slv_lesser_f(slv_floor(x), slv_spread_f(SPANS - 1));
        const sli span = slv_int_of_f(whole);
        const slf t = x - whole;
        const slv I = load3(in->I, in->stride, i);
        slv N = unit(load3(in->N, in->stride, i));
        const slf flip = slv_select_f(dot(I, N) > 0.0f, slv_spread_f(-1), one);
        N = slv_scale_3(N, flip);
        const slv d = unit(I);
        const slf twice = dot(d, N) * 2.0f;
        const slv R = {d.x - twice * N.x, d.y - twice * N.y, d.z - twice * N.z};
        const slf lambert = slv_greater_f(zero, N.x * l + N.y * (2 * l) - N.z * (3 * l));
        const slf mirror = slv_greater_f(zero, R.x * l + R.y * (2 * l) - R.z * (3 * l));
        const slf base = in->Ka + in->Kd * lambert;
        const slf high = in->polish * slv_pow(mirror, slv_spread_f(in->size));
        for (uint32_t c = 0; c < 3; c++) {
            slf Cs, Os;
            __builtin_memcpy(&Cs, in->Cs + c * in->stride + i, sizeof(slf));
            __builtin_memcpy(&Os, in->Os + c * in->stride + i, sizeof(slf));
            const slf result = Os * (Cs * at(&stone[c], span, t) * base + high);
            __builtin_memcpy(Ci + c * in->stride + i, &result, sizeof(slf));
            __builtin_memcpy(Oi + c * in->stride + i, &Os, sizeof(slf));
        }
    }
}
