// SPDX-License-Identifier: Apache-2.0
/* Ray-marched smoke: density by noise, lights asked at each step, jittered start, early end when opaque. */
#include "noises.h"
float smokedensity(point Pcur; uniform float octaves, freq)
{
    point Q = transform("world", Pcur) * freq;
    float d = .5 + fBm(Q, .1, octaves, 2, .5);
    return smoothstep(.4, .8, d);
}
color light_at(point PW; color smokecolor)
{
    color C = 0;
    illuminance (PW, vector (0, 0, 1), PI) {
        extern color Cl;
        extern vector L;
        float foglight = 1;
        lightsource("__foglight", foglight);
        if (foglight > 0)
            C += smokecolor * Cl;
    }
    return C;
}
volume smoke_march(float opacdensity = .6, lightdensity = .6, integstart = 0, integend = 12, stepsize = .4, octaves = 3, freq = .7;
                   color smokecolor = color (.9, .9, .95))
{
    point Worigin = P - I;
    float end = min(length(I), integend), dtau, last_dtau;
    float d = integstart + random() * stepsize;
    vector IN = normalize(vector I);
    color Cv = 0, Ov = 0;
    float ss, tau;
    last_dtau = smokedensity(Worigin + d * IN, octaves, freq);
    color li, last_li = light_at(Worigin + d * IN, smokecolor);
    while (d <= end && comp(Ov, 0) < .99) {
        ss = clamp(stepsize, .005, end - d + .01);
        d += ss;
        point PP = Worigin + d * IN;
        dtau = smokedensity(PP, octaves, freq);
        li = light_at(PP, smokecolor) * dtau;
        tau = opacdensity * ss / 2 * (dtau + last_dtau);
        color lighttau = lightdensity * ss / 2 * (li + last_li);
        color scat = -1 * color (1 - exp(tau), 1 - exp(tau), 1 - exp(tau)) * exp(-tau);
        Cv += (1 - Ov) * lighttau;
        Ov += (1 - Ov) * scat;
        last_dtau = dtau;
        last_li = li;
    }
    Ci = Cv + (1 - Ov) * Ci;
    Oi = Ov + (1 - Ov) * Oi;
}
