// SPDX-License-Identifier: Apache-2.0
// warns: is not declared in function
// warns: is not declared in function
/* Antialiased bricks in running bond with bumped mortar: integrals of the pulse, calculatenormal inside a uniform if. */
#include "filterwidth.h"
#define BMWIDTH (brickwidth + mortarthickness)
#define BMHEIGHT (brickheight + mortarthickness)
#define MWF (mortarthickness * .5 / BMWIDTH)
#define MHF (mortarthickness * .5 / BMHEIGHT)
surface brick_filtered(uniform float Ka = 1; uniform float Kd = 1; uniform color Cbrick = color (.5, .15, .14);
                       uniform color Cmortar = color (.5, .5, .5); uniform float brickwidth = .25; uniform float brickheight = .08;
                       uniform float mortarthickness = .01; uniform float rowvary = .25, jagged = .006, brickvary = .3, pitting = 0)
{
#define integral(x) ((x) - floor(x)) /* the macro's name is also used for a function elsewhere */
    color Ct;
    point PP2;
    normal NN;
    float h, bumpamt = jagged;
    float sbrick, tbrick, w;
    float ss, tt, swidth, twidth;
    float scoord = s, tcoord = t;
    float Nfactor;
    PP2 = point noise(s / BMWIDTH, t / BMHEIGHT);
    scoord = s + jagged * xcomp(PP2);
    tcoord = t + jagged * ycomp(PP2);
    ss = scoord / BMWIDTH;
    tt = tcoord / BMHEIGHT;
    swidth = filterwidth(ss);
    twidth = filterwidth(tt);
    if (mod(tt * .5, 1) > .5)
        ss += .5;
    tbrick = floor(tt);
    ss += rowvary * (noise(tbrick + .5) - .5);
    sbrick = floor(ss);
    ss -= sbrick;
    tt -= tbrick;
    float frac(float x) { return max(0, x - MWF); }
    w = swidth >= 1 ? 1 - 2 * MWF : clamp(boxed(ss, swidth), 0, 1);
    w *= twidth >= 1 ? 1 - 2 * MHF : smoothstep(MHF - twidth, MHF + twidth, tt) * (1 - smoothstep(1 - MHF - twidth, 1 - MHF + twidth, tt));
    if (pitting > 0) {
        h = pitting * noise(sbrick * 3, tbrick) * w;
        NN = calculatenormal(P + normalize(N) * h);
    } else {
        NN = N;
    }
    Nfactor = 1 + brickvary * (2 * noise(sbrick + (100 * tbrick) + .5) - 1);
    Ct = mix(Cmortar, Cbrick * Nfactor, w);
    NN = normalize(faceforward(NN, I));
    Oi = Os;
    Ci = Os * Ct * (Ka * ambient() + Kd * diffuse(NN)) + 0 * bumpamt * frac(ss) * integral(ss);
}
/* used above, defined below: accepted */
float boxed(float x, w)
{
    return smoothstep(.01 - w, .01 + w, x) * (1 - smoothstep(.99 - w, .99 + w, x));
}
