/* SPDX-License-Identifier: Apache-2.0
 * The noise of noise_lattice.h written for one processor: AVX2 intrinsics, everything inlined into
 * the octave loop. The limit that the library's form is measured against.
 */
#include "noise_loop.h"

#include <immintrin.h>

typedef __m256 F;
typedef __m256i I;

static inline F fade(F f) {
    const F six = _mm256_set1_ps(6), fifteen = _mm256_set1_ps(15), ten = _mm256_set1_ps(10);
    const F inner =
        _mm256_add_ps(_mm256_mul_ps(f, _mm256_sub_ps(_mm256_mul_ps(f, six), fifteen)), ten);
    return _mm256_mul_ps(_mm256_mul_ps(_mm256_mul_ps(f, f), f), inner);
}

static inline F corner(I hash, F x, F y, F z) {
    const float a = 0.822598f, b = 1.150362f, d = 0.997497f, e = 0.1f;
    const F gx = _mm256_setr_ps(a, -a, 0, 0, d, d, -d, -d);
    const F gy = _mm256_setr_ps(0, 0, a, -a, d, -d, d, -d);
    const F gz = _mm256_setr_ps(b, b, b, b, e, e, e, e);
    const I h = _mm256_mullo_epi32(hash, _mm256_set1_epi32((int)0xe3779b97u));
    const I k = _mm256_srli_epi32(h, 28);
    const F dot = _mm256_add_ps(_mm256_add_ps(_mm256_mul_ps(_mm256_permutevar8x32_ps(gx, k), x),
                                              _mm256_mul_ps(_mm256_permutevar8x32_ps(gy, k), y)),
                                _mm256_mul_ps(_mm256_permutevar8x32_ps(gz, k), z));
    const I sign = _mm256_and_si256(h, _mm256_set1_epi32((int)0x80000000));
    return _mm256_xor_ps(dot, _mm256_castsi256_ps(sign));
}

static inline F blend(F w, F a, F b) {
    return _mm256_add_ps(a, _mm256_mul_ps(w, _mm256_sub_ps(b, a)));
}

static inline I lattice(F whole, unsigned prime, unsigned seed) {
    return _mm256_add_epi32(
        _mm256_mullo_epi32(_mm256_cvttps_epi32(whole), _mm256_set1_epi32((int)prime)),
        _mm256_set1_epi32((int)seed));
}

static inline F face(I x0, I x1, I y0, I y1, I z, F x, F y, F dz, F wx, F wy) {
    const F one = _mm256_set1_ps(1), xb = _mm256_sub_ps(x, one), yb = _mm256_sub_ps(y, one);
    const I low = _mm256_xor_si256(y0, z), high = _mm256_xor_si256(y1, z);
    const F a = blend(wx, corner(_mm256_xor_si256(x0, low), x, y, dz),
                      corner(_mm256_xor_si256(x1, low), xb, y, dz));
    const F b = blend(wx, corner(_mm256_xor_si256(x0, high), x, yb, dz),
                      corner(_mm256_xor_si256(x1, high), xb, yb, dz));
    return blend(wy, a, b);
}

static inline F noise(F x, F y, F z) {
    const unsigned px = 0x8da6b343u, py = 0xb5297a4du, pz = 0xcb1ab31fu;
    const F fx = _mm256_floor_ps(x), fy = _mm256_floor_ps(y), fz = _mm256_floor_ps(z);
    const I x0 = lattice(fx, px, 3 * 0x9e3779b9u),
            x1 = _mm256_add_epi32(x0, _mm256_set1_epi32((int)px));
    const I y0 = lattice(fy, py, 0), y1 = _mm256_add_epi32(y0, _mm256_set1_epi32((int)py));
    const I z0 = lattice(fz, pz, 0), z1 = _mm256_add_epi32(z0, _mm256_set1_epi32((int)pz));
    const F dx = _mm256_sub_ps(x, fx), dy = _mm256_sub_ps(y, fy), dz = _mm256_sub_ps(z, fz);
    const F wx = fade(dx), wy = fade(dy), wz = fade(dz);
    const F low = face(x0, x1, y0, y1, z0, dx, dy, dz, wx, wy);
    const F high = face(x0, x1, y0, y1, z1, dx, dy, _mm256_sub_ps(dz, _mm256_set1_ps(1)), wx, wy);
    const F sum = blend(wz, low, high);
    const F scaled = _mm256_and_ps(_mm256_mul_ps(sum, _mm256_set1_ps(0.468f)),
                                   _mm256_cmp_ps(sum, sum, _CMP_EQ_OQ));
    return _mm256_add_ps(_mm256_set1_ps(0.5f), scaled);
}

void noise_octaves_by_hand(const float* x, const float* y, const float* z, float* result, int n) {
    for (int i = 0; i < n; i += 8) {
        F px = _mm256_loadu_ps(x + i), py = _mm256_loadu_ps(y + i), pz = _mm256_loadu_ps(z + i);
        F sum = _mm256_setzero_ps(), weight = _mm256_set1_ps(1);
        for (int octave = 0; octave < 8; octave++) {
            sum = _mm256_add_ps(sum, _mm256_mul_ps(weight, noise(px, py, pz)));
            px = _mm256_add_ps(px, px), py = _mm256_add_ps(py, py), pz = _mm256_add_ps(pz, pz);
            weight = _mm256_mul_ps(weight, _mm256_set1_ps(0.5f));
        }
        _mm256_storeu_ps(result + i, sum);
    }
}
