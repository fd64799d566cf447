/* SPDX-License-Identifier: Apache-2.0
 * A mirror whose rays have options. */
surface mirror_options(string subset = "", sides = "both"; float maxdist = 1e30, samples = 1, cone = 0)
{
    normal Nf = faceforward(normalize(N), I);
    Oi = 1;
    Ci = color trace(P, reflect(normalize(I), Nf), "subset", subset, "hitsides", sides, "maxdist", maxdist,
                     "samples", samples, "samplecone", cone);
}
