/* SPDX-License-Identifier: Apache-2.0
 * noise, pnoise, cellnoise and random for both worlds; the definition is in noise_body.h.
 */
#include "body.h"

/* The 3-D gradients by the lower 3 bits of `bits`; the fourth is the sign (noise_body.h). */
#define GRADIENT_A  0.822598f
#define GRADIENT_B  1.150362f
#define GRADIENT_D  0.997497f
#define GRADIENT_E  0.1f
#define GRADIENTS_X GRADIENT_A, -GRADIENT_A, 0, 0, GRADIENT_D, GRADIENT_D, -GRADIENT_D, -GRADIENT_D
#define GRADIENTS_Y 0, 0, GRADIENT_A, -GRADIENT_A, GRADIENT_D, -GRADIENT_D, GRADIENT_D, -GRADIENT_D
#define GRADIENTS_Z                                                                                \
    GRADIENT_B, GRADIENT_B, GRADIENT_B, GRADIENT_B, GRADIENT_E, GRADIENT_E, GRADIENT_E, GRADIENT_E

SL_INLINE slu3 slu_direction_(int bits) {
    static const float x[8] = {GRADIENTS_X}, y[8] = {GRADIENTS_Y}, z[8] = {GRADIENTS_Z};
    const int k = bits & 7;
    return slu_make_3(x[k], y[k], z[k]);
}

#if SL_LANES == 8
SL_INLINE slv
slv_direction_(sli bits) { /* the instruction looks at the lower 3 bits of each lane */
    const slf x = {GRADIENTS_X}, y = {GRADIENTS_Y}, z = {GRADIENTS_Z};
    return slv_make_3(__builtin_ia32_permvarsf256(x, bits), __builtin_ia32_permvarsf256(y, bits),
                      __builtin_ia32_permvarsf256(z, bits));
}
#else
/* No lookup within a register: the bits are spread to masks and signs. */
SL_INLINE slv slv_direction_(sli bits) {
    const sli diagonal = slv_shl_i(bits, 29) >> 31, second = slv_shl_i(bits, 30) >> 31;
    const sli sign = slv_shl_i(bits, 31),
              sign_x = (slv_shl_i(bits, 30) & diagonal) & (int)0x80000000;
    const sli a = (sli)slv_spread_f(GRADIENT_A), d = (sli)slv_spread_f(GRADIENT_D);
    const sli size = slv_select_i(diagonal, d, a);
    const sli x = (size ^ slv_select_i(diagonal, sign_x, sign)) & (diagonal | ~second);
    const sli y = (size ^ sign) & (diagonal | second);
    return slv_make_3((slf)x, (slf)y,
                      slv_select_f(diagonal, slv_spread_f(GRADIENT_E), slv_spread_f(GRADIENT_B)));
}
#endif

#define SL_BODY "noise_body.h"
#include "sl_both_worlds.h"

/* --- random: a function of the point's seed (pixel and sample), how often the lane has called it,
 * and the component -- */

SL_INLINE float slu_unit_of_(uint32_t seed, uint32_t count, uint32_t component) {
    const int h =
        slu_mul_i((int)seed, 0x9e3779b1u) ^ slu_mul_i((int)(count * 3 + component), 0x85ebca77u);
    return slu_unit_of_hash_(slu_finish_(slu_add_i(h, 0x2545f491)));
}

SL_INLINE slf slv_unit_of_(sli seed, sli count, int component) {
    const sli n = slv_add_i(slv_mul_i(count, 3), slv_spread_i(component));
    const sli h = slv_mul_i(seed, 0x9e3779b1u) ^ slv_mul_i(n, 0x85ebca77u);
    return slv_unit_of_hash_(slv_finish_(slv_add_i(h, slv_spread_i(0x2545f491))));
}

static sli seed_lanes(const sl_call* call) {
    return *(const sli*)(const void*)(call->batch->seed + call->first);
}

/* Lanes count their own calls, so a point's numbers do not depend on its neighbours in the packet.
 */
static sli next_count(const sl_call* call, sli mask) {
    const sli count = call->counters->random_lanes;
    call->counters->random_lanes = count - mask;
    return count;
}

float slu_random_f(
    const sl_call* call) { /* uniform target: one value for all points of all batches */
    return slu_unit_of_(0, call->counters->random_uniform++, 0);
}

slu3 slu_random_3(const sl_call* call) {
    const uint32_t n = call->counters->random_uniform++;
    return slu_make_3(slu_unit_of_(0, n, 0), slu_unit_of_(0, n, 1), slu_unit_of_(0, n, 2));
}

slf slv_random_f(const sl_call* call, sli mask) {
    return slv_unit_of_(seed_lanes(call), next_count(call, mask), 0);
}

slv slv_random_3(const sl_call* call, sli mask) {
    const sli seed = seed_lanes(call), n = next_count(call, mask);
    return slv_make_3(slv_unit_of_(seed, n, 0), slv_unit_of_(seed, n, 1), slv_unit_of_(seed, n, 2));
}
