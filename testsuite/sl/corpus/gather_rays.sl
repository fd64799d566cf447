// SPDX-License-Identifier: Apache-2.0
/* gather with outputs and an else branch. */
surface gather_rays(float samples = 16, angle = PI / 2)
{
    normal Nf = faceforward(normalize(N), I);
    color hitc = 0, sum = 0;
    float dist = 0, hits = 0;
    gather("illuminance", P, Nf, angle, samples, "bias", .01, "surface:Ci", hitc, "ray:length", dist) {
        if (dist > 100) continue;
        sum += hitc;
        hits += 1;
    } else {
        sum += .5;
    }
    Ci = sum / samples + occlusion(P, Nf, samples, "maxdist", 10) + indirectdiffuse(P, Nf, samples);
    Oi = 1;
}
