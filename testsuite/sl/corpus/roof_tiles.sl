// SPDX-License-Identifier: Apache-2.0
/* Overlapping round tiles as displacement with truedisp switch; odd rows shifted. */
displacement roof_tiles(float Km = .05, freq = 8, truedisp = 1; string space = "shader";)
{
    float ss = s * freq, tt = t * freq;
    float row = floor(tt);
    ss += .5 * mod(row, 2);
    float x = mod(ss, 1) - .5, y = mod(tt, 1);
    float arc = sqrt(max(0, .25 - x * x)) * 2;
    float h = y < arc ? 1 - y * .6 : .2 * (1 - (y - arc));
    normal NN = normalize(N);
    float amp = Km * h / max(length(vtransform(space, NN)), 1e-6);
    point PP = P + amp * NN;
    N = calculatenormal(PP);
    if (truedisp == 1)
        P = PP;
}
