// SPDX-License-Identifier: Apache-2.0
/* Parquet of planks with grain: filtered tiling, per-plank variation, rings from a distorted solid, layered varnish. */
#include "noises.h"
#include "patterns.h"
#include "material.h"

void plank_tile(float ss, tt, dss, dtt; uniform float width, length_, groove; output float plank, inplank)
{
    float column = floor(ss / width);
    float y = tt / length_ + .5 * mod(column, 2) + cellnoise(column) * .3;
    plank = column * 17 + floor(y);
    inplank = filteredpulsetrain(groove, width, ss + width - groove / 2, dss)
        * filteredpulsetrain(groove / length_, 1, y + 1 - groove / length_ / 2, dtt / length_);
}
float oak_grain(point Q; float dQ; float ringfreq)
{
    vector wander = vfBm(Q * .5, dQ * .5, 2, 4, .5);
    point P2 = Q + wander * .15;
    float r = sqrt(xcomp(P2) * xcomp(P2) + zcomp(P2) * zcomp(P2)) * ringfreq;
    r += .5 * filteredsnoise(point (r, 0, 0), dQ);
    float inring = smoothpulsetrain(.1, .55, .7, .95, 1, r);
    point Pg = point (xcomp(Q) * 90, ycomp(Q) * 3, zcomp(Q) * 90);
    return inring * .7 + .3 * filterednoise(Pg, dQ * 90);
}
surface oak_planks(float Ka = 1, Kd = .75, Ks = .15, roughness = .1, Kr = 0, width = .12, plen = .8, groove = .006, ringfreq = 12;
                   color lightwood = color (.6, .35, .15), darkwood = color (.25, .12, .05), groovecolor = color (.05, .04, .015);
                   DECLARE_DEFAULTED_ENVPARAMS;)
{
    normal Nf = faceforward(normalize(N), I);
    float ss = s, tt = t;
    float dss = filterwidth(ss), dtt = filterwidth(tt);
    float plank, inplank;
    plank_tile(ss, tt, dss, dtt, width, plen, groove, plank, inplank);
    point Q = point (ss, tt, .1 * cellnoise(plank)) + vector cellnoise(plank, 3) * 5;
    float g = oak_grain(Q, max(dss, dtt), ringfreq);
    color wood = mix(lightwood, darkwood, g);
    wood = varyEach(wood, plank, .03, .2, .3);
    color base = mix(groovecolor, wood, inplank);
    Oi = Os;
    Ci = Oi * MaterialShinyPlastic(Nf, base, Ka, Kd, Ks * inplank, roughness, Kr, 0, 1.5, ENVPARAMS);
}
