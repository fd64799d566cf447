// SPDX-License-Identifier: Apache-2.0
#include "filterwidth.h"
/* Turbulence whose octaves end where they become smaller than a sample. */
surface study_marble(float freq = 3, Ks = .4, roughness = .1;)
{
    point PP = freq * transform("shader", P);
    float width = filterwidthp(PP), sum = 0, size = 1;
    while (size > width && size > .01) {
        sum += size * abs(2 * noise(PP / size) - 1) * (1 - smoothstep(.2, .6, width / size));
        size /= 2;
    }
    normal Nf = faceforward(normalize(N), I);
    vector V = -normalize(I);
    color veins = mix(Cs, Cs * color(.3, .25, .2), smoothstep(.2, .9, sum));
    Oi = Os;
    Ci = Os * (veins * (ambient() + diffuse(Nf)) + Ks * specular(Nf, V, roughness));
}
