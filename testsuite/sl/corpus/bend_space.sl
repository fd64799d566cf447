// SPDX-License-Identifier: Apache-2.0
/* A transformation shader of 3.1: parsed and compiled, nothing binds it. */
transformation bend_space(float angle = .3; point axis0 = 0, axis1 = (0, 1, 0);)
{
    float k = ycomp(P) * angle;
    P = rotate(P, k, axis0, axis1);
    N = rotate(N, k, point 0, axis1 - axis0);
}
