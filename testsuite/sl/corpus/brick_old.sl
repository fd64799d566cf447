// SPDX-License-Identifier: Apache-2.0
/* Bricks in the untyped style of the first interface: points for everything, no declarations of detail. */
#include "patterns.slh"
#define BRICKWIDTH 0.25
#define BRICKHEIGHT 0.08
#define MORTAR 0.01
#define BMWIDTH (BRICKWIDTH + MORTAR)
#define BMHEIGHT (BRICKHEIGHT + MORTAR)
#define MWF (MORTAR * 0.5 / BMWIDTH)
#define MHF (MORTAR * 0.5 / BMHEIGHT)

surface
brick_old(
    float Ka = 1, Kd = 1;
    color brickcolor = color (0.5, 0.15, 0.14);
    color mortarcolor = color (0.5, 0.5, 0.5);
    )
{
    color Ct;
    point NN;
    float ss, tt, sbrick, tbrick, w, h;
    float scoord = s;
    float tcoord = t;

    NN = normalize(faceforward(N, I));
    ss = scoord / BMWIDTH;
    tt = tcoord / BMHEIGHT;
    if (mod(tt * 0.5, 1) > 0.5)
        ss += 0.5;
    sbrick = floor(ss); /* which brick? */
    tbrick = floor(tt);
    ss -= sbrick;
    tt -= tbrick;
    w = step(MWF, ss) - step(1 - MWF, ss);
    h = step(MHF, tt) - step(1 - MHF, tt);
    Ct = mix(mortarcolor, brickcolor * (1 + 0.2 * snoise(sbrick + tbrick * 7 + 0.5)), w * h);
    Oi = Os;
    Ci = Os * Ct * (Ka * ambient() + Kd * diffuse(NN));
}
