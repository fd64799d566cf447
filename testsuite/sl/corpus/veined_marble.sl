// SPDX-License-Identifier: Apache-2.0
/* Veins sharpened by pow with noise of varying frequency; a user function with output and several early exits. */
#include "noises.h"
float vein(point Q; float dQ, freq, sharpness, octaves; output color stain)
{
    float t2 = 0;
    if (freq <= 0)
        return 0;
    vector offset = vfBm(Q, dQ, octaves, 2, .75);
    point PP = Q + offset;
    t2 = abs(2 * filterednoise(PP * freq, dQ * freq) - 1);
    t2 = smoothstep(0, sharpness, t2);
    stain = mix(color (.7, .6, .5), color (1, 1, 1), fBm(Q * 2, dQ * 2, 3, 2, .5) * .5 + .5);
    return 1 - t2;
}
surface veined_marble(float Ka = 1, Kd = .7, Ks = .2, roughness = .1, veinfreq = 1.5, veinlevels = 2, sharpness = .2;
                      color basecolor = color (.9, .88, .85), veincolor = color (.35, .3, .4); string shadingspace = "shader";)
{
    point Q = transform(shadingspace, P);
    float dQ = filterwidthp(Q);
    color total = basecolor, stain = 1;
    uniform float i, freq = veinfreq;
    for (i = 1; i <= veinlevels; i += 1) {
        total = mix(total, veincolor, vein(Q, dQ, freq, sharpness, 4, stain) / i) * stain;
        freq *= 2;
    }
    normal Nf = faceforward(normalize(N), I);
    Oi = Os;
    Ci = Oi * (total * (Ka * ambient() + Kd * diffuse(Nf)) + Ks * specular(Nf, -normalize(I), roughness));
}
