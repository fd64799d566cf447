// SPDX-License-Identifier: Apache-2.0
/* Holes by opacity, filtered; frequency from a uniform string, nothing shaded where it is clear. */
#include "patterns.h"
surface wire_screen(float Ka = 1, Kd = .75, Ks = .4, roughness = .1, density = .25, freq = 20; string axes = "both"; color specularcolor = 1)
{
    float fs = s * freq, ft = t * freq;
    float ws = filterwidth(fs), wt = filterwidth(ft);
    float hs = axes == "t" ? 0 : filteredpulsetrain(1 - density, 1, fs, ws), ht = axes == "s" ? 0 : filteredpulsetrain(1 - density, 1, ft, wt);
    float solid = union(hs, ht);
    if (solid > .001) {
        normal Nf = faceforward(normalize(N), I);
        Oi = Os * solid;
        Ci = Oi * (Cs * (Ka * ambient() + Kd * diffuse(Nf)) + specularcolor * Ks * specular(Nf, -normalize(I), roughness));
    } else {
        Oi = 0;
        Ci = 0;
    }
}
