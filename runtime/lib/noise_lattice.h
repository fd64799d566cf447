/* SPDX-License-Identifier: Apache-2.0
 * Gradient noise, its periodic form and cell noise, one text per world. Integer hashing, no tables:
 * at 8 lanes tables cost 2.6 times as much (design.md 4). Complete definition, for independent
 * implementations:
 *
 * Lattice. Coordinate a: i = floor(a), or -2^31 where that is outside [-2^31, 2^31); f = a -
 * floor(a) (rounded to float); w = f^3 (f (6 f - 15) + 10), so the noise is twice continuously
 * differentiable. pnoise with period p: the index of a corner is floor(a) mod p, that of its upper
 * neighbour (floor(a) + 1) mod p; p is rounded (floor(p + 1/2)) and limited to [1, 2^23]. Hash
 * (32-bit unsigned arithmetic) of a corner (i, j, k, l), D = number of dimensions, for channel c =
 * 0, 1, 2: h = ((i P0 + S_D) xor (j P1) xor (k P2) xor (l P3)) C_c P = 8da6b343 b5297a4d cb1ab31f
 * a7d69b35,  S_D = 9e3779b9 D,  C = e3779b97 9d2c5681 2c1b3c6d (hexadecimal) Gradient times the
 * offset (x, y, z, t) of the point from the corner; bN is bit N of h: 1-D  (1 + b30 b29 b28 as a
 * number) x, negated if b31 2-D  u = b31 ? y : x, v the other:  (b30 ? -u : u) + 2 (b29 ? -v : v)
 *   3-D  negated if b31; b30 = 0: (+-a, 0, b) for b29 = 0, (0, +-a, b) for b29 = 1, with the sign
 * b28; b30 = 1: (+-d, +-d, e) with the signs b29, b28. a = 0.822598 b = 1.150362 d = 0.997497 e =
 * 0.1: 16 vectors of length sqrt 2 without a preferred direction (the sum of g g^T is a multiple of
 * the identity) 4-D  u = b31 and b30 ? y : x, v = b31 ? z : y, w = b31 or b30 ? t : z, signs b29
 * b28 b27 Sum: corners blended linearly by w, first along x, then y, z, t. noise = 1/2 + K_D sum, K
 * = 0.094 0.2535 0.468 0.435; |sum| in 3-D is at most 1.063, in 4-D the result is limited to [0,
 * 1]. 1/2 exactly at lattice points. NaN, inf: 1/2. cellnoise: h of the cell as above but with S_D
 * = 7f4a7c15 D and without C, for channels 1 and 2 plus 9e3779b9 and 3c6ef372, finished by h ^= h
 * >> 16; h *= 85ebca6b; h ^= h >> 13; h *= c2b2ae35; h ^= h >> 16 (MurmurHash3); the value is (h >>
 * 8) 2^-24. NaN, inf: 1/2.
 */

/* --- lattice
 * ------------------------------------------------------------------------------------------------------
 */

#define NOISE_P0 0x8da6b343u
#define NOISE_P1 0xb5297a4du
#define NOISE_P2 0xcb1ab31fu
#define NOISE_P3 0xa7d69b35u
#define NOISE_C0 0xe3779b97u
#define NOISE_C1 0x9d2c5681u
#define NOISE_C2 0x2c1b3c6du

/* One axis: hashed indices of the two corners, offset from the lower one, blending weight. */
typedef struct FN(axis_) {
    I lower, upper;
    F f, w;
} FN(axis_);

SL_INLINE F FN(fade_)(F f) {
    return f * f * f * (f * (f * 6.0f - 15.0f) + 10.0f);
}

SL_INLINE FN(axis_) FN(open_axis_)(F a, uint32_t prime, uint32_t seed) {
    const F whole = FN(floor)(a);
    FN(axis_) r;
    r.lower = FN(add_i)(FN(mul_i)(FN(whole_of_f)(whole), prime), KI((int)seed));
    r.upper = FN(add_i)(r.lower, KI((int)prime));
    r.f = a - whole;
    r.w = FN(fade_)(r.f);
    return r;
}

/* An integer modulo the period p. */
SL_INLINE F FN(wrapped_)(F whole, F p) {
    F low = whole - p * FN(floor)(whole / p);
    low = SEL(LT(low, K(0)), low + p, low); /* the quotient may round across an integer */
    return SEL(LE(p, low), low - p, low);
}

SL_INLINE FN(axis_) FN(closed_axis_)(F a, F period, uint32_t prime, uint32_t seed) {
    const F one = K(1), zero = K(0);
    const F p = FN(lesser_f)(FN(greater_f)(FN(floor)(period + 0.5f), one), K(0x1p23f));
    const F whole = FN(floor)(a), low = FN(wrapped_)(whole, p);
    const F high = SEL(LE(p, low + 1.0f), zero, low + 1.0f);
    FN(axis_) r;
    r.lower = FN(add_i)(FN(mul_i)(FN(whole_of_f)(low), prime), KI((int)seed));
    r.upper = FN(add_i)(FN(mul_i)(FN(whole_of_f)(high), prime), KI((int)seed));
    r.f = a - whole;
    r.w = FN(fade_)(r.f);
    return r;
}

SL_INLINE F FN(blend_)(F w, F a, F b) {
    return a + w * (b - a);
}

SL_INLINE F FN(flip_)(I h, int bit, F x) {
    return FLOAT(BITS(x) ^ (FN(shl_i)(h, 31 - bit) & (int)0x80000000));
}

/* A sum outside the numbers (NaN or infinite coordinates) counts as 0. */
SL_INLINE F FN(scaled_)(F sum, float k) {
    return 0.5f + FLOAT(BITS(sum * k) & FN(eq_f)(sum, sum));
}

/* --- corners: gradient times offset
 * ------------------------------------------------------------------------------- */

SL_INLINE F FN(corner_1_)(I hash, uint32_t c, F x) {
    const I h = FN(mul_i)(hash, c);
    const F g = FN(float_of_i)(FN(shr_i)(h, 28) & 7) + 1.0f;
    return FN(flip_)(h, 31, g * x);
}

SL_INLINE F FN(corner_2_)(I hash, uint32_t c, F x, F y) {
    const I h = FN(mul_i)(hash, c);
    const F u = FN(flip_)(h, 30, FN(select_sign_f)(h, y, x));
    const F v = FN(flip_)(h, 29, FN(select_sign_f)(h, x, y));
    return u + (v + v);
}

SL_INLINE F FN(corner_3_)(I hash, uint32_t c, F x, F y, F z) {
    const I h = FN(mul_i)(hash, c);
    const V g = FN(direction_)(FN(shr_i)(h, 28));
    return FN(flip_)(h, 31, g.x * x + g.y * y + g.z * z);
}

SL_INLINE F FN(corner_4_)(I hash, uint32_t c, F x, F y, F z, F t) {
    const I h = FN(mul_i)(hash, c), next = FN(shl_i)(h, 1);
    const F u = FN(select_sign_f)(h & next, y, x);
    const F v = FN(select_sign_f)(h, z, y);
    const F w = FN(select_sign_f)(h | next, t, z);
    return FN(flip_)(h, 29, u) + FN(flip_)(h, 28, v) + FN(flip_)(h, 27, w);
}

/* --- sums over the corners of a cell
 * ------------------------------------------------------------------------------ */

SL_INLINE F FN(sum_1_)(FN(axis_) x, uint32_t c) {
    const F a = FN(corner_1_)(x.lower, c, x.f);
    const F b = FN(corner_1_)(x.upper, c, x.f - 1.0f);
    return FN(blend_)(x.w, a, b);
}

SL_INLINE F FN(row_2_)(FN(axis_) x, I hy, F y, uint32_t c) {
    const F a = FN(corner_2_)(x.lower ^ hy, c, x.f, y);
    const F b = FN(corner_2_)(x.upper ^ hy, c, x.f - 1.0f, y);
    return FN(blend_)(x.w, a, b);
}

SL_INLINE F FN(sum_2_)(FN(axis_) x, FN(axis_) y, uint32_t c) {
    return FN(blend_)(y.w, FN(row_2_)(x, y.lower, y.f, c), FN(row_2_)(x, y.upper, y.f - 1.0f, c));
}

SL_INLINE F FN(row_3_)(FN(axis_) x, I hyz, F y, F z, uint32_t c) {
    const F a = FN(corner_3_)(x.lower ^ hyz, c, x.f, y, z);
    const F b = FN(corner_3_)(x.upper ^ hyz, c, x.f - 1.0f, y, z);
    return FN(blend_)(x.w, a, b);
}

SL_INLINE F FN(face_3_)(FN(axis_) x, FN(axis_) y, I hz, F z, uint32_t c) {
    return FN(blend_)(y.w, FN(row_3_)(x, y.lower ^ hz, y.f, z, c),
                      FN(row_3_)(x, y.upper ^ hz, y.f - 1.0f, z, c));
}

SL_INLINE F FN(sum_3_)(FN(axis_) x, FN(axis_) y, FN(axis_) z, uint32_t c) {
    return FN(blend_)(z.w, FN(face_3_)(x, y, z.lower, z.f, c),
                      FN(face_3_)(x, y, z.upper, z.f - 1.0f, c));
}

SL_INLINE F FN(row_4_)(FN(axis_) x, I hash, F y, F z, F t, uint32_t c) {
    const F a = FN(corner_4_)(x.lower ^ hash, c, x.f, y, z, t);
    const F b = FN(corner_4_)(x.upper ^ hash, c, x.f - 1.0f, y, z, t);
    return FN(blend_)(x.w, a, b);
}

SL_INLINE F FN(face_4_)(FN(axis_) x, FN(axis_) y, I hash, F z, F t, uint32_t c) {
    return FN(blend_)(y.w, FN(row_4_)(x, y.lower ^ hash, y.f, z, t, c),
                      FN(row_4_)(x, y.upper ^ hash, y.f - 1.0f, z, t, c));
}

SL_INLINE F FN(cube_4_)(FN(axis_) x, FN(axis_) y, FN(axis_) z, I ht, F t, uint32_t c) {
    return FN(blend_)(z.w, FN(face_4_)(x, y, z.lower ^ ht, z.f, t, c),
                      FN(face_4_)(x, y, z.upper ^ ht, z.f - 1.0f, t, c));
}

/* Not inlined: 16 corners are used by six functions. */
static F FN(sum_4_)(FN(axis_) x, FN(axis_) y, FN(axis_) z, FN(axis_) t, uint32_t c) {
    return FN(blend_)(t.w, FN(cube_4_)(x, y, z, t.lower, t.f, c),
                      FN(cube_4_)(x, y, z, t.upper, t.f - 1.0f, c));
}

/* --- values
 * -------------------------------------------------------------------------------------------------------
 */

#define NOISE_SEED(d) (0x9e3779b9u * (d))

SL_INLINE F FN(value_1_)(FN(axis_) x, uint32_t c) {
    return FN(scaled_)(FN(sum_1_)(x, c), 0.094f);
}
SL_INLINE F FN(value_2_)(FN(axis_) x, FN(axis_) y, uint32_t c) {
    return FN(scaled_)(FN(sum_2_)(x, y, c), 0.2535f);
}
SL_INLINE F FN(value_3_)(FN(axis_) x, FN(axis_) y, FN(axis_) z, uint32_t c) {
    return FN(scaled_)(FN(sum_3_)(x, y, z, c), 0.468f);
}
SL_INLINE F FN(value_4_)(FN(axis_) x, FN(axis_) y, FN(axis_) z, FN(axis_) t, uint32_t c) {
    return FN(clamp_f)(FN(scaled_)(FN(sum_4_)(x, y, z, t, c), 0.435f), K(0), K(1));
}

SL_INLINE V FN(channels_1_)(FN(axis_) x) {
    return FN(make_3)(FN(value_1_)(x, NOISE_C0), FN(value_1_)(x, NOISE_C1),
                      FN(value_1_)(x, NOISE_C2));
}
SL_INLINE V FN(channels_2_)(FN(axis_) x, FN(axis_) y) {
    return FN(make_3)(FN(value_2_)(x, y, NOISE_C0), FN(value_2_)(x, y, NOISE_C1),
                      FN(value_2_)(x, y, NOISE_C2));
}
SL_INLINE V FN(channels_3_)(FN(axis_) x, FN(axis_) y, FN(axis_) z) {
    return FN(make_3)(FN(value_3_)(x, y, z, NOISE_C0), FN(value_3_)(x, y, z, NOISE_C1),
                      FN(value_3_)(x, y, z, NOISE_C2));
}
SL_INLINE V FN(channels_4_)(FN(axis_) x, FN(axis_) y, FN(axis_) z, FN(axis_) t) {
    return FN(make_3)(FN(value_4_)(x, y, z, t, NOISE_C0), FN(value_4_)(x, y, z, t, NOISE_C1),
                      FN(value_4_)(x, y, z, t, NOISE_C2));
}

/* The axes of a point: o open, p periodic. */
#define OPEN_X(d, a)      FN(open_axis_)(a, NOISE_P0, NOISE_SEED(d))
#define OPEN_Y(a)         FN(open_axis_)(a, NOISE_P1, 0)
#define OPEN_Z(a)         FN(open_axis_)(a, NOISE_P2, 0)
#define OPEN_T(a)         FN(open_axis_)(a, NOISE_P3, 0)
#define CLOSED_X(d, a, p) FN(closed_axis_)(a, p, NOISE_P0, NOISE_SEED(d))
#define CLOSED_Y(a, p)    FN(closed_axis_)(a, p, NOISE_P1, 0)
#define CLOSED_Z(a, p)    FN(closed_axis_)(a, p, NOISE_P2, 0)
#define CLOSED_T(a, p)    FN(closed_axis_)(a, p, NOISE_P3, 0)

/* --- cells
 * --------------------------------------------------------------------------------------------------------
 */

SL_INLINE I FN(finish_)(I h) {
    h = h ^ FN(shr_i)(h, 16);
    h = FN(mul_i)(h, 0x85ebca6bu);
    h = h ^ FN(shr_i)(h, 13);
    h = FN(mul_i)(h, 0xc2b2ae35u);
    return h ^ FN(shr_i)(h, 16);
}

SL_INLINE F FN(unit_of_hash_)(I h) { /* [0,1) in steps of 2^-24 */
    return FN(float_of_i)(FN(shr_i)(h, 8)) * 0x1p-24f;
}

#define CELL_SEED 0x7f4a7c15u

SL_INLINE I FN(cell_index_)(F a) {
    return FN(whole_of_f)(FN(floor)(a));
}

/* probe: 0 times the coordinates; anything but 0 comes from NaN or infinity. */
SL_INLINE F FN(cell_value_)(I h, F probe) {
    return SEL(EQ(probe, K(0)), FN(unit_of_hash_)(FN(finish_)(h)), K(0.5f));
}
SL_INLINE V FN(cell_channels_)(I h, F probe) {
    return FN(make_3)(FN(cell_value_)(h, probe),
                      FN(cell_value_)(FN(add_i)(h, KI((int)0x9e3779b9u)), probe),
                      FN(cell_value_)(FN(add_i)(h, KI(0x3c6ef372)), probe));
}
