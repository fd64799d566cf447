/* SPDX-License-Identifier: Apache-2.0
 * noise, pnoise, cellnoise and random for both worlds; the definition is in noise_lattice.h.
 */
#include "noise_gradients.h"

#define SL_BODY "noise_lattice.h"
#include "sl_both_worlds.h"
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
