// SPDX-License-Identifier: Apache-2.0
/* Imager that goes through other colour spaces and limits saturation. */
imager sepia_grade(float amount = .8; string space = "YIQ"; color tone = color (1, .85, .6);)
{
    color c = ctransform("rgb", space, Ci);
    color hsl = ctransform("hsl", clamp(Ci, color 0, color 1));
    float lum = comp(c, 0);
    setcomp(hsl, 1, comp(hsl, 1) * .5);
    color soft = ctransform("hsl", "rgb", hsl);
    Ci = mix(soft, lum * tone, amount);
}
