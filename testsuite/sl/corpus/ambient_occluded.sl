// SPDX-License-Identifier: Apache-2.0
/* Ambient light with neither illuminate nor solar; Ns and Ps of the surface, a hemisphere of two colours, occlusion. */
light ambient_occluded(float intensity = .5; color skycolor = color (.4, .5, .8), groundcolor = color (.3, .2, .1);
                       vector up = vector "world" (0, 1, 0); float samples = 0, maxdist = 10; string __category = "ambient";)
{
    normal Nn = normalize(Ns);
    float k = .5 + .5 * (Nn . normalize(up));
    float hidden = 0;
    if (samples > 0)
        hidden = occlusion(Ps, Nn, samples, "maxdist", maxdist, "coneangle", PI / 2);
    Cl = intensity * mix(groundcolor, skycolor, k) * (1 - hidden);
}
