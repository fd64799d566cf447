/* SPDX-License-Identifier: Apache-2.0
 * Eight octaves of 3-D noise at n points (a multiple of 8) given as planes: the loop emitted code
 * would hold, and the same with intrinsics and everything inlined, as the limit. And octaves with
 * their differences for two steps of length `step`: by a call each (_apart), by one call for value
 * and both (_together), by three values (_by_values).
 */
#ifndef PERIGEE_NOISE_LOOP_H
#define PERIGEE_NOISE_LOOP_H

#ifdef __cplusplus
extern "C" {
#endif

void noise_octaves_1(const float* x, const float* y, const float* z, float* result, int n);
void noise_octaves_4(const float* x, const float* y, const float* z, float* result, int n);
void noise_octaves_8(const float* x, const float* y, const float* z, float* result, int n);
void noise_octaves_by_hand(const float* x, const float* y, const float* z, float* result, int n);
void noise_differences_apart(const float* x, const float* y, const float* z, float* result, int n,
                             float step);
void noise_differences_together(const float* x, const float* y, const float* z, float* result,
                                int n, float step);
void noise_differences_by_values(const float* x, const float* y, const float* z, float* result,
                                 int n, float step);

#ifdef __cplusplus
}
#endif
#endif
