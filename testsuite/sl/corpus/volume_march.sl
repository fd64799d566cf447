// SPDX-License-Identifier: Apache-2.0
/* A ray-marched fog that accumulates in Ci and Oi. */
#include "patterns.slh"
volume volume_march(float opacdensity = .1, lightdensity = .1, stepsize = .1; uniform float maxsteps = 50;
                    DECLARE_FRACTAL;)
{
    float d = length(I);
    vector dir = normalize(I);
    point PP = P - I;
    float steps = 0;
    float ss = min(stepsize, d), dleft = d;
    color Cv = 0, Ov = 0;
    while (dleft > 0 && steps < maxsteps) {
        color li = 0;
        illuminance(PP, point (0, 0, 1), PI) li += Cl;
        float dtau = opacdensity * (1 + fractal(transform("shader", PP), ss, octaves, lacunarity, gain));
        color tau = color (1 - exp(-dtau * ss));
        Cv += (1 - Ov) * tau * li * lightdensity;
        Ov += (1 - Ov) * tau;
        PP += ss * dir;
        dleft -= ss;
        ss = min(ss * (.9 + .2 * random()), dleft);
        steps += 1;
    }
    Ci = Cv + (1 - Ov) * Ci;
    Oi = Ov + (1 - Ov) * Oi;
}
