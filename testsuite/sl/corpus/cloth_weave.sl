// SPDX-License-Identifier: Apache-2.0
/* Woven threads: over and under by parity, anisotropic sheen along the thread, Oren and Nayar below. */
#include "patterns.h"
#include "material.h"
surface cloth_weave(float freq = 30, Ka = 1, Kd = .8, Ks = .4, gap = .1; color warp = color (.6, .1, .1), weft = color (.8, .7, .3))
{
    normal Nf = faceforward(normalize(N), I);
    float ss = s * freq, tt = t * freq;
    float over = mod(floor(ss) + floor(tt), 2);
    float across = over == 1 ? mod(ss, 1) : mod(tt, 1);
    float height = sin(PI * across);
    vector xdir = over == 1 ? normalize(dPdv) : normalize(dPdu);
    color Ct = (over == 1 ? warp : weft) * (.6 + .4 * height);
    float hole = smoothpulse(0, gap, 1 - gap, 1, mod(ss, 1)) * smoothpulse(0, gap, 1 - gap, 1, mod(tt, 1));
    color C = Ct * LocIllumOrenNayar(Nf, -normalize(I), .7) * Kd + Ks * Ct * LocIllumWardAnisotropic(Nf, -normalize(I), xdir, .15, .6);
    Oi = Os * mix(.3, 1, hole);
    Ci = Oi * (C + Ka * Ct * ambient());
}
