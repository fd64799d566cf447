// SPDX-License-Identifier: Apache-2.0
/* Sum of wave trains about wandering centres, as a bump; reflection mixed by fresnel, sky by a spline. */
surface water_waves(float Ka = .2, Kd = .2, Ks = 1, roughness = .03, amp = .004, freq = 12, eta = 1.33, phase = 0; uniform float trains = 12;)
{
    point PP = transform("shader", P);
    float h = 0;
    uniform float i;
    for (i = 0; i < trains; i += 1) {
        point center = 10 * (point cellnoise(i) - .5);
        float r = distance(PP, center);
        h += sin(r * freq * (1 + .5 * cellnoise(i + 100)) + phase * 2 * PI + cellnoise(i + 50) * 6);
    }
    normal Nn = normalize(N);
    normal Nf = faceforward(normalize(calculatenormal(P + amp * h * Nn)), I);
    vector IN = normalize(I), R = reflect(IN, Nf);
    float kr, kt;
    fresnel(IN, Nf, 1 / eta, kr, kt);
    float up = clamp(zcomp(vtransform("world", R)) * .5 + .5, 0, 1);
    color sky = spline("linear", up, color (.8, .85, .9), color (.8, .85, .9), color (.5, .6, .8), color (.2, .3, .6), color (.1, .1, .4));
    Oi = Os;
    Ci = Os * ((1 - kr) * Cs * (Ka * ambient() + Kd * diffuse(Nf)) + kr * sky + Ks * specular(Nf, -IN, roughness));
}
