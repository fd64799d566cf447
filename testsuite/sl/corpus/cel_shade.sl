// SPDX-License-Identifier: Apache-2.0
/* Cartoon: bands by thresholds in an array, ink line by the angle to the eye, highlight as a hard spot. */
float quantise(float x; float levels[]; float n)
{
    float i, result = 0;
    for (i = 0; i < n; i += 1) {
        if (x >= levels[i])
            result = (i + 1) / n;
    }
    return result;
}
surface cel_shade(float Ka = .3, Kd = .8, Ks = .8, inkwidth = .25, roughness = .1; color inkcolor = 0;
                  float thresholds[3] = {.15, .5, .85};)
{
    normal Nf = faceforward(normalize(N), I);
    vector V = -normalize(I);
    color Ct = 0;
    float lit = 0;
    illuminance (P, Nf, PI / 2) {
        float d = normalize(L) . Nf;
        lit = max(lit, d * comp(Cl, 0));
        vector H = normalize(normalize(L) + V);
        if (pow(max(0, H . Nf), 1 / roughness) > .5)
            Ct += Ks * Cl;
    }
    float band = quantise(lit, thresholds, arraylength(thresholds));
    color base = Cs * (Ka * ambient() + Kd * band) + Ct;
    float ink = 1 - step(inkwidth, abs(Nf . V));
    Oi = Os;
    Ci = Oi * mix(base, inkcolor, ink);
}
