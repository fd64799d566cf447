/* SPDX-License-Identifier: Apache-2.0
 * What the shaders written by hand for lanes share: the limit that emitted code is measured
 * against.
 */
#pragma once

#include "sl_shader.h"

static inline slv load3(const float* p, uint32_t stride, uint32_t i) {
    slv r;
    __builtin_memcpy(&r.x, p + i, sizeof(slf));
    __builtin_memcpy(&r.y, p + stride + i, sizeof(slf));
    __builtin_memcpy(&r.z, p + 2 * stride + i, sizeof(slf));
    return r;
}

static inline slf dot(slv a, slv b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline slv unit(slv a) {
    const slf d = dot(a, a);
    const slf k = 1.0f / slv_root_f(slv_select_f(d == 0.0f, slv_spread_f(1), d));
    return slv_scale_3(a, k);
}
