// SPDX-License-Identifier: Apache-2.0
// The same as tilt with the usual last line.
displacement tilt_N(float slope = 1; output varying float height = 0;)
{
    height = slope * u;
    P += height * normalize(N);
    N = calculatenormal(P);
}
