// SPDX-License-Identifier: Apache-2.0
/* Imager: option("Format"), gradient background under the picture, dark corners, gamma by pow per component. */
imager vignette_imager(float strength = .6, gamma = 1; color top = color (.3, .5, .9), bottom = color (.9, .9, 1);)
{
    uniform float res[3] = {640, 480, 1};
    if (option("Format", res) != 1)
        printf("no format\n");
    float x = xcomp(P) / res[0], y = ycomp(P) / res[1];
    Ci += (1 - alpha) * mix(top, bottom, y);
    float r2 = (x - .5) * (x - .5) + (y - .5) * (y - .5);
    Ci *= 1 - strength * smoothstep(.1, .5, r2);
    uniform float i;
    for (i = 0; i < ncomps; i += 1)
        setcomp(Ci, i, pow(comp(Ci, i), 1 / gamma));
    Oi = 1;
    alpha = 1;
}
