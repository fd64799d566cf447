/* SPDX-License-Identifier: Apache-2.0
 * Gradient directions of 3-D noise in both worlds: the one part of the lattice that depends on how
 * a processor looks things up. In: hash bits. Out: the vectors of noise_lattice.h.
 */
#ifndef PERIGEE_LIB_NOISE_GRADIENTS_H
#define PERIGEE_LIB_NOISE_GRADIENTS_H

#include "body.h"

/* The 3-D gradients by the lower 3 bits of `bits`; the fourth is the sign (noise_lattice.h). */
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

#endif
