/* SPDX-License-Identifier: Apache-2.0
 * The built-in noise functions and cell noise, one text per world, on the lattice of
 * noise_lattice.h, which holds the definition; included by noise.c.
 */

F FN(noise_f_1)(F x) {
    return FN(value_1_)(OPEN_X(1, x), NOISE_C0);
}
F FN(noise_f_2)(F x, F y) {
    return FN(value_2_)(OPEN_X(2, x), OPEN_Y(y), NOISE_C0);
}
F FN(noise_f_3)(V p) {
    return FN(value_3_)(OPEN_X(3, p.x), OPEN_Y(p.y), OPEN_Z(p.z), NOISE_C0);
}
F FN(noise_f_4)(V p, F t) {
    return FN(value_4_)(OPEN_X(4, p.x), OPEN_Y(p.y), OPEN_Z(p.z), OPEN_T(t), NOISE_C0);
}
V FN(noise_3_1)(F x) {
    return FN(channels_1_)(OPEN_X(1, x));
}
V FN(noise_3_2)(F x, F y) {
    return FN(channels_2_)(OPEN_X(2, x), OPEN_Y(y));
}
V FN(noise_3_3)(V p) {
    return FN(channels_3_)(OPEN_X(3, p.x), OPEN_Y(p.y), OPEN_Z(p.z));
}
V FN(noise_3_4)(V p, F t) {
    return FN(channels_4_)(OPEN_X(4, p.x), OPEN_Y(p.y), OPEN_Z(p.z), OPEN_T(t));
}
F FN(pnoise_f_1)(F x, F px) {
    return FN(value_1_)(CLOSED_X(1, x, px), NOISE_C0);
}
F FN(pnoise_f_2)(F x, F y, F px, F py) {
    return FN(value_2_)(CLOSED_X(2, x, px), CLOSED_Y(y, py), NOISE_C0);
}
F FN(pnoise_f_3)(V p, V pp) {
    return FN(value_3_)(CLOSED_X(3, p.x, pp.x), CLOSED_Y(p.y, pp.y), CLOSED_Z(p.z, pp.z), NOISE_C0);
}
F FN(pnoise_f_4)(V p, F t, V pp, F pt) {
    return FN(value_4_)(CLOSED_X(4, p.x, pp.x), CLOSED_Y(p.y, pp.y), CLOSED_Z(p.z, pp.z),
                        CLOSED_T(t, pt), NOISE_C0);
}
V FN(pnoise_3_1)(F x, F px) {
    return FN(channels_1_)(CLOSED_X(1, x, px));
}
V FN(pnoise_3_2)(F x, F y, F px, F py) {
    return FN(channels_2_)(CLOSED_X(2, x, px), CLOSED_Y(y, py));
}
V FN(pnoise_3_3)(V p, V pp) {
    return FN(channels_3_)(CLOSED_X(3, p.x, pp.x), CLOSED_Y(p.y, pp.y), CLOSED_Z(p.z, pp.z));
}
V FN(pnoise_3_4)(V p, F t, V pp, F pt) {
    return FN(channels_4_)(CLOSED_X(4, p.x, pp.x), CLOSED_Y(p.y, pp.y), CLOSED_Z(p.z, pp.z),
                           CLOSED_T(t, pt));
}

/* --- cells
 * --------------------------------------------------------------------------------------------------------
 */

SL_INLINE I FN(cell_)(F a, uint32_t prime) {
    return FN(mul_i)(FN(cell_index_)(a), prime);
}

SL_INLINE I FN(cell_1_)(F x) {
    return FN(add_i)(FN(cell_)(x, NOISE_P0), KI((int)CELL_SEED));
}
SL_INLINE I FN(cell_2_)(F x, F y) {
    const I seeded = FN(add_i)(FN(cell_)(x, NOISE_P0), KI((int)(2 * CELL_SEED)));
    return seeded ^ FN(cell_)(y, NOISE_P1);
}
SL_INLINE I FN(cell_3_)(V p) {
    const I seeded = FN(add_i)(FN(cell_)(p.x, NOISE_P0), KI((int)(3 * CELL_SEED)));
    return seeded ^ FN(cell_)(p.y, NOISE_P1) ^ FN(cell_)(p.z, NOISE_P2);
}
SL_INLINE I FN(cell_4_)(V p, F t) {
    const I seeded = FN(add_i)(FN(cell_)(p.x, NOISE_P0), KI((int)(4 * CELL_SEED)));
    return seeded ^ FN(cell_)(p.y, NOISE_P1) ^ FN(cell_)(p.z, NOISE_P2) ^ FN(cell_)(t, NOISE_P3);
}

F FN(cellnoise_f_1)(F x) {
    return FN(cell_value_)(FN(cell_1_)(x), x * 0.0f);
}
F FN(cellnoise_f_2)(F x, F y) {
    return FN(cell_value_)(FN(cell_2_)(x, y), x * 0.0f + y * 0.0f);
}
F FN(cellnoise_f_3)(V p) {
    return FN(cell_value_)(FN(cell_3_)(p), p.x * 0.0f + p.y * 0.0f + p.z * 0.0f);
}
F FN(cellnoise_f_4)(V p, F t) {
    return FN(cell_value_)(FN(cell_4_)(p, t), p.x * 0.0f + p.y * 0.0f + p.z * 0.0f + t * 0.0f);
}
V FN(cellnoise_3_1)(F x) {
    return FN(cell_channels_)(FN(cell_1_)(x), x * 0.0f);
}
V FN(cellnoise_3_2)(F x, F y) {
    return FN(cell_channels_)(FN(cell_2_)(x, y), x * 0.0f + y * 0.0f);
}
V FN(cellnoise_3_3)(V p) {
    return FN(cell_channels_)(FN(cell_3_)(p), p.x * 0.0f + p.y * 0.0f + p.z * 0.0f);
}
V FN(cellnoise_3_4)(V p, F t) {
    return FN(cell_channels_)(FN(cell_4_)(p, t), p.x * 0.0f + p.y * 0.0f + p.z * 0.0f + t * 0.0f);
}
