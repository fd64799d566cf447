// SPDX-License-Identifier: Apache-2.0
/* Displacement from octaves of noise in object space; the result is reported to the surface. */
#include "patterns.slh"
displacement dented(float Km = 1.0; uniform float octaves = 6; output varying float depth_of_dent = 0;)
{
    float size = 1.0, magnitude = 0.0, i;
    point P2;
    P2 = transform("shader", P);
    for (i = 0; i < octaves; i += 1.0) {
        magnitude += 4.0 * abs(.5 - noise(P2 * size)) / size;
        size *= 2.0;
    }
    magnitude = magnitude * magnitude * magnitude * Km;
    depth_of_dent = magnitude;
    P -= magnitude * normalize(N);
    N = calculatenormal(P);
}
