// SPDX-License-Identifier: Apache-2.0
// Ci = occlusion() of the side that is seen.
surface show_occlusion(float samples = 400, maxdist = 1e30, coneangle = PI / 2, falloff = 0, falloffmode = 0, minsamples = 0;
                       string distribution = "cosine", hitsides = "both";)
{
    normal n = faceforward(normalize(N), I);
    Oi = 1;
    Ci = occlusion(P, n, samples, "maxdist", maxdist, "coneangle", coneangle, "falloff", falloff, "falloffmode", falloffmode,
                   "minsamples", minsamples, "distribution", distribution, "hitsides", hitsides);
}
