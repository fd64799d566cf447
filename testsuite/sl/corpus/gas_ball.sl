// SPDX-License-Identifier: Apache-2.0
/* A closed sphere as the box of a cloud: the ray is marched inside it, in object space; back faces stay clear. */
#include "raysphere.h"
#include "noises.h"
surface gas_ball(float density = 3, freq = 2.5, radius = 1, stepsize = .12, octaves = 3; color glow = color (.9, .5, .2))
{
    Ci = 0;
    Oi = 0;
    if (N . I < 0) {
        point Ob = transform("object", P);
        vector V = normalize(vtransform("object", I));
        float t0, t1;
        float hits = raysphere(Ob, V, radius, .001, t0, t1);
        float end = hits > 0 ? max(t0, t1) : 0;
        float d = stepsize * cellnoise(s * 1000, t * 1000);
        float trans = 1;
        color sum = 0;
        while (d < end && trans > .02) {
            point Q = Ob + d * V;
            float n = fBm(Q * freq, .05, octaves, 2, .5);
            float dens = density * smoothstep(-.1, .6, n) * smoothstep(0, .4, 1 - length(vector Q) / radius);
            float a = 1 - exp(-dens * stepsize);
            sum += trans * a * mix(glow, color (1, 1, .8), clamp(n, 0, 1));
            trans *= 1 - a;
            d += stepsize;
        }
        Ci = sum;
        Oi = 1 - trans;
    }
}
