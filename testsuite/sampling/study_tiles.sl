// SPDX-License-Identifier: Apache-2.0
#include "filterwidth.h"
/* Tiles with joints, filtered over the width of a sample; every tile has its own shade and grain. */
float filtered_pulse(float edge0, edge1, x, width)
{
    return (min(max(x + width / 2, edge0), edge1) - min(max(x - width / 2, edge0), edge1)) / max(width, 1e-6);
}

surface study_tiles(float freq = 6, joint = .06, grain = 20; color joint_color = .2;)
{
    float ss = s * freq, tt = t * freq;
    float ws = filterwidth(ss), wt = filterwidth(tt);
    float inside = filtered_pulse(joint, 1, mod(ss, 1), ws) * filtered_pulse(joint, 1, mod(tt, 1), wt);
    color tile = Cs * (.7 + .3 * cellnoise(ss, tt)) * (.85 + .3 * noise(s * grain, t * grain) * (1 - smoothstep(.2, .6, grain * ws / freq)));
    normal Nf = faceforward(normalize(N), I);
    Oi = Os;
    Ci = Os * mix(joint_color, tile, inside) * (ambient() + diffuse(Nf));
}
