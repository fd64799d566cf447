// SPDX-License-Identifier: Apache-2.0
/* Nested tiles with filtered pulses, glossy lobe from the library, grout that bends the normal. */
#include "patterns.h"
#include "noises.h"
#include "material.h"
#include "displace.h"
surface ceramic_tiles(float Ka = 1, Kd = .6, Ks = .5, roughness = .2, specsharpness = .5, tilesize = .2, grout = .06, groutdepth = .01;
                      color tilecolor = color (.85, .85, .9), groutcolor = color (.5, .5, .48), speckcolor = color (.2, .3, .5); float colorvary = .1;)
{
    float ss = s / tilesize, tt = t / tilesize;
    float dss = filterwidth(ss), dtt = filterwidth(tt);
    float tileindex = floor(ss) + 13 * floor(tt);
    float intile = filteredpulsetrain(grout, 1, ss + 1 - grout / 2, dss) * filteredpulsetrain(grout, 1, tt + 1 - grout / 2, dtt);
    normal Nt = Displace(normalize(N), "shader", groutdepth * (intile - 1), 0);
    normal Nf = faceforward(Nt, I);
    point Q = transform("shader", P) * 30;
    float speck = smoothstep(.65, .75, filterednoise(Q, filterwidthp(Q)));
    color Ct = varyEach(tilecolor, tileindex, .05, .1, colorvary);
    Ct = mix(Ct, speckcolor, speck);
    Ct = mix(groutcolor, Ct, intile);
    Oi = Os;
    Ci = Oi * MaterialCeramic(Nf, Ct, Ka, Kd, Ks * intile, roughness, specsharpness);
}
