// SPDX-License-Identifier: Apache-2.0
/* Anisotropic highlight with an own light loop; the direction of brushing turns about the middle of the disk. */
surface brushed_metal(float Ka = .2, Ks = .9, xrough = .08, yrough = .4, scratch = .1; color tint = color (.9, .85, .8); string way = "linear";)
{
    normal Nf = faceforward(normalize(N), I);
    vector V = normalize(-I);
    vector xdir = way == "radial" ? normalize(dPdv) : normalize(dPdu);
    float n = noise(s * 4, t * 300) + .5 * noise(s * 8, t * 700);
    xdir = normalize(xdir + scratch * (n - .75) * (Nf ^ xdir));
    vector ydir = Nf ^ xdir;
    color spec = 0;
    float nv = max(Nf . V, .01);
    illuminance (P, Nf, PI / 2) {
        float nons = 0;
        if (lightsource("__nonspecular", nons) == 0) nons = 0;
        vector LN = normalize(L);
        float nl = Nf . LN;
        if (nl > 0 && nons < 1) {
            vector H = normalize(LN + V);
            float hx = (H . xdir) / xrough, hy = (H . ydir) / yrough;
            float e = (hx * hx + hy * hy) / (1 + H . Nf);
            spec += (1 - nons) * Cl * nl * exp(-2 * e) / (sqrt(nl * nv) * 4 * PI * xrough * yrough);
        }
    }
    Oi = Os;
    Ci = Oi * tint * Cs * (Ka * ambient() + Ks * spec);
}
