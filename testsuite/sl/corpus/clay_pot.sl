// SPDX-License-Identifier: Apache-2.0
/* Rough diffuse reflection from the library, turned rings by a uniform loop of sines. */
#include "material.h"
surface clay_pot(float Ka = .5, Kd = .9, sigma = .5, rings = 40; color clay = color (.7, .4, .25))
{
    normal Nf = faceforward(normalize(N), I);
    uniform float k;
    float ring = 0;
    for (k = 1; k < 8; k *= 2)
        ring += sin(2 * PI * k * rings * v) / k;
    Oi = Os;
    Ci = Os * MaterialClay(Nf, clay * (1 + .08 * ring), Ka, Kd, sigma);
}
