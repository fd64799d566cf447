/* SPDX-License-Identifier: Apache-2.0
 * Transcendental functions for both worlds (math_body.h), and the range reduction of huge angles.
 */
#include "body.h"

/* x as an angle beyond the reach of math_body.h's reduction: quadrant and remainder in [-pi/4,
 * pi/4]. 2/pi is multiplied as an integer, keeping only the bits that decide the fraction of a full
 * turn [Payne83]. x = M 2^E: the wanted 96 bits of 2/pi start E-2 places after the binary
 * point. */
static float huge_remainder(float x, float* rest_tail, int* quadrant) {
    static const uint32_t two_over_pi[9] = {0,          0xa2f9836e, 0x4e441529,
                                            0xfc2757d1, 0xf534ddc0, 0xdb629599,
                                            0x3c439041, 0xfe5163ab, 0xdebbc561};
    const uint32_t bits = (uint32_t)slu_bits_of_f(x);
    const uint32_t exponent = bits >> 23 & 255;
    *quadrant = 0;
    *rest_tail = 0;
    if (exponent == 255)
        return x - x; /* NaN */
    const uint32_t mantissa = (bits & 0x7fffff) | 0x800000;
    const uint32_t shift = exponent - 150 - 2 + 32;
    uint32_t w[3];
    for (uint32_t i = 0; i < 3; i++) {
        const uint64_t pair =
            (uint64_t)two_over_pi[(shift >> 5) + i] << 32 | two_over_pi[(shift >> 5) + i + 1];
        w[i] = (uint32_t)(pair << (shift & 31) >> 32);
    }
    const uint64_t low = (uint64_t)mantissa * w[2];
    const uint64_t middle = (uint64_t)mantissa * w[1] + (low >> 32);
    const uint64_t high = (uint64_t)mantissa * w[0] + (middle >> 32);
    const uint64_t turn = high << 32 | (middle & 0xffffffff); /* fraction of a turn, 2^-64 */
    const uint64_t q4 = (turn + (1ull << 61)) >> 62;
    const int64_t rest = (int64_t)(turn - (q4 << 62));
    /* times pi/2 2^-62 = c + d, with c and the head of the product's other factor of 12 bits */
    const float c = 0x1.92p-62f, d = 0x1.fb5444p-74f;
    const float head = (float)rest, tail = (float)(rest - (int64_t)head);
    const float top = slu_f_of_bits(slu_bits_of_f(head) & (int)0xfffff000);
    const float p = top * c, q = ((head - top) * c + head * d) + tail * c;
    const float sign = bits >> 31 ? -1.0f : 1.0f;
    *quadrant = bits >> 31 ? -(int)(q4 & 3) : (int)(q4 & 3);
    *rest_tail = sign * ((p - (p + q)) + q);
    return sign * (p + q);
}

static float slu_huge_angle_(float x, int huge, float r, float* tail, int* quadrant) {
    return huge ? huge_remainder(x, tail, quadrant) : r;
}

static slf slv_huge_angle_(slf x, sli huge, slf r, slf* tail, sli* quadrant) {
    for (int i = 0; i < SL_LANES; i++)
        if (huge[i]) {
            int q;
            float t;
            r[i] = huge_remainder(x[i], &t, &q);
            (*tail)[i] = t;
            (*quadrant)[i] = q;
        }
    return r;
}

#define SL_BODY "math_body.h"
#include "sl_both_worlds.h"
#define SL_BODY "diff_math_body.h"
#include "sl_both_worlds.h"
